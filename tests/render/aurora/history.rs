//! The aurora's history on the GPU: a ring of rows of which a step writes one, and the place between nodes in both languages.

use glam::DVec2;
use lensrunner::render::aurora::node_history::{NodeHistory, NodeRow, ROW, ROWS, row};
use lensrunner::render::aurora::{AuroraSettings, CurtainNode, Segment};
use lensrunner::render::gpu::layout;
use lensrunner::render::gpu::shaders::Pass;
use lensrunner::render::stage::{Stage, settings};
use lensrunner::scene::aurora::curve::between_nodes;
use lensrunner::scene::aurora::motion::Node;
use lensrunner::scene::aurora::random::uniform;
use lensrunner::scene::{self, GameConfig};

use crate::gpu::GPU;
use crate::render::support::renderer;
use crate::twin::{run, run_with};

/// Nodes of a row of the tests.
const NODES: u32 = 16;

/// Nodes on their way round a circle, each row elsewhere.
fn nodes(number: u32) -> NodeRow {
    row((0..NODES).map(move |k| {
        let random = |which: u32| f64::from(uniform(number, k, which));
        let place = DVec2::from_angle(0.4 * f64::from(k)) * (2000.0 + 20.0 * random(0)) + 0.1 * f64::from(number);
        Node { place, flux: 1.0 + random(1), along: 6.0 * f64::from(k) }
    }))
}

#[test]
fn a_step_writes_one_row() {
    let mut rows = NodeHistory::still(nodes(0));
    for step in 1..=300 {
        let before = rows.clone();
        rows.push(nodes(step));
        let changed: Vec<usize> = rows.changed(&before).map(|(slot, _)| slot).collect();
        assert_eq!(changed, [rows.newest()], "step {step}");
        // What was the newest is the one before it now, and so on, back to where there was nothing.
        assert!((1..ROWS).all(|k| rows.ago(k) == before.ago(k - 1)));
    }
    assert_eq!(rows.changed(&NodeHistory::default()).count(), ROWS);
    // A watched aurora: a frame makes two rows at most.
    let mut renderer = renderer([96, 54]);
    let (scene, config) = (scene::load("aurora-orbit").unwrap(), GameConfig::default());
    let mut stage = Stage::new(&mut renderer, &scene, &config).watched();
    let mut history = |time: f64| {
        let frame = stage.frame(stage.camera(time, &[]), [96, 54], time, &[], None, &settings(&config));
        frame.aurora.unwrap().rows
    };
    let frames: Vec<NodeHistory> = (0..12).map(|k| history(0.05 * f64::from(k))).collect();
    assert!(frames.windows(2).all(|pair| pair[1].changed(&pair[0]).count() <= 2));
    assert!(frames[11].changed(&frames[0]).count() >= 2);
}

#[test]
fn the_ring_of_rows_is_read_the_same_in_both_languages() {
    let mut rows = NodeHistory::still(nodes(0));
    let uniform_buffer = layout::buffer(&GPU.device, "aurora", size_of::<AuroraSettings>() as u64, wgpu::BufferUsages::UNIFORM);
    for pushed in [0, 1, 50, 130] {
        (0..pushed).for_each(|step| rows.push(nodes(1000 * pushed + step)));
        let (row_nodes, newest_row) = (rows.ago(0).len() as u32, rows.newest() as u32);
        let settings = AuroraSettings { row_nodes, newest_row, row_seconds: ROW as f32, ..Default::default() };
        GPU.queue.write_buffer(&uniform_buffer, 0, bytemuck::bytes_of(&settings));
        let slots: Vec<CurtainNode> = rows.slots().iter().flat_map(|row| row.iter().copied()).collect();
        let slots = layout::storage(&GPU, "nodes", &slots);
        // A node, an age from the newest row to before the oldest, and the part of a curtain that begins with it.
        let input: Vec<[f32; 4]> = (0..400u32).map(|k| [(1 + k % 8) as f32, 0.35 * k as f32 - 1.0, (1 + k % 6) as f32, 0.0]).collect();
        let body = "#import lensrunner::aurora::streaks::{middle_of, Segment}
    var part: Segment; part.first_node = u32(row.x); part.span = u32(row.z); \
                    twin_out[id.x] = vec4<f32>(node_at(u32(row.x), row.y).place, middle_of(part, row.y));";
        let got = run_with(Pass::AuroraEnds, body, [&[], &[]], &[(0, &uniform_buffer), (2, &slots)], &input, 1);
        for (row, got) in input.iter().zip(got) {
            let age = f64::from(row[1]);
            let part = Segment { first_node: row[0] as u32, span: row[2] as u32, ..Default::default() };
            let want = [rows.node_at(row[0] as usize, age), rows.middle_of(&part, age)];
            let got = [DVec2::new(got[0].into(), got[1].into()), DVec2::new(got[2].into(), got[3].into())];
            // f32 at 2000 km is good to 0.1 m, and the clock of 127 s to 10 µs, in which these nodes move by 0.2 m.
            assert!(got[0].distance(want[0]) < 2e-3 && got[1].distance(want[1]) < 2e-3, "{row:?}: {got:?} on the GPU, {want:?} in Rust");
        }
    }
}

