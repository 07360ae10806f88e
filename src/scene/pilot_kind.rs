//! The kinds of pilot that fly the player's ship where no player does.

use std::fmt;
use std::str::FromStr;

use crate::user_file::short;

/// The kinds of pilot that fly the player's ship where no player does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PilotKind {
    /// As one who plays for the first time: full thrust to the marker, with assist.
    Naive,
    /// A person at the first flight who does not heed the signs on the screen.
    Ignoring,
    /// A person at the first flight who does as the signs say.
    Person,
    /// A person with practice.
    Practised,
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
    pub const ALL: [PilotKind; 7] = [
        PilotKind::Naive,
        PilotKind::Ignoring,
        PilotKind::Person,
        PilotKind::Practised,
        PilotKind::Apprentice,
        PilotKind::Expert,
        PilotKind::Hands,
    ];
    /// Those who try to win, the least able first.
    pub const RATED: [PilotKind; 6] =
        [PilotKind::Naive, PilotKind::Ignoring, PilotKind::Person, PilotKind::Practised, PilotKind::Apprentice, PilotKind::Expert];

    /// As files and the command line write it.
    pub fn name(self) -> &'static str {
        ["naive", "ignoring", "person", "practised", "apprentice", "expert", "hands"][self as usize]
    }

    /// How it flies, in a few words.
    pub fn about(self) -> &'static str {
        match self {
            PilotKind::Naive => "nose to the marker, full thrust, assist: sees all at once and never errs",
            PilotKind::Ignoring => "a person at the first flight who heeds no sign of the screen",
            PilotKind::Person => "a person at the first flight who does as the signs say",
            PilotKind::Practised => "a person who has flown before",
            PilotKind::Apprentice => "the autopilot, slow to see and to decide",
            PilotKind::Expert => "the autopilot",
            PilotKind::Hands => "hands that throw the ship about",
        }
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
        found.ok_or_else(|| format!("{:?} is no pilot; known: {}", short(name), PilotKind::ALL.map(PilotKind::name).join(", ")))
    }
}
