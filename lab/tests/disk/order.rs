//! Images of bodies before and behind the disk, of every order, thin or wide: what the gas between them and the camera leaves of their
//! light.

use glam::{DQuat, DVec3};
use lensrunner::render::Renderer;
use lensrunner::render::gpu::readback::ReadbackPicture;
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::{Stage, static_camera};
use lensrunner::scene::disk::Gas;
use lensrunner::scene::{GameConfig, Scene};
use lensrunner::spacetime::Observer;
use lensrunner_lab::disk::exact::{self, Crossing};

use crate::render_support::{renderer, settings};

const SIZE: [u32; 2] = [320, 180];

/// Gas that shines so little that it only takes light away, and the same at all azimuths.
fn dark(representation: &str) -> GameConfig {
    let mut config = GameConfig::default();
    config.disk.accretion_rate = 1e-18;
    config.disk.turbulence = 0.0;
    config.disk.opacity = 0.8;
    config.disk.representation = representation.into();
    config
}

/// A picture with layers of balls (place, model units to r_s) held round the hole, with a disk or without.
fn balls(
    renderer: &mut Renderer,
    camera: Observer,
    balls: &[(DVec3, f64)],
    config: &GameConfig,
    disk: bool,
    settings: &Settings,
) -> ReadbackPicture {
    let mut text = if disk { "[disk]\n" } else { "" }.to_string();
    for (k, (p, size)) in balls.iter().enumerate() {
        text += &format!(
            "[[prop]]\nname = \"ball {k}\"\nmodel = \"sphere\"\nposition = [{:.4}, {:.4}, {:.4}]\nsize = {size:.4}\n",
            p.x, p.y, p.z
        );
    }
    let scene = Scene::from_toml("order.toml".as_ref(), &text).unwrap();
    let mut stage = Stage::new(renderer, &scene, config);
    let frame = stage.frame(camera, SIZE, 0.0, &[], None, settings);
    renderer.picture(&frame, true).unwrap()
}

/// What is left of the light of the image of ball `number` (from 1) in `order`.
#[derive(Debug)]
struct Left {
    number: usize,
    order: u32,
    /// As it is drawn.
    drawn: f64,
    /// By the exact crossings of the rays through its pixels that have a shorter light path.
    exact: f64,
    /// Such crossings, and those beyond, in its pixel of most light.
    crossings: [usize; 2],
    /// Where it is, in pixels from the left and the top, and how many it takes.
    at: [f64; 2],
    light: f64,
}

/// Of all images of the balls that there are without a disk.
fn left(renderer: &mut Renderer, camera: Observer, all: &[(DVec3, f64)], config: &GameConfig, settings: &Settings) -> Vec<Left> {
    let with = balls(renderer, camera, all, config, true, settings);
    let alone = balls(renderer, camera, all, config, false, settings);
    let gas = Gas::new(&config.disk, config.hole.mass_solar);
    let image = |number: usize, order: u32| {
        let (mut drawn, mut exact, mut whole, mut most, mut crossings) = (0.0, 0.0, 0.0, 0.0, [0; 2]);
        let mut middle = [0.0; 2];
        for (k, layer) in alone.layers.iter().enumerate().filter(|(_, layer)| (layer[0], layer[1]) == (number as f32, order as f32)) {
            let light = f64::from(alone.linear[k][1]);
            let at = [k as u32 % SIZE[0], k as u32 / SIZE[0]].map(|c| f64::from(c) + 0.5);
            let all = exact::crossings(&gas, &camera, SIZE, at, 3);
            let before = all.iter().filter(|crossing| crossing.path < f64::from(layer[2]));
            let stops = |c: &Crossing| gas.emission(c.radius, c.azimuth, -c.path).opacity(c.cosine, c.path);
            drawn += f64::from(with.linear[k][1]);
            exact += light * before.clone().map(|crossing| 1.0 - stops(crossing)).product::<f64>();
            whole += light;
            middle = [0, 1].map(|c| middle[c] + light * at[c]);
            if light > most {
                (most, crossings) = (light, [before.clone().count(), all.len() - before.count()]);
            }
        }
        let at = middle.map(|c| c / whole);
        (whole > 0.0).then(|| Left { number, order, drawn: drawn / whole, exact: exact / whole, crossings, at, light: whole })
    };
    (1..=all.len()).flat_map(|number| [1, 2, 3].map(|order| image(number, order))).flatten().collect()
}

/// Places of balls before and behind the disk.
const PLACES: [DVec3; 7] = [
    DVec3::new(0.0, -12.2, 3.2),
    DVec3::new(0.0, -3.75, -2.0),
    DVec3::new(6.0, 4.0, 3.0),
    DVec3::new(6.0, 4.0, -3.0),
    DVec3::new(-6.0, 4.0, 8.0),
    DVec3::new(-6.0, -14.0, -8.0),
    DVec3::new(-6.0, -3.0, -2.0),
];

/// The images of balls of this size that a camera at `eye` sees which looks at the hole under `degrees`.
fn left_at_all(renderer: &mut Renderer, eye: DVec3, degrees: f64, size: f64, config: &GameConfig) -> Vec<Left> {
    let camera = static_camera(eye, -eye, DVec3::Z, degrees.to_radians());
    // The narrowest images are drawn too.
    let settings = Settings { least_width: 0.0, ..settings() };
    left(renderer, camera, &PLACES.map(|place| (place, size)), config, &settings)
}

