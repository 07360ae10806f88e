#define_import_path lensrunner::method::at_rest

// Static bodies where there is no hole: they are at rest.

fn static_body_momentum(position: vec3<f32>) -> vec4<f32> {
    return vec4<f32>(0.0, 0.0, 0.0, 1.0);
}
