//! Sound in the window: in each frame what is heard is read and handed to the loudspeakers.

use bevy::prelude::*;

use crate::play::menus::screens::Screen;
use crate::play::picture::CurrentShot;
use crate::play::schedule::GameSet;
use crate::play::session::Session;
use crate::play::sound::heard::Heard;
use crate::play::sound::output::{Wanted, hear, open};
use crate::play::sound::read::Listener;
use crate::play::sound::volumes::Volumes;
use crate::sim::Clock;

/// Plays what is heard. Needs [`Session`], [`CurrentShot`] and the screens.
pub struct SoundPlugin;

impl Plugin for SoundPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<SceneListener>()
            .insert_resource(Loudspeakers(open()))
            .add_systems(Update, (tune.run_if(resource_exists_and_changed::<Session>), listen).chain().in_set(GameSet::Instruments));
    }
}

/// Where the sound goes, if there is anything.
#[derive(Resource)]
struct Loudspeakers(Option<Wanted>);

/// The listener of the scene that is played.
#[derive(Resource, Default)]
struct SceneListener(Option<Listener>);

fn tune(session: Res<Session>, mut listener: ResMut<SceneListener>) {
    listener.0 = Some(Listener::of(&session));
}

fn listen(world: &World) {
    let Some(Loudspeakers(Some(wanted))) = world.get_resource::<Loudspeakers>() else { return };
    let volumes = world.get_resource::<Session>().map_or_else(Volumes::default, |session| Volumes::of(&session.config.sound));
    hear(wanted, now(world), volumes);
}

/// What is heard in this frame: in play the flight, after it what rings on, on the title the music.
fn now(world: &World) -> Heard {
    let screen = world.get_resource::<State<Screen>>().map(|screen| *screen.get());
    if screen.is_none_or(|screen| matches!(screen, Screen::Paused | Screen::Photo | Screen::Warning)) {
        return Heard::default();
    }
    let flight = || {
        let (session, clock) = (world.get_resource::<Session>()?, world.get_resource::<Clock>()?);
        let overstep = world.get_resource::<Time<Fixed>>().map_or(0.0, Time::overstep_fraction_f64);
        let time = (clock.time - clock.step * (1.0 - overstep)).max(0.0);
        let shot = world.get_resource::<CurrentShot>().and_then(|shot| shot.0);
        world.get_resource::<SceneListener>()?.0.as_ref()?.heard(world, session, time, shot.map(|shot| shot.camera.attitude))
    };
    match screen {
        Some(Screen::Playing) => flight().unwrap_or(Heard::MUSIC),
        Some(Screen::Result) => flight().map_or(Heard::MUSIC, Heard::at_rest),
        _ => Heard::MUSIC,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::app_of;

    /// A flight on the screen `screen`, 2 r_s/c after its beginning.
    fn heard(screen: Screen) -> Heard {
        let session = Session::load(None, Some("chase"), Some(1)).expect("the game's own files");
        let mut app = app_of(&session.scene, &session.effective(), 1);
        (0..64).for_each(|_| app.world_mut().run_schedule(FixedUpdate));
        app.insert_resource(SceneListener(Some(Listener::of(&session)))).insert_resource(session).insert_resource(State::new(screen));
        now(app.world())
    }

    #[test]
    fn the_flight_is_heard_in_play_alone() {
        let playing = heard(Screen::Playing);
        assert!(playing.running && playing.engine > 0.1 && playing.beacon.is_some(), "{playing:?}");
        assert_eq!(heard(Screen::Paused), Heard::default());
        assert_eq!(heard(Screen::Title), Heard::MUSIC);
        assert_eq!(heard(Screen::Result), playing.at_rest());
    }
}
