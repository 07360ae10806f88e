//! The aurora on the GPU: its functions against their Rust twins, and what it draws.

use glam::{DVec2, DVec3};
use lensrunner::lensing;
use lensrunner::measure::aurora::experiment::{Job, TOLERANCE, Tables, VARIANTS, View, draw};
use lensrunner::measure::aurora::eye::Eye;
use lensrunner::measure::aurora::sheet::{Falls, Sheet};
use lensrunner::measure::aurora::splat::Splat;
use lensrunner::play::aurora_race;
use lensrunner::render::aurora::rooms::{CORNERS, DRAWS_BYTES, FOURS, Rooms};
use lensrunner::render::aurora::{PYRAMID, RAYS_PERIOD, planet_history, veil};
use lensrunner::render::frame::{Camera, FrameInput};
use lensrunner::render::placements::against_static;
use lensrunner::render::renderer::Surroundings;
use lensrunner::render::shaders::Pass;
use lensrunner::render::stage::{Stage, settings, static_camera};
use lensrunner::render::{Renderer, layout, readback};
use lensrunner::scene::aurora::air;
use lensrunner::scene::aurora::dipole::on_field_line;
use lensrunner::scene::aurora::fall::{self, Spectrum};
use lensrunner::scene::aurora::lines::{self, Line};
use lensrunner::scene::aurora::quantiles::Quantiles;
use lensrunner::scene::aurora::random;
use lensrunner::scene::{self, GameConfig, Scene};
use lensrunner::spacetime::light::{self, Branch, Order};
use std::sync::Arc;

use crate::render_shaders::GPU;
use crate::twin::{run, run_with};

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

/// The tables of the fall as the shaders read them.
fn falls(spectrum: Spectrum) -> wgpu::Buffer {
    layout::storage(&GPU, "falls", &Quantiles::new(&spectrum).laid_out())
}

/// Electrons as the game has them where the flux is the mean.
const SPECTRUM: Spectrum = Spectrum { accelerated: 4.0, thermal: 1.5 };

#[test]
fn streaks_of_the_shader_are_the_mean_of_electrons_of_the_physics() {
    let falls = falls(SPECTRUM);
    // Kinds as in streaks.wgsl.
    let body = "let fall = fall_at(row.x); let kind = u32(row.z); \
                twin_out[2u * id.x] = vec4<f32>(fall, height_of(fall, kind, row.y), 0.0, 0.0); \
                twin_out[2u * id.x + 1u] = photons_of(fall, kind, row.y);";
    let fluxes = [0.05, 0.3, 1.0, 2.2, 4.0, 9.0];
    let parts = [0.1, 0.35, 0.6, 0.85, 1.0];
    for flux in fluxes {
        // Brighter parts are harder: the potential goes as the square root of the flux, between a twentieth and four times its mean.
        let potential = SPECTRUM.accelerated * f64::from(flux).clamp(0.05, 4.0).sqrt();
        let made = light_of_electrons(&Spectrum { accelerated: potential, ..SPECTRUM });
        let whole: [f64; 4] = made[made.len() - 1];
        let rows: Vec<[f32; 4]> = [0.0, 1.0].iter().flat_map(|&kind| parts.map(|part| [flux, part, kind, 0.0])).collect();
        let got = run_with(Pass::AuroraWalk, body, [&[], &[]], &[(4, &falls)], &rows, 2);
        for (row, got) in rows.iter().zip(got.chunks(2)) {
            let red = row[2] == 1.0;
            let [index, height, ..] = got[0];
            assert!((0.0..=31.0).contains(&index), "{row:?}: row {index}");
            let lines: &[usize] = if red { &[2] } else { &[0, 1, 3] };
            let of = |sums: &[f64; 4]| lines.iter().map(|&line| sums[line]).sum::<f64>();
            // The part of the electrons' light that is above that height: to 2 %, for 32 rows and 32 parts and what chance makes of so many.
            let above_it = |line: usize| {
                let x = (TOP - f64::from(height)) / LEVEL;
                let k = (x as usize).min(made.len() - 2);
                made[k][line] + (x - k as f64) * (made[k + 1][line] - made[k][line])
            };
            let above = lines.iter().map(|&line| above_it(line)).sum::<f64>() / of(&whole);
            let bottom = if red { 130.0 } else { 84.0 };
            assert!(
                (above - f64::from(row[1])).abs() < 0.02 || (row[1] == 1.0 && f64::from(height) <= bottom + 12.0),
                "{row:?}: {above} of the light is above {height} km"
            );
            for line in 0..4 {
                // What little is made below the least height is drawn there.
                let want = if row[1] == 1.0 { whole[line] } else { above_it(line) };
                let want = if lines.contains(&line) { want } else { 0.0 };
                let off = (f64::from(got[1][line]) - want).abs();
                assert!(off < 0.03 * whole[line] + 1e-6, "{row:?}, line {line}: {} photons, {want} of electrons", got[1][line]);
            }
        }
    }
}

