//! The rings of the drawn disk: how the gas goes from one circle to the next.

use std::f64::consts::PI;

use glam::DVec3;
use lensrunner::lensing::Slice;
use lensrunner::render::Renderer;
use lensrunner::render::disk::DrawnDisk;
use lensrunner::render::disk::circles::{AZIMUTHS, Look, SeenCircle, azimuth, pixel_angle, radii};
use lensrunner::render::disk::view::DiskView;
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::shaders::Pass;
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::static_camera;
use lensrunner::scene::GameConfig;
use lensrunner::scene::disk::PATTERN_HEIGHT;
use lensrunner::spacetime::light::Order;

use crate::render::disk::arcs::exact;
use crate::render::support::{a_disk, camera, renderer, settings, total};
use crate::support::shared_table;
use crate::twin::run;

/// The azimuths at which bends are told are the same in both languages, the first of them and the last too.
#[test]
fn bends_are_told_at_the_same_azimuths_in_both_languages() {
    let rows: Vec<[f32; 4]> = (0..AZIMUTHS).map(|k| [azimuth(k) as f32, 0.0, 0.0, 0.0]).collect();
    let body = "#import lensrunner::disk::arcs::place::{among_azimuths, FIRST_AZIMUTH, FROM_LAST_AZIMUTH}
    twin_out[id.x] = vec4<f32>(among_azimuths(row.x), FIRST_AZIMUTH, FROM_LAST_AZIMUTH);";
    for (k, got) in run(Pass::DiskVertices, body, [&[], &[]], &rows, 1).into_iter().enumerate() {
        let [before, share, first, last] = got.map(f64::from);
        // A root of single precision, of which twelve are made.
        assert!((before + share - k as f64).abs() < 1e-5, "azimuth {k} is {before} + {share}");
        assert!((first - azimuth(0)).abs() < 1e-9 && (last - (PI - azimuth(AZIMUTHS - 1))).abs() < 1e-7, "{first}, {last}");
    }
}

/// What the rows of an order are chosen by, the light of a circle at azimuths on both sides, is that of the exact ray to there: ln of it is
/// −26,160 K/gT.
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

