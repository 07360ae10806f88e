//! What is drawn of the aurora: where it is, how bright, and that nothing shows which is only there to be fast.

use glam::DVec3;
use lensrunner::render::aurora::PYRAMID;
use lensrunner::render::gpu::readback;
use lensrunner::render::instances::against_static;
use lensrunner::render::stage::{Stage, settings, static_camera};
use lensrunner::scene::aurora::lines::{self, Line};
use lensrunner::scene::{self, GameConfig, Scene};

use crate::gpu::GPU;
use crate::render::support::{apart, aurora_alone, renderer, total};

/// Greens of a picture that stand out from red and blue.
fn green(picture: &readback::ReadbackPicture) -> f32 {
    picture.linear.iter().map(|p| (p[1] - p[0].max(p[2])).max(0.0)).sum()
}

/// The adapter adds up strokes in 32-bit floats.
fn adds_floats() -> bool {
    GPU.device.features().contains(wgpu::Features::FLOAT32_BLENDABLE | wgpu::Features::FLOAT32_FILTERABLE)
}

fn orbit_scene() -> (Scene, GameConfig) {
    let mut config = GameConfig::default();
    config.aurora.streaks = 4000;
    (scene::load("aurora-orbit").unwrap(), config)
}

#[test]
fn an_aurora_is_drawn_where_it_is_and_only_there() {
    let scene = scene::load("aurora-orbit").unwrap();
    let size = [160, 90];
    let mut renderer = renderer(size);
    let mut config = GameConfig::default();
    config.aurora.streaks = 3000;
    let mut stage = Stage::new(&mut renderer, &scene, &config);
    let camera = stage.camera(0.0, &[]);
    let frame = stage.frame(camera, size, 0.0, &[], None, &settings(&config));
    let aurora = frame.aurora.as_ref().expect("the aurora is in sight");
    let streaks = aurora.settings.streaks;
    // Each segment has at least its ten: five in the north and five in the south.
    assert!(streaks <= 3000 + 10 * aurora.segments.len() as u32, "{streaks}");
    assert!(aurora.segments.iter().all(|segment| segment.streaks % 10 == 0 && segment.collisions.is_finite()));
    let picture = renderer.picture(&frame, false).unwrap();
    assert!(picture.linear.iter().flatten().all(|x| x.is_finite()));
    let shines = green(&picture);
    // Measured 23.
    assert!(shines > 10.0, "{shines}");

    // The walk of Sekiguchi et al. draws something else, little as it is from orbit; switched off, there is none.
    config.aurora.walk = "linear".into();
    let linear = Stage::new(&mut renderer, &scene, &config).frame(camera, size, 0.0, &[], None, &settings(&config));
    let linear = renderer.picture(&linear, false).unwrap();
    let most = picture.linear.iter().map(|p| p[1]).fold(0.0, f32::max);
    let differs = linear.linear.iter().zip(&picture.linear).map(|(a, b)| (a[1] - b[1]).abs() / most).fold(0.0, f32::max);
    // Measured 0.012.
    assert!(differs > 0.005, "{differs}");
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

/// A planet that passes exactly behind the hole is drawn out to a ring: its curtains lie along it, not across the hole's shadow.
#[test]
fn an_aurora_behind_the_hole_leaves_the_shadow_dark() {
    let (scene, config) = (scene::load("aurora-lensed").unwrap(), GameConfig::default());
    let size = [160, 90];
    let mut renderer = renderer(size);
    let mut stage = Stage::new(&mut renderer, &scene, &config);
    for time in [8.0, 8.5, 9.0, 9.5, 10.0] {
        let camera = stage.camera(time, &[]);
        // The photon sphere's edge as a static camera sees it (Synge 1966).
        let r = camera.radius();
        let shadow = (1.5 * 3f64.sqrt() / r * (1.0 - 1.0 / r).sqrt()).asin();
        let frame = aurora_alone(&mut stage, camera, size, time, &config);
        let picture = renderer.picture(&frame, false).unwrap();
        let pixels = 0.5 * f64::from(size[0]) / (0.5 * camera.field_of_view).tan();
        let centre = glam::DVec2::from(camera.pixel(camera.seen_direction(-camera.position), size).unwrap());
        let (mut inside, mut all) = (0.0, 0.0);
        for (k, light) in picture.linear.iter().enumerate() {
            let place = glam::DVec2::new((k as u32 % size[0]) as f64 + 0.5, (k as u32 / size[0]) as f64 + 0.5);
            let sum: f64 = light.iter().take(3).map(|x| f64::from(*x)).sum();
            all += sum;
            inside += if place.distance(centre) < 0.9 * pixels * shadow.tan() { sum } else { 0.0 };
        }
        println!("T = {time}: {:.5} of the light lies within the shadow", inside / all);
        assert!(all > 0.0 && inside < 0.01 * all);
    }
}

#[test]
fn brightness_never_jumps() {
    let (scene, config) = orbit_scene();
    let size = [96, 54];
    let mut renderer = renderer(size);
    let mut stage = Stage::new(&mut renderer, &scene, &config);
    let planet = scene.planet.unwrap().state(0.0).unwrap().position;
    let aside = (planet.normalize() * 0.9 + DVec3::Z * 0.43).normalize();
    let mut light = |distance: f64, time: f64| {
        let camera = static_camera(planet + aside * distance, -aside, DVec3::Z, 0.35);
        let frame = aurora_alone(&mut stage, camera, size, time, &config);
        let streaks = frame.aurora.as_ref().map_or(0, |aurora| aurora.settings.streaks);
        (streaks, total(&renderer.picture(&frame, false).unwrap()))
    };
    // Away from the planet until it is out of sight by its size: fewer and fewer streaks, fewer strokes, fewer chords, none.
    let away: Vec<(u32, f64)> = (0..62).map(|k| light(9.0 * 1.035f64.powi(k), 0.0)).collect();
    assert!(away[0].0 > 100 && away[61] == (0, 0.0), "{:?} to {:?}", away[0], away[61]);
    // Here a step is 3.5 % of the distance, hundreds of frames of the game. Fewer streaks stand elsewhere among the rays.
    smooth(&away, 0.05);
    // And as time goes by, past steps of the curtains' motion.
    let still: Vec<(u32, f64)> = (0..30).map(|k| light(12.0, 0.05 * f64::from(k))).collect();
    smooth(&still, 0.02);
}

/// Each brightness is the mean of its neighbours, but for that part of the brightest of the three, and half a per cent of the brightest of
/// all.
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
    let mut renderer = renderer(size);
    // Light takes 14 r_s/c: the planet was half a radian back then, under the plane of the disk or above it.
    for (phase, behind) in [(-1.1, true), (2.0, false)] {
        let scene = Scene::from_toml("veil.toml".as_ref(), &text(phase)).unwrap();
        let mut light = |opacity: f64| {
            let mut config = GameConfig::default();
            (config.aurora.streaks, config.aurora.brightness, config.disk.opacity) = (4000, 0.5, opacity);
            let mut stage = Stage::new(&mut renderer, &scene, &config);
            let planet = scene.planet.unwrap().state(-14.0).unwrap().position;
            let eye = DVec3::new(0.0, -14.0, 12.0);
            let camera = static_camera(eye, planet - eye, DVec3::Z, 0.35);
            let mut frame = aurora_alone(&mut stage, camera, size, 0.0, &config);
            let images = frame.aurora.as_ref().expect("the aurora is in sight").behind.clone();
            assert_eq!(images[0], behind, "{images:?}");
            let with = total(&renderer.picture(&frame, false).unwrap());
            frame.aurora = None;
            with - total(&renderer.picture(&frame, false).unwrap())
        };
        let share = light(0.9) / light(0.0);
        // The disk lets a tenth through where it is seen face on. Measured 0.23 behind it, 1 − 9e-6 before it.
        assert!(if behind { (0.1..0.35).contains(&share) } else { (share - 1.0).abs() < 1e-3 }, "{share} of the light is left");
    }
}

