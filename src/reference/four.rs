//! Four steps of four rays at once, each of its own length: the same bits as four of [`Segment::step`].

use glam::DVec2;

use super::geodesic::{Segment, State, order_for, step_length};
use super::taylor::{Four, Number, Vectors, series};

/// Parts of a step at which the rays are looked at: the ends of this many equal pieces.
pub const PIECES: usize = 4;

/// Four steps of the solution, side by side.
#[derive(Clone, Debug)]
pub struct FourSegments {
    /// The delays at which they start, in r_s/c.
    pub start: [f64; 4],
    /// How much delay each covers, in r_s/c.
    pub length: [f64; 4],
    /// A bound on |d²x/dτ²| over each, in 1/r_s, as of [`Segment::bend`].
    pub bend: [f64; 4],
    /// The state at the end of each.
    pub end: [State; 4],
    /// Positions in the planes of the orbits at the ends of [`PIECES`] equal pieces, x and y.
    along: [[Four; 2]; PIECES + 1],
    order: usize,
    x: Vectors<Four>,
    p: Vectors<Four>,
}

impl FourSegments {
    /// Room for four steps.
    pub fn empty() -> FourSegments {
        let state = State { position: DVec2::ZERO, momentum: DVec2::ZERO };
        let (x, p) = (Default::default(), Default::default());
        FourSegments { start: [0.0; 4], length: [0.0; 4], bend: [0.0; 4], end: [state; 4], along: Default::default(), order: 1, x, p }
    }

    /// Takes the steps that follow `states` backwards in time, with a local error of about `tolerance` relative to r and |p|.
    pub fn step(&mut self, start: [f64; 4], states: &[State; 4], tolerance: f64) {
        (self.start, self.order) = (start, order_for(tolerance));
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            #[allow(unsafe_code)]
            // SAFETY: AVX2 was detected. Measured: three times as fast as without.
            return unsafe { self.step_avx(states, tolerance) };
        }
        self.work(states, tolerance);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn step_avx(&mut self, states: &[State; 4], tolerance: f64) {
        self.work(states, tolerance);
    }

    #[inline(always)]
    fn work(&mut self, states: &[State; 4], tolerance: f64) {
        let order = self.order;
        let position = [lanes(states, |s| s.position.x), lanes(states, |s| s.position.y)];
        let momentum = [lanes(states, |s| s.momentum.x), lanes(states, |s| s.momentum.y)];
        series(position, momentum, order, &mut self.x, &mut self.p);
        let of = |vector: [Four; 2], lane: usize| DVec2::new(vector[0].0[lane], vector[1].0[lane]);
        self.length = std::array::from_fn(|lane| {
            step_length(&states[lane], order, tolerance, |n| [of(self.x[n], lane), of(self.p[n], lane)])
        });
        let length = Four(self.length);
        self.along[0] = position;
        for k in 1..PIECES {
            self.along[k] = horner(&self.x[..=order], Four::splat(k as f64 / PIECES as f64) * length);
        }
        self.along[PIECES] = horner(&self.x[..=order], length);
        let p = horner(&self.p[..=order], length);
        self.end = std::array::from_fn(|lane| State { position: of(self.along[PIECES], lane), momentum: of(p, lane) });
        let mut bend = Four::splat(0.0);
        for n in (2..=order).rev() {
            let [x, y] = self.x[n];
            bend = bend * length + Four::splat((n * (n - 1)) as f64) * (x * x + y * y).sqrt();
        }
        self.bend = bend.0;
    }

    /// Where the ray of a lane is at the ends of [`PIECES`] equal pieces of its step, in the plane of its orbit.
    pub fn along(&self, lane: usize) -> [DVec2; PIECES + 1] {
        self.along.map(|[x, y]| DVec2::new(x.0[lane], y.0[lane]))
    }

    /// The step of one lane.
    pub fn lane(&self, lane: usize) -> Segment {
        let of = |series: &Vectors<Four>| series.map(|[x, y]| DVec2::new(x.0[lane], y.0[lane]));
        Segment { start: self.start[lane], length: self.length[lane], order: self.order, x: of(&self.x), p: of(&self.p) }
    }
}

#[inline(always)]
fn lanes(states: &[State; 4], number: impl Fn(&State) -> f64) -> Four {
    Four(std::array::from_fn(|i| number(&states[i])))
}

/// The polynomial at `elapsed`, rounded as [`Segment::position`] rounds.
#[inline(always)]
fn horner(coefficients: &[[Four; 2]], elapsed: Four) -> [Four; 2] {
    let mut sum = [Four::splat(0.0); 2];
    for c in coefficients.iter().rev() {
        sum = [sum[0] * elapsed + c[0], sum[1] * elapsed + c[1]];
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_side_by_side_are_four_alone() {
        let state = |k: usize| State {
            position: DVec2::new(1.1 + 3.0 * k as f64, 0.3 * k as f64),
            momentum: DVec2::new(0.4 - 0.3 * k as f64, -0.9).normalize(),
        };
        let states = [0, 1, 2, 3].map(state);
        let mut four = FourSegments::empty();
        for tolerance in [1e-6, 1e-12, 1e-16] {
            four.step([0.0, 1.0, 2.0, 3.0], &states, tolerance);
            for k in 0..4 {
                let alone = Segment::step(k as f64, states[k], tolerance);
                let lane = four.lane(k);
                assert_eq!(lane.length.to_bits(), alone.length.to_bits());
                for part in [0.0, 0.3, 1.0] {
                    assert_eq!(lane.at(part * lane.length), alone.at(part * alone.length));
                }
                assert_eq!(four.end[k], alone.at(alone.length));
                assert_eq!(four.bend[k].to_bits(), alone.bend().to_bits());
                assert_eq!(four.along(k), [0.0, 0.25, 0.5, 0.75, 1.0].map(|part| alone.position(part * alone.length)));
            }
        }
    }
}
