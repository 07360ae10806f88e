//! Trees over boxes: valid for every input, wrong ones found.

use glam::DVec3;
use lensrunner_lab::straight::{Bounds, BvhSettings, Costs, MAX_DEPTH, Node, Scalar, Tree, build};
use proptest::prelude::*;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::validate::{Fault, validate};

fn cube(x: f64, y: f64, z: f64, size: f64) -> Bounds<f64> {
    Bounds { min: [x, y, z], max: [x + size, y + size, z + size] }
}

/// Boxes along a line, the shape that every test below may spoil.
fn row(number: usize) -> Vec<Bounds<f64>> {
    (0..number).map(|i| cube(i as f64, 0.5 * i as f64, 0.0, 0.75)).collect()
}

fn built<T: Scalar>(boxes: &[Bounds<T>], max_leaf: usize) -> Tree<T> {
    let tree = build(boxes, &BvhSettings { max_leaf, ..BvhSettings::default() });
    let census = validate(&tree, boxes).unwrap();
    assert!(census.fullest <= max_leaf && census.depth <= MAX_DEPTH, "{census:?}");
    tree
}

#[test]
fn every_number_of_boxes() {
    assert_eq!(built::<f64>(&[], 4).nodes.len(), 0);
    for number in 1..70 {
        built(&row(number), 4);
    }
}

#[test]
fn the_heuristic_weighs_two_to_one() {
    // Two far boxes: one split costs 2·2 and saves nearly all of the area; with n = 2 a leaf (cost 2) is cheaper than 4, with n = 20 it is
    // not.
    let far = |number: usize| {
        let boxes: Vec<_> = (0..number).map(|i| cube(if i % 2 == 0 { 0.0 } else { 1e6 }, 0.0, 0.0, 1.0)).collect();
        build(&boxes, &BvhSettings { max_leaf: 100, ..BvhSettings::default() }).nodes.len()
    };
    assert_eq!([far(2), far(4), far(5), far(20)], [1, 1, 3, 3]);
    let dear = BvhSettings { costs: Costs { node: 0.0, primitive: 1.0 }, max_leaf: 100 };
    assert_eq!(build(&row(2), &dear).nodes.len(), 3, "with free boxes everything is split");
    // The root alone: cost n; the cost of a whole tree is what the leaf or split choices add up to.
    let tree = build(&row(2), &BvhSettings::default());
    assert_eq!(tree.cost(Costs::default()), 2.0);
}

#[test]
fn awkward_boxes() {
    let same = vec![cube(1.0, 2.0, 3.0, 1.0); 1000];
    built(&same, 4);
    let points = vec![cube(1.0, 2.0, 3.0, 0.0); 1000];
    built(&points, 4);
    let flat: Vec<_> = (0..500).map(|i| Bounds { min: [i as f64, 0.0, 0.0], max: [i as f64 + 2.0, 1.0, 0.0] }).collect();
    built(&flat, 4);
    // Each ten times as large as the one before: the heuristic peels one by one, and the depth must stay bounded.
    let mut nested: Vec<_> = (0..300).map(|i| cube(0.0, 0.0, 0.0, 10f64.powi(i - 150))).collect();
    built(&nested, 1);
    // Areas that overflow.
    nested.push(cube(-1e200, -1e200, -1e200, 1e200));
    built(&nested, 1);
    let largest = vec![Bounds { min: [f32::MIN; 3], max: [f32::MAX; 3] }; 100];
    built(&largest, 4);
}

#[test]
fn improper_boxes_are_left_out_and_poison_nobody() {
    let mut boxes = row(50);
    boxes[3].min[1] = f64::NAN;
    boxes[17].max[2] = f64::INFINITY;
    boxes[30] = Bounds::EMPTY;
    boxes[40] = Bounds { min: [1.0; 3], max: [0.0; 3] };
    let tree = built(&boxes, 4);
    assert_eq!(tree.left_out, 4);
    assert!(tree.nodes.iter().all(|node| node.bounds.is_proper()));
    assert_eq!(built(&[Bounds { min: [f32::NAN; 3], max: [f32::NAN; 3] }; 5], 4).nodes.len(), 0);
}

