//! Flying freely in a scene that was made to be looked at.

use super::load::Scene;
use super::ship::ShipSpec;
use crate::spacetime::matter::ShipState;

impl Scene {
    /// The scene with somebody to fly: without ships it gets one, where its camera is at T = 0. Beside a planet there is none: ships are a
    /// million times as large.
    pub fn with_a_ship(mut self) -> Scene {
        if self.ships.is_empty() && self.planet.is_none() {
            let camera = self.camera.viewpoint(0.0, &[]);
            let state = ShipState { attitude: camera.attitude, ..ShipState::new(camera.position, camera.momentum) };
            self.ships.push(ShipSpec { player: true, ..ShipSpec::coasting("ship", state) });
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use crate::scene;

    #[test]
    fn a_scene_to_look_at_gets_a_ship_and_one_with_ships_none_more() {
        let load = |name: &str| scene::load(name).expect("a scene of the game");
        let ring = load("ring").with_a_ship();
        assert_eq!(ring.ships.len(), 1);
        assert!(ring.ships[0].player && ring.ships[0].state.position.is_finite());
        assert_eq!(load("chase").with_a_ship().ships.len(), load("chase").ships.len());
        assert!(load("aurora-orbit").with_a_ship().ships.is_empty());
    }
}
