//! Direct integration: shooting at the point with Runge and Kutta's fourth-order rule, a fixed number of steps over the angle swept.
//!
//! u″ = −u + 3/2 u² with its variation η″ = (−1 + 3u) η by the slope at the camera gives Newton's method its derivative, and the travel
//! time is a third equation. It starts from the table's closed form, which is generous.

use lensrunner::lensing::double::{self, LensCamera, bent_sweep, slope_guess};
use lensrunner::lensing::methods::{ProjectionInput, Projector, Sight, sight};
use lensrunner::spacetime::light::{Branch, Order};

use super::{Frame, Method, each};

/// Shooting with `steps` steps a shot.
#[derive(Clone, Copy, Debug)]
pub struct Integrate {
    /// Steps over the whole angle swept.
    pub steps: usize,
}

/// Shots after which it gives up.
const MOST_SHOTS: usize = 60;
/// Beyond this u (1/r_s) a shot counts as fallen in: no point lies so deep.
const FALLEN: f64 = 100.0;

/// u, w = u′, η, η′, T.
type State = [f64; 5];

fn rates([u, w, eta, eta_rate, _]: State) -> State {
    let e = (w * w + u * u * (1.0 - u)).max(0.0).sqrt();
    let beta = u.max(0.0).sqrt();
    // dT/dΦ of the photon, which runs against Φ: ingoing, then outgoing light.
    let time = if w <= 0.0 { (w * w + u * u) / (u * u * (e - beta * w)) } else { (e + beta * w) / (u * u * (1.0 - u)) };
    [w, u * (1.5 * u - 1.0), eta_rate, (3.0 * u - 1.0) * eta, time]
}

impl Integrate {
    /// Where the ray of slope `w` is after `swept`; None where it fell in or left.
    fn shoot(&self, u: f64, w: f64, swept: f64) -> Result<State, Missed> {
        let h = swept / self.steps as f64;
        let mut state = [u, w, 0.0, 1.0, 0.0];
        let ahead = |s: State, k: State, h: f64| [0, 1, 2, 3, 4].map(|i| s[i] + h * k[i]);
        for _ in 0..self.steps {
            let k1 = rates(state);
            let k2 = rates(ahead(state, k1, 0.5 * h));
            let k3 = rates(ahead(state, k2, 0.5 * h));
            let k4 = rates(ahead(state, k3, h));
            state = [0, 1, 2, 3, 4].map(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
            if state[0].is_nan() || state[0] > FALLEN.max(2.0 * u) {
                return Err(Missed::Fell);
            }
            // Past the sky the equation leads back to false points.
            if state[0] < -0.5 || state[0] < 0.0 && state[1] > 0.0 {
                return Err(Missed::Left);
            }
        }
        Ok(state)
    }

    fn solve(&self, cam: &LensCamera, input: ProjectionInput, order: Order) -> Option<Sight> {
        let (a, c, swept) = (cam.a, 1.0 / input.r, order.swept(input.phi));
        let (mut w, _) = slope_guess(cam, -(input.r - input.camera) / (input.r * input.camera), bent_sweep(swept));
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for _ in 0..MOST_SHOTS {
            let step = match self.shoot(a, w, swept) {
                Ok(state) => {
                    let miss = c - state[0];
                    *if miss > 0.0 { &mut low } else { &mut high } = w;
                    let step = miss / state[2];
                    if step.abs() <= 1e-10 * (w.abs() + 1e-3 * a) {
                        let e = (w * w + a * a * (1.0 - a)).max(0.0).sqrt();
                        return Some(sight(w, e, state[4], a));
                    }
                    step
                }
                Err(Missed::Fell) => {
                    high = w;
                    f64::NAN
                }
                Err(Missed::Left) => {
                    low = w;
                    f64::NAN
                }
            };
            let next = w + step;
            w = if next > low && next < high { next } else { between(low, high, a) };
        }
        None
    }
}

/// Why a shot went astray.
enum Missed {
    Fell,
    Left,
}

/// A slope between two: halfway in the angle that the camera sees.
fn between(low: f64, high: f64, a: f64) -> f64 {
    let angle = |w: f64| a.atan2(-w);
    -a / (0.5 * (angle(low) + angle(high))).tan()
}

impl Projector for Integrate {
    fn project(&self, input: ProjectionInput, order: Order, branch: Branch) -> Option<Sight> {
        let both_inside = input.r <= 1.0;
        if both_inside || branch == Branch::Minus && input.camera < 1.0 && input.r < 1.0 {
            return None;
        }
        self.solve(&double::camera(input.camera), input, order).filter(|sight| sight.psi_rain.is_finite() && sight.delay.is_finite())
    }
}

impl Method for Integrate {
    fn frame(&self, l: f64) -> Box<dyn Frame + '_> {
        let cam = double::camera(l);
        each(move |point, order| self.solve(&cam, point.input, order))
    }
}
