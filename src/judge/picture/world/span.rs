//! The delays between which a camera may see a flying body, and how far out: found by a walk along its worldline, in steps proportional to
//! its radius.

use super::sweep::fastest_since;
use super::worldline::{Pose, Worldline};
use crate::spacetime::matter::gamma;

/// Longest winding at the photon sphere, in r_s/c. A deviation from it grows by a factor of e in (3√3/2) r_s/c, and 10¹⁶ is e^36.8.
const WINDING: f64 = 100.0;
/// For how long light that clings to the horizon is followed, in r_s/c. Its frequency has then fallen by e^−100, below the least number in
/// f32.
pub(in crate::judge::picture) const CLINGING: f64 = 200.0;
/// Oldest light that is searched for, in r_s/c. A ship that comes straight at the camera with 1 − v below about 10⁻⁴ is not seen at its
/// earlier positions.
const OLDEST: f64 = 1e5;
/// Step of the walk, as a share of the radius or of the body's reach, whichever is more.
const STEP: f64 = 0.25;
/// Gaps to r = 1, in r_s, down to which clinging light may be followed. The one with which the following ends soonest is taken. Each costs
/// 4.6 r_s/c more than the one before.
const GAPS: [f64; 6] = [1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11];
/// Clinging light stands still in front of a body held in place, if it moves by less than this share of the body's reach, in the body's
/// axes.
const STILL: f64 = 1e-3;

/// What light to a camera at one radius may meet.
#[derive(Clone, Debug)]
pub(in crate::judge::picture) struct Scope {
    /// The camera's radius, in r_s.
    camera: f64,
    /// Outgoing light beyond this radius, in r_s, meets nothing.
    pub radius: f64,
    /// Clinging light may meet something until this delay, in r_s/c,
    pub clings_until: f64,
    /// or while it is farther than this from r = 1 (r_s).
    pub gap: f64,
    /// For each of [`GAPS`] the delay, in r_s/c, after which no body is so close to r = 1.
    lingers: [f64; GAPS.len()],
    /// For each flying body the least and the greatest delay at which it may be met, in r_s/c.
    spans: Vec<[f64; 2]>,
}

impl Scope {
    /// For a camera at radius `camera` (r_s) at T = `time`. Nothing is held in place beyond `radius`. `lines` are the flying bodies with
    /// their reach (r_s), in order.
    pub fn new<'a>(camera: f64, radius: f64, time: f64, hole: bool, lines: impl Iterator<Item = (&'a dyn Worldline, f64)>) -> Scope {
        let (lingers, spans) = ([0.0; GAPS.len()], Vec::new());
        let mut scope = Scope { camera, radius, clings_until: 0.0, gap: GAPS[0], lingers, spans };
        for (line, reach) in lines {
            scope.add(time, hole, line, reach);
        }
        scope.settle();
        scope
    }

    /// Whether it belongs to a camera at this radius (r_s).
    pub fn is_of(&self, camera: f64) -> bool {
        self.camera == camera
    }

    /// Whether the flying body of this number may be met at delays from `from` to `to` (r_s/c).
    pub fn allows(&self, number: u32, from: f64, to: f64) -> bool {
        let [newest, oldest] = self.spans[number as usize];
        to >= newest && from <= oldest
    }

    fn add(&mut self, time: f64, hole: bool, line: &dyn Worldline, reach: f64) {
        let pose = |delay: f64| line.at(time - delay);
        let at = |delay: f64| pose(delay).position.length();
        // Light to the camera, followed backwards, comes no nearer to the hole than this, and a body inside never comes out.
        let floor = if hole { self.camera.min(1.0) } else { 0.0 };
        let newest = last_below(|delay| at(delay) + reach < floor);
        let mut delay = newest;
        let mut here = pose(delay);
        let mut r = here.position.length();
        while delay < OLDEST {
            if !r.is_finite() {
                // If nothing is known at this time, something may be known a moment earlier.
                delay += 1.0 / 64.0;
                here = pose(delay);
                r = here.position.length();
                continue;
            }
            let clings = hole && r <= 2.0 + 2.0 * reach && delay < self.inwards() + CLINGING;
            if self.is_past(hole, r + reach, delay) && !clings {
                break;
            }
            let strays = STEP * r.max(reach);
            // At r = 0 the bound is infinite.
            let newer = delay;
            delay += (strays / fastest_since(r)).max(1e-4);
            let last = std::mem::replace(&mut here, pose(delay));
            let before = std::mem::replace(&mut r, here.position.length());
            // Between the two times it may be nearer or farther by half of the largest motion.
            let far = before.max(r) + 0.5 * strays + reach;
            // Light is faster than any body: a body that it has not reached by this delay it had not reached before.
            if r - reach <= farthest(self.camera, delay) {
                self.radius = self.radius.max(far);
            }
            if clings {
                let clearance = clearance(time, line, reach, [(newer, &last), (delay, &here)]).unwrap_or_else(|| {
                    let strays = 0.5 * strays + reach;
                    Clearance { least: (before.min(r) - strays - 1.0).max(1.0 - before.max(r) - strays), stands: 0.0 }
                });
                for (lingers, gap) in self.lingers.iter_mut().zip(GAPS) {
                    if !(clearance.least > gap || gap < clearance.stands) {
                        *lingers = delay;
                    }
                }
            }
        }
        self.spans.push([newest, delay]);
    }

    /// Takes the gap with which the following of clinging light ends soonest.
    fn settle(&mut self) {
        let left = |k: &usize| self.lingers[*k].max(self.inwards() - 2.0 * GAPS[*k].ln());
        let best = (0..GAPS.len()).min_by(|a, b| left(a).total_cmp(&left(b))).unwrap_or(0);
        (self.clings_until, self.gap) = (self.lingers[best], GAPS[best]);
    }

    /// Whether no light of this age (r_s/c) is still within `far` (r_s), except clinging light. Nothing overtakes light, so this stays true
    /// for older light. Followed backwards, light takes r − 2√r + 2 ln(1 + √r) outwards, and at most [`Scope::inwards`] inwards.
    fn is_past(&self, hole: bool, far: f64, delay: f64) -> bool {
        if !hole {
            return far < delay - self.camera;
        }
        let root = far.sqrt();
        far - 2.0 * root + 2.0 * root.ln_1p() < delay - self.inwards() - WINDING
    }

    /// Longest time that light takes from the camera inwards, without winding, in r_s/c.
    fn inwards(&self) -> f64 {
        let root = self.camera.sqrt();
        self.camera + 2.0 * root + 2.0 * root.ln_1p()
    }
}

