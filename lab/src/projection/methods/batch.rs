//! The lookup for eight points at once on the processor: the formulas of `formulas` and `lookup` under the same names, without branches, in
//! SIMD registers of eight f32. It exists for speed alone; a test holds it to the answers of `lookup`.

use wide::f32x8;

use lensrunner::lensing::lookup::{LEAST_LAPSE2, LensRay, YOUNG, lens_lookup_aged};
use lensrunner::lensing::methods::table::{in_range, seen};
use lensrunner::lensing::methods::{ProjectionInput, Projector, Sight, Table, Vertex};
use lensrunner::lensing::single::{BEND_RANGE, BEND_START, HALF_TURN, LensCamera, SMALLEST_SWEEP, SWEEP_LENGTH};
use lensrunner::lensing::table::slice::{HEADER, Slice};
use lensrunner::spacetime::light::{Branch, Order};

use super::{Frame, Method};

/// Points in a batch.
pub const LANES: usize = 8;

/// Eight answers: the fields of [`LensRay`].
#[derive(Clone, Copy, Debug)]
pub struct LensRays {
    /// See [`LensRay::cos_psi`].
    pub cos_psi: [f32; LANES],
    /// See [`LensRay::sin_psi`].
    pub sin_psi: [f32; LANES],
    /// See [`LensRay::delay`].
    pub delay: [f32; LANES],
    /// See [`LensRay::frequency`].
    pub frequency: [f32; LANES],
    /// See [`LensRay::emission_radial`].
    pub emission_radial: [f32; LANES],
    /// See [`LensRay::emission_tangential`].
    pub emission_tangential: [f32; LANES],
    /// See [`LensRay::emission_frequency`].
    pub emission_frequency: [f32; LANES],
    /// See [`LensRay::slope`].
    pub slope: [f32; LANES],
    /// See [`LensRay::emission_slope`].
    pub emission_slope: [f32; LANES],
    /// See [`LensRay::energy`].
    pub energy: [f32; LANES],
    /// See [`LensRay::valid`].
    pub valid: [bool; LANES],
}

impl LensRays {
    /// The answer for one of the points.
    pub fn ray(&self, i: usize) -> LensRay {
        LensRay {
            cos_psi: self.cos_psi[i],
            sin_psi: self.sin_psi[i],
            delay: self.delay[i],
            frequency: self.frequency[i],
            emission_radial: self.emission_radial[i],
            emission_tangential: self.emission_tangential[i],
            emission_frequency: self.emission_frequency[i],
            slope: self.slope[i],
            emission_slope: self.emission_slope[i],
            energy: self.energy[i],
            valid: self.valid[i],
        }
    }

    fn set(&mut self, i: usize, ray: LensRay) {
        self.cos_psi[i] = ray.cos_psi;
        self.sin_psi[i] = ray.sin_psi;
        self.delay[i] = ray.delay;
        self.frequency[i] = ray.frequency;
        self.emission_radial[i] = ray.emission_radial;
        self.emission_tangential[i] = ray.emission_tangential;
        self.emission_frequency[i] = ray.emission_frequency;
        self.slope[i] = ray.slope;
        self.emission_slope[i] = ray.emission_slope;
        self.energy[i] = ray.energy;
        self.valid[i] = ray.valid;
    }
}

fn all(x: f32) -> f32x8 {
    f32x8::splat(x)
}

/// The larger of two, neither being NaN.
fn most(a: f32x8, b: f32) -> f32x8 {
    a.fast_max(all(b))
}

fn log1p(x: f32x8) -> f32x8 {
    let z = x / (all(2.0) + x);
    let y = z * z;
    let series = all(2.0) * z * (all(1.0) + y * (all(1.0 / 3.0) + y * (all(0.2) + y * (all(1.0 / 7.0) + y * all(1.0 / 9.0)))));
    z.abs().simd_lt(all(0.1)).select(series, (all(1.0) + x).ln())
}

fn angle(sine: f32x8, cosine: f32x8) -> f32x8 {
    let y = sine * sine;
    let x = sine * (all(1.0) + y * (all(1.0 / 6.0) + y * (all(3.0 / 40.0) + y * (all(15.0 / 336.0) + y * all(105.0 / 3456.0)))));
    let near = cosine.simd_lt(all(0.0)).select(all(HALF_TURN) - x, x);
    sine.simd_lt(all(0.25)).select(near, sine.atan2(cosine))
}

