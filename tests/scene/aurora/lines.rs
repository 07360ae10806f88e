//! The colours of the aurora's lines under a Doppler shift, against spectra integrated with the tabulated observer.

use std::f64::consts::PI;

use lensrunner::scene::aurora::lines::{self, Line};
use lensrunner::scene::blackbody::xyz_to_rgb;

/// CIE 1931 2° observer, x̄, ȳ, z̄ from 380 nm on in steps of 5 nm (CIE 015).
#[rustfmt::skip]
const OBSERVER: [[f64; 3]; 73] = [
    [0.001368, 0.000039, 0.006450], [0.002236, 0.000064, 0.010550], [0.004243, 0.000120, 0.020050], [0.007650, 0.000217, 0.036210],
    [0.014310, 0.000396, 0.067850], [0.023190, 0.000640, 0.110200], [0.043510, 0.001210, 0.207400], [0.077630, 0.002180, 0.371300],
    [0.134380, 0.004000, 0.645600], [0.214770, 0.007300, 1.039050], [0.283900, 0.011600, 1.385600], [0.328500, 0.016840, 1.622960],
    [0.348280, 0.023000, 1.747060], [0.348060, 0.029800, 1.782600], [0.336200, 0.038000, 1.772110], [0.318700, 0.048000, 1.744100],
    [0.290800, 0.060000, 1.669200], [0.251100, 0.073900, 1.528100], [0.195360, 0.090980, 1.287640], [0.142100, 0.112600, 1.041900],
    [0.095640, 0.139020, 0.812950], [0.057950, 0.169300, 0.616200], [0.032010, 0.208020, 0.465180], [0.014700, 0.258600, 0.353300],
    [0.004900, 0.323000, 0.272000], [0.002400, 0.407300, 0.212300], [0.009300, 0.503000, 0.158200], [0.029100, 0.608200, 0.111700],
    [0.063270, 0.710000, 0.078250], [0.109600, 0.793200, 0.057250], [0.165500, 0.862000, 0.042160], [0.225750, 0.914850, 0.029840],
    [0.290400, 0.954000, 0.020300], [0.359700, 0.980300, 0.013400], [0.433450, 0.994950, 0.008750], [0.512050, 1.000000, 0.005750],
    [0.594500, 0.995000, 0.003900], [0.678400, 0.978600, 0.002750], [0.762100, 0.952000, 0.002100], [0.842500, 0.915400, 0.001800],
    [0.916300, 0.870000, 0.001650], [0.978600, 0.816300, 0.001400], [1.026300, 0.757000, 0.001100], [1.056700, 0.694900, 0.001000],
    [1.062200, 0.631000, 0.000800], [1.045600, 0.566800, 0.000600], [1.002600, 0.503000, 0.000340], [0.938400, 0.441200, 0.000240],
    [0.854450, 0.381000, 0.000190], [0.751400, 0.321000, 0.000100], [0.642400, 0.265000, 0.000050], [0.541900, 0.217000, 0.000030],
    [0.447900, 0.175000, 0.000020], [0.360800, 0.138200, 0.000010], [0.283500, 0.107000, 0.000000], [0.218700, 0.081600, 0.000000],
    [0.164900, 0.061000, 0.000000], [0.121200, 0.044580, 0.000000], [0.087400, 0.032000, 0.000000], [0.063600, 0.023200, 0.000000],
    [0.046770, 0.017000, 0.000000], [0.032900, 0.011920, 0.000000], [0.022700, 0.008210, 0.000000], [0.015840, 0.005723, 0.000000],
    [0.011359, 0.004102, 0.000000], [0.008111, 0.002929, 0.000000], [0.005790, 0.002091, 0.000000], [0.004109, 0.001484, 0.000000],
    [0.002899, 0.001047, 0.000000], [0.002049, 0.000740, 0.000000], [0.001440, 0.000520, 0.000000], [0.001000, 0.000361, 0.000000],
    [0.000690, 0.000249, 0.000000],
];

fn observer(wavelength: f64) -> [f64; 3] {
    let x = (wavelength - 380.0) / 5.0;
    if !(0.0..72.0).contains(&x) {
        return [0.0; 3];
    }
    let (k, t) = (x as usize, x.fract());
    std::array::from_fn(|c| OBSERVER[k][c] + t * (OBSERVER[k + 1][c] - OBSERVER[k][c]))
}

