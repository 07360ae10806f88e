//! `lensrunner-lab chart trace`: the image of a Page–Thorne disk by the judge and, where it is installed, by Gyoto (Vincent, Paumard,
//! Gourgoulhon and Perrin, *Class. Quantum Grav.* 28 (2011) 225011): redshift and bolometric flux pixel by pixel, error against rays per
//! second and core.

mod draw;
mod gyoto;
pub mod ray;

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use glam::DVec3;

use crate::chart::{ChartError, Output, Sheet};
use crate::thin_disk::ray::{Impact, Ring, Screen, image};
use lensrunner::argument::whole;
use lensrunner::judge::picture::{PlaneCrossing, World};
use lensrunner::scene::disk::radial::page_thorne_flux;
use lensrunner::spacetime::frames;
use lensrunner::spacetime::matter::{ShipState, gamma};
use lensrunner::spacetime::metric::river_speed;

/// A thin disk after Page and Thorne: error against rays per second, by the judge and by Gyoto where that is installed.
#[derive(Args, Clone, Debug)]
pub struct ThinDiskRequest {
    /// Where it goes.
    #[command(flatten)]
    pub output: Output,
    /// Pixels along each side of the picture.
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = whole::<usize>(8, 1024))]
    pub pixels: usize,
}

/// The scene: Gyoto's own example of a Page–Thorne disk without spin, seen from 100 M at 1.22 rad, 0.314 rad wide, cut off at 50 M.
pub const RING: Ring = Ring { inner: 3.0, outer: 25.0 };

/// The camera of it.
pub fn screen(pixels: usize) -> Screen {
    Screen { radius: 50.0, inclination: 1.22, field_of_view: 0.314_159_265_358_979_3, pixels }
}

/// The general judge's picture of the disk: geodesics in Painlevé–Gullstrand coordinates, every crossing of the plane.
pub fn judge(screen: &Screen, ring: &Ring, tolerance: f64) -> Vec<Impact> {
    let world = World::new(&[], Vec::new(), 0.0, true);
    let position = screen.position();
    let state = hovering(position);
    let mut impacts = Vec::with_capacity(screen.pixels * screen.pixels);
    for row in 0..screen.pixels {
        for column in 0..screen.pixels {
            // From the hovering camera's frame to the rain's: the photon moves against the look.
            let photon = frames::ship_to_rain(state.momentum, state.attitude) * (-screen.look(column, row)).extend(1.0);
            let (look, blue) = (-photon.truncate() / photon.w, 1.0 / photon.w);
            let mut impact = Impact { radius: f64::NAN, g: f64::NAN };
            world.look_through(position, look, tolerance, &mut |crossing| {
                let r = crossing.position.length();
                if impact.radius.is_nan() && (ring.inner..=ring.outer).contains(&r) {
                    impact = Impact { radius: r, g: shift(&crossing, blue) };
                }
            });
            impacts.push(impact);
        }
    }
    impacts
}

fn hovering(position: DVec3) -> ShipState {
    let r = position.length();
    let beta = river_speed(r);
    ShipState::new(position, position * (beta / (r * (1.0 - beta * beta).sqrt())))
}

/// g from the two four-velocities alone.
fn shift(crossing: &PlaneCrossing, blue: f64) -> f64 {
    let x = crossing.position;
    let r = x.length();
    let outward = x / r;
    // A circular orbit: dφ/dT = Ω, dr/dT = 0, so p/γ = v + βn with v = Ω r.
    let velocity = DVec3::Z.cross(outward) * (0.5 / r).sqrt() + outward * river_speed(r);
    let momentum = velocity / (1.0 - velocity.length_squared()).sqrt();
    let k = crossing.momentum;
    blue / (gamma(momentum) * k.length() - momentum.dot(k))
}

/// Bolometric flux that is seen, in the unit of [`page_thorne_flux`]: the emitted one times g⁴.
pub fn flux(impact: &Impact) -> f64 {
    page_thorne_flux(2.0 * impact.radius) * impact.g.powi(4)
}

/// How two pictures differ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    /// Greatest relative difference in g over pixels that both see.
    pub shift: f64,
    /// The median.
    pub shift_median: f64,
    /// Greatest difference in flux over such pixels, relative to the brightest.
    pub flux: f64,
    /// The median.
    pub flux_median: f64,
    /// Pixels that only one sees.
    pub coverage: usize,
}

/// Compares pixel by pixel.
pub fn difference(truth: &[Impact], other: &[Impact]) -> Difference {
    difference_in(truth, other, &other.iter().map(flux).collect::<Vec<f64>>())
}

