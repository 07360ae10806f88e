// The rasteriser's part: opaque triangles with depth, then thin ones, summed with their coverage.

#import lensrunner::geometry::clip::clip_position
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::{FLAG_INSIDE, INSTANCE_OWN, SeenVertex}
#import lensrunner::instances::instance::instance_at
#import lensrunner::post_process::coverage::coverage_sign
#import lensrunner::shading::bindings::seen
#import lensrunner::shading::shade::{shaded, Surface, surface_of, texture_place}

/// `SeenVertex` from the vertex buffer.
struct SeenInput {
    @location(0) apparent: vec3<f32>,
    @location(1) path: f32,
    @location(2) normal: vec3<f32>,
    @location(3) shift: f32,
    @location(4) leaving: vec3<f32>,
    @location(5) radius: f32,
    @location(6) uv: vec2<f32>,
    @location(7) instance: u32,
    @location(8) material: u32,
    @location(9) axis_uv: vec2<f32>,
    @location(10) from_axis: f32,
    @location(11) height: f32,
}

@vertex
fn opaque_vertex(in: SeenInput) -> Surface {
    let vertex = SeenVertex(in.apparent, in.path, in.normal, in.shift, in.leaving, in.radius, in.uv, in.instance, in.material, in.axis_uv,
        in.from_axis, in.height);
    return surface_of(vertex, clip_position(vertex.apparent), vec2<f32>(1.0, 0.0));
}

@fragment
fn opaque_fragment(in: Surface) -> @location(0) vec4<f32> {
    if hidden(in) {
        discard;
    }
    return vec4<f32>(shaded(in), 1.0);
}

/// The player's own ship alone, as a mask: all else is drawn as a point off the screen.
@vertex
fn own_vertex(in: SeenInput) -> @builtin(position) vec4<f32> {
    let is_own = (instance_at(in.instance).flags & INSTANCE_OWN) != 0u;
    return select(vec4<f32>(2.0, 2.0, 2.0, 1.0), clip_position(in.apparent), is_own);
}

@fragment
fn own_fragment() -> @location(0) vec4<f32> {
    return vec4<f32>(1.0);
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

/// `ThinVertex` from the vertex buffer.
struct ThinInput {
    @location(0) position: vec4<f32>,
    @location(1) vertex: u32,
    @location(2) coverage: f32,
    @location(3) order: u32,
    @location(4) across: f32,
}

@vertex
fn thin_vertex(in: ThinInput) -> Surface {
    return thin_surface(in, vec2<f32>(1.0, 0.0));
}

/// For comparing pictures: nothing thin is taken for an opaque triangle, whose coverage is 1.
@vertex
fn thin_layers_vertex(in: ThinInput) -> Surface {
    var surface = thin_surface(in, vec2<f32>(1.0, 0.0));
    surface.coverage.x = min(surface.coverage.x, MOST_THIN);
    return surface;
}

const MOST_THIN: f32 = 0.99;

fn thin_surface(in: ThinInput, shares: vec2<f32>) -> Surface {
    return surface_of(seen[in.vertex], in.position, in.coverage * shares);
}

/// The coverage of those parts of the triangle whose light crosses the disk's plane `crossings` times; and that of the parts of the same
/// image whose light crosses it once less. Triangles of both have been listed (geometry/thin_lists.wgsl).
fn thin_across(in: ThinInput, crossings: u32) -> Surface {
    let share = in.across;
    return thin_surface(in, select(vec2<f32>(1.0 - share, 0.0), vec2<f32>(share, 1.0 - share), crossings == in.order));
}

@vertex
fn thin_vertex_uncrossed(in: ThinInput) -> Surface {
    return thin_across(in, 0u);
}

@vertex
fn thin_vertex_once(in: ThinInput) -> Surface {
    return thin_across(in, 1u);
}

@vertex
fn thin_vertex_twice(in: ThinInput) -> Surface {
    return thin_across(in, 2u);
}

@vertex
fn thin_vertex_thrice(in: ThinInput) -> Surface {
    return thin_across(in, 3u);
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
