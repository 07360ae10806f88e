//! How much of the model the frames of the game are drawn with: `video.quality`, held by a [`Governor`] or fixed.

use bevy::prelude::*;
use bevy::window::{Monitor, OnMonitor, PrimaryWindow};

use crate::play::picture::stage_loading::CurrentStage;
use crate::play::session::Session;
use crate::render::plugin::RenderStatistics;
use crate::render::quality::costs::{QualityCosts, SceneClass};
use crate::render::quality::governor::Governor;
use crate::render::quality::ladder::{QualityRung, ladder, within};
use crate::render::quality::options::turned;
use crate::render::settings::Settings;
use crate::scene::GameConfig;

/// The greatest error of `medium`, in mean FLIP: a look for differences finds them.
pub const MEDIUM: f64 = 0.04;
/// The greatest error of `low`: they are seen at once.
pub const LOW: f64 = 0.3;
/// Frames a second that are held where the display does not tell its rate.
const USUAL_RATE: f64 = 60.0;
/// A frame within this share of the time to hold may have waited for the screen.
const CAPPED: f64 = 1.1;
/// What of such a frame is taken for work, where the device has no timestamps: little enough that every ladder's next rung is tried.
const UNKNOWN_WORK: f64 = 0.5;

/// The rung in use, and what chose it.
#[derive(Resource, Debug, Default)]
pub struct Quality {
    /// Whether `automatic` is; else it is as `high`, for pictures that nobody waits for.
    governed: bool,
    class: Option<SceneClass>,
    ladder: Vec<QualityRung>,
    governor: Governor,
    rung: usize,
    hold: Option<f64>,
}

impl Quality {
    /// At its finest unless a level is chosen; `governed`: `automatic` holds the frame time.
    pub fn new(governed: bool) -> Quality {
        Quality { governed, ..Quality::default() }
    }

    /// The rung in use; None before the first frame.
    pub fn rung(&self) -> Option<&QualityRung> {
        self.ladder.get(self.rung)
    }

    /// The number of the rung, and of all.
    pub fn place(&self) -> [usize; 2] {
        [self.rung, self.ladder.len()]
    }

    /// The frame time that is held, in ms; None where the level is fixed.
    pub fn hold(&self) -> Option<f64> {
        self.hold
    }

    /// Whether the next choice may depend on how long the passes took: only then may a finer rung fit.
    pub fn reads_passes(&self) -> bool {
        self.hold.is_some() && self.rung > 0
    }

    /// The settings on that rung.
    pub fn turned(&self, settings: &Settings) -> Settings {
        self.rung().map_or(*settings, |rung| turned(settings, &rung.steps))
    }

    /// What is chosen and why, in a sentence.
    pub fn describe(&self) -> String {
        let Some(rung) = self.rung() else { return "nothing is drawn yet".into() };
        let why = match self.hold {
            Some(hold) => format!("to hold {hold:.1} ms a frame (now {:.1})", self.governor.mean()),
            None => "as chosen".into(),
        };
        let class = self.class.map_or("", SceneClass::name);
        format!(
            "rung {} of {} for scenes of the class {class}, {why}: {}; predicted error {:.3} (mean FLIP), {:.0} % of the finest's time",
            self.rung + 1,
            self.ladder.len(),
            rung.describe(),
            rung.error,
            100.0 * rung.time
        )
    }

    /// Takes up the class of the scene. The error stays about as it was.
    fn take_up(&mut self, class: SceneClass) {
        if self.class == Some(class) {
            return;
        }
        let error = self.rung().map_or(0.0, |rung| rung.error);
        self.class = Some(class);
        self.ladder = ladder(QualityCosts::shipped(), class);
        self.rung = within(&self.ladder, error);
        self.governor.begin_at(self.rung);
    }

    /// Chooses the rung of a frame. `hold` is the time to hold, `frame` that of the last frame, `passes` that of its passes, in ms.
    fn choose(&mut self, config: &GameConfig, hold: f64, frame: f64, passes: f64) {
        let fixed = match config.video.quality.as_str() {
            "low" => Some(within(&self.ladder, LOW)),
            "medium" => Some(within(&self.ladder, MEDIUM)),
            "automatic" if self.governed => None,
            _ => Some(0),
        };
        self.hold = fixed.is_none().then_some(hold);
        self.rung = match fixed {
            Some(rung) => rung,
            None => {
                let capped = frame <= CAPPED * hold;
                let work = match (capped, passes > 0.0) {
                    (true, true) => passes,
                    (true, false) => UNKNOWN_WORK * frame,
                    (false, _) => frame,
                };
                self.governor.follow(&self.ladder, hold, frame, work)
            }
        };
    }
}