/// From near, rings of order 1 are held to 0.1 pixels across the orbits, 1 along them, 0.001 of the light of the brightest gas at the same
/// azimuth and 0.005 of the light from behind. So they are at all circles between their own two that there were to choose from: what goes
/// straight over a ring, and as a parabola, against the gas itself. Rings with fewer than two circles between are left out: the parabola
/// goes through one by itself.
#[test]
fn rings_from_near_are_as_true_as_they_are_held_to_be() {
    const WIDTH: u32 = 1280;
    let disk = a_disk();
    let radial = &disk.gas.radial;
    let all = radii(&disk, true);
    let table = shared_table();
    // The scenes `disk-skim` and `disk-inner`.
    let skim = static_camera(DVec3::new(0.0, -6.5, 0.3), DVec3::new(-0.75, 0.66, -0.06), DVec3::Z, 80f64.to_radians());
    let inner = static_camera(DVec3::new(0.0, -3.3, 0.5), DVec3::new(0.9, 0.55, -0.1), DVec3::Z, 90f64.to_radians());
    for camera in [skim, inner] {
        let slice = Slice::new(&table, camera.radius());
        let input = FrameInput { camera, time: 100.0, placed: Vec::new(), held: None, aurora: None, settings: settings() };
        let view = DiskView::new(&disk, &input, &slice, WIDTH);
        let look = Look { disk: &disk, camera: &camera, slice: &slice, order: 1, width: WIDTH, beaming: true };
        let pixel = pixel_angle(&camera, WIDTH);
        // Seen face on, and from where the camera is.
        let slants = [1.0, camera.radius() / camera.position.z.abs()];
        let light = |circle: &SeenCircle, k: usize, side: usize| circle.log_light[k][side].exp();
        let seen: Vec<SeenCircle> = all.iter().map(|&r| look.circle(r)).collect();
        let shining = |k: usize, side: usize| seen.iter().map(|c| light(c, k, side) * radial.depth(c.radius).min(1.0)).fold(0.0, f64::max);
        let brightest: [[f64; 2]; AZIMUTHS] = std::array::from_fn(|k| [0, 1].map(|side| shining(k, side)));
        let index = |row: u32| {
            let radius = f64::from(view.circles[row as usize].gas.radius);
            all.iter().position(|r| (r - radius).abs() < 1e-4).expect("one of the circles")
        };
        let (mut worst, mut rings) = ([0.0f64; 4], 0);
        for ring in view.rings.iter().filter(|ring| ring.order == 1) {
            let [from, to] = [ring.inner, ring.outer].map(index);
            if to < from + 3 {
                continue;
            }
            rings += 1;
            let (a, b) = (&seen[from], &seen[to]);
            for here in &seen[from + 1..to] {
                let r = here.radius;
                for (k, brightest) in brightest.iter().enumerate() {
                    let [place, start, end] = [here, a, b].map(|circle| circle.places[k]);
                    let (before, after) = (place.perp_dot(start), place.perp_dot(end));
                    let t = before / (before - after);
                    assert!(t > 0.0 && t < 1.0, "r = {r}, azimuth {k}: seen at {t} of the ring");
                    let parabola = |start: f64, end: f64, bend: f64| start + t * (end - start) + 4.0 * t * (1.0 - t) * bend;
                    let bend = view.bends[ring.inner as usize * AZIMUTHS + k];
                    let [height, bent, bent_too, depth] = [bend.height, bend.light, bend.other_light, bend.depth].map(f64::from);
                    let of = |value: &dyn Fn(f64) -> f64, bend: f64| parabola(value(a.radius), value(b.radius), bend) - value(r);
                    // The pattern's radius goes as its height's exponential. Gas whose light is older is turned back.
                    let aside = radial.pattern_radius(r) * of(&|r| radial.pattern_radius(r).ln(), PATTERN_HEIGHT * height).abs();
                    let older = parabola(start.length(), end.length(), 0.0) - place.length();
                    let ahead = of(&|r| radial.lag(r), 0.0).abs() + radial.turning_rate(r) * older.abs();
                    let wide = a.angle_to(b, k) / pixel;
                    worst[0] = worst[0].max(aside * wide / (b.radius - a.radius));
                    worst[1] = worst[1].max(ahead * r / place.length() / pixel * wide.min(1.0));
                    let line = parabola(radial.depth(a.radius), radial.depth(b.radius), 0.0);
                    let drawn = (line * (1.0 + 4.0 * t * (1.0 - t) * depth)).max(0.0);
                    for slant in slants {
                        let [got, want] = [drawn, radial.depth(r)].map(|depth| 1.0 - (-slant * depth).exp());
                        worst[3] = worst[3].max((got - want).abs() * wide.min(1.0));
                        for (side, bent) in [bent, bent_too].into_iter().enumerate() {
                            let line = parabola(a.log_light[k][side], b.log_light[k][side], 0.0);
                            let shown = (line * (1.0 - 4.0 * t * (1.0 - t) * bent)).exp();
                            let off = (shown * got - light(here, k, side) * want).abs() * wide.min(1.0);
                            worst[2] = worst[2].max(off / brightest[side]);
                        }
                    }
                }
            }
        }
        println!("{rings} rings: {worst:.5?} across, along, of light, of what is stopped");
        assert!(rings > 5);
        for (worst, bound) in worst.into_iter().zip([0.1, 1.0, 0.001, 0.005]) {
            // Circles that were not tried are off by up to a quarter more.
            assert!(worst < 1.3 * bound, "off by {worst}, must be {bound}");
        }
    }
}

