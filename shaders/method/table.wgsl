#define_import_path lensrunner::method::table

// Method "table": the residual table, with the closed form where camera and point are both inside the horizon.

#import lensrunner::lensing::lookup::{lens_lookup_aged, LensRay}

/// Triangles are cut at the axis and subdivided, none is dropped.
const METHOD_FILTERS: bool = false;

fn method_ray(along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    return lens_lookup_aged(along, across, height, order, elapsed);
}