/// The first of the levels of [`light_of_electrons`], and from each to the next, km.
const TOP: f64 = 500.0;
const LEVEL: f64 = 1.0;

/// Photons of each line above levels down to 80 km, for each 35 eV that 16,000 electrons drawn one by one bring down, each falling by itself.
fn light_of_electrons(spectrum: &Spectrum) -> Vec<[f64; 4]> {
    // What falls between two levels shines as in their middle.
    let levels = (0..=420).map(|k| TOP - LEVEL * f64::from(k)).map(|z| (air::overhead(z), lines::photons(z + 0.5 * LEVEL)));
    let levels: Vec<(f64, [f64; 4])> = levels.collect();
    let mut sums = vec![[0.0; 4]; levels.len()];
    let mut brought = 0.0;
    for electron in 0..16_000u32 {
        let draw = |k: u32| (f64::from(random::hash(electron.wrapping_mul(7) + random::hash(k)) >> 8) + 0.5) / 16_777_216.0;
        let energy = spectrum.energy(draw(1), draw(2), draw(3));
        let reach = fall::slope(draw(4)) * fall::range(energy);
        brought += energy;
        let mut sum = [0.0; 4];
        let mut before = 1.0;
        for ((overhead, photons), sums) in levels.iter().zip(&mut sums) {
            let left = fall::share_left(*overhead, reach);
            for line in 0..4 {
                sum[line] += energy * (before - left) * photons[line];
                sums[line] += sum[line];
            }
            before = left;
        }
    }
    sums.iter().map(|sum| sum.map(|light| light / brought)).collect()
}

#[test]
fn red_lags_in_the_shader_as_its_lifetime_says() {
    let falls = falls(SPECTRUM);
    // Kinds as in streaks.wgsl: green, red; streaks have waits that are even over many of them.
    let body = "var streak: Streak; streak.kind = u32(row.x); streak.wait = unit(hash(id.x)); \
                twin_out[id.x] = vec4<f32>(waits(streak, row.y), 0.0, 0.0, 0.0);";
    for (kind, line) in [(0, Line::Green), (1, Line::Red)] {
        for height in [110.0, 160.0, 220.0, 300.0] {
            let rows = vec![[kind as f32, height, 0.0, 0.0]; 8000];
            let waits = run_with(Pass::AuroraWalk, body, [&[], &[]], &[(4, &falls)], &rows, 1);
            let mean = waits.iter().map(|wait| f64::from(wait[0])).sum::<f64>() / waits.len() as f64;
            let want = lines::delays(f64::from(height))[line as usize];
            // The mean of 8,000 exponential draws is good to 1.1 %; between its 64 heights the table is off by a few per cent, and by milliseconds
            // where the life is that short.
            assert!((mean - want).abs() <= 0.05 * want + 0.01, "{line:?} at {height} km waits {mean} s, lives {want} s");
        }
    }
}

