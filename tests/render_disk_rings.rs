//! The rings of the drawn disk: how the gas goes from one circle to the next.

use std::f64::consts::PI;

use glam::DVec3;
use lensrunner::lensing::Slice;
use lensrunner::render::disk::Disk;
use lensrunner::render::disk::rows::{AZIMUTHS, Look, azimuth};
use lensrunner::render::frame::FrameInput;
use lensrunner::render::shaders::Pass;
use lensrunner::render::stage::static_camera;
use lensrunner::scene::GameConfig;
use lensrunner::spacetime::light::Order;

use crate::render_disk::{a_disk, exact};
use crate::render_support::{camera, renderer, settings};
use crate::twin::run;

/// The azimuths at which bends are told are the same in both languages, the first of them and the last too.
#[test]
fn bends_are_told_at_the_same_azimuths_in_both_languages() {
    let rows: Vec<[f32; 4]> = (0..AZIMUTHS).map(|k| [azimuth(k) as f32, 0.0, 0.0, 0.0]).collect();
    let body = "twin_out[id.x] = vec4<f32>(among_azimuths(row.x), FIRST_AZIMUTH, FROM_LAST_AZIMUTH);";
    for (k, got) in run(Pass::DiskVertices, body, [&[], &[]], &rows, 1).into_iter().enumerate() {
        let [before, share, first, last] = got.map(f64::from);
        // A root of single precision, of which twelve are made.
        assert!((before + share - k as f64).abs() < 1e-5, "azimuth {k} is {before} + {share}");
        assert!((first - azimuth(0)).abs() < 1e-9 && (last - (PI - azimuth(AZIMUTHS - 1))).abs() < 1e-7, "{first}, {last}");
    }
}

/// What the rows of an order are chosen by, the light of a circle at azimuths on both sides, is that of the exact ray to there: ln of it is −26,160 K/gT.
#[test]
fn the_light_of_circles_is_that_of_exact_rays() {
    let disk = a_disk();
    let renderer = renderer([64, 36]);
    for (l, degrees) in [(22.0, 80.0), (22.0, 40.0), (7.0, 95.0)] {
        let camera = camera(l, degrees, 60f64.to_radians());
        let slice = Slice::new(renderer.table(), l);
        let origin = camera.position.y.atan2(camera.position.x);
        for order in 1..=3 {
            let look = Look { disk: &disk, camera: &camera, slice: &slice, order, width: 1280, beaming: true };
            for r in [2.5, 4.0, 9.0] {
                let circle = look.circle(r);
                for (k, sides) in circle.log_light.iter().enumerate() {
                    for (side, got) in [1.0, -1.0].into_iter().zip(sides) {
                        let Some((_, g)) = exact(&disk.gas, &camera, r, origin + side * azimuth(k), Order::ALL[order as usize - 1]) else {
                            continue;
                        };
                        let want = -26_160.0 / (g * disk.gas.radial.temperature(r));
                        assert!(
                            (got / want - 1.0).abs() < 1e-3,
                            "L = {l}, {degrees}°, order {order}, r = {r}, azimuth {k}, side {side}: {got}, must be {want}"
                        );
                    }
                }
            }
        }
    }
}

/// Slivers of thin images hardly touch the pixels that they are drawn in, and what is interpolated there may be anything: a disk ten times as wide as the camera's
/// distance has its height in the pattern far beyond where the orbits' rate is a number. No pixel is without one.
#[test]
fn every_pixel_of_a_wide_disk_is_a_number() {
    let size = [640, 360];
    let mut renderer = renderer(size);
    for (gap, turbulence) in [(0.0, 1.0), (0.0, 0.0), (0.01, 1.0)] {
        let mut config = GameConfig::default();
        (config.disk.outer, config.disk.gap, config.disk.turbulence) = (200.0, gap, turbulence);
        renderer.set_disk(Some(Disk::new(config.disk.clone(), &config)));
        for degrees in [80.0, 60.0, 30.0] {
            let input = FrameInput {
                camera: camera(27.0, degrees, 60f64.to_radians()),
                time: 100.0,
                placed: Vec::new(),
                aurora: None,
                settings: settings(),
            };
            let linear = renderer.picture(&input, false).unwrap().linear;
            let none = linear.iter().flatten().filter(|value| !value.is_finite()).count();
            assert_eq!(none, 0, "{none} values that are no number with a gap of {gap} from {degrees}°");
        }
    }
}

/// A camera next to the plane sees no edge where the azimuth changes its sign: light is bent over a ring by another amount on either side, and both meet there.
#[test]
fn no_edge_is_seen_where_the_azimuth_changes_its_sign() {
    let size = [320, 180];
    let mut config = GameConfig::default();
    config.disk.turbulence = 0.0;
    let mut renderer = renderer(size);
    renderer.set_disk(Some(Disk::new(config.disk.clone(), &config)));
    let camera = static_camera(DVec3::new(0.0, -8.0, -0.05), DVec3::new(0.5, 1.0, -0.1), DVec3::Z, 90f64.to_radians());
    let input = FrameInput { camera, time: 100.0, placed: Vec::new(), aurora: None, settings: settings() };
    let linear = renderer.picture(&input, false).unwrap().linear;
    let light = |x: u32, y: u32| f64::from(linear[(y * size[0] + x) as usize][1]);
    // The way to the hole is seen 26.6° left of the middle: tan of that, of 160 pixels. Light is smooth there: a step is no larger than those beside it.
    let column = 160 - 80;
    let mut worst = 0.0f64;
    for y in 30..70 {
        let step = |x: u32| light(x + 1, y) - light(x, y);
        let beside = [column - 6, column - 5, column + 4, column + 5].map(|x| step(x).abs()).into_iter().fold(0.0, f64::max);
        let most = (column - 2..=column + 2).map(|x| step(x).abs()).fold(0.0, f64::max);
        worst = worst.max((most - beside) / light(column, y));
    }
    println!("steps are larger by {worst:.4} of the light than those beside them");
    // 0.006; 0.2 where each side has its own light up to the first of the azimuths at which it is told.
    assert!(worst < 0.02, "{worst}");
}
