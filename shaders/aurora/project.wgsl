// First pass of the aurora. For each part of a curtain and each end of its chords, its middle and three points beside it go through the
// lensing lookup; nothing else does. One thread per end, pole and image order. In flat space apparent positions are linear in positions, so
// nothing is lost; through bent light a part is short enough, once the turn about the axis of hole and camera is taken apart.

#import lensrunner::aurora::streaks::{
    across_field, at_height, aurora, AURORA_BOTH_POLES, aurora_instances, chord_height, chords_of, GREEN, mean_wait, middle_of, RED,
    Reference, reference_capacity, references, segments,
}
#import lensrunner::geometry::clip::finite_vector
#import lensrunner::geometry::project::{body_input, project_point, side_towards}
#import lensrunner::gpu::bindings::frame

/// Distance of the points beside it, in km: large against the rounding of the lookup, small against its bending.
const ASIDE: f32 = 20.0;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let capacity = reference_capacity();
    let both = (aurora.flags & AURORA_BOTH_POLES) != 0u;
    let poles = select(1u, 2u, both);
    let number = id.x / capacity;
    let segment_index = number / poles;
    if segment_index >= aurora.segments {
        return;
    }
    let south = number % poles == 1u;
    let red = id.x % capacity > aurora.chords;
    let kind = select(GREEN, RED, red);
    let end = id.x % capacity - select(0u, aurora.chords + 1u, red);
    let height = chord_height(kind, end, chords_of(kind));
    let segment = segments[segment_index];
    let middle = middle_of(segment, aurora.ahead + mean_wait(kind, height));
    let body = at_height(middle, height, south);
    let axes = across_field(body);

    let instance = aurora_instances[id.y];
    let order = instance.order;
    var seen: vec3<f32>;
    var left: array<vec3<f32>, 4>;
    var arriving: array<vec3<f32>, 4>;
    var valid = true;
    for (var k = 0u; k < 4u; k++) {
        let aside = select(select(select(vec3<f32>(0.0), axes[0], k == 1u), axes[1], k == 2u), axes[2], k == 3u) * ASIDE;
        let found = project_point(instance, body_input(body + aside), order);
        seen = select(seen, found.ray.apparent, k == 0u);
        left[k] = found.by_axis;
        // The direction from which it comes, times its path.
        let towards = found.ray.arriving.xyz * (-found.ray.delay / found.ray.arriving.w);
        let side = side_towards(found.by_axis.xy);
        arriving[k] = vec3<f32>(dot(towards, frame.outward), dot(towards, side), found.ray.delay);
        valid = valid && found.ray.valid && finite_vector(found.ray.apparent) && finite_vector(arriving[k]);
    }
    // The change of `arriving` in the two coordinates that it depends on: least squares of the three differences.
    var squares = vec3<f32>(0.0);
    var across_sum = vec3<f32>(0.0);
    var along_sum = vec3<f32>(0.0);
    for (var k = 1u; k < 4u; k++) {
        let step = vec2<f32>(length(left[k].xy) - length(left[0].xy), left[k].z - left[0].z);
        let change = arriving[k] - arriving[0];
        squares += vec3<f32>(step.x * step.x, step.x * step.y, step.y * step.y);
        across_sum += change * step.x;
        along_sum += change * step.y;
    }
    let determinant = max(squares.x * squares.z - squares.y * squares.y, 1e-30);
    var reference: Reference;
    reference.body = body;
    reference.is_seen = select(0u, 1u, valid);
    reference.apparent = seen;
    reference.left = left[0];
    reference.east = (left[1] - left[0]) / ASIDE;
    reference.north = (left[2] - left[0]) / ASIDE;
    reference.up = (left[3] - left[0]) / ASIDE;
    reference.arriving = arriving[0];
    reference.by_across = (across_sum * squares.z - along_sum * squares.y) / determinant;
    reference.by_along = (along_sum * squares.x - across_sum * squares.y) / determinant;
    references[id.y * aurora.segments * poles * capacity + id.x] = reference;
}