#[test]
fn red_lags_where_it_is_drawn_as_its_lifetime_says() {
    // A curtain that moves evenly is drawn, at a height between two ends of chords, as old as the ends' mean waits say between them.
    let falls = falls(SPECTRUM);
    let body = "let count = u32(row.y); let chord = chord_at(RED, row.x, count); let above = chord_height(RED, chord, count); \
                let below = chord_height(RED, chord + 1u, count); let s = clamp((above - row.x) / (above - below), 0.0, 1.0); \
                twin_out[id.x] = vec4<f32>(mix(mean_wait(RED, above), mean_wait(RED, below), s), s, above, below);";
    // So many chords, and by how much the straight line between their ends may be off, in parts of the wait: a curtain moves some 100 m in a second.
    for (count, part) in [(4.0, 1.0), (8.0, 0.3)] {
        let rows: Vec<[f32; 4]> = (150..400).step_by(10).map(|z| [z as f32, count, 0.0, 0.0]).collect();
        for (row, got) in rows.iter().zip(run_with(Pass::AuroraWalk, body, [&[], &[]], &[(4, &falls)], &rows, 1)) {
            let want = lines::delays(f64::from(row[0]))[Line::Red as usize];
            assert!(got[2] >= row[0] && row[0] >= got[3], "{row:?} lies in {got:?}");
            assert!((f64::from(got[0]) - want).abs() < part * want + 1.0, "{} km, {count} chords: {} s, lives {want} s", row[0], got[0]);
        }
    }
}

#[test]
fn the_clock_of_the_rays_starts_again_without_a_jump() {
    let rows: Vec<[f32; 4]> = (0..400).map(|k| [0.37 * k as f32, 0.0, 0.0, 0.0]).collect();
    let body = "twin_out[id.x] = vec4<f32>(rays(row.x, 0.0, 0.0), rays(row.x, 102400.0, 0.0), rays(row.x, -3.0, 0.0), rays(row.x, 102397.0, 0.0));";
    for (row, got) in rows.iter().zip(run(Pass::AuroraEnds, body, [&[], &[]], &rows, 1)) {
        // Late in the day a number of f32 is a hundredth of a second.
        assert!((got[0] - got[1]).abs() < 0.03 && (got[2] - got[3]).abs() < 0.03, "{row:?}: {got:?}");
    }
    assert_eq!(RAYS_PERIOD, 102_400.0);
}

