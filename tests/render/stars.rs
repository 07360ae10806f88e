//! The way of the stars by themselves: which are drawn, and how a sky of them is exposed.

use std::collections::HashMap;
use std::f64::consts::TAU;

use lensrunner::spacetime::{Observer, light};

use glam::{DQuat, DVec3};
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::readback::{self, ReadbackPicture};
use lensrunner::render::gpu::types::{STAR_ORDERS, Star};
use lensrunner::render::quality::options::{QualityOption, turned};
use lensrunner::render::renderer::Surroundings;
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::Stage;
use lensrunner::scene::sky::stars::SKY_UNIT;
use lensrunner::scene::{self, GameConfig};

use crate::render::support::{linear, renderer_under};
use crate::support::shared_table;

/// A picture of these stars before a Milky Way of even brightness `haze`, from far away.
fn picture(stars: &[Star], haze: f32, camera: Observer, size: [u32; 2], settings: Settings) -> ReadbackPicture {
    let surroundings = Surroundings { table: shared_table(), stars: stars.to_vec(), milky_way: vec![(1, 1, vec![haze])] };
    let mut renderer = renderer_under(&surroundings, size);
    let input = FrameInput { camera, time: 0.0, placed: Vec::new(), held: None, aurora: None, settings };
    renderer.picture(&input, false).unwrap()
}

fn star(direction: DVec3, flux: f32) -> Star {
    let d = direction.normalize();
    Star { direction: d.as_vec3().to_array(), flux, temperature: 5772.0, luminance: 0.0, unused: [0.0; 2] }
}

/// `count` directions in a spiral over the sphere.
fn spiral(count: u32) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |k| {
        let z = 1.0 - 2.0 * (f64::from(k) + 0.5) / f64::from(count);
        let (sine, cosine) = (2.399_963 * f64::from(k)).sin_cos();
        DVec3::new((1.0 - z * z).sqrt() * cosine, (1.0 - z * z).sqrt() * sine, z)
    })
}

/// A camera 10⁵ r_s away that looks along −z, across the direction of the hole.
fn far_camera(momentum: DVec3) -> Observer {
    Observer { position: DVec3::new(1e5, 0.0, 0.0), momentum, attitude: DQuat::IDENTITY, field_of_view: 60f64.to_radians() }
}

/// What a sky of bright stars does to the exposure does not depend on the size of the picture: the haze between them is finished alike. In
/// cells of a part of the picture's width stars weigh as they are, but for what each halving spreads them; pixel by pixel, their spots
/// would be brighter in a finer picture, and the haze darker by a factor of 3.5.
#[test]
fn stars_are_metered_alike_in_pictures_of_any_size() {
    let stars: Vec<Star> = spiral(400).map(|direction| star(direction, 0.1)).collect();
    let settings = Settings { bloom: 0.0, exposure_range: [1e-9, 1e9], sky_brightness: 1.0, star_brightness: 1.0, ..Settings::finest() };
    let haze = |size: [u32; 2]| -> f64 {
        let picture = picture(&stars, 0.05, far_camera(DVec3::ZERO), size, settings);
        let mut green: Vec<u8> = picture.display.chunks_exact(4).map(|pixel| pixel[1]).collect();
        green.sort_unstable();
        let value = f64::from(green[green.len() / 2]) / 255.0;
        println!("{size:?}: haze at {value}");
        assert!((0.1..0.9).contains(&value), "the haze is finished to {value}, which tells nothing of the exposure");
        value
    };
    let [coarse, fine] = [haze([320, 180]), haze([1280, 720])];
    assert!((0.7..1.4).contains(&(fine / coarse)), "the haze is {coarse:.3} of white in a coarse picture and {fine:.3} in a fine one");
}

