#define_import_path lensrunner::instances::ring

// Worldlines of the points of a ring that turns round the hole in the plane z = 0 (Yamashita 2025, section 2.1); used in place of
// instances/recorded.wgsl. Its own numbers lie in the table where a body has its nodes.

#import lensrunner::gpu::types::Instance
#import lensrunner::instances::instance::instance_row
#import lensrunner::instances::local_motion::MovedPoint

struct Ring {
    /// Radii of those rims of the disk that are this ring's, in r_s, or −1.
    inner: f32,
    outer: f32,
    /// dφ/dT, in rad per r_s/c.
    rate: f32,
    /// Azimuth at T₀ of what has azimuth 0 in the model, in rad.
    azimuth: f32,
}

fn ring_of(instance: Instance) -> Ring {
    let row = instance_row(instance.node_texel);
    return Ring(row.x, row.y, row.z, row.w);
}

/// The body point `s` after T₀; its offset is from the hole.
fn local_motion_at(instance: Instance, body: vec3<f32>, s: f32) -> MovedPoint {
    let ring = ring_of(instance);
    let angle = ring.azimuth + ring.rate * s;
    let c = cos(angle);
    let t = sin(angle);
    let position = vec3<f32>(c * body.x - t * body.y, t * body.x + c * body.y, 0.0);
    return MovedPoint(position, ring.rate * vec3<f32>(-position.y, position.x, 0.0), vec4<f32>(0.0));
}

/// First guess of the emission time of a point, after T₀: by straight light from where it was at T₀.
fn first_guess(instance: Instance, body: vec3<f32>) -> f32 {
    return instance.delay - length(instance.offset + local_motion_at(instance, body, 0.0).offset);
}

/// As for bodies; no image of a flat ring depends on it.
fn before_turning(instance: Instance, leaving: vec3<f32>, delay: f32) -> vec3<f32> {
    return leaving;
}

/// As for bodies.
fn turning_slack(instance: Instance) -> f32 {
    return 0.0;
}

/// Whether an edge inside the surface may be an outline of its image. Only light within the plane grazes a plane, so a flat ring has no
/// outline but its rims.
const MAY_FOLD: bool = false;

/// Whether the disk ends at an edge of the model, which has one triangle (`alone`) and runs from `a` to `b`: where one ring slides along
/// another the disk goes on.
fn is_rim(instance: Instance, alone: bool, a: vec3<f32>, b: vec3<f32>) -> bool {
    let radii = vec2<f32>(length(a.xy), length(b.xy));
    let ring = ring_of(instance);
    let at_inner = abs(radii - ring.inner) < vec2<f32>(1e-3 * radii.x);
    let at_outer = abs(radii - ring.outer) < vec2<f32>(1e-3 * radii.x);
    return alone && (all(at_inner) || all(at_outer));
}

/// Whether slivers are not split any more from some depth on. Seen from beside their plane turning rings consist of slivers, which would
/// fill the buffers.
const KEEPS_SLIVERS: bool = true;
