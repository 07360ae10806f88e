#define_import_path lensrunner::instances::instance

// Instances, read from their table. What a pass does not use of one is not fetched.

#import lensrunner::gpu::bindings::TABLE_ROW
#import lensrunner::gpu::types::{Cap, Instance}

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
    let offset = instance_numbers(i, 0u);
    let position = instance_numbers(i, 1u);
    let velocity = instance_numbers(i, 2u);
    let acceleration = instance_numbers(i, 3u);
    let jerk = instance_numbers(i, 4u);
    let snap = instance_numbers(i, 5u);
    let momentum = instance_numbers(i, 6u);
    let contraction = instance_numbers(i, 7u);
    let force = instance_numbers(i, 8u);
    let spin = instance_numbers(i, 9u);
    let shape_x = instance_numbers(i, 10u);
    let shape_y = instance_numbers(i, 11u);
    let shape_z = instance_numbers(i, 12u);
    let turn_x = instance_numbers(i, 13u);
    let turn_y = instance_numbers(i, 14u);
    let turn_z = instance_numbers(i, 15u);
    let bound_high = instance_numbers(i, 19u);
    let bound_low = instance_numbers(i, 20u);
    let bound_look = instance_numbers(i, 21u);
    let ids = instance_words(i, 22u);
    let counts = instance_words(i, 23u);
    let materials = instance_words(i, 24u);
    return Instance(
        offset.xyz, offset.w, position.xyz, position.w, velocity.xyz, velocity.w, acceleration.xyz, acceleration.w,
        jerk.xyz, jerk.w, snap.xyz, snap.w, momentum.xyz, momentum.w, contraction.xyz, contraction.w,
        force.xyz, force.w, spin.xyz, spin.w, shape_x.xyz, shape_x.w, shape_y.xyz, shape_y.w,
        shape_z.xyz, shape_z.w, turn_x.xyz, turn_x.w, turn_y.xyz, bitcast<u32>(turn_y.w), turn_z.xyz, turn_z.w,
        instance_numbers(i, 16u), instance_numbers(i, 17u), instance_numbers(i, 18u), Cap(bound_high.xyz, bound_high.w),
        Cap(bound_low.xyz, bound_low.w), Cap(bound_look.xyz, bound_look.w), ids.x, ids.y, ids.z, ids.w, counts.x, counts.y, counts.z, counts.w,
        materials.x, materials.y, materials.z, materials.w);
}

/// A direction in body axes, in rain axes at T₀.
fn normal_of(instance: Instance, normal: vec3<f32>) -> vec3<f32> {
    return instance.turn_x * normal.x + instance.turn_y * normal.y + instance.turn_z * normal.z;
}

/// The inverse of `normal_of`.
fn in_body_axes(instance: Instance, v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(instance.turn_x, v), dot(instance.turn_y, v), dot(instance.turn_z, v));
}

/// A body offset on the slice at T₀.
fn shaped(instance: Instance, body: vec3<f32>) -> vec3<f32> {
    return instance.shape_x * body.x + instance.shape_y * body.y + instance.shape_z * body.z;
}