#[test]
fn the_pyramid_changes_no_picture() {
    let size = [192, 108];
    let mut renderer = renderer(size);
    for name in ["aurora-below", "aurora-orbit"] {
        let scene = scene::load(name).unwrap();
        let mut config = GameConfig::default();
        // Points so wide that they go to coarse levels, and outlines of the planet among them.
        (config.aurora.streaks, config.aurora.radius) = (1500, if name == "aurora-orbit" { 50.0 } else { 12.0 });
        let mut stage = Stage::new(&mut renderer, &scene, &config);
        let mut frame = stage.frame(stage.camera(0.0, &[]), size, 0.0, &[], None, &settings(&config));
        (frame.settings.stars, frame.settings.milky_way, frame.settings.bloom) = (false, false, 0.0);
        let got = renderer.picture(&frame, false).unwrap();
        let levels = renderer.aurora_strokes().unwrap().unwrap();
        let coarse: u32 = levels[1..].iter().sum();
        assert!(levels.len() == PYRAMID as usize && coarse > levels[0] / 10, "{name}: {levels:?}");
        frame.aurora.as_mut().unwrap().settings.levels = 1;
        let want = renderer.picture(&frame, false).unwrap();
        assert_eq!(renderer.aurora_strokes().unwrap().unwrap().len(), 1);
        // As the experiment's: 2 % of the root mean square. Measured 0.013, of the light 0.0003. Light is kept to what lies beyond three
        // standard deviations.
        let (off, ratio) = (apart(&got, &want), total(&got) / total(&want));
        // No light where the planet hides it, not a pixel further than with one level.
        let most = want.linear.iter().map(|p| p[1]).fold(0.0, f32::max);
        let worst = got.linear.iter().zip(&want.linear).map(|(p, q)| (p[1] - q[1]).abs()).fold(0.0, f32::max);
        println!("{name}: rms {off:.4}, light {ratio:.4}, worst pixel {:.4}, {levels:?}", worst / most);
        assert!(off < 0.02 && (ratio - 1.0).abs() < 0.002 && worst < 0.06 * most);
    }
}

