//! Where a point is seen, against the picture that shows it.

use lensrunner::judge::case::Case;
use lensrunner::scene::{GameConfig, Scene};
use lensrunner_lab::compare::measure::probe::{Probe, probe};

/// A ball behind the hole beside the axis and a ship that comes from beside the camera, which moves too.
const SCENE: &str = r#"
[camera]
position = [0.0, 1.0, 9.0]
momentum = [0.3, 0.0, -0.2]
look = [0.0, 0.0, -1.0]
fov = 70.0
[[prop]]
name = "ball"
model = "sphere"
position = [0.3, 0.2, -6.0]
size = 2.0
triangles = 1200
[[ship]]
name = "fast"
model = "hunter.glb"
ai = "none"
position = [0.1, 1.0, 7.6]
momentum = [0.1, 0.0, -0.8]
"#;

#[test]
fn a_point_is_seen_where_the_picture_shows_it() {
    let scene = Scene::from_toml("sight.toml".as_ref(), SCENE).unwrap();
    let case = Case::new(scene, GameConfig::default(), 0.0, [96, 64]);
    let probe = probe(&case, 1e-13);
    let mut counts = [[0; 3]; 2];
    for y in 0..64 {
        for x in 0..96 {
            let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let Some(point) = probe.at(x, y).filter(|point| point.order <= 3) else { continue };
            counts[point.object as usize - 1][point.order as usize - 1] += 1;
            let place = probe.place(&point).unwrap();
            let off = (place.x - x).hypot(place.y - y);
            // Both integrate to 1e-13; at the third order the photon sphere magnifies that by 1e5.
            assert!(off < 1e-6, "{point:?} at ({x}, {y}): seen {off} px away");
        }
    }
    // Measured 115 and 42 pixels of the ball.
    assert!(counts[0][0] > 10 && counts[1][0] > 50 && counts[1][1] > 20, "{counts:?}");
}