/// r, 1 − 1/r, r − L, φ.
pub(super) fn source_point(cam: &LensCamera, along: f32x8, across: f32x8, height: f32x8) -> [f32x8; 4] {
    let l = all(cam.l);
    let square = along * along + across * across;
    let r = (height * height + across * across).sqrt();
    let inverse = all(1.0) / r;
    let phi = angle(across * inverse, height * inverse);
    let near = square.simd_lt(all(0.25 * cam.l * cam.l));
    let offset = (all(2.0) * l * along + square) / (r + l);
    let height = near.select(all(cam.lapse2 * cam.l) + offset, r - all(1.0));
    [r, height * inverse, near.select(offset, r - l), phi]
}

fn bent_sweep(sweep: f32x8) -> f32x8 {
    let off = most(sweep - all(BEND_START), 0.0);
    if !off.simd_gt(all(0.0)).any() {
        return sweep;
    }
    let x = off * all(1.0 / BEND_RANGE);
    let x2 = x * x;
    sweep - off + off / (all(1.0) + x2 * x2)
}

fn basis(cam: &LensCamera, sweep: f32x8) -> [f32x8; 2] {
    let x = all(cam.rate) * sweep;
    let y = all(cam.bend) * sweep * sweep;
    let one = all(1.0);
    let small_s = sweep * (one + y * all(1.0 / 6.0) * (one + y * all(1.0 / 20.0) * (one + y * all(1.0 / 42.0))));
    let small_k = all(0.5) * sweep * sweep * (one + y * all(1.0 / 12.0) * (one + y * all(1.0 / 30.0) * (one + y * all(1.0 / 56.0))));
    let small = x.simd_lt(all(0.3));
    let over = 1.0 / cam.rate;
    let [s, k] = if cam.bend < 0.0 {
        // sin x = 2 sin(x/2) cos(x/2): one evaluation serves both.
        let (sin, cos) = (all(0.5) * x).sin_cos();
        let h = sin * all(over);
        [all(2.0) * h * cos, all(2.0) * h * h]
    } else {
        let up = x.exp();
        let down = one / up;
        [all(0.5) * (up - down) * all(over), (all(0.5) * (up + down) - one) * all(over * over)]
    };
    [small.select(small_s, s), small.select(small_k, k)]
}

fn slopes(cam: &LensCamera, rise: f32x8, bent: f32x8) -> [f32x8; 2] {
    let [s, k] = basis(cam, bent);
    let m = all(cam.fade) / (all(1.0) + all(cam.a) * all(cam.a) * k * k);
    let am = all(cam.a) * m;
    let f = all(cam.a * (1.5 * cam.a - 1.0));
    let b = s * (all(1.0) + am * k);
    let c = rise - f * k - all(0.5) * am * f * k * k;
    let q = m * k * k;
    let root = (b * b + all(2.0) * q * c).fast_max(all(0.05) * b * b + all(1e-4) * q).sqrt();
    let w = b.simd_gt(all(0.0)).select(all(2.0) * c / (b + root), (root - b) / q);
    let turn = all(1.0) + all(cam.bend) * k;
    let w_e = if cam.bend > 0.0 {
        let rest = (all(1.5) + all(0.5 * cam.bend) * k) * k * k * (am * f + m * w * w);
        (turn * rise + f * k + rest) / s + w * am * s * s
    } else {
        w * (turn * (all(1.0) + am * k) + am * s * s) + f * s + am * f * k * s + m * k * s * w * w
    };
    [w, w_e]
}

fn turned_slope(guess: f32x8, u: f32x8, turn: f32x8) -> f32x8 {
    let (ct, st) = (all(1.0) - turn * turn, turn + turn);
    let sine = (u * ct - guess * st).fast_max(all(1e-6) * u);
    u * (guess * ct + u * st) / sine
}

fn joined(w: f32x8, w_e: f32x8, cam: &LensCamera, c: f32x8, lapse2: f32x8) -> [f32x8; 3] {
    let (here, there) = (all(cam.a * cam.a * cam.lapse2), c * c * lapse2);
    if cam.lapse2 <= 0.0 {
        let square = most(w_e * w_e + there, 0.0);
        return [-(square - here).sqrt(), square.sqrt(), w_e];
    }
    let square = most(w * w + here, 0.0);
    let rest = square - there;
    let root = most(rest, 0.0).sqrt();
    let sure = rest.simd_gt(all(0.3) * square);
    [w, square.sqrt(), sure.select(w_e.simd_lt(all(0.0)).select(-root, root), w_e)]
}

