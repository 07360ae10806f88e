//! The last flight as a link, which the game in a page and `--replay` open.

use bevy::prelude::*;

use crate::play::hud::notice::Notice;
use crate::play::missions::LastFlight;
use crate::play::session::Session;
use crate::sim::replay::link::MOST_LINK;

/// How long the player reads what became of it, in seconds of wall time.
const SHOWN: f64 = 6.0;

/// Copies the link of the last flight and says so, or says why there is none.
pub fn share(world: &mut World) {
    let Some(link) = world.get_resource::<LastFlight>().and_then(|last| last.link.clone()) else { return };
    let language = world.resource::<Session>().language();
    let text = match link {
        Ok(link) => {
            copy(world, &link);
            language.say("share-copied")
        }
        Err(length) => language.fill("share-long", &[("length", length.to_string().as_str()), ("most", MOST_LINK.to_string().as_str())]),
    };
    let until = world.resource::<Time<Real>>().elapsed_secs_f64() + SHOWN;
    world.insert_resource(Notice { text, until, share: None });
}

/// A page puts its own address before it.
#[cfg(target_family = "wasm")]
fn copy(_: &mut World, link: &str) {
    crate::page::share(link);
}

/// It goes as all that egui copies.
#[cfg(not(target_family = "wasm"))]
fn copy(world: &mut World, link: &str) {
    let mut contexts = world.query::<&mut bevy_egui::EguiContext>();
    for mut context in contexts.iter_mut(world) {
        context.get_mut().copy_text(link.to_owned());
    }
}

#[cfg(test)]
mod tests {
    use crate::play::game::begin;
    use crate::play::game::tests::game_of;
    use crate::play::input::mouse::MouseTurn;
    use crate::play::input::tests::press_key;
    use crate::play::menus::screens::Screen;
    use crate::play::missions::{Catalogue, Watched};
    use crate::play::player_state::{Flown, PlayerState};
    use crate::play::session::Session;
    use crate::scene::GameConfig;
    use crate::sim::Clock;
    use crate::sim::replay::{Replay, ReplayLog};
    use crate::sim::run::state_hash;
    use bevy::input::ButtonState;
    use bevy::prelude::*;
    use rand::{RngExt, SeedableRng, rngs::StdRng};
    use std::path::Path;
    use std::time::Duration;

    /// A hand: where the mouse goes in each frame (pixels), and which keys it has pressed.
    struct Hand {
        chance: StdRng,
        /// Its flicks: pixels, frames, frames done.
        flick: (Vec2, f32, f32),
        gone: Vec2,
        /// Frames between two flicks, about.
        rest: u32,
        /// Keys, whether they are down, and for how many frames.
        keys: [(KeyCode, bool, u32, [std::ops::Range<u32>; 2]); 3],
    }

    impl Hand {
        fn moves(&mut self) -> Vec2 {
            let (way, long, done) = self.flick;
            if done >= long && self.chance.random_range(0..self.rest) == 0 {
                let angle = self.chance.random_range(0.0..std::f32::consts::TAU);
                let far = 10.0 * self.chance.random_range(0.0f32..3.0).exp();
                self.flick = (Vec2::from_angle(angle) * far, self.chance.random_range(8.0..27.0), 0.0);
                self.gone = Vec2::ZERO;
                return Vec2::ZERO;
            }
            // It starts and stops softly, and moves whole pixels.
            self.flick.2 += 1.0;
            let share = (self.flick.2 / long).min(1.0);
            let at = (way * share.powi(3) * (10.0 - 15.0 * share + 6.0 * share * share)).round();
            at - std::mem::replace(&mut self.gone, at)
        }

        fn presses(&mut self, app: &mut App) {
            for (key, down, left, spans) in &mut self.keys {
                if *left == 0 {
                    *down = !*down;
                    *left = self.chance.random_range(spans[usize::from(*down)].clone());
                    press_key(app, *key, if *down { ButtonState::Pressed } else { ButtonState::Released });
                }
                *left -= 1;
            }
        }
    }