#[test]
fn parts_of_a_streak_that_are_one_stroke_change_no_picture() {
    let size = [192, 108];
    let mut renderer = renderer(size);
    let mut config = GameConfig::default();
    config.aurora.streaks = 4000;
    for name in ["aurora-below", "aurora-orbit"] {
        let mut stage = Stage::new(&mut renderer, &scene::load(name).unwrap(), &config);
        let camera = stage.camera(0.0, &[]);
        let mut frame = aurora_alone(&mut stage, camera, size, 0.0, &config);
        // Parts of a streak, and a picture of each; room for the most.
        let drawn = [24, 48].map(|parts| {
            let settings = &mut frame.aurora.as_mut().unwrap().settings;
            let streaks = settings.streaks;
            (settings.parts, settings.capacity) = (parts, 48 * streaks);
            let picture = renderer.picture(&frame, false).unwrap();
            let strokes: u32 = renderer.aurora_strokes().unwrap().unwrap().iter().sum();
            assert!(f64::from(strokes) < 0.8 * f64::from(parts * streaks), "{name}: {strokes} strokes, {parts} parts");
            picture
        });
        let [few, many] = &drawn;
        let (off, ratio) = (apart(few, many), total(few) / total(many));
        println!("{name}: rms {off:.4}, light {ratio:.4}");
        // 24 parts are themselves coarser than 48. Measured 0.006, of the light 0.0007. Joined wrongly they would have other light.
        assert!(off < 0.015 && (ratio - 1.0).abs() < 0.002);
    }
}

