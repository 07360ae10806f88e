//! The aurora on the GPU: its functions against their Rust twins, and what it draws.

use glam::{DVec2, DVec3};
use lensrunner::lensing;
use lensrunner::render::renderer::Surroundings;
use lensrunner::render::shaders::Pass;
use lensrunner::render::stage::{Stage, settings, static_camera};
use lensrunner::render::{Renderer, readback};
use lensrunner::scene::aurora::dipole::on_field_line;
use lensrunner::scene::aurora::random;
use lensrunner::scene::{self, GameConfig};
use std::sync::Arc;

use crate::render_shaders::GPU;
use crate::twin::run;

#[test]
fn field_lines_and_random_numbers_are_the_same_in_both_languages() {
    let rows: Vec<[f32; 4]> =
        (0..400u32).map(|k| [13.7 * k as f32 - 2500.0, 9.1 * k as f32 - 1500.0, 80.0 + k as f32, f32::from_bits(k * 7919)]).collect();
    let lines = run(
        Pass::AuroraWalk,
        "twin_out[id.x] = vec4<f32>(on_field_line(row.xy, row.z), unit(hash(bitcast<u32>(row.w))));",
        [&[], &[]],
        &rows,
        1,
    );
    for (row, got) in rows.iter().zip(lines) {
        let want = on_field_line(DVec2::new(f64::from(row[0]), f64::from(row[1])), f64::from(row[2]));
        let got_point = DVec3::new(f64::from(got[0]), f64::from(got[1]), f64::from(got[2]));
        // f32 at 7000 km is good to half a metre; a driver's sine to a few of those.
        assert!(got_point.distance(want) < 0.02, "{row:?}: {got_point} on the GPU, {want} in Rust");
        let number = (random::hash(row[3].to_bits()) >> 8) as f32 / 16_777_216.0;
        assert_eq!(got[3], number, "{row:?}");
    }
}

fn surroundings() -> Surroundings {
    Surroundings { table: Arc::new(lensing::default_table()), stars: Vec::new(), milky_way: vec![(1, 1, vec![0.0])] }
}

/// Greens of a picture that stand out from red and blue.
fn green(picture: &readback::Picture) -> f32 {
    picture.linear.iter().map(|p| (p[1] - p[0].max(p[2])).max(0.0)).sum()
}

#[test]
fn an_aurora_is_drawn_where_it_is_and_only_there() {
    let scene = scene::load("aurora-orbit").unwrap();
    let size = [160, 90];
    let mut renderer = Renderer::new(&GPU, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, size);
    let mut config = GameConfig::default();
    config.aurora.streaks = 3000;
    let stage = Stage::new(&mut renderer, &scene, &config);
    let camera = stage.camera(0.0, &[]);
    let frame = stage.frame(camera, size, 0.0, &[], None, &settings(&config));
    let aurora = frame.aurora.as_ref().expect("the aurora is in sight");
    let streaks = aurora.settings.counts[0];
    // Each segment has at least its eight.
    assert!(streaks <= 3000 + 8 * aurora.segments.len() as u32, "{streaks}");
    assert!(aurora.segments.iter().all(|segment| segment.range[2] % 8 == 0 && segment.light[0].is_finite()));
    let picture = renderer.picture(&frame, false).unwrap();
    assert!(picture.linear.iter().flatten().all(|x| x.is_finite()));
    let shines = green(&picture);
    assert!(shines > 1.0, "{shines}");

    // The paper's walk draws something else; switched off, there is none.
    config.aurora.walk = "linear".into();
    let linear = Stage::new(&mut renderer, &scene, &config).frame(camera, size, 0.0, &[], None, &settings(&config));
    let linear = renderer.picture(&linear, false).unwrap();
    assert!(linear.linear.iter().zip(&picture.linear).any(|(a, b)| (a[1] - b[1]).abs() > 0.01));
    config.aurora.enabled = false;
    let off = Stage::new(&mut renderer, &scene, &config).frame(camera, size, 0.0, &[], None, &settings(&config));
    assert!(off.aurora.is_none());
    assert!(green(&renderer.picture(&off, false).unwrap()) < 0.05 * shines);

    // Looking away from the planet, or from where it is a dot, nothing is simulated.
    let away = static_camera(DVec3::new(400.0, 0.0, 0.0), DVec3::X, DVec3::Z, 1.0);
    assert!(stage.frame(away, size, 0.0, &[], None, &settings(&config)).aurora.is_none());
    let far = static_camera(DVec3::new(400.0, 0.0, 0.0), DVec3::NEG_X, DVec3::Z, 1.0);
    assert!(stage.frame(far, size, 0.0, &[], None, &settings(&config)).aurora.is_none());
}
