//! Reduced flashes: the mean brightness of pictures as they are shown rises no faster than it may, and reaches the same in the end.

use glam::{DQuat, DVec3};
use lensrunner::play::demonstration::drawn;
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::targets::target;
use lensrunner::render::settings::{GREATEST_RISE, Settings, greatest_rise};
use lensrunner::render::stage::{self, Stage, static_camera};
use lensrunner::scene::{self, GameConfig};
use lensrunner::sim::Moment;
use lensrunner::spacetime::Observer;

use crate::gpu::GPU;
use crate::render::support::{LentRenderer, linear, renderer};

const SIZE: [u32; 2] = [160, 90];
/// Simulated time of a frame, in s.
const SECONDS: f64 = 1.0 / 30.0;
/// What a rise may be more than its bound, of white: a step of 8 bits is 3e-4 in the dark, of which the mean over thousands of pixels keeps
/// little (4e-5 is reached) and that over a few dozen more (1.6e-4); noise against banding adds 1e-4 to what is black; smoothed outlines
/// change the mean a little.
const TOLERANCE: f64 = 3e-4;

/// A scene that is shown frame by frame.
struct Show {
    renderer: LentRenderer,
    stage: Stage,
    moment: Moment,
    settings: Settings,
    output: (wgpu::Texture, wgpu::TextureView),
}

impl Show {
    /// At its start; nothing has been shown. The exposure is at once what it should be.
    fn new(name: &str) -> Show {
        let mut config = GameConfig::default();
        // Its strokes are added in any order, which rounding tells.
        config.aurora.enabled = false;
        let scene = scene::load(name).unwrap();
        let mut renderer = renderer(SIZE);
        let stage = Stage::new(&mut renderer, &scene, &config);
        let moment = Moment::new(&scene, &config, 0.0, 0);
        Show { renderer, stage, moment, settings: stage::settings(&config), output: output(SIZE) }
    }

    /// The scene's own camera.
    fn camera(&self) -> Observer {
        self.stage.camera(0.0, &self.moment.ships())
    }

    /// The picture on the screen, sRGB.
    fn draw(&mut self, camera: Observer, settings: &Settings) -> Vec<u8> {
        let frame: FrameInput = self.stage.frame(camera, self.renderer.size(), 0.0, &self.moment.histories(), None, settings);
        drawn(&GPU, &mut self.renderer, &frame, (&self.output.0, &self.output.1)).unwrap()
    }

    /// The mean brightness of the next frame without a bound, and with it.
    fn free(&mut self, camera: Observer) -> f64 {
        let settings = self.settings;
        mean(&self.draw(camera, &settings))
    }

    fn bound(&mut self, camera: Observer) -> f64 {
        let settings = Settings { rise: greatest_rise(true, SECONDS), ..self.settings };
        mean(&self.draw(camera, &settings))
    }

    fn resize(&mut self, size: [u32; 2]) {
        self.renderer.resize(size);
        self.output = output(size);
    }
}

fn output(size: [u32; 2]) -> (wgpu::Texture, wgpu::TextureView) {
    target(&GPU.device, "output", size, wgpu::TextureFormat::Rgba8UnormSrgb)
}

/// Mean relative luminance of a picture, 1 for white (IEC 61966-2-1, ITU-R BT.709).
fn mean(picture: &[u8]) -> f64 {
    let light = |p: &[u8]| 0.2126 * linear(p[0]) + 0.7152 * linear(p[1]) + 0.0722 * linear(p[2]);
    picture.chunks_exact(4).map(light).sum::<f64>() / (picture.len() / 4) as f64
}

/// Each frame by itself, and each second. `means` begins with what was before.
fn assert_slow(means: &[f64], what: &str) {
    let most = GREATEST_RISE * SECONDS + TOLERANCE;
    let steepest = means.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    let second = means.windows(31).map(|second| second[30] - second[0]).fold(0.0, f64::max);
    println!(
        "{what}: {} frames to {:.4}, by {steepest:.5} at most in one, {second:.4} in a second",
        means.len() - 1,
        means[means.len() - 1]
    );
    assert!(steepest <= most, "{what}: by {steepest} in a frame, {most} are allowed");
    assert!(second <= GREATEST_RISE + TOLERANCE, "{what}: by {second} in a second");
}

/// Frames that a picture of this brightness may take from black, and a few more.
fn enough(brightness: f64) -> usize {
    (brightness / (GREATEST_RISE * SECONDS)).ceil() as usize + 3
}

/// From the first frame on, in the brightest scenes. Without the bound they are there at once; with it in the end, to the bit.
#[test]
fn games_begin_in_the_dark() {
    let mut fastest: f64 = 0.0;
    for name in ["disk-inner", "disk-skim", "chase", "galaxy-axis"] {
        let mut show = Show::new(name);
        let camera = show.camera();
        let settled = show.settings;
        let plain = show.draw(camera, &settled);
        let brightness = mean(&plain);
        fastest = fastest.max(brightness);
        show.renderer.nothing_shown();
        let mut means = vec![0.0];
        means.extend((0..enough(brightness)).map(|_| show.bound(camera)));
        assert_slow(&means, name);
        assert!(means[1] < 0.1 * brightness, "{name} does not begin in the dark: {} of {brightness}", means[1]);
        let last = show.draw(camera, &Settings { rise: greatest_rise(true, SECONDS), ..settled });
        assert_eq!(mean(&last), brightness, "{name} does not become as bright as without a bound");
        assert!(last == plain, "{name} is another picture in the end");
    }
    assert!(fastest > 20.0 * GREATEST_RISE * SECONDS, "no scene rises fast by itself: {fastest} at once");
}

