//! At which delays a camera may see a flying body at all, and how far out: by a walk along its worldline in steps as long as it is far.

use std::sync::Arc;

use super::sweep::fastest_since;
use super::world::{Motion, World, Worldline};

/// Light winds at the photon sphere for this long at most (r_s/c): a deviation grows by e in (3√3/2) r_s/c, and 10¹⁶ is e^36.8.
const WINDING: f64 = 100.0;
/// Light that clings to the horizon is followed for this long (r_s/c): its frequency has then fallen by e^−100, below the least number in f32.
const CLINGING: f64 = 200.0;
/// Older light is not looked for (r_s/c): a ship that comes straight at the camera with 1 − v below about 10⁻⁴ is not seen where it was before.
const OLDEST: f64 = 1e5;
/// A step of the walk, as a part of the radius or of the body's reach, whichever is more.
const STEP: f64 = 0.25;

/// What light to a camera at one radius may meet.
#[derive(Clone, Debug)]
pub(super) struct Scope {
    /// The camera's radius, in r_s.
    camera: f64,
    /// Light on its way out beyond this radius (r_s) meets nothing any more.
    pub radius: f64,
    /// Light that clings to the horizon may meet something until this delay (r_s/c).
    pub clings_until: f64,
    /// For each flying body the delays between which it may be met, in r_s/c.
    spans: Vec<[f64; 2]>,
}

impl Scope {
    /// Whether the flying body of this number may be met at delays from `from` to `to` (r_s/c).
    pub fn allows(&self, number: u32, from: f64, to: f64) -> bool {
        let [newest, oldest] = self.spans[number as usize];
        to >= newest && from <= oldest
    }

    fn add(&mut self, world: &World, line: &dyn Worldline, reach: f64) {
        let at = |delay: f64| line.at(world.time - delay).position.length();
        // Light to the camera, followed backwards, comes no nearer to the hole than this; nor does a body that is inside ever come out.
        let floor = if world.hole { self.camera.min(1.0) } else { 0.0 };
        let newest = last_below(|delay| at(delay) + reach < floor);
        let mut delay = newest;
        let mut r = at(delay);
        while delay < OLDEST {
            if !r.is_finite() {
                // Where nothing is known here, more may be known a moment earlier.
                delay += 1.0 / 64.0;
                r = at(delay);
                continue;
            }
            let clings = world.hole && r <= 2.0 + 2.0 * reach && delay < self.inwards() + CLINGING;
            if self.is_past(world.hole, r + reach, delay) && !clings {
                break;
            }
            let strays = STEP * r.max(reach);
            // At r = 0, where nothing real is, the bound has no end.
            delay += (strays / fastest_since(r)).max(1e-4);
            let before = std::mem::replace(&mut r, at(delay));
            // Between the two it may be nearer and farther by half of what it strays at most.
            let [near, far] = [before.min(r) - 0.5 * strays - reach, before.max(r) + 0.5 * strays + reach];
            // Light gains on everything: what it has not reached by now it had not before.
            if r - reach <= farthest(self.camera, delay) {
                self.radius = self.radius.max(far);
            }
            if clings && near <= 1.0 {
                self.clings_until = self.clings_until.max(delay);
            }
        }
        self.spans.push([newest, delay]);
    }

    /// Whether no light is as old as this (r_s/c) and still within `far` (r_s), but what clings to the horizon. Nothing overtakes light, so that
    /// stays so. Light takes r − 2√r + 2 ln(1 + √r) out, followed backwards, and at most [`Scope::inwards`] in.
    fn is_past(&self, hole: bool, far: f64, delay: f64) -> bool {
        if !hole {
            return far < delay - self.camera;
        }
        let root = far.sqrt();
        far - 2.0 * root + 2.0 * root.ln_1p() < delay - self.inwards() - WINDING
    }

    /// How long light takes from the camera inwards at most, without its winding (r_s/c).
    fn inwards(&self) -> f64 {
        let root = self.camera.sqrt();
        self.camera + 2.0 * root + 2.0 * root.ln_1p()
    }
}

/// How far out light of this delay (r_s/c) to a camera at radius `camera` is at most, in r_s: dr/dτ ≤ 1 + r^{-1/2}.
fn farthest(camera: f64, delay: f64) -> f64 {
    let start = camera.max(1.0);
    start + delay + 2.0 * ((start + delay).sqrt() - start.sqrt())
}

/// The last delay (r_s/c) up to which something holds that, once it does not, never holds at greater ones; a little less is given, never more.
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

impl World<'_> {
    /// What light to a camera at radius `camera` (r_s) may meet; kept for the next ray.
    pub(super) fn scope(&self, camera: f64) -> Arc<Scope> {
        let mut kept = self.scope.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        match &*kept {
            Some(scope) if scope.camera == camera => scope.clone(),
            _ => {
                let mut scope = Scope { camera, radius: self.held_radius, clings_until: 0.0, spans: Vec::new() };
                for flying in &self.flying {
                    if let Motion::Flying(line) = self.things[flying.thing as usize].motion {
                        scope.add(self, line, flying.reach);
                    }
                }
                let scope = Arc::new(scope);
                *kept = Some(scope.clone());
                scope
            }
        }
    }
}
