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
    let Some(replay) = world.get_resource::<LastFlight>().and_then(|last| last.replay.clone()) else { return };
    let language = world.resource::<Session>().language();
    let text = match replay.to_link() {
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
