//! The window's side of the interface: its 2-D camera, its scale, the cursor.

use bevy::camera::RenderTarget;
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::input::mouse::AccumulatedMouseMotion;
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;
use bevy::window::{CursorGrabMode, CursorOptions, MonitorSelection, PresentMode, PrimaryWindow, WindowMode};
use bevy_egui::EguiContexts;
use bevy_egui::egui::style::Spacing;

use web_time::{Duration, Instant};

use crate::play::choices::Choices;
use crate::play::hud::notice::Notice;
use crate::play::hud::palette::Palette;
use crate::play::loading::Loading;

use crate::play::input::button::Device;
use crate::play::input::mouse::MouseTurn;
use crate::play::menus::screens::Screen;
use crate::play::photo::Photo;
use crate::play::player_state::PlayerState;
use crate::play::schedule::GameSet;
use crate::play::session::Session;
use crate::play::window::points::points_of;
use crate::play::words::font;
use crate::render::job::Wake;
use crate::scene::config::Video;

/// A camera for the picture and the interface, which fits the window; and the mouse in play.
pub struct InterfacePlugin {
    /// Draws on a picture of this size, in pixels, instead of the window.
    pub picture: Option<[u32; 2]>,
}

/// The picture that is drawn on instead of a window.
#[derive(Resource, Clone, Debug)]
pub struct DrawnOn(pub Handle<Image>);

impl Plugin for InterfacePlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(ClearColor(Color::BLACK))
            .add_systems(Startup, spawn_camera)
            .insert_resource(Target(self.picture))
            .init_resource::<Choices>()
            .add_systems(Update, (fit_interface, grab_cursor, follow_settings, keep_choices).in_set(GameSet::Window))
            .add_systems(Last, (keep_at_the_end, limit_frames).chain());
    }
}

#[derive(Resource)]
struct Target(Option<[u32; 2]>);

fn spawn_camera(target: Res<Target>, mut images: ResMut<Assets<Image>>, mut commands: Commands) {
    // The renderer fills the picture itself, tone curve included.
    let mut camera = commands.spawn((Camera2d, Msaa::Off, Tonemapping::None, DebandDither::Disabled));
    if let Some([width, height]) = target.0 {
        let image = images.add(Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None));
        camera.insert(RenderTarget::from(image.clone()));
        commands.insert_resource(DrawnOn(image));
    }
}

/// In a window lower or narrower than this (logical pixels) there is no room for a card.
const NO_ROOM: f32 = 100.0;

/// A click that takes longer, in seconds, is none: some frames where they are slow.
const LONGEST_CLICK: f64 = 3.0;
/// What a finger can meet, in logical pixels.
const FINGER: f32 = 44.0;

/// Gives the interface its letters, its size and its colours.
fn fit_interface(
    windows: Query<&Window, With<PrimaryWindow>>,
    session: Res<Session>,
    mut contexts: EguiContexts,
    device: Res<Device>,
    (mut has_letters, mut had_room): (Local<bool>, Local<bool>),
) {
    let Ok(context) = contexts.ctx_mut() else { return };
    if !std::mem::replace(&mut *has_letters, true) {
        font::install(context);
        context.options_mut(|options| options.input_options.max_click_duration = LONGEST_CLICK);
    }
    let settings = &session.config.accessibility;
    Palette::of(settings).put(context);
    let Some(window) = windows.iter().next() else { return };
    let points = points_of(window, &session);
    context.set_zoom_factor(points);
    let target = if *device == Device::Touch { FINGER / points } else { Spacing::default().interact_size.y };
    if context.global_style().spacing.interact_size.y != target {
        context.all_styles_mut(|style| style.spacing.interact_size.y = target);
    }
    let has_room = window.width().min(window.height()) >= NO_ROOM;
    if has_room && !std::mem::replace(&mut *had_room, has_room) {
        // Cards remember their size, and would stay as small as they were.
        context.memory_mut(bevy_egui::egui::Memory::reset_areas);
    }
    *had_room = has_room;
}

