//! The ground that the aurora lights, in pictures.

use lensrunner::render::Renderer;
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::readback::ReadbackPicture;
use lensrunner::render::stage::{Stage, settings};
use lensrunner::scene::{GameConfig, Model, Scene};

use crate::render::support::renderer;

const SIZE: [u32; 2] = [240, 240];

/// A planet with an aurora of this shape, seen from straight above a magnetic latitude, so many km high. It is so far from the hole that
/// space is flat about it, and slow.
fn scene_above(shape: &str, latitude: f64, height: f64) -> Scene {
    let text = format!(
        "[planet]\norbit_radius = 1000.0\nradius = 0.8\nday = 1e6\nphase = 2.4\naxis_tilt = 0.3\ndipole_tilt = 0.35\naurora = \"{shape}\"\nseed = 3\n\
         [camera]\nabove = [{latitude}, 0.4, {height}]\nlook = [0.0, 0.0, -1.0]\nup = [0.0, 1.0, 0.0]\nfov = 50.0\n\
         [sky]\nstars = false\nmilky_way = false\n"
    );
    Scene::from_toml("above.toml".as_ref(), &text).unwrap()
}

/// The planet all white.
fn white(model: &Model) -> Model {
    let mut model = model.clone();
    for material in &mut model.materials {
        (material.base_colour, material.texture, material.metallic) = ([1.0; 4], None, 0.0);
    }
    model
}

/// The frame's parts: what the curtains alone and what the ground that they light adds to a picture without either, green channel.
struct Parts {
    curtains: Vec<f64>,
    ground: Vec<f64>,
}

fn green(renderer: &mut Renderer, frame: &FrameInput) -> Vec<f64> {
    let picture: ReadbackPicture = renderer.picture(frame, false).unwrap();
    picture.linear.iter().map(|pixel| f64::from(pixel[1])).collect()
}

fn config() -> GameConfig {
    let mut config = GameConfig::default();
    // Light of known colours, none of which is spread by the lens.
    (config.render.doppler, config.render.beaming, config.render.bloom) = (false, false, 0.0);
    config.aurora.brightness = 0.2;
    config
}

fn parts(renderer: &mut Renderer, scene: &Scene, config: &GameConfig) -> Parts {
    let mut stage = Stage::of(renderer, scene, scene.assemble(config), config, Some(white));
    let mut frame = stage.frame(stage.camera(0.0, &[]), SIZE, 0.0, &[], None, &settings(config));
    let both = frame.clone();
    let aurora = frame.aurora.as_mut().expect("the aurora is in sight");
    let ground = aurora.ground.take().expect("its ground is wide enough");
    let curtains = green(renderer, &frame);
    let aurora = frame.aurora.as_mut().unwrap();
    aurora.colours.iter_mut().for_each(|colours| colours.lines.iter_mut().flatten().for_each(|line| *line = [0.0; 4]));
    let neither = green(renderer, &frame);
    frame.aurora.as_mut().unwrap().ground = Some(ground);
    let lit = green(renderer, &frame);
    let less = |a: &[f64]| -> Vec<f64> { a.iter().zip(&neither).map(|(a, b)| a - b).collect() };
    let parts = Parts { curtains: less(&curtains), ground: less(&lit) };
    // Both together are the picture; halves are good to a thousandth.
    for (k, (got, dark)) in green(renderer, &both).iter().zip(&neither).enumerate() {
        let want = dark + parts.curtains[k] + parts.ground[k];
        assert!((got - want).abs() <= 4e-3 * want + 1e-5, "pixel {k}: {got}, its parts come to {want}");
    }
    parts
}

#[test]
fn the_ground_gets_half_of_the_light_but_for_what_passes_over_the_horizon() {
    let mut renderer = renderer(SIZE);
    let height = 9000.0;
    // What a pixel shows of a sphere about the planet: its area, as far as it is seen askew, and the cosine of how much it is.
    let sums = |pixels: &[f64], radius: f64, askew: bool| {
        let centre = 6371.0 + height;
        let aside = |k: usize| 25f64.to_radians().tan() * (2.0 * (k as f64 + 0.5) / f64::from(SIZE[0]) - 1.0);
        let width = SIZE[0] as usize;
        let light = |(k, light): (usize, &f64)| {
            let cosine = 1.0 / (1.0 + aside(k % width).powi(2) + aside(k / width).powi(2)).sqrt();
            let half = (radius * radius - centre * centre * (1.0 - cosine * cosine)).max(0.0).sqrt();
            let distance = centre * cosine - half;
            // A pixel's solid angle goes as the third power of the cosine.
            light * cosine.powi(3) * distance * distance / if askew { (half / radius).max(0.1) } else { 1.0 }
        };
        pixels.iter().enumerate().map(light).sum::<f64>()
    };
    // A source of intensity Q shines into 4π; the globe fills 2π (1 − √(1 − k²)) of it, k = R/(R + h), and a white ground sends out 1/π of
    // what falls on it: ∫ (E/π) dA = 2Q (1 − √(1 − k²)). In the plane of the map circles of latitude are too long by θ/sin θ, θ = 0.386 the
    // arcs' colatitude.
    let k: f64 = 6371.0 / 6486.0;
    let want = 2.0 * (1.0 - (1.0 - k * k).sqrt()) * 0.386f64.sin() / 0.386;
    // Even curtains; and some with waves of brightness and rays, a thousand of which are as bright as their mean within a few per cent.
    for (contrast, off) in [(0.0, 0.01), (0.7, 0.02)] {
        let mut config = config();
        config.aurora.contrast = contrast;
        let parts = parts(&mut renderer, &scene_above("arcs", 1.18, height), &config);
        let ratio = sums(&parts.ground, 6371.0, true) / sums(&parts.curtains, 6486.0, false);
        assert!(
            (ratio / want - 1.0).abs() < off,
            "contrast {contrast}: the ground has {ratio} of the curtains' light, {want} by what falls on it"
        );
    }
}

