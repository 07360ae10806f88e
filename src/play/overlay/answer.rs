//! Does what the overlay is asked for.

use bevy::prelude::*;

use crate::play::overlay::history::EditHistory;
use crate::play::overlay::moments::travel;
use crate::play::overlay::saving::{begun, command_line, save};
use crate::play::overlay::state::{Ask, Overlay};
use crate::play::pace::Freeze;
use crate::play::session::Session;
use crate::scene::GameConfig;
use crate::scene::config::{self, Value};

/// Does all that is asked for.
pub(super) fn answer(world: &mut World) {
    if world.resource::<Overlay>().asked.is_empty() {
        return;
    }
    for ask in std::mem::take(&mut world.resource_mut::<Overlay>().asked) {
        match ask {
            Ask::Change { to, continues } => change(world, to, continues),
            Ask::Undo => back(world, EditHistory::undo, "undone"),
            Ask::Redo => back(world, EditHistory::redo, "done again"),
            Ask::Save => {
                let said = save(world).unwrap_or_else(|why| why);
                world.resource_mut::<Overlay>().said = said;
            }
            Ask::Copy => {
                let text = command_line(world.resource::<Session>(), &begun(world));
                let mut overlay = world.resource_mut::<Overlay>();
                overlay.said = format!("copied: {text}");
                overlay.copies = Some(text);
            }
            Ask::Freeze(on) => *world.resource_mut::<Freeze>() = Freeze { on, steps: 0 },
            Ask::Step(steps) => {
                let mut freeze = world.resource_mut::<Freeze>();
                *freeze = Freeze { on: true, steps: freeze.steps.saturating_add(steps) };
            }
            Ask::Teleport(time) => {
                if let Err(why) = travel(world, time) {
                    world.resource_mut::<Overlay>().said = why;
                }
            }
            Ask::SaveMoment => world.resource_mut::<Overlay>().saves = true,
        }
    }
}

/// Gives settings new values and keeps the old ones; what clashes changes nothing.
fn change(world: &mut World, to: Vec<(usize, Value)>, continues: bool) {
    let Some(edits) = EditHistory::edits(&world.resource::<Session>().config, to) else { return };
    match put(world, edits.iter().map(|(place, _, after)| (*place, after.clone()))) {
        Ok(()) => {
            let mut overlay = world.resource_mut::<Overlay>();
            overlay.said.clear();
            overlay.history.did(edits, continues);
        }
        Err(why) => world.resource_mut::<Overlay>().said = why,
    }
}

/// One change back or on, and what it is.
fn back(world: &mut World, which: fn(&mut EditHistory) -> Vec<(usize, Value)>, word: &str) {
    let to = which(&mut world.resource_mut::<Overlay>().history);
    let names: Vec<String> = to.iter().map(|(place, _)| config::settings()[*place].path()).collect();
    let said =
        put(world, to).err().unwrap_or_else(|| if names.is_empty() { String::new() } else { format!("{word}: {}", names.join(", ")) });
    world.resource_mut::<Overlay>().said = said;
}

/// Gives settings values; an error in words where they clash with others that are well.
fn put(world: &mut World, to: impl IntoIterator<Item = (usize, Value)>) -> Result<(), String> {
    let session = world.resource::<Session>();
    let mut config: GameConfig = session.config.clone();
    for (place, value) in to {
        config::settings()[place].set(&mut config, value)?;
    }
    // What clashed before, as two keys for one thing, hinders no other change.
    if config::check(&session.config).is_ok() {
        config::check(&config)?;
    }
    if config != session.config {
        world.resource_mut::<Session>().config = config;
    }
    Ok(())
}
