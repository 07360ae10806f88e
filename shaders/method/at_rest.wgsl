#define_import_path lensrunner::method::at_rest

// What is held in place where there is no hole: it is at rest.

fn held_momentum(position: vec3<f32>) -> vec4<f32> {
    return vec4<f32>(0.0, 0.0, 0.0, 1.0);
}
