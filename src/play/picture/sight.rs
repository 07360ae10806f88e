//! What the screen shows, and the camera that shows it.

use glam::{DQuat, DVec3};

use crate::play::camera::director::{on_caught, wide};
use crate::play::camera::{View, on_ship};
use crate::play::menus::screens::Screen;
use crate::sim::{History, Outcome};
use crate::spacetime::Observer;
use crate::spacetime::matter::ShipState;

/// What the screen shows, whatever the player looked at before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sight {
    /// What the player looks at.
    Own,
    /// All of it from far, by a camera that slowly goes round: on the title, and where the chase is not won. It stands still then, and
    /// there may be nothing ahead of a ship; who has crossed the horizon sees nothing change any more.
    #[default]
    Afar,
    /// The quarry, caught.
    Caught,
}

impl Sight {
    /// What a screen shows, of a chase that is undecided or has this outcome.
    pub fn of(screen: Screen, outcome: Option<Outcome>) -> Sight {
        match (screen, outcome) {
            (Screen::Title, _) => Sight::Afar,
            (Screen::Result, Some(Outcome::Caught)) => Sight::Caught,
            (Screen::Result, Some(_)) => Sight::Afar,
            _ => Sight::Own,
        }
    }
}

/// The camera of a frame, and what it does to the ships.
#[derive(Clone, Copy, Debug)]
pub struct Shot {
    /// Who looks.
    pub camera: Observer,
    /// The ship that is not drawn: the cockpit's own.
    pub hidden: Option<usize>,
    /// The ship that is lit so that it is seen.
    pub lit: Option<usize>,
}

/// A ship to look at: its index in the scene, its worldline, its length (r_s).
pub type Subject<'a> = (usize, &'a History, f64);

impl Shot {
    /// From the player's own ship at `position`, `attitude` turned as the camera is.
    pub fn own(ship: usize, state: &ShipState, view: View, attitude: DQuat, length: f64, field_of_view: f64) -> Shot {
        Shot {
            camera: on_ship(state, view, attitude, length, field_of_view),
            hidden: (view == View::Cockpit).then_some(ship),
            lit: Some(ship),
        }
    }

    /// Of a ship that has been caught, at T = `time`, from where the player is.
    pub fn caught((ship, history, length): Subject, position: DVec3, time: f64, field_of_view: f64) -> Shot {
        Shot { camera: on_caught(history, length, position, time, field_of_view), hidden: None, lit: Some(ship) }
    }

    /// Of everything from far, turned by `turn` rad.
    pub fn afar(position: DVec3, turn: f64, field_of_view: f64) -> Shot {
        Shot { camera: wide(position, turn, field_of_view), hidden: None, lit: None }
    }
}

/// Whether the picture at T = `time` has nothing to do with that before, which `last` keeps: what is shown is another thing, or the chase
/// began anew.
pub fn is_cut(last: &mut Option<(Sight, f64)>, sight: Sight, time: f64) -> bool {
    last.replace((sight, time)).is_none_or(|(before, earlier)| before != sight || time < earlier)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_restart_is_a_cut() {
        let mut last = None;
        let cuts = [(Sight::Afar, 3.0), (Sight::Own, 0.0), (Sight::Own, 5.0), (Sight::Own, 5.0), (Sight::Own, 0.1), (Sight::Caught, 0.2)];
        assert_eq!(cuts.map(|(sight, time)| is_cut(&mut last, sight, time)), [true, true, false, false, true, true]);
    }

    #[test]
    fn the_result_shows_what_it_tells_of() {
        assert_eq!(Sight::of(Screen::Title, None), Sight::Afar);
        assert_eq!(Sight::of(Screen::Result, Some(Outcome::Caught)), Sight::Caught);
        for lost in [Outcome::HunterLost, Outcome::QuarryLost, Outcome::TimeOut] {
            assert_eq!(Sight::of(Screen::Result, Some(lost)), Sight::Afar);
        }
        assert_eq!(Sight::of(Screen::Playing, Some(Outcome::HunterLost)), Sight::Own);
        assert_eq!(Sight::of(Screen::Paused, None), Sight::Own);
    }
}