/// XYZ of narrow lines, (nm, kR) at rest, seen with the frequency ratio `g`: the radiance of each wavelength that is seen, L′(λ′) = g⁵
/// L(gλ′) as I/ν³ is invariant, summed over what the eye sees.
fn integrated(spectrum: &[(f64, f64)], g: f64) -> [f64; 3] {
    const WIDTH: f64 = 0.3;
    let radiance = |wavelength: f64| -> f64 {
        let line = |(middle, kilorayleighs): &(f64, f64)| {
            let photons =
                kilorayleighs * 1e13 / (4.0 * PI) * (-0.5 * ((wavelength - middle) / WIDTH).powi(2)).exp() / (WIDTH * (2.0 * PI).sqrt());
            photons * 6.626_070_15e-34 * 299_792_458.0 / (middle * 1e-9)
        };
        spectrum.iter().map(line).sum()
    };
    let step = 0.05;
    let mut xyz = [0.0; 3];
    for k in 0..8000 {
        let seen = 370.0 + step * f64::from(k);
        let light = g.powi(5) * radiance(g * seen) * step;
        xyz = std::array::from_fn(|c| xyz[c] + 683.0 * observer(seen)[c] * light);
    }
    xyz
}

/// For one photon at 427.8 nm there are 3.25 at 391.4 nm, by the parts 0.20 and 0.65 of N₂⁺(B); for one at 630.0 nm 0.316 at 636.4.
const BLUE: [(f64, f64); 2] = [(427.8, 1.0), (391.4, 3.25)];
const RED: [(f64, f64); 2] = [(630.0, 1.0), (636.4, 0.001_85 / 0.005_85)];

#[test]
fn shifted_lines_have_the_colours_of_their_spectra() {
    for (line, spectrum) in [(Line::Blue, &BLUE), (Line::Red, &RED)] {
        let at_rest = integrated(spectrum, 1.0).into_iter().fold(0.0, f64::max);
        for g in [1.0, 0.92, 0.88, 1.08] {
            let (got, want) = (lines::kilorayleigh_xyz(g)[line as usize], integrated(spectrum, g));
            println!("{line:?} at {g}: {got:?}, integrated {want:?}");
            // The fit to the observer is off by up to 0.02 where it is 1, and by more in the far red, where hardly anything is seen.
            for c in 0..3 {
                assert!((got[c] - want[c]).abs() < 0.025 * at_rest + 0.06 * want[c], "{line:?} at {g}: {got:?}, integrated {want:?}");
            }
        }
    }
}

#[test]
fn a_shifted_aurora_has_the_colour_of_its_spectrum() {
    // All that shines at 110 km: green becomes red at 0.88, the violet of N₂⁺ blue.
    let [green, blue, red, crimson] = lines::photons(110.0);
    let mut spectrum = vec![(557.7, green), (650.0, crimson)];
    spectrum.extend(BLUE.map(|(wavelength, part)| (wavelength, part * blue)));
    spectrum.extend(RED.map(|(wavelength, part)| (wavelength, part * red)));
    // The fit to the observer, as above: red on the screen is 3.2 X less 1.5 Y and 0.5 Z, so that what it is off by, 2 to 3 % of X at 634
    // nm (green at 0.88) and at 445 nm (violet), comes to twice that; measured 0.006, 0.001 and 0.044. At 0.92 only blue is left that is
    // neither cut off nor the brightest.
    for (g, allowed) in [(1.0, 0.01), (0.92, 0.01), (0.88, 0.055)] {
        let lines = lines::kilorayleigh_xyz(g);
        let sum: [f64; 3] = std::array::from_fn(|c| lines.iter().zip(lines::photons(110.0)).map(|(line, photons)| photons * line[c]).sum());
        // As on the screen: what lies outside sRGB is cut off, and the brightest channel is 1.
        let [got, want] = [sum, integrated(&spectrum, g)].map(|xyz| {
            let rgb = xyz_to_rgb(xyz).map(|channel| channel.max(0.0));
            rgb.map(|channel| channel / rgb.into_iter().fold(0.0, f64::max))
        });
        println!("{g}: {got:?}, integrated {want:?}");
        assert!((0..3).all(|c| (got[c] - want[c]).abs() < allowed));
    }
}
