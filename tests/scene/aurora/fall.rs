//! The fall of electrons and its light against published heights, energy balance and closed forms.

use lensrunner::scene::aurora::air::{air, overhead};
use lensrunner::scene::aurora::fall::{self, Spectrum};
use lensrunner::scene::aurora::lines::{self, Line};
use lensrunner::scene::aurora::random::uniform;
use lensrunner::scene::blackbody::xyz_to_rgb;

use crate::scene::aurora::fang::ionisation;

/// Heights of the test's profiles, km.
fn heights() -> impl DoubleEndedIterator<Item = f64> {
    (0..1840).map(|k| 80.0 + 0.25 * f64::from(k))
}

/// Collisions per electron in bins of 0.25 km: `electrons` of one energy, isotropic from above.
fn walked(energy: f64, electrons: u32) -> Vec<f64> {
    let mut bins = vec![0.0; heights().count()];
    let overheads: Vec<f64> = heights().map(overhead).collect();
    for electron in 0..electrons {
        let mu = fall::slope((f64::from(electron) + 0.5) / f64::from(electrons));
        let reach = mu * fall::range(energy);
        let mut before = energy;
        for k in (0..bins.len()).rev() {
            let after = energy * fall::share_left(overheads[k], reach);
            bins[k] += f64::from(fall::collisions(before, after, f64::from(uniform(1, electron, k as u32))));
            before = after;
        }
    }
    bins.iter().map(|count| count / f64::from(electrons)).collect()
}

/// The height of the peak of a profile, smoothed over ±1.5 km against the noise of counting.
fn peak(profile: &[f64]) -> f64 {
    let smooth = |k: usize| profile[k.saturating_sub(6)..(k + 7).min(profile.len())].iter().sum::<f64>();
    let best = (0..profile.len()).max_by(|&a, &b| smooth(a).total_cmp(&smooth(b))).unwrap();
    heights().nth(best).unwrap()
}

#[test]
fn the_parameterisation_gives_the_published_peaks() {
    // Fang and others (2010), figure 2, read with this air: peak heights in km.
    for (energy, want) in [(0.1, 270.0), (1.0, 157.0), (2.0, 131.0), (5.0, 112.0), (10.0, 105.0), (20.0, 99.0), (100.0, 83.0)] {
        let profile: Vec<f64> = heights().map(|z| ionisation(z, energy, 1.0)).collect();
        let best = heights().zip(&profile).max_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
        assert!((best - want).abs() < 1.5, "{energy} keV: {best} km, published {want} km");
    }
}

#[test]
fn peaks_of_the_walk_are_within_3_km_of_fang() {
    for energy in [1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0] {
        let fang: Vec<f64> = heights().map(|z| ionisation(z, energy, 1.0)).collect();
        let (ours, want) = (peak(&walked(energy, 1500)), peak(&fang));
        assert!((ours - want).abs() <= 3.0, "{energy} keV: the walk peaks at {ours} km, Fang at {want} km");
    }
}

#[test]
fn collisions_pay_for_the_energy() {
    for energy in [0.5, 1.0, 3.0, 10.0, 50.0] {
        let collisions: f64 = walked(energy, 2000).iter().sum();
        let spent = collisions * 0.035;
        // 6 %: the parameterisation itself has 94 to 99 % of the energy, the rest is scattered back.
        let fang: f64 = heights().map(|z| ionisation(z, energy, energy) * 0.25e5 * 0.035).sum();
        assert!((spent / energy - 1.0).abs() < 0.06, "{energy} keV: {spent} keV spent");
        assert!((spent / fang - 1.0).abs() < 0.06, "{energy} keV: {spent} keV spent, Fang {fang} keV");
    }
}

#[test]
fn photons_are_production_times_branching_times_quenching() {
    // Worked by hand from the densities at 110 km: N₂ 1.504e12, O₂ 2.723e11, O 2.440e11 cm⁻³, T = 215 K.
    let photons = lines::photons(110.0);
    let share = 0.92 * 1.504e12 / (0.92 * 1.504e12 + 2.723e11 + 0.56 * 2.440e11);
    assert!((photons[1] / (0.11 * 0.20 * share) - 1.0).abs() < 1e-3);
    let quenching = 2.0e-11 * f64::exp(107.8 / 215.0) * 1.504e12 + 2.9e-11 * f64::exp(67.5 / 215.0) * 2.723e11 + 3.0e-12 * 2.440e11;
    assert!((photons[2] / (0.5 * 0.00585 / (0.0077 + quenching)) - 1.0).abs() < 1e-3);
    // The whole column of a walk: 427.8 nm of one erg cm⁻² s⁻¹ at 1, 5 and 20 keV, computed elsewhere as 202, 286 and 301 R.
    for (energy, want) in [(1.0, 202.0), (5.0, 286.0), (20.0, 301.0)] {
        let electrons = 6.2415e8 / energy;
        let column: f64 = heights().zip(walked(energy, 1000)).map(|(z, pairs)| pairs * electrons * lines::photons(z)[1]).sum();
        assert!((column / 1e6 / want - 1.0).abs() < 0.12, "{energy} keV: {} R of 427.8 nm, published {want}", column / 1e6);
    }
}