/// Every star that lands on the screen, by the exact solution, is drawn there, and no other; clusters of stars that are elsewhere are left
/// out before their stars are projected.
#[test]
fn no_star_on_the_screen_is_left_out() {
    const STARS: u32 = 20_000;
    // All are bright enough in both orders.
    let stars: Vec<Star> = spiral(STARS).map(|direction| star(direction, 1e15)).collect();
    let size = [640, 360];
    let surroundings = Surroundings { table: shared_table(), stars: stars.clone(), milky_way: vec![(1, 1, vec![0.0])] };
    let mut renderer = renderer_under(&surroundings, size);
    let (mut expected, mut kept) = (0, 0);
    for (position, momentum, angle) in [
        (DVec3::new(9.0, 2.0, 1.0), DVec3::ZERO, 0.3),
        (DVec3::new(9.0, 2.0, 1.0), DVec3::new(-0.8, 0.9, 0.2), 2.6),
        (DVec3::new(9.0, 2.0, 1.0), DVec3::new(-6.0, 9.0, 2.0), 1.7),
        (DVec3::new(0.2, 1.05, 0.3), DVec3::new(1.5, 2.0, -1.0), 1.2),
        (DVec3::new(0.5, 0.1, 0.3), DVec3::new(-0.4, 0.0, 0.7), 4.4),
    ] {
        let attitude = DQuat::from_rotation_y(angle) * DQuat::from_rotation_x(0.4);
        let camera = Observer { position, momentum, attitude, field_of_view: 1.05 };
        let settings = Settings { bloom: 0.0, star_brightness: 1.0, ..Settings::finest() };
        renderer.picture(&FrameInput { camera, time: 0.0, placed: Vec::new(), held: None, aurora: None, settings }, false).unwrap();
        let [groups, seen, arguments] = renderer.stars().lists().map(|buffer| readback::buffer(renderer.gpu(), buffer).unwrap());
        let words = |bytes: &[u8]| bytemuck::pod_collect_to_vec::<u8, u32>(bytes);
        kept += words(&groups)[3];
        let drawn = words(&arguments)[0] as usize / 3;
        // The place is the first thing of a SeenStar, a row of eight numbers.
        let rows = bytemuck::pod_collect_to_vec::<u8, [f32; 8]>(&seen[..32 * drawn]);
        let pixel = |row: &[f32; 8]| [(0.5 + 0.5 * row[0]) * 640.0, (0.5 - 0.5 * row[1]) * 360.0];
        let places: Vec<[f32; 2]> = rows.iter().map(pixel).filter(|[x, y]| (0.0..640.0).contains(x) && (0.0..360.0).contains(y)).collect();
        let mut cells: HashMap<[i32; 2], Vec<[f32; 2]>> = HashMap::new();
        places.iter().for_each(|place| cells.entry(place.map(|x| x as i32)).or_default().push(*place));

        let (n, u) = (camera.axis_frame()[0], 1.0 / camera.radius());
        let mut on_screen = 0;
        for (order, d) in [1, 2].into_iter().flat_map(|order| stars.iter().map(move |star| (order, star.direction))) {
            let d = DVec3::from_array(d.map(f64::from)).normalize();
            let phi = d.angle_between(n);
            let side = (d - n * d.dot(n)).normalize_or_zero();
            let (swept, turn) = if order == 1 { (phi, 1.0) } else { (TAU - phi, -1.0) };
            let Some(slope) = light::sky_slope(swept, u) else { continue };
            let energy = (slope * slope + u * u - u * u * u).max(0.0).sqrt();
            let psi = light::rain_angle(slope, energy, u);
            let seen = camera.seen_direction(n * psi.cos() + side * (turn * psi.sin()));
            let Some([x, y]) = camera.pixel(seen, size) else { continue };
            if !((0.0..640.0).contains(&x) && (0.0..360.0).contains(&y)) {
                continue;
            }
            on_screen += 1;
            let near = |[a, b]: [f32; 2]| (f64::from(a) - x).hypot(f64::from(b) - y) < 0.25;
            let about = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [x as i32 + i, y as i32 + j]));
            let found = about.filter_map(|cell| cells.get(&cell)).flatten().any(|place| near(*place));
            assert!(found, "a star at pixel {x}, {y} in order {order} was left out, camera at {position}");
        }
        println!("camera at {position}: {on_screen} stars on the screen, {} drawn there", places.len());
        // Those at the edge of the screen are rounded to this side of it or to that.
        assert!(places.len().abs_diff(on_screen) < 3, "{} stars are drawn, of {on_screen} on the screen", places.len());
        expected += on_screen;
    }
    // The test saw something, and most of the 6 × 16 × 16 clusters are left out.
    assert!(expected > 3000, "{expected}");
    println!("{kept} clusters are kept");
    assert!(kept < 5 * STAR_ORDERS * 1536 * 2 / 5, "{kept}");
}

/// Settings under which a star of this flux is about as bright as white in a picture of 640 pixels' width and 60° of view, drawn at this
/// step of the resolution.
fn exposed_for(flux: f32, step: u8) -> Settings {
    let pixel = 2.0 * 30f32.to_radians().tan() / 640.0;
    let exposure = 3.0 * pixel * pixel / (flux * SKY_UNIT);
    let mut steps = [0; QualityOption::ALL.len()];
    steps[0] = step;
    turned(&Settings { bloom: 0.0, exposure_range: [exposure; 2], exposure_bias: 1.0, ..Settings::finest() }, &steps)
}

/// The step of the resolution that draws a quarter of the width.
const QUARTER: u8 = 7;

