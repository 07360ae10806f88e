//! The demonstration flight's cameras: what is shown when.

use crate::spacetime::Observer;
use glam::{DQuat, DVec3};

use crate::render::stage::{static_camera, third_person};
use crate::sim::History;
use crate::spacetime::frames;
use crate::spacetime::matter::ShipState;

use crate::play::camera::state_of;
use crate::sim::sight::facing;

/// A kind of picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shot {
    /// Behind the hunter, looking where the quarry is seen.
    Chase,
    /// From the hunter's cockpit, looking where the quarry is seen.
    Cockpit,
    /// Behind the quarry, looking back at the hunter.
    Quarry,
    /// From far, at rest, with the hole in the middle.
    Wide,
}

/// The shots of the flight, each with the share of it at which it ends.
const PLAN: [(f64, Shot); 7] = [
    (0.12, Shot::Wide),
    (0.38, Shot::Chase),
    (0.50, Shot::Cockpit),
    (0.66, Shot::Chase),
    (0.76, Shot::Quarry),
    (0.86, Shot::Cockpit),
    (1.0, Shot::Chase),
];

/// The shot at `share` of the flight, in [0, 1].
fn shot_at(share: f64) -> Shot {
    PLAN.iter().find(|(end, _)| share < *end).map_or(PLAN[PLAN.len() - 1].1, |(_, shot)| *shot)
}

/// Behind and above, in lengths of the ship.
const BEHIND: DVec3 = DVec3::new(0.5, 0.6, 3.0);
/// How much of the way to its new attitude a camera goes in a frame.
const FOLLOW: f64 = 0.25;

/// The camera of the demonstration.
#[derive(Clone, Debug)]
pub struct Director {
    shot: Option<Shot>,
    attitude: DQuat,
}

impl Default for Director {
    fn default() -> Self {
        Director { shot: None, attitude: DQuat::IDENTITY }
    }
}

