//! The aurora's lines, shifted from one side of a turning planet to the other.

use glam::{DQuat, DVec2, DVec3};
use lensrunner::render::aurora::shift::ImageShift;
use lensrunner::render::aurora::{Colours, PlanetLine, SHIFTS};
use lensrunner::render::gpu::layout;
use lensrunner::render::gpu::shaders::Pass;
use lensrunner::render::instances::{InstanceView, departure};
use lensrunner::render::stage::{Stage, settings, static_camera};
use lensrunner::scene::aurora::lines::kilorayleigh_xyz;
use lensrunner::scene::planet::Planet;
use lensrunner::scene::{self, GameConfig};
use lensrunner::sim::History;
use lensrunner::sim::sight::light_path;
use lensrunner::spacetime::Observer;
use lensrunner::spacetime::light::{Branch, Order};
use lensrunner::spacetime::matter::{ShipState, velocity};

use crate::gpu::GPU;
use crate::render::pictures::exact;
use crate::render::support::renderer;
use crate::twin::run_with;

/// At places all over the planet's shining side, ν_observed/ν_emitted of two wave crests: sent a moment apart, and received when light gets
/// there.
#[test]
fn lines_shift_with_the_planets_rotation() {
    let config = GameConfig::default();
    let scene = scene::load("aurora-orbit").unwrap();
    let size = [256u32, 144];
    let mut renderer = renderer(size);
    let stage = Stage::new(&mut renderer, &scene, &config);
    let planet = scene.planet.unwrap();
    let mut line = PlanetLine::new(DQuat::IDENTITY);
    let history = line.about(&planet, 0.0, 60.0).unwrap();
    let middle = planet.state(0.0).unwrap().position;
    let aside = (middle.normalize() * 0.9 + DVec3::Z * 0.43).normalize();
    let far = static_camera(middle + aside * (12.0 * planet.radius), -aside, DVec3::Z, 0.35);
    // One ratio for all would miss ten times as much from far. A camera that turns with the planet sees it unshifted.
    for (camera, allowed, differ) in [(far, 0.01, [1.1, 1.3]), (stage.camera(0.0, &[]), 0.01, [1.0, 1.03])] {
        let slice = lensrunner::lensing::Slice::new(renderer.table(), camera.radius());
        let view = InstanceView { camera: &camera, slice: &slice, pixel: 1e-3, aspect: Some(144.0 / 256.0), settings: &settings(&config) };
        let [least, greatest] = compare(&view, &planet, history, allowed);
        assert!((differ[0]..differ[1]).contains(&(greatest / least)), "ratios from {least} to {greatest}");
    }
}

/// What neither colours nor brightness go by is not worked out, and the lines are those of light at rest.
#[test]
fn without_doppler_and_beaming_no_shift_is_looked_for() {
    let scene = scene::load("aurora-orbit").unwrap();
    let size = [96u32, 54];
    let mut renderer = renderer(size);
    for (doppler, beaming) in [(false, false), (true, false), (false, true)] {
        let mut config = GameConfig::default();
        (config.render.doppler, config.render.beaming) = (doppler, beaming);
        let settings = settings(&config);
        let mut stage = Stage::new(&mut renderer, &scene, &config);
        // One that does not turn with the planet.
        let state = scene.planet.unwrap().state(0.0).unwrap();
        let aside = (state.position.normalize() * 0.9 + DVec3::Z * 0.43).normalize();
        let camera = static_camera(state.position + aside * 12.0, -aside, DVec3::Z, 0.35);
        let colours = stage.frame(camera, size, 0.0, &[], None, &settings).aurora.expect("the aurora is in sight").colours[0];
        let differ = (0..SHIFTS).any(|k| colours.lines[k] != colours.lines[0]) || colours.slope != [0.0; 2];
        assert_eq!(differ, doppler || beaming, "doppler {doppler}, beaming {beaming}: {:?}", colours.slope);
        let rest = kilorayleigh_xyz(1.0);
        let unit = colours.lines[0][0][1] / rest[0][1] as f32;
        for (got, want) in colours.lines[0].iter().zip(rest).filter(|_| !doppler && !beaming) {
            // Rounding of 32-bit floats, once in the unit and once in the colour.
            assert!((0..3).all(|k| (got[k] - want[k] as f32 * unit).abs() <= 3e-7 * got[k].abs()), "{got:?}, {want:?} at rest");
        }
    }
}

