//! Black-body light: Planck's spectrum as linear sRGB.
//!
//! A black body at T is seen as one at g·T, so its colour and brightness over T is all that redshift needs. Luminance is given in
//! units of a black body at [`UNIT_TEMPERATURE`], and is true from there to any T.

use std::sync::OnceLock;

/// The temperature, in K, at which the luminance of [`blackbody_rgb`] is 1: that of the Sun (IAU 2015 Resolution B3).
pub const UNIT_TEMPERATURE: f64 = 5772.0;
/// The least a channel has of the colour's luminance in [`table`], where logarithms are kept: less does not show beside the others.
const LEAST_CHANNEL: f64 = 1e-4;

/// The temperature, in K, below which blue falls on as between it and 3,000 K: ln(blue/red) is [`TAIL`]'s first number less the second, in
/// K, over T. By itself sRGB has 7 % of red here and none at all from 1,900 K down. The difference cannot be seen (1.4 % of red at 1,900
/// K), but a streak's light is told from that of gas of mean temperature and its slope: from none at all no hotter streak got its blue, and
/// they were yellow.
const DIM_BLUE: f64 = 2500.0;
/// See `DIM_BLUE`.
const TAIL: [f64; 2] = [2.255, 12_370.0];

/// Second radiation constant hc/k in nm·K (CODATA 2018, exact).
const C2: f64 = 1.438_776_877e7;
/// First radiation constant for radiance 2hc², in W·m²/sr (CODATA 2018, exact).
const C1L: f64 = 1.191_042_972e-16;
/// Luminous efficacy at the peak of ȳ, in lm/W (that of 540 THz, 683, carried to 555 nm).
const PEAK_EFFICACY: f64 = 683.002;

/// A Gaussian with different widths, in nm, on its two sides.
fn lobe(wavelength: f64, peak: f64, left: f64, right: f64) -> f64 {
    let t = (wavelength - peak) / if wavelength < peak { left } else { right };
    (-0.5 * t * t).exp()
}

/// The CIE 1931 colour matching functions x̄, ȳ, z̄ at a wavelength in nm. Wyman, Sloan and Shirley, *Simple Analytic Approximations to
/// the CIE XYZ Color Matching Functions*, JCGT 2(2) 2013, the multi-lobe fits of listing 1.
pub fn matching(wavelength: f64) -> [f64; 3] {
    let l = |peak, left, right| lobe(wavelength, peak, left, right);
    [
        1.056 * l(599.8, 37.9, 31.0) + 0.362 * l(442.0, 16.0, 26.7) - 0.065 * l(501.1, 20.4, 26.2),
        0.821 * l(568.8, 46.9, 40.5) + 0.286 * l(530.9, 16.3, 31.1),
        1.217 * l(437.0, 11.8, 36.0) + 0.681 * l(459.0, 26.0, 13.8),
    ]
}

/// CIE XYZ of a black body at `temperature` (K), Y in cd/m².
pub fn blackbody_xyz(temperature: f64) -> [f64; 3] {
    let mut xyz = [0.0; 3];
    // 360 to 830 nm in steps of 2: the integrand is smooth and ends near zero, where the sum converges fast.
    for step in 0..=235 {
        let wavelength = 360.0 + 2.0 * f64::from(step);
        let metres = wavelength * 1e-9;
        let radiance = C1L / (metres.powi(5) * (C2 / (wavelength * temperature)).exp_m1());
        for (total, weight) in xyz.iter_mut().zip(matching(wavelength)) {
            *total += PEAK_EFFICACY * weight * radiance * 2e-9;
        }
    }
    xyz
}

/// The luminance of a black body at [`UNIT_TEMPERATURE`], in cd/m²: the unit of [`blackbody_rgb`].
fn unit_luminance() -> f64 {
    static UNIT: OnceLock<f64> = OnceLock::new();
    *UNIT.get_or_init(|| blackbody_xyz(UNIT_TEMPERATURE)[1])
}

/// Linear sRGB of a black body at `temperature` (K), in units in which its luminance at [`UNIT_TEMPERATURE`] is 1. Colours outside sRGB
/// (below about 1,900 K) are brought in by adding grey at the same luminance, and blue goes on to fall as by Wien's law (see `DIM_BLUE`).
/// Zero for a temperature that is not positive.
pub fn blackbody_rgb(temperature: f64) -> [f64; 3] {
    if !(temperature > 0.0 && temperature.is_finite()) {
        return [0.0; 3];
    }
    let [x, y, z] = blackbody_xyz(temperature);
    if y <= 0.0 {
        return [0.0; 3];
    }
    let [r, g, b] = into_gamut(xyz_to_rgb([x / y, 1.0, z / y]));
    let dim = if temperature < DIM_BLUE { r * (TAIL[0] - TAIL[1] / temperature).exp() } else { 0.0 };
    [r, g, b.max(dim)].map(|channel| channel * y / unit_luminance())
}

/// Linear sRGB (IEC 61966-2-1, white D65) of CIE XYZ; negative where the colour is outside sRGB.
pub fn xyz_to_rgb([x, y, z]: [f64; 3]) -> [f64; 3] {
    [
        3.240_454_2 * x - 1.537_138_5 * y - 0.498_531_4 * z,
        -0.969_266_0 * x + 1.876_010_8 * y + 0.041_556_0 * z,
        0.055_643_4 * x - 0.204_025_9 * y + 1.057_225_2 * z,
    ]
}

/// Mixes a colour of luminance 1 with white of luminance 1 until no channel is negative.
fn into_gamut(rgb: [f64; 3]) -> [f64; 3] {
    let least = rgb.into_iter().fold(0.0, f64::min);
    rgb.map(|channel| (channel - least) / (1.0 - least))
}

/// The table for the GPU: `entries` (at least 2) evenly spaced in ln T from `coldest` to `hottest` (K), the natural logarithms of the
/// channels of [`blackbody_rgb`] and a zero. Logarithms, because radiance spans many powers of ten; with 512 entries from 200 K to
/// 2·10⁶ K linear interpolation is within 0.5 % from 300 K up.
pub fn table(entries: usize, coldest: f32, hottest: f32) -> Vec<[f32; 4]> {
    let span = (f64::from(hottest) / f64::from(coldest)).ln();
    (0..entries)
        .map(|index| {
            let temperature = f64::from(coldest) * (span * index as f64 / (entries.max(2) - 1) as f64).exp();
            let rgb = blackbody_rgb(temperature);
            let least = LEAST_CHANNEL * luminance(rgb);
            let [r, g, b] = rgb.map(|channel| channel.max(least).max(f64::MIN_POSITIVE).ln() as f32);
            [r, g, b, 0.0]
        })
        .collect()
}

/// What the shader makes of [`table`] at `temperature` (K); its ends hold beyond them.
pub fn lookup(table: &[[f32; 4]], coldest: f32, hottest: f32, temperature: f32) -> [f32; 3] {
    let last = table.len() - 1;
    let place = (temperature.clamp(coldest, hottest) / coldest).ln() / (hottest / coldest).ln() * last as f32;
    let index = (place as usize).min(last - 1);
    let part = place - index as f32;
    [0, 1, 2].map(|channel| (table[index][channel] + part * (table[index + 1][channel] - table[index][channel])).exp())
}

/// The luminance Y of a linear sRGB colour.
pub fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.212_672_9 * r + 0.715_152_2 * g + 0.072_175_0 * b
}
