//! What a touch of a menu does.

use bevy::ecs::message::MessageCursor;
use bevy::input::gamepad::Gamepad;
use bevy::input::keyboard::KeyboardInput;
use bevy::prelude::*;
use bevy_egui::input::EguiWantsInput;

use crate::play::choices::Choices;
use crate::play::input::action::Action;
use crate::play::input::bindings::{bound, setting_of};
use crate::play::input::button::{Button, Device};
use crate::play::menus::change::{at_share, stepped};
use crate::play::menus::entries::{Does, Entry, Menu, Page, SLOTS, Touch, Way};
use crate::play::menus::keys::{Held, pressed, touches};
use crate::play::menus::lists::{entries, is_on, settings_of};
use crate::play::menus::screens::{MenuAction, Screen};
use crate::play::missions::Catalogue;
use crate::play::photo;
use crate::play::player_state::PlayerState;
use crate::play::session::Session;
use crate::scene::config::{self, HELD, Setting, Value};
use crate::scene::{Difficulty, GameConfig};

/// Sizes of the window to choose from, in pixels.
const SIZES: [[u32; 2]; 6] = [[960, 540], [1280, 720], [1600, 900], [1920, 1080], [2560, 1440], [3840, 2160]];

/// Reads the devices, and does what they ask of the menu of the screen.
pub fn navigate(world: &mut World, mut held: Local<Held>, mut typed: Local<MessageCursor<KeyboardInput>>) {
    refresh(world);
    let messages: Vec<KeyboardInput> =
        world.get_resource::<Messages<KeyboardInput>>().map(|messages| typed.read(messages).cloned().collect()).unwrap_or_default();
    let mut todo = std::mem::take(&mut world.resource_mut::<Menu>().touched);
    if world.resource::<Menu>().awaits.is_some() {
        await_button(world);
    } else if !world.get_resource::<EguiWantsInput>().is_some_and(EguiWantsInput::wants_keyboard_input) {
        let now = world.resource::<Time<Real>>().elapsed_secs_f64();
        let mut pads = world.query::<&Gamepad>();
        let pads: Vec<&Gamepad> = pads.iter(world).collect();
        let keys = world.resource::<ButtonInput<KeyCode>>();
        todo.extend(touches(keys, &pressed(keys, messages.into_iter()), &pads, now, &mut held));
    }
    if world.resource::<Menu>().entries.is_empty() {
        return;
    }
    for touch in todo {
        touched(world, touch);
        refresh(world);
    }
}

/// The entries as they are now, with the focus on one of them.
fn refresh(world: &mut World) {
    let screen = *world.resource::<State<Screen>>().get();
    let changed = world.resource::<Menu>().screen != Some(screen);
    if changed {
        let mut menu = world.resource_mut::<Menu>();
        menu.screen = Some(screen);
        // What is seen is asked for in play, and shown on the pause.
        let seeing = screen == Screen::Paused && menu.page() == Some(Page::Seeing);
        if !seeing {
            menu.close_all();
        }
    }
    let found = entries(world);
    let chosen = world.get_resource::<PlayerState>().map_or(0, |player| player.choice);
    let mut menu = world.resource_mut::<Menu>();
    menu.focus = menu.focus.min(found.len().saturating_sub(1));
    if changed && screen == Screen::Title {
        let is_chosen = |entry: &Entry| match entry.does {
            Does::Fly(choice) => choice == chosen,
            Does::Ask(action) => action == MenuAction::Start,
            _ => false,
        };
        menu.focus = found.iter().position(is_chosen).unwrap_or(0);
    }
    menu.entries = found;
}

fn focused(world: &World) -> Option<Entry> {
    let menu = world.resource::<Menu>();
    menu.entries.get(menu.focus).cloned()
}

fn touched(world: &mut World, touch: Touch) {
    match touch {
        Touch::Step(Way::Up) => step(world, -1),
        Touch::Step(Way::Down) => step(world, 1),
        Touch::Step(Way::Left) => turn(world, -1),
        Touch::Step(Way::Right) => turn(world, 1),
        Touch::Focus(place, column) => {
            let mut menu = world.resource_mut::<Menu>();
            (menu.focus, menu.column) = (place.min(menu.entries.len().saturating_sub(1)), column);
            chosen_by_focus(world);
        }
        Touch::Turn(share) => match focused(world).map(|entry| entry.does) {
            Some(Does::Choose(setting)) => _ = at_share(setting, share).map(|value| choose(world, setting, value)),
            Some(Does::Photo(knob)) => photo::turn_to(world, knob, share),
            _ => (),
        },
        Touch::Clear => {
            if let Some(Does::Bind(action)) = focused(world).map(|entry| entry.does) {
                bind(world, action, None);
            }
        }
        Touch::Confirm => confirm(world),
        Touch::Back => back(world),
    }
}

