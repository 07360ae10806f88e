//! The methods, each with one number that says how finely it works.

use std::sync::LazyLock;

use glam::DVec3;
use lensrunner::spacetime::matter::{ShipRate, ShipState, gamma, rate, step_until, tidal_pull};
use lensrunner::spacetime::tableau;

use super::cases::{FlightCase, MOMENTS};

/// A method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The classical method of order 4, equal steps.
    Rk4,
    /// Free fall of the river and straight motion, one after the other, each exact: order 2, symplectic.
    Split2,
    /// Five of those after Suzuki: order 4.
    Split4,
    /// Dormand and Prince 5(4), steps by its own error.
    Dopri5,
    /// Order 8 with 12 stages, steps by its own error.
    Dop853,
    /// As the game flies: the same weights, steps cut by the ship's shortest time scale.
    Game,
}

impl Method {
    /// All of them.
    pub const ALL: [Method; 6] = [Method::Rk4, Method::Split2, Method::Split4, Method::Dopri5, Method::Dop853, Method::Game];

    /// As charts call it.
    pub fn name(self) -> &'static str {
        ["RK4", "splitting, order 2", "splitting, order 4", "DOPRI5", "DOP853", "the game"][self as usize]
    }

    /// Whether it chooses its steps by a tolerance.
    pub fn is_adaptive(self) -> bool {
        matches!(self, Method::Dopri5 | Method::Dop853)
    }
}

/// How finely a method works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Effort {
    /// Equal steps, so many between two moments.
    Steps(u32),
    /// Error of a step, relative to 1 + |y|.
    Tolerance(f64),
}

/// What came of a flight.
#[derive(Clone, Debug)]
pub struct Flown {
    /// The state at each moment; NaN from where it failed on.
    pub states: Vec<ShipState>,
    /// Evaluations of the right-hand side; of a splitting each pair of flows counts as one.
    pub evaluations: u64,
    /// Steps.
    pub steps: u64,
}

/// Steps that no flight needs: a method that takes more has failed.
const MOST_STEPS: u64 = 20_000_000;

/// Flies a case.
pub fn fly(method: Method, case: &FlightCase, effort: Effort) -> Flown {
    let mut pilot = Pilot {
        thrust: DVec3::X * case.drive.thrust,
        rates: DVec3::Z * case.drive.turning,
        evaluations: 0,
        steps: 0,
        last: case.segment(),
    };
    let mut now = case.start;
    let states = (0..MOMENTS).map(|_| {
        now = pilot.segment(method, now, case.segment(), effort);
        now
    });
    let states = states.collect();
    Flown { states, evaluations: pilot.evaluations, steps: pilot.steps }
}

/// One flight under way.
struct Pilot {
    thrust: DVec3,
    rates: DVec3,
    evaluations: u64,
    steps: u64,
    /// The step that an adaptive method would take next.
    last: f64,
}

impl Pilot {
    fn segment(&mut self, method: Method, start: ShipState, span: f64, effort: Effort) -> ShipState {
        match effort {
            Effort::Steps(steps) => {
                let h = span / f64::from(steps);
                (0..steps).fold(start, |now, _| if now.is_finite() { self.step(method, now, h) } else { now })
            }
            Effort::Tolerance(tolerance) => self.adaptive(method, start, span, tolerance),
        }
    }

    fn step(&mut self, method: Method, now: ShipState, h: f64) -> ShipState {
        self.steps += 1;
        match method {
            Method::Rk4 => self.explicit(&RK4, now, h).0,
            Method::Split2 => self.split(now, h),
            Method::Split4 => SUZUKI.iter().fold(now, |now, share| self.split(now, share * h)),
            Method::Dopri5 => self.explicit(&DOPRI5, now, h).0,
            Method::Dop853 => self.explicit(&DOP853, now, h).0,
            Method::Game => {
                let mut substeps = 0;
                let (end, covered) = step_until(&now, h, self.thrust, self.rates, |_, _| substeps += 1);
                self.evaluations += substeps * tableau::STAGES as u64;
                self.steps += substeps.saturating_sub(1);
                if covered < h { failed(end) } else { end }
            }
        }
    }