/// Frequency plus outward momentum, and frequency less it.
fn light_cone(w: f32x8, e: f32x8, u: f32x8, beta: f32x8, lapse2: f32x8) -> [f32x8; 2] {
    let rising = w.simd_gt(all(0.0));
    let square = u * u;
    let over = rising.select(e + w, square) * (all(1.0) + beta);
    let under = rising.select(lapse2, e - w);
    [over / under, square * under / over]
}

/// (K, h, q): see `formulas`.
fn lens_equation(cam: &LensCamera, c: f32x8, bent: f32x8) -> [f32x8; 3] {
    let (sine, cosine) = (all(0.5) * bent).sin_cos();
    let square = all(4.0) * sine * sine;
    let k = all(0.5) * square;
    let y = all(2.0) * cosine;
    let quarter = all(0.5) * (all(cam.share) + c) * k * k;
    let large = all(0.5) * y.abs() + (all(0.25) * y * y + quarter).sqrt();
    let small = quarter / large;
    let ahead = y.simd_gt(all(0.0));
    [k, ahead.select(large, small), square - quarter - ahead.select(small, large) * y]
}

/// The three residuals of each point at coordinates in 0..=1, clamped.
fn residuals(slice: &Slice, x: f32x8, y: f32x8) -> [f32x8; 3] {
    let [nx, ny] = slice.size;
    let cell = |x: f32x8, n: u32| {
        let p = most(x, 0.0).fast_min(all(1.0)) * all((n - 1) as f32);
        let i = p.floor().fast_min(all((n - 2) as f32));
        (i.to_array(), spline_weights(p - i))
    };
    let ((i, wx), (j, wy)) = (cell(x, nx), cell(y, ny));
    let (wx, wy) = (wx.map(|w| w.to_array()), wy.map(|w| w.to_array()));
    let mut sums = [[0.0f32; LANES]; 3];
    for lane in 0..LANES {
        // Four channels at once: a texel is one register.
        let mut sum = wide::f32x4::ZERO;
        for (b, weight) in wy.iter().enumerate() {
            let at = HEADER + (j[lane] as usize + b) * (nx as usize + 2) + i[lane] as usize;
            let texels = &slice.texels()[at..at + 4];
            let mut row = wide::f32x4::ZERO;
            for (texel, weights) in texels.iter().zip(&wx) {
                row += wide::f32x4::from(*texel) * wide::f32x4::splat(weights[lane]);
            }
            sum += row * wide::f32x4::splat(weight[lane]);
        }
        let sum = sum.to_array();
        (0..3).for_each(|h| sums[h][lane] = sum[h]);
    }
    sums.map(f32x8::from)
}

fn spline_weights(t: f32x8) -> [f32x8; 4] {
    let s = all(1.0) - t;
    let sixth = all(1.0 / 6.0);
    let inner = |t: f32x8| all(4.0 / 6.0) + t * t * (all(0.5) * t - all(1.0));
    [s * s * s * sixth, inner(t), inner(s), t * t * t * sixth]
}

