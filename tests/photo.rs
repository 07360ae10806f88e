//! Pictures that carry their moment: made again from the picture alone, by the game's renderer and by the judge.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::Duration;

use glam::DQuat;
use lensrunner::judge::case::{Case, DEFAULT_TOLERANCE};
use lensrunner::judge::picture::{DEFAULT_PACKET, Sampling};
use lensrunner::picture_file::text::read_text;
use lensrunner::picture_file::{png, write_png_with_text};
use lensrunner::play::camera::{CameraView, on_ship, state_of};
use lensrunner::play::demonstration::{DemonstrationRequest, drawn, fly};
use lensrunner::play::develop::{DevelopProgress, Developing};
use lensrunner::play::session::Session;
use lensrunner::render::Renderer;
use lensrunner::render::gpu::readback::ReadbackPicture;
use lensrunner::render::gpu::targets::target;
use lensrunner::render::settings::Settings;
use lensrunner::render::shot::{shot_again, surroundings};
use lensrunner::render::stage::{Stage, settings};
use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner::scene::{self, Difficulty, GameConfig, Scene};
use lensrunner::sim::Moment;
use lensrunner::sim::assist::AssistMode;
use lensrunner::sim::replay::{Record, Replay};
use lensrunner::sim::snapshot::{FrameCamera, Snapshot, step_after};
use lensrunner::sim::{Bolts, Fleet, History, PlayerCommands};

use crate::gpu::GPU;
use crate::support::Folder;

const SIZE: [u32; 2] = [96, 54];
/// T of the frame, in steps: between two.
const STEPS: f64 = 60.4;

/// A mission flown by hand, with thrust, a turn and two bolts: the light of the later one has not come yet.
fn flight() -> (Scene, GameConfig, Replay) {
    let scene = scene::load("02-first-pursuit").unwrap();
    let mut config = GameConfig::default();
    config.ship.bolts = 3;
    config.render.orders = 3;
    config.sky.star_brightness = 0.5;
    let mut flight = Replay::begin(&scene, &config, Difficulty::Hard, PilotKind::Expert, 5);
    let commands = |tick: u64| PlayerCommands {
        thrust: [0, 30, -127],
        turn: [(tick % 7) as i8, 3, 0],
        fire: tick == 10 || tick == 40,
        assist: if tick > 30 { AssistMode::Target } else { AssistMode::Off },
        ..PlayerCommands::default()
    };
    flight.records = (0..90).map(|tick| Record { tick, commands: commands(tick) }).collect();
    (scene, config, flight)
}

/// What the game draws of that flight, and the moment that its picture is to carry.
fn original(view: CameraView) -> (ReadbackPicture, Snapshot) {
    let (scene, config, flight) = flight();
    let step = config.clock.step;
    let (time, ticks) = (STEPS * step, step_after(STEPS * step, step) as u64);
    let mut app = flight.app(&scene, &config);
    (0..ticks).for_each(|_| lensrunner::sim::step(app.world_mut()));
    let world = app.world();
    let mut histories: Vec<&History> = world.resource::<Fleet>().0.iter().map(|&ship| world.get::<History>(ship).unwrap()).collect();
    let nobody = History::nobody();
    histories.push(&nobody);
    histories.extend(world.resource::<Bolts>().0.iter().map(|bolt| &bolt.history));
    assert_eq!(histories.len(), scene.ships.len() + 3, "two bolts fly");
    let me = scene.ships.iter().position(|ship| ship.player).unwrap();
    let state = state_of(&histories[me].at(time));
    let camera = on_ship(&state, view, state.attitude * DQuat::from_rotation_x(-0.1), config.ship.size, 1.0);
    let hidden = (view == CameraView::Cockpit).then_some(me);
    let levelled = scene.config(&config, flight.difficulty);
    let mut renderer = Renderer::new(&GPU, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, SIZE);
    let mut stage = Stage::new(&mut renderer, &scene, &levelled);
    let engines = Some([config.ship.thrust, config.enemy.thrust]);
    let settings = Settings { own_ship: Some(me), engines, ..settings(&config) };
    let picture = renderer.picture(&stage.frame(camera, SIZE, time, &histories, hidden, &settings), true).unwrap();
    let shot = FrameCamera { camera, hidden, lit: Some(me) };
    (picture, Snapshot::new(flight.up_to(ticks, world), &scene, &config, world, time, shot, SIZE))
}

