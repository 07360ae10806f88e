//! What the HUD costs the processor in a frame: its numbers read and its dials and markers laid out, in the whole game on a picture.

use std::path::PathBuf;
use std::time::Duration;

use bevy::ecs::schedule::SingleThreadedExecutor;
use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use bevy_egui::EguiPrimaryContextPass;
use clap::Args;
use lensrunner::argument::whole;
use lensrunner::play::choices::Choices;
use lensrunner::play::schedule::{GameSet, PaintSet};
use lensrunner::play::session::Session;
use lensrunner::play::tour::wait_for_scene;
use lensrunner::play::window::{Options, OutputSurface, app};

use crate::chart::{ChartError, quantile};
use crate::offscreen::thread_time;
use crate::say::say;

/// What the HUD costs the processor in a frame of missions flown by hand: a table.
#[derive(Args, Clone, Debug)]
pub struct HudRequest {
    /// Frames of each mission.
    #[arg(long, value_name = "N", default_value_t = 300, value_parser = whole::<usize>(10, 1_000_000))]
    pub frames: usize,
}

/// A target that is seen now, one known by its light alone, one to be hit.
const MISSIONS: [&str; 3] = ["02-first-pursuit", "04-the-ghost", "06-the-long-shot"];
/// Pixels of the picture, which is not what is measured; its aspect is that of the usual window.
const SIZE: [u32; 2] = [320, 180];
/// Frames before the first that is timed.
const WARM: usize = 30;

/// When the part that runs now began, and what both took in each frame, in ms.
#[derive(Resource, Default)]
struct Spent {
    began: f64,
    numbers: Vec<f64>,
    painted: Vec<f64>,
}

fn begin(mut spent: ResMut<Spent>) {
    spent.began = thread_time();
}

/// Times the missions one after the other, and says a table.
pub fn run(request: &HudRequest) -> Result<Vec<PathBuf>, ChartError> {
    say("| mission | numbers, median | dials and markers, median | together, median | 99 of 100 under, ms |\n|---|---|---|---|---|");
    for mission in MISSIONS {
        let session = Session::load(None, Some(mission), Some(1)).map_err(|error| ChartError::Failed(error.to_string()))?;
        let options = Options { at_once: true, frames: Some(u32::MAX), ..Options::default() };
        let mut app = app(session, &options, OutputSurface::Picture(SIZE), Choices::default());
        // On one thread, so that nothing else is counted.
        app.edit_schedule(Update, |schedule| _ = schedule.set_executor(SingleThreadedExecutor::new()))
            .edit_schedule(EguiPrimaryContextPass, |schedule| _ = schedule.set_executor(SingleThreadedExecutor::new()))
            .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(16)))
            .init_resource::<Spent>()
            .add_systems(Update, begin.after(GameSet::Picture).before(GameSet::Instruments))
            .add_systems(
                Update,
                (|mut spent: ResMut<Spent>| {
                    let took = thread_time() - spent.began;
                    spent.numbers.push(took);
                })
                .after(GameSet::Instruments),
            )
            .add_systems(EguiPrimaryContextPass, begin.before(PaintSet::Hud))
            .add_systems(
                EguiPrimaryContextPass,
                (|mut spent: ResMut<Spent>| {
                    let took = thread_time() - spent.began;
                    spent.painted.push(took);
                })
                .after(PaintSet::Hud)
                .before(PaintSet::Menus),
            );
        app.finish();
        app.cleanup();
        wait_for_scene(&mut app);
        (0..WARM).for_each(|_| app.update());
        *app.world_mut().resource_mut::<Spent>() = Spent::default();
        (0..request.frames).for_each(|_| app.update());
        let spent = app.world().resource::<Spent>();
        let together = || spent.numbers.iter().zip(&spent.painted).map(|(a, b)| a + b);
        let [numbers, painted] = [&spent.numbers, &spent.painted].map(|times| quantile(times.iter().copied(), 0.5));
        let [median, most] = [0.5, 0.99].map(|share| quantile(together(), share));
        say(format_args!("| `{mission}` | {numbers:.3} | {painted:.3} | {median:.3} | {most:.3} |"));
    }
    Ok(Vec::new())
}
