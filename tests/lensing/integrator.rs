//! The judge of the tables: u″ = −u + 3/2 u² by Taylor series, the boundary value by shooting, the delay by quadrature. It shares
//! no code with the library.

use crate::spacetime::oracles::JOINED;

const ORDER: usize = 24;
type Series = [f64; ORDER + 1];

/// What the judge finds: du/dΦ at the camera and at the point, e, and the delay in Painlevé–Gullstrand time.
pub struct Truth {
    pub slope: f64,
    pub emission_slope: f64,
    pub energy: f64,
    pub delay: f64,
}

/// Coefficients of u and of ∂u/∂w around one place.
fn series(u: [f64; 2], y: [f64; 2]) -> (Series, Series) {
    let (mut a, mut b) = ([0.0; ORDER + 1], [0.0; ORDER + 1]);
    a[..2].copy_from_slice(&u);
    b[..2].copy_from_slice(&y);
    for n in 0..ORDER - 1 {
        let (mut uu, mut uy) = (0.0, 0.0);
        for i in 0..=n {
            uu += a[i] * a[n - i];
            uy += a[i] * b[n - i];
        }
        let divisor = ((n + 2) * (n + 1)) as f64;
        a[n + 2] = (-a[n] + 1.5 * uu) / divisor;
        b[n + 2] = (-b[n] + 3.0 * uy) / divisor;
    }
    (a, b)
}

fn horner(s: &Series, h: f64) -> [f64; 2] {
    let (mut value, mut slope) = (0.0, 0.0);
    for c in s.iter().rev() {
        slope = slope * h + value;
        value = value * h + c;
    }
    [value, slope]
}

/// The step on which the last terms stay under rounding.
fn step(s: &Series) -> f64 {
    let size = s[0].abs().max(1e-6);
    let root = |n: usize| (1e-17 * size / s[n].abs().max(1e-300)).powf(1.0 / n as f64);
    root(ORDER).min(root(ORDER - 1))
}

enum End {
    At { u: f64, w: f64, du: f64 },
    High,
    Low,
}

fn shoot(a: f64, w: f64, sweep: f64) -> End {
    let (mut u, mut y, mut p) = ([a, w], [0.0, 1.0], 0.0);
    loop {
        let (su, sy) = series(u, y);
        let h = step(&su).min(step(&sy)).min(1.0).min(sweep - p);
        u = horner(&su, h);
        y = horner(&sy, h);
        p += h;
        if u[0] > 1e3 || (u[0] > a.max(1.01) && u[1] > 0.0) {
            return End::High;
        }
        if u[0] < 0.0 {
            return End::Low;
        }
        if sweep - p < 1e-14 {
            return End::At { u: u[0], w: u[1], du: y[0] };
        }
    }
}

/// dT/dΦ: the photon's rain-frame energy over u².
fn time_rate([u, w]: [f64; 2], e: f64) -> f64 {
    let b = u.sqrt();
    let momentum = if w > 0.0 { (w + b * e) / (1.0 - u) } else { (u * u - e * e) / (b * e - w) };
    (e + b * momentum) / (u * u)
}

fn delay(a: f64, w: f64, e: f64, sweep: f64, c: f64) -> f64 {
    // Gauss–Legendre of five points.
    const NODES: [(f64, f64); 5] = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683, 0.478_628_670_499_366_5),
        (-0.538_469_310_105_683, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
        (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    let (mut u, mut p, mut t) = ([a, w], 0.0, 0.0);
    while sweep - p > 1e-14 {
        let (su, _) = series(u, [0.0, 1.0]);
        let mut h = step(&su).min(0.1).min(0.1 * u[0] / u[1].abs().max(1e-300));
        if u[1] > 0.0 && u[0] < 1.0 {
            h = h.min(0.15 * (1.0 - u[0]) / u[1]);
        }
        let h = h.max(1e-9).min(sweep - p);
        t += NODES.iter().map(|(x, weight)| 0.5 * h * weight * time_rate(horner(&su, 0.5 * h * (1.0 + x)), e)).sum::<f64>();
        u = horner(&su, h);
        p += h;
    }
    // Far away the last digits of u count for much: the rest of the way along the same ray.
    if c < 0.05 && u[1] < 0.0 { t + (c - u[0]) / u[1] * time_rate(u, e) } else { t }
}

/// The ray from u = c to the camera at u = a over `sweep`, all at or outside the horizon but for the camera.
pub fn connect(c: f64, sweep: f64, a: f64) -> Truth {
    let scale = a + 0.3;
    let slope = |s: f64| scale * s / (1.0 - s * s);
    let place = |w: f64| 2.0 * (w / scale) / (1.0 + (1.0 + 4.0 * (w / scale).powi(2)).sqrt());
    let (mut low, mut high) = (-1.0f64, 1.0f64);
    let mut w = 0.0;
    let mut emission = 0.0;
    for _ in 0..300 {
        match shoot(a, w, sweep) {
            End::High => high = place(w),
            End::Low => low = place(w),
            End::At { u, w: w_e, du } => {
                emission = w_e;
                if u > c {
                    high = place(w)
                } else {
                    low = place(w)
                }
                let next = w - (u - c) / du;
                if (next - w).abs() < 1e-14 * (w.abs() + 0.01 * a) {
                    break;
                }
                if place(next) > low && place(next) < high {
                    w = next;
                    continue;
                }
            }
        }
        if high - low < 1e-15 {
            break;
        }
        w = slope(0.5 * (low + high));
    }
    let energy = (w * w + a * a - a * a * a).max(0.0).sqrt();
    Truth { slope: w, emission_slope: emission, energy, delay: delay(a, w, energy, sweep, c) }
}

/// ψ in the rain frame from the outward radial.
pub fn rain_angle(t: &Truth, a: f64) -> f64 {
    let b = a.sqrt();
    let radial =
        if t.slope > 0.0 { (t.slope + b * t.energy) / (1.0 - a) } else { (a * a - t.energy * t.energy) / (b * t.energy - t.slope) };
    a.atan2(-radial)
}

/// The judge against the values of the oracles in the reference: b, and t by Schwarzschild's clock.
#[test]
fn the_judge_agrees_with_independent_values() {
    for (r, degrees, l, _, b, t) in JOINED {
        let truth = connect(1.0 / r, f64::to_radians(degrees), 1.0 / l);
        let to_rain = |r: f64| 2.0 * r.sqrt() + ((r.sqrt() - 1.0) / (r.sqrt() + 1.0)).ln();
        assert!((1.0 / truth.energy - b).abs() < 1e-9 * b, "b at {r}, {degrees}, {l}");
        let delay = t + to_rain(l) - to_rain(r);
        assert!((truth.delay - delay).abs() < 1e-7 * delay, "delay at {r}, {degrees}, {l}: {} {delay}", truth.delay);
    }
}
