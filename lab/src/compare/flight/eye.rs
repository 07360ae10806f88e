//! From where a flight by hands is looked at: as a player looks who turns the camera about.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use rand::RngExt;
use rand::rngs::StdRng;

use crate::compare::random::draw::chance;
use lensrunner::play::camera::{CameraView, on_ship};
use lensrunner::scene::ship::Ai;
use lensrunner::scene::{GameConfig, Scene};
use lensrunner::sim::Moment;
use lensrunner::sim::sight::facing;
use lensrunner::spacetime::Observer;
use lensrunner::spacetime::matter::ShipState;

/// Keeps the chance of cameras apart from that of flights: any number does.
const EYES: u64 = 0x0e7e_5eed;
/// How far the camera is led before the ship, or comes after it, in radians.
const LED: f64 = 0.5;

/// Where the camera is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Eye {
    /// Behind the own ship.
    Behind,
    /// In its cockpit.
    Cockpit,
    /// Round the ship.
    Around,
    /// Beside the ship, flying on as it did: as another ship sees it.
    Beside,
}

impl Eye {
    /// All.
    pub const ALL: [Eye; 4] = [Eye::Behind, Eye::Cockpit, Eye::Around, Eye::Beside];

    /// In a word.
    pub fn name(self) -> &'static str {
        ["behind", "cockpit", "around", "beside"][self as usize]
    }
}

/// Index of the ship that hands fly: the player's, else the first.
pub fn own_ship(scene: &Scene) -> usize {
    scene.ships.iter().position(|ship| ship.player).unwrap_or(0)
}

/// The camera of the moment `number` of the flight `seed`, and the ship that is not drawn.
pub fn eye(scene: &Scene, config: &GameConfig, moment: &Moment, seed: u64, number: u64) -> Option<(Eye, Observer, Option<usize>)> {
    let mut chance = chance(seed ^ EYES, number);
    let own = own_ship(scene);
    let state = moment.ships().get(own)?.1;
    let length = if scene.ships[own].ai == Ai::Flee { config.enemy.size } else { config.ship.size };
    let view = Eye::ALL[chance.random_range(0..4)];
    let field_of_view = config.video.fov.to_radians();
    let led = state.attitude * DQuat::from_scaled_axis(any(&mut chance) * LED);
    let camera = match view {
        Eye::Behind => on_ship(&state, CameraView::ThirdPerson, led, length, field_of_view),
        Eye::Cockpit => on_ship(&state, CameraView::Cockpit, led, length, field_of_view),
        Eye::Around => {
            let (yaw, pitch) = (chance.random_range(-PI..PI), chance.random_range(-1.4..1.4));
            let turned = state.attitude * DQuat::from_rotation_y(yaw) * DQuat::from_rotation_x(pitch);
            on_ship(&state, CameraView::ThirdPerson, turned, length * chance.random_range(0.6..3.0), field_of_view)
        }
        Eye::Beside => beside(moment, own, &state, length, &mut chance, field_of_view)?,
    };
    Some((view, camera, (view == Eye::Cockpit).then_some(own)))
}

/// Each coordinate from −1 to 1.
fn any(chance: &mut StdRng) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| chance.random_range(-1.0..1.0)))
}

/// A camera some lengths from the ship that looks to where it is seen.
fn beside(moment: &Moment, own: usize, state: &ShipState, length: f64, chance: &mut StdRng, field_of_view: f64) -> Option<Observer> {
    let away = any(chance).try_normalize()? * (length * chance.random_range(1.5..8.0));
    let momentum = state.momentum + any(chance) * 0.2;
    let position = state.position + away;
    let eye = Observer { position, momentum, attitude: DQuat::IDENTITY, field_of_view };
    let attitude = facing(&eye, moment.time(), moment.histories().get(own)?, DVec3::Z)?;
    // Outside, where the camera would be inside.
    (position.length() > 1.05).then_some(Observer { attitude, ..eye })
}