#[test]
fn between_nodes_both_languages_have_the_same_curve() {
    let input: Vec<[f32; 4]> = (0..300u32)
        .flat_map(|k| {
            let random = |number: u32| uniform(7, k, number);
            // Nodes some kilometres from one another, here and there two at one place.
            let node = |number: u32| [12.0 * random(2 * number), 12.0 * random(2 * number + 1)];
            let [before, a, b, after] = [node(0), node(1), if k % 11 == 0 { node(1) } else { node(2) }, node(3)];
            [[before[0], before[1], a[0], a[1]], [b[0], b[1], after[0], after[1]], [random(20), 0.0, 0.0, 0.0], [0.0; 4]]
        })
        .collect();
    let body = "let first = 4u * (id.x / 4u); let one = twin_rows[first]; let two = twin_rows[first + 1u]; \
                twin_out[id.x] = between_nodes(one.xy, one.zw, two.xy, two.zw, twin_rows[first + 2u].x);";
    let got = run(Pass::AuroraEnds, body, [&[], &[]], &input, 1);
    for (row, got) in input.chunks(4).zip(got.chunks(4)) {
        let node = |row: [f32; 4], k: usize| DVec2::new(f64::from(row[k]), f64::from(row[k + 1]));
        let [place, step] = between_nodes([node(row[0], 0), node(row[0], 2), node(row[1], 0), node(row[1], 2)], f64::from(row[2][0]));
        // A few roundings of numbers up to 12.
        assert!(
            node(got[0], 0).distance(place) < 2e-5 && node(got[0], 2).distance(step) < 1e-4,
            "{row:?}: {got:?}, {place} {step} in Rust"
        );
    }
}

#[test]
fn rows_written_one_by_one_are_drawn_as_all_at_once() {
    let size = [192, 108];
    let scene = scene::load("aurora-below").unwrap();
    let mut config = GameConfig::default();
    config.aurora.streaks = 3000;
    let (mut renderer, mut other) = (renderer(size), renderer(size));
    let mut stage = Stage::new(&mut renderer, &scene, &config);
    let mut draw = |seconds: f64| {
        let time = seconds / config.aurora.pace;
        // The camera goes with the planet.
        let mut frame = stage.frame(stage.camera(time, &[]), size, time, &[], None, &settings(&config));
        (frame.settings.stars, frame.settings.milky_way, frame.settings.bloom) = (false, false, 0.0);
        (renderer.picture(&frame, false).unwrap().linear, frame)
    };
    let (first, _) = draw(0.0);
    // 40 rows later in several frames, some of which make several rows.
    for seconds in [1.0, 2.0, 2.2, 10.0, 10.5, 11.5, 39.0] {
        draw(seconds);
    }
    let (got, frame) = draw(40.0);
    let want = other.picture(&frame, false).unwrap().linear;
    let most = want.iter().flat_map(|p| &p[..3]).copied().fold(0.0, f32::max);
    let apart = |one: &[[f32; 4]]| one.iter().zip(&want).map(|(a, b)| (a[1] - b[1]).abs() / most).fold(0.0, f32::max);
    println!("{} of the brightest from what was uploaded at once, {} from the picture before", apart(&got), apart(&first));
    // Threads append strokes in any order, and sums are rounded: measured 0. What has moved: measured 0.99.
    assert!(most > 0.1 && apart(&got) < 0.005 && apart(&first) > 0.5);
}