/// The focus goes up or down, and round.
fn step(world: &mut World, by: isize) {
    let mut menu = world.resource_mut::<Menu>();
    let count = menu.entries.len() as isize;
    menu.focus = (menu.focus as isize + by).rem_euclid(count.max(1)) as usize;
    chosen_by_focus(world);
}

/// On the title what has the focus is chosen.
fn chosen_by_focus(world: &mut World) {
    if let Some(Does::Fly(choice)) = focused(world).map(|entry| entry.does) {
        world.write_message(MenuAction::Choose(choice));
    }
}

/// The value before or after; or the column beside.
fn turn(world: &mut World, by: i32) {
    let Some(entry) = focused(world) else { return };
    match entry.does {
        Does::Choose(setting) => {
            let value = stepped(setting, &setting.get(&world.resource::<Session>().config), by);
            choose(world, setting, value);
        }
        Does::Switch(setting) => switch(world, setting),
        Does::WindowSize => {
            let video = &world.resource::<Session>().config.video;
            let place = SIZES.iter().position(|size| *size == [video.width, video.height]).unwrap_or(1) as i32;
            let [width, height] = SIZES[(place + by).rem_euclid(SIZES.len() as i32) as usize];
            for (path, pixels) in [("video.width", width), ("video.height", height)] {
                if let Some(setting) = config::setting(path) {
                    choose(world, setting, Value::Integer(pixels));
                }
            }
        }
        Does::Level => {
            let place = Difficulty::ALL.iter().position(|level| *level == world.resource::<Session>().difficulty).unwrap_or(0) as i32;
            let level = Difficulty::ALL[(place + by).rem_euclid(Difficulty::ALL.len() as i32) as usize];
            world.write_message(MenuAction::Level(level));
        }
        Does::Fly(_) if entry.id == "free" => {
            let scenes = world.get_resource::<Catalogue>().map_or(1, |catalogue| catalogue.free.len()) as i32;
            let free = world.resource::<PlayerState>().free as i32;
            world.write_message(MenuAction::Scene((free + by).rem_euclid(scenes) as usize));
        }
        Does::Bind(_) => {
            let mut menu = world.resource_mut::<Menu>();
            menu.column = (menu.column as i32 + by).rem_euclid(SLOTS.len() as i32) as usize;
        }
        Does::Card(_) => {
            let to = world.resource::<Menu>().entries.get(usize::from(by < 0)).map(|entry| entry.does);
            if let Some(Does::Card(card)) = to {
                show_card(world, card);
            }
        }
        Does::Photo(knob) => photo::step(world, knob, by),
        _ => (),
    }
}

/// Does what the entry with the focus is for.
fn confirm(world: &mut World) {
    let Some(entry) = focused(world) else { return };
    match entry.does {
        Does::Ask(action) => _ = world.write_message(action),
        Does::Open(page) => world.resource_mut::<Menu>().open(page),
        Does::Back => back(world),
        Does::Fly(choice) => {
            world.write_message(MenuAction::Choose(choice));
            world.write_message(MenuAction::Start);
        }
        Does::Bind(action) => {
            let column = world.resource::<Menu>().column;
            match SLOTS[column] {
                Some(_) => world.resource_mut::<Menu>().awaits = Some((action, column)),
                None => tap_or_hold(world, action),
            }
        }
        Does::Preset(preset) => with_choices(world, |choices, file, config| preset.apply(choices, file, config)),
        Does::Reset(page) => with_choices(world, |choices, file, config| {
            let of_page = |setting: &Setting<GameConfig>| {
                settings_of(page).contains(&setting.path().as_str())
                    || (page == Page::Video && ["video.width", "video.height"].contains(&setting.path().as_str()))
            };
            choices.forget(of_page, file, config);
        }),
        Does::Warned => {
            if let Some(setting) = config::setting("interface.warned") {
                choose(world, setting, Value::Switch(true));
            }
            world.write_message(MenuAction::Title);
        }
        Does::Card(card) => show_card(world, card),
        Does::Photo(knob) => photo::press(world, knob),
        Does::Choose(_) | Does::Switch(_) | Does::WindowSize | Does::Level => turn(world, 1),
    }
}

fn show_card(world: &mut World, card: usize) {
    let mut menu = world.resource_mut::<Menu>();
    if let Some(page) = menu.pages.last_mut() {
        *page = Page::Manual(card);
    }
}

