//! The curves on which electrons come down: a cubic Bézier curve with a sine laid over it, in the plane across the field (Sekiguchi et al.,
//! 2.2).

use glam::DVec2;

/// A curve in the plane across the field, km.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// Control points of the cubic Bézier curve.
    pub control: [DVec2; 4],
    /// Height of the sine, km.
    pub amplitude: f64,
    /// Number of its waves along the curve.
    pub waves: f64,
    /// Its phase, radians.
    pub phase: f64,
    /// Width across the curve in which electrons are placed, km.
    pub width: f64,
}

impl Curve {
    /// The point at `t` in [0, 1]: Bézier point plus the sine along the normal.
    pub fn point(&self, t: f64) -> DVec2 {
        let sine = self.amplitude * (std::f64::consts::TAU * self.waves * t + self.phase).sin();
        self.base(t) + self.base_normal(t) * sine
    }

    /// The unit normal of the curve with its sine at `t`. Where the derivative vanishes it is that of the Bézier curve's chord, or +y.
    pub fn normal(&self, t: f64) -> DVec2 {
        // A step of 1e-4 of the curve: the error, of second order, is far below the width.
        let step = (self.point((t + 1e-4).min(1.0)) - self.point((t - 1e-4).max(0.0))).perp();
        step.try_normalize().unwrap_or_else(|| self.base_normal(t))
    }

    /// A place for an electron: `along` and `across` uniform in [0, 1).
    pub fn seed(&self, along: f64, across: f64) -> DVec2 {
        self.point(along) + self.normal(along) * (self.width * (across - 0.5))
    }

    fn base(&self, t: f64) -> DVec2 {
        let [a, b, c, d] = self.control;
        let s = 1.0 - t;
        a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
    }

    fn base_normal(&self, t: f64) -> DVec2 {
        let [a, b, c, d] = self.control;
        let s = 1.0 - t;
        let along = (b - a) * (s * s) + (c - b) * (2.0 * s * t) + (d - c) * (t * t);
        along.perp().try_normalize().or((d - a).perp().try_normalize()).unwrap_or(DVec2::Y)
    }
}

/// The point at `t` of the way from node `a` to node `b` of a curtain, with its derivative by t. It is a cubic with Catmull and Rom's
/// directions: at a node the direction is that from the node before to the node after. The speed is everywhere about the distance of the
/// two nodes. So nodes at uneven distances make no loops, light spread evenly over t is spread evenly along the curve, and seven nodes
/// round a circle make one to half a per cent. Twin: `between_nodes` in shaders/aurora/streaks.wgsl.
pub fn between_nodes([before, a, b, after]: [DVec2; 4], t: f64) -> [DVec2; 2] {
    let chord = b - a;
    let apart = chord.length();
    let at_a = (b - before).normalize_or_zero() * apart;
    let at_b = (after - a).normalize_or_zero() * apart;
    let place = a + chord * (t * t * (3.0 - 2.0 * t)) + (at_a * (1.0 - t) - at_b * t) * (t * (1.0 - t));
    let step = chord * (6.0 * t * (1.0 - t)) + at_a * ((1.0 - t) * (1.0 - 3.0 * t)) + at_b * (t * (3.0 * t - 2.0));
    [place, step]
}
