#define_import_path lensrunner_lab::aurora::eye

// The camera of the aurora's experiment in flat space.

#import lensrunner::gpu::bindings::frame

/// The apparent place of a point, camera axes (right, up, back).
fn apparent(point: vec3<f32>) -> vec3<f32> {
    let offset = point - frame.origin.xyz;
    return frame.axes[0].xyz * offset.x + frame.axes[1].xyz * offset.y + frame.axes[2].xyz * offset.z;
}
