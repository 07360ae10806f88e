//! What the dev overlay costs the processor in a frame: laid out and made into triangles, without a device. A frame without it is taken
//! beside each.

use std::path::PathBuf;
use std::time::Instant;

use bevy_egui::egui::{Context, Pos2, RawInput, Rect, vec2};
use clap::Args;
use lensrunner::argument::whole;
use lensrunner::play::overlay::frames::Frames;
use lensrunner::play::overlay::history::{EditHistory, marks};
use lensrunner::play::overlay::place::places;
use lensrunner::play::overlay::quality::QualityReport;
use lensrunner::play::overlay::show;
use lensrunner::play::overlay::state::{Overlay, OverlayView, Passing, Tab};
use lensrunner::scene::GameConfig;
use lensrunner::scene::config::section_names;

use crate::chart::{ChartError, quantile};
use crate::say::say;

/// What the dev overlay costs the processor in a frame, page by page, beside a frame without it: a table.
#[derive(Args, Clone, Debug)]
pub struct OverlayRequest {
    /// Frames of each page.
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = whole::<usize>(10, 1_000_000))]
    pub frames: usize,
}

/// Frames before the first that is timed: letters are drawn and cards find their size.
const WARM: usize = 300;
/// Passes of a frame.
const PASSES: &str = "vertices edges triangles refine mesh sky stars project ends arcs disk draw ranges walk thin compose strokes resolve bloom \
                      exposure develop smooth flashes afterwards";

/// What is open in the overlay.
struct Case {
    name: &'static str,
    overlay: Option<Overlay>,
}

fn cases() -> Vec<Case> {
    let opened = |tab, groups: &[&'static str], search: &str| {
        let mut overlay = Overlay::default();
        (overlay.tab, overlay.open, overlay.search) = (tab, groups.iter().copied().collect(), search.to_owned());
        Some(overlay)
    };
    let mut cases = vec![Case { name: "closed", overlay: None }];
    cases.extend(Tab::ALL.map(|(tab, name)| Case { name, overlay: opened(tab, &["render"], "") }));
    cases.push(Case { name: "Frame, all groups open", overlay: opened(Tab::Frame, &section_names(), "") });
    cases.push(Case { name: "Frame, a search", overlay: opened(Tab::Frame, &[], "budget") });
    cases
}

/// Durations of the last frames that change from frame to frame.
fn note(frames: &mut Frames, frame: usize) {
    let wave = |k: usize| 1.0 + 0.5 * (0.1 * (frame * (k + 1)) as f64).sin();
    let passes: Vec<(&'static str, f32)> =
        PASSES.split(' ').enumerate().map(|(k, name)| (name, (wave(k) * k as f64) as f32 + 0.01)).collect();
    frames.push(40.0 * wave(0), &passes);
    frames.overlay.push(0.5 * wave(1));
}

/// One case in its own context.
struct Run {
    case: Case,
    context: Context,
    /// Laid out, and with triangles, in ms.
    times: Vec<[f64; 2]>,
}

impl Run {
    fn frame(&mut self, seen: &OverlayView, frame: usize) {
        let screen = Rect::from_min_size(Pos2::ZERO, vec2(1280.0, 720.0));
        let input = RawInput { screen_rect: Some(screen), time: Some(frame as f64 / 60.0), ..RawInput::default() };
        let began = Instant::now();
        self.context.begin_pass(input);
        if let Some(overlay) = &mut self.case.overlay {
            show(&self.context, places(screen, &[]), seen, overlay);
        }
        let output = self.context.end_pass();
        let laid_out = began.elapsed();
        let triangles = self.context.tessellate(output.shapes, output.pixels_per_point);
        let whole = began.elapsed();
        drop(triangles);
        if frame >= WARM {
            self.times.push([laid_out, whole].map(|time| 1e3 * time.as_secs_f64()));
        }
    }
}

/// Times the frames of each case, all cases in turn, and says a table in ms.
pub fn run(request: &OverlayRequest) -> Result<Vec<PathBuf>, ChartError> {
    let mut config = GameConfig::default();
    (config.render.bloom, config.disk.arcs) = (0.5, 900);
    let (begun, quality) = (GameConfig::default(), QualityReport::default());
    let marks = marks(&config, &begun, &EditHistory::default());
    let mut frames = Frames::default();
    let mut runs: Vec<Run> = cases().into_iter().map(|case| Run { case, context: Context::default(), times: Vec::new() }).collect();
    for frame in 0..WARM + request.frames {
        note(&mut frames, frame);
        let passing = Passing { now: frame as f64, step: 1.0 / 32.0, end: Some(400.0), ..Passing::default() };
        let seen = OverlayView { config: &config, marks: &marks, frames: &frames, counters: None, disk: None, quality: &quality, passing };
        runs.iter_mut().for_each(|run| run.frame(&seen, frame));
    }
    say(format_args!(
        "| the overlay at 1280x720, {} frames each | laid out, median | with triangles, median | 99 of 100 under |\n|---|---|---|---|",
        request.frames
    ));
    for Run { case, times, .. } in runs {
        let at = |which: usize, share: f64| quantile(times.iter().map(|pair| pair[which]), share);
        say(format_args!("| {} | {:.3} | {:.3} | {:.3} |", case.name, at(0, 0.5), at(1, 0.5), at(1, 0.99)));
    }
    Ok(Vec::new())
}