/// The gas takes as much from thin images of ships as from wide ones (balls of 0.05 to 1 r_s), of every order: an image of order n is
/// behind n − 1 or n images of the disk.
#[test]
fn images_are_dimmed_by_what_of_the_disk_is_before_them() {
    let mut renderer = renderer(SIZE);
    let mut found = [[0; 4]; 4];
    let (above, below) = (DVec3::new(0.0, -20.0, 8.0), DVec3::new(0.0, -18.0, -20.0));
    for (representation, eye, degrees, orders) in
        [("arcs", above, 50.0, 1), ("arcs", above, 20.0, 3), ("arcs", below, 20.0, 2), ("sprites", above, 20.0, 2)]
    {
        let config = dark(representation);
        for size in [0.05, 0.3, 1.0] {
            // Third images of large balls are arcs far narrower than a pixel: what crosses the plane before and beyond them at a pixel's
            // middle is not what does in them.
            let seen = |left: &&Left| left.order <= orders && (left.order < 3 || size < 1.0);
            for left in left_at_all(&mut renderer, eye, degrees, size, &config).iter().filter(seen) {
                // The exact gas is that at the middle of a pixel, the drawn one the mean over the pixel where the disk's image is as thin,
                // as those of order 3 are, and of falling gas, which thins out within a tenth of r_s, the mean between two circles.
                let off = if left.order > 1 { 0.08 } else { 0.04 };
                let place = PLACES[left.number - 1];
                println!("{representation} from {eye} under {degrees}°, ball of {size} at {place}: {left:?}");
                assert!((left.drawn - left.exact).abs() < off);
                found[left.order as usize][left.crossings[0]] += 1;
            }
        }
    }
    for (order, crossings) in [(1, 0), (1, 1), (2, 1), (2, 2), (3, 2), (3, 3)] {
        assert!(found[order][crossings] > 0, "no image of order {order} behind {crossings} of the disk: {found:?}");
    }
}

/// Polygons are opaque and have depth: they hide all that is behind them.
#[test]
fn polygons_hide_thin_images_behind_them() {
    let mut renderer = renderer(SIZE);
    let eye = DVec3::new(0.0, -20.0, 8.0);
    for left in left_at_all(&mut renderer, eye, 50.0, 0.05, &dark("polygons-at-rest")).iter().filter(|left| left.order == 1) {
        let hidden = left.crossings[0] > 0;
        assert!(if hidden { left.drawn < 0.01 } else { left.drawn > 0.99 }, "{left:?}");
    }
}

/// That camera turned to a point of its picture and with so many pixels in one of those.
fn nearer(camera: &Observer, at: [f64; 2], times: f64) -> Observer {
    let [width, height] = SIZE.map(f64::from);
    let pixel = 2.0 * (0.5 * camera.field_of_view).tan() / width;
    let seen = DVec3::new((at[0] - 0.5 * width) * pixel, (0.5 * height - at[1]) * pixel, -1.0).normalize();
    let turn = DQuat::from_rotation_arc(DVec3::NEG_Z, seen);
    Observer { attitude: camera.attitude * turn, field_of_view: 2.0 * (0.5 * width * pixel / times).atan(), ..*camera }
}

/// Of a thin body that stands astride the disk's plane each part keeps what the gas before it leaves; the nearer part hides nothing of the
/// farther one.
///
/// A pixel with light of both parts has no one path. So what is right is counted by the exact gas in a picture in which such a body is some
/// fifty pixels wide. And a triangle that is drawn a pixel wide meets the middle of one pixel or of none: its light is right only in the
/// mean over the places in a pixel where it may be.
#[test]
fn a_thin_body_astride_the_disk_keeps_the_light_of_both_its_parts() {
    let mut renderer = renderer(SIZE);
    let mut config = dark("arcs");
    // Of light that passes through about half is left: of the farther part there is something to lose.
    config.disk.opacity = 0.2;
    let eye = DVec3::new(0.0, -20.0, 8.0);
    let camera = static_camera(eye, -eye, DVec3::Z, 50_f64.to_radians());
    // Heights of the middle over the body's radius, which is 1/2 in the model.
    let places = [(0.0, -6.0, 0.0), (6.0, 4.0, 0.0), (-8.0, 2.0, 0.0), (4.0, -6.0, -0.3), (8.0, 0.0, -0.7)];
    let balls = |size: f64| places.map(|(x, y, height)| (DVec3::new(x, y, 0.5 * height * size), size));
    let mut sums = [[0.0; 4]; 5];
    for k in 0..9 {
        let at = [160.0 + f64::from(k % 3) / 3.0, 90.0 + f64::from(k / 3) / 3.0];
        for left in left(&mut renderer, nearer(&camera, at, 1.0), &balls(0.05), &config, &settings()).iter().filter(|left| left.order == 1)
        {
            let [x, y] = [0, 1].map(|c| left.at[c] + at[c] - 0.5 * f64::from(SIZE[c]));
            let sum = [left.drawn, 1.0, x, y].map(|value| value * left.light);
            sums[left.number - 1] = std::array::from_fn(|c| sums[left.number - 1][c] + sum[c]);
        }
    }
    for ([drawn, light, x, y], ball) in sums.into_iter().zip(balls(0.2)) {
        let drawn = drawn / light;
        let wide = &left(&mut renderer, nearer(&camera, [x / light, y / light], 12.0), &[ball], &config, &settings())[0];
        println!("ball at {}: {drawn:.3} of its light is left, {:.3} by the exact gas", ball.0, wide.exact);
        // Half an hundredth for nine places in a pixel, and as much for fifty pixels across the body that tells.
        assert!((drawn - wide.exact).abs() < 0.02);
    }
}
