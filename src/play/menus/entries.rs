//! What a menu is made of: entries, one of which has the focus. Keys, mouse and gamepad all work on them.

use bevy::prelude::*;

use crate::play::input::action::Action;
use crate::play::input::button::Device;
use crate::play::menus::presets::Preset;
use crate::play::menus::screens::{MenuAction, Screen};
use crate::scene::GameConfig;
use crate::scene::config::Setting;

/// A page that lies over the title or the pause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Page {
    /// The list of the other settings pages.
    Settings,
    /// Window and picture.
    Video,
    /// Volumes.
    Sound,
    /// Mouse and sticks.
    Controls,
    /// Which button does what.
    Buttons,
    /// For eyes and hands of every kind.
    Accessibility,
    /// Of all words.
    Language,
    /// A card of the manual, from 0.
    Manual(usize),
    /// Names of what is on the screen, and switches of what light does.
    Seeing,
}

/// What an entry does.
#[derive(Clone, Copy, Debug)]
pub enum Does {
    /// A button.
    Ask(MenuAction),
    /// Leads to a page.
    Open(Page),
    /// Leads back.
    Back,
    /// A setting that is kept.
    Choose(&'static Setting<GameConfig>),
    /// A setting for this moment.
    Switch(&'static Setting<GameConfig>),
    /// The size of the window.
    WindowSize,
    /// The difficulty.
    Level,
    /// A mission, or free flight: chosen by the focus, flown by confirming.
    Fly(usize),
    /// The buttons of an action: two of the keyboard or mouse, one of the gamepad; and whether they are held or tapped.
    Bind(Action),
    /// Buttons for one hand, or for both.
    Preset(Preset),
    /// What this page changes is as `game.toml` says again.
    Reset(Page),
    /// The warning has been read.
    Warned,
    /// The previous or next card.
    Card(usize),
    /// Something of photo mode.
    Photo(PhotoKnob),
}

/// What photo mode has to turn or press.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhotoKnob {
    /// Horizontal field of view.
    FieldOfView,
    /// Stops lighter or darker.
    Exposure,
    /// Share of light spread by the lens.
    Bloom,
    /// How the camera moves: with the ship, falling from rest, hovering.
    Motion,
    /// Pixels of the saved picture.
    Size,
    /// Writes the picture.
    Save,
    /// Lets the judge draw it.
    Develop,
    /// The camera is where it was.
    Home,
}

/// The columns of an entry that binds buttons: device and place on it; the last says whether they are held or tapped.
pub const SLOTS: [Option<(Device, usize)>; 4] = [Some((Device::Keyboard, 0)), Some((Device::Keyboard, 1)), Some((Device::Pad, 0)), None];

/// One line of a menu.
#[derive(Clone, Debug)]
pub struct Entry {
    /// What it is called here, for tests.
    pub id: String,
    /// What it says.
    pub words: String,
    /// Its values, if it has any: one, or one for each of [`SLOTS`].
    pub values: Vec<String>,
    /// Where the value lies between its ends, 0 to 1, for those that are turned.
    pub share: Option<f64>,
    /// Something is amiss with it, in words.
    pub amiss: Option<String>,
    /// What it does.
    pub does: Does,
}

impl Entry {
    /// An entry without a value.
    pub fn new(id: impl Into<String>, words: String, does: Does) -> Entry {
        Entry { id: id.into(), words, values: Vec::new(), share: None, amiss: None, does }
    }

    /// The same with a value.
    pub fn valued(self, value: String) -> Entry {
        Entry { values: vec![value], ..self }
    }
}

/// A step to a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// To the entry above.
    Up,
    /// To the one below.
    Down,
    /// The value before, or the column to the left.
    Left,
    /// The next.
    Right,
}

/// What a player does to a menu.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Touch {
    /// The focus goes on.
    Step(Way),
    /// The focus goes to an entry, and in it to a column.
    Focus(usize, usize),
    /// What has the focus is done.
    Confirm,
    /// Its value is turned to a share between its ends.
    Turn(f64),
    /// Its button is unbound.
    Clear,
    /// Back to where one came from.
    Back,
}

/// The menu of the screen.
#[derive(Resource, Clone, Debug, Default)]
pub struct Menu {
    /// The pages over the screen, the last on top.
    pub pages: Vec<Page>,
    /// What is on it now.
    pub entries: Vec<Entry>,
    /// Which entry has the focus.
    pub focus: usize,
    /// Which column of it.
    pub column: usize,
    /// What the mouse did in the last picture.
    pub touched: Vec<Touch>,
    /// A button is awaited for this action and column.
    pub awaits: Option<(Action, usize)>,
    /// The focus in the pages below.
    pub(super) before: Vec<usize>,
    /// The screen that the entries belong to.
    pub screen: Option<Screen>,
}

impl Menu {
    /// The page on top.
    pub fn page(&self) -> Option<Page> {
        self.pages.last().copied()
    }

    /// Opens a page.
    pub fn open(&mut self, page: Page) {
        self.before.push(self.focus);
        self.pages.push(page);
        (self.focus, self.column) = (0, 0);
    }

    /// Closes the page on top; whether there was one.
    pub fn close(&mut self) -> bool {
        let closed = self.pages.pop().is_some();
        if closed {
            (self.focus, self.column) = (self.before.pop().unwrap_or(0), 0);
        }
        closed
    }

    /// Closes all pages.
    pub fn close_all(&mut self) {
        self.pages.clear();
        self.before.clear();
        (self.focus, self.column, self.awaits) = (0, 0, None);
    }
}