    /// Flights at the usual pace by a hand that is never long at rest: flicks of the mouse, thrust on and off, the mark now and then. Two
    /// minutes go into a link with a flick a second, three with half as many. Flown again they come to the same end.
    #[test]
    fn minutes_by_hand_go_into_a_link() {
        for (minutes, rest) in [(2, 60), (3, 120)] {
            let (_, flight) = flown(60 * 60 * minutes, rest, false);
            let link = flight.to_link();
            println!("{minutes} minutes, {} commands, {} steps: {:?}", flight.records.len(), flight.ticks, link.as_ref().map(String::len));
            let again = Replay::from_link(&link.expect("it goes into a link")).expect("a flight");
            again.verify(Path::new("the link"), None, &GameConfig::default()).expect("the same end");
            assert!(flight.ticks > 60 * 40 * u64::from(minutes), "{}", flight.ticks);
        }
    }

    /// Watched in the game, with the pace turned up, a flight by hand and autopilot comes to the same end as it had; after it the player's own
    /// settings are there again, and the next flight is recorded.
    #[test]
    fn a_flight_that_is_watched_is_the_one_that_was_flown() {
        let (mut app, flight) = flown(60 * 50, 60, true);
        let own = &mut app.world_mut().resource_mut::<Session>().config;
        (own.clock.pace, own.assist.damping_time) = (0.9, 2.0);
        let (catalogue, _) = Catalogue::read(app.world().resource::<Session>().scene.clone());
        let free = catalogue.missions.len();
        app.insert_resource(catalogue);
        app.world_mut().resource_mut::<PlayerState>().choice = free;
        app.insert_resource(Watched(flight.clone()));
        begin(app.world_mut(), Screen::Playing);
        for frame in 0..200_000 {
            app.update();
            if frame == 100 {
                app.world_mut().resource_mut::<Session>().config.clock.pace *= 1.25;
            }
            if app.world().resource::<Clock>().tick == flight.ticks {
                break;
            }
        }
        assert_eq!((app.world().resource::<Clock>().tick, state_hash(app.world()).to_string()), (flight.ticks, flight.hash));
        app.world_mut().remove_resource::<Watched>();
        begin(app.world_mut(), Screen::Playing);
        app.update();
        let own = &app.world().resource::<Session>().config;
        assert_eq!((own.clock.pace, own.assist.damping_time), (0.9, 2.0));
        assert!(app.world().contains_resource::<ReplayLog>(), "the next flight is recorded");
    }

    /// So many frames of a sixtieth of a second, by a hand that rests so many of them between two flicks, and for the last quarter by the
    /// autopilot, if at all.
    fn flown(frames: u32, rest: u32, with_autopilot: bool) -> (App, Replay) {
        let mut app = game_of(Duration::from_micros(16_667));
        app.insert_resource(Session::load(None, Some("chase"), Some(1)).expect("the game's own"));
        app.update();
        app.update();
        press_key(&mut app, KeyCode::Enter, ButtonState::Pressed);
        app.update();
        press_key(&mut app, KeyCode::Enter, ButtonState::Released);
        app.update();
        let key = |key, up, down| (key, false, 60, [up, down]);
        let keys = [key(KeyCode::KeyW, 60..300, 20..90), key(KeyCode::KeyS, 200..900, 10..60), key(KeyCode::KeyF, 600..1200, 90..180)];
        let mut hand = Hand { chance: StdRng::seed_from_u64(1), flick: (Vec2::ZERO, 1.0, 1.0), gone: Vec2::ZERO, rest, keys };
        for frame in 0..frames {
            // The autopilot takes over for the last quarter.
            if with_autopilot && frame == 3 * frames / 4 {
                app.world_mut().resource_mut::<PlayerState>().autopilot = true;
            }
            let pixels = hand.moves();
            app.world_mut().resource_mut::<MouseTurn>().push(pixels, &GameConfig::default());
            hand.presses(&mut app);
            app.update();
        }
        let mut flight = app.world().resource::<ReplayLog>().0.clone();
        flight.finish(app.world());
        assert_eq!(app.world().resource::<PlayerState>().flown, Flown { by_hand: true, by_autopilot: with_autopilot });
        (app, flight)
    }
}