/// Fluxes that have a unit of their own, the accretion rate being free: brought to ours by one factor, that of the sums over the picture.
fn in_our_unit(truth: &[Impact], fluxes: &[f64]) -> Vec<f64> {
    let (mut ours, mut theirs) = (0.0, 0.0);
    for (ours_here, theirs_here) in truth.iter().map(flux).zip(fluxes).filter(|(a, b)| a.is_finite() && b.is_finite()) {
        ours += ours_here;
        theirs += theirs_here;
    }
    fluxes.iter().map(|f| f * ours / theirs).collect()
}

/// The same where the other has a map of `fluxes` by itself.
fn difference_in(truth: &[Impact], other: &[Impact], fluxes_seen: &[f64]) -> Difference {
    let peak = truth.iter().map(flux).filter(|f| f.is_finite()).fold(0.0, f64::max);
    let (mut shifts, mut fluxes, mut coverage) = (Vec::new(), Vec::new(), 0);
    for ((a, b), seen) in truth.iter().zip(other).zip(fluxes_seen) {
        match (a.g.is_finite(), b.g.is_finite()) {
            (true, true) => {
                shifts.push((b.g / a.g - 1.0).abs());
                fluxes.push((seen - flux(a)).abs() / peak);
            }
            (false, false) => {}
            _ => coverage += 1,
        }
    }
    let [(shift, shift_median), (flux, flux_median)] = [shifts, fluxes].map(most_and_median);
    Difference { shift, shift_median, flux, flux_median, coverage }
}

fn most_and_median(mut values: Vec<f64>) -> (f64, f64) {
    values.sort_by(f64::total_cmp);
    (values.last().copied().unwrap_or(f64::NAN), values.get(values.len() / 2).copied().unwrap_or(f64::NAN))
}

const NAME: &str = "trace";
const COLUMNS: [&str; 9] =
    ["method", "tolerance", "rays", "rays_per_second", "shift_max", "shift_median", "flux_max", "flux_median", "coverage"];

/// Measures, or takes the CSV that is there, and draws.
pub fn run(request: &ThinDiskRequest) -> Result<Vec<PathBuf>, ChartError> {
    let sheet = request.output.sheet::<ChartError>(NAME, || Ok(measure(request.pixels)))?;
    let [svg, png] = draw::figure(&sheet).save(&request.output.folder, NAME)?;
    Ok(vec![request.output.csv(NAME), svg, png])
}

fn measure(pixels: usize) -> Sheet {
    let mut sheet = Sheet::measured(&COLUMNS, "");
    let screen = screen(pixels);
    // Beyond what f64 resolves: the steps are then as short as rounding allows.
    let truth = judge(&screen, &RING, 1e-16);
    let mut push = |method: &str, tolerance: f64, rays: usize, rate: f64, d: &Difference| {
        let Difference { shift, shift_median, flux, flux_median, coverage } = d;
        sheet.line(format_args!(
            "{method}|{tolerance:e}|{rays}|{rate:.1}|{shift:.3e}|{shift_median:.3e}|{flux:.3e}|{flux_median:.3e}|{coverage}"
        ));
    };
    for exponent in [4, 6, 8, 10, 12, 14] {
        let tolerance = 10f64.powi(-exponent);
        let (picture, rate) = timed(pixels * pixels, 0.3, || image(&screen, &RING, tolerance));
        push("shape of the ray", tolerance, pixels * pixels, rate, &difference(&truth, &picture));
    }
    for exponent in [6, 9, 12] {
        let tolerance = 10f64.powi(-exponent);
        let (picture, rate) = timed(pixels * pixels, 0.3, || judge(&screen, &RING, tolerance));
        push("judge", tolerance, pixels * pixels, rate, &difference(&truth, &picture));
    }
    let mut note = gyoto::MISSING.to_owned();
    for tolerance in [1e-4, 1e-6, 1e-8] {
        match gyoto::picture(&screen, &RING, tolerance) {
            Ok(picture) => {
                let found = difference_in(&truth, &picture.impacts, &in_our_unit(&truth, &picture.fluxes));
                push("Gyoto", tolerance, pixels * pixels, picture.rate, &found);
                note = picture.version;
            }
            Err(reason) => {
                eprintln!("Gyoto: {reason}");
                note = if reason == note { reason } else { format!("{note} ({reason})") };
                break;
            }
        }
    }
    sheet.notes.push(("Gyoto".into(), note));
    sheet
}

/// A picture and its rays a second, on one thread: repeated until `seconds` have gone by, the fastest taken.
fn timed(rays: usize, seconds: f64, mut draw: impl FnMut() -> Vec<Impact>) -> (Vec<Impact>, f64) {
    let began = Instant::now();
    let mut best = f64::INFINITY;
    loop {
        let started = Instant::now();
        let picture = draw();
        best = best.min(started.elapsed().as_secs_f64());
        if began.elapsed().as_secs_f64() > seconds {
            return (picture, rays as f64 / best);
        }
    }
}
