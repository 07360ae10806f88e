// Lays the sum of the thin triangles over the picture, once: their mean colour, as far as they cover the pixel. In tiles, and only in those
// that have some.

#import lensrunner::post_process::coverage::{before_later, covered, overfull}
#import lensrunner::post_process::tiles::{tile_corner, tile_grid}

/// Those of geometry/thin_lists.wgsl.
@group(1) @binding(0) var<storage, read> tiles: array<u32>;
@group(2) @binding(0) var source: texture_2d<f32>;
@group(2) @binding(1) var signed_source: texture_2d<f32>;

/// A tile with thin triangles, before everything.
@vertex
fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) number: u32) -> @builtin(position) vec4<f32> {
    let grid = tile_grid();
    return vec4<f32>(tile_corner(tiles[grid.x * grid.y + number], i), 1.0, 1.0);
}

struct Nothing {
    @location(0) light: vec4<f32>,
    @location(1) coverages: vec2<f32>,
}

/// Before they are summed: nothing.
@fragment
fn wipe() -> Nothing {
    return Nothing(vec4<f32>(0.0), vec2<f32>(0.0));
}

@fragment
fn fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let sum = textureLoad(source, vec2<i32>(position.xy), 0);
    if sum.a <= 0.0 {
        discard;
    }
    let coverages = textureLoad(signed_source, vec2<i32>(position.xy), 0).rg;
    let part = covered(sum.a, coverages.x);
    let weight = before_later(part, coverages.y);
    // Triangles that fold over are taken off again, which rounding may overdo.
    let light = weight / sum.a * overfull(sum.a, coverages.x);
    return vec4<f32>(max(sum.rgb, vec3<f32>(0.0)) * light, weight);
}
