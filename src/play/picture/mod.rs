//! The picture of the chase: the scene on the renderer, the camera of each frame, and the frame itself.

pub mod now;
pub mod quality;
pub mod sight;
pub mod snapshot;
pub mod stage_loading;

use bevy::prelude::*;
use bevy::window::PrimaryWindow;

use glam::DQuat;

use crate::play::camera::{CameraView, state_of};
use crate::play::input::mouse::MouseTurn;
use crate::play::menus::screens::Screen;
use crate::play::photo::state::Photo;
use crate::play::player_state::PlayerState;
use crate::play::schedule::GameSet;
use crate::render::plugin::{FrameToDraw, PassesTimed, RenderStatistics};
use crate::render::settings::{ANY_FILL, Settings, greatest_rise};
use crate::render::stage::settings;
use crate::scene::mission::GoalTask;
use crate::scene::pilot_kind::PilotKind;
use crate::sim::replay::Playback;
use crate::sim::snapshot::FrameCamera;
use now::Now;
use quality::Quality;
use sight::{ScreenContent, is_cut};
use stage_loading::{CurrentStage, StageLoadingPlugin};

/// Loads the scene, and makes a frame of it each time. Needs [`RelativisticRenderPlugin`](crate::render::plugin::RelativisticRenderPlugin)
/// and [`GamePlugin`](crate::play::game::GamePlugin).
pub struct PicturePlugin;

impl Plugin for PicturePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<CurrentShot>().init_resource::<Quality>().add_plugins(StageLoadingPlugin).add_systems(
            Update,
            (point_camera, quality::choose, make_frame).chain().in_set(GameSet::Picture).run_if(resource_exists::<CurrentStage>),
        );
    }
}

/// The camera of this frame; None as long as there is nothing to show: no chase has begun, or the window has no area, as a minimised one.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct CurrentShot(pub Option<FrameCamera>);

/// How fast the title's camera goes round, in rad a second.
const TITLE_TURN: f64 = 0.02;

/// Chooses the camera: on the player's ship as it turns and looks, or where the screen wants it.
fn point_camera(
    now: Now,
    real: Res<Time<Real>>,
    screen: Res<State<Screen>>,
    windows: Query<&Window, With<PrimaryWindow>>,
    (playback, photo): (Option<Res<Playback>>, Option<Res<Photo>>),
    (mut player, mut turn): (ResMut<PlayerState>, ResMut<MouseTurn>),
    mut shot: ResMut<CurrentShot>,
) {
    if let Some(photo) = photo {
        shot.0 = Some(photo.frame());
        return;
    }
    shot.0 = None;
    let Some((history, ..)) = now.own() else { return };
    if area(&windows).is_none() {
        return;
    }
    let video = &now.session.config.video;
    let (time, seconds, field_of_view) = (now.time(), real.delta_secs_f64(), video.fov.to_radians());
    let me = now.session.player();
    let state = state_of(&history.at(time));
    let sight = sight(&now, *screen.get());
    // All of the player's state goes on, whatever is shown.
    let rigid = player.view == CameraView::Cockpit || video.reduced_motion;
    // The mouse leads the camera at once, and the ship follows.
    player.follower.led(turn.led());
    let lead = if player.autopilot || playback.is_some() { DQuat::IDENTITY } else { turn.lead(now.share()) };
    let attitude = player.follower.follow((state.attitude * lead).normalize(), seconds, rigid);
    // Who does not fly by hand sees where the flight is to lead.
    let watches = player.autopilot && player.pilot != Some(PilotKind::Hands) || playback.is_some();
    let sought = now.target().filter(|_| (player.looking || watches) && sight == ScreenContent::Own);
    let length = now.session.length(me) * player.orbit.zoom();
    let facing = sought.and_then(|(_, target)| player.gaze.facing(&state, player.view, length, attitude, time, target));
    let attitude = player.gaze.turned(attitude, facing, seconds, video.reduced_motion);
    let attitude = player.orbit.attitude(attitude);
    shot.0 = Some(match (sight, now.target()) {
        (ScreenContent::Own, _) => FrameCamera::own(me, &state, player.view, attitude, length, field_of_view),
        (ScreenContent::Caught, Some((caught, history))) => {
            FrameCamera::caught((caught, history, now.session.length(caught)), state.position, time, field_of_view)
        }
        _ => {
            let stands = video.reduced_motion || *screen.get() == Screen::Warning;
            let turn = if stands { 0.0 } else { real.elapsed_secs_f64() * TITLE_TURN };
            FrameCamera::afar(state.position, turn, field_of_view)
        }
    });
}

/// Makes the frame to draw.
fn make_frame(
    now: Now,
    (mut current, shot, statistics, quality): (ResMut<CurrentStage>, Res<CurrentShot>, Res<RenderStatistics>, Res<Quality>),
    (real, player): (Res<Time<Real>>, Res<PlayerState>),
    screen: Res<State<Screen>>,
    (windows, photo): (Query<&Window, With<PrimaryWindow>>, Option<Res<Photo>>),
    (mut frame, mut timed): (ResMut<FrameToDraw>, ResMut<PassesTimed>),
    mut last: Local<Option<(ScreenContent, f64)>>,
) {
    let seconds = real.delta_secs_f64();
    let rise = greatest_rise(now.session.config.accessibility.reduced_flashes, seconds);
    let (Some(size), Some(shot)) = (area(&windows), shot.0) else {
        // The frame before is shown once more.
        if let Some(frame) = &mut frame.0 {
            frame.settings.rise = rise;
        }
        return;
    };
    let config = &now.session.config;
    // Times of an earlier frame will do.
    current.0.ration_aurora(&statistics.passes);
    timed.0 = player.overlay || quality.reads_passes() || current.0.rations_aurora();
    let asked = photo.map_or_else(|| settings(config), |photo| photo.settings(config));
    let mut settings = Settings { rise, ..quality.turned(&asked) };
    if is_cut(&mut last, sight(&now, *screen.get()), now.clock()) {
        // Another picture than that before: the exposure is at once what suits it. What was exposed before says nothing of how light a ship
        // should be.
        settings.fill = ANY_FILL;
    } else {
        settings.adaptation = (1.0 - (-config.render.exposure_speed * seconds).exp2()) as f32;
    }
    settings.own_ship = shot.lit;
    settings.engines = Some([config.ship.thrust, config.enemy.thrust]);
    if let Some(before) = frame.0.take() {
        current.0.reuse(before);
    }
    frame.0 = Some(current.0.frame(shot.camera, size, now.time(), &now.histories(), shot.hidden, &settings));
}

/// What the screen shows of the chase.
fn sight(now: &Now, screen: Screen) -> ScreenContent {
    let outcome = now.chase.as_ref().and_then(|chase| chase.outcome).map(|(outcome, _)| outcome);
    let by_holding =
        now.mission.as_ref().and_then(|mission| mission.0.goals.last()).is_some_and(|goal| matches!(goal.task, GoalTask::Hold { .. }));
    ScreenContent::of(screen, outcome, by_holding)
}

/// Width and height of the window in pixels, if it has an area: a minimised one has none.
fn area(windows: &Query<&Window, With<PrimaryWindow>>) -> Option<[u32; 2]> {
    windows.iter().map(|window| window.physical_size().to_array()).find(|size| size[0] > 0 && size[1] > 0)
}
