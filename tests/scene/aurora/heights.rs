//! The heights between which the aurora's light is drawn, for the softest and the hardest electrons that game.toml allows.

use lensrunner::scene::aurora::air::overhead;
use lensrunner::scene::aurora::fall::{Spectrum, range, sane_energy, share_left, slope};
use lensrunner::scene::aurora::lines;
use lensrunner::scene::aurora::quantiles::{HEIGHTS, KINDS, PARTS, Quantiles, ROWS, flux};
use lensrunner::scene::config::{Allowed, settings};

/// Kinds of light by line: green, blue and crimson are drawn together.
const KIND: [usize; 4] = [0, 0, 1, 0];

/// Least and greatest value that game.toml allows.
fn allowed(key: &str) -> [f64; 2] {
    let setting = settings().iter().find(|setting| setting.section == "aurora" && setting.key == key).unwrap();
    match setting.allowed {
        Allowed::Number { min, max } => [min, max],
        other => panic!("{key}: {other:?}"),
    }
}

/// Photons of each line above 900 km, 899, … 45 km for each 35 eV that comes down: each energy of the spectrum and each slope by itself.
fn light(spectrum: &Spectrum) -> Vec<[f64; 4]> {
    let levels: Vec<(f64, [f64; 4])> = (0..=855).map(|k| 900.0 - f64::from(k)).map(|z| (overhead(z), lines::photons(z + 0.5))).collect();
    let mut sums = vec![[0.0; 4]; levels.len()];
    let mut brought = 0.0;
    for k in 0..80 {
        let x = 0.2 * (f64::from(k) + 0.5);
        let energy = spectrum.accelerated + spectrum.thermal * x;
        let weight = energy * energy * (-x).exp();
        for j in 0..40 {
            let reach = slope((f64::from(j) + 0.5) / 40.0) * range(sane_energy(energy));
            brought += weight;
            let mut sum = [0.0; 4];
            let mut before = 1.0;
            for ((overhead, photons), sums) in levels.iter().zip(&mut sums) {
                let left = share_left(*overhead, reach);
                for line in 0..4 {
                    sum[line] += weight * (before - left) * photons[line];
                    sums[line] += sum[line];
                }
                before = left;
            }
        }
    }
    sums.iter().map(|sum| sum.map(|light| light / brought)).collect()
}

#[test]
fn hardly_any_light_is_left_to_the_ends_of_the_heights() {
    let [[softest, hardest], [coldest, hottest]] = ["energy", "thermal"].map(allowed);
    assert!(softest <= 0.5 && hardest >= 50.0);
    for accelerated in [softest, 4.0, hardest] {
        for thermal in [coldest, 1.5, hottest] {
            let spectrum = Spectrum { accelerated, thermal };
            let falls = Quantiles::new(&spectrum);
            for row in [0, ROWS / 2, ROWS - 1] {
                let sums = light(&Spectrum { accelerated: accelerated * flux(row).sqrt(), ..spectrum });
                let whole = sums[sums.len() - 1];
                for line in 0..4 {
                    let [top, foot] = falls.ends[KIND[line]].map(f64::from);
                    let above = |height: f64| {
                        let x = 900.0 - height;
                        let k = (x as usize).min(sums.len() - 2);
                        sums[k][line] + (x - k as f64) * (sums[k + 1][line] - sums[k][line])
                    };
                    let outside = [above(top) / whole[line], 1.0 - above(foot) / whole[line]];
                    let name = format!("{accelerated} keV + {thermal} keV, row {row}, line {line}, {foot} to {top} km");
                    // A five hundredth of a line and 1/125 of red are meant to be, and a tenth of that for the steps of both integrals.
                    // Where the hardest electrons end within kilometres, half a step of the tables more; above, what the softest make
                    // higher than any light is drawn, 0.33 % of green and 0.89 % of red where the curtain is faintest.
                    let allowed = 1.1 * [0.002, 0.008][KIND[line]];
                    let below = 1.0 - above(foot - 0.25) / whole[line];
                    let beyond = above(HEIGHTS[0]) / whole[line];
                    assert!(outside[0] <= allowed + beyond && below <= allowed, "{name}: {outside:.5?} of the light above and below");
                    // And none of it is lost: what is tabulated is all that is made. 3 %: steps of 1 km here, of half a kilometre there.
                    let drawn = f64::from(falls.photons[row * (PARTS + 1) + PARTS][line]);
                    assert!((drawn / whole[line] - 1.0).abs() < 0.03, "{name}: {drawn} photons of {}", whole[line]);
                    // Nor is it at one height: of equal parts of a kind's light, no more than one in eight is thinner than 10 m.
                    let first = (row * KINDS + KIND[line]) * (PARTS + 1);
                    let thin = falls.heights[first..=first + PARTS].windows(2).filter(|pair| pair[0] - pair[1] < 0.01).count();
                    assert!(8 * thin <= PARTS, "{name}: {thin} parts of no height");
                }
            }
        }
    }
}