/// The space between a body and r = 1 over a span of delay.
struct Clearance {
    /// Least distance of the body from r = 1, in r_s; below 0 where it may lie across it.
    least: f64,
    /// Light closer than this to r = 1, in r_s, stands still in front of the body.
    stands: f64,
}

/// The clearance of a body between two delays (r_s/c) one step apart, with its poses there; None if its motion is not known. A body close
/// to the horizon is contracted across it: followed backwards it comes as close to r = 1 as clinging light, and no closer.
fn clearance(time: f64, line: &dyn Worldline, reach: f64, [newer, older]: [(f64, &Pose); 2]) -> Option<Clearance> {
    let span = older.0 - newer.0;
    let sway = line.sway(time - older.0, time - newer.0)?;
    let moves = 0.5 * sway.velocity * span;
    let extent = |pose: &Pose| {
        // A point y in body axes is B⁻¹ y from the centre, and |B⁻¹ n|² = 1 − (n·p)²/γ² = (1 + |p × n|²)/γ².
        let across = pose.momentum.cross(pose.position.normalize());
        reach * across.length().hypot(1.0) / gamma(pose.momentum)
    };
    let extent = if sway.force * span <= 0.25 * (1.0 + sway.momentum[0]) {
        // In so short a time neither part of the momentum changes by half of it.
        reach.min(2.0 * extent(newer.1).max(extent(older.1)))
    } else {
        reach
    };
    let [r0, r1] = [newer.1, older.1].map(|pose| pose.position.length());
    let held = sway.velocity == 0.0 && sway.force == 0.0 && sway.turning == 0.0;
    let stands = if held { STILL * reach / gamma(older.1.momentum) } else { 0.0 };
    Some(Clearance { least: (r0.min(r1) - 1.0).max(1.0 - r0.max(r1)) - moves - extent, stands })
}

/// Largest radius of light of this delay (r_s/c) to a camera at radius `camera`, in r_s: dr/dτ ≤ 1 + r^{-1/2}.
fn farthest(camera: f64, delay: f64) -> f64 {
    let start = camera.max(1.0);
    start + delay + 2.0 * ((start + delay).sqrt() - start.sqrt())
}

/// The largest delay (r_s/c) up to which `holds` is true, if once false it stays false at greater ones. The result may be a little less,
/// never more.
fn last_below(holds: impl Fn(f64) -> bool) -> f64 {
    if !holds(0.0) {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 1.0 / 64.0);
    while holds(high) && high < OLDEST {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..20 {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}