/// The light of a star alone on black, as shown, and the standard deviation of its spot in pixels, wherever it lies between them.
#[test]
fn a_star_of_an_enlarged_picture_is_as_bright_and_as_narrow_as_in_a_full_one() {
    for k in 0..8 {
        let aside = DVec3::new(0.1 + 0.003 * f64::from(k), 0.05 + 0.0017 * f64::from(k), -1.0);
        let [full, enlarged] = [0, QUARTER].map(|step| {
            let picture = picture(&[star(aside, 0.1)], 0.0, far_camera(DVec3::ZERO), [640, 360], exposed_for(0.1, step));
            // Without the noise of the dark.
            let lit = picture.display.chunks_exact(4).enumerate().filter(|(_, pixel)| pixel[1] > 8);
            let lit: Vec<[f64; 3]> = lit.map(|(k, pixel)| [(k % 640) as f64, (k / 640) as f64, linear(pixel[1])]).collect();
            let mean = |of: &dyn Fn(&[f64; 3]) -> f64| lit.iter().map(of).sum::<f64>() / lit.iter().map(|p| p[2]).sum::<f64>();
            let [x, y] = [0, 1].map(|axis| mean(&|p| p[axis] * p[2]));
            [lit.iter().map(|p| p[2]).sum::<f64>(), mean(&|p| 0.5 * ((p[0] - x).powi(2) + (p[1] - y).powi(2)) * p[2]).sqrt(), x, y]
        });
        println!("light, width, place: {full:.3?} in full, {enlarged:.3?} enlarged");
        assert!((0.98..1.02).contains(&(enlarged[0] / full[0])), "the light is {} and {}", full[0], enlarged[0]);
        assert!((0.98..1.02).contains(&(enlarged[1] / full[1])), "the width is {} and {} px", full[1], enlarged[1]);
        assert!((2..4).all(|k| (enlarged[k] - full[k]).abs() < 0.02), "it is elsewhere");
    }
}

/// A whole sky of them is that of a full picture, pixel by pixel.
#[test]
fn stars_of_an_enlarged_picture_are_those_of_a_full_one() {
    let stars: Vec<Star> = spiral(3000).map(|direction| star(direction, 0.1)).collect();
    let [full, enlarged] =
        [0, QUARTER].map(|step| picture(&stars, 0.0, far_camera(DVec3::ZERO), [640, 360], exposed_for(0.1, step)).display);
    let lit = full.iter().filter(|&&value| (64..255).contains(&value)).count();
    let worst = full.iter().zip(&enlarged).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
    println!("{lit} values are lit, and off by {worst} steps at most");
    assert!(lit > 1000, "{lit}");
    // The dark is dithered in the small picture, and light is added up in eight bits.
    assert!(worst < 8, "a value is off by {worst} steps");
}

/// What covers the sky hides the stars of an enlarged picture.
#[test]
fn bodies_hide_the_stars_of_an_enlarged_picture() {
    const SIZE: [u32; 2] = [640, 360];
    let stars: Vec<Star> = spiral(20_000).map(|direction| star(direction, 0.1)).collect();
    let surroundings = Surroundings { table: shared_table(), stars, milky_way: vec![(1, 1, vec![0.0])] };
    let mut renderer = renderer_under(&surroundings, SIZE);
    let mut stage = Stage::new(&mut renderer, &scene::load("ring").unwrap(), &GameConfig::default());
    let camera = stage.camera(0.0, &[]);
    let mut shown = |step, stars| {
        let settings = Settings { stars, ..exposed_for(0.1, step) };
        renderer.picture(&stage.frame(camera, SIZE, 0.0, &[], None, &settings), step == 0).unwrap()
    };
    let full = shown(0, false);
    let [with, without] = [true, false].map(|stars| shown(QUARTER, stars).display);
    let is_body = |x: i64, y: i64| full.layers.get((y * 640 + x) as usize).is_some_and(|layer| layer[0] > 0.0);
    let (mut inside, mut lit) = (0, 0);
    for (x, y) in (0..360).flat_map(|y| (0..640).map(move |x| (x, y))) {
        let k = 4 * (y * 640 + x) as usize;
        let differs = with[k..k + 3] != without[k..k + 3];
        lit += u32::from(differs);
        // Farther from its outline than two drawn pixels and a spot.
        let mut about = (-12..=12).step_by(4).flat_map(|i| (-12..=12).step_by(4).map(move |j| [i, j]));
        if about.all(|[i, j]| (0..640).contains(&(x + i)) && is_body(x + i, y + j)) {
            inside += 1;
            assert!(!differs, "a star is seen through the body at {x}, {y}");
        }
    }
    println!("{inside} pixels of the body are looked at, stars are seen in {lit}");
    assert!(inside > 500 && lit > 1000, "{inside}, {lit}");
}
