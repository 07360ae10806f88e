//! Photo mode: time stands still, the camera is free, and the picture is saved or drawn exactly.

pub mod camera;
pub mod darkroom;
pub mod state;

use bevy::input::mouse::AccumulatedMouseMotion;
use bevy::input::touch::Touches;
use bevy::prelude::*;
use bevy_egui::input::EguiWantsInput;
use glam::DVec3;

use crate::play::hud::notice::Notice;
use crate::play::input::PlayerInput;
use crate::play::input::action::Action;
use crate::play::menus::entries::{Does, Entry, PhotoKnob};
use crate::play::menus::screens::{MenuAction, Screen};
use crate::play::picture::CurrentShot;
use crate::play::picture::snapshot::snapshot;
use crate::play::schedule::GameSet;
use crate::play::session::Session;
use crate::play::window::record;
use camera::{CameraMotion, FreeCamera};
use darkroom::{Darkroom, How};
pub use state::Photo;
use state::{FIELD, STOPS};

/// The camera of photo mode, and its panel's numbers.
pub struct PhotoPlugin;

impl Plugin for PhotoPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Darkroom>()
            .add_systems(Update, darkroom::watch.in_set(GameSet::Window).run_if(resource_exists::<Notice>))
            .add_systems(OnEnter(Screen::Photo), begin)
            .add_systems(OnExit(Screen::Photo), end)
            .add_systems(Update, lead.in_set(GameSet::Keys).run_if(in_state(Screen::Photo).and_then(resource_exists::<Photo>)));
    }
}

fn begin(shot: Option<Res<CurrentShot>>, session: Res<Session>, mut actions: MessageWriter<MenuAction>, mut commands: Commands) {
    let Some(frame) = shot.and_then(|shot| shot.0) else {
        // Nothing is shown that could be photographed.
        actions.write(MenuAction::Photo);
        return;
    };
    let bloom = session.config.render.bloom;
    commands.insert_resource(Photo { camera: FreeCamera::at(frame.camera), frame, stops: 0.0, bloom, size: 0, panel: true, makes_way: 0 });
}

fn end(mut commands: Commands) {
    commands.remove_resource::<Photo>();
}

/// The entries of photo mode's panel.
pub fn entries(world: &World) -> Vec<Entry> {
    let (Some(photo), Some(session)) = (world.get_resource::<Photo>(), world.get_resource::<Session>()) else { return Vec::new() };
    if !photo.panel {
        return Vec::new();
    }
    let language = session.language();
    let knob = |id: &'static str, key: &str, knob, value: String| Entry::new(id, language.say(key), Does::Photo(knob)).valued(value);
    let motion = language.say(match photo.camera.motion {
        CameraMotion::Ship => "photo-motion-ship",
        CameraMotion::Falling => "photo-motion-falling",
        CameraMotion::Hovering => "photo-motion-hovering",
    });
    let size = photo.size().map_or_else(|| language.say("photo-size-window"), |[width, height]| format!("{width} × {height}"));
    let field = photo.camera.field_of_view.to_degrees();
    let share = |number: f64, (least, most, _): (f64, f64, f64)| Some((number - least) / (most - least));
    let mut entries = vec![
        Entry { share: share(field, FIELD), ..knob("field-of-view", "setting-video-fov", PhotoKnob::FieldOfView, format!("{field:.0}°")) },
        Entry {
            share: share(photo.stops, STOPS),
            ..knob("exposure", "photo-exposure", PhotoKnob::Exposure, format!("{:+.1}", photo.stops))
        },
        Entry { share: Some(photo.bloom), ..knob("bloom", "photo-bloom", PhotoKnob::Bloom, format!("{:.2}", photo.bloom)) },
        knob("motion", "photo-motion", PhotoKnob::Motion, motion),
        knob("size", "photo-size", PhotoKnob::Size, size),
    ];
    let press = |id: &'static str, key: &str, knob| Entry::new(id, language.say(key), Does::Photo(knob));
    entries.push(press("save", "photo-save", PhotoKnob::Save));
    entries.push(press("develop", "photo-develop", PhotoKnob::Develop));
    entries.push(press("home", "photo-home", PhotoKnob::Home));
    entries.push(Entry::new("back", language.say("menu-back"), Does::Back));
    if cfg!(target_family = "wasm") {
        entries.retain(|entry| !matches!(entry.does, Does::Photo(PhotoKnob::Size | PhotoKnob::Develop)));
    }
    entries
}

