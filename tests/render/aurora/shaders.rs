//! The aurora on the GPU: its functions against their Rust twins, its history, and its numbers.

use glam::{DVec2, DVec3};
use lensrunner::render::aurora::capacities::{CORNERS, DRAWS_BYTES, FOURS, StrokeCapacities};
use lensrunner::render::aurora::{AuroraSettings, PYRAMID, PlanetLine, RAYS_PERIOD, occlusion};
use lensrunner::render::gpu::layout;
use lensrunner::render::gpu::shaders::Pass;
use lensrunner::render::stage::static_camera;
use lensrunner::scene::Scene;
use lensrunner::scene::aurora::air;
use lensrunner::scene::aurora::dipole::on_field_line;
use lensrunner::scene::aurora::fall::{self, Spectrum};
use lensrunner::scene::aurora::lines::{self, Line};
use lensrunner::scene::aurora::motion::RAYS_LENGTH;
use lensrunner::scene::aurora::quantiles::Quantiles;
use lensrunner::scene::aurora::random;
use lensrunner::spacetime::light::{self, Branch, Order};

use crate::gpu::GPU;
use crate::twin::{run, run_with};

#[test]
fn field_lines_and_random_numbers_are_the_same_in_both_languages() {
    let rows: Vec<[f32; 4]> =
        (0..400u32).map(|k| [13.7 * k as f32 - 2500.0, 9.1 * k as f32 - 1500.0, 80.0 + k as f32, f32::from_bits(k * 7919)]).collect();
    let lines = run(
        Pass::AuroraWalk,
        "#import lensrunner::aurora::streaks::on_field_line
#import lensrunner::gpu::random::{hash, unit}
    twin_out[id.x] = vec4<f32>(on_field_line(row.xy, row.z), unit(hash(bitcast<u32>(row.w))));",
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

/// Settings that say no more than the heights between which those are drawn.
fn heights(spectrum: Spectrum) -> wgpu::Buffer {
    let [[green_top, green_foot], [red_top, red_foot]] = Quantiles::new(&spectrum).ends;
    let settings = AuroraSettings { green_top, green_foot, red_top, red_foot, ..AuroraSettings::default() };
    let uniform = layout::buffer(&GPU.device, "aurora", size_of::<AuroraSettings>() as u64, wgpu::BufferUsages::UNIFORM);
    GPU.queue.write_buffer(&uniform, 0, bytemuck::bytes_of(&settings));
    uniform
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
    let ends = Quantiles::new(&SPECTRUM).ends;
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
            // The part of the electrons' light that is above that height: to 2 %, for 32 rows and 32 parts and what chance makes of so
            // many.
            let above_it = |line: usize| {
                let x = (TOP - f64::from(height)) / LEVEL;
                let k = (x as usize).min(made.len() - 2);
                made[k][line] + (x - k as f64) * (made[k + 1][line] - made[k][line])
            };
            let above = lines.iter().map(|&line| above_it(line)).sum::<f64>() / of(&whole);
            let bottom = f64::from(ends[usize::from(red)][1]);
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

/// Photons of each line above levels down to 80 km, for each 35 eV that 16,000 electrons drawn one by one bring down, each falling by
/// itself.
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
    let body = "#import lensrunner::aurora::streaks::waits
#import lensrunner::gpu::random::{hash, unit}
    var streak: Streak; streak.kind = u32(row.x); streak.wait = unit(hash(id.x)); \
                twin_out[id.x] = vec4<f32>(waits(streak, row.y), 0.0, 0.0, 0.0);";
    for (kind, line) in [(0, Line::Green), (1, Line::Red)] {
        for height in [110.0, 160.0, 220.0, 300.0] {
            let rows = vec![[kind as f32, height, 0.0, 0.0]; 8000];
            let waits = run_with(Pass::AuroraWalk, body, [&[], &[]], &[(4, &falls)], &rows, 1);
            let mean = waits.iter().map(|wait| f64::from(wait[0])).sum::<f64>() / waits.len() as f64;
            let want = lines::delays(f64::from(height))[line as usize];
            assert!(
                waits.iter().all(|wait| f64::from(wait[0]) <= 4.0 * (1.05 * want + 0.01)),
                "{line:?} at {height} km: one waits too long"
            );
            // The mean of 8,000 draws of what decays within four lives is good to 1 %; between its 64 heights the table is off by a few per
            // cent, and by milliseconds where the life is that short. Measured 0.010 of the life, and 4 ms.
            assert!((mean - want).abs() <= 0.02 * want + 0.01, "{line:?} at {height} km waits {mean} s, lives {want} s");
        }
    }
}

#[test]
fn red_lags_where_it_is_drawn_as_its_lifetime_says() {
    // A curtain that moves evenly is drawn, at a height between two ends of chords, as old as the ends' mean waits say between them.
    let falls = falls(SPECTRUM);
    let body = "#import lensrunner::aurora::streaks::{mean_wait, RED}
    let count = u32(row.y); let chord = chord_at(RED, row.x, count); let above = chord_height(RED, chord, count); \
                let below = chord_height(RED, chord + 1u, count); let s = clamp((above - row.x) / (above - below), 0.0, 1.0); \
                twin_out[id.x] = vec4<f32>(mix(mean_wait(RED, above), mean_wait(RED, below), s), s, above, below);";
    let heights = heights(SPECTRUM);
    // So many chords, and by how much the straight line between their ends may be off, in parts of the wait and in seconds: a curtain moves
    // some 100 m in a second. Measured 0.30 of the wait and 2.1 s with 4 chords, 0.17 and 0.9 s with 8.
    for (count, part, seconds) in [(4.0, 0.4, 2.0), (8.0, 0.2, 1.0)] {
        let rows: Vec<[f32; 4]> = (150..400).step_by(10).map(|z| [z as f32, count, 0.0, 0.0]).collect();
        for (row, got) in rows.iter().zip(run_with(Pass::AuroraWalk, body, [&[], &[]], &[(0, &heights), (4, &falls)], &rows, 1)) {
            let want = lines::delays(f64::from(row[0]))[Line::Red as usize];
            assert!(got[2] >= row[0] && row[0] >= got[3], "{row:?} lies in {got:?}");
            assert!(
                (f64::from(got[0]) - want).abs() < part * want + seconds,
                "{} km, {count} chords: {} s, lives {want} s",
                row[0],
                got[0]
            );
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
fn rays_go_round_an_oval_without_a_seam() {
    let rows: Vec<[f32; 4]> = (0..400).map(|k| [0.37 * k as f32, 9.0 * RAYS_LENGTH as f32, 0.0, 0.0]).collect();
    let body =
        "twin_out[id.x] = vec4<f32>(rays(row.x, 5.0, 0.0), rays(row.x + row.y, 5.0, 0.0), rays(row.x, 5.0, 1.6), rays(row.x, 5.0, 11.0));";
    let (mut fine, mut coarse) = (0.0f32, 0.0f32);
    for (row, got) in rows.iter().zip(run(Pass::AuroraEnds, body, [&[], &[]], &rows, 1)) {
        // After 15,000 km a number of f32 is a thousandth of one, and noise changes by 2 values a km at most.
        assert!((got[0] - got[1]).abs() < 0.02, "{row:?}: {got:?}");
        // Seen kilometres apart, the finer noise goes over to its mean first, and then all of it.
        (fine, coarse) = (fine.max((got[0] - got[2]).abs()), coarse.max((got[2] - 1.0).abs()));
        assert!((got[3] - 1.0).abs() < 1e-5, "{got:?}");
    }
    assert!(fine > 0.1 && coarse > 0.3, "{fine}, {coarse}");
}

#[test]
fn a_planet_far_away_has_a_history() {
    let text = "[camera]\nposition = [-2000.0, 0.0, 0.0]\n[planet]\norbit_radius = 600.0\nradius = 0.8\n";
    let planet = Scene::from_toml("far.toml".as_ref(), text).unwrap().planet.unwrap();
    for back in [10.0, 900.0, 6000.0, 1e5] {
        let mut line = PlanetLine::new(planet.dipole());
        let history = line.about(&planet, 0.0, back).expect("it is somewhere");
        for time in [-back, 0.0] {
            let off = history.at(time).position.distance(planet.state(time).unwrap().position);
            println!("{back} r_s/c back: off by {off}");
            assert!(off < 1e-6);
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
            let mut radii = Vec::new();
            occlusion::crossings(&camera, position, order, true, |radius| radii.push(radius));
            for radius in radii {
                // The place of the crossing lies in the ray's plane and in that of the disk, on one side or the other; its light comes the
                // same way.
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

#[test]
fn rooms_of_strokes_do_not_overlap() {
    for (finest, levels, images) in [(8, 1, 3), (800, PYRAMID, 2), (64, 4, 3)] {
        let capacities = StrokeCapacities { finest, levels };
        let numbers: Vec<[u32; 4]> = (0..images).flat_map(|image| capacities.empty(image)).collect();
        assert_eq!(16 * numbers.len() as u64, u64::from(images) * DRAWS_BYTES);
        let mut after = 0;
        for image in numbers.chunks(FOURS) {
            for pair in 0..levels.div_ceil(2) {
                // As many as allocate_stroke lets in, from the beginning of the first level's and from the end of the second's.
                let capacity = CORNERS * (finest >> pair) as u32;
                let level = 2 * pair as usize;
                assert_eq!(image[level][2], after, "{capacities:?}, level {level}");
                // The coarsest has a part of its own.
                assert!(level + 1 == PYRAMID as usize || image[level + 1][2] == after + capacity, "{capacities:?}, level {}", level + 1);
                after += capacity;
            }
        }
        assert_eq!(u64::from(after), u64::from(CORNERS) * capacities.all() * u64::from(images));
    }
}

#[test]
fn the_box_of_a_stroke_holds_it() {
    // In units of a level's pixel: a blur that goes aslant, as narrow as is added there at all (the lesser eigenvalue is 0.6), and more and
    // more drawn out.
    let body = "let level = u32(row.x); let pixel = f32(1u << level); let u = vec2<f32>(cos(row.y), sin(row.y)); \
                let blur = vec3<f32>(row.z * row.z / 0.4 + 0.6, 1.0, row.z) * pixel * pixel; \
                let shape = shape_of(level, u, row.w * pixel, Blur(blur.x, blur.y, blur.z)); \
                let around = box_of(vec2<f32>(0.0), shape, level); \
                let corners = max(abs(shape.half + shape.side), abs(shape.half - shape.side)); \
                twin_out[2u * id.x] = around; twin_out[2u * id.x + 1u] = vec4<f32>(corners, shape.sigma, dot(shape.side, u));";
    let rows: Vec<[f32; 4]> = (0..PYRAMID as usize * 9 * 4)
        .map(|k| [(k % PYRAMID as usize) as f32, 0.7 * (k / 7 % 9) as f32, [0.0, 1.0, 3.0, 6.0][k / 63], 2.0])
        .collect();
    for (row, got) in rows.iter().zip(run(Pass::AuroraWalk, body, [&[], &[]], &rows, 2).chunks(2)) {
        // What enlarging adds: a texel of each level to either side, down to the second finest.
        let pixel = 2f32.powf(row[0]);
        let reach = 2.0 * pixel - 2.0;
        let [left, top, right, bottom] = got[0];
        let [x, y, sigma, aslant] = got[1];
        assert!(x + reach <= right && y + reach <= bottom && -left == right && -top == bottom, "{row:?}: {got:?}");
        // No wider than that, and as the stroke is added: narrower than it is seen by what enlarging adds.
        assert!(right <= x + 2.0 * pixel + 1.0 && bottom <= y + 2.0 * pixel + 1.0, "{row:?}: {got:?}");
        let narrow = (pixel * pixel - 0.25 * (pixel * pixel - 1.0)).sqrt();
        assert!((sigma / narrow - 1.0).abs() < 1e-4, "{row:?}: {sigma}, not {narrow}");
        assert!((aslant - 2.6 * row[2] * pixel * pixel / narrow).abs() < 1e-3 * pixel * (1.0 + row[2]), "{row:?}: {aslant} aslant");
    }
}