    /// One step of an explicit Runge–Kutta method, and its slopes.
    fn explicit(&mut self, scheme: &Scheme, now: ShipState, h: f64) -> (ShipState, Vec<ShipRate>) {
        let mut slopes = vec![rate(&now, self.thrust, self.rates)];
        for weights in &scheme.nodes {
            slopes.push(rate(&now.plus(h, &sum(&slopes, weights)), self.thrust, self.rates));
        }
        self.evaluations += slopes.len() as u64;
        (upright(now.plus(h, &sum(&slopes, &scheme.weights))), slopes)
    }

    fn adaptive(&mut self, method: Method, start: ShipState, span: f64, tolerance: f64) -> ShipState {
        let scheme: &Scheme = if method == Method::Dopri5 { &DOPRI5 } else { &DOP853 };
        let (mut now, mut elapsed) = (start, 0.0);
        while elapsed < span {
            let whole = self.last >= span - elapsed;
            let h = if whole { span - elapsed } else { self.last };
            let (end, slopes) = self.explicit(scheme, now, h);
            let error = scheme.error(&now, h, &slopes) / tolerance;
            self.steps += 1;
            if !now.is_finite() || h < 1e-12 * span || self.steps > MOST_STEPS {
                return failed(now);
            }
            if error <= 1.0 && end.is_finite() {
                now = end;
                elapsed = if whole { span } else { elapsed + h };
            }
            let factor = 0.9 * error.max(1e-10).powf(-1.0 / scheme.order);
            let next = h * if factor.is_finite() { factor.clamp(0.2, 5.0) } else { 0.2 };
            // What the end of a segment cut short says nothing of the next.
            self.last = if whole && error <= 1.0 { next.max(self.last) } else { next };
        }
        now
    }

    /// Half a fall, half a way straight on, the engine, and back.
    fn split(&mut self, now: ShipState, h: f64) -> ShipState {
        self.evaluations += 1;
        let now = straight(river(now, 0.5 * h), 0.5 * h);
        river(straight(self.kick(now, h), 0.5 * h), 0.5 * h)
    }

    /// What the engine does where the ship is: momentum and attitude alone, by four evaluations.
    fn kick(&mut self, now: ShipState, h: f64) -> ShipState {
        if self.thrust == DVec3::ZERO && self.rates == DVec3::ZERO {
            return now;
        }
        self.evaluations += 4;
        let (thrust, rates) = (self.thrust, self.rates);
        let there = |state: &ShipState| {
            let all = rate(state, thrust, rates);
            let momentum = all.momentum - tidal_pull(state.position, state.momentum);
            ShipRate { position: DVec3::ZERO, momentum, proper_time: 0.0, ..all }
        };
        let mut slopes = vec![there(&now)];
        for weights in &RK4.nodes {
            slopes.push(there(&now.plus(h, &sum(&slopes, weights))));
        }
        upright(now.plus(h, &sum(&slopes, &RK4.weights)))
    }
}

/// The way straight on, at one momentum.
fn straight(now: ShipState, h: f64) -> ShipState {
    let per_gamma = 1.0 / gamma(now.momentum);
    ShipState { position: now.position + now.momentum * (h * per_gamma), proper_time: now.proper_time + h * per_gamma, ..now }
}

/// The fall with the river, exactly: r^(3/2) falls by (3/2)h, p_r goes as √r, what is across as 1/r.
fn river(now: ShipState, h: f64) -> ShipState {
    let r = now.position.length();
    let outward = now.position / r;
    let fallen = (r * r.sqrt() - 1.5 * h).powf(2.0 / 3.0);
    let radial = outward * now.momentum.dot(outward);
    let momentum = radial * (fallen / r).sqrt() + (now.momentum - radial) * (r / fallen);
    ShipState { position: outward * fallen, momentum, ..now }
}

fn failed(state: ShipState) -> ShipState {
    ShipState { position: DVec3::NAN, ..state }
}

/// With an attitude of unit length, as the game keeps it.
fn upright(mut state: ShipState) -> ShipState {
    state.attitude *= 1.0 / state.attitude.length_squared().sqrt();
    state
}

