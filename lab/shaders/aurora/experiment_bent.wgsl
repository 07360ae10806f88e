#define_import_path lensrunner_lab::aurora::eye

// The camera of the aurora's experiment near a hole: each point goes through the lensing table.

#import lensrunner::gpu::bindings::frame
#import lensrunner::lensing::lookup::lens_lookup

/// The apparent place of a point, camera axes (right, up, back): direction times light path. Far behind the camera where there is no ray.
fn apparent(point: vec3<f32>) -> vec3<f32> {
    let offset = frame.origin.xyz + frame.place[0].xyz * point.x + frame.place[1].xyz * point.y + frame.place[2].xyz * point.z;
    let across = length(offset.xy);
    let order = u32(frame.origin.w);
    // As lab/src/aurora/eye.rs does: the height above the hole's plane has no part in it.
    let ray = lens_lookup(offset.z, across, order);
    let side = select(vec2<f32>(1.0, 0.0), offset.xy / max(across, 1e-30), across > 0.0) * select(1.0, -1.0, order == 2u);
    let seen = vec3<f32>(side * ray.sin_psi, ray.cos_psi) * ray.delay;
    let place = frame.axes[0].xyz * seen.x + frame.axes[1].xyz * seen.y + frame.axes[2].xyz * seen.z;
    return select(vec3<f32>(0.0, 0.0, 1e9), place, ray.valid);
}
