#define_import_path lensrunner::method::paper1

// Method "paper1-128": the tables of Yamashita 2012 as its author used them. ψ in the static frame, linear between nodes on the meshes of
// its equations 3 to 7, one table for points nearer than the camera and one for those beyond; triangles are drawn as they are, and dropped
// where the hole makes them more than nine times as large (its section 4.3). Outside the horizon and for two orders only.

#import lensrunner::lensing::closed_form::{finite, log1p, source_point}
#import lensrunner::lensing::lookup::{LensRay, no_ray}
#import lensrunner::lensing::slice::{HEADER, lens_camera, lens_texel}
#import lensrunner::lensing::static_ray::static_ray

/// Triangles are filtered by area instead of being cut at the axis and subdivided.
const METHOD_FILTERS: bool = true;

/// Place on a mesh of n nodes, F[A, a, b] of section 4.2 there: node and fraction.
fn paper_cell(mesh: vec4<f32>, x: f32, n: f32) -> vec2<f32> {
    let share = (x - mesh.y) / max(mesh.z - mesh.y, 1e-30);
    var z = share;
    if mesh.x != 0.0 {
        z = log1p(share * (exp(mesh.x) - 1.0)) / mesh.x;
    }
    let p = clamp(z, 0.0, 1.0) * (n - 1.0);
    let i = min(floor(p), n - 2.0);
    return vec2<f32>(i, p - i);
}

fn method_ray(along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    let cam = lens_camera();
    let at = source_point(cam, along, across, height);
    if !(finite(at.r) && finite(at.dr) && at.lapse_squared > 0.0 && cam.lapse_squared > 0.0 && order <= 2u) {
        return no_ray();
    }
    let inner = at.dr <= 0.0;
    let n = f32(cam.nx);
    let meshes = HEADER + select(2u, 0u, inner);
    let cr = paper_cell(lens_texel(meshes), at.r, n);
    let cp = paper_cell(lens_texel(meshes + 1u), at.phi, n);
    let first = HEADER + 4u + 2u * (u32(cp.x) * cam.nx + u32(cr.x)) + select(1u, 0u, inner);
    let low = mix(lens_texel(first), lens_texel(first + 2u), vec4<f32>(cr.y));
    let high = mix(lens_texel(first + 2u * cam.nx), lens_texel(first + 2u * cam.nx + 2u), vec4<f32>(cr.y));
    let both = mix(low, high, vec4<f32>(cp.y));
    let found = select(both.zw, both.xy, order == 1u);
    return static_ray(cam, at, order, found.x, found.y);
}