#[test]
fn a_planet_far_away_has_a_history() {
    let text = "[camera]\nposition = [-2000.0, 0.0, 0.0]\n[planet]\norbit_radius = 600.0\nradius = 0.8\n";
    let path = std::env::temp_dir().join(format!("lensrunner-far-{}.toml", std::process::id()));
    std::fs::write(&path, text).unwrap();
    let planet = scene::load(path.to_str().unwrap()).unwrap().planet.unwrap();
    std::fs::remove_file(&path).unwrap();
    for back in [10.0, 900.0, 6000.0, 1e5] {
        let history = planet_history(&planet, 0.0, back, planet.dipole()).expect("it is somewhere");
        assert!(history.at(-back).position.is_finite() && history.at(0.0).position.is_finite());
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
    // Each segment has at least its ten: five in the north and five in the south.
    assert!(streaks <= 3000 + 10 * aurora.segments.len() as u32, "{streaks}");
    assert!(aurora.segments.iter().all(|segment| segment.range[2] % 10 == 0 && segment.light[0].is_finite()));
    let picture = renderer.picture(&frame, false).unwrap();
    assert!(picture.linear.iter().flatten().all(|x| x.is_finite()));
    let shines = green(&picture);
    assert!(shines > 1.0, "{shines}");

    // The paper's walk draws something else; switched off, there is none.
    config.aurora.walk = "linear".into();
    let linear = Stage::new(&mut renderer, &scene, &config).frame(camera, size, 0.0, &[], None, &settings(&config));
    let linear = renderer.picture(&linear, false).unwrap();
    let most = picture.linear.iter().map(|p| p[1]).fold(0.0, f32::max);
    assert!(linear.linear.iter().zip(&picture.linear).any(|(a, b)| (a[1] - b[1]).abs() > 0.01 * most));
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

#[test]
fn the_adapter_draws_the_experiment_as_the_processor_does() {
    let (_, mut runners) = aurora_race::runners();
    // An adapter that cannot add up 32-bit floats draws none, and says so.
    if runners.is_empty() {
        return;
    }
    let table = lensing::default_table();
    let (falls, tables) = (Falls::new(), Tables::default());
    let sheet = Sheet::numbered(2);
    let streaks = sheet.streaks(150);
    // From amid the curtains too: what is behind the camera leaves no light.
    let amid = Eye::flat(DVec3::new(0.0, 0.0, 150.0), DVec3::new(0.0, 100.0, 150.0), DVec3::Z, 1.0, [128, 72]);
    let eyes = [View::Below, View::Bent].map(|view| view.eye([128, 72], &table));
    for (eye, view) in eyes.into_iter().zip(["below", "bent"]).chain([(amid, "amid")]) {
        let job = Job { eye: &eye, falls: &falls, streaks: &streaks, seed: sheet.seed, splat: Splat { radius: 0.5, table: true } };
        for runner in &mut runners {
            let like = if runner.name() == "exact-gpu" { "exact" } else { "particles" };
            let want = draw(*VARIANTS.iter().find(|variant| variant.name == like).unwrap(), &job, &tables).picture;
            let got = runner.draw(&job).expect("the adapter draws");
            // Rounding of f32 moves a collision here and there to the next level, and steps of the processor's tabulated Gaussian differ from the adapter's own.
            let off = got.picture.error(&want);
            assert!(off < 0.02, "{view}, {}: off by {off} (chords allow {TOLERANCE} px)", runner.name());
            let light = |pixels: &[[f32; 4]]| pixels.iter().map(|pixel| f64::from(pixel[0])).sum::<f64>();
            let ratio = light(&got.picture.pixels) / light(&want.pixels);
            assert!((ratio - 1.0).abs() < 0.02, "{view}, {}: {ratio} of the light", runner.name());
        }
    }
}

#[test]
fn light_crosses_the_plane_of_the_disk_where_its_ray_does() {
    let mut found = 0;
    for k in 0..60 {
        let turn = 0.37 * f64::from(k);
        let camera = static_camera(DVec3::new(9.0, 1.0, 2.5), -DVec3::X, DVec3::Z, 1.0);
        let position = DVec3::new(14.0 * turn.cos(), 14.0 * turn.sin(), 5.0 * (1.7 * turn).sin());
        for order in [1, 2].map(|order| Order::new(order).unwrap()) {
            for radius in veil::crossings(&camera, position, order, true) {
                // The place of the crossing lies in the ray's plane and in that of the disk, on one side or the other; its light comes the same way.
                let line = camera.position.cross(position).cross(DVec3::Z).normalize();
                let seen = |place: DVec3| {
                    let (l, r) = (camera.radius(), place.length());
                    let n = camera.position / l;
                    let phi = (place - n * place.dot(n)).length().atan2(place.dot(n));
                    Order::ALL.map(|order| {
                        let ray = light::connect(1.0 / r, order.swept(phi), 1.0 / l, Branch::Plus)?;
                        let psi = light::rain_angle(ray.slope, ray.energy, 1.0 / l);
                        let side = (place - n * place.dot(n)).normalize() * if order.flips() { -1.0 } else { 1.0 };
                        Some(n * psi.cos() + side * psi.sin())
                    })
                };
                let want = seen(position)[usize::from(order.number()) - 1].unwrap();
                let nearest = [line, -line]
                    .into_iter()
                    .flat_map(|side| seen(side * radius))
                    .flatten()
                    .map(|direction| direction.angle_between(want))
                    .fold(f64::INFINITY, f64::min);
                // Linear between steps of a fiftieth of a radian: a thousandth of the radius.
                assert!(nearest < 2e-3, "order {}, {position}: {radius} is seen {nearest} away", order.number());
                found += 1;
            }
        }
    }
    assert!(found > 60, "{found}");
}

/// The aurora alone: no planet, no sky.
fn aurora_alone(stage: &Stage, camera: Camera, size: [u32; 2], time: f64, config: &GameConfig) -> FrameInput {
    let mut settings = settings(config);
    (settings.stars, settings.milky_way, settings.bloom) = (false, false, 0.0);
    let mut frame = stage.frame(camera, size, time, &[], None, &settings);
    frame.placed.clear();
    frame
}

/// The light in a picture.
fn total(picture: &readback::Picture) -> f64 {
    picture.linear.iter().map(|p| f64::from(p[0] + p[1] + p[2])).sum()
}

fn orbit_scene() -> (Scene, GameConfig) {
    let mut config = GameConfig::default();
    config.aurora.streaks = 4000;
    (scene::load("aurora-orbit").unwrap(), config)
}

#[test]
fn brightness_never_jumps() {
    let (scene, config) = orbit_scene();
    let size = [96, 54];
    let mut renderer = Renderer::new(&GPU, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, size);
    let stage = Stage::new(&mut renderer, &scene, &config);
    let planet = scene.planet.unwrap().state(0.0).unwrap().position;
    let aside = (planet.normalize() * 0.9 + DVec3::Z * 0.43).normalize();
    let mut light = |distance: f64, time: f64| {
        let camera = static_camera(planet + aside * distance, -aside, DVec3::Z, 0.35);
        let frame = aurora_alone(&stage, camera, size, time, &config);
        let streaks = frame.aurora.as_ref().map_or(0, |aurora| aurora.settings.counts[0]);
        (streaks, total(&renderer.picture(&frame, false).unwrap()))
    };
    // Away from the planet until it is out of sight by its size: fewer and fewer streaks, fewer strokes, fewer chords, none.
    let away: Vec<(u32, f64)> = (0..54).map(|k| light(9.0 * 1.035f64.powi(k), 0.0)).collect();
    assert!(away[0].0 > 100 && away[53] == (0, 0.0), "{:?} to {:?}", away[0], away[53]);
    // Here a step is 3.5 % of the distance, hundreds of frames of the game. Fewer streaks stand elsewhere among the rays.
    smooth(&away, 0.05);
    // And as time goes by, past steps of the curtains' motion.
    let still: Vec<(u32, f64)> = (0..30).map(|k| light(12.0, 0.05 * f64::from(k))).collect();
    smooth(&still, 0.02);
}

/// Each brightness is the mean of its neighbours, but for that part of the brightest of the three, and half a per cent of the brightest of all.
fn smooth(steps: &[(u32, f64)], part: f64) {
    let least = 0.005 * steps.iter().map(|step| step.1).fold(0.0, f64::max);
    for (k, three) in steps.windows(3).enumerate() {
        let [a, b, c] = [three[0].1, three[1].1, three[2].1];
        let jump = (b - 0.5 * (a + c)).abs();
        assert!(jump <= part * a.max(b).max(c) + least, "step {k}: {three:?} (streaks, light)");
    }
}

#[test]
fn the_disk_dims_an_aurora_behind_it() {
    let text = |phase: f64| {
        format!(
            "[camera]\nposition = [0.0, -14.0, 12.0]\n[disk]\n[planet]\norbit_radius = 8.0\ninclination = 0.35\nradius = 0.8\nphase = {phase}\n"
        )
    };
    let size = [96, 54];
    let mut renderer = Renderer::new(&GPU, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, size);
    // Light takes 14 r_s/c: the planet was half a radian back then, under the plane of the disk or above it.
    for (phase, behind) in [(-1.1, true), (2.0, false)] {
        let path = std::env::temp_dir().join(format!("lensrunner-veil-{}-{behind}.toml", std::process::id()));
        std::fs::write(&path, text(phase)).unwrap();
        let scene = scene::load(path.to_str().unwrap()).unwrap();
        std::fs::remove_file(&path).unwrap();
        let mut light = |opacity: f64| {
            let mut config = GameConfig::default();
            (config.aurora.streaks, config.aurora.brightness, config.disk.opacity) = (4000, 0.5, opacity);
            let stage = Stage::new(&mut renderer, &scene, &config);
            let planet = scene.planet.unwrap().state(-14.0).unwrap().position;
            let eye = DVec3::new(0.0, -14.0, 12.0);
            let camera = static_camera(eye, planet - eye, DVec3::Z, 0.35);
            let mut frame = aurora_alone(&stage, camera, size, 0.0, &config);
            let images = frame.aurora.as_ref().expect("the aurora is in sight").behind.clone();
            assert_eq!(images[0], behind, "{images:?}");
            let with = total(&renderer.picture(&frame, false).unwrap());
            frame.aurora = None;
            with - total(&renderer.picture(&frame, false).unwrap())
        };
        let share = light(0.9) / light(0.0);
        // The disk lets a tenth through where it is seen face on.
        assert!(if behind { (0.0..0.5).contains(&share) } else { (share - 1.0).abs() < 0.1 }, "{share} of the light is left");
    }
}

#[test]
fn the_pyramid_changes_no_picture() {
    let size = [192, 108];
    let mut renderer = Renderer::new(&GPU, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, size);
    for name in ["aurora-below", "aurora-orbit"] {
        let scene = scene::load(name).unwrap();
        let mut config = GameConfig::default();
        // Points so wide that they go to coarse levels, and outlines of the planet among them.
        (config.aurora.streaks, config.aurora.radius) = (1500, if name == "aurora-orbit" { 50.0 } else { 12.0 });
        let stage = Stage::new(&mut renderer, &scene, &config);
        let mut frame = stage.frame(stage.camera(0.0, &[]), size, 0.0, &[], None, &settings(&config));
        (frame.settings.stars, frame.settings.milky_way, frame.settings.bloom) = (false, false, 0.0);
        let got = renderer.picture(&frame, false).unwrap();
        let levels = renderer.aurora_strokes().unwrap().unwrap();
        let coarse: u32 = levels[1..].iter().sum();
        assert!(levels.len() == PYRAMID as usize && coarse > levels[0] / 10, "{name}: {levels:?}");
        frame.aurora.as_mut().unwrap().settings.strokes[1] = 1.0;
        let want = renderer.picture(&frame, false).unwrap();
        assert_eq!(renderer.aurora_strokes().unwrap().unwrap().len(), 1);
        let square = |p: &[f32; 4], q: &[f32; 4]| (0..3).map(|k| f64::from(p[k] - q[k]).powi(2)).sum::<f64>();
        let off: f64 = got.linear.iter().zip(&want.linear).map(|(p, q)| square(p, q)).sum();
        let all: f64 = want.linear.iter().map(|p| square(p, &[0.0; 4])).sum();
        // As the experiment's: 2 % of the root mean square. Light is kept to what lies beyond three standard deviations.
        assert!((off / all).sqrt() < 0.02, "{name}: off by {}", (off / all).sqrt());
        let ratio = total(&got) / total(&want);
        assert!((ratio - 1.0).abs() < 0.01, "{name}: {ratio} of the light");
        // No light where the planet hides it, not a pixel further than before.
        let most = want.linear.iter().map(|p| p[1]).fold(0.0, f32::max);
        let worst = got.linear.iter().zip(&want.linear).map(|(p, q)| (p[1] - q[1]).abs()).fold(0.0, f32::max);
        println!("{name}: rms {:.4}, light {ratio:.4}, worst pixel {:.4}, {levels:?}", (off / all).sqrt(), worst / most);
        assert!(worst < 0.06 * most, "{name}: a pixel is off by {worst} of {most}");
    }
}

#[test]
fn rooms_of_strokes_do_not_overlap() {
    for (finest, levels, images) in [(8, 1, 3), (800, PYRAMID, 2), (64, 4, 3)] {
        let rooms = Rooms { finest, levels };
        let numbers = rooms.empty(images);
        assert_eq!(16 * numbers.len() as u64, u64::from(images) * DRAWS_BYTES);
        let mut after = 0;
        for image in numbers.chunks(FOURS) {
            for pair in 0..levels.div_ceil(2) {
                // As many as room_of lets in, from the beginning of the first level's and from the end of the second's.
                let room = CORNERS * (finest >> pair) as u32;
                let level = 2 * pair as usize;
                assert_eq!(image[level][2], after, "{rooms:?}, level {level}");
                // The coarsest has a room of its own.
                assert!(level + 1 == PYRAMID as usize || image[level + 1][2] == after + room, "{rooms:?}, level {}", level + 1);
                after += room;
            }
        }
        assert_eq!(u64::from(after), u64::from(CORNERS) * rooms.all() * u64::from(images));
    }
}

#[test]
fn parts_of_a_streak_that_are_one_stroke_change_no_picture() {
    let size = [192, 108];
    let mut renderer = Renderer::new(&GPU, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, size);
    let mut config = GameConfig::default();
    config.aurora.streaks = 4000;
    for name in ["aurora-below", "aurora-orbit"] {
        let stage = Stage::new(&mut renderer, &scene::load(name).unwrap(), &config);
        let mut frame = aurora_alone(&stage, stage.camera(0.0, &[]), size, 0.0, &config);
        // Parts of a streak, and a picture of each; room for the most.
        let drawn = [24, 48].map(|parts| {
            let settings = &mut frame.aurora.as_mut().unwrap().settings;
            let streaks = settings.counts[0];
            (settings.counts[2], settings.history[2]) = (parts, 48 * streaks);
            let picture = renderer.picture(&frame, false).unwrap();
            let strokes: u32 = renderer.aurora_strokes().unwrap().unwrap().iter().sum();
            assert!(f64::from(strokes) < 0.8 * f64::from(parts * streaks), "{name}: {strokes} strokes, {parts} parts");
            picture
        });
        let [few, many] = &drawn;
        let square = |p: &[f32; 4], q: &[f32; 4]| (0..3).map(|k| f64::from(p[k] - q[k]).powi(2)).sum::<f64>();
        let off: f64 = few.linear.iter().zip(&many.linear).map(|(p, q)| square(p, q)).sum();
        let all: f64 = many.linear.iter().map(|p| square(p, &[0.0; 4])).sum();
        println!("{name}: rms {:.4}, light {:.4}", (off / all).sqrt(), total(few) / total(many));
        // 24 parts are themselves coarser than 48: 3 % seen from below. Joined wrongly they would have other light.
        assert!((off / all).sqrt() < 0.05, "{name}: off by {}", (off / all).sqrt());
        assert!((total(few) / total(many) - 1.0).abs() < 0.01, "{name}: {} of the light", total(few) / total(many));
    }
}

#[test]
fn the_same_frame_is_drawn_the_same() {
    // Halves lose what is faint in the order in which threads append it.
    if !GPU.device.features().contains(wgpu::Features::FLOAT32_BLENDABLE | wgpu::Features::FLOAT32_FILTERABLE) {
        return;
    }
    let size = [192, 108];
    let mut renderer = Renderer::new(&GPU, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, size);
    let config = GameConfig::default();
    for name in ["aurora-below", "aurora-side"] {
        let stage = Stage::new(&mut renderer, &scene::load(name).unwrap(), &config);
        let frame = aurora_alone(&stage, stage.camera(0.0, &[]), size, 0.0, &config);
        let [one, other] = [(), ()].map(|()| renderer.picture(&frame, false).unwrap());
        let most = one.linear.iter().flatten().copied().fold(0.0, f32::max);
        assert!(most > 0.1, "{name}: {most}");
        for (a, b) in one.linear.iter().flatten().zip(other.linear.iter().flatten()) {
            // Sums of 32-bit floats differ by some 1e-6 of themselves; in the picture, of halves, that is the next number at most.
            assert!((a - b).abs() <= a.max(*b) / 1000.0 + 1e-6, "{name}: {a} and {b}");
        }
    }
}

#[test]
fn nothing_is_left_of_an_earlier_frame() {
    // The finest level is made black only where the new frame has light there; an odd size, that tiles do not divide.
    let size = [197, 111];
    let config = GameConfig::default();
    let drawn = |names: &[&str]| {
        let mut renderer = Renderer::new(&GPU, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, size);
        let pictures = names.iter().map(|name| {
            let stage = Stage::new(&mut renderer, &scene::load(name).unwrap(), &config);
            let mut frame = aurora_alone(&stage, stage.camera(0.0, &[]), size, 0.0, &config);
            frame.aurora.as_mut().unwrap().settings.strokes[1] = 1.0;
            renderer.picture(&frame, false).unwrap()
        });
        pictures.last().unwrap()
    };
    let [fresh, used] = [drawn(&["aurora-orbit"]), drawn(&["aurora-below", "aurora-orbit"])];
    let most = fresh.linear.iter().flatten().copied().fold(0.0, f32::max);
    assert!(most > 0.1, "{most}");
    for (a, b) in fresh.linear.iter().flatten().zip(used.linear.iter().flatten()) {
        // Halves lose the faintest strokes, where those are all that the adapter adds up in.
        assert!((a - b).abs() <= 0.02 * most, "{a} and {b}, of {most}");
    }
}

#[test]
fn a_watched_aurora_goes_on_without_a_burst() {
    let (scene, config) = orbit_scene();
    let size = [96, 54];
    let mut renderer = Renderer::new(&GPU, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, size);
    let stage = Stage::new(&mut renderer, &scene, &config).watched();
    // The camera goes with the planet.
    let mut light = |stage: &Stage, config: &GameConfig, time: f64| {
        let frame = aurora_alone(stage, stage.camera(time, &[]), size, time, config);
        let nodes = frame.aurora.as_ref().unwrap().nodes.clone();
        (nodes, total(&renderer.picture(&frame, false).unwrap()))
    };
    // Ten frames, twelve days of the planet out of sight, ten more: curtains and their brightness go on where they were.
    let gap = 12.0 * scene.planet.unwrap().day;
    let times = (0..10).map(|k| 0.05 * f64::from(k)).chain((0..10).map(|k| gap + 0.05 * f64::from(k)));
    let steps: Vec<_> = times.map(|time| light(&stage, &config, time)).collect();
    for pair in steps.windows(2) {
        // Other rays pass in the meantime; the planet turns a little.
        let ratio = pair[1].1 / pair[0].1;
        assert!((0.6..1.6).contains(&ratio), "{ratio} times as much light from one frame to the next");
        // No row is older than four steps of half a second: the row that was the newest is among the first three.
        let row = pair[0].0.len() / 128;
        let kept = (0..3).any(|k| pair[1].0[k * row..(k + 1) * row] == pair[0].0[..row]);
        assert!(kept, "the curtains have moved by more than two rows in a frame");
    }
    // Keys of brightness, walk and pace leave the curtains as they are, and another seed does not.
    let before = light(&stage, &config, gap + 1.0).0;
    let mut other = config.clone();
    (other.aurora.brightness, other.aurora.pace, other.aurora.walk) = (0.02, 9.0, "linear".into());
    stage.change_aurora(&other.aurora);
    let row = before.len() / 128;
    let after = light(&stage, &other, gap + 1.0).0;
    assert!((0..2).any(|k| after[k * row..(k + 1) * row] == before[..row]), "another pace makes no other curtains");
    other.aurora.seed += 1;
    stage.change_aurora(&other.aurora);
    assert!(light(&stage, &other, gap + 1.0).0[..row] != before[..row]);
    other.aurora.enabled = false;
    stage.change_aurora(&other.aurora);
    assert!(aurora_alone(&stage, stage.camera(gap + 1.0, &[]), size, gap + 1.0, &other).aurora.is_none());
}

#[test]
fn lines_shift_as_the_settings_ask() {
    let (scene, mut config) = orbit_scene();
    let size = [96, 54];
    let mut renderer = Renderer::new(&GPU, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, size);
    // The red line's X over Y falls as it becomes greener.
    let mut hue = |lensing: bool, light_delay: bool| {
        (config.render.lensing, config.render.light_delay) = (lensing, light_delay);
        let stage = Stage::new(&mut renderer, &scene, &config);
        let camera = stage.camera(0.0, &[]);
        let frame = stage.frame(camera, size, 0.0, &[], None, &settings(&config));
        let red = frame.aurora.unwrap().colours[0].lines[0][Line::Red as usize];
        (camera, f64::from(red[0] / red[1]))
    };
    let expected = |g: f64| {
        let [x, y, _] = lines::kilorayleigh_xyz(g)[Line::Red as usize];
        x / y
    };
    // Straight light, at once: g = γₑ(1 − n·vₑ)⁻¹ … of special relativity, with the speeds against what hovers there.
    let (camera, flat) = hue(false, false);
    let planet = scene.planet.unwrap().state(0.0).unwrap();
    let speed = |position: DVec3, momentum: DVec3| {
        let p = against_static(position, momentum);
        p / (1.0 + p.length_squared()).sqrt()
    };
    let n = (camera.position - planet.position).normalize();
    let doppler = |v: DVec3| (1.0 - v.dot(n)) / (1.0 - v.length_squared()).sqrt();
    let g = doppler(speed(camera.position, camera.momentum)) / doppler(speed(planet.position, planet.momentum));
    assert!((flat / expected(g) - 1.0).abs() < 1e-3, "{flat} in the frame, {} for g = {g}", expected(g));
    // With the hole its field's part comes in, and with the delay another moment.
    let (_, bent) = hue(true, true);
    assert!((bent - flat).abs() > 1e-5, "{bent} and {flat}");
}
