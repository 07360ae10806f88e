//! What the overlay is set to, what it shows, and what it is asked for. What is painted only asks; `answer` does it.

use std::collections::BTreeSet;
use std::path::PathBuf;

use bevy::prelude::Resource;

use crate::play::overlay::frames::Frames;
use crate::play::overlay::history::{EditHistory, Mark};
use crate::play::overlay::quality::QualityReport;
use crate::render::disk::types::DiskCounters;
use crate::render::gpu::types::Counters;
use crate::scene::GameConfig;
use crate::scene::config::{self, Value};

/// The pages of the left window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tab {
    /// What a frame takes and counts.
    #[default]
    Frame,
    /// Switches of what light does and how it is drawn.
    Light,
    /// The flow of time, replays, moments.
    Time,
    /// What chose how much is drawn.
    Quality,
}

impl Tab {
    /// All, with their names.
    pub const ALL: [(Tab, &'static str); 4] =
        [(Tab::Frame, "Frame"), (Tab::Light, "Light"), (Tab::Time, "Time"), (Tab::Quality, "Quality")];
}

/// What the overlay is asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Ask {
    /// New values of settings, by their places in the list of all.
    Change {
        /// Places and values.
        to: Vec<(usize, Value)>,
        /// It goes on with the change before, as when a slider is dragged.
        continues: bool,
    },
    /// The change before is taken back.
    Undo,
    /// What was taken back is done again.
    Redo,
    /// What was changed goes to the file.
    Save,
    /// A command that starts the game as it is set goes to the clipboard.
    Copy,
    /// Time stands still, or passes again.
    Freeze(bool),
    /// So many steps of the simulation pass while time stands still.
    Step(u32),
    /// The replay is shown from this T on, in r_s/c.
    Teleport(f64),
    /// The moment that is shown goes to a file.
    SaveMoment,
}

/// The overlay.
#[derive(Resource, Clone, Debug, Default)]
pub struct Overlay {
    /// The page of the left window.
    pub tab: Tab,
    /// What is searched for.
    pub search: String,
    /// The groups that are open.
    pub open: BTreeSet<&'static str>,
    /// What was changed.
    pub history: EditHistory,
    /// What is asked for and not done yet.
    pub asked: Vec<Ask>,
    /// What was done last, or why not.
    pub said: String,
    /// Where moments are saved; None: in the folder of the player's pictures.
    pub folder: Option<PathBuf>,
    /// The last moment that was saved.
    pub moment: Option<PathBuf>,
    /// What is to go to the clipboard.
    pub(super) copies: Option<String>,
    /// A moment is to be saved at the end of the frame.
    pub(super) saves: bool,
    /// Places of the settings that were found, and by which words.
    found: Option<(String, Vec<usize>)>,
}

impl Overlay {
    /// Asks for a new value of one setting.
    pub fn change(&mut self, path: &str, value: Value) {
        if let Some(place) = config::settings().iter().position(|setting| setting.path() == path) {
            self.asked.push(Ask::Change { to: vec![(place, value)], continues: false });
        }
    }

    /// Places of the settings that have all words of the search in name, unit or description; None without a search.
    pub fn found(&mut self) -> Option<&[usize]> {
        if self.search.trim().is_empty() {
            self.found = None;
            return None;
        }
        if self.found.as_ref().is_none_or(|(search, _)| *search != self.search) {
            self.found = Some((self.search.clone(), search(&self.search)));
        }
        self.found.as_ref().map(|(_, places)| &places[..])
    }
}

fn search(words: &str) -> Vec<usize> {
    let words = words.to_lowercase();
    let has_all = |text: &str| words.split_whitespace().all(|word| text.contains(word));
    let texts = config::settings().iter().map(|setting| format!("{} {} {}", setting.path(), setting.unit, setting.help).to_lowercase());
    texts.enumerate().filter(|(_, text)| has_all(text)).map(|(place, _)| place).collect()
}

/// How time passes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Passing {
    /// T of the last step, in r_s/c.
    pub now: f64,
    /// The step, in r_s/c.
    pub step: f64,
    /// It stands still.
    pub frozen: bool,
    /// The last T of the replay that is shown, in r_s/c; None where one flies.
    pub end: Option<f64>,
    /// The replay is flown to a T, in r_s/c.
    pub travels: Option<f64>,
}

/// What the overlay shows.
pub struct OverlayView<'a> {
    /// What is played.
    pub config: &'a GameConfig,
    /// How each setting stands.
    pub marks: &'a [Mark],
    /// What the last frames took.
    pub frames: &'a Frames,
    /// What the stages of the geometry counted.
    pub counters: Option<Counters>,
    /// What the stages of the disk counted.
    pub disk: Option<DiskCounters>,
    /// What chose how much is drawn.
    pub quality: &'a QualityReport,
    /// How time passes.
    pub passing: Passing,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_words_are_searched_for_in_name_unit_and_description() {
        let mut overlay = Overlay::default();
        assert_eq!(overlay.found(), None);
        let paths = |overlay: &mut Overlay, words: &str| {
            overlay.search = words.into();
            let found = overlay.found().unwrap_or_default();
            found.iter().map(|place| config::settings()[*place].path()).collect::<Vec<_>>()
        };
        assert_eq!(paths(&mut overlay, "ERROR budget"), ["render.pixel_error_budget", "render.coarse_below", "disk.error_budget"]);
        assert_eq!(paths(&mut overlay, "mV/m"), ["aurora.field"]);
        assert!(paths(&mut overlay, "warp drive").is_empty());
    }
}
