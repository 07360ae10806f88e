//! What can be drawn with less, and how far.

use crate::render::settings::Settings;

/// Something that can be drawn with less.
#[derive(Clone, Copy, Debug)]
pub struct QualityOption {
    /// Its name in tables.
    pub name: &'static str,
    /// Whether what it saves is done pixel by pixel.
    pub is_by_pixel: bool,
    /// The value of each step; step 0 is as configured.
    values: &'static [f32],
    /// What a value is, in words.
    words: fn(f32) -> String,
    /// Puts a value into the settings.
    set: fn(&mut Settings, f32),
}

/// The step of each option, in the order of [`QualityOption::ALL`].
pub type OptionSteps = [u8; QualityOption::ALL.len()];

impl QualityOption {
    /// All of them.
    pub const ALL: [QualityOption; 9] = [
        // Share of the width and height that is drawn.
        QualityOption {
            name: "resolution",
            is_by_pixel: false,
            values: &[1.0, 0.85, 0.7, 0.6, 0.5, 0.4, 0.33, 0.25],
            words: |share| format!("{:.0} % of the width", 100.0 * share),
            set: |settings, share| settings.resolution *= share,
        },
        // Factor on the allowed error of a point.
        QualityOption {
            name: "pixel error",
            is_by_pixel: false,
            values: &[1.0, 2.0, 4.0, 8.0],
            words: |factor| format!("{factor} times the error"),
            set: |settings, factor| settings.pixel_error *= factor,
        },
        // Width in drawn pixels from which images of bodies of order 2 and 3 are drawn, but no less than configured.
        QualityOption {
            name: "second images",
            is_by_pixel: false,
            values: &[0.0, 0.5, 2.0, f32::INFINITY],
            words: |width| if width.is_finite() { format!("from {width} px on") } else { "of the disk alone".into() },
            set: |settings, width| settings.least_width = settings.least_width.max(f64::from(width)),
        },
        // Factor on the errors of the rings and arcs of the disk.
        QualityOption {
            name: "rings",
            is_by_pixel: false,
            values: &[1.0, 2.0, 4.0, 8.0],
            words: |factor| format!("{factor} times the error"),
            set: |settings, factor| settings.ring_error *= factor,
        },
        // Most positions along a pixel at which a camera close to the disk looks gas up, but no more than configured.
        QualityOption {
            name: "gas",
            is_by_pixel: true,
            values: &[f32::INFINITY, 8.0, 4.0, 1.0],
            words: |looks| format!("{looks} looks in a pixel"),
            set: |settings, looks| settings.gas_looks = settings.gas_looks.min(looks),
        },
        // Share of the streaks of the aurora.
        QualityOption {
            name: "streaks",
            is_by_pixel: false,
            values: &[1.0, 0.5, 0.25, 0.125],
            words: |share| format!("{} % of them", 100.0 * share),
            set: |settings, share| settings.streaks *= share,
        },
        // Faintest magnitude of stars, but none fainter than configured.
        QualityOption {
            name: "stars",
            is_by_pixel: false,
            values: &[f32::INFINITY, 8.5, 7.5, 6.5],
            words: |magnitude| format!("to magnitude {magnitude}"),
            set: |settings, magnitude| settings.faintest_star = settings.faintest_star.max(10f32.powf(-0.4 * magnitude)),
        },
        // Whether outlines are smoothed.
        QualityOption {
            name: "outlines",
            is_by_pixel: true,
            values: &[1.0, 0.0],
            words: |_| "not smoothed".into(),
            set: |settings, smooth| settings.smooth &= smooth > 0.0,
        },
        // Share of the light that the lens spreads.
        QualityOption {
            name: "bloom",
            is_by_pixel: true,
            values: &[1.0, 0.0],
            words: |_| "none".into(),
            set: |settings, share| settings.bloom *= share,
        },
    ];

    /// The number of its steps, with step 0.
    pub fn steps(&self) -> u8 {
        self.values.len() as u8
    }

    /// The value of a step. One beyond the last is the last.
    fn value(&self, step: u8) -> f32 {
        self.values[usize::from(step.min(self.steps() - 1))]
    }

    /// What a step is, in words.
    pub fn describe(&self, step: u8) -> String {
        if step == 0 { "as configured".into() } else { (self.words)(self.value(step)) }
    }
}

/// The share of the pixels that are drawn.
pub fn area(steps: &OptionSteps) -> f64 {
    f64::from(turned(&Settings::finest(), steps).resolution).powi(2)
}

/// The settings with every option at its step.
pub fn turned(settings: &Settings, steps: &OptionSteps) -> Settings {
    let mut settings = *settings;
    for (option, step) in QualityOption::ALL.into_iter().zip(steps) {
        (option.set)(&mut settings, option.value(*step));
    }
    settings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn step_0_is_as_configured_and_every_other_is_not() {
        let settings = Settings::finest();
        assert_eq!(turned(&settings, &[0; QualityOption::ALL.len()]), settings);
        for (k, option) in QualityOption::ALL.into_iter().enumerate() {
            for step in 1..option.steps() {
                let mut steps = [0; QualityOption::ALL.len()];
                steps[k] = step;
                assert_ne!(turned(&settings, &steps), settings, "{} {step}", option.name);
            }
        }
    }

    /// An option never draws more than is configured.
    #[test]
    fn what_is_configured_coarser_stays_so() {
        let coarse = Settings { smooth: false, orders: 1, faintest_star: 1.0, ..Settings::finest() };
        let turned = turned(&coarse, &[0, 0, 3, 3, 3, 3, 3, 1, 1]);
        assert_eq!((turned.smooth, turned.orders, turned.faintest_star), (false, 1, 1.0));
    }
}
