//! The reference: the same motion in polar coordinates, by the extrapolated midpoint rule of Gragg, Bulirsch and Stoer (Hairer, Nørsett,
//! Wanner, *Solving Ordinary Differential Equations I*, section II.9). It shares no line with the methods that it judges.
//!
//! In the plane, with p_r the radial momentum and L = r p_φ, H = γ − βp_r, γ = √(1 + p_r² + L²/r²) and β = r^−½ (r_s = c = 1):
//!
//! * dr/dT = p_r/γ − β, dφ/dT = L/(γr²), dτ/dT = 1/γ
//! * dp_r/dT = L²/(γr³) − ½r^(−3/2) p_r + F_r, dL/dT = rF_φ, F = [α + p(p·α)/(1+γ)]/γ
//! * dθ/dT = [ω + (p × (g − α))/(1+γ)]/γ: the body's angle, against fixed axes

/// r (r_s), φ (rad), p_r (c), L (r_s c), θ (rad), τ (r_s/c).
pub type Polar = [f64; 6];

/// What drives it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Drive {
    /// Proper acceleration along the body's +x axis, c²/r_s.
    pub thrust: f64,
    /// Body rate about the plane's normal, rad per proper r_s/c.
    pub turning: f64,
}

/// d/dT.
fn rate([r, phi, radial, momentum, angle, _]: Polar, drive: Drive) -> Polar {
    let across = momentum / r;
    let gamma = (1.0 + radial * radial + across * across).sqrt();
    let river = r.powf(-0.5);
    let stretch = river / r;
    // The thrust, along r and φ.
    let (sin, cos) = (angle - phi).sin_cos();
    let (along, sideways) = (drive.thrust * cos, drive.thrust * sin);
    let work = (radial * along + across * sideways) / (1.0 + gamma);
    let [push, turn] = [(along + radial * work) / gamma, (sideways + across * work) / gamma];
    // g = (β/r)(p − (3/2) p_r n): −½ and 1 times p along r and φ.
    let cross = radial * (stretch * across - sideways) - across * (-0.5 * stretch * radial - along);
    [
        radial / gamma - river,
        across / (gamma * r),
        across * across / (gamma * r) - 0.5 * stretch * radial + push,
        r * turn,
        (drive.turning + cross / (1.0 + gamma)) / gamma,
        1.0 / gamma,
    ]
}

/// Columns of the extrapolation; its order is twice that.
const COLUMNS: usize = 8;
/// Error of a step, relative to 1 + |y|: a hundred roundings.
const TOLERANCE: f64 = 2e-14;

/// The state a span of T later.
pub fn later(state: Polar, span: f64, drive: Drive) -> Polar {
    let (mut now, mut elapsed, mut h) = (state, 0.0, (0.02 * span).min(0.5));
    while elapsed < span {
        h = h.min(span - elapsed);
        let (next, error) = extrapolated(now, h, drive);
        // Below this a step is shorter than rounding lets it be better.
        if error <= 1.0 || h < 1e-9 * span {
            elapsed = if h >= span - elapsed { span } else { elapsed + h };
            now = next;
        }
        let factor = 0.8 * error.max(1e-30).powf(-1.0 / (2 * COLUMNS - 1) as f64);
        h *= if factor.is_finite() { factor.clamp(0.2, 3.0) } else { 0.2 };
    }
    now
}

/// One step and its error in units of what is allowed.
fn extrapolated(start: Polar, h: f64, drive: Drive) -> (Polar, f64) {
    let mut table: Vec<Vec<Polar>> = Vec::new();
    for row in 0..COLUMNS {
        let mut line = vec![midpoint(start, h, 2 * (row + 1), drive)];
        for column in 1..=row {
            let quotient = ((row + 1) as f64 / (row + 1 - column) as f64).powi(2);
            let (better, worse): (Polar, Polar) = (line[column - 1], table[row - 1][column - 1]);
            line.push(std::array::from_fn(|i| better[i] + (better[i] - worse[i]) / (quotient - 1.0)));
        }
        table.push(line);
    }
    let (best, before) = (table[COLUMNS - 1][COLUMNS - 1], table[COLUMNS - 1][COLUMNS - 2]);
    let error = |i: usize| (best[i] - before[i]).abs() / (TOLERANCE * (1.0 + best[i].abs()));
    let error = (0..best.len()).map(error).fold(0.0, |worst: f64, e| if e.is_nan() { f64::INFINITY } else { worst.max(e) });
    (best, error)
}

/// The modified midpoint rule with `steps` steps, an even number.
fn midpoint(start: Polar, span: f64, steps: usize, drive: Drive) -> Polar {
    let h = span / steps as f64;
    let plus = |a: Polar, h: f64, b: Polar| -> Polar { std::array::from_fn(|i| a[i] + h * b[i]) };
    let (mut before, mut now) = (start, plus(start, h, rate(start, drive)));
    for _ in 1..steps {
        (before, now) = (now, plus(before, 2.0 * h, rate(now, drive)));
    }
    let last = rate(now, drive);
    std::array::from_fn(|i| 0.5 * (before[i] + now[i] + h * last[i]))
}

/// E = γ − βp_r, per mass.
pub fn energy([r, _, radial, momentum, ..]: Polar) -> f64 {
    (1.0 + radial * radial + (momentum / r).powi(2)).sqrt() - radial / r.sqrt()
}
