//! When each frame was ready, counted from the start of the program, into a file: for the first picture and for hitches.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use bevy::prelude::*;
use bevy::render::renderer::RenderDevice;
use bevy::render::{Extract, ExtractSchedule, Render, RenderApp, RenderSystems};

use crate::play::menus::screens::Screen;
use crate::play::picture::staging::Staged;
use crate::play::window::record::record;

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
    shown: &'static str,
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
#[derive(Resource, Clone, Copy, Debug)]
struct Showing(&'static str);

impl Plugin for TimingsPlugin {
    fn build(&self, app: &mut App) {
        let timings = Timings { started: self.started, waits: self.waits, file: self.file.clone(), rows: Arc::new(Mutex::new(Vec::new())) };
        app.insert_resource(timings.clone()).add_systems(Last, write.after(record));
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
        render_app
            .insert_resource(timings)
            .insert_resource(Showing(LOADING))
            .add_systems(ExtractSchedule, look)
            .add_systems(Render, note.in_set(RenderSystems::Cleanup));
    }
}

/// What is shown before the scene.
const LOADING: &str = "loading";
/// What is shown while one flies.
const PLAYING: &str = "playing";

fn look(mut showing: ResMut<Showing>, staged: Extract<Option<Res<Staged>>>, screen: Extract<Res<State<Screen>>>) {
    showing.0 = match screen.get() {
        _ if staged.is_none() => LOADING,
        Screen::Playing => PLAYING,
        _ => "menu",
    };
}

/// After the frame was handed over.
fn note(timings: Res<Timings>, showing: Res<Showing>, device: Res<RenderDevice>) {
    if timings.waits {
        // One that is lost ends the game elsewhere.
        _ = device.poll(wgpu::PollType::wait_indefinitely());
    }
    let row = Row { seconds: timings.started.elapsed().as_secs_f64(), shown: showing.0 };
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

/// The rows as CSV: seconds since the start, ms since the frame before, what is shown.
fn table(rows: &[Row]) -> String {
    let mut text = "frame,seconds,milliseconds,shown\n".to_owned();
    let mut before = 0.0;
    for (frame, row) in rows.iter().enumerate() {
        text += &format!("{frame},{:.4},{:.1},{}\n", row.seconds, 1e3 * (row.seconds - before), row.shown);
        before = row.seconds;
    }
    text
}

/// First picture, first picture of the scene, mean and longest frame of the play.
fn summary(rows: &[Row]) -> String {
    let Some(first) = rows.first() else { return "No frame was drawn.".into() };
    let mut words = format!("First picture after {:.2} s", first.seconds);
    if let Some(ready) = rows.iter().find(|row| row.shown != LOADING) {
        words += &format!(", of the scene after {:.2} s", ready.seconds);
    }
    // The time from one frame of play to the next; loading between two flights is no hitch.
    let spans: Vec<f64> =
        rows.windows(2).filter(|two| two.iter().all(|row| row.shown == PLAYING)).map(|two| two[1].seconds - two[0].seconds).collect();
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
        let row = |seconds, shown| Row { seconds, shown };
        let mut rows = vec![row(0.5, LOADING), row(3.0, LOADING), row(3.5, "menu")];
        rows.extend((0..9).map(|k| row(6.0 + 0.1 * f64::from(k), PLAYING)));
        rows.push(row(7.3, PLAYING));
        let words = summary(&rows);
        assert!(words.contains("First picture after 0.50 s, of the scene after 3.50 s"), "{words}");
        assert!(words.contains("10 frames: 144.4 ms in the mean, 500.0 ms the longest, 1 longer"), "{words}");
        assert_eq!(summary(&[]), "No frame was drawn.");
        assert!(table(&rows).contains("\n1,3.0000,2500.0,loading\n"), "{}", table(&rows));
    }
}