/// What the PNG `path` carries, flown again.
fn flown_again(path: &Path) -> (Snapshot, Moment) {
    let snapshot = Snapshot::from_text(path, &read_text(path).unwrap()).unwrap();
    let moment = snapshot.fly(path).unwrap();
    (snapshot, moment)
}

fn rgb(picture: &ReadbackPicture) -> Vec<u8> {
    picture.display.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect()
}

/// Whether two pictures are the same but for the order in which the adapter drew: half floats that add up in another order are rounded
/// otherwise, and of two surfaces at one depth another is seen. Mostly there is no difference at all.
fn assert_same(name: &str, before: &[u8], again: &[u8]) {
    let differ = before.iter().zip(again).filter(|(a, b)| a != b).count();
    let off = before.iter().zip(again).filter(|(a, b)| a.abs_diff(**b) > 1).count();
    println!("{name}: {differ} values differ, {off} by more than 1");
    assert!(before.len() == again.len() && off * 500 <= again.len());
}

/// The file of the exact picture beside another.
fn exact(picture: &Path) -> PathBuf {
    picture.with_extension("exact.png")
}

/// From the file alone the game's picture comes again, once the eye has adapted; the judge's shows the same bodies at all pixels but some
/// along edges, where the one's point of a pixel is just beside the other's.
#[test]
fn a_picture_is_made_again_from_its_file() {
    let folder = Folder::new();
    for (name, view) in [("behind", CameraView::ThirdPerson), ("cockpit", CameraView::Cockpit)] {
        let (picture, snapshot) = original(view);
        let path = folder.path().join(format!("{name}.png"));
        write_png_with_text(&path, &rgb(&picture), SIZE, &snapshot.to_text()).unwrap();
        let (snapshot, moment) = flown_again(&path);
        let again = shot_again(&snapshot, &moment, SIZE, true, true).unwrap();
        assert_same(name, &rgb(&picture), &rgb(&again));
        let differ = picture.layers.iter().zip(&again.layers).filter(|(a, b)| a != b).count();
        println!("{name}: layers of {differ} pixels have other bits");
        assert!(differ * 500 <= again.layers.len());
        let case = Case::again(&snapshot, &moment, SIZE);
        let sampling = Sampling { samples: 1, tolerance: DEFAULT_TOLERANCE, packet: DEFAULT_PACKET };
        let judge = case.trace(&sampling, true, &|_| ());
        let what = |id: u32| (id > 0).then(|| case.assembly.objects[id as usize - 1].name.clone());
        let count = |ids: &mut dyn Iterator<Item = u32>, name: &str| {
            ids.filter(|id| what(*id).is_some_and(|found| found.starts_with(name))).count()
        };
        let own = &case.scene.ships[case.scene.ships.iter().position(|ship| ship.player).unwrap()].name;
        for ids in [
            picture.layers.iter().map(|layer| layer[0] as u32).collect::<Vec<_>>(),
            judge.layers.iter().map(|layer| layer.object).collect(),
        ] {
            let (ships, bolts) = (count(&mut ids.iter().copied(), own), count(&mut ids.iter().copied(), "bolt"));
            println!("{name}: {ships} pixels of the ship, {bolts} of the bolt");
            assert_eq!(ships > 30, view == CameraView::ThirdPerson, "{ships} pixels of the own ship");
            assert!(bolts >= 2, "{bolts} pixels of the bolt");
        }
        let differ = picture.layers.iter().zip(&judge.layers).filter(|(game, judge)| game[0] as u32 != judge.object).count();
        let solid = judge.layers.iter().filter(|layer| layer.object > 0).count();
        println!("{name}: {differ} of {solid} solid pixels differ");
        assert!(differ <= 2 + solid / 25);
    }
}

