// First pass of the aurora. For each part of a curtain and each end of its chords, its middle and three points beside it go through the
// lensing lookup; nothing else does. One thread per end, pole and image order. In flat space apparent positions are linear in positions, so
// nothing is lost; through bent light a part is short enough.

#import lensrunner::aurora::streaks::{
    across_field, at_height, aurora, AURORA_BOTH_POLES, aurora_instances, chord_height, chords_of, GREEN, mean_wait, middle_of, RED,
    Reference, reference_room, references, segments,
}
#import lensrunner::geometry::clip::finite_vector
#import lensrunner::geometry::project::{answer, query_body}

/// Distance of the points beside it, in km: large against the rounding of the lookup, small against its bending.
const ASIDE: f32 = 20.0;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let room = reference_room();
    let both = (aurora.history.w & AURORA_BOTH_POLES) != 0u;
    let poles = select(1u, 2u, both);
    let number = id.x / room;
    let segment_index = number / poles;
    if segment_index >= aurora.history.y {
        return;
    }
    let south = number % poles == 1u;
    let red = id.x % room > aurora.counts.y;
    let kind = select(GREEN, RED, red);
    let end = id.x % room - select(0u, aurora.counts.y + 1u, red);
    let height = chord_height(kind, end, chords_of(kind));
    let segment = segments[segment_index];
    let middle = middle_of(segment, aurora.clock.y + mean_wait(kind, height));
    let body = at_height(middle, height, south);
    let axes = across_field(body);

    let instance = aurora_instances[id.y];
    let order = instance.ids.x;
    var seen: array<vec3<f32>, 4>;
    var valid = true;
    for (var k = 0u; k < 4u; k++) {
        let aside = select(select(select(vec3<f32>(0.0), axes[0], k == 1u), axes[1], k == 2u), axes[2], k == 3u) * ASIDE;
        let found = answer(instance, query_body(body + aside), order);
        seen[k] = found.ray.apparent;
        valid = valid && found.ray.valid && finite_vector(found.ray.apparent);
    }
    var reference: Reference;
    reference.apparent = vec4<f32>(seen[0], select(0.0, 1.0, valid));
    reference.east = vec4<f32>((seen[1] - seen[0]) / ASIDE, body.x);
    reference.north = vec4<f32>((seen[2] - seen[0]) / ASIDE, body.y);
    reference.up = vec4<f32>((seen[3] - seen[0]) / ASIDE, body.z);
    references[id.y * aurora.history.y * poles * room + id.x] = reference;
}