fn compare(view: &InstanceView, planet: &Planet, history: &History, allowed: f64) -> [f64; 2] {
    let (camera, aspect, time, order) = (view.camera, view.aspect.unwrap(), 0.0, Order::ALL[0]);
    let began = departure(view, time, history, order).unwrap().time;
    let shift = ImageShift::new(view, [began, time], history, order, planet.radius).unwrap();
    // What flows past a place with the rain: proper time by T of what moves.
    let slowed = |position: DVec3, velocity: DVec3| (1.0 - (velocity + position / position.length().powf(1.5)).length_squared()).sqrt();
    let flies = velocity(&ShipState::new(camera.position, camera.momentum));
    let own = slowed(camera.position, flies);
    let (mut checked, mut worst, mut spread) = (0, 0.0f64, [f64::INFINITY, 0.0f64]);
    for k in 0..1000 {
        // Evenly over a ball.
        let z = 1.0 - (f64::from(k) + 0.5) / 500.0;
        let body = DVec3::new((2.4 * f64::from(k)).cos() * (1.0 - z * z).sqrt(), (2.4 * f64::from(k)).sin() * (1.0 - z * z).sqrt(), z)
            * (1.02 * planet.radius);
        let place = |t: f64| {
            let state = planet.state(t).unwrap();
            state.position + state.attitude * body
        };
        let arrives = |t: f64| {
            (0..60).fold(t, |arrived, _| {
                let there = Observer { position: camera.position + flies * (arrived - time), ..*camera };
                t + light_path(&there, place(t), order, Branch::Plus).unwrap().0
            })
        };
        // The moment of the light that arrives at `time`.
        let sent = (0..60).fold(time - 10.0, |t, _| t - (arrives(t) - time));
        let h = 1e-3;
        let velocity = (place(sent + h) - place(sent - h)) / (2.0 * h);
        let got = slowed(place(sent), velocity) / own / ((arrives(sent + h) - arrives(sent - h)) / (2.0 * h));
        let outward = place(sent) - planet.state(sent).unwrap().position;
        let Some(seen) = exact(camera, place(sent), order).filter(|seen| seen.z < 0.0) else { continue };
        if outward.dot(camera.position - place(sent)) < 0.0 {
            continue;
        }
        let on_screen = DVec2::new(seen.x, seen.y / aspect) / (-seen.z * (0.5 * camera.field_of_view).tan());
        if on_screen.abs().max_element() > 1.0 {
            continue;
        }
        worst = worst.max((shift.at(on_screen) / got - 1.0).abs());
        spread = [spread[0].min(got), spread[1].max(got)];
        checked += 1;
    }
    println!("{checked} places, ratios {spread:?}, off by {worst:.4} at most");
    assert!(checked > 20 && worst < allowed);
    spread
}

#[test]
fn colours_of_lines_are_the_same_in_both_languages() {
    let shift = ImageShift { middle: 1.02, slope: DVec2::new(0.05, -0.03), range: [0.96, 1.05] };
    let colours = Colours::new(&shift, |g| std::array::from_fn(|line| [g as f32, (g * g) as f32, line as f32 * g as f32, 0.0]));
    let bytes = size_of::<Colours>() as u64;
    let buffer = layout::buffer(&GPU.device, "colours", bytes, wgpu::BufferUsages::UNIFORM);
    GPU.queue.write_buffer(&buffer, 0, bytemuck::bytes_of(&colours));
    let rows: Vec<[f32; 4]> =
        (0..100u32).map(|k| [-1.0 + 0.2 * (k % 10) as f32, -0.95 + 0.2 * (k / 10) as f32, (k % 4) as f32, 0.0]).collect();
    let out = run_with(
        Pass::AuroraResolve,
        "twin_out[id.x] = vec4<f32>(colour_at(u32(row.z), row.xy), 0.0);",
        [&[], &[]],
        &[(0, &buffer)],
        &rows,
        1,
    );
    for (row, got) in rows.iter().zip(out) {
        let place = DVec2::new(f64::from(row[0]), f64::from(row[1]));
        let want = colours.at(place)[row[2] as usize];
        let g = shift.at(place);
        for c in 0..3 {
            assert!((got[c] - want[c]).abs() < 1e-5, "{row:?}: {got:?} on the GPU, {want:?} in Rust");
        }
        // Fifteen straight pieces of a parabola 0.09 wide, 0.003² off in the middle of each.
        assert!((f64::from(got[1]) - g * g).abs() < 2e-5 && SHIFTS == 16, "{row:?}: {} for {}", got[1], g * g);
    }
}

/// Between the ratios at which they are worked out, lines are as bright as at the ratio itself: to 0.1 % of green at rest over the 8 % of a
/// planet that turns once in 40 r_s/c, to 0.25 % over 0.88 to 1.05.
#[test]
fn between_two_ratios_lines_are_as_bright() {
    let green = kilorayleigh_xyz(1.0)[0][1];
    for (range, allowed) in [([0.96, 1.04], 1e-3), ([0.88, 1.05], 2.5e-3)] {
        let middle = 0.5 * (range[0] + range[1]);
        let shift = ImageShift { middle, slope: DVec2::new(range[1] - middle, 0.0), range };
        let colours = Colours::new(&shift, |g| kilorayleigh_xyz(g).map(|[x, y, z]| [x as f32, y as f32, z as f32, 0.0]));
        for k in 0..=400 {
            let place = DVec2::new(-1.0 + 0.005 * f64::from(k), 0.0);
            let (got, want) = (colours.at(place), kilorayleigh_xyz(shift.at(place)));
            for (got, want) in got.iter().zip(want) {
                let off = (f64::from(got[1]) - want[1]).abs() / green;
                assert!(off < allowed, "at {}: {off:.5} of green", shift.at(place));
            }
        }
    }
}