/// Frames of the demonstration come again if they are drawn in their order, as the eye adapts from each to the next. Only
/// the first is exposed as one alone.
#[test]
fn frames_of_the_demonstration_are_made_again() {
    const FRAMES: u32 = 4;
    let folder = Folder::new();
    let mut session = Session::load(None, Some("chase"), Some(3)).unwrap();
    session.config = GameConfig::default();
    let mut flight = Replay::begin(&session.scene, &session.config, session.difficulty, PilotKind::Expert, session.seed);
    let commands =
        |k: u64| PlayerCommands { thrust: [0, 0, -100], turn: [0, k as i8, 0], assist: AssistMode::Orbit, ..PlayerCommands::default() };
    flight.records = (0..40).map(|k| Record { tick: 16 * k, commands: commands(k) }).collect();
    let request = DemonstrationRequest {
        frames: FRAMES,
        size: SIZE,
        folder: folder.path().to_path_buf(),
        pilot: PilotKind::Expert,
        replay: Some(flight),
        sound: None,
    };
    let report = fly(&GPU, &session, &request).unwrap();
    let mut renderer = Renderer::new(&GPU, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, SIZE);
    let (texture, view) = target(&GPU.device, "again", SIZE, wgpu::TextureFormat::Rgba8UnormSrgb);
    for frame in 0..FRAMES {
        let path = folder.path().join(format!("frames/frame-{frame:05}.png"));
        let (snapshot, moment) = flown_again(&path);
        let before = image::open(&path).unwrap().to_rgb8().into_raw();
        let (config, shot) = (snapshot.config(), snapshot.shot);
        let seconds = (report.span[1] - report.span[0]) / f64::from(FRAMES) / config.clock.pace;
        let adaptation = if frame == 0 { 1.0 } else { (1.0 - (-config.render.exposure_speed * seconds).exp2()) as f32 };
        let engines = Some([config.ship.thrust, config.enemy.thrust]);
        let settings = Settings { own_ship: shot.lit, engines, adaptation, ..settings(&config) };
        let mut stage = Stage::new(&mut renderer, &moment.scene, &snapshot.levelled(&moment.scene));
        let input = stage.frame(shot.camera, SIZE, snapshot.time, &moment.all_histories(), shot.hidden, &settings);
        let pixels = drawn(&GPU, &mut renderer, &input, (&texture, &view)).unwrap();
        let again: Vec<u8> = pixels.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        assert_same(&format!("T = {}", snapshot.time), &before, &again);
        if frame == 0 {
            // Of the own ship's light, and of stars that just come to be seen, a little hangs on the frame before.
            let alone = rgb(&shot_again(&snapshot, &moment, SIZE, false, true).unwrap());
            let off = before.iter().zip(&alone).filter(|(a, b)| a.abs_diff(**b) > 8).count();
            assert!(off * 1000 < alone.len(), "{off} of {} values differ by more than 8", alone.len());
        }
    }
}

/// A scene of one's own travels with the picture; a model that is missing is named.
#[test]
fn a_scene_of_ones_own_travels_along() {
    let folder = Folder::new();
    let file = folder.path().join("mine.toml");
    let text = std::fs::read_to_string(crate::support::root().join("assets/scenes/chase.toml")).unwrap() + "\n# mine\n";
    std::fs::write(&file, &text).unwrap();
    let scene = scene::load(file.to_str().unwrap()).unwrap();
    std::fs::remove_file(&file).unwrap();
    let config = GameConfig::default();
    let flight = Replay::begin(&scene, &config, Difficulty::default(), PilotKind::Expert, 0);
    let camera = scene.camera.viewpoint(0.0, &[]);
    let (world, shot) = (bevy::prelude::World::new(), FrameCamera { camera, hidden: None, lit: None });
    let snapshot = Snapshot::new(flight.up_to(16, &world), &scene, &config, &world, 0.5, shot, SIZE);
    let path = Path::new("a.png");
    let read = Snapshot::from_text(path, &snapshot.to_text()).unwrap();
    let again = read.fly(path).unwrap();
    assert_eq!((again.scene.name.as_str(), again.scene.fingerprint), ("mine", scene.fingerprint));
    let refused = |change: &dyn Fn(&mut Snapshot), told: &str| {
        let mut other = read.clone();
        change(&mut other);
        let said = other.fly(path).err().unwrap_or_else(|| panic!("refused: {told}")).to_string();
        assert!(said.contains(told), "{told}: {said}");
    };
    refused(&|other| other.models.push("lost.glb".into()), "lost.glb");
    refused(&|other| other.scene = Some(text.replace("# mine", "# yours")), "not the one");
    refused(&|other| other.scene = Some("[[ship]]\nnose = 1".into()), "nose");
    refused(&|other| other.scene = None, "mine");
    refused(&|other| other.shot.lit = Some(9), "no ship number 9");
    refused(&|other| other.flight.hash = "0123456789abcdef".into(), "elsewhere");
}