/// The shares of Suzuki's five steps.
static SUZUKI: LazyLock<[f64; 5]> = LazyLock::new(|| {
    let s = 1.0 / (4.0 - 4f64.powf(1.0 / 3.0));
    [s, s, 1.0 - 4.0 * s, s, s]
});

type Weights = Vec<(usize, f64)>;

fn sum(slopes: &[ShipRate], weights: &[(usize, f64)]) -> ShipRate {
    weights.iter().fold(ShipRate::ZERO, |sum, &(stage, weight)| sum.plus(weight, &slopes[stage]))
}

/// An explicit Runge–Kutta method.
struct Scheme {
    /// For stages from the second on: (earlier stage, weight).
    nodes: Vec<Weights>,
    weights: Weights,
    /// Differences of the weights from those of embedded methods.
    errors: Vec<Weights>,
    /// The power of the step that the error goes with.
    order: f64,
}

impl Scheme {
    /// The error of a step, relative to 1 + |y|, the greatest of all components.
    fn error(&self, now: &ShipState, h: f64, slopes: &[ShipRate]) -> f64 {
        let worst = |weights: &Weights| {
            let off = sum(slopes, weights);
            let scale = [now.position.length(), now.momentum.length(), 1.0, now.proper_time.abs()].map(|size| 1.0 + size);
            let off = [off.position.length(), off.momentum.length(), off.attitude.length(), off.proper_time.abs()];
            h * off
                .iter()
                .zip(scale)
                .map(|(off, scale)| off / scale)
                .fold(0.0, |worst: f64, e| if e.is_nan() { f64::INFINITY } else { worst.max(e) })
        };
        match &self.errors[..] {
            [one] => worst(one),
            // Of order 5, corrected by one of order 3 (Hairer, Nørsett, Wanner, section II.10).
            [fifth, third] => {
                let (fifth, third) = (worst(fifth), worst(third));
                if fifth == 0.0 { 0.0 } else { fifth * fifth / (fifth * fifth + 0.01 * third * third).sqrt() }
            }
            _ => 0.0,
        }
    }
}

fn weights(all: &[f64]) -> Weights {
    all.iter().copied().enumerate().filter(|(_, weight)| *weight != 0.0).collect()
}

static RK4: LazyLock<Scheme> = LazyLock::new(|| Scheme {
    nodes: [&[0.5][..], &[0.0, 0.5], &[0.0, 0.0, 1.0]].map(weights).to_vec(),
    weights: weights(&[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0]),
    errors: Vec::new(),
    order: 5.0,
});

/// Hairer, Nørsett, Wanner, section II.5, table 5.2. Its last stage is the first of the next step; it is evaluated again here.
static DOPRI5: LazyLock<Scheme> = LazyLock::new(|| {
    let last = [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];
    let nodes = [
        &[0.2][..],
        &[3.0 / 40.0, 9.0 / 40.0],
        &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
        &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
        &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
        &last,
    ];
    let error = [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];
    Scheme { nodes: nodes.map(weights).to_vec(), weights: weights(&last), errors: vec![weights(&error)], order: 5.0 }
});

/// The game's weights, with the two embedded methods of the published code.
static DOP853: LazyLock<Scheme> = LazyLock::new(|| {
    let mut third: Weights = tableau::WEIGHTS.to_vec();
    for (stage, weight) in [(0, 0.244_094_488_188_976_4), (8, 0.733_846_688_281_611_9), (11, 0.022_058_823_529_411_766)] {
        third.push((stage, -weight));
    }
    let fifth = vec![
        (0, 0.013_120_044_994_194_88),
        (5, -1.225_156_446_376_204_4),
        (6, -0.495_758_949_657_250_2),
        (7, 1.664_377_182_454_986_4),
        (8, -0.350_328_848_749_973_7),
        (9, 0.334_179_118_713_017_5),
        (10, 0.081_923_206_485_115_71),
        (11, -0.022_355_307_863_886_294),
    ];
    Scheme {
        nodes: tableau::NODES.iter().map(|weights| weights.to_vec()).collect(),
        weights: tableau::WEIGHTS.to_vec(),
        errors: vec![fifth, third],
        order: 8.0,
    }
});
