//! The moment of the frame that is on the screen, for its picture to carry.

use bevy::prelude::*;
use bevy::window::PrimaryWindow;

use crate::play::missions::{LastFlight, TitleFlight, Watched};
use crate::play::photo::state::Photo;
use crate::play::picture::{CurrentShot, now};
use crate::play::session::Session;
use crate::sim::Clock;
use crate::sim::replay::{Playback, Replay, ReplayLog};
use crate::sim::run::state_hash;
use crate::sim::snapshot::Snapshot;

/// The moment of this frame, once its camera is chosen; an error, in words, where it cannot be made again.
pub fn snapshot(world: &mut World) -> Result<Snapshot, &'static str> {
    let sizes: Vec<[u32; 2]> =
        world.query_filtered::<&Window, With<PrimaryWindow>>().iter(world).map(|window| window.physical_size().to_array()).collect();
    let shot = world.get_resource::<CurrentShot>().and_then(|shot| shot.0);
    let (Some(shot), Some(&size)) = (shot, sizes.first()) else { return Err("nothing is flown yet") };
    let (Some(session), Some(clock)) = (world.get_resource::<Session>(), world.get_resource::<Clock>()) else {
        return Err("nothing is flown yet");
    };
    let flight = flight(world).ok_or("a setting that the flight depends on was changed in flight")?;
    let time = world.get_resource::<Time<Fixed>>().map_or(clock.time, |fixed| now::time(clock, fixed));
    let config = session.config.clone();
    let config = world.get_resource::<Photo>().map_or_else(|| config.clone(), |photo| photo.config(&config));
    Ok(Snapshot::new(flight.up_to(clock.tick, world), &session.scene, &config, world, time, shot, size))
}

/// The flight that is shown, from its beginning.
fn flight(world: &World) -> Option<&Replay> {
    if let Some(title) = world.get_resource::<TitleFlight>() {
        return Some(&title.0);
    }
    if let (Some(watched), true) = (world.get_resource::<Watched>(), world.contains_resource::<Playback>()) {
        return Some(&watched.0);
    }
    if let Some(log) = world.get_resource::<ReplayLog>() {
        return Some(&log.0);
    }
    // Of a decided flight the log is closed. An earlier flight ended otherwise.
    let last = world.get_resource::<LastFlight>()?.replay.as_ref()?;
    (last.ticks == world.get_resource::<Clock>()?.tick && last.hash == state_hash(world).to_string()).then_some(last)
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::time::Duration;

    use super::*;
    use crate::play::game::begin;
    use crate::play::game::tests::game_of;
    use crate::play::input::tests::press_key;
    use crate::play::menus::screens::Screen;
    use crate::sim::snapshot::FrameCamera;
    use crate::sim::{Fleet, History};
    use bevy::input::ButtonState;

    /// The game at the title, 0.37 steps more than a whole number a frame, with a window and a camera from far.
    fn game() -> App {
        let mut app = game_of(Duration::from_secs_f64(3.37 / 48.0));
        app.insert_resource(CurrentShot(Some(FrameCamera::afar(glam::DVec3::X * 9.0, 0.3, 1.0))));
        app.world_mut().spawn((Window { resolution: (320, 180).into(), ..default() }, PrimaryWindow));
        (0..9).for_each(|_| app.update());
        app
    }

    /// Takes the moment, makes it again from its text, and holds it against the game.
    fn hold(app: &mut App) -> Snapshot {
        let taken = snapshot(app.world_mut()).expect("a moment");
        let path = Path::new("a.png");
        let read = Snapshot::from_text(path, &taken.to_text()).expect("a text that can be read");
        assert_eq!(read, taken);
        // Says so if it comes elsewhere.
        let again = read.fly(path).expect("it is made again");
        let world = app.world();
        for (index, &ship) in world.resource::<Fleet>().0.iter().enumerate() {
            let there = world.get::<History>(ship).expect("a ship's worldline");
            for time in [taken.time, taken.time - 0.013, taken.time - 5.0] {
                assert_eq!(again.histories()[index].at(time), there.at(time), "ship {index} at T = {time}");
            }
        }
        taken
    }

    #[test]
    fn a_moment_of_the_title_and_one_flown_by_hand_come_again() {
        let mut app = game();
        let title = hold(&mut app);
        assert!(title.flight.records.is_empty() && title.time > 0.5, "{title:?}");
        // Whatever the pace is later, the flight is as it began.
        app.world_mut().resource_mut::<Session>().config.clock.pace = 3.0;
        app.update();
        hold(&mut app);
        begin(app.world_mut(), Screen::Playing);
        app.world_mut().resource_mut::<NextState<Screen>>().set(Screen::Playing);
        app.update();
        for (frame, key) in [(3, KeyCode::KeyW), (9, KeyCode::ArrowLeft), (15, KeyCode::KeyA)] {
            press_key(&mut app, key, ButtonState::Pressed);
            (0..frame).for_each(|_| app.update());
        }
        let flown = hold(&mut app);
        let step = app.world().resource::<Clock>().step;
        let part = flown.time / step - (flown.time / step).floor();
        assert!(flown.flight.records.len() >= 3 && part > 0.01 && part < 0.99, "{part}: {:?}", flown.flight.records);
    }

    #[test]
    fn what_cannot_come_again_is_said() {
        let mut app = game();
        begin(app.world_mut(), Screen::Playing);
        app.update();
        assert!(snapshot(app.world_mut()).is_ok());
        app.world_mut().remove_resource::<ReplayLog>();
        assert!(snapshot(app.world_mut()).is_err_and(|why| why.contains("setting")));
    }
}
