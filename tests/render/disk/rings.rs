//! The rings of the drawn disk: how the gas goes from one circle to the next.

use std::f64::consts::PI;

use glam::DVec3;
use lensrunner::lensing::Slice;
use lensrunner::render::Renderer;
use lensrunner::render::disk::DrawnDisk;
use lensrunner::render::disk::circles::{AZIMUTHS, CircleGas, Look, SeenCircle, azimuth, radii};
use lensrunner::render::disk::types::Ring;
use lensrunner::render::disk::view::{DiskView, own_shares};
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::shaders::Pass;
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::static_camera;
use lensrunner::scene::GameConfig;
use lensrunner::scene::disk::{LEAST_COSINE, PATTERN_HEIGHT};
use lensrunner::spacetime::Observer;
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
            let look = Look::new(&camera, &slice, order, 1280, true);
            for r in [2.5, 4.0, 9.0] {
                let circle = look.circle(&CircleGas::at(&disk, r));
                for (side, lights) in [1.0, -1.0].into_iter().zip(circle.log_light) {
                    for (k, got) in lights.into_iter().enumerate() {
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

/// The circles of a disk as one image order shows them, to measure rings by.
struct Measure<'a> {
    disk: &'a DrawnDisk,
    look: Look<'a>,
    /// The circles on offer.
    offered: Vec<SeenCircle>,
    own: [f64; AZIMUTHS],
    /// Light of the brightest by azimuth and side.
    brightest: [[f64; 2]; AZIMUTHS],
    /// Errors that are allowed: pixels across the orbits and along them, light, light from behind.
    limits: [f64; 4],
}

/// Of a circle.
fn light(circle: &SeenCircle, k: usize, side: usize) -> f64 {
    circle.log_light[side][k].exp()
}

impl<'a> Measure<'a> {
    fn new(disk: &'a DrawnDisk, look: Look<'a>, close: bool) -> Measure<'a> {
        let offered: Vec<SeenCircle> = radii(disk, close).iter().map(|&r| look.circle(&CircleGas::at(disk, r))).collect();
        let opacity = |c: &SeenCircle| disk.gas.radial.depth(c.gas.radius).min(1.0);
        let shining = |k: usize, side: usize| offered.iter().map(|c| light(c, k, side) * opacity(c)).fold(0.0, f64::max);
        Measure {
            disk,
            own: own_shares(&look, &offered),
            brightest: std::array::from_fn(|k| [0, 1].map(|side| shining(k, side))),
            limits: if close && look.order == 1 { [0.1, 1.0, 0.001, 0.005] } else { [0.15, 4.0, 0.005, 0.015] },
            look,
            offered,
        }
    }

    /// Errors of a ring of `view`, over what is allowed, at all circles between its own two that there were to choose from, and how many
    /// these are: what goes straight over a ring, and as a parabola, against the gas itself. Between neighbours three are made.
    fn errors(&self, view: &DiskView, ring: &Ring) -> ([f64; 4], usize) {
        let Measure { disk, look, offered, .. } = self;
        let (radial, camera, pixel) = (&disk.gas.radial, look.camera, look.pixel);
        // Seen face on, and from where the camera is.
        let slants = [1.0, (camera.radius() / camera.position.z.abs()).min(1.0 / LEAST_COSINE)];
        let index = |row: u32| {
            let radius = f64::from(view.circles[row as usize].gas.radius);
            offered.iter().position(|circle| (circle.gas.radius - radius).abs() < 1e-4).expect("one of the circles")
        };
        let [from, to] = [ring.inner, ring.outer].map(index);
        let (a, b) = (&offered[from], &offered[to]);
        let at = |share: f64| look.circle(&CircleGas::at(disk, a.gas.radius + share * (b.gas.radius - a.gas.radius)));
        let made = [0.25, 0.5, 0.75].map(at);
        let between = if to == from + 1 { &made[..] } else { &offered[from + 1..to] };
        let mut worst = [0.0f64; 4];
        for here in between {
            let r = here.gas.radius;
            for (k, brightest) in self.brightest.iter().enumerate() {
                let [place, start, end] = [here, a, b].map(|circle| circle.places[k]);
                let (before, after) = (place.perp_dot(start), place.perp_dot(end));
                let t = before / (before - after);
                if to > from + 1 {
                    assert!(t > 0.0 && t < 1.0, "r = {r}, azimuth {k}: seen at {t} of the ring");
                }
                let parabola = |start: f64, end: f64, bend: f64| start + t * (end - start) + 4.0 * t * (1.0 - t) * bend;
                let bend = view.bends[ring.inner as usize * AZIMUTHS + k];
                let [height, bent, bent_too, depth] = [bend.height, bend.light, bend.other_light, bend.depth].map(f64::from);
                let of = |value: &dyn Fn(f64) -> f64, bend: f64| parabola(value(a.gas.radius), value(b.gas.radius), bend) - value(r);
                // The pattern's radius goes as its height's exponential. Gas whose light is older is turned back.
                let aside = radial.pattern_radius(r) * of(&|r| radial.pattern_radius(r).ln(), PATTERN_HEIGHT * height).abs();
                let older = parabola(start.length(), end.length(), 0.0) - place.length();
                let ahead = of(&|r| radial.lag(r), 0.0).abs() + radial.turning_rate(r) * older.abs();
                let wide = a.angle_to(b, k) / pixel;
                let shown = self.own[k] * wide.min(1.0);
                worst[0] = worst[0].max(aside * wide / (b.gas.radius - a.gas.radius));
                worst[1] = worst[1].max(ahead * r / place.length() / pixel * wide.min(1.0));
                let line = parabola(radial.depth(a.gas.radius), radial.depth(b.gas.radius), 0.0);
                let drawn = (line * (1.0 + 4.0 * t * (1.0 - t) * depth)).max(0.0);
                for slant in slants {
                    let [got, want] = [drawn, radial.depth(r)].map(|depth| 1.0 - (-slant * depth).exp());
                    worst[3] = worst[3].max((got - want).abs() * shown);
                    for (side, bent) in [bent, bent_too].into_iter().enumerate() {
                        let line = parabola(a.log_light[side][k], b.log_light[side][k], 0.0);
                        let seen = (line * (1.0 - 4.0 * t * (1.0 - t) * bent)).exp();
                        worst[2] = worst[2].max((seen * got - light(here, k, side) * want).abs() * shown / brightest[side]);
                    }
                }
            }
        }
        (std::array::from_fn(|k| worst[k] / self.limits[k]), to - from - 1)
    }
}

/// The scenes `disk-skim` and `disk-inner`.
fn close_cameras() -> [Observer; 2] {
    let skim = static_camera(DVec3::new(0.0, -6.5, 0.3), DVec3::new(-0.75, 0.66, -0.06), DVec3::Z, 80f64.to_radians());
    let inner = static_camera(DVec3::new(0.0, -3.3, 0.5), DVec3::new(0.9, 0.55, -0.1), DVec3::Z, 90f64.to_radians());
    [skim, inner]
}

/// From near, rings of order 1 are held to 0.1 pixels across the orbits, 1 along them, 0.001 of the light of the brightest gas at the same
/// azimuth and 0.005 of the light from behind. So they are at all circles between their own two that there were to choose from. Rings with
/// fewer than two circles between are left out: the parabola goes through one by itself.
#[test]
fn rings_from_near_are_as_true_as_they_are_held_to_be() {
    const WIDTH: u32 = 1280;
    let disk = a_disk();
    let table = shared_table();
    for camera in close_cameras() {
        let slice = Slice::new(&table, camera.radius());
        let input = FrameInput { camera, time: 100.0, placed: Vec::new(), held: None, aurora: None, settings: settings() };
        let view = DiskView::new(&disk, &input, &slice, WIDTH);
        let measure = Measure::new(&disk, Look::new(&camera, &slice, 1, WIDTH, true), true);
        let (mut worst, mut rings) = ([0.0f64; 4], 0);
        for ring in view.rings.iter().filter(|ring| ring.order == 1) {
            let (errors, between) = measure.errors(&view, ring);
            if between >= 2 {
                rings += 1;
                worst = std::array::from_fn(|k| worst[k].max(errors[k]));
            }
        }
        println!("{rings} rings: {worst:.5?} of what they may be off across, along, of light, of what is stopped");
        assert!(rings > 5);
        // Circles that were not tried are off by up to a quarter more.
        assert!(worst.into_iter().all(|worst| worst < 1.3));
    }
}

/// The rings of an order, and the bends at their beginning.
fn of_order(view: &DiskView, order: u32) -> (Vec<Ring>, Vec<[f32; 4]>) {
    let rings: Vec<Ring> = view.rings.iter().filter(|ring| ring.order == order).copied().collect();
    let bends = rings.iter().flat_map(|ring| &view.bends[ring.inner as usize * AZIMUTHS..][..AZIMUTHS]);
    let bends = bends.map(|bend| [bend.height, bend.light, bend.other_light, bend.depth]).collect();
    (rings, bends)
}

/// Radii of the circles of an order.
fn chosen_radii(view: &DiskView, order: u32) -> Vec<f32> {
    view.circles.iter().filter(|circle| circle.order == order).map(|circle| circle.gas.radius).collect()
}

/// What is kept of an image.
#[derive(Clone, Copy, Debug)]
enum Kept {
    /// All of it.
    Rings,
    /// Which circles it has; the rings between them are made anew.
    Choice,
}

/// The worst errors of kept rings, over those that they had when they were made, those of new ones, or what is allowed: the camera goes as
/// far as each order is `kept`, up and down, in and out, and by its momentum. It is kept `times` as long as by itself.
fn worse_than_new(what: Kept, times: f64) -> [f64; 4] {
    const WIDTH: u32 = 640;
    let disk = a_disk();
    let table = shared_table();
    let field_of_view = 60f64.to_radians();
    let mut cameras = close_cameras().to_vec();
    for (l, degrees) in [(27.0, 80.0), (22.0, 89.0), (14.0, 89.0), (9.0, 78.0), (9.0, 89.5), (6.0, 30.0), (2.0, 60.0), (1.6, 89.0)] {
        cameras.push(camera(l, degrees, field_of_view));
    }
    // An orbit, and a flight at nine tenths of the speed of light.
    cameras.push(Observer { momentum: DVec3::new(0.37, 0.2, 0.08), ..camera(9.0, 86.0, field_of_view) });
    cameras.push(Observer { momentum: DVec3::new(0.1, -2.0, -0.5), ..camera(7.0, 70.0, field_of_view) });
    let places = [DVec3::Z, DVec3::NEG_Z, DVec3::Y, DVec3::NEG_Y].map(|way| [way, DVec3::ZERO]);
    let momenta = [DVec3::X, DVec3::Y, DVec3::NEG_Y, DVec3::Z].map(|way| [DVec3::ZERO, way]);
    let mut worst = [0.0f64; 4];
    for start in cameras {
        let follow = |view: &mut DiskView, camera: Observer| {
            let input = FrameInput { camera, time: 100.0, placed: Vec::new(), held: None, aurora: None, settings: settings() };
            view.follow(&disk, &input, &Slice::new(&table, camera.radius()), WIDTH);
        };
        let mut view = DiskView::of(&disk);
        match what {
            Kept::Rings => view.kept = view.kept.map(|kept| kept * times),
            // Whatever moves makes new rings.
            Kept::Choice => {
                view.choice_kept *= times * 1e6;
                view.kept = view.kept.map(|kept| kept * 1e-6);
            }
        }
        follow(&mut view, start);
        for order in 1..=3 {
            let made = of_order(&view, order);
            if made.0.is_empty() {
                continue;
            }
            let chosen = chosen_radii(&view, order);
            let errors = |camera: &Observer, view: &DiskView| {
                let slice = Slice::new(&table, camera.radius());
                let look = Look::new(camera, &slice, order, WIDTH, true);
                let measure = Measure::new(&disk, look, order <= view.frame.near_orders);
                let all = of_order(view, order).0.into_iter().map(|ring| measure.errors(view, &ring).0);
                all.fold([0.0f64; 4], |worst, errors| std::array::from_fn(|k| worst[k].max(errors[k])))
            };
            let fresh = errors(&start, &view);
            for [place, momentum] in places.into_iter().chain(momenta) {
                let moved = |by: f64| Observer { position: start.position + by * place, momentum: start.momentum + by * momentum, ..start };
                let kept = |by: f64| {
                    let mut next = view.clone();
                    follow(&mut next, moved(by));
                    let is_kept = match what {
                        Kept::Rings => of_order(&next, order) == made,
                        Kept::Choice => chosen_radii(&next, order) == chosen,
                    };
                    is_kept.then_some(next)
                };
                let (mut least, mut most) = (0.0, 2.0);
                while most - least > 0.02 * most && most > 1e-5 {
                    let by = 0.5 * (least + most);
                    *(if kept(by).is_some() { &mut least } else { &mut most }) = by;
                }
                let camera = moved(least);
                let mut new = DiskView::of(&disk);
                follow(&mut new, camera);
                let [old, new] = [kept(least).expect("it was kept there"), new].map(|view| errors(&camera, &view));
                let worse: [f64; 4] = std::array::from_fn(|k| old[k] / new[k].max(fresh[k]).max(1.0));
                println!("{:.2} order {order} by {place} {momentum} {least:.4}: {worse:.2?}: {old:.2?}, new {new:.2?}", start.position);
                worst = std::array::from_fn(|k| worst[k].max(worse[k]));
            }
        }
    }
    worst
}

/// What is kept of an image while the camera moves on is about as true as what is made anew, and would not be if it were kept for longer.
#[test]
fn kept_rings_are_as_true_as_new_ones() {
    for what in [Kept::Rings, Kept::Choice] {
        let worse = worse_than_new(what, 1.0);
        println!("{what:?}: errors are {worse:.2?} times as great");
        assert!(worse.into_iter().all(|worse| worse < 1.5), "{what:?}");
        let worse = worse_than_new(what, 8.0);
        println!("{what:?}: kept eight times as long {worse:.2?} times");
        assert!(worse.into_iter().any(|worse| worse > 2.0), "{what:?}");
    }
}

/// A picture does not depend on those before it: after a step that is kept in a flight it is that of a new disk.
#[test]
fn pictures_do_not_depend_on_those_before() {
    let mut renderer = renderer([160, 90]);
    let disk = a_disk();
    renderer.set_disk(Some(disk.clone()));
    let picture = |renderer: &mut Renderer, degrees: f64| {
        let camera = camera(22.0, degrees, 60f64.to_radians());
        let input = FrameInput { camera, time: 100.0, placed: Vec::new(), held: None, aurora: None, settings: settings() };
        renderer.picture(&input, false).unwrap().linear
    };
    picture(&mut renderer, 80.0);
    let after = picture(&mut renderer, 80.2);
    renderer.set_disk(Some(disk));
    assert!(after == picture(&mut renderer, 80.2));
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