/// The window is as the settings say, from when they change on.
fn follow_settings(session: Res<Session>, mut before: Local<Option<Video>>, mut windows: Query<&mut Window, With<PrimaryWindow>>) {
    let video = &session.config.video;
    let Some(last) = before.replace(video.clone()) else { return };
    for mut window in &mut windows {
        if last.vsync != video.vsync {
            window.present_mode = present_mode(video);
        }
        if last.fullscreen != video.fullscreen {
            window.mode = mode(video);
        }
        if (last.width, last.height) != (video.width, video.height) {
            window.resolution.set(video.width as f32, video.height as f32);
        }
    }
}

/// How frames reach the screen.
pub(in crate::play) fn present_mode(video: &Video) -> PresentMode {
    if video.vsync { PresentMode::AutoVsync } else { PresentMode::AutoNoVsync }
}

/// In a window, or over the whole screen.
pub(in crate::play) fn mode(video: &Video) -> WindowMode {
    if video.fullscreen { WindowMode::BorderlessFullscreen(MonitorSelection::Current) } else { WindowMode::Windowed }
}

/// Frames a second while the scene is loaded: enough to answer, and the processor is free for the work.
const LOADING_FRAMES: u32 = 10;

/// Waits until the next frame is due, where frames are limited; while the scene is loaded, until something has come.
fn limit_frames(session: Res<Session>, loading: Option<Res<Loading>>, wake: Res<Wake>, mut due: Local<Option<Instant>>) {
    // A page has its own beat, and must not wait.
    if cfg!(target_family = "wasm") {
        return;
    }
    let limit = match session.config.video.frame_limit {
        limit if loading.is_none() => limit,
        0 => LOADING_FRAMES,
        limit => limit.min(LOADING_FRAMES),
    };
    let now = Instant::now();
    if limit == 0 {
        *due = None;
        return;
    }
    let period = Duration::from_secs_f64(1.0 / f64::from(limit));
    // Who is late does not hurry afterwards.
    let next = due.map_or(now, |due| due + period).max(now.checked_sub(period).unwrap_or(now));
    let rest = next.saturating_duration_since(now);
    if loading.is_none() {
        std::thread::sleep(rest);
    } else {
        wake.wait(rest);
    }
    *due = Some(next.min(Instant::now()));
}

/// Writes what the player chose, soon after it was chosen: a game that ends badly has lost nothing.
fn keep_choices(mut choices: ResMut<Choices>, real: Res<Time<Real>>, mut notice: ResMut<Notice>, mut last: Local<f64>) {
    /// Wall time between two writings, in seconds: a slider that is dragged changes in each frame.
    const PERIOD: f64 = 0.5;
    let now = real.elapsed_secs_f64();
    if now < *last + PERIOD {
        return;
    }
    *last = now;
    if let Some(text) = choices.bypass_change_detection().write() {
        *notice = Notice { text, until: now + 8.0, share: None };
    }
}

/// What was chosen in the last moment is kept as well.
fn keep_at_the_end(mut ends: MessageReader<AppExit>, mut choices: ResMut<Choices>) {
    if ends.read().next().is_some() {
        choices.write();
    }
}

/// In play the mouse belongs to the ship.
fn grab_cursor(
    screen: Res<State<Screen>>,
    player: Res<PlayerState>,
    (motion, photo): (Res<AccumulatedMouseMotion>, Option<Res<Photo>>),
    (session, device): (Res<Session>, Res<Device>),
    mut turn: ResMut<MouseTurn>,
    mut cursors: Query<&mut CursorOptions, With<PrimaryWindow>>,
) {
    let flown = *screen.get() == Screen::Playing && !player.overlay && !player.autopilot;
    let grabbed = (flown || photo.is_some_and(|photo| !photo.panel)) && *device != Device::Touch;
    for mut cursor in &mut cursors {
        if cursor.visible == grabbed {
            cursor.visible = !grabbed;
            cursor.grab_mode = if grabbed { CursorGrabMode::Locked } else { CursorGrabMode::None };
        }
    }
    if flown && *device != Device::Touch {
        turn.push(motion.delta, &session.config);
    }
}