/// The ships of the demonstration: their worldlines, and the length of each in r_s.
#[derive(Clone, Copy, Debug)]
pub struct Cast<'a> {
    /// The one that hunts.
    pub hunter: (&'a History, f64),
    /// The one that flees, if there is one.
    pub quarry: Option<(&'a History, f64)>,
    /// Index of the hunter among the scene's ships.
    pub hunter_index: usize,
}

impl Director {
    /// The camera at T = `time`, `share` of the way through the flight, and the ship that is not drawn.
    pub fn camera(&mut self, cast: &Cast, time: f64, share: f64, field_of_view: f64) -> (Observer, Option<usize>) {
        self.shoot(shot_at(share), cast, time, share, field_of_view)
    }

    /// The same for a shot of one's own choice.
    pub fn shoot(&mut self, shot: Shot, cast: &Cast, time: f64, share: f64, field_of_view: f64) -> (Observer, Option<usize>) {
        let (near, far) = match (shot, cast.quarry) {
            (Shot::Quarry, Some(quarry)) => (quarry, Some(cast.hunter)),
            (_, quarry) => (cast.hunter, quarry),
        };
        if shot == Shot::Wide {
            self.shot = Some(shot);
            return (wide(near.0.at(time).position, share, field_of_view), None);
        }
        let state = state_of(&near.0.at(time));
        let resting = Observer { position: state.position, momentum: state.momentum, attitude: DQuat::IDENTITY, field_of_view };
        // The disk's axis upwards.
        let wanted = far.and_then(|far| facing(&resting, time, far.0, DVec3::Z)).unwrap_or(state.attitude);
        self.attitude = if self.shot == Some(shot) { self.attitude.slerp(wanted, FOLLOW).normalize() } else { wanted };
        self.shot = Some(shot);
        let turned = ShipState { attitude: self.attitude, ..state };
        match shot {
            Shot::Cockpit => (third_person(&turned, DVec3::ZERO, DQuat::IDENTITY, field_of_view), Some(cast.hunter_index)),
            _ => (third_person(&turned, BEHIND * near.1, DQuat::IDENTITY, field_of_view), None),
        }
    }
}

/// A hovering camera above the side of the hole where the ships are, the hole in the middle.
pub fn wide(ship: DVec3, share: f64, field_of_view: f64) -> Observer {
    let azimuth = ship.y.atan2(ship.x) - 0.35 + share;
    let position = DVec3::new(azimuth.cos(), azimuth.sin(), 0.32) * 15.0;
    static_camera(position, -position, DVec3::Z, field_of_view)
}

/// How far from a caught ship its camera is, in lengths of the ship: all of it is seen, and not much else than what is beyond.
const NEAR_CAUGHT: f64 = 3.0;
/// How far right of the picture's middle a caught ship is, in radians: at the left is what the result says.
const ASIDE_CAUGHT: f64 = 0.12;
/// Where the hole is then, in camera axes: farther right, its edge behind the ship.
const HOLE_BEYOND: DVec3 = DVec3::new(0.45, 0.05, -1.0);

/// A camera that flies with a caught ship `length` r_s long and sees all of it, the hole beyond and `own` (the position of the ship that
/// caught it, in r_s) not in the way.
pub fn on_caught(caught: &History, length: f64, own: DVec3, time: f64, field_of_view: f64) -> Observer {
    let state = state_of(&caught.at(time));
    let inward = -state.position.normalize_or(DVec3::X);
    let across = inward.cross(DVec3::Z).normalize_or(DVec3::Y);
    // A little from above, from all sides: how the hole is seen depends on how the ship moves.
    let cameras = (0..48).map(|k| {
        let (sine, cosine) = (std::f64::consts::TAU * f64::from(k) / 48.0).sin_cos();
        let sight = inward * cosine + across * sine - DVec3::Z * 0.25;
        let turned = ShipState { attitude: frames::look(sight, DVec3::Z).unwrap_or(DQuat::IDENTITY), ..state };
        third_person(&turned, DVec3::Z * (NEAR_CAUGHT * length), DQuat::from_rotation_y(ASIDE_CAUGHT), field_of_view)
    });
    let fault = |camera: &Observer| {
        let hole = camera.seen_direction(-camera.position.normalize_or(DVec3::X));
        let [to_own, to_caught] = [own, state.position].map(|place| place - camera.position);
        let in_front = to_own.length() < to_caught.length() && to_own.angle_between(to_caught) < 0.35;
        let too_near = to_own.length() < 1.5 * length;
        hole.angle_between(HOLE_BEYOND) + if in_front || too_near { 10.0 } else { 0.0 }
    };
    let Some(mut camera) = cameras.min_by(|a, b| fault(a).total_cmp(&fault(b))) else { return wide(state.position, 0.0, field_of_view) };
    // Light from so near is all but straight; it is aimed at where the ship is seen all the same.
    if let Some(aimed) = facing(&camera, time, caught, DVec3::Z) {
        camera.attitude = (aimed * DQuat::from_rotation_y(ASIDE_CAUGHT)).normalize();
    }
    camera
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::sight::apparition;
    use crate::spacetime::light::Order;
    use crate::spacetime::orbit::static_momentum;

    #[test]
    fn every_moment_has_a_shot() {
        assert_eq!(shot_at(0.0), Shot::Wide);
        assert_eq!(shot_at(1.0), Shot::Chase);
        let kinds: Vec<Shot> = (0..=100).map(|k| shot_at(f64::from(k) / 100.0)).collect();
        for shot in [Shot::Wide, Shot::Chase, Shot::Cockpit, Shot::Quarry] {
            assert!(kinds.contains(&shot), "{shot:?}");
        }
    }

    #[test]
    fn the_quarry_is_in_the_middle_of_the_picture() {
        let ship = |position: DVec3| ShipState::new(position, static_momentum(position).unwrap_or_default());
        let (hunter, quarry) = (History::new(0.0, &ship(DVec3::X * 9.0)), History::new(0.0, &ship(DVec3::new(2.0, 7.0, 1.0))));
        let cast = Cast { hunter: (&hunter, 0.25), quarry: Some((&quarry, 0.25)), hunter_index: 0 };
        let (camera, hidden) = Director::default().camera(&cast, 0.0, 0.45, 1.0);
        assert_eq!(hidden, Some(0));
        let seen = apparition(&camera, 0.0, &quarry, Order::ALL[0]).expect("seen").direction;
        assert!(seen.angle_between(DVec3::NEG_Z) < 1e-6, "{seen}");
    }

    /// However the caught ship moves, and wherever the other is: all of it is on the screen, right of the middle, at the chosen distance,
    /// with the hole in sight.
    #[test]
    fn a_caught_ship_is_seen_whole_before_the_hole() {
        for (position, velocity) in
            [(DVec3::X * 6.0, DVec3::ZERO), (DVec3::new(-3.0, 6.0, 0.5), DVec3::new(0.3, 0.2, 0.0)), (DVec3::Y * 3.0, DVec3::X * 0.5)]
        {
            let momentum = static_momentum(position).unwrap_or_default() + velocity;
            let caught = History::new(0.0, &ShipState::new(position, momentum));
            for own in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z].map(|side| position + side * 0.4) {
                let camera = on_caught(&caught, 0.25, own, 0.0, 60_f64.to_radians());
                let seen = apparition(&camera, 0.0, &caught, Order::ALL[0]).expect("seen").direction;
                let ahead = seen.angle_between(DVec3::NEG_Z);
                // A ship of this length at three of its lengths is 0.17 to each side; half the screen is 0.52.
                assert!(seen.x > 0.05 && ahead < 0.25, "{position} {own}: {seen}");
                let hole = camera.seen_direction(-camera.position.normalize());
                assert!(hole.angle_between(DVec3::NEG_Z) < 0.7 && hole.x > seen.x, "{position} {own}: {hole}");
                let line = position - camera.position;
                assert!(
                    (own - camera.position).angle_between(line) > 0.35 || (own - camera.position).length() > line.length(),
                    "{position} {own}"
                );
                assert!((own - camera.position).length() > 0.375, "{position} {own}");
            }
        }
    }
}
