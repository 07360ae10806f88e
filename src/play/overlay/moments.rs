//! Moments: saved as files, and gone to in a replay.

use std::path::{Path, PathBuf};
use web_time::{Duration, Instant, SystemTime};

use bevy::prelude::*;

use crate::play::game::begin;
use crate::play::menus::screens::Screen;
use crate::play::missions::Watched;
use crate::play::overlay::state::Overlay;
use crate::play::picture::snapshot::snapshot;
use crate::play::player_state::PlayerState;
use crate::play::window::pictures::{folders, save_new, stem};
use crate::sim::replay::Playback;
use crate::sim::{Clock, outcome};

/// Wall time in a frame for flying to a moment: the window goes on answering.
const PATIENCE: Duration = Duration::from_millis(30);

/// The replay is flown to this step, a part of the way in each frame.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct Journey(pub u64);

/// Begins to fly the replay that is shown to T = `time`, in r_s/c: on from where it is, or from its start. What is wrong.
pub fn travel(world: &mut World, time: f64) -> Result<(), String> {
    let (Some(watched), true) = (world.get_resource::<Watched>(), world.contains_resource::<Playback>()) else {
        return Err("no replay is shown".into());
    };
    let (clock, last) = (*world.resource::<Clock>(), watched.0.ticks);
    let to = ((time / clock.step).round().max(0.0) as u64).min(last);
    if to < clock.tick {
        let player = world.resource::<PlayerState>().clone();
        begin(world, Screen::Playing);
        // Who looks where stays.
        *world.resource_mut::<PlayerState>() = PlayerState { flown: world.resource::<PlayerState>().flown, ..player };
    }
    if *world.resource::<State<Screen>>().get() == Screen::Result {
        world.resource_mut::<NextState<Screen>>().set(Screen::Playing);
    }
    world.insert_resource(Journey(to));
    Ok(())
}

/// Flies on to where one wants to go.
pub(super) fn fly(world: &mut World) {
    let Some(&Journey(to)) = world.get_resource::<Journey>() else { return };
    let end = Instant::now() + PATIENCE;
    let arrived = loop {
        let gone = !world.contains_resource::<Playback>() || outcome(world).is_some();
        if gone || world.resource::<Clock>().tick >= to {
            break true;
        }
        if Instant::now() >= end {
            break false;
        }
        world.run_schedule(FixedUpdate);
    };
    if arrived {
        world.remove_resource::<Journey>();
    }
}

/// Saves the moment of the frame, where that was asked for; its camera is chosen by now.
pub(super) fn keep(world: &mut World) {
    if !std::mem::take(&mut world.resource_mut::<Overlay>().bypass_change_detection().saves) {
        return;
    }
    let folder = world.resource::<Overlay>().folder.clone();
    let saved = snapshot(world).map_err(String::from).and_then(|moment| write(folder.as_deref(), &moment.to_text()));
    let mut overlay = world.resource_mut::<Overlay>();
    match saved {
        Ok(file) => {
            overlay.said = format!("{}: for shot, trace and compare, as --scene", file.display());
            overlay.moment = Some(file);
        }
        Err(why) => overlay.said = format!("the moment is not saved: {why}"),
    }
}

fn write(folder: Option<&Path>, text: &str) -> Result<PathBuf, String> {
    let folders = folder.map_or_else(folders, |folder| vec![folder.to_path_buf()]);
    save_new(&folders, &stem(SystemTime::now()), "toml", text.as_bytes()).map_err(|error| error.to_string())
}
