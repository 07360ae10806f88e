//! Where the judge is asked for a surface point.

use glam::{DVec2, DVec3};
use lensrunner::judge::picture::{Layer, TracedPicture};
use lensrunner_lab::compare::measure::displacement::{Effort, Measured, Point, Probe, displacements};
use lensrunner_lab::compare::{ContestantFrame, Shown};

/// A wall of which each point is its own place on the screen; before it, a rod a sixth of a pixel wide, whose points are far from the
/// wall's.
struct Rod;

/// From here to there on the screen.
const ROD: [f64; 2] = [2.72, 2.88];
const FAR: DVec3 = DVec3::new(500.0, 0.0, 0.0);

impl Probe for Rod {
    fn at(&self, x: f64, y: f64) -> Option<Point> {
        let place = DVec3::new(x, y, 0.0);
        let body = if (ROD[0]..ROD[1]).contains(&x) { place + FAR } else { place };
        Some(Point { object: 1, order: 1, body })
    }

    fn place(&self, point: &Point) -> Option<DVec2> {
        (point.body.x < FAR.x / 2.0).then(|| point.body.truncate())
    }

    fn body(&self, layer: &Layer) -> DVec3 {
        DVec3::new(f64::from(layer.uv[0]), f64::from(layer.uv[1]), 0.0)
    }

    fn off_body(&self, _: u32, body: DVec3) -> f64 {
        body.z.abs()
    }

    fn radius(&self, _: u32) -> f64 {
        1.0
    }

    fn is_dark(&self, _: f64, _: f64) -> bool {
        false
    }
}

#[test]
fn a_part_narrower_than_a_pixel_is_found_beside_the_centre() {
    let size = [5, 5];
    let centre = |i: usize| [(i % 5) as f32 + 0.5, (i / 5) as f32 + 0.5];
    let layers: Vec<Layer> = (0..25).map(|i| Layer { object: 1, order: 1, uv: centre(i), ..Layer::default() }).collect();
    let judge = TracedPicture {
        size,
        light: vec![[0.0; 3]; 25],
        layers,
        shares: vec![vec![(1, 1, 1.0)]; 25],
        open: vec![0.0; 25],
        dark: vec![false; 25],
        given_up: 0,
        missing: 0,
    };
    // The contestant shows the middle of the rod where the judge, a third of a pixel beside it, shows the wall.
    let mut shown: Vec<Shown> =
        (0..25).map(|i| Shown { object: 1, order: 1, body: [centre(i)[0], centre(i)[1], 0.0], coverage: 1.0 }).collect();
    shown[12].body = [502.8, 2.5, 0.0];
    // A point of nothing.
    shown[24].body = [4.5, 6.5, 1.0];
    let frame = ContestantFrame { size, light: vec![[0.0; 3]; 25], bare: vec![[0.0; 3]; 25], surfaces: vec![[0.0; 3]; 25], shown };
    let found = displacements(&judge, &frame, &Rod, &Effort::default());
    let Some(Measured::Pixels(rod)) = found[12] else { panic!("{:?}", found[12]) };
    assert!((rod - 0.3).abs() < 1e-3, "{rod}");
    assert!(matches!(found[6], Some(Measured::Pixels(wall)) if wall < 1e-3), "{:?}", found[6]);
    assert_eq!(found[24], Some(Measured::Nowhere));
}
