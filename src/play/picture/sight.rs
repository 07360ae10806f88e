//! What the screen shows, and the camera that shows it.

use glam::{DQuat, DVec3};

use crate::play::camera::director::{on_caught, wide};
use crate::play::camera::{CameraView, on_ship};
use crate::play::menus::screens::Screen;
use crate::sim::snapshot::FrameCamera;
use crate::sim::{History, Outcome};
use crate::spacetime::matter::ShipState;

/// What the screen shows, whatever the player looked at before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ScreenContent {
    /// What the player looks at.
    Own,
    /// All of it from far, by a camera that slowly goes round: on the title, and where the chase is not won. It stands still then, and
    /// there may be nothing ahead of a ship; who has crossed the horizon sees nothing change any more.
    #[default]
    Afar,
    /// The quarry, caught.
    Caught,
}

impl ScreenContent {
    /// What a screen shows, of a chase that is undecided or has this outcome. `by_holding`: its mission is done by holding a ship.
    pub fn of(screen: Screen, outcome: Option<Outcome>, by_holding: bool) -> ScreenContent {
        match (screen, outcome) {
            (Screen::Title | Screen::Warning, _) => ScreenContent::Afar,
            (Screen::Result, Some(Outcome::Caught)) => ScreenContent::Caught,
            (Screen::Result, Some(Outcome::Done)) if by_holding => ScreenContent::Caught,
            (Screen::Result, Some(_)) => ScreenContent::Afar,
            _ => ScreenContent::Own,
        }
    }
}

/// A ship to look at: its index in the scene, its worldline, its length (r_s).
pub type Subject<'a> = (usize, &'a History, f64);

impl FrameCamera {
    /// From the player's own ship at `position`, `attitude` turned as the camera is.
    pub fn own(ship: usize, state: &ShipState, view: CameraView, attitude: DQuat, length: f64, field_of_view: f64) -> FrameCamera {
        FrameCamera {
            camera: on_ship(state, view, attitude, length, field_of_view),
            hidden: (view == CameraView::Cockpit).then_some(ship),
            lit: Some(ship),
        }
    }

    /// Of a ship that has been caught, at T = `time`, from where the player is.
    pub fn caught((ship, history, length): Subject, position: DVec3, time: f64, field_of_view: f64) -> FrameCamera {
        FrameCamera { camera: on_caught(history, length, position, time, field_of_view), hidden: None, lit: Some(ship) }
    }

    /// Of everything from far, turned by `turn` rad.
    pub fn afar(position: DVec3, turn: f64, field_of_view: f64) -> FrameCamera {
        FrameCamera { camera: wide(position, turn, field_of_view), hidden: None, lit: None }
    }
}

/// Whether the picture at T = `time` has nothing to do with that before, which `last` keeps: what is shown is another thing, or the chase
/// began anew.
pub fn is_cut(last: &mut Option<(ScreenContent, f64)>, sight: ScreenContent, time: f64) -> bool {
    last.replace((sight, time)).is_none_or(|(before, earlier)| before != sight || time < earlier)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_restart_is_a_cut() {
        let mut last = None;
        let cuts = [
            (ScreenContent::Afar, 3.0),
            (ScreenContent::Own, 0.0),
            (ScreenContent::Own, 5.0),
            (ScreenContent::Own, 5.0),
            (ScreenContent::Own, 0.1),
            (ScreenContent::Caught, 0.2),
        ];
        assert_eq!(cuts.map(|(sight, time)| is_cut(&mut last, sight, time)), [true, true, false, false, true, true]);
    }

    #[test]
    fn the_result_shows_what_it_tells_of() {
        assert_eq!(ScreenContent::of(Screen::Title, None, true), ScreenContent::Afar);
        assert_eq!(ScreenContent::of(Screen::Result, Some(Outcome::Caught), false), ScreenContent::Caught);
        for lost in [Outcome::HunterLost, Outcome::QuarryLost, Outcome::TimeOut] {
            assert_eq!(ScreenContent::of(Screen::Result, Some(lost), true), ScreenContent::Afar);
        }
        assert_eq!(ScreenContent::of(Screen::Playing, Some(Outcome::HunterLost), true), ScreenContent::Own);
        let done = |by_holding| ScreenContent::of(Screen::Result, Some(Outcome::Done), by_holding);
        assert_eq!([done(true), done(false)], [ScreenContent::Caught, ScreenContent::Afar]);
        assert_eq!(ScreenContent::of(Screen::Paused, None, true), ScreenContent::Own);
    }
}
