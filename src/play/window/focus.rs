//! The window's focus: without it nothing stays pressed, and the flight pauses where `video.pause_without_focus` says so.

use bevy::prelude::*;
use bevy::window::WindowFocused;

use crate::play::menus::screens::{MenuAction, Screen};
use crate::play::schedule::GameSet;
use crate::play::session::Session;

/// Sees the window lose its focus.
pub struct FocusPlugin;

impl Plugin for FocusPlugin {
    fn build(&self, app: &mut App) {
        app.add_message::<WindowFocused>().add_systems(Update, lose_focus.in_set(GameSet::Keys));
    }
}

/// Keys are let go by Bevy itself; mouse buttons here.
fn lose_focus(
    mut changes: MessageReader<WindowFocused>,
    (screen, session): (Res<State<Screen>>, Res<Session>),
    mut mouse: ResMut<ButtonInput<MouseButton>>,
    mut actions: MessageWriter<MenuAction>,
) {
    let Some(change) = changes.read().last() else { return };
    if change.focused {
        return;
    }
    mouse.release_all();
    if session.config.video.pause_without_focus && *screen.get() == Screen::Playing {
        actions.write(MenuAction::Pause);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::input::InputPlugin;
    use bevy::state::app::StatesPlugin;

    /// What is asked for when a window in play loses its focus (or gains it) with a mouse button down, and whether the button is still
    /// down.
    fn asked(focused: bool, pauses: bool) -> (Vec<MenuAction>, bool) {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, StatesPlugin, InputPlugin, FocusPlugin));
        app.add_message::<MenuAction>().insert_state(Screen::Playing);
        let mut session = Session::load(None, Some("chase"), Some(1)).expect("the game's own files");
        session.config.video.pause_without_focus = pauses;
        app.insert_resource(session);
        app.update();
        app.world_mut().resource_mut::<ButtonInput<MouseButton>>().press(MouseButton::Left);
        app.world_mut().write_message(WindowFocused { window: Entity::PLACEHOLDER, focused });
        app.update();
        let actions = app.world_mut().resource_mut::<Messages<MenuAction>>().drain().collect();
        (actions, app.world().resource::<ButtonInput<MouseButton>>().pressed(MouseButton::Left))
    }

    #[test]
    fn without_focus_nothing_stays_pressed_and_the_flight_pauses() {
        assert_eq!(asked(false, true), (vec![MenuAction::Pause], false));
        assert_eq!(asked(false, false), (vec![], false));
        assert_eq!(asked(true, true), (vec![], true));
    }
}