/// A knob one step on or back.
pub fn step(world: &mut World, knob: PhotoKnob, by: i32) {
    if let Some(mut photo) = world.get_resource_mut::<Photo>() {
        photo.turn(knob, by);
    }
}

/// A knob at a share between its ends.
pub fn turn_to(world: &mut World, knob: PhotoKnob, share: f64) {
    let Some(mut photo) = world.get_resource_mut::<Photo>() else { return };
    let between = |(least, most, step): (f64, f64, f64)| (least + ((most - least) * share / step).round() * step).clamp(least, most);
    if knob == PhotoKnob::FieldOfView {
        photo.camera.field_of_view = between(FIELD).to_radians();
    } else if let Some((number, ends)) = photo.number(knob) {
        *number = between(ends);
    }
}

/// After so many frames a picture has been taken.
const PICTURED: u32 = 3;

/// A knob is pressed.
pub fn press(world: &mut World, knob: PhotoKnob) {
    match knob {
        // A page has no program to draw another size: what is on the screen is saved.
        PhotoKnob::Save if cfg!(target_family = "wasm") => {
            if let Some(mut photo) = world.get_resource_mut::<Photo>() {
                (photo.makes_way, photo.panel) = (PICTURED, false);
            }
            record::screenshot(world);
        }
        PhotoKnob::Save | PhotoKnob::Develop => {
            let how = if knob == PhotoKnob::Save { How::Drawn } else { How::Exactly };
            let size = world.get_resource::<Photo>().and_then(Photo::size);
            match snapshot(world) {
                Ok(moment) => {
                    let moment = moment.resized(size.unwrap_or(moment.size));
                    darkroom::begin(world, &moment, how);
                }
                Err(why) => darkroom::notify_failure(world, why),
            }
        }
        PhotoKnob::Home => {
            if let Some(mut photo) = world.get_resource_mut::<Photo>() {
                photo.camera = FreeCamera::at(photo.camera.home);
            }
        }
        _ => step(world, knob, 1),
    }
}

/// The keys that otherwise fly move the camera; the mouse turns it while its left button is held, or while the panel is off.
fn lead(
    input: PlayerInput,
    (mouse, motion, touches): (Res<ButtonInput<MouseButton>>, Res<AccumulatedMouseMotion>, Res<Touches>),
    pointer: Option<Res<EguiWantsInput>>,
    real: Res<Time<Real>>,
    session: Res<Session>,
    mut photo: ResMut<Photo>,
) {
    /// Of the camera's distance from the hole a second; of a turn in radians a second.
    const RATES: (f64, f64) = (0.12, 1.0);
    /// Of the camera's distance from the hole, for fingers that go e times as far apart.
    const PINCH: f64 = 0.3;
    if input.pushed(Action::ToggleHud) {
        photo.panel = !photo.panel;
    }
    if photo.makes_way > 0 {
        photo.makes_way -= 1;
        photo.panel |= photo.makes_way == 0;
    }
    let seconds = real.delta_secs_f64().min(0.1);
    let stick = input.stick();
    // With the panel on, the arrow keys are its own; a stick or other keys turn all the same.
    let arrows = photo.panel && input.keys.any_pressed([KeyCode::ArrowUp, KeyCode::ArrowDown, KeyCode::ArrowLeft, KeyCode::ArrowRight]);
    let mut turn = if arrows { DVec3::Z * stick.turn.z } else { stick.turn } * (RATES.1 * seconds);
    let free = !pointer.is_some_and(|pointer| pointer.wants_any_pointer_input());
    let dragged = mouse.pressed(MouseButton::Left) && free;
    let mut way = stick.thrust * (RATES.0 * seconds);
    let mut led = if dragged || !photo.panel { motion.delta } else { Vec2::ZERO };
    // One finger leads as the mouse does; two go nearer and farther.
    match touches.iter().collect::<Vec<_>>()[..] {
        [one] if free => led += one.delta(),
        [one, other] => {
            let [before, now] = [one.previous_position() - other.previous_position(), one.position() - other.position()].map(Vec2::length);
            if before > 0.0 && now > 0.0 {
                way.z += PINCH * f64::from(before / now).ln();
            }
        }
        _ => (),
    }
    let controls = &session.config.controls;
    let sign = |inverted: bool| if inverted { -1.0 } else { 1.0 };
    turn.x -= f64::from(led.y) * controls.mouse_sensitivity * sign(controls.invert_y);
    turn.y -= f64::from(led.x) * controls.mouse_sensitivity * sign(controls.invert_x);
    if way != DVec3::ZERO || turn != DVec3::ZERO {
        photo.camera.moved(way, turn);
    }
}