/// Slivers of thin images hardly touch the pixels that they are drawn in, and what is interpolated there may be anything: a disk ten times
/// as wide as the camera's distance has its height in the pattern far beyond where the orbits' rate is a number. No pixel is without one.
#[test]
fn every_pixel_of_a_wide_disk_is_a_number() {
    let size = [640, 360];
    let mut renderer = renderer(size);
    for (gap, turbulence) in [(0.0, 1.0), (0.0, 0.0), (0.01, 1.0)] {
        let mut config = GameConfig::default();
        (config.disk.outer, config.disk.gap, config.disk.turbulence) = (200.0, gap, turbulence);
        renderer.set_disk(Some(DrawnDisk::new(config.disk.clone(), &config)));
        for degrees in [80.0, 60.0, 30.0] {
            let input = FrameInput {
                camera: camera(27.0, degrees, 60f64.to_radians()),
                time: 100.0,
                placed: Vec::new(),
                held: None,
                aurora: None,
                settings: settings(),
            };
            let linear = renderer.picture(&input, false).unwrap().linear;
            let none = linear.iter().flatten().filter(|value| !value.is_finite()).count();
            assert_eq!(none, 0, "{none} values that are no number with a gap of {gap} from {degrees}°");
        }
    }
}

/// A camera next to the plane sees no edge where the azimuth changes its sign: light is bent over a ring by another amount on either side,
/// and both meet there.
#[test]
fn no_edge_is_seen_where_the_azimuth_changes_its_sign() {
    let size = [320, 180];
    let mut config = GameConfig::default();
    config.disk.turbulence = 0.0;
    let mut renderer = renderer(size);
    renderer.set_disk(Some(DrawnDisk::new(config.disk.clone(), &config)));
    let camera = static_camera(DVec3::new(0.0, -8.0, -0.05), DVec3::new(0.5, 1.0, -0.1), DVec3::Z, 90f64.to_radians());
    let input = FrameInput { camera, time: 100.0, placed: Vec::new(), held: None, aurora: None, settings: settings() };
    let linear = renderer.picture(&input, false).unwrap().linear;
    let light = |x: u32, y: u32| f64::from(linear[(y * size[0] + x) as usize][1]);
    // The way to the hole is seen 26.6° left of the middle: tan of that, of 160 pixels. Light is smooth there: a step is no larger than
    // those beside it.
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
    assert!(worst < 0.02);
}

/// What the dial may leave out of the disk: wider rings are fewer, and neither they nor fewer looks along a pixel change its light.
#[test]
fn a_disk_with_less_in_it_is_as_bright() {
    let size = [320, 180];
    let mut renderer = renderer(size);
    let disk = a_disk();
    renderer.set_disk(Some(disk.clone()));
    for (l, degrees) in [(22.0, 80.0), (6.5, 86.0)] {
        let of = |ring_error, gas_looks| FrameInput {
            camera: camera(l, degrees, 60f64.to_radians()),
            time: 100.0,
            placed: Vec::new(),
            held: None,
            aurora: None,
            settings: Settings { ring_error, gas_looks, ..settings() },
        };
        let rings = |input: &FrameInput| DiskView::new(&disk, input, &Slice::new(&shared_table(), l), size[0]).rings.len();
        let finest = of(1.0, 16.0);
        let light = |renderer: &mut Renderer, input: &FrameInput| total(&renderer.picture(input, false).unwrap());
        let whole = light(&mut renderer, &finest);
        for (ring_error, gas_looks) in [(8.0, 16.0), (1.0, 4.0), (1.0, 1.0), (8.0, 1.0)] {
            let less = of(ring_error, gas_looks);
            let change = light(&mut renderer, &less) / whole - 1.0;
            println!(
                "L = {l}, {ring_error} times the error, {gas_looks} looks: {} of {} rings, light {change:+.4}",
                rings(&less),
                rings(&finest)
            );
            assert_eq!(rings(&less) < rings(&finest), ring_error > 1.0);
            // From far there are two looks anyway. A mean over a frame of streaks and their chance.
            let same = ring_error == 1.0 && l > 10.0;
            assert!((change == 0.0) == same && change.abs() < 0.03, "{change}");
        }
    }
}
