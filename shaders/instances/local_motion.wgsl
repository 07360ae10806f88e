#define_import_path lensrunner::instances::local_motion

// What the worldlines of bodies have in common: the centre's way, and the contraction by its momentum.

#import lensrunner::gpu::types::Instance

/// A point of a body, some time after the emission time T₀ of its centre.
struct MovedPoint {
    /// From the centre at T₀, on the slice, in r_s and rain axes.
    offset: vec3<f32>,
    /// dx/dT, in c.
    velocity: vec3<f32>,
    /// Quaternion from body axes to rain axes; 0 where they are as at T₀.
    attitude: vec4<f32>,
}

/// The point that lies at `rest` (r_s, rain axes, rest frame) from the centre, `s` after T₀, and moves with `turning` (c) round it:
/// contracted by the momentum of that moment, which is `pushed` beside one that grows evenly, and carried along with the centre to fourth
/// order.
fn carried(instance: Instance, rest: vec3<f32>, turning: vec3<f32>, s: f32, pushed: vec3<f32>) -> MovedPoint {
    let way = (instance.velocity + (instance.acceleration + (instance.jerk + instance.snap * (0.25 * s)) * (s / 3.0)) * (0.5 * s)) * s;
    let velocity = instance.velocity + (instance.acceleration + (instance.jerk + instance.snap * (s / 3.0)) * (0.5 * s)) * s;
    let p = instance.contraction + instance.force * s + pushed;
    let gamma = sqrt(1.0 + dot(p, p));
    let shorter = 1.0 / (gamma * (1.0 + gamma));
    return MovedPoint(way + rest - p * (dot(p, rest) * shorter), velocity + turning - p * (dot(p, turning) * shorter), vec4<f32>(0.0));
}

/// A vector turned by a unit quaternion.
fn turned_by(q: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    let once = 2.0 * cross(q.xyz, v);
    return v + q.w * once + cross(q.xyz, once);
}