#[test]
fn red_over_blue_falls_with_energy() {
    let ratio = |energy: f64| {
        let profile = walked(energy, 300);
        let of = |line: usize| heights().zip(&profile).map(|(z, pairs)| pairs * lines::photons(z)[line]).sum::<f64>();
        of(2) / of(1)
    };
    let ratios = [0.3, 1.0, 3.0, 10.0].map(ratio);
    assert!(ratios.is_sorted_by(|a, b| a > b), "{ratios:?}");
    assert!(ratios[0] / ratios[3] > 20.0, "{ratios:?}");
}

#[test]
fn red_waits_green_less_blue_not_at_all() {
    for (z, want) in [(100.0, 2.3e-3), (120.0, 0.11), (150.0, 1.5), (200.0, 11.9), (250.0, 45.0), (300.0, 90.0)] {
        let [green, blue, red, crimson] = lines::delays(z);
        assert!((red / want - 1.0).abs() < 0.05, "O(¹D) at {z} km lives {red} s, published {want} s");
        assert!(green > 0.2 && green <= 0.906 && blue == 0.0 && crimson == 0.0);
    }
    assert!((lines::delays(300.0)[0] - 0.905).abs() < 0.01);
}

#[test]
fn lines_have_their_colours() {
    let xyz = lines::kilorayleigh_xyz(1.0);
    // Luminance per kR: 557.7 nm 1.93e-4, 427.8 nm 2.45e-6 and 391.4 nm 4.1e-8, 630.0 nm 4.54e-5 and 636.4 nm 3.48e-5 cd m⁻², from the CIE
    // table; the fit is within a few per cent where the eye sees, and less so at its violet end.
    let [blue, red] = [2.45e-6 + 0.65 / 0.20 * 4.1e-8, 4.54e-5 + 0.001_85 / 0.005_85 * 3.48e-5];
    for (line, want, relative) in [(Line::Green, 1.93e-4, 0.03), (Line::Blue, blue, 0.35), (Line::Red, red, 0.05)] {
        let got = xyz[line as usize][1];
        assert!((got / want - 1.0).abs() < relative, "{line:?}: {got} cd/m² per kR");
    }
    let rgb = xyz.map(xyz_to_rgb);
    assert!(rgb[0][1] > 4.0 * rgb[0][0].abs(), "green {:?}", rgb[0]);
    assert!(rgb[1][2] > 4.0 * rgb[1][0].abs(), "blue {:?}", rgb[1]);
    assert!(rgb[2][0] > 8.0 * rgb[2][1].abs(), "red {:?}", rgb[2]);
    // Red light from a source that comes towards the camera is seen greener.
    let shifted = xyz_to_rgb(lines::kilorayleigh_xyz(1.12)[2]);
    assert!(shifted[1] > shifted[0]);
}

#[test]
fn the_air_overhead_is_the_integral_of_the_air() {
    for z in [82.0, 113.0, 260.0, 430.0] {
        let sum: f64 = (0..200_000).map(|k| air(z + 0.005 * (f64::from(k) + 0.5)).mass * 500.0).sum();
        assert!((overhead(z) / sum - 1.0).abs() < 1e-3, "{z} km: {} against {sum}", overhead(z));
    }
}

#[test]
fn any_energy_and_any_step_is_sane() {
    for energy in [f64::NAN, -1.0, 0.0, 1e-30, 1e30, f64::INFINITY] {
        let energy = fall::sane_energy(energy);
        for mu in [f64::NAN, -1.0, 0.0, 1.0, 5.0] {
            let mu = fall::slope(mu);
            let reach = mu * fall::range(energy);
            for z in [f64::NEG_INFINITY, -500.0, 0.0, 100.0, 1e9, f64::NAN] {
                let left = fall::share_left(overhead(z), reach);
                assert!((0.0..=1.0).contains(&left), "{energy} keV, µ = {mu}, {z} km: {left}");
            }
            // One step from the top to far below the ground spends everything, and no more.
            let spent = fall::collisions(energy, energy * fall::share_left(overhead(-1e6), reach), 0.999);
            assert!(f64::from(spent) * 0.035 <= energy + 0.035);
        }
    }
}

#[test]
fn spectra_have_their_mean_energy() {
    // ⟨E⟩ of φ ∝ E e^{−(E−a)/t}, E ≥ a: (a³ + …)/…: by quadrature.
    let spectrum = Spectrum { accelerated: 3.0, thermal: 1.0 };
    let (mut flux, mut energy) = (0.0, 0.0);
    for k in 0..100_000 {
        let e = 3.0 + 3e-4 * f64::from(k);
        let phi = e * (-(e - 3.0)).exp();
        flux += phi;
        energy += phi * e;
    }
    let drawn = |k: u32| spectrum.energy(f64::from(1.0 - uniform(5, k, 0)), f64::from(1.0 - uniform(5, k, 1)), f64::from(uniform(5, k, 2)));
    let mean = (0..40_000).map(drawn).sum::<f64>() / 40_000.0;
    assert!((mean / (energy / flux) - 1.0).abs() < 0.01, "{mean} keV, by quadrature {}", energy / flux);
}
