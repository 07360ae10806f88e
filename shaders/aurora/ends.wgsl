// Second pass of the aurora: the ends of each streak's chords, from what was projected beside them. One thread per end and image order.

#import lensrunner::aurora::streaks::{
    across_field, at_height, aurora, between_nodes, chord_height, chord_room, ChordEnd, chords, chords_of, end_seen, first_reference,
    node_at, RED, Reference, references, segments, streak_of, waits,
}
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::random::{hash, unit}

/// Number of values of the rays' noise, a power of two. The time after which both its drifts have passed a multiple of them is in
/// animation.rs (RAYS_PERIOD), the length in motion.rs (RAYS_LENGTH).
const RAYS_CELLS: i32 = 512;

/// Smooth noise in [0, 1], of period RAYS_CELLS in x: the clock may start again without a jump.
fn ray_noise(x: f32, channel: u32) -> f32 {
    let cell = floor(x);
    let s = x - cell;
    let key = hash(channel);
    let a = unit(hash(key + u32(i32(cell) & (RAYS_CELLS - 1))));
    let b = unit(hash(key + u32((i32(cell) + 1) & (RAYS_CELLS - 1))));
    return mix(a, b, s * s * (3.0 - 2.0 * s));
}

/// Share of noise that is left at positions so many of its values apart: what is finer is replaced by its mean.
fn resolved(apart: f32) -> f32 {
    return 1.0 - smoothstep(1.0, 3.0, apart);
}

/// Rays: brightness at `along` km of the curtain at a time in s: noise of one and of three kilometres, drifting; seen at positions `apart`
/// km from one another.
fn rays(along: f32, time: f32, apart: f32) -> f32 {
    let fine = mix(0.5, ray_noise(along * 1.2 + 0.11 * time, 3u), resolved(1.2 * apart));
    let coarse = mix(0.5, ray_noise(along * 0.3 - 0.07 * time, 4u), resolved(0.3 * apart));
    return fine * coarse * 4.0;
}

/// Brightness of a position by its local time.
fn night(place: vec2<f32>) -> f32 {
    return 1.0 + dot(place, aurora.midnight) / max(length(place), 1.0);
}

/// A place as its light arrives.
struct Arriving {
    /// Light path times direction, along the axis of hole and camera and across it; and the light path.
    along: f32,
    across: vec3<f32>,
    path: f32,
    /// Across the axis towards the place, a unit vector, and how far it is from the axis.
    towards: vec2<f32>,
    distance: f32,
    /// What of the direction across the axis is left on the axis itself: the radius of its ring behind the hole, 0 before it.
    ring: f32,
}

/// The vector across the axis with these coordinates.
fn beside(v: vec2<f32>) -> vec3<f32> {
    return frame.side_a * v.x + frame.side_b * v.y;
}

/// Camera axes.
fn to_camera(along: f32, across: vec3<f32>, path: f32) -> vec3<f32> {
    return (frame.camera_from_rain * vec4<f32>(frame.outward * along + across, -path)).xyz;
}

/// The place so many km east, north and up of a reference. What depends on its distance from the axis is taken as linear; where about the
/// axis it is, exactly.
fn placed(reference: Reference, aside: vec3<f32>) -> Arriving {
    let left = reference.left + reference.east * aside.x + reference.north * aside.y + reference.up * aside.z;
    var place: Arriving;
    place.distance = length(left.xy);
    place.towards = vec2<f32>(1.0, 0.0);
    if place.distance > 0.0 {
        place.towards = left.xy / place.distance;
    }
    let further = place.distance - length(reference.left.xy);
    let arriving = reference.arriving + reference.by_across * further + reference.by_along * (left.z - reference.left.z);
    place.along = arriving.x;
    place.across = beside(place.towards) * arriving.y;
    place.path = arriving.z;
    place.ring = arriving.y - reference.by_across.y * place.distance;
    return place;
}

/// Most of a turn, in radians, that the standard deviation of a straight stroke may span.
const MOST_TURN: f32 = 0.05;

/// By how much a place moves as the camera sees it, where what is there moves by `step` (as Reference.left). `wide`: of a streak with this
/// standard deviation in such steps, no more than MOST_TURN is drawn of the ring that it is drawn out to.
fn moved(reference: Reference, place: Arriving, step: vec3<f32>, wide: f32) -> vec3<f32> {
    let outward = dot(place.towards, step.xy);
    let about = place.towards.x * step.y - place.towards.y * step.x;
    let change = reference.by_across * outward + reference.by_along * step.z;
    let ring = place.ring / max(place.distance, wide * abs(about) / MOST_TURN + 1e-9);
    let turned = beside(vec2<f32>(-place.towards.y, place.towards.x)) * about * (reference.by_across.y + ring);
    return to_camera(change.x, beside(place.towards) * change.y + turned, change.z);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let ends = chord_room();
    let index = id.x;
    if index >= aurora.streaks * ends {
        return;
    }
    let streak = streak_of(index / ends);
    let count = chords_of(streak.kind);
    let end_index = index % ends;
    if end_index > count {
        return;
    }
    let height = chord_height(streak.kind, end_index, count);
    let wait = waits(streak, height);
    let age = wait + aurora.ahead;
    let segment = segments[streak.segment];
    let nodes_along = streak.along * f32(segment.span);
    let before = min(u32(nodes_along), segment.span - 1u);
    let part = nodes_along - f32(before);
    let first = segment.first_node + before;
    let a = node_at(first, age);
    let b = node_at(first + 1u, age);
    let curtain = between_nodes(node_at(first - 1u, age).place, a.place, b.place, node_at(first + 2u, age).place, part);
    let place = curtain.xy;
    let step = curtain.zw;
    let body = at_height(place, height, streak.south);
    let slot = end_index + select(0u, aurora.chords + 1u, streak.kind == RED);
    let reference = references[first_reference(streak.segment, streak.south, id.y) + slot];
    let aside = transpose(across_field(reference.body)) * (body - reference.body);
    var end: ChordEnd;
    let place_seen = placed(reference, aside);
    let on_ring = abs(place_seen.ring) > 0.5 * length(place_seen.across);
    end.seen = end_seen(reference.is_seen != 0u, on_ring, place_seen.towards);
    end.apparent = to_camera(place_seen.along, place_seen.across, place_seen.path);
    // Along the curtain, in the directions east and north of the place (the plane's middle is the pole), and across it.
    let pole = normalize(place + vec2<f32>(1e-6, 0.0));
    let towards = step / max(length(step), 1e-6);
    let turn = vec2<f32>(pole.x * towards.y - pole.y * towards.x, -dot(pole, towards));
    let apart = streak.apart * f32(segment.span) * (b.along - a.along);
    let along = mix(a.along, b.along, part);
    let whole = night(place);
    end.waited = whole * mix(a.flux, b.flux, part) * mix(1.0, rays(along, aurora.clock - wait, apart), aurora.contrast);
    let now_a = node_at(first, aurora.ahead).flux;
    let now_b = node_at(first + 1u, aurora.ahead).flux;
    end.prompt = whole * mix(now_a, now_b, part) * mix(1.0, rays(along, aurora.clock, apart), aurora.contrast);
    let wide = sqrt(streak.spread);
    end.along = moved(reference, place_seen, reference.east * turn.x + reference.north * turn.y, wide.x);
    end.across = moved(reference, place_seen, reference.north * turn.x - reference.east * turn.y, wide.y);
    chords[id.y * aurora.streaks * ends + index] = end;
}