#[test]
fn the_ground_is_lit_beneath_the_curtains() {
    let mut renderer = renderer(SIZE);
    for (shape, latitude, height, least) in [("arcs", 1.18, 4000.0, 0.94), ("oval", 1.5, 9000.0, 0.87), ("oval", -1.4, 9000.0, 0.87)] {
        let parts = parts(&mut renderer, &scene_above(shape, latitude, height), &config());
        // About 150 km of the ground.
        let radius = (150.0 / (2.0 * height * 25f64.to_radians().tan() / f64::from(SIZE[0]))).round() as usize;
        let spread = blurred(&blurred(&parts.curtains, radius), radius);
        let alike = correlation(&spread, &parts.ground);
        // From above the pole an oval's curtains, seen askew, are brighter than what is lit, and the two are less alike. Mirrored they come
        // to 0.91 (arcs) and 0.63.
        assert!(alike > least, "{shape} from {latitude} rad: {alike}");
    }
}

#[test]
fn without_an_aurora_the_ground_is_as_it_was() {
    let mut renderer = renderer(SIZE);
    let scene = scene_above("arcs", 1.18, 4000.0);
    let mut config = config();
    let mut stage = Stage::new(&mut renderer, &scene, &config);
    let mut frame = stage.frame(stage.camera(0.0, &[]), SIZE, 0.0, &[], None, &settings(&config));
    let lit = green(&mut renderer, &frame);
    let mut other = frame.clone();
    frame.aurora = None;
    let dark = green(&mut renderer, &frame);
    // What is not the planet is not lit.
    let aurora = other.aurora.as_mut().unwrap();
    aurora.colours.iter_mut().for_each(|colours| colours.lines = Default::default());
    aurora.ground.as_mut().unwrap().light.planet += 1;
    assert_eq!(green(&mut renderer, &other), dark);
    config.aurora.enabled = false;
    let mut stage = Stage::new(&mut renderer, &scene, &config);
    let frame = stage.frame(stage.camera(0.0, &[]), SIZE, 0.0, &[], None, &settings(&config));
    assert!(frame.aurora.is_none());
    assert_eq!(green(&mut renderer, &frame), dark);
    assert!(lit.iter().sum::<f64>() > 1.5 * dark.iter().sum::<f64>());

    // Arcs are in the north alone: about the south pole of the magnetic axis the map's middle is in no direction, and in all.
    config.aurora.enabled = true;
    for height in [60.0, 300.0] {
        let scene = scene_above("arcs", 1e-4 - std::f64::consts::FRAC_PI_2, height);
        let mut stage = Stage::of(&mut renderer, &scene, scene.assemble(&config), &config, Some(white));
        let mut frame = stage.frame(stage.camera(0.0, &[]), SIZE, 0.0, &[], None, &settings(&config));
        let south = green(&mut renderer, &frame);
        frame.aurora.as_mut().and_then(|aurora| aurora.ground.take()).expect("the planet is wide enough");
        let off = south.iter().zip(green(&mut renderer, &frame)).filter(|(a, b)| **a != *b).count();
        assert_eq!(off, 0, "pixels lit from {height} km");
    }

    // Where the planet is small on the screen no map is made, though its curtains still show.
    let scene = scene_above("arcs", 1.18, 60_000.0);
    let mut stage = Stage::new(&mut renderer, &scene, &config);
    let frame = stage.frame(stage.camera(0.0, &[]), SIZE, 0.0, &[], None, &settings(&config));
    assert!(frame.aurora.is_some_and(|aurora| aurora.ground.is_none()));
}

/// The mean over squares of so many pixels to each side.
fn blurred(pixels: &[f64], radius: usize) -> Vec<f64> {
    let [width, height] = SIZE.map(|size| size as usize);
    let mean = |x: usize, y: usize| {
        let (columns, rows) =
            (x.saturating_sub(radius)..(x + radius + 1).min(width), y.saturating_sub(radius)..(y + radius + 1).min(height));
        rows.flat_map(|y| columns.clone().map(move |x| pixels[y * width + x])).sum::<f64>()
    };
    (0..width * height).map(|k| mean(k % width, k / width)).collect()
}

/// Pearson's, of two pictures.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let (ma, mb) = (mean(a), mean(b));
    let sum = |of: &dyn Fn(f64, f64) -> f64| a.iter().zip(b).map(|(a, b)| of(a - ma, b - mb)).sum::<f64>();
    sum(&|a, b| a * b) / (sum(&|a, _| a * a) * sum(&|_, b| b * b)).sqrt()
}
