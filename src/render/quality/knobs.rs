//! What can be drawn with less, and how far.

use crate::render::settings::Settings;

/// Something that can be drawn with less. Step 0 is as configured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Knob {
    /// Pixels that are drawn.
    Resolution,
    /// Allowed error of points.
    PixelError,
    /// Width from which images of bodies of order 2 and 3 are drawn.
    SecondImages,
    /// Width of the rings of the disk, by their error.
    Rings,
    /// Positions along a pixel at which a camera close to the disk looks gas up.
    Gas,
    /// Streaks of the aurora.
    Streaks,
    /// Stars, down to which light.
    Stars,
    /// Smooth outlines.
    Outlines,
    /// Light spread by the lens.
    Bloom,
}

/// The step of each knob, in the order of [`Knob::ALL`].
pub type Steps = [u8; Knob::ALL.len()];

/// Share of the width and height that is drawn.
const RESOLUTIONS: [f32; 8] = [1.0, 0.85, 0.7, 0.6, 0.5, 0.4, 0.33, 0.25];
/// Standard deviation of the narrowest spots of stars, in drawn pixels: as they move their light, sampled at pixel centres, changes by up to
/// 4 % (twice its transform at the sampling frequency, e^{−2π²·0.45²}).
const LEAST_SIGMA: f32 = 0.45;
/// Factors on the allowed error of a point.
const PIXEL_ERRORS: [f32; 4] = [1.0, 2.0, 4.0, 8.0];
/// Width in drawn pixels from which images of bodies of order 2 and 3 are drawn, but no less than configured.
const LEAST_WIDTHS: [f64; 4] = [0.0, 0.5, 2.0, f64::INFINITY];
/// Factors on the errors of rings and arcs.
const RING_ERRORS: [f32; 4] = [1.0, 2.0, 4.0, 8.0];
/// Most positions along a pixel, but no more than configured.
const LOOKS: [f32; 4] = [f32::INFINITY, 8.0, 4.0, 1.0];
/// Shares of the streaks.
const STREAKS: [f32; 4] = [1.0, 0.5, 0.25, 0.125];
/// Faintest magnitudes, but none fainter than configured.
const MAGNITUDES: [f32; 4] = [f32::INFINITY, 8.5, 7.5, 6.5];

impl Knob {
    /// All of them.
    pub const ALL: [Knob; 9] = [
        Knob::Resolution,
        Knob::PixelError,
        Knob::SecondImages,
        Knob::Rings,
        Knob::Gas,
        Knob::Streaks,
        Knob::Stars,
        Knob::Outlines,
        Knob::Bloom,
    ];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Knob::Resolution => "resolution",
            Knob::PixelError => "pixel error",
            Knob::SecondImages => "second images",
            Knob::Rings => "rings",
            Knob::Gas => "gas",
            Knob::Streaks => "streaks",
            Knob::Stars => "stars",
            Knob::Outlines => "outlines",
            Knob::Bloom => "bloom",
        }
    }

    /// The number of its steps, with step 0.
    pub fn steps(self) -> u8 {
        match self {
            Knob::Resolution => RESOLUTIONS.len() as u8,
            Knob::PixelError => PIXEL_ERRORS.len() as u8,
            Knob::SecondImages => LEAST_WIDTHS.len() as u8,
            Knob::Rings => RING_ERRORS.len() as u8,
            Knob::Gas => LOOKS.len() as u8,
            Knob::Streaks => STREAKS.len() as u8,
            Knob::Stars => MAGNITUDES.len() as u8,
            Knob::Outlines | Knob::Bloom => 2,
        }
    }

    /// What a step is, in words.
    pub fn says(self, step: u8) -> String {
        if step == 0 {
            return "as configured".into();
        }
        let k = usize::from(step.min(self.steps() - 1));
        match self {
            Knob::Resolution => format!("{:.0} % of the width", 100.0 * RESOLUTIONS[k]),
            Knob::PixelError => format!("{} times the error", PIXEL_ERRORS[k]),
            Knob::SecondImages if LEAST_WIDTHS[k].is_finite() => format!("from {} px on", LEAST_WIDTHS[k]),
            Knob::SecondImages => "of the disk alone".into(),
            Knob::Rings => format!("{} times the error", RING_ERRORS[k]),
            Knob::Gas => format!("{} looks in a pixel", LOOKS[k]),
            Knob::Streaks => format!("{} % of them", 100.0 * STREAKS[k]),
            Knob::Stars => format!("to magnitude {}", MAGNITUDES[k]),
            Knob::Outlines => "not smoothed".into(),
            Knob::Bloom => "none".into(),
        }
    }

    /// Whether what it saves is done pixel by pixel.
    pub fn is_by_pixel(self) -> bool {
        matches!(self, Knob::Gas | Knob::Outlines | Knob::Bloom)
    }

    /// The share of the pixels that are drawn.
    pub fn area(steps: Steps) -> f64 {
        let place = Knob::ALL.iter().position(|knob| *knob == Knob::Resolution).unwrap_or(0);
        f64::from(RESOLUTIONS[usize::from(steps[place]).min(RESOLUTIONS.len() - 1)]).powi(2)
    }

    /// Sets it. A step beyond the last is the last.
    pub fn set(self, step: u8, settings: &mut Settings) {
        let k = usize::from(step.min(self.steps() - 1));
        match self {
            Knob::Resolution => {
                settings.resolution *= RESOLUTIONS[k];
                // Spots of stars stay as wide in the output, as far as they can be sampled.
                settings.star_sigma = (settings.star_sigma * RESOLUTIONS[k]).max(LEAST_SIGMA.min(settings.star_sigma));
            }
            Knob::PixelError => settings.pixel_error *= PIXEL_ERRORS[k],
            Knob::SecondImages => settings.least_width = settings.least_width.max(LEAST_WIDTHS[k]),
            Knob::Rings => settings.ring_error *= RING_ERRORS[k],
            Knob::Gas => settings.gas_looks = settings.gas_looks.min(LOOKS[k]),
            Knob::Streaks => settings.streaks *= STREAKS[k],
            Knob::Stars => settings.faintest_star = settings.faintest_star.max(10f32.powf(-0.4 * MAGNITUDES[k])),
            Knob::Outlines => settings.smooth &= k == 0,
            Knob::Bloom if k > 0 => settings.bloom = 0.0,
            Knob::Bloom => {}
        }
    }
}

/// The settings with every knob at its step.
pub fn turned(settings: &Settings, steps: &Steps) -> Settings {
    let mut settings = *settings;
    for (knob, step) in Knob::ALL.into_iter().zip(steps) {
        knob.set(*step, &mut settings);
    }
    settings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn step_0_is_as_configured_and_every_other_is_not() {
        let settings = Settings::finest();
        assert_eq!(turned(&settings, &[0; Knob::ALL.len()]), settings);
        for (k, knob) in Knob::ALL.into_iter().enumerate() {
            for step in 1..knob.steps() {
                let mut steps = [0; Knob::ALL.len()];
                steps[k] = step;
                assert_ne!(turned(&settings, &steps), settings, "{} {step}", knob.name());
            }
        }
    }

    /// A knob never draws more than is configured.
    #[test]
    fn what_is_configured_coarser_stays_so() {
        let coarse = Settings { smooth: false, orders: 1, faintest_star: 1.0, ..Settings::finest() };
        let turned = turned(&coarse, &[0, 0, 3, 3, 3, 3, 3, 1, 1]);
        assert_eq!((turned.smooth, turned.orders, turned.faintest_star), (false, 1, 1.0));
    }
}
