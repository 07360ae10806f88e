#define_import_path lensrunner::instances::swing

// Worldlines of the points of a body that flies and turns as a whole.

#import lensrunner::gpu::types::Instance
#import lensrunner::instances::instance::{normal_of, shaped}

/// The largest turn that is used, in radians: the polynomials of `swing_at` are right to 1.3 % there and to 1e-7 at half a radian.
const FARTHEST_TURN: f32 = 2.0;

/// Offset of the body point from the centre at T₀, `s` after the emission time T₀ of that centre. It turns with the body, is contracted by
/// the momentum of that moment, and follows the centre to fourth order. Twin of src/render/instances/swing.rs.
fn swing_at(instance: Instance, body: vec3<f32>, s: f32) -> vec3<f32> {
    let scale = instance.velocity.w;
    if scale == 0.0 {
        return shaped(instance, body);
    }
    let jolted = max(s - instance.jolt.w, 0.0) - max(-instance.jolt.w, 0.0);
    let turn = (instance.spin.xyz + instance.spin_rate.xyz * (0.5 * s)) * s + instance.jolt.xyz * jolted;
    let turned = turn * (FARTHEST_TURN / max(length(turn), FARTHEST_TURN));
    let q = dot(turned, turned);
    let straight = normal_of(instance, body) * scale;
    // Rodrigues: sin θ / θ and (1 − cos θ) / θ² as polynomials in θ².
    let once = cross(turned, straight);
    let rest = straight + once * (1.0 - q * (1.0 / 6.0 - q / 120.0)) + cross(turned, once) * (0.5 - q * (1.0 / 24.0 - q / 720.0));
    let p = vec3<f32>(instance.spin.w, instance.spin_rate.w, instance.force.w) + instance.force.xyz * s;
    let gamma = sqrt(1.0 + dot(p, p));
    let contracted = rest - p * (dot(p, rest) / (gamma * (1.0 + gamma)));
    let acceleration = vec3<f32>(instance.shape_x.w, instance.shape_y.w, instance.shape_z.w);
    let jerk = vec3<f32>(instance.turn_x.w, instance.turn_y.w, instance.turn_z.w);
    return contracted + (instance.velocity.xyz + (acceleration + (jerk + instance.snap.xyz * (0.25 * s)) * (s / 3.0)) * (0.5 * s)) * s;
}

/// First guess of the emission time of a point, after T₀: nearly that of the centre.
fn first_guess(instance: Instance, body: vec3<f32>) -> f32 {
    return 0.0;
}

/// dx/dT of the matter at `position`: that of the centre, since a body turns slowly.
fn velocity_at(instance: Instance, position: vec3<f32>) -> vec3<f32> {
    return instance.velocity.xyz;
}

/// Whether an edge inside the surface may be an outline of its image.
const MAY_FOLD: bool = true;

/// Whether the surface ends at an edge of the model, which has one triangle (`alone`) and runs from `a` to `b`.
fn is_rim(instance: Instance, alone: bool, a: vec3<f32>, b: vec3<f32>) -> bool {
    return alone;
}

/// Whether slivers are not split any more from some depth on. Not here: pixels beside them would be missed, where a neighbour has more
/// segments.
const KEEPS_SLIVERS: bool = false;
