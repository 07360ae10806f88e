//! When each frame was ready, counted from the start of the program, into a file: for the first picture and for hitches.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use web_time::Instant;

use bevy::prelude::*;
use bevy::render::renderer::RenderDevice;
use bevy::render::{Extract, ExtractSchedule, Render, RenderApp, RenderSystems};

use crate::play::menus::screens::Screen;
use crate::play::picture::quality::Quality;
use crate::play::picture::stage_loading::CurrentStage;
use crate::play::window::record::record;
use crate::sim::Clock;

/// Writes the time of each frame, and says in a few words what they come to.
pub struct TimingsPlugin {
    /// The table, CSV.
    pub file: PathBuf,
    /// When the program began.
    pub started: Instant,
    /// Without a window nothing else waits for the graphics device: a frame is ready when the device is.
    pub waits: bool,
}

/// One frame.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Row {
    /// When it was handed to the window, in seconds since the start of the program.
    seconds: f64,
    /// What was shown.
    showing: Showing,
}

/// The frames so far; both worlds have it.
#[derive(Resource, Clone, Debug)]
struct Timings {
    started: Instant,
    waits: bool,
    file: PathBuf,
    rows: Arc<Mutex<Vec<Row>>>,
}

/// Render world: what this frame shows.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
struct Showing {
    what: &'static str,
    /// T of the flight, in r_s/c.
    time: f64,
    /// The number of the rung that it is drawn on, from 1: the finest. 0 before there is one.
    rung: usize,
}

impl Plugin for TimingsPlugin {
    fn build(&self, app: &mut App) {
        let timings = Timings { started: self.started, waits: self.waits, file: self.file.clone(), rows: Arc::new(Mutex::new(Vec::new())) };
        app.insert_resource(timings.clone()).add_systems(Last, write.after(record));
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
        render_app
            .insert_resource(timings)
            .insert_resource(Showing { what: LOADING, time: 0.0, rung: 0 })
            .add_systems(ExtractSchedule, look)
            .add_systems(Render, note.in_set(RenderSystems::Cleanup));
    }
}

/// What is shown before the scene.
const LOADING: &str = "loading";
/// What is shown while one flies.
const PLAYING: &str = "playing";

fn look(
    mut showing: ResMut<Showing>,
    current: Extract<Option<Res<CurrentStage>>>,
    screen: Extract<Res<State<Screen>>>,
    clock: Extract<Option<Res<Clock>>>,
    quality: Extract<Res<Quality>>,
) {
    let what = match screen.get() {
        _ if current.is_none() => LOADING,
        Screen::Playing => PLAYING,
        _ => "menu",
    };
    let rung = quality.rung().map_or(0, |_| quality.place()[0] + 1);
    *showing = Showing { what, time: clock.as_ref().map_or(0.0, |clock| clock.time), rung };
}

/// After the frame was handed over.
fn note(timings: Res<Timings>, showing: Res<Showing>, device: Res<RenderDevice>) {
    if timings.waits {
        // One that is lost ends the game elsewhere.
        _ = device.poll(wgpu::PollType::wait_indefinitely());
    }
    let row = Row { seconds: timings.started.elapsed().as_secs_f64(), showing: *showing };
    timings.rows.lock().unwrap_or_else(PoisonError::into_inner).push(row);
}

/// At the end the table goes to its file.
fn write(mut ends: MessageReader<AppExit>, timings: Res<Timings>) {
    if ends.read().next().is_none() {
        return;
    }
    let rows = timings.rows.lock().unwrap_or_else(PoisonError::into_inner).clone();
    if let Err(error) = std::fs::write(&timings.file, table(&rows)) {
        eprintln!("warning: cannot write {}: {error}", timings.file.display());
    }
    eprintln!("{}", summary(&rows));
}

/// The rows as CSV: seconds since the start, ms since the frame before, what is shown, T, the number of the rung.
fn table(rows: &[Row]) -> String {
    let mut text = "frame,seconds,milliseconds,shown,time,rung\n".to_owned();
    let mut before = 0.0;
    for (frame, row) in rows.iter().enumerate() {
        let Showing { what, time, rung } = row.showing;
        text += &format!("{frame},{:.4},{:.1},{what},{time:.5},{rung}\n", row.seconds, 1e3 * (row.seconds - before));
        before = row.seconds;
    }
    text
}

/// First picture, first picture of the scene, mean and longest frame of the play.
fn summary(rows: &[Row]) -> String {
    let Some(first) = rows.first() else { return "No frame was drawn.".into() };
    let mut words = format!("First picture after {:.2} s", first.seconds);
    if let Some(ready) = rows.iter().find(|row| row.showing.what != LOADING) {
        words += &format!(", of the scene after {:.2} s", ready.seconds);
    }
    // The time from one frame of play to the next; loading between two flights is no hitch.
    let spans: Vec<f64> = rows
        .windows(2)
        .filter(|two| two.iter().all(|row| row.showing.what == PLAYING))
        .map(|two| two[1].seconds - two[0].seconds)
        .collect();
    if !spans.is_empty() {
        let mean = spans.iter().sum::<f64>() / spans.len() as f64;
        let longest = spans.iter().copied().fold(0.0, f64::max);
        let hitches = spans.iter().filter(|span| **span > 2.0 * mean).count();
        words += &format!(
            ". Play, {} frames: {:.1} ms in the mean, {:.1} ms the longest, {hitches} longer than twice the mean",
            spans.len() + 1,
            1e3 * mean,
            1e3 * longest
        );
    }
    words + "."
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hitch_is_counted_in_play_alone() {
        let row = |seconds, what| Row { seconds, showing: Showing { what, time: 0.5, rung: 2 } };
        let mut rows = vec![row(0.5, LOADING), row(3.0, LOADING), row(3.5, "menu")];
        rows.extend((0..9).map(|k| row(6.0 + 0.1 * f64::from(k), PLAYING)));
        rows.push(row(7.3, PLAYING));
        let words = summary(&rows);
        assert!(words.contains("First picture after 0.50 s, of the scene after 3.50 s"), "{words}");
        assert!(words.contains("10 frames: 144.4 ms in the mean, 500.0 ms the longest, 1 longer"), "{words}");
        assert_eq!(summary(&[]), "No frame was drawn.");
        assert!(table(&rows).contains("\n1,3.0000,2500.0,loading,0.50000,2\n"), "{}", table(&rows));
    }
}
