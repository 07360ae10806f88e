//! The disk of sprites beside the disk of arcs and the exact picture.

use lensrunner::render::Renderer;
use lensrunner::render::disk::DrawnDisk;
use lensrunner::render::gpu::shaders::Pass;
use lensrunner::scene::GameConfig;
use lensrunner::scene::disk::sprites::Sprites;
use lensrunner::spacetime::Observer;
use lensrunner_lab::disk;

use super::{disk_with, green, of_orders, shown};
use crate::render_support::{camera, renderer};
use crate::twin::run;

fn with(representation: &str, change: impl Fn(&mut GameConfig)) -> DrawnDisk {
    disk_with(|config| {
        config.disk.representation = representation.into();
        change(config);
    })
}

/// Linear light of so many image orders.
fn drawn(renderer: &mut Renderer, disk: &DrawnDisk, camera: Observer, orders: u32) -> Vec<[f32; 3]> {
    drawn_at(renderer, disk, camera, 100.0, orders)
}

fn drawn_at(renderer: &mut Renderer, disk: &DrawnDisk, camera: Observer, time: f64, orders: u32) -> Vec<[f32; 3]> {
    renderer.set_disk(Some(disk.clone()));
    shown(renderer, camera, time, of_orders(orders))
}

/// Where the front of an opaque disk lies before its second image it hides it: there the light is that of arcs, and the same whether the
/// second is drawn or not.
#[test]
fn the_front_image_hides_the_ghost() {
    let size = [320, 180];
    let opaque = |config: &mut GameConfig| {
        config.disk.opacity = 1.0;
        config.disk.turbulence = 0.0;
    };
    let (arcs, sprites) = (with("arcs", opaque), with("sprites", opaque));
    let camera = camera(27.0, 80.0, 26f64.to_radians());
    let mut renderer = renderer(size);
    let by_arcs = drawn(&mut renderer, &arcs, camera, 2);
    let both = drawn(&mut renderer, &sprites, camera, 2);
    let front = drawn(&mut renderer, &sprites, camera, 1);
    let light = |p: &[f32; 3]| f64::from(p[1]);
    let (mut pixels, mut other, mut worst, mut through) = (0, 0, 0.0f64, 0.0f64);
    for k in 0..both.len() {
        let at = [f64::from(k as u32 % size[0]) + 0.5, f64::from(k as u32 / size[0]) + 0.5];
        let crossings = disk::exact::crossings(&sprites.gas, &camera, size, at, 2);
        // Away from the edges, where gas is thin and lets the ghost through.
        let [first, second] = crossings[..] else { continue };
        if !(4.0..8.8).contains(&first.radius) || !(3.3..8.8).contains(&second.radius) {
            continue;
        }
        pixels += 1;
        // Of the same radius, the ghost is where the shift is another: it would show.
        other += usize::from((second.ratio / first.ratio - 1.0).abs() > 0.2);
        worst = worst.max((light(&both[k]) / light(&by_arcs[k]) - 1.0).abs());
        through = through.max((light(&both[k]) / light(&front[k]) - 1.0).abs());
    }
    println!("{pixels} pixels, {other} of another shift: off from arcs by {worst:.4} at most, the ghost adds {through:.4}");
    assert!(pixels > 100 && other > 30);
    // e⁻⁷ at a slant of 6 is nothing, but spots are flat and the disk's image is bent: what four of them leave to a pixel is not all of it,
    // by as little.
    assert!(through < 0.01, "the ghost adds {through} of the light");
    // Between the middles of spots light goes straight, and of arcs its logarithm; it falls off by 5 % from a ring to the next.
    assert!(worst < 0.05, "off from arcs by {worst}");
}

/// Streaks: what turbulence makes of the light in each pixel goes with what it makes of that of arcs.
#[test]
fn sprites_have_the_streaks_of_arcs() {
    let size = [320, 180];
    let camera = camera(27.0, 80.0, 60f64.to_radians());
    let mut renderer = renderer(size);
    let mut streaks = |representation: &str| -> Vec<f64> {
        let [with_streaks, without] = [0.6, 0.0].map(|contrast| {
            let disk = with(representation, |config| config.disk.turbulence = contrast);
            drawn(&mut renderer, &disk, camera, 1)
        });
        with_streaks
            .iter()
            .zip(without)
            .map(|(a, b)| if b[1] > 1e-3 { (f64::from(a[1]) / f64::from(b[1])).max(1e-3).ln() } else { f64::NAN })
            .collect()
    };
    let (arcs, sprites) = (streaks("arcs"), streaks("sprites"));
    let pairs: Vec<[f64; 2]> = arcs.into_iter().zip(sprites).filter(|(a, b)| a.is_finite() && b.is_finite()).map(|(a, b)| [a, b]).collect();
    let count = pairs.len() as f64;
    let mean = [0, 1].map(|k| pairs.iter().map(|pair| pair[k]).sum::<f64>() / count);
    let product = |i: usize, j: usize| pairs.iter().map(|pair| (pair[i] - mean[i]) * (pair[j] - mean[j])).sum::<f64>() / count;
    let correlation = product(0, 1) / (product(0, 0) * product(1, 1)).max(1e-12).sqrt();
    let contrast = (product(1, 1) / product(0, 0)).sqrt();
    println!("{count} pixels: correlation {correlation:.3}, contrast {contrast:.3} of that of arcs");
    // Spots are wider than a pixel along the orbits: what is finer is lost.
    assert!(count > 5_000.0 && correlation > 0.95 && (0.85..1.15).contains(&contrast));
}