/// Every kind of damage is named.
#[test]
fn the_validator_finds_each_fault() {
    let boxes = row(40);
    let good = built(&boxes, 2);
    let leaf = good.nodes.iter().position(Node::is_leaf).unwrap();
    let inner = (1..good.nodes.len()).find(|&i| !good.nodes[i].is_leaf()).unwrap();
    let fault = |damage: &dyn Fn(&mut Tree<f64>)| {
        let mut tree = good.clone();
        damage(&mut tree);
        validate(&tree, &boxes).expect_err("damaged")
    };
    assert_eq!(fault(&|t| t.nodes[inner].first = 1000), Fault::NoSuchNode);
    assert_eq!(fault(&|t| t.nodes[inner].first = 0), Fault::BeforeParent);
    assert!(matches!(fault(&|t| t.nodes[inner].first = t.nodes[0].first + 1), Fault::TwoParents | Fault::BeforeParent));
    assert_eq!(fault(&|t| t.nodes.push(t.nodes[leaf])), Fault::Unreachable);
    assert_eq!(fault(&|t| t.nodes[leaf].first = 1000), Fault::NoSuchRun);
    assert_eq!(fault(&|t| t.order[0] = 1000), Fault::NoSuchPrimitive);
    assert!(matches!(fault(&|t| t.order[0] = t.order[1]), Fault::HeldTwice | Fault::WrongBox));
    assert_eq!(fault(&|t| t.left_out = 1), Fault::Missing);
    assert_eq!(fault(&|t| t.nodes[leaf].bounds.max[0] += 1e-9), Fault::WrongBox);
    assert_eq!(fault(&|t| t.nodes[leaf].bounds.min[0] += 1e-9), Fault::WrongBox);
    let everywhere = Bounds { min: [0.0; 3], max: [1.0; 3] };
    assert!(validate(&chain(MAX_DEPTH), &[everywhere; MAX_DEPTH + 1]).is_ok());
    assert_eq!(validate(&chain(MAX_DEPTH + 1), &[everywhere; MAX_DEPTH + 2]), Err(Fault::TooDeep));
}

/// A tree that peels off one primitive a level.
fn chain(depth: usize) -> Tree<f64> {
    let bounds = Bounds { min: [0.0; 3], max: [1.0; 3] };
    let leaf = |first: usize| Node { bounds, first: first as u32, count: 1 };
    let mut nodes = vec![];
    for level in 0..depth {
        // The inner node of level k > 0 stands at 2k − 1, its sibling leaf at 2k.
        nodes.push(Node { bounds, first: 2 * level as u32 + 1, count: 0 });
        if level > 0 {
            nodes.push(leaf(level - 1));
        }
    }
    nodes.extend([leaf(depth - 1), leaf(depth)]);
    Tree { nodes, order: (0..=depth as u32).collect(), left_out: 0 }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, rng_seed: proptest::test_runner::RngSeed::Fixed(7), failure_persistence: None, ..ProptestConfig::default() })]

    /// Any boxes, some of them equal, flat or not a number.
    #[test]
    fn any_boxes_make_a_valid_tree(
        raw in prop::collection::vec((prop::array::uniform3(-3i32..3), prop::array::uniform3(0u32..3), 0u32..40), 0..200),
        max_leaf in 1usize..9,
    ) {
        let boxes: Vec<Bounds<f32>> = raw
            .iter()
            .map(|&(low, extent, kind)| {
                let min = low.map(|x| if kind == 0 { f32::NAN } else { x as f32 });
                Bounds { min, max: std::array::from_fn(|a| min[a] + extent[a] as f32) }
            })
            .collect();
        let tree = build(&boxes, &BvhSettings { max_leaf, ..BvhSettings::default() });
        let census = validate(&tree, &boxes).unwrap();
        prop_assert!(census.fullest <= max_leaf);
        prop_assert_eq!(&tree, &build(&boxes, &BvhSettings { max_leaf, ..BvhSettings::default() }));
    }
}

#[test]
fn long_needles_make_no_deep_tree_and_no_slow_one() {
    // Through a cube, each from one point of it to another.
    let random = &mut StdRng::seed_from_u64(8);
    let mut anywhere = || DVec3::from_array(std::array::from_fn(|_| random.random_range(-1.0..1.0)));
    let mut needle = || {
        let (from, to, aside) = (anywhere(), anywhere(), anywhere());
        [from, from + (to - from).cross(aside).normalize_or(DVec3::Z) * 2e-4, to].map(|corner| corner.as_vec3().to_array())
    };
    let boxes: Vec<Bounds<f32>> = (0..5000).map(|_| Bounds::around(needle())).collect();
    let tree = build(&boxes, &BvhSettings::default());
    validate(&tree, &boxes).unwrap();
    // The heuristic finds hardly a plane that parts them, and might take one away at a time: each level looks at all of its needles again.
    let mut looked = 0;
    let mut open = vec![(0, 1)];
    while let Some((at, level)) = open.pop() {
        let node = &tree.nodes[at];
        if node.is_leaf() {
            looked += level * node.run().len();
        } else {
            open.extend(node.children().map(|child| (child, level + 1)));
        }
    }
    let levels = looked as f64 / boxes.len() as f64;
    assert!(levels < 40.0, "each needle is looked at in {levels} nodes");
}
