// The rasteriser's part: opaque triangles with depth, then thin ones, summed with their coverage.

#import lensrunner::geometry::clip::clip_position
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::{FLAG_INSIDE, SeenVertex}
#import lensrunner::post_process::coverage::coverage_sign
#import lensrunner::shading::bindings::{seen, thin}
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

@vertex
fn thin_vertex(@builtin(vertex_index) index: u32) -> Surface {
    return thin_surface(index, vec2<f32>(1.0, 0.0));
}

fn thin_surface(index: u32, shares: vec2<f32>) -> Surface {
    let corner = thin[index];
    return surface_of(seen[bitcast<u32>(corner.data.x)], corner.position, corner.data.y * shares);
}

/// The coverage of those parts of the triangle whose light crosses the disk's plane `crossings` times; and that of the parts of the same
/// image whose light crosses it once less.
fn thin_across(index: u32, crossings: f32) -> Surface {
    let data = thin[index].data;
    var shares = vec2<f32>(0.0);
    if crossings == data.z { shares = vec2<f32>(data.w, 1.0 - data.w); }
    if crossings == data.z - 1.0 { shares.x = 1.0 - data.w; }
    if all(shares == vec2<f32>(0.0)) {
        // All three corners at one point, in front of the nearest depth.
        var nothing: Surface;
        nothing.position = vec4<f32>(0.0, 0.0, 2.0, 1.0);
        return nothing;
    }
    return thin_surface(index, shares);
}

@vertex
fn thin_vertex_0(@builtin(vertex_index) index: u32) -> Surface {
    return thin_across(index, 0.0);
}

@vertex
fn thin_vertex_1(@builtin(vertex_index) index: u32) -> Surface {
    return thin_across(index, 1.0);
}

@vertex
fn thin_vertex_2(@builtin(vertex_index) index: u32) -> Surface {
    return thin_across(index, 2.0);
}

@vertex
fn thin_vertex_3(@builtin(vertex_index) index: u32) -> Surface {
    return thin_across(index, 3.0);
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
    return in.leaving.w < 1.0 && (frame.switches.x & FLAG_INSIDE) == 0u;
}