/// The rays of `order` (1 to 3) from eight points, each `along` outward and `across` from the axis, away from the camera of `slice`;
/// `height` = L + along. As [`lensrunner::lensing::lens_lookup_at`] for each; points inside the horizon go through it one by one.
pub fn lens_lookup_batch(slice: &Slice, along: [f32; LANES], across: [f32; LANES], height: [f32; LANES], order: u32) -> LensRays {
    let cam = &slice.camera;
    let sides = [along, across, height];
    let [r, lapse2, dr, phi] = source_point(cam, along.into(), across.into(), height.into());
    let sweep = match order {
        2 => all(2.0 * HALF_TURN) - phi,
        3 => all(2.0 * HALF_TURN) + phi,
        _ => phi,
    };
    let swept = most(sweep, SMALLEST_SWEEP);
    let (l, c) = (all(cam.l), all(1.0) / r);
    let open = most(lapse2, LEAST_LAPSE2);
    let bent = bent_sweep(swept);
    let guess = slopes(cam, -dr * c * all(cam.a), bent);
    let [k, h, q] = lens_equation(cam, c, bent);
    let lens = (all(0.5) * h).ln();
    let near = (all(10.0) * swept + (all(1.0) + all(100.0) * swept * swept).sqrt()).ln();
    let x = ((c + all(cam.soft)).ln() - all(2.0) * open.sqrt() - all(cam.start)) * all(cam.scale);
    let table = residuals(slice, x, (swept + near - all(0.3) * lens) * all(1.0 / SWEEP_LENGTH));
    let scale = c + all(cam.reach);
    let [w, e, w_e] = joined(turned_slope(guess[0], all(cam.a), table[0]), turned_slope(guess[1], scale, table[2]), cam, c, open);
    let root_c = c.sqrt();
    let [seen, seen_less] = light_cone(w, e, all(cam.a), all(cam.beta), all(cam.lapse2));
    let [emitted, emitted_less] = light_cone(w_e, e, c, root_c, open);
    let log = log1p(dr * all(cam.a));
    let mean = all(1.0) + dr.abs().simd_gt(all(1e-6 * cam.l)).select(all(3.0) * log / dr, all(3.0 * cam.a));
    let both = open + all(cam.even) * (all(cam.lapse2) - open) + k * c * c * all(cam.share - 1.5 * cam.share * cam.even);
    let across = (all(1.0) + all(1.5) * (all(cam.a) + c)) * both * r * l * q;
    let near_hole = c + all(0.01);
    let c4 = near_hole * near_hole * near_hole * near_hole;
    let factor = e / (e * e + all(0.25) * k * k * c4 * c4 * all(cam.lift)).sqrt();
    let along = all(2.0) * ((emitted * seen_less * (r * l)).ln() - dr / (r * root_c + all(cam.l * cam.beta)));
    let delay = along + factor * ((mean * (mean * dr * dr + across)).sqrt() - all(2.0) * lens + table[1]);
    let (frequency, emission_frequency) = (all(0.5) * (seen + seen_less), all(0.5) * (emitted + emitted_less));
    let leaving = all(0.5) * (emitted - emitted_less);
    let over = all(0.5) / frequency;
    let mut rays = LensRays {
        cos_psi: ((seen_less - seen) * over).to_array(),
        sin_psi: (all(2.0 * cam.a) * over).to_array(),
        delay: delay.to_array(),
        frequency: frequency.to_array(),
        emission_radial: leaving.to_array(),
        emission_tangential: c.to_array(),
        emission_frequency: emission_frequency.to_array(),
        slope: w.to_array(),
        emission_slope: w_e.to_array(),
        energy: e.to_array(),
        valid: [true; LANES],
    };
    // What is not a plain point outside (inside, NaN, infinite, overflowing) is answered by the scalar lookup.
    let sum = frequency + emission_frequency + w.abs() + w_e.abs() + delay.abs() + r + f32x8::from(sides[0]).abs();
    let plain = lapse2.simd_gt(all(0.0)) & sum.simd_lt(all(3e38));
    let plain = plain.to_bitmask();
    if plain != (1 << LANES) - 1 {
        for i in (0..LANES).filter(|i| plain >> i & 1 == 0) {
            rays.set(i, lens_lookup_aged(slice, sides[0][i], sides[1][i], sides[2][i], order, YOUNG));
        }
    }
    rays
}

/// The game's table, eight points at once.
pub struct Batch(pub Table);

/// The answers for at most eight points; the last is repeated to fill the batch.
fn look_up_batch(slice: &Slice, points: &[Vertex], order: Order) -> LensRays {
    let last = points.len() - 1;
    let of = |field: fn(&Vertex) -> f32| std::array::from_fn(|i| field(&points[i.min(last)]));
    lens_lookup_batch(slice, of(|p| p.along), of(|p| p.across), of(|p| p.height), u32::from(order.number()))
}

struct Batches(Slice);

impl Frame for Batches {
    fn look_up(&self, points: &[Vertex], order: Order) {
        for points in points.chunks(LANES) {
            std::hint::black_box(look_up_batch(&self.0, points, order));
        }
    }
}

impl Projector for Batch {
    fn project(&self, input: ProjectionInput, order: Order, branch: Branch) -> Option<Sight> {
        if branch == Branch::Minus || !in_range(input) {
            return self.0.project(input, order, branch);
        }
        seen(&look_up_batch(&Slice::new(&self.0.0, input.camera), &[input.into()], order).ray(0), input)
    }
}

impl Method for Batch {
    fn frame(&self, l: f64) -> Box<dyn Frame + '_> {
        Box::new(Batches(Slice::new(&self.0.0, l)))
    }

    fn memory(&self) -> usize {
        self.0.memory()
    }
}
