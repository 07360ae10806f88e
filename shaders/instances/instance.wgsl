#define_import_path lensrunner::instances::instance

// Instances, read from their table. What a pass does not use of one is not fetched.

#import lensrunner::gpu::bindings::TABLE_ROW
#import lensrunner::gpu::types::Instance

@group(#{DATA_GROUP}) @binding(0) var instances: texture_2d<u32>;

/// Texels of an instance.
const INSTANCE_TEXELS: u32 = 25u;

/// Texel k of instance `index`, bits of u32 or f32.
fn instance_words(index: u32, k: u32) -> vec4<u32> {
    let texel = index * INSTANCE_TEXELS + k;
    return textureLoad(instances, vec2<u32>(texel % TABLE_ROW, texel / TABLE_ROW), 0);
}

fn instance_numbers(index: u32, k: u32) -> vec4<f32> {
    return bitcast<vec4<f32>>(instance_words(index, k));
}

/// A texel of the table.
fn instance_row(texel: u32) -> vec4<f32> {
    return instance_numbers(0u, texel);
}

fn instance_at(i: u32) -> Instance {
    return Instance(
        instance_numbers(i, 0u), instance_numbers(i, 1u), instance_numbers(i, 2u), instance_numbers(i, 3u),
        instance_numbers(i, 4u), instance_numbers(i, 5u), instance_numbers(i, 6u),
        instance_numbers(i, 7u), instance_numbers(i, 8u), instance_numbers(i, 9u), instance_numbers(i, 10u),
        instance_numbers(i, 11u), instance_numbers(i, 12u), instance_numbers(i, 13u),
        instance_numbers(i, 14u), instance_numbers(i, 15u), instance_numbers(i, 16u), instance_numbers(i, 17u),
        instance_numbers(i, 18u), instance_numbers(i, 19u), instance_numbers(i, 20u), instance_numbers(i, 21u),
        instance_words(i, 22u), instance_words(i, 23u), instance_words(i, 24u));
}

/// A direction in body axes, in rain axes at T₀.
fn normal_of(instance: Instance, normal: vec3<f32>) -> vec3<f32> {
    return instance.turn_x.xyz * normal.x + instance.turn_y.xyz * normal.y + instance.turn_z.xyz * normal.z;
}

/// The inverse of `normal_of`.
fn in_body_axes(instance: Instance, v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(instance.turn_x.xyz, v), dot(instance.turn_y.xyz, v), dot(instance.turn_z.xyz, v));
}

/// A body offset on the slice at T₀.
fn shaped(instance: Instance, body: vec3<f32>) -> vec3<f32> {
    return instance.shape_x.xyz * body.x + instance.shape_y.xyz * body.y + instance.shape_z.xyz * body.z;
}
