//! Ways to divide triangles.

use lensrunner::render::settings::Settings;
use lensrunner::render::stage::settings;
use lensrunner::scene::GameConfig;

/// A way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// The game's, with a bound in pixels.
    Ours(f64),
    /// The criterion of Yamashita 2025, the error of the midpoint alone, in the game's stages, with a bound in pixels.
    Midpoint(f64),
    /// Edges as they are; triangles on the axis are cut as in the game.
    Whole,
    /// The tables of Yamashita 2012 without any division; triangles that the hole makes nine times as large are dropped.
    Dropped,
}

/// Names of the ways, in the order of their colours.
pub const NAMES: [&str; 4] = ["ours", "midpoints (Yamashita 2025)", "no subdivision", "dropped triangles (Yamashita 2012)"];

impl Way {
    /// All of them with these bounds; the game's at its own bound must be among them.
    pub fn all(bounds: &[f64]) -> Vec<Way> {
        let with = |way: fn(f64) -> Way| bounds.iter().copied().map(way);
        with(Way::Ours).chain(with(Way::Midpoint)).chain([Way::Whole, Way::Dropped]).collect()
    }

    /// Its place in [`NAMES`].
    pub fn family(self) -> usize {
        match self {
            Way::Ours(_) => 0,
            Way::Midpoint(_) => 1,
            Way::Whole => 2,
            Way::Dropped => 3,
        }
    }

    /// The bound in pixels; NaN for the ways without.
    pub fn bound(self) -> f64 {
        match self {
            Way::Ours(bound) | Way::Midpoint(bound) => bound,
            Way::Whole | Way::Dropped => f64::NAN,
        }
    }

    /// Whether edges are divided by their midpoints.
    pub fn is_midpoint(self) -> bool {
        matches!(self, Way::Midpoint(_))
    }

    /// The configuration that draws it.
    pub fn config(self, base: &GameConfig) -> GameConfig {
        let mut config = base.clone();
        match self {
            Way::Ours(bound) | Way::Midpoint(bound) => config.render.pixel_error_budget = bound,
            Way::Whole => config.render.tessellation_max_level = 0,
            Way::Dropped => config.render.method = "paper1-128".into(),
        }
        config
    }

    /// The settings that draw it.
    pub fn settings(self, base: &GameConfig) -> Settings {
        Settings { midpoint: self.is_midpoint(), ..settings(&self.config(base)) }
    }
}
