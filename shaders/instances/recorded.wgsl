#define_import_path lensrunner::instances::recorded

// Worldlines of the points of a body that was flown: its attitude, and where its centre and its momentum were beside a smooth way, are read
// from nodes of what was recorded. They lie behind the instances in their table, three texels each: the attitude; what to add to the smooth
// way (xyz); what to add to the smooth momentum (xyz).

#import lensrunner::gpu::types::{Instance, INSTANCE_STRAYS}
#import lensrunner::instances::instance::{instance_row, shaped}
#import lensrunner::instances::local_motion::{carried, MovedPoint, turned_by}

/// Texels of a node.
const NODE_TEXELS: u32 = 3u;

/// The interval between two nodes that a time lies in, and the share of the way through it.
struct NodePlace {
    index: u32,
    share: f32,
    /// 1 within the nodes, 0 before the first and after the last: there nothing turns.
    inside: f32,
}

fn node_place(instance: Instance, s: f32) -> NodePlace {
    let last = instance.node_intervals;
    let at = (s - instance.first_node) * instance.nodes_per_time;
    let x = clamp(at, 0.0, last);
    let index = min(floor(x), last - 1.0);
    return NodePlace(u32(index), x - index, select(0.0, 1.0, at == x));
}

/// The body point `s` after T₀, between two nodes: their attitudes, and how far they and their momenta are beside the smooth ones. Twin of
/// the function of the same name in src/render/instances/local_motion.rs.
fn local_motion_between(instance: Instance, body: vec3<f32>, s: f32, place: NodePlace, turns: mat2x4<f32>, asides: mat2x3<f32>,
    pushes: mat2x3<f32>) -> MovedPoint {
    let mean = mix(turns[0], turns[1], place.share);
    let length_squared = dot(mean, mean);
    let q = mean * inverseSqrt(length_squared);
    let rest = turned_by(q, body * instance.scale);
    // Twice the vector part of q' q*, q' being the rate of the quaternion.
    let change = turns[1] - turns[0];
    let rate = 2.0 * (change.xyz * mean.w - mean.xyz * change.w - cross(change.xyz, mean.xyz)) / length_squared;
    let per_time = instance.nodes_per_time * place.inside;
    var moved = carried(instance, rest, cross(rate, rest) * per_time, s, mix(pushes[0], pushes[1], place.share));
    moved.offset += mix(asides[0], asides[1], place.share);
    moved.velocity += (asides[1] - asides[0]) * per_time;
    moved.attitude = q;
    return moved;
}

/// The body point `s` after the emission time T₀ of the centre.
fn local_motion_at(instance: Instance, body: vec3<f32>, s: f32) -> MovedPoint {
    if instance.scale == 0.0 {
        return MovedPoint(shaped(instance, body), vec3<f32>(0.0), vec4<f32>(0.0));
    }
    let place = node_place(instance, s);
    let first = instance.node_texel + NODE_TEXELS * place.index;
    let turns = mat2x4<f32>(instance_row(first), instance_row(first + NODE_TEXELS));
    var asides = mat2x3<f32>();
    var pushes = mat2x3<f32>();
    // Most bodies keep to the smooth way.
    if (instance.flags & INSTANCE_STRAYS) != 0u {
        asides = mat2x3<f32>(instance_row(first + 1u).xyz, instance_row(first + NODE_TEXELS + 1u).xyz);
        pushes = mat2x3<f32>(instance_row(first + 2u).xyz, instance_row(first + NODE_TEXELS + 2u).xyz);
    }
    return local_motion_between(instance, body, s, place, turns, asides, pushes);
}

/// First guess of the emission time of a point, after T₀: nearly that of the centre.
fn first_guess(instance: Instance, body: vec3<f32>) -> f32 {
    return 0.0;
}

/// A direction in which light leaves the body (rest frame, rain axes), turned back to the attitude at T₀; `delay` is the light's path.
fn before_turning(instance: Instance, leaving: vec3<f32>, delay: f32) -> vec3<f32> {
    return leaving - cross(instance.spin * (instance.delay - delay), leaving);
}

/// By how much the sine of light against a surface may be off what `before_turning` tells: for uneven turns, and for the surface's own
/// speed.
fn turning_slack(instance: Instance) -> f32 {
    return instance.spin_slack;
}

/// Whether an edge inside the surface may be an outline of its image.
const MAY_FOLD: bool = true;

/// Whether the surface ends at an edge of the model, which has one triangle (`alone`) and runs from `a` to `b`.
fn is_rim(instance: Instance, alone: bool, a: vec3<f32>, b: vec3<f32>) -> bool {
    return alone;
}

/// Whether slivers are not split any more from some depth on. Not here: pixels beside them would be missed, where a neighbour has more
/// segments.
const KEEPS_SLIVERS: bool = false;
