#define_import_path lensrunner::instances::bounds

// The guard: no triangle of an object is drawn outside of where the image of its ball can be, whatever went wrong before.

#import lensrunner::geometry::bindings::{counters, seen}
#import lensrunner::gpu::types::{Cap, Instance}

/// Whether a triangle of three seen vertices leaves one of the instance's caps, or enters one that it must keep out of. If so it is
/// counted.
fn leaves_bounds(instance: Instance, i0: u32, i1: u32, i2: u32) -> bool {
    if instance.bound_high.rim == 0.0 && instance.bound_low.rim == 0.0 && instance.bound_look.rim == 0.0 {
        return false;
    }
    let a = normalize(seen[i0].apparent);
    let b = normalize(seen[i1].apparent);
    let c = normalize(seen[i2].apparent);
    let leaves = leaves_cap(instance.bound_high, a, b, c) || leaves_cap(instance.bound_low, a, b, c)
        || leaves_cap(instance.bound_look, a, b, c);
    if leaves {
        atomicAdd(&counters.outside, 1u);
    }
    return leaves;
}

/// The same for one cap, as `Bounds` of Rust. A cap is convex: a triangle whose corners are in it is in it. To be outside of a cap the
/// nearest point of the triangle must be outside.
fn leaves_cap(cap: Cap, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> bool {
    if cap.rim == 0.0 {
        return false;
    }
    let middle = cap.middle;
    let chords = vec3<f32>(square(a - middle), square(b - middle), square(c - middle));
    if cap.rim > 0.0 {
        return max(chords.x, max(chords.y, chords.z)) > cap.rim;
    }
    let corners = min(chords.x, min(chords.y, chords.z));
    let sides = min(nearest_on_side(middle, a, b), min(nearest_on_side(middle, b, c), nearest_on_side(middle, c, a)));
    let normals = mat3x3<f32>(side_normal(a, b), side_normal(b, c), side_normal(c, a));
    let turns = middle * normals;
    let least = UNSURE * vec3<f32>(length(normals[0]), length(normals[1]), length(normals[2]));
    let round = (all(turns > least) || all(turns < -least)) && dot(a + b + c, middle) > 0.0;
    return round || min(corners, sides) < -cap.rim;
}

/// A direction nearer to a great circle than this, in radians, may by rounding be on either side: f32 has 1e-7, and no cap is that small.
const UNSURE: f32 = 1e-5;

/// The normal of the great circle from a to b, as long as the sine between them. By the difference, which is exact for near directions: a
/// driver that fuses products gives cross(a, a) the direction of its rounding.
fn side_normal(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return cross(a, b - a);
}

fn square(v: vec3<f32>) -> f32 {
    return dot(v, v);
}

/// The square of the chord from a direction to the nearest inner point of the great circle's arc from a to b; 4, the largest value, if an
/// end is nearer.
fn nearest_on_side(middle: vec3<f32>, a: vec3<f32>, b: vec3<f32>) -> f32 {
    let normal = side_normal(a, b);
    let foot = middle - normal * (dot(normal, middle) / max(dot(normal, normal), 1e-30));
    let between = dot(cross(a, foot), normal) > 0.0 && dot(cross(foot, b), normal) > 0.0;
    return select(4.0, square(foot / max(length(foot), 1e-20) - middle), between);
}