/// Cuts from black to the disk and back, light that beaming takes and gives, an exposure that moves by itself, the window's size, and a
/// frame in which the screen was black.
#[test]
fn brightness_rises_slowly_whatever_happens() {
    let mut show = Show::new("disk-skim");
    let bright = show.camera();
    // The sky has no light: only the disk, which is behind.
    let away = static_camera(DVec3::new(0.0, 0.0, 30.0), DVec3::Z, DVec3::X, 1.0);
    let dim = Settings { beaming: false, exposure_range: [1e-3; 2], ..show.settings };
    let plain = show.settings;

    let mut free = vec![0.0];
    free.extend([away, bright, away, bright].map(|camera| show.free(camera)));
    let jump = free[2] - free[1];
    assert!(free[1] < 1e-3 && jump > 20.0 * GREATEST_RISE * SECONDS, "cuts are none: {free:?}");

    let mut means = vec![show.free(away)];
    for camera in [away, bright, away, bright] {
        let frames = if camera == bright { enough(jump) / 2 } else { 2 };
        means.extend((0..frames).map(|_| show.bound(camera)));
    }
    for settings in [dim, plain, dim, plain] {
        show.settings = settings;
        let before = means[means.len() - 1];
        means.extend((0..8).map(|_| show.bound(bright)));
        assert!(settings.beaming || means[means.len() - 1] < 0.5 * before, "without beaming and exposure it is as bright");
    }
    for size in [[320, 180], [64, 90], [7, 5], SIZE] {
        show.resize(size);
        means.extend((0..4).map(|_| show.bound(bright)));
    }
    // An exposure that lags behind.
    means.push(show.bound(away));
    show.settings.adaptation = 0.2;
    means.extend((0..20).map(|_| show.bound(bright)));
    assert_slow(&means, "cuts");

    show.renderer.nothing_shown();
    assert!(show.bound(bright) < GREATEST_RISE * SECONDS + TOLERANCE, "after a black frame the picture is there at once");
}

/// A camera that falls from afar through the disk, faster than any ship.
#[test]
fn brightness_rises_slowly_on_a_fall_into_the_disk() {
    let fall = |show: &mut Show, bound: bool| -> Vec<f64> {
        let mut means = vec![0.0];
        for step in 0..60 {
            let height = 12.0 * (1.0 - f64::from(step) / 50.0);
            let position = DVec3::new(0.0, -4.0, height);
            let camera = Observer { attitude: DQuat::IDENTITY, ..static_camera(position, -DVec3::Z, DVec3::Y, 1.5) };
            means.push(if bound { show.bound(camera) } else { show.free(camera) });
        }
        means
    };
    let mut show = Show::new("disk-inner");
    let free = fall(&mut show, false);
    let steepest = free[1..].windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    assert!(steepest > 3.0 * GREATEST_RISE * SECONDS, "the fall is slow by itself: by {steepest} in a frame");
    show.renderer.nothing_shown();
    assert_slow(&fall(&mut show, true), "fall");
}

/// Where the bound is not reached, not a bit changes; nor does the picture darken when the setting is switched on over it.
#[test]
fn nothing_changes_where_brightness_does_not_rise() {
    for name in ["disk-skim", "chase"] {
        let mut show = Show::new(name);
        let camera = show.camera();
        for (own_ship, bias) in [(None, 1.0), (Some(0), 0.3), (Some(0), 5.0)] {
            show.settings = Settings { own_ship, exposure_bias: bias, ..show.settings };
            let free = show.settings;
            let all = Settings { rise: 1.0, ..free };
            let little = Settings { rise: greatest_rise(true, SECONDS), ..free };
            // The own ship is lit by the exposure of the frame before.
            show.draw(camera, &free);
            let plain = show.draw(camera, &free);
            assert!(mean(&plain) > 0.01, "{name} is dark");
            assert!(show.draw(camera, &little) == plain, "{name} darkens as the setting is switched on");
            assert!(show.draw(camera, &little) == plain, "{name}: a picture that stays does not stay");
            show.renderer.nothing_shown();
            assert!(show.draw(camera, &all) == plain, "{name}: a bound that is not reached changes the picture");
            let held = Settings { hold_exposure: true, ..little };
            assert!(show.draw(camera, &held) == plain, "{name}: an exposure that is held changes");
        }
    }
}

/// The bound is per time, and a wait gives no leap.
#[test]
fn a_wait_gives_no_leap() {
    assert_eq!(greatest_rise(false, 0.01), f32::INFINITY);
    assert_eq!(greatest_rise(true, 0.02), 0.002);
    assert_eq!(greatest_rise(true, 5.0), 0.01);
    assert_eq!(greatest_rise(true, 0.0), 0.0);
}
