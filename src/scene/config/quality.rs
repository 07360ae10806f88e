//! How much is drawn: the presets of `video.quality`.

use super::GameConfig;

impl GameConfig {
    /// The configuration as it is drawn: with less of what costs most, where `video.quality` is low or medium.
    pub fn drawn(&self) -> GameConfig {
        let mut config = self.clone();
        let (coarser, fewer) = match config.video.quality.as_str() {
            "low" => (4.0, 4),
            "medium" => (2.0, 2),
            _ => return config,
        };
        let render = &mut config.render;
        render.pixel_error_budget = (render.pixel_error_budget * coarser).min(16.0);
        render.thin_below = (render.thin_below * coarser).min(100.0);
        render.antialiasing &= fewer < 4;
        config.disk.arcs = (config.disk.arcs / fewer).max(16);
        // As wide as they are fewer, so that the disk stays full.
        config.disk.width = (config.disk.width * f64::from(fewer).sqrt()).min(2.0);
        config.aurora.streaks = (config.aurora.streaks / fewer).max(64);
        config.sky.faintest_magnitude = config.sky.faintest_magnitude.min(if fewer == 4 { 7.0 } else { 9.0 });
        config
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::config::settings;

    #[test]
    fn every_preset_is_allowed() {
        let mut config = GameConfig::default();
        assert_eq!(config.drawn(), config, "high is as configured");
        for quality in ["low", "medium"] {
            config.video.quality = quality.into();
            let drawn = config.drawn();
            assert!(drawn.disk.arcs < config.disk.arcs);
            for setting in settings() {
                assert!(setting.check(setting.get(&drawn)).is_ok(), "{quality}: {}", setting.path());
            }
        }
    }
}