/// The time to hold, in ms, on displays of these rates (Hz).
fn hold(config: &GameConfig, rates: impl Iterator<Item = f64>) -> f64 {
    let video = &config.video;
    let rate = if video.held_rate > 0 { f64::from(video.held_rate) } else { rates.fold(f64::NAN, f64::max) };
    let rate = if rate > 1.0 { rate } else { USUAL_RATE };
    let rate = if video.frame_limit > 0 { rate.min(f64::from(video.frame_limit)) } else { rate };
    1000.0 / rate
}

/// Chooses how the next frame is drawn.
pub(super) fn choose(
    (current, session): (Res<CurrentStage>, Res<Session>),
    (statistics, real): (Res<RenderStatistics>, Res<Time<Real>>),
    (monitors, windows): (Query<&Monitor>, Query<&OnMonitor, With<PrimaryWindow>>),
    mut quality: ResMut<Quality>,
) {
    let is_new = quality.class != Some(current.0.class());
    quality.take_up(current.0.class());
    // The window's own display, if that is known.
    let own = windows.iter().find_map(|on| monitors.get(on.0).ok());
    let shown = monitors.iter().filter(|monitor| own.is_none_or(|own| std::ptr::eq(own, *monitor)));
    let rates = shown.filter_map(|monitor| monitor.refresh_rate_millihertz).map(|rate| f64::from(rate) / 1000.0);
    let hold = hold(&session.config, rates);
    let passes = statistics.passes.iter().map(|pass| f64::from(pass.1)).sum();
    let before = quality.rung;
    quality.choose(&session.config, hold, 1000.0 * real.delta_secs_f64(), passes);
    if is_new || quality.rung != before {
        debug!("picture: {}", quality.describe());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(quality: &str, governed: bool, frames: u32, frame: f64) -> usize {
        let mut config = GameConfig::default();
        config.video.quality = quality.into();
        let mut chosen = Quality::new(governed);
        chosen.take_up(SceneClass::Chase);
        (0..frames).for_each(|_| chosen.choose(&config, 40.0, frame, 0.9 * frame));
        chosen.rung
    }

    #[test]
    fn levels_are_fixed_and_automatic_holds_the_time() {
        assert_eq!(chosen("high", true, 50, 500.0), 0);
        assert!(chosen("medium", true, 1, 500.0) > 0);
        assert!(chosen("low", true, 1, 500.0) > chosen("medium", true, 1, 500.0));
        assert!(chosen("automatic", true, 20, 100.0) > 0);
        assert_eq!(chosen("automatic", true, 50, 20.0), 0);
        assert_eq!(chosen("automatic", false, 50, 500.0), 0);
    }

    /// Under a display's rate and without timestamps no ladder holds a fast machine down.
    #[test]
    fn with_room_every_ladder_is_climbed_to_its_top() {
        for class in SceneClass::ALL {
            let mut chosen = Quality::new(true);
            let mut config = GameConfig::default();
            config.video.quality = "automatic".into();
            chosen.take_up(class);
            chosen.governor.begin_at(chosen.ladder.len() - 1);
            (0..4000).for_each(|_| chosen.choose(&config, 16.7, 16.7, 0.0));
            assert_eq!(chosen.rung, 0, "{}", class.name());
        }
    }

    #[test]
    fn a_scene_of_another_class_begins_with_about_the_same_error() {
        let mut quality = Quality::new(true);
        quality.take_up(SceneClass::Chase);
        quality.rung = within(&quality.ladder, LOW);
        let error = quality.ladder[quality.rung].error;
        quality.take_up(SceneClass::Disk);
        assert!(quality.rung > 0 && quality.ladder[quality.rung].error <= error);
    }

    #[test]
    fn the_rate_to_hold_is_the_displays_unless_one_is_chosen() {
        let mut config = GameConfig::default();
        assert_eq!(hold(&config, std::iter::empty()), 1000.0 / 60.0);
        assert_eq!(hold(&config, [50.0, 100.0].into_iter()), 10.0);
        config.video.frame_limit = 50;
        assert_eq!(hold(&config, [100.0].into_iter()), 20.0);
        config.video.held_rate = 25;
        assert_eq!(hold(&config, [100.0].into_iter()), 40.0);
    }
}
