//! Photo mode: time stands still, the camera is free, and the picture is saved or drawn exactly.

pub mod camera;
pub mod darkroom;

use bevy::input::mouse::AccumulatedMouseMotion;
use bevy::prelude::*;
use bevy_egui::input::EguiWantsInput;
use glam::DVec3;

use crate::play::hud::notice::Notice;
use crate::play::input::PlayerInput;
use crate::play::input::action::Action;
use crate::play::menus::entries::{Does, Entry, PhotoKnob};
use crate::play::menus::screens::{MenuAction, Screen};
use crate::play::picture::CurrentShot;
use crate::play::picture::sight::FrameCamera;
use crate::play::picture::snapshot::snapshot;
use crate::play::schedule::GameSet;
use crate::play::session::Session;
use crate::scene::GameConfig;
use camera::{FreeCamera, Motion};
use darkroom::{Darkroom, How};

/// Sizes of saved pictures, in pixels; the largest has 16 million. None is that of the window.
const SIZES: [Option<[u32; 2]>; 5] = [None, Some([1280, 720]), Some([1920, 1080]), Some([3840, 2160]), Some([5312, 2988])];
/// Field of view, in degrees: least, greatest, step.
const FIELD: (f64, f64, f64) = (20.0, 130.0, 5.0);
/// Stops: least, greatest, step.
const STOPS: (f64, f64, f64) = (-4.0, 4.0, 0.5);
/// Light that the lens spreads: least, greatest, step.
const BLOOM: (f64, f64, f64) = (0.0, 1.0, 0.05);

/// What photo mode has been set to.
#[derive(Resource, Clone, Copy, Debug)]
pub struct Photo {
    /// Where the camera is.
    pub camera: FreeCamera,
    /// The frame that photo mode began with: which ship is hidden or lit.
    frame: FrameCamera,
    /// Stops lighter or darker.
    stops: f64,
    /// Share of light that the lens spreads.
    bloom: f64,
    /// Place in [`SIZES`].
    size: usize,
    /// The panel is shown.
    pub panel: bool,
}

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
    commands.insert_resource(Photo { camera: FreeCamera::at(frame.camera), frame, stops: 0.0, bloom, size: 0, panel: true });
}

fn end(mut commands: Commands) {
    commands.remove_resource::<Photo>();
}

impl Photo {
    /// The camera of the frame. Away from its ship the camera sees that too.
    pub fn frame(&self) -> FrameCamera {
        let away = self.camera.position.distance(self.camera.home.position) > 1e-9;
        let camera = self.camera.observer();
        FrameCamera { camera, hidden: self.frame.hidden.filter(|_| !away), lit: self.frame.lit.filter(|_| !away) }
    }

    /// The configuration that the picture is drawn by.
    pub fn config(&self, config: &GameConfig) -> GameConfig {
        let mut config = config.clone();
        config.video.fov = self.camera.field_of_view.to_degrees();
        config.render.bloom = self.bloom;
        let factor = self.stops.exp2();
        config.render.exposure_key = (config.render.exposure_key * factor).clamp(0.01, 1.0);
        config.disk.exposure_key = (config.disk.exposure_key * factor).clamp(0.01, 8.0);
        config
    }

    /// Width and height of the saved picture in pixels; None for those of the window.
    pub fn size(&self) -> Option<[u32; 2]> {
        SIZES[self.size]
    }

    /// The number of a knob, and between which ends it is turned.
    fn number(&mut self, knob: PhotoKnob) -> Option<(&mut f64, (f64, f64, f64))> {
        match knob {
            PhotoKnob::Exposure => Some((&mut self.stops, STOPS)),
            PhotoKnob::Bloom => Some((&mut self.bloom, BLOOM)),
            _ => None,
        }
    }

