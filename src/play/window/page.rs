//! What the page is told of the game: that it has begun, and which screen is shown.

use bevy::prelude::*;

use crate::page;
use crate::play::input::button::Device;
use crate::play::menus::screens::Screen;
use crate::play::missions::LastFlight;
use crate::play::picture::stage_loading::CurrentStage;
use crate::sim::replay::Playback;

/// After so many frames one is on the page.
const FRAMES_BEFORE_BEGUN: u32 = 2;

/// Tells the page.
pub(super) struct PagePlugin;

impl Plugin for PagePlugin {
    fn build(&self, app: &mut App) {
        if page::by_finger() {
            app.insert_resource(Device::Touch);
        }
        app.add_systems(
            Last,
            (
                begun,
                shown.run_if(state_changed::<Screen>),
                page::drawn.run_if(resource_added::<CurrentStage>),
                hands.run_if(resource_exists_and_changed::<Device>),
            ),
        );
    }
}

fn hands(device: Res<Device>) {
    page::hands(match *device {
        Device::Keyboard => "keyboard",
        Device::Pad => "pad",
        Device::Touch => "touch",
    });
}

fn begun(mut frames: Local<u32>) {
    *frames = frames.saturating_add(1);
    if *frames == FRAMES_BEFORE_BEGUN {
        page::begun();
    }
}

fn shown(screen: Res<State<Screen>>, last: Option<Res<LastFlight>>, playback: Option<Res<Playback>>) {
    let name = match screen.get() {
        Screen::Warning => "warning",
        Screen::Title => "title",
        Screen::Playing => "playing",
        Screen::Paused => "paused",
        Screen::Result => "result",
        Screen::Photo => "photo",
    };
    let won = *screen.get() == Screen::Result && last.is_some_and(|last| last.won.is_some());
    page::screen(name, won, playback.is_some());
}
