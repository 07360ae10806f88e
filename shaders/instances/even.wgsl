#define_import_path lensrunner::instances::even

// Worldlines of the points of a body that turns evenly, as a planet does; used in place of instances/recorded.wgsl.

#import lensrunner::gpu::types::Instance
#import lensrunner::instances::instance::{normal_of, shaped}
#import lensrunner::instances::local_motion::{carried, MovedPoint}

/// The largest turn that is used, in radians: the polynomials of `local_motion_at` are right to 1.3 % there and to 1e-7 at half a radian.
const FARTHEST_TURN: f32 = 2.0;

/// The body point `s` after the emission time T₀ of the centre.
fn local_motion_at(instance: Instance, body: vec3<f32>, s: f32) -> MovedPoint {
    let scale = instance.scale;
    if scale == 0.0 {
        return MovedPoint(shaped(instance, body), vec3<f32>(0.0), vec4<f32>(0.0));
    }
    let turn = instance.spin * s;
    let turned = turn * (FARTHEST_TURN / max(length(turn), FARTHEST_TURN));
    let q = dot(turned, turned);
    let straight = normal_of(instance, body) * scale;
    // Rodrigues: sin θ / θ and (1 − cos θ) / θ² as polynomials in θ².
    let once = cross(turned, straight);
    let rest = straight + once * (1.0 - q * (1.0 / 6.0 - q / 120.0)) + cross(turned, once) * (0.5 - q * (1.0 / 24.0 - q / 720.0));
    return carried(instance, rest, cross(instance.spin, rest), s, vec3<f32>(0.0));
}

/// First guess of the emission time of a point, after T₀: nearly that of the centre.
fn first_guess(instance: Instance, body: vec3<f32>) -> f32 {
    return 0.0;
}