/// Closes the page on top; without one, leaves the screen.
fn back(world: &mut World) {
    let screen = *world.resource::<State<Screen>>().get();
    let was_seeing = world.resource::<Menu>().page() == Some(Page::Seeing);
    if world.resource_mut::<Menu>().close() {
        // It was asked for in play, by its key.
        if was_seeing && world.resource::<Menu>().pages.is_empty() && world.resource::<PlayerState>().seeing_from_play {
            world.write_message(MenuAction::Pause);
        }
        return;
    }
    match screen {
        Screen::Paused => _ = world.write_message(MenuAction::Pause),
        Screen::Result => _ = world.write_message(MenuAction::Title),
        Screen::Photo => _ = world.write_message(MenuAction::Photo),
        Screen::Warning | Screen::Title | Screen::Playing => (),
    }
}

/// What `game.toml` says, without the player's choices.
#[derive(Resource, Clone, Debug, Default)]
pub struct FileConfig(pub GameConfig);

/// Changes the player's choices.
pub fn with_choices(world: &mut World, change: impl FnOnce(&mut Choices, &GameConfig, &mut GameConfig)) {
    world.init_resource::<Choices>();
    world.init_resource::<FileConfig>();
    world.resource_scope(|world, mut choices: Mut<Choices>| {
        let file = world.resource::<FileConfig>().0.clone();
        change(&mut choices, &file, &mut world.resource_mut::<Session>().config);
    });
}

/// Chooses a value that is kept.
pub fn choose(world: &mut World, setting: &'static Setting<GameConfig>, value: Value) {
    with_choices(world, |choices, _, config| choices.choose(setting, value, config));
}

/// Changes one of the switches of what light does, for this moment.
fn switch(world: &mut World, setting: &'static Setting<GameConfig>) {
    let config = &mut world.resource_mut::<Session>().config;
    let value = match setting.get(config) {
        Value::Switch(on) => Value::Switch(!on),
        _ => Value::Integer(if is_on(setting, config) { 1 } else { 2 }),
    };
    _ = setting.set(config, value);
}

/// Whether an action is held or tapped.
fn tap_or_hold(world: &mut World, action: Action) {
    let (Some(setting), true) = (config::setting("controls.tapped"), HELD.contains(&action.key())) else { return };
    let tapped = world.resource::<Session>().config.controls.tapped.clone();
    let mut names: Vec<&str> = tapped.split_whitespace().filter(|name| *name != "None" && *name != action.key()).collect();
    if !tapped.split_whitespace().any(|name| name == action.key()) {
        names.push(action.key());
    }
    let words = if names.is_empty() { "None".to_owned() } else { names.join(" ") };
    choose(world, setting, Value::Word(words));
}

/// Binds a button to the column that has the focus, or none.
fn bind(world: &mut World, action: Action, name: Option<&str>) {
    let column = world.resource::<Menu>().column;
    let (Some(Some((device, slot))), Some(setting)) = (SLOTS.get(column), setting_of(action)) else { return };
    let value = bound(&world.resource::<Session>().config, action, *device, *slot, name);
    choose(world, setting, value);
}

/// Waits for the button that is to do something. Escape is none, but for the pause.
fn await_button(world: &mut World) {
    let Some((action, column)) = world.resource::<Menu>().awaits else { return };
    let Some(Some((device, _))) = SLOTS.get(column) else { return };
    let keys = world.resource::<ButtonInput<KeyCode>>();
    if keys.just_pressed(KeyCode::Escape) && !(action == Action::Pause && *device == Device::Keyboard) {
        world.resource_mut::<Menu>().awaits = None;
        return;
    }
    let button = match device {
        Device::Keyboard => {
            let key = keys.get_just_pressed().next().map(|key| Button::Key(*key));
            key.or_else(|| world.resource::<ButtonInput<MouseButton>>().get_just_pressed().next().map(|button| Button::Mouse(*button)))
        }
        // What is on the screen stays as it is.
        Device::Touch => None,
        Device::Pad => {
            let mut pads = world.query::<&Gamepad>();
            pads.iter(world).find_map(pressed_on)
        }
    };
    if let Some(name) = button.and_then(Button::name) {
        world.resource_mut::<Menu>().awaits = None;
        bind(world, action, Some(&name));
    }
}

/// The button that went down on a pad, or the way in which one of its sticks is pushed.
fn pressed_on(pad: &Gamepad) -> Option<Button> {
    use bevy::input::gamepad::GamepadAxis::{LeftStickX, LeftStickY, RightStickX, RightStickY};
    /// A stick means it from here on.
    const PUSHED: f32 = 0.7;
    let button = pad.get_just_pressed().next().map(|button| Button::Pad(*button));
    let stick = || {
        let ways = [LeftStickX, LeftStickY, RightStickX, RightStickY].into_iter();
        let values = ways.filter_map(|axis| pad.get(axis).map(|value| (axis, value)));
        values.filter(|(_, value)| value.abs() > PUSHED).map(|(axis, value)| Button::Stick(axis, value.signum())).next()
    };
    button.or_else(stick)
}
