//! Closed approximations: Beloborodov's and Poutanen's relations between the angle at a point of a ray and the angle left
//! to infinity.
//!
//! Both relations read 1 − cos α = X(u, y), y = 1 − cos χ: α is the angle of the ray from the outward radial direction in the static frame
//! at u = 1/r, χ the angle it still sweeps on its way to infinity. The impact parameter b² = X (2 − X)/(u² (1 − u)) is the same at both
//! ends of the ray from a point to a camera, which leaves one equation in χ at the outer end. First order only, both ends outside.
//!
//! Beloborodov 2002, ApJ 566, L85, eq. 1; Poutanen 2020, A&A 640, A24 (arXiv 1909.05732); delay: Poutanen and Beloborodov 2006,
//! MNRAS 373, 836, the excess over the radial ray, r y (1 + u y/8 (1 + y (1/3 − u/14))).

use std::f64::consts::{E, PI};

use lensrunner::lensing::methods::{ProjectionInput, Projector, Sight};
use lensrunner::spacetime::light::{Branch, Order};

use super::{Frame, Method, each};

/// A relation between α and χ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Approximation {
    /// X = (1 − u) y.
    Beloborodov,
    /// X = (1 − u) y {1 + u² y²/112 − (e/100) u y [ln(1 − y/2) + y/2]}.
    Poutanen,
}

impl Approximation {
    fn tilt(self, u: f64, y: f64) -> f64 {
        let x = (1.0 - u) * y;
        match self {
            Approximation::Beloborodov => x,
            Approximation::Poutanen => {
                // The logarithm diverges where the ray comes from straight behind, beyond the relation's range (160°).
                let rest = (1.0 - 0.5 * y).max(1e-6).ln() + 0.5 * y;
                (x * (1.0 + u * u * y * y / 112.0 - E / 100.0 * u * y * rest)).min(2.0)
            }
        }
    }

    /// b².
    fn impact(self, r: f64, angle: f64) -> f64 {
        let half = (0.5 * angle).sin();
        let x = self.tilt(1.0 / r, 2.0 * half * half);
        x * (2.0 - x) * r * r * r / (r - 1.0)
    }

    fn solve(self, input: ProjectionInput) -> Option<Sight> {
        let ProjectionInput { r, phi, camera: l } = input;
        if r <= 1.0 || l <= 1.0 {
            return None;
        }
        let (outer, inner) = (r.max(l), r.min(l));
        let excess = |angle: f64| self.impact(outer, angle) - self.impact(inner, angle + phi);
        // False position (Illinois): b falls short at the outer end while χ is small, and overshoots where the ray goes on inward.
        let (mut low, mut high) = (1e-12, PI - 0.5 * phi);
        let (mut at_low, mut at_high) = (excess(low), excess(high));
        if at_low >= 0.0 || at_high <= 0.0 {
            return None;
        }
        let mut angle = low;
        for _ in 0..80 {
            let next = (low * at_high - high * at_low) / (at_high - at_low);
            let done = (next - angle).abs() <= 1e-12 * next;
            angle = next;
            let value = excess(angle);
            if done || value == 0.0 {
                break;
            }
            if value < 0.0 {
                (low, at_low) = (angle, value);
                at_high *= 0.5;
            } else {
                (high, at_high) = (angle, value);
                at_low *= 0.5;
            }
        }
        let local = |radius: f64, angle: f64| 2.0 * (0.5 * self.tilt(1.0 / radius, 1.0 - angle.cos())).sqrt().min(1.0).asin();
        // Infinity lies beyond the outer end: a camera there looks the other way.
        let psi = if l >= r { PI - local(outer, angle) } else { local(outer.min(l), angle + phi) };
        let lag = |radius: f64, angle: f64| {
            let (u, y) = (1.0 / radius, 1.0 - angle.cos());
            radius * y * (1.0 + u * y / 8.0 * (1.0 + y * (1.0 / 3.0 - u / 14.0)))
        };
        let tortoise = |radius: f64| radius + (radius - 1.0).ln();
        let time = tortoise(outer) - tortoise(inner) + lag(inner, angle + phi) - lag(outer, angle);
        // From Schwarzschild's time to Painlevé and Gullstrand's.
        let rain = |radius: f64| 2.0 * radius.sqrt() + ((radius.sqrt() - 1.0) / (radius.sqrt() + 1.0)).ln();
        Some(Sight::from_static(psi, time + rain(l) - rain(r), l))
    }
}

impl Projector for Approximation {
    fn project(&self, input: ProjectionInput, order: Order, _branch: Branch) -> Option<Sight> {
        if order.number() == 1 { self.solve(input) } else { None }
    }
}

impl Method for Approximation {
    fn frame(&self, _l: f64) -> Box<dyn Frame + '_> {
        each(|point, _| self.solve(point.input))
    }
}
