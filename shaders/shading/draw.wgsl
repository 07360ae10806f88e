// The rasteriser's part: opaque triangles with depth, then thin ones, summed with their coverage.

#import lensrunner::geometry::clip::clip_position
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::{FLAG_INSIDE, SeenVertex}
#import lensrunner::post_process::coverage::coverage_sign
#import lensrunner::shading::bindings::seen
#import lensrunner::shading::shade::{shaded, Surface, surface_of, texture_place}

/// `SeenVertex` from the vertex buffer; `surface` as bits, since two of its numbers are integers.
struct SeenInput {
    @location(0) apparent: vec4<f32>,
    @location(1) normal: vec4<f32>,
    @location(2) leaving: vec4<f32>,
    @location(3) surface: vec4<u32>,
    @location(4) fan: vec4<f32>,
}

@vertex
fn opaque_vertex(in: SeenInput) -> Surface {
    let vertex = SeenVertex(in.apparent, in.normal, in.leaving, bitcast<vec4<f32>>(in.surface), in.fan);
    return surface_of(vertex, clip_position(vertex.apparent.xyz), vec2<f32>(1.0, 0.0));
}

@fragment
fn opaque_fragment(in: Surface) -> @location(0) vec4<f32> {
    if hidden(in) {
        discard;
    }
    return vec4<f32>(shaded(in), 1.0);
}

struct Layers {
    /// Object id, image order, travel time and g.
    @location(0) what: vec4<f32>,
    /// Texture coordinates, coverage.
    @location(1) surface: vec4<f32>,
}

/// For comparing pictures.
@fragment
fn layers_fragment(in: Surface) -> Layers {
    if hidden(in) {
        discard;
    }
    return Layers(vec4<f32>(f32(in.which.x), f32(in.which.y), in.uv.z, in.normal.w), vec4<f32>(texture_place(in), in.coverage.x, 0.0));
}

/// `ThinVertex` from the vertex buffer; `data` as bits, since its first number is an integer.
struct ThinInput {
    @location(0) position: vec4<f32>,
    @location(1) data: vec4<u32>,
}

@vertex
fn thin_vertex(in: ThinInput) -> Surface {
    return thin_surface(in, vec2<f32>(1.0, 0.0));
}

fn thin_surface(in: ThinInput, shares: vec2<f32>) -> Surface {
    return surface_of(seen[in.data.x], in.position, bitcast<f32>(in.data.y) * shares);
}

/// The coverage of those parts of the triangle whose light crosses the disk's plane `crossings` times; and that of the parts of the same
/// image whose light crosses it once less. Triangles of both have been listed (geometry/thin_lists.wgsl).
fn thin_across(in: ThinInput, crossings: f32) -> Surface {
    let data = bitcast<vec4<f32>>(in.data);
    return thin_surface(in, select(vec2<f32>(1.0 - data.w, 0.0), vec2<f32>(data.w, 1.0 - data.w), crossings == data.z));
}

@vertex
fn thin_vertex_0(in: ThinInput) -> Surface {
    return thin_across(in, 0.0);
}

@vertex
fn thin_vertex_1(in: ThinInput) -> Surface {
    return thin_across(in, 1.0);
}

@vertex
fn thin_vertex_2(in: ThinInput) -> Surface {
    return thin_across(in, 2.0);
}

@vertex
fn thin_vertex_3(in: ThinInput) -> Surface {
    return thin_across(in, 3.0);
}

struct Thin {
    /// Colour times coverage, and coverage.
    @location(0) light: vec4<f32>,
    /// Coverage with the sign of its object; and the coverage of the nearer part of the same image.
    @location(1) coverages: vec2<f32>,
}

/// Everything is added, and the sum is laid over the picture once, so the order does not matter.
@fragment
fn thin_fragment(in: Surface) -> Thin {
    if hidden(in) {
        discard;
    }
    let covers = in.coverage.x;
    return Thin(vec4<f32>(shaded(in) * covers, covers), vec2<f32>(covers * coverage_sign(in.which.x), in.coverage.y));
}

/// Geometry inside the horizon is not seen from outside.
fn hidden(in: Surface) -> bool {
    return in.leaving.w < 1.0 && (frame.flags & FLAG_INSIDE) == 0u;
}
