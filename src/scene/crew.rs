//! Who flies the player's ship where nobody sits at it.

use std::fmt;
use std::str::FromStr;

use crate::user_file::short;

/// Who flies the player's ship where nobody sits at it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Crew {
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

impl Crew {
    /// All.
    pub const ALL: [Crew; 4] = [Crew::Naive, Crew::Apprentice, Crew::Expert, Crew::Hands];
    /// Those who try to win, the least able first.
    pub const RATED: [Crew; 3] = [Crew::Naive, Crew::Apprentice, Crew::Expert];

    /// As files and the command line write it.
    pub fn name(self) -> &'static str {
        ["naive", "apprentice", "expert", "hands"][self as usize]
    }
}

impl fmt::Display for Crew {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Crew {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Crew::ALL.into_iter().find(|crew| crew.name() == name);
        found.ok_or_else(|| format!("{:?} is no pilot; known: naive, apprentice, expert, hands", short(name)))
    }
}