/// Against the exact picture from far and near, from above and edge on; and the picture is the same, bit by bit, when it is drawn again.
#[test]
fn the_picture_of_sprites_is_the_exact_one() {
    let size = [320, 180];
    let sprites = with("sprites", |_| ());
    let mut renderer = renderer(size);
    // About 2 dB less than measured, and no less light: streaks add up to 0.023 too much.
    for (l, degrees, least, most) in
        [(27.0, 0.0, 40.0, 0.03), (27.0, 30.0, 38.0, 0.03), (27.0, 80.0, 43.0, 0.03), (27.0, 88.0, 40.0, 0.03), (6.5, 87.0, 37.5, 0.03)]
    {
        let camera = camera(l, degrees, 60f64.to_radians());
        let got = drawn(&mut renderer, &sprites, camera, 2);
        let truth = disk::picture(&sprites.gas, &camera, size, 100.0, 2, 3);
        let error = disk::compare(&got, &truth, size, disk::peak(&truth));
        let ratio = green(&got) / green(&truth);
        println!("L = {l}, {degrees}°: {error:?}, {ratio:.3} of the light");
        assert!(error.psnr > least && (ratio - 1.0).abs() < most && drawn(&mut renderer, &sprites, camera, 2) == got);
    }
}

/// Without streaks the whole has its light: what goes straight between spots is 0.04 r_s apart and takes nothing off and adds nothing that
/// counts.
#[test]
fn sprites_without_streaks_have_their_light() {
    let size = [320, 180];
    let sprites = with("sprites", |config| config.disk.turbulence = 0.0);
    let mut renderer = renderer(size);
    for (l, degrees) in [(27.0, 0.0), (27.0, 80.0), (6.5, 87.0)] {
        let camera = camera(l, degrees, 60f64.to_radians());
        let truth = disk::picture(&sprites.gas, &camera, size, 100.0, 2, 3);
        let ratio = green(&drawn(&mut renderer, &sprites, camera, 2)) / green(&truth);
        println!("L = {l}, {degrees}°: {ratio:.4} of the light");
        assert!((ratio - 1.0).abs() < 0.005);
    }
}

/// The third image is far thinner than a pixel, and yet it has its light: from one spot to the next its rings part by a few
/// roundings of f32 alone. At one time alone it is chance which streak of the second image is before it.
#[test]
fn the_third_image_of_sprites_has_its_light() {
    let size = [160, 160];
    let sprites = with("sprites", |_| ());
    let mut renderer = renderer(size);
    let camera = camera(27.0, 80.0, 15f64.to_radians());
    let [third, second] = [3, 2].map(|orders| {
        [60.0, 100.0, 145.0].map(|time| {
            let truth = disk::picture(&sprites.gas, &camera, size, time, orders, 2);
            [drawn_at(&mut renderer, &sprites, camera, time, orders), truth].map(|picture| green(&picture))
        })
    });
    let [third, second] = [third, second].map(|times| [0, 1].map(|k| times.iter().map(|both| both[k]).sum::<f64>()));
    let [got, want] = [0, 1].map(|k| third[k] - second[k]);
    println!("the third image adds {got:.2}, must add {want:.2}");
    // Measured 0.991.
    assert!((got / want - 1.0).abs() < 0.05);
}

/// The share of later rings, in closed form, is the sum that it stands for.
#[test]
fn the_share_of_later_rings_is_a_sum() {
    let rows: Vec<[f32; 4]> = (0..600)
        .map(|k| [-1.0 + 2.0 * (k % 40) as f32 / 39.0, [1.0, 2.0, 3.0, 7.0, 40.0][k / 40 % 5], [0.0, 2.0, 100.0][k / 200], 0.0])
        .collect();
    let got = run(Pass::DiskSpritesDraw, "twin_out[id.x] = vec4<f32>(later_rings(row.x, row.y, row.z));", [&[], &[]], &rows, 1);
    for (row, got) in rows.iter().zip(got) {
        let [across, spread] = [row[0], row[1]].map(f64::from);
        let want: f64 = (1..=row[2] as u32).map(|k| (1.0 - (across - f64::from(k) / spread).abs()).max(0.0) / spread).sum();
        assert!((f64::from(got[0]) - want).abs() < 1e-5, "{across} over {spread} rings: {} instead of {want}", got[0]);
    }
}

/// No more sprites than asked for and hardly fewer, evenly over the area, ring by ring outwards.
#[test]
fn sprites_are_as_many_as_asked_and_even() {
    let disk = with("sprites", |_| ());
    let [start, end] = disk.gas.extent();
    for most in [100u32, 10_000, 100_000] {
        let Sprites { all, width } = Sprites::new(most, &disk.config, &disk.gas.radial);
        // Each ring has a whole number, so up to one of it is missing.
        let rings = ((end - start) / width).round();
        assert!(all.len() as u32 <= most && all.len() as f64 >= f64::from(most) - rings, "{} of {most}", all.len());
        assert!(all.windows(2).all(|pair| (pair[0].radius, pair[0].sigma) < (pair[1].radius, pair[1].sigma)), "{most}: not in order");
        let middle = (0.5 * (start * start + end * end)).sqrt();
        let within = all.iter().filter(|sprite| sprite.radius < middle).count() as f64 / all.len() as f64;
        assert!((within - 0.5).abs() < 1.0 / rings, "{most}: {within} of them within the middle of the area");
    }
}
