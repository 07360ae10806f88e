//! A picture drawn smaller than the output is enlarged to it by cubic convolution.

use lensrunner::render::gpu::readback::ReadbackPicture;
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::{self, Stage};
use lensrunner::scene::{self, GameConfig};

use crate::render::post_process::a_chase;
use crate::render::support::{linear, renderer};

/// Keys' kernel (1981, equation 4), as in upscale.wgsl of this sharpness.
fn kernel(x: f64) -> f64 {
    const A: f64 = -0.75;
    match x.abs() {
        x if x <= 1.0 => (A + 2.0) * x.powi(3) - (A + 3.0) * x.powi(2) + 1.0,
        x if x < 2.0 => A * x.powi(3) - 5.0 * A * x.powi(2) + 8.0 * A * x - 4.0 * A,
        _ => 0.0,
    }
}

/// A row of `values` enlarged to `wide`, each held between its two neighbours.
fn enlarged(values: &[f64], wide: usize) -> Vec<f64> {
    let at = |i: i64| values[i.clamp(0, values.len() as i64 - 1) as usize];
    let place = |k: usize| (k as f64 + 0.5) * values.len() as f64 / wide as f64 - 0.5;
    (0..wide)
        .map(|k| {
            let (x, first) = (place(k), place(k).floor() as i64);
            let sum: f64 = (first - 1..=first + 2).map(|i| kernel(x - i as f64) * at(i)).sum();
            sum.clamp(at(first).min(at(first + 1)), at(first).max(at(first + 1)))
        })
        .collect()
}

fn encoded(light: f64) -> f64 {
    255.0 * if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

#[test]
fn a_small_picture_is_enlarged_as_in_rust() {
    let (small, output) = ([96, 54], [160, 90]);
    let scene = scene::load("ring").unwrap();
    let mut renderer = renderer(output);
    let mut stage = Stage::new(&mut renderer, &scene, &GameConfig::default());
    let camera = stage.camera(0.0, &[]);
    let mut draw = |size, resolution| {
        renderer.resize(size);
        // Of a picture that will be enlarged the glow is narrower.
        let settings = Settings { resolution, bloom: 0.0, ..Settings::finest() };
        renderer.picture(&stage.frame(camera, size, 0.0, &[], None, &settings), false).unwrap()
    };
    let shown = draw(output, 0.6);
    let drawn = draw(small, 1.0);
    assert_eq!((shown.size, drawn.size), (output, small));
    let [width, height] = small.map(|side| side as usize);
    let (mut values, mut wide) = (0, 0);
    for k in 0..3 {
        let row = |y: usize| -> Vec<f64> { (0..width).map(|x| linear(drawn.display[4 * (y * width + x) + k])).collect() };
        // What is between the passes has eight bits.
        let eight_bits = |light: f64| linear(encoded(light).round() as u8);
        let rows: Vec<Vec<f64>> =
            (0..height).map(|y| enlarged(&row(y), output[0] as usize).into_iter().map(eight_bits).collect()).collect();
        for x in 0..output[0] as usize {
            let column: Vec<f64> = rows.iter().map(|row| row[x]).collect();
            for (y, light) in enlarged(&column, output[1] as usize).into_iter().enumerate() {
                let got = f64::from(shown.display[4 * (y * output[0] as usize + x) + k]);
                assert!((got - encoded(light)).abs() < 4.0, "({x}, {y}): {got} for {:.1}", encoded(light));
                values += 1;
                wide += usize::from((got - encoded(light)).abs() > 1.0);
            }
        }
    }
    // Drivers may round otherwise on the way to eight bits, twice.
    assert!(20 * wide < values, "{wide} of {values} values are off by more than a step");
}

/// Beside the outline of the own ship an enlarged picture is nearer to the full one than it is without its mask: there each pixel has the
/// colour of its own side.
#[test]
fn the_own_ship_keeps_its_outline() {
    let (size, config, mut renderer, mut stage, moment) = a_chase([480, 270]);
    let mut draw = |resolution: f32, is_masked: bool| {
        let exposure_range = [1.0; 2];
        let settings = Settings { own_ship: Some(0), resolution, exposure_range, bloom: 0.0, smooth: false, ..stage::settings(&config) };
        let camera = stage.camera(0.0, &moment.ships());
        let mut frame = stage.frame(camera, size, 0.0, &moment.histories(), None, &settings);
        assert!(frame.settings.unmetered[2] > 0.0);
        if !is_masked {
            frame.settings.unmetered = [0.0; 3];
        }
        renderer.picture(&frame, true).unwrap()
    };
    let full = draw(1.0, true);
    let [masked, plain] = [true, false].map(|is_masked| draw(0.25, is_masked));
    let wide = size[0] as usize;
    let is_ship = |k: usize| full.layers[k][0] == 1.0;
    // Within two pixels of the outline.
    let beside = |k: usize| {
        let steps = [1, 2, wide, 2 * wide];
        steps.into_iter().any(|step| {
            [k.checked_sub(step), Some(k + step)]
                .into_iter()
                .flatten()
                .any(|other| other < full.layers.len() && is_ship(other) != is_ship(k))
        })
    };
    // Outside: the ship's own surface is coarse at a quarter of the width.
    let outline: Vec<usize> = (0..full.layers.len()).filter(|&k| beside(k) && !is_ship(k)).collect();
    assert!(outline.len() > 150, "{} pixels", outline.len());
    let error = |picture: &ReadbackPicture| -> f64 {
        let differences = outline.iter().flat_map(|&k| 4 * k..4 * k + 3).map(|byte| picture.display[byte].abs_diff(full.display[byte]));
        differences.map(f64::from).sum::<f64>() / (3 * outline.len()) as f64
    };
    let [masked, plain] = [error(&masked), error(&plain)];
    // Most of what is left is the gas behind, as coarse in both.
    assert!(masked < 0.8 * plain, "{masked:.1} of {plain:.1}");
}
