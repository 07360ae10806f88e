//! How a moving body moves, turns and contracts while its light crosses it: its centre to fourth order in time, its attitude to second
//! order in the rotation vector and with one jump of the angular velocity, its contraction by the momentum at each moment. The coefficients
//! go to the GPU with the instance; [`swing_at`] is the twin of the shader's function.

use glam::{DVec3, Vec3};

use crate::sim::History;
use crate::sim::history::{Sample, rotation};

use crate::render::gpu::types::Instance;

/// Coefficients about the emission time T₀ of the centre.
#[derive(Clone, Copy, Debug)]
pub struct Swing {
    /// d²x/dT² of the centre, in c²/r_s.
    pub acceleration: DVec3,
    /// d³x/dT³ of the centre, in c³/r_s².
    pub jerk: DVec3,
    /// d⁴x/dT⁴ of the centre, in c⁴/r_s³.
    pub snap: DVec3,
    /// Angular velocity against the attitude at T₀, rain axes, in c/r_s.
    pub spin: DVec3,
    /// Its rate, in (c/r_s)².
    pub spin_rate: DVec3,
    /// A jump of the angular velocity, where a pilot begins or ends a turn, in c/r_s.
    pub jolt: DVec3,
    /// When it happens, after T₀, in r_s/c.
    pub jolt_after: f64,
    /// dp/dT, p being the rain-frame momentum per mass, in c²/r_s.
    pub force: DVec3,
}

impl Swing {
    /// Fitted to positions and attitudes at T₀ − `reach`, T₀ and T₀ + `reach` (r_s/c), and to positions halfway: in that time light crosses
    /// a body of this radius. The fourth order is needed for what falls inside the horizon beside the camera: without it a ship of 0.16 r_s
    /// at r = 0.6 is off by 10⁻⁴ r_s, a pixel at a distance of a thirtieth of r_s. A Taylor series about T₀ would be worst at the ends,
    /// where it matters. It would also need derivatives where the turning of a ship jumps; one pixel in a hundred would be off by two.
    pub fn new(history: &History, emission: f64, reach: f64) -> Swing {
        // For bodies smaller than a thousandth of r_s differences would be lost in rounding, and no motion is visible.
        let w = reach.max(1e-3);
        let [earlier, now, later] = [emission - w, emission, emission + w].map(|t| history.at(t));
        // Light takes longer to cross a body that approaches or recedes.
        let (after, jolt) = history.jolt(emission - 2.0 * w, emission + 2.0 * w).unwrap_or((emission, DVec3::ZERO));
        let jolt_after = after - emission;
        let [back, on] =
            [(earlier, -w), (later, w)].map(|(sample, s)| rotation(now.attitude, sample.attitude) - jolt * jolted(s, jolt_after));
        let moved = |sample: &Sample, s: f64| sample.position - now.position - now.velocity * s;
        let (moved_back, moved_on) = (moved(&earlier, -w), moved(&later, w));
        let [half_back, half_on] = [-0.5 * w, 0.5 * w].map(|s| moved(&history.at(emission + s), s));
        // The even part in s is a s² + k s⁴/12.
        let (even, even_half) = (moved_on + moved_back, half_on + half_back);
        Swing {
            acceleration: (even_half * 16.0 - even) / (3.0 * w * w),
            jerk: (moved_on - moved_back) * (3.0 / (w * w * w)),
            snap: (even - even_half * 4.0) * (16.0 / (w * w * w * w)),
            spin: (on - back) / (2.0 * w),
            spin_rate: (on + back) / (w * w),
            jolt,
            jolt_after,
            force: (later.momentum - earlier.momentum) / (2.0 * w),
        }
    }
}

/// Time for which the jump at `after` has acted at `s`, less that at s = 0: so there is no turn at 0.
fn jolted(s: f64, after: f64) -> f64 {
    (s - after).max(0.0) - (-after).max(0.0)
}

/// The largest turn that is used, in radians. The polynomials below are right to 1.3 % there and to 1e-7 at half a radian.
const FARTHEST_TURN: f32 = 2.0;

/// Offset of a point of a body (model's unit, body axes) from the body's centre at T₀, `s` r_s/c later, on the slice, in r_s and rain axes.
/// Twin of the function of the same name in shaders/instances/swing.wgsl.
pub fn swing_at(instance: &Instance, body: Vec3, s: f32) -> Vec3 {
    let xyz = |row: [f32; 4]| Vec3::new(row[0], row[1], row[2]);
    let columns = |m: [[f32; 4]; 3]| xyz(m[0]) * body.x + xyz(m[1]) * body.y + xyz(m[2]) * body.z;
    let last = |m: [[f32; 4]; 3]| Vec3::new(m[0][3], m[1][3], m[2][3]);
    let scale = instance.velocity[3];
    if scale == 0.0 {
        return columns(instance.shape);
    }
    let jolted = (s - instance.jolt[3]).max(0.0) - (-instance.jolt[3]).max(0.0);
    let turned = (xyz(instance.spin) + xyz(instance.spin_rate) * (0.5 * s)) * s + xyz(instance.jolt) * jolted;
    let turned = turned * (FARTHEST_TURN / turned.length().max(FARTHEST_TURN));
    let q = turned.length_squared();
    let rest = columns(instance.turn) * scale;
    // Rodrigues: sin θ / θ and (1 − cos θ) / θ² as polynomials in θ².
    let once = turned.cross(rest);
    let rest = rest + once * (1.0 - q * (1.0 / 6.0 - q / 120.0)) + turned.cross(once) * (0.5 - q * (1.0 / 24.0 - q / 720.0));
    let p = Vec3::new(instance.spin[3], instance.spin_rate[3], instance.force[3]) + xyz(instance.force) * s;
    let gamma = (1.0 + p.length_squared()).sqrt();
    let contracted = rest - p * (p.dot(rest) / (gamma * (1.0 + gamma)));
    let jerk = last(instance.turn) + xyz(instance.snap) * (0.25 * s);
    contracted + (xyz(instance.velocity) + (last(instance.shape) + jerk * (s / 3.0)) * (0.5 * s)) * s
}
