//! What the chart is asked for, what it draws, and how a frame is timed.

use clap::Args;
use glam::DVec3;
use lensrunner::argument::whole;
use lensrunner::scene::{GameConfig, picture_size};
use lensrunner::spacetime::orbit::static_momentum;
use lensrunner::spacetime::{Observer, frames};

use crate::chart::Output;

/// The accretion disk as polygons, sprites and arcs: time and error of each alone, and along a scripted chase.
#[derive(Args, Clone, Debug)]
pub struct DiskRequest {
    /// Where it goes.
    #[command(flatten)]
    pub output: Output,
    /// Width and height of the frames that are timed.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = picture_size)]
    pub size: [u32; 2],
    /// Width and height of the pictures that are compared with the exact one.
    #[arg(long, value_name = "WxH", default_value = "480x270", value_parser = picture_size)]
    pub error_size: [u32; 2],
    /// Rounds in which all ways take turns.
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = whole::<usize>(1, 1000))]
    pub rounds: usize,
    /// Places along the chase.
    #[arg(long, value_name = "N", default_value_t = 25, value_parser = whole::<usize>(2, 1000))]
    pub steps: usize,
    /// Frames in which the chase is also flown as in the game: 1,000 and more tell what 99.9 % of them stay under. 0 for none.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = whole::<usize>(0, 100_000))]
    pub flight: usize,
}

/// One way to draw the disk.
#[derive(Clone, Debug)]
pub struct DiskContestant {
    /// What it is called.
    pub name: String,
    /// 0 arcs, 1 polygons, 2 sprites, 3 arcs at another error budget.
    pub family: usize,
    /// The configuration that draws it.
    pub config: GameConfig,
}

/// A drawn frame.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// The whole frame on the clock, in ms.
    pub whole: f64,
    /// The processor time of all threads, in ms, where a software adapter draws.
    pub processor: Option<f64>,
    /// Until it was handed to the adapter, on the clock, in ms.
    pub before: f64,
    /// Passes with their times by the adapter's timestamps, in ms.
    pub passes: Vec<(String, f64)>,
    /// Fragments that the disk's draw shaded, where the adapter counts them.
    pub fragments: Option<u64>,
    /// Linear light, if it was asked for.
    pub picture: Vec<[f32; 3]>,
}

impl Shown {
    /// The time of a pass in ms; 0 if it is not there.
    pub(super) fn pass(&self, label: &str) -> f64 {
        self.passes.iter().filter(|(name, _)| name == label).map(|(_, time)| time).sum()
    }
}

/// What is looked at.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredView {
    /// From where.
    pub eye: Observer,
    /// T, in r_s/c.
    pub time: f64,
    /// Whether stars and the Milky Way stand behind the disk, as the configuration has them; black else.
    pub sky: bool,
    /// Whether fragments are counted, which takes a little time.
    pub counted: bool,
}

/// Passes that are the disk's own.
pub(super) const DISK_PASSES: [&str; 3] = ["disk arcs", "disk mesh", "disk"];

/// What ratios are told against.
pub(super) const REFERENCE: &str = "arcs 4200";

/// T of all frames but the chase's, in r_s/c.
pub(super) const TIME: f64 = 100.0;

/// All ways, in the order of the tables of Yamashita 2025, then arcs at other budgets.
pub fn contestants(config: &GameConfig) -> Vec<DiskContestant> {
    let with = |name: String, family, change: &dyn Fn(&mut GameConfig)| {
        let mut config = config.clone();
        change(&mut config);
        DiskContestant { name, family, config }
    };
    let mut all = vec![
        with("polygons 960".into(), 1, &|c| c.disk.representation = "polygons".into()),
        with("polygons 960 at rest".into(), 1, &|c| c.disk.representation = "polygons-at-rest".into()),
        with("sprites 100 000".into(), 2, &|c| c.disk.representation = "sprites".into()),
    ];
    for arcs in [570u32, 1_100, 2_100, 4_200, 8_500, 17_000] {
        all.push(with(format!("arcs {arcs}"), 0, &|c| {
            c.disk.arcs = arcs;
            c.disk.width = 0.16 * (4200.0 / f64::from(arcs)).sqrt();
        }));
    }
    for budget in [3e-3, 1e-3, 1e-4] {
        all.push(with(format!("arcs 4200; Δ {budget} rad"), 3, &|c| c.disk.error_budget = budget));
    }
    all
}

/// A hovering eye that looks along `look`.
pub(super) fn eye(position: DVec3, look: DVec3) -> Observer {
    Observer {
        position,
        momentum: static_momentum(position).unwrap_or_default(),
        attitude: frames::look(look, DVec3::Z).unwrap_or_default(),
        field_of_view: 60f64.to_radians(),
    }
}

/// What the disk costs: the passes that are its own by timestamps. A software adapter draws on the processor, where other programs run as
/// well and passes overlap: there it is the processor time of the frame less that of a frame without a disk.
pub(super) fn own(shown: &Shown, without: &Shown) -> f64 {
    match (shown.processor, without.processor) {
        (Some(with), Some(without)) => with - without,
        _ => passes(shown),
    }
}

pub(super) fn passes(shown: &Shown) -> f64 {
    DISK_PASSES.iter().map(|label| shown.pass(label)).sum()
}