    fn turn(&mut self, knob: PhotoKnob, by: i32) {
        let round = |place: usize, count: usize| (place as i32 + by).rem_euclid(count as i32) as usize;
        match knob {
            PhotoKnob::FieldOfView => {
                let degrees = self.camera.field_of_view.to_degrees().round() + f64::from(by) * FIELD.2;
                self.camera.field_of_view = degrees.clamp(FIELD.0, FIELD.1).to_radians();
            }
            PhotoKnob::Motion => {
                let place = Motion::ALL.iter().position(|motion| *motion == self.camera.motion).unwrap_or(0);
                self.camera.motion = Motion::ALL[round(place, Motion::ALL.len())];
            }
            PhotoKnob::Size => self.size = round(self.size, SIZES.len()),
            _ => {
                if let Some((number, (least, most, step))) = self.number(knob) {
                    *number = (*number + f64::from(by) * step).clamp(least, most);
                }
            }
        }
    }
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
        Motion::Ship => "photo-motion-ship",
        Motion::Falling => "photo-motion-falling",
        Motion::Hovering => "photo-motion-hovering",
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

/// A knob is pressed.
pub fn press(world: &mut World, knob: PhotoKnob) {
    match knob {
        PhotoKnob::Save | PhotoKnob::Develop => {
            let how = if knob == PhotoKnob::Save { How::Drawn } else { How::Exactly };
            let size = world.get_resource::<Photo>().and_then(Photo::size);
            match snapshot(world) {
                Ok(moment) => {
                    let moment = moment.resized(size.unwrap_or(moment.size));
                    darkroom::begin(world, &moment, how);
                }
                Err(why) => darkroom::say_failed(world, why),
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
    (mouse, motion): (Res<ButtonInput<MouseButton>>, Res<AccumulatedMouseMotion>),
    pointer: Option<Res<EguiWantsInput>>,
    real: Res<Time<Real>>,
    session: Res<Session>,
    mut photo: ResMut<Photo>,
) {
    /// Of the camera's distance from the hole a second; of a turn in radians a second.
    const RATES: (f64, f64) = (0.35, 1.0);
    if input.pushed(Action::ToggleHud) {
        photo.panel = !photo.panel;
    }
    let seconds = real.delta_secs_f64().min(0.1);
    let stick = input.stick();
    // With the panel on, the arrow keys are its own; a stick or other keys turn all the same.
    let arrows = photo.panel && input.keys.any_pressed([KeyCode::ArrowUp, KeyCode::ArrowDown, KeyCode::ArrowLeft, KeyCode::ArrowRight]);
    let mut turn = if arrows { DVec3::Z * stick.turn.z } else { stick.turn } * (RATES.1 * seconds);
    let dragged = mouse.pressed(MouseButton::Left) && !pointer.is_some_and(|pointer| pointer.wants_any_pointer_input());
    if dragged || !photo.panel {
        let controls = &session.config.controls;
        let sign = |inverted: bool| if inverted { -1.0 } else { 1.0 };
        turn.x -= f64::from(motion.delta.y) * controls.mouse_sensitivity * sign(controls.invert_y);
        turn.y -= f64::from(motion.delta.x) * controls.mouse_sensitivity * sign(controls.invert_x);
    }
    let way = stick.thrust * (RATES.0 * seconds);
    if way != DVec3::ZERO || turn != DVec3::ZERO {
        photo.camera.moved(way, turn);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::config::settings;

    /// Whatever is turned stays allowed.
    #[test]
    fn every_knob_has_ends() {
        let camera = crate::spacetime::Observer {
            position: DVec3::X * 9.0,
            momentum: DVec3::ZERO,
            attitude: glam::DQuat::IDENTITY,
            field_of_view: 1.0,
        };
        let frame = FrameCamera { camera, hidden: Some(0), lit: Some(0) };
        let mut photo = Photo { camera: FreeCamera::at(camera), frame, stops: 0.0, bloom: 0.3, size: 0, panel: true };
        assert_eq!(photo.frame().hidden, Some(0));
        for knob in [PhotoKnob::FieldOfView, PhotoKnob::Exposure, PhotoKnob::Bloom, PhotoKnob::Motion, PhotoKnob::Size] {
            for by in [1, -1] {
                for _ in 0..50 {
                    photo.turn(knob, by);
                    let config = photo.config(&GameConfig::default());
                    for setting in settings() {
                        assert!(setting.check(setting.get(&config)).is_ok(), "{knob:?}: {}", setting.path());
                    }
                }
            }
        }
        assert!(SIZES.iter().flatten().all(|[width, height]| width * height <= 16_000_000));
        photo.camera.moved(DVec3::X * 0.1, DVec3::ZERO);
        assert_eq!(photo.frame().hidden, None, "from aside the ship is seen");
    }
}
