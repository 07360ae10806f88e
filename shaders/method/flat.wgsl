#define_import_path lensrunner::method::flat

// Method "flat": no hole. Light is straight, its travel time the distance, the frame of every direction the one at rest.

#import lensrunner::gpu::bindings::frame
#import lensrunner::lensing::lookup::LensRay

/// Triangles are cut at the axis and subdivided, none is dropped.
const METHOD_FILTERS: bool = false;

fn method_ray(along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    let distance = sqrt(along * along + across * across);
    let r = sqrt(height * height + across * across);
    let inverse = 1.0 / max(distance, 1e-20);
    // Cosine of the angle at the point between the outward radial and the line of sight away from the camera.
    let outward = (along * height + across * across) * inverse / max(r, 1e-20);
    let sweeping = frame.camera_radius * across * inverse / max(r, 1e-20);
    return LensRay(along * inverse, across * inverse, distance, 1.0, -outward, sweeping, 1.0, 0.0, 0.0, 1.0, order == 1u && distance > 0.0);
}
