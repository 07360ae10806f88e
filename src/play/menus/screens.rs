//! The screens and the ways between them.

use bevy::prelude::*;

use crate::scene::Difficulty;

/// What is before the player.
#[derive(States, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Screen {
    /// At the first start, before anything moves: what the picture may do to those sensitive to it.
    Warning,
    /// The missions; behind them the autopilot plays.
    #[default]
    Title,
    /// The chase.
    Playing,
    /// The chase stands still.
    Paused,
    /// How it ended.
    Result,
    /// The chase stands still, the camera is free.
    Photo,
}

impl Screen {
    /// All of them.
    pub const ALL: [Screen; 6] = [Screen::Warning, Screen::Title, Screen::Playing, Screen::Paused, Screen::Result, Screen::Photo];

    /// Whether game time passes.
    pub fn runs(self) -> bool {
        matches!(self, Screen::Title | Screen::Playing)
    }
}

/// What a player can ask of the menus.
#[derive(Message, Clone, Copy, Debug, PartialEq, Eq)]
pub enum MenuAction {
    /// A new flight of what is chosen; where one is flown, of the same again.
    Start,
    /// The same flight again, from the same start.
    Again,
    /// The next mission.
    Next,
    /// The last flight, to look at.
    Watch,
    /// Its link, to hand on.
    Share,
    /// This entry of the title's list: a mission, or the last for free flight.
    Choose(usize),
    /// This scene for free flight.
    Scene(usize),
    /// How hard it is to be.
    Level(Difficulty),
    /// Stop, or go on.
    Pause,
    /// Into photo mode, or back to the pause.
    Photo,
    /// Back to the title; from the warning on to it.
    Title,
    /// All that a page keeps, as one file.
    SaveAll,
    /// Such a file again.
    BringAll,
    /// Out.
    Quit,
}

/// Where an action leads, and whether the chase begins anew; None where it means nothing.
pub fn answer(screen: Screen, action: MenuAction) -> Option<(Screen, bool)> {
    match (screen, action) {
        (Screen::Warning, MenuAction::Title) => Some((Screen::Title, true)),
        (Screen::Warning, _) => None,
        (_, MenuAction::Start) | (Screen::Playing | Screen::Paused | Screen::Result, MenuAction::Again) => Some((Screen::Playing, true)),
        (Screen::Result, MenuAction::Next | MenuAction::Watch) => Some((Screen::Playing, true)),
        (Screen::Playing, MenuAction::Pause) => Some((Screen::Paused, false)),
        (Screen::Paused, MenuAction::Pause) => Some((Screen::Playing, false)),
        (Screen::Playing | Screen::Paused, MenuAction::Photo) => Some((Screen::Photo, false)),
        (Screen::Photo, MenuAction::Photo | MenuAction::Pause) => Some((Screen::Paused, false)),
        (Screen::Paused | Screen::Result, MenuAction::Title) => Some((Screen::Title, true)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pause_stops_and_goes_on() {
        assert_eq!(answer(Screen::Playing, MenuAction::Pause), Some((Screen::Paused, false)));
        assert_eq!(answer(Screen::Paused, MenuAction::Pause), Some((Screen::Playing, false)));
        assert_eq!(answer(Screen::Title, MenuAction::Pause), None);
        assert_eq!(answer(Screen::Result, MenuAction::Pause), None);
    }

    #[test]
    fn every_screen_but_the_warning_leads_to_a_new_chase() {
        for screen in Screen::ALL {
            let next = (screen != Screen::Warning).then_some((Screen::Playing, true));
            assert_eq!(answer(screen, MenuAction::Start), next);
        }
    }

    #[test]
    fn time_passes_only_on_title_and_in_play() {
        for screen in Screen::ALL {
            assert_eq!(screen.runs(), [Screen::Title, Screen::Playing].contains(&screen));
        }
    }
}