#[test]
fn the_same_frame_is_drawn_the_same() {
    // Halves lose what is faint in the order in which threads append it.
    assert!(adds_floats(), "the adapter cannot add up 32-bit floats: that frames are drawn the same is not tested on it");
    let size = [192, 108];
    let mut renderer = renderer(size);
    let config = GameConfig::default();
    for name in ["aurora-below", "aurora-side"] {
        let mut stage = Stage::new(&mut renderer, &scene::load(name).unwrap(), &config);
        let camera = stage.camera(0.0, &[]);
        let frame = aurora_alone(&mut stage, camera, size, 0.0, &config);
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
    // The finest level is made black only where the new frame has light there; odd sizes, that tiles do not divide.
    let config = GameConfig::default();
    let drawn = |names: &[&str], size: [u32; 2], images: usize| {
        let mut renderer = renderer(size);
        let pictures = names.iter().map(|name| {
            let mut stage = Stage::new(&mut renderer, &scene::load(name).unwrap(), &config);
            let camera = stage.camera(0.0, &[]);
            let mut frame = aurora_alone(&mut stage, camera, size, 0.0, &config);
            let aurora = frame.aurora.as_mut().unwrap();
            assert!(*name == "aurora-below" || aurora.instances.len() == images, "{name}: {} images", aurora.instances.len());
            aurora.settings.levels = 1;
            renderer.picture(&frame, false).unwrap().linear
        });
        pictures.last().unwrap()
    };
    // Of one image; and of both that the hole makes, in a picture that is large enough to have the second.
    for (name, size, images, least) in [("aurora-orbit", [197, 111], 1, 0.1), ("aurora-lensed", LENSED_SIZE, 2, 0.05)] {
        same(&drawn(&[name], size, images), &drawn(&["aurora-below", name], size, images), least, name);
    }
}

/// Pixels of a picture in which the second image of the scene `aurora-lensed` is wide enough to show its aurora.
const LENSED_SIZE: [u32; 2] = [591, 333];

#[test]
fn nothing_is_left_of_an_earlier_image() {
    let config = GameConfig::default();
    let mut renderer = renderer(LENSED_SIZE);
    let mut stage = Stage::new(&mut renderer, &scene::load("aurora-lensed").unwrap(), &config);
    let camera = stage.camera(0.0, &[]);
    let mut frame = aurora_alone(&mut stage, camera, LENSED_SIZE, 0.0, &config);
    let whole = frame.aurora.take().unwrap();
    assert_eq!(whole.instances.len(), 2);
    let mut drawn = |images: &[usize]| {
        let mut aurora = whole.clone();
        aurora.settings.levels = 1;
        aurora.instances = images.iter().map(|&k| whole.instances[k]).collect();
        aurora.parts = images.iter().map(|&k| whole.parts[k]).collect();
        aurora.behind = images.iter().map(|&k| whole.behind[k]).collect();
        aurora.colours = images.iter().map(|&k| whole.colours[k]).collect();
        frame.aurora = Some(aurora);
        renderer.picture(&frame, false).unwrap().linear
    };
    let alone = [drawn(&[0]), drawn(&[1])];
    // Their light is added up in one picture after the other, so that two together are the sum of each by itself; the same one twice is in
    // the same tiles.
    for [one, other] in [[0, 1], [0, 0], [1, 1]] {
        let sum = alone[one].iter().zip(&alone[other]).map(|(a, b)| [0, 1, 2, 3].map(|c| a[c] + b[c]));
        same(&sum.collect::<Vec<_>>(), &drawn(&[one, other]), 0.05, &format!("images {one} and {other}"));
    }
}

/// Two pictures are the same in colour, the brightest of which is more than `least`.
fn same(one: &[[f32; 4]], other: &[[f32; 4]], least: f32, name: &str) {
    let most = one.iter().flat_map(|p| &p[..3]).copied().fold(0.0, f32::max);
    let worst = one.iter().flat_map(|p| &p[..3]).zip(other.iter().flat_map(|p| &p[..3])).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(most > least, "{name}: {most}");
    // Halves lose the faintest strokes, where those are all that the adapter adds up in. Measured 0 with 32-bit floats.
    let allowed = if adds_floats() { 1e-3 } else { 0.02 };
    assert!(worst <= allowed * most, "{name}: off by {worst} of {most}");
}

#[test]
fn a_watched_aurora_goes_on_without_a_burst() {
    let (scene, config) = orbit_scene();
    let size = [96, 54];
    let mut renderer = renderer(size);
    let mut stage = Stage::new(&mut renderer, &scene, &config).watched();
    // The camera goes with the planet.
    let mut light = |stage: &mut Stage, config: &GameConfig, time: f64| {
        let camera = stage.camera(time, &[]);
        let frame = aurora_alone(stage, camera, size, time, config);
        let rows = frame.aurora.as_ref().unwrap().rows.clone();
        (rows, total(&renderer.picture(&frame, false).unwrap()))
    };
    // Ten frames, twelve days of the planet out of sight, ten more: curtains and their brightness go on where they were.
    let gap = 12.0 * scene.planet.unwrap().day;
    let times = (0..10).map(|k| 0.05 * f64::from(k)).chain((0..10).map(|k| gap + 0.05 * f64::from(k)));
    let steps: Vec<_> = times.map(|time| light(&mut stage, &config, time)).collect();
    for (k, pair) in steps.windows(2).enumerate() {
        // Other rays pass in the meantime; the planet turns a little.
        let ratio = pair[1].1 / pair[0].1;
        // Measured 0.003, and 0.049 over the twelve days.
        let allowed = if k == 9 { 0.15 } else { 0.01 };
        assert!((ratio - 1.0).abs() < allowed, "{ratio} times as much light from one frame to the next");
        // No row is older than four steps of half a second: the row that was the newest is among the first three.
        let kept = (0..3).any(|k| pair[1].0.ago(k) == pair[0].0.ago(0));
        assert!(kept, "the curtains have moved by more than two rows in a frame");
    }
    // Keys of brightness, walk and pace leave the curtains as they are, and another seed does not.
    let before = light(&mut stage, &config, gap + 1.0).0;
    let mut other = config.clone();
    (other.aurora.brightness, other.aurora.pace, other.aurora.walk) = (0.02, 9.0, "linear".into());
    stage.change_aurora(&other.aurora);
    let after = light(&mut stage, &other, gap + 1.0).0;
    assert!((0..2).any(|k| after.ago(k) == before.ago(0)), "another pace makes no other curtains");
    other.aurora.seed += 1;
    stage.change_aurora(&other.aurora);
    assert!(light(&mut stage, &other, gap + 1.0).0.ago(0) != before.ago(0));
    other.aurora.enabled = false;
    stage.change_aurora(&other.aurora);
    let camera = stage.camera(gap + 1.0, &[]);
    assert!(aurora_alone(&mut stage, camera, size, gap + 1.0, &other).aurora.is_none());
}

#[test]
fn an_oval_is_brighter_at_magnetic_midnight() {
    let (scene, config) = orbit_scene();
    let size = [96, 54];
    let mut renderer = renderer(size);
    let mut stage = Stage::new(&mut renderer, &scene, &config);
    let planet = scene.planet.unwrap();
    for time in [0.0, 0.3 * planet.day] {
        let camera = stage.camera(time, &[]);
        let mut frame = aurora_alone(&mut stage, camera, size, time, &config);
        // In the dipole's axes, which turn with the planet; in space it points away from the hole.
        let [x, y] = frame.aurora.as_ref().unwrap().settings.midnight.map(f64::from);
        let state = planet.state(time).unwrap();
        let midnight = state.attitude * planet.dipole() * DVec3::new(x, y, 0.0);
        assert!(midnight.dot(state.position.normalize()) > 0.4, "{midnight} at {}", state.position);
        // The light of both sides, with midnight on the one, on the other, and on neither.
        let lit = [1.0, -1.0, 0.0].map(|part: f64| {
            frame.aurora.as_mut().unwrap().settings.midnight = [(part * x) as f32, (part * y) as f32];
            total(&renderer.picture(&frame, false).unwrap())
        });
        // Brighter parts have harder electrons, whose lines are a little others. Measured 0.0008.
        assert!(((lit[0] + lit[1]) / (2.0 * lit[2]) - 1.0).abs() < 0.003, "{lit:?}");
        // The side that faces the camera is seen larger, and more of it. Measured 0.48 and 0.15.
        let facing = midnight.dot((frame.camera.position - state.position).normalize());
        assert!((lit[0] / lit[1]).ln() * facing.signum() > 0.07, "{lit:?}, {facing}");
    }
}

#[test]
fn lines_shift_as_the_settings_ask() {
    let (scene, mut config) = orbit_scene();
    let size = [96, 54];
    let mut renderer = renderer(size);
    // The red line's X over Y falls as it becomes greener.
    let mut hue = |lensing: bool, light_delay: bool| {
        (config.render.lensing, config.render.light_delay) = (lensing, light_delay);
        let mut stage = Stage::new(&mut renderer, &scene, &config);
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
    // Measured 9e-9.
    assert!((flat / expected(g) - 1.0).abs() < 1e-6, "{flat} in the frame, {} for g = {g}", expected(g));
    // With the hole its field's part comes in, and with the delay another moment.
    let (_, bent) = hue(true, true);
    // Measured 0.048.
    assert!((bent - flat).abs() > 0.02, "{bent} and {flat}");
}
