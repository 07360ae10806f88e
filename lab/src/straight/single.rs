//! One ray through the binary tree: the plain method that the others are held against.

use super::bounds::Bounds;
use super::build::{BvhSettings, build};
use super::ray::{Hit, Ray, Slabs, widening};
use super::tree::{MAX_DEPTH, Tree};
use super::triangle::Shear;

/// Triangles under a binary tree of boxes.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// The tree over the triangles' boxes.
    pub tree: Tree<f32>,
    /// Corners, in the order of the leaves (as [`Tree::order`]).
    pub corners: Vec<[[f32; 3]; 3]>,
}

impl Mesh {
    /// Builds the tree of Sei 2008. Triangles with a corner that is not finite are left out: no ray meets them.
    pub fn new(triangles: &[[[f32; 3]; 3]], settings: &BvhSettings) -> Mesh {
        let boxes: Vec<Bounds<f32>> = triangles.iter().map(bounds).collect();
        let tree = build(&boxes, settings);
        let corners = tree.order.iter().map(|&i| triangles[i as usize]).collect();
        Mesh { tree, corners }
    }

    /// The nearest triangle that a ray meets.
    pub fn closest(&self, ray: &Ray) -> Hit {
        self.descend(ray, |_| ())
    }

    /// The same, and how many boxes were tested.
    pub fn closest_counted(&self, ray: &Ray) -> (Hit, usize) {
        let mut boxes = 0;
        (self.descend(ray, |more| boxes += more), boxes)
    }

    #[inline]
    fn descend(&self, ray: &Ray, mut count: impl FnMut(usize)) -> Hit {
        let mut best = Hit::MISS;
        let Some(root) = self.tree.nodes.first() else { return best };
        let slabs = Slabs::new(ray, widening(&root.bounds, ray.origin));
        let shear = Shear::new(ray);
        let mut stack = [(0usize, 0f32); MAX_DEPTH + 1];
        let mut height = 0;
        if let Some(enter) = slabs.enter(&root.bounds, ray.until) {
            stack[0] = (0, enter);
            height = 1;
        }
        while height > 0 {
            height -= 1;
            let (mut at, enter) = stack[height];
            // Only what starts behind the best hit is skipped: at the same t a lower number may win.
            if enter > best.t {
                continue;
            }
            loop {
                let node = &self.tree.nodes[at];
                if node.is_leaf() {
                    for place in node.run() {
                        shear.update(&self.corners[place], self.tree.order[place], ray.until, &mut best);
                    }
                    break;
                }
                count(2);
                let until = ray.until.min(best.t);
                let [left, right] = node.children();
                let enters = [left, right].map(|child| slabs.enter(&self.tree.nodes[child].bounds, until));
                at = match enters {
                    [None, None] => break,
                    [Some(_), None] => left,
                    [None, Some(_)] => right,
                    [Some(l), Some(r)] => {
                        let (near, far) = if l <= r { (left, (right, r)) } else { (right, (left, l)) };
                        stack[height] = far;
                        height += 1;
                        near
                    }
                };
            }
        }
        best
    }
}

/// The box of a triangle.
pub fn bounds(corners: &[[f32; 3]; 3]) -> Bounds<f32> {
    if corners.iter().flatten().all(|c| c.is_finite()) {
        Bounds::around(*corners)
    } else {
        // A NaN would not show in the smallest box.
        Bounds::EMPTY
    }
}