/// A picture of the flight, without its pixels.
fn picture(folder: &Folder, name: &str, size: [u32; 2]) -> PathBuf {
    let (scene, config, flight) = flight();
    let camera = scene.camera.viewpoint(0.0, &[]);
    let (world, shot) = (bevy::prelude::World::new(), FrameCamera { camera, hidden: None, lit: None });
    let snapshot = Snapshot::new(flight.up_to(13, &world), &scene, &config, &world, 0.4, shot, size);
    let path = folder.path().join(name);
    std::fs::write(&path, png(&[0; 3], [1, 1], true, Some(&snapshot.to_text())).unwrap()).unwrap();
    path
}

fn lensrunner(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lensrunner")).args(arguments).output().expect("the program starts")
}

#[test]
fn the_commands_take_a_picture() {
    let folder = Folder::new();
    let from = picture(&folder, "a.png", [32, 18]);
    let out = folder.path().join("b.png");
    let [from, out_text] = [&from, &out].map(|path| path.to_str().unwrap());
    for command in ["shot", "trace"] {
        for (arguments, size) in [(&[][..], [32, 18]), (&["--size", "16x12"], [16, 12])] {
            let ran = lensrunner(&[&[command, "--from", from, "-o", out_text], arguments].concat());
            assert!(ran.status.success(), "{command}: {}", String::from_utf8_lossy(&ran.stderr));
            assert_eq!(image::image_dimensions(&out).unwrap(), size.into());
            assert_eq!(flown_again(&out).0.size, size, "it carries its moment on");
        }
        std::fs::write(folder.path().join("plain.png"), png(&[0; 3], [1, 1], true, None).unwrap()).unwrap();
        let ran = lensrunner(&[command, "--from", folder.path().join("plain.png").to_str().unwrap(), "-o", out_text]);
        let said = String::from_utf8_lossy(&ran.stderr);
        assert!(ran.status.code() == Some(2) && said.contains("plain.png: it carries no moment"), "{command}: {said}");
    }
    let ran = lensrunner(&["trace", "--from", from, "-o", out_text, "--progress"]);
    let shares: Vec<f64> =
        String::from_utf8_lossy(&ran.stdout).lines().map(|line| line.strip_prefix("progress ").unwrap().parse().unwrap()).collect();
    assert!(shares.windows(2).all(|pair| pair[0] < pair[1]) && shares.last() == Some(&1.0), "{shares:?}");
}

/// Waits for the end, which comes whether soon or late.
fn end(developing: &Developing) -> DevelopProgress {
    loop {
        match developing.progress() {
            DevelopProgress::Traced(share) => assert!((0.0..=1.0).contains(&share)),
            end => return end,
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn a_picture_is_developed_in_the_background() {
    let folder = Folder::new();
    let program = Path::new(env!("CARGO_BIN_EXE_lensrunner"));
    let photo = picture(&folder, "a.png", [32, 18]);
    assert_eq!(end(&Developing::trace_with(program, &photo, 1, &exact(&photo))), DevelopProgress::Done(exact(&photo)));
    assert_eq!(image::image_dimensions(exact(&photo)).unwrap(), (32, 18));
    let plain = folder.path().join("plain.png");
    std::fs::write(&plain, png(&[0; 3], [1, 1], true, None).unwrap()).unwrap();
    let failed = |progress: DevelopProgress, told: &str| match progress {
        DevelopProgress::Failed(why) => assert!(why.contains(told) && !why.contains('\n'), "{why}"),
        other => panic!("{told}: {other:?}"),
    };
    failed(end(&Developing::trace_with(program, &plain, 1, &exact(&plain))), "carries no moment");
    failed(end(&Developing::trace_with(program, &photo, 3, &exact(&photo))), "--samples 3");
    failed(end(&Developing::trace_with(&folder.path().join("nothing"), &photo, 1, &exact(&photo))), "cannot be started");
    // Hours of work.
    let large = picture(&folder, "large.png", [8000, 8000]);
    let developing = Developing::trace_with(program, &large, 256, &exact(&large));
    developing.cancel();
    assert_eq!(developing.progress(), DevelopProgress::Cancelled);
    assert!(!exact(&large).exists());
}
