//! The dev overlay: every number of `game.toml` live, what a frame costs, switches of light, the flow of time, moments.
//!
//! Two windows lie beside the picture, between the HUD's dials. What is painted only asks ([`state::Ask`]); `answer` does it.

mod answer;
#[cfg(not(target_family = "wasm"))]
mod clipboard;
pub mod frames;
mod groups;
pub mod history;
pub mod live;
pub mod moments;
pub mod place;
mod plots;
pub mod quality;
mod rows;
pub mod saving;
pub mod state;
mod time;

use web_time::Instant;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy_egui::egui::{self, Rect, RichText};
use bevy_egui::{EguiContexts, EguiPrimaryContextPass};

use crate::play::choices::Choices;
use crate::play::hud::Dials;
use crate::play::menus::navigate::FileConfig;
use crate::play::missions::Watched;
use crate::play::pace::{Freeze, run_time};
use crate::play::picture::quality::Quality;
use crate::play::player_state::PlayerState;
use crate::play::schedule::{GameSet, PaintSet};
use crate::play::session::Session;
use crate::render::plugin::RenderStatistics;
use crate::scene::GameConfig;
use crate::sim::Clock;
use crate::sim::replay::Playback;
use frames::Frames;
use history::{Mark, marks};
use moments::Journey;
use quality::QualityReport;
use state::{Overlay, OverlayView, Passing, Tab};

/// Wall time between two looks at the counters, in seconds: faster, nobody could read them.
const COUNTER_PERIOD: f64 = 0.5;
/// Settings of the page of light.
const LIGHT: [&str; 8] = [
    "render.lensing", "render.doppler", "render.beaming", "render.light_delay", "render.orders", "render.method", "disk.representation",
    "aurora.walk",
];

/// The dev overlay, and changes of the configuration. Needs [`HudPlugin`](crate::play::hud::HudPlugin).
pub struct OverlayPlugin;

impl Plugin for OverlayPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(live::LivePlugin)
            .init_resource::<Overlay>()
            .init_resource::<Frames>()
            .init_resource::<Marks>()
            .init_resource::<QualityReport>()
            .init_resource::<FileConfig>()
            .init_resource::<Choices>()
            .add_systems(Update, (answer::answer, moments::fly).chain().in_set(GameSet::Answer).before(run_time))
            .add_systems(Update, (quality::fill_report.run_if(resource_exists::<Quality>), note).in_set(GameSet::Instruments))
            .add_systems(EguiPrimaryContextPass, draw.in_set(PaintSet::Overlay))
            .add_systems(Last, moments::keep);
        // In a page bevy_egui does it.
        #[cfg(not(target_family = "wasm"))]
        app.add_plugins(clipboard::ClipboardPlugin);
    }
}

/// How each setting stands.
#[derive(Resource, Clone, Debug, Default)]
struct Marks(Vec<Mark>);

/// Keeps what the frame took.
fn note(real: Res<Time<Real>>, statistics: Res<RenderStatistics>, mut frames: ResMut<Frames>) {
    frames.push(real.delta_secs_f64() * 1e3, &statistics.passes);
}

/// The flow of time.
#[derive(SystemParam)]
struct Flow<'w> {
    clock: Res<'w, Clock>,
    freeze: Res<'w, Freeze>,
    journey: Option<Res<'w, Journey>>,
    watched: Option<Res<'w, Watched>>,
    playback: Option<Res<'w, Playback>>,
}

impl Flow<'_> {
    fn passing(&self) -> Passing {
        let step = self.clock.step;
        let replay = self.watched.as_ref().filter(|_| self.playback.is_some());
        Passing {
            now: self.clock.time,
            step,
            frozen: self.freeze.on,
            end: replay.map(|watched| watched.0.ticks as f64 * step),
            travels: self.journey.as_ref().map(|journey| journey.0 as f64 * step),
        }
    }
}

/// Draws the overlay where it is on.
fn draw(
    mut contexts: EguiContexts,
    (player, session, dials, quality): (Res<PlayerState>, Res<Session>, Res<Dials>, Res<QualityReport>),
    (file, choices, statistics): (Res<FileConfig>, Res<Choices>, Res<RenderStatistics>),
    (flow, real): (Flow, Res<Time<Real>>),
    (mut overlay, mut frames, mut known): (ResMut<Overlay>, ResMut<Frames>, ResMut<Marks>),
    mut shown: Local<(f64, RenderStatistics)>,
) -> Result {
    if !player.overlay {
        return Ok(());
    }
    let began = Instant::now();
    let context = contexts.ctx_mut()?;
    if let Some(text) = overlay.copies.take() {
        context.copy_text(text);
    }
    if real.elapsed_secs_f64() >= shown.0 {
        *shown = (real.elapsed_secs_f64() + COUNTER_PERIOD, statistics.clone());
    }
    if known.0.is_empty() || session.is_changed() || file.is_changed() || choices.is_changed() || overlay.is_changed() {
        let mut begun: GameConfig = file.0.clone();
        choices.over(&mut begun);
        known.0 = marks(&session.config, &begun, &overlay.history);
    }
    let seen = OverlayView {
        config: &session.config,
        marks: &known.0,
        frames: &frames,
        counters: shown.1.counters,
        disk: shown.1.disk,
        quality: &quality,
        passing: flow.passing(),
    };
    // What is only looked at changes nothing.
    let overlay = overlay.bypass_change_detection();
    show(context, place::places(context.content_rect(), &dials.0), &seen, overlay);
    frames.overlay.push(began.elapsed().as_secs_f64() * 1e3);
    Ok(())
}

/// Lays both windows out.
pub fn show(context: &egui::Context, [left, right]: [Rect; 2], seen: &OverlayView, overlay: &mut Overlay) {
    window("Dev overlay", left).show(context, |ui| {
        ui.horizontal(|ui| {
            for (tab, name) in Tab::ALL {
                ui.selectable_value(&mut overlay.tab, tab, name);
            }
        });
        ui.separator();
        match overlay.tab {
            Tab::Frame => plots::show(ui, seen),
            Tab::Light => rows::list(ui, &LIGHT, seen, overlay),
            Tab::Time => time::show(ui, seen, overlay),
            Tab::Quality => quality::show(ui, seen.quality),
        }
    });
    window("game.toml", right).show(context, |ui| groups::show(ui, seen, overlay));
}

/// A window that fills its place.
fn window(name: &'static str, place: Rect) -> egui::Window<'static> {
    egui::Window::new(RichText::new(name).size(13.0)).id(egui::Id::new(name)).fixed_rect(place.shrink(1.0)).constrain_to(place)
}
