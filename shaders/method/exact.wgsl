#define_import_path lensrunner::method::exact

// Method "exact": the closed form of the ray by elliptic functions, solved for each vertex in f32. No table.

#import lensrunner::lensing::closed_form::source_point
#import lensrunner::lensing::exact::exact_ray
#import lensrunner::lensing::lookup::{LensRay, lookup, SEES_INSIDE, swept}
#import lensrunner::lensing::slice::lens_camera

/// Triangles are cut at the axis and subdivided, none is dropped.
const METHOD_FILTERS: bool = false;

fn method_ray(along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    let cam = lens_camera();
    let at = source_point(cam, along, across, height);
    if SEES_INSIDE && at.lapse_squared <= 0.0 {
        return lookup(cam, at, swept(at, order), elapsed);
    }
    return exact_ray(cam, at, swept(at, order));
}
