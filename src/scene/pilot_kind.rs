//! The kinds of pilot that fly the player's ship where no player does.

use std::fmt;
use std::str::FromStr;

use crate::user_file::short;

/// The kinds of pilot that fly the player's ship where no player does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PilotKind {
    /// As one who plays for the first time: full thrust to the marker, with assist.
    Naive,
    /// The autopilot, slow to see and to decide.
    Apprentice,
    /// The autopilot.
    #[default]
    Expert,
    /// Hands that throw the ship about: for judging pictures.
    Hands,
}

impl PilotKind {
    /// All.
    pub const ALL: [PilotKind; 4] = [PilotKind::Naive, PilotKind::Apprentice, PilotKind::Expert, PilotKind::Hands];
    /// Those who try to win, the least able first.
    pub const RATED: [PilotKind; 3] = [PilotKind::Naive, PilotKind::Apprentice, PilotKind::Expert];

    /// As files and the command line write it.
    pub fn name(self) -> &'static str {
        ["naive", "apprentice", "expert", "hands"][self as usize]
    }
}

impl fmt::Display for PilotKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for PilotKind {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = PilotKind::ALL.into_iter().find(|pilot| pilot.name() == name);
        found.ok_or_else(|| format!("{:?} is no pilot; known: naive, apprentice, expert, hands", short(name)))
    }
}
