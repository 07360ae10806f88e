//! All crossings of a curve with a plane, in order, if a bound on the bend of the curve is known.

/// Bounds on how much a curve, or its height over a plane, bends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bend {
    /// Greatest |second derivative|, except at kinks.
    pub curve: f64,
    /// Sum of all jumps of the first derivative.
    pub kink: f64,
}

impl Bend {
    /// Greatest distance of the curve from its chord over a span. Green's function of the second derivative is at most a quarter of the
    /// span, and its integral an eighth of the span's square.
    pub fn sagitta(&self, span: f64) -> f64 {
        (0.125 * self.curve * span + 0.25 * self.kink) * span
    }

    /// The same bounds times `factor`.
    pub fn times(&self, factor: f64) -> Bend {
        Bend { curve: self.curve * factor, kink: self.kink * factor }
    }
}

/// Calls `visit` for the roots of f from `a` to `b` (each with the value of f there), in order, until it returns true. Returns whether it
/// did.
///
/// With the sagitta S a function is within 4 S t (1 − t) of its chord at the share t of the span, and its slope within 4 S over the span of
/// the chord's. So between ends of one sign it has no root if √a + √b > 2 √S, and between ends of different signs exactly one if |b − a| >
/// 4 S. All other spans are halved, down to dips and waves of less than `least`.
pub(super) fn roots(
    f: &impl Fn(f64) -> f64,
    a: (f64, f64),
    b: (f64, f64),
    bend: &Bend,
    least: f64,
    visit: &mut impl FnMut(f64) -> bool,
) -> bool {
    let span = b.0 - a.0;
    let sagitta = bend.sagitta(span);
    let crosses = a.1 * b.1 <= 0.0;
    // If f is unknown at one end, it may be known up to near there.
    let known = [a.1, b.1].map(f64::is_finite);
    if known == [false; 2] || known == [true; 2] && !crosses && a.1.abs().sqrt() + b.1.abs().sqrt() > 2.0 * sagitta.sqrt() {
        return false;
    }
    if crosses && (b.1 - a.1).abs() > 4.0 * sagitta || sagitta.is_nan() || sagitta <= least {
        // A curve in the plane sees the triangle edge on.
        return crosses && (a.1 != 0.0 || b.1 != 0.0) && visit(falsi(a, b, f));
    }
    let middle = a.0 + 0.5 * span;
    let middle = (middle, f(middle));
    roots(f, a, middle, bend, least, visit) || roots(f, middle, b, bend, least, visit)
}

/// A root of f between two points with values of opposite signs: regula falsi with the weight of the end that stays halved (Illinois).
fn falsi((mut a, mut fa): (f64, f64), (mut b, mut fb): (f64, f64), f: impl Fn(f64) -> f64) -> f64 {
    if fa == 0.0 {
        return a;
    }
    let scale = fa.abs().max(fb.abs());
    // About seven evaluations reach rounding; sixty are enough for any f.
    for _ in 0..60 {
        if fb == 0.0 || (b - a).abs() <= 2.0 * f64::EPSILON * b.abs() || fb.abs() <= 1e-15 * scale {
            break;
        }
        let c = (b * fa - a * fb) / (fa - fb);
        let fc = f(c);
        if fc * fb < 0.0 {
            (a, fa) = (b, fb);
        } else {
            fa *= 0.5;
        }
        (b, fb) = (c, fc);
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(f: impl Fn(f64) -> f64, curve: f64) -> Vec<f64> {
        within(f, Bend { curve, kink: 0.0 })
    }

    fn within(f: impl Fn(f64) -> f64, bend: Bend) -> Vec<f64> {
        let mut found = Vec::new();
        roots(&f, (0.0, f(0.0)), (1.0, f(1.0)), &bend, 1e-12, &mut |s| {
            found.push(s);
            false
        });
        found
    }

    #[test]
    fn dips_and_waves_are_found_however_shallow() {
        for depth in [1e-1, 1e-3, 1e-5] {
            for middle in [0.31, 0.5, 0.77] {
                let found = all(|s| (s - middle) * (s - middle) - depth * depth, 2.0);
                assert_eq!(found.len(), 2, "depth {depth} at {middle}: {found:?}");
                assert!((found[0] - (middle - depth)).abs() < 1e-12 && (found[1] - (middle + depth)).abs() < 1e-12);
            }
        }
        // Opposite signs at the ends, and still three.
        let found = all(|s| (s - 0.2) * (s - 0.21) * (s - 0.9), 6.0);
        assert!(found.len() == 3 && found.windows(2).all(|pair| pair[0] < pair[1]), "{found:?}");
        assert!(all(|s| (s - 0.4) * (s - 0.4) + 1e-9, 2.0).is_empty());
        assert!(all(|_| 0.0, 2.0).is_empty());
        assert_eq!(all(|s| if s < 0.6 { s - 0.4 } else { f64::NAN }, 2.0).len(), 1);
    }
    #[test]
    fn a_kink_within_its_bound_hides_no_roots() {
        for middle in [0.03, 0.3, 0.5, 0.99] {
            let found = within(|s| (s - middle).abs() - 1e-3, Bend { curve: 0.0, kink: 2.0 });
            assert_eq!(found.len(), 2, "at {middle}: {found:?}");
        }
    }
}
