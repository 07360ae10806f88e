// Stage 4: splitting. One thread per piece. If an edge needs more than eight segments it is halved; else the piece goes to the mesh stage.
// An edge is judged by its end points alone, so both its sides split it alike.

#import lensrunner::chosen::worldlines::{before_turning, KEEPS_SLIVERS, turning_slack}
#import lensrunner::geometry::bindings::{counters, EDGE_LIMB, model_triangle, pieces, states}
#import lensrunner::geometry::clip::pixel_fineness
#import lensrunner::geometry::emit::{emit_piece, emit_work, hand_over, off_screen}
#import lensrunner::geometry::patch::{
    angle_between, ARC_SHARE, axis_matters, AXIS_SHARE, BLOCK, BLURRED_TURN, body_point, CHORD_SHARE, comes_first, DEEPEST, edge_error,
    edge_point, exact, fan_input, halfway, is_blurred, is_lost, level_for, LIMB_SINE, limb_strictness, meets_axis, momentum_at,
    most_segments, most_turn, MUST_SPLIT, part_between, plane_normal, ring_strictness, ring_tangent, Slack, slack_of, strictness,
    turn_along, turned_away, uneven_sag,
}
#import lensrunner::geometry::project::{body_input, leaving_direction, project_point}
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::{FLAG_INSIDE, Instance, is_thin, ModelTriangle, Piece, PIECE_FAN, PIECE_STRIP, PIECE_TRIANGLE}
#import lensrunner::instances::instance::instance_at

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let queue = counters.turn;
    let index = group.x * 64u + lane;
    if index >= min(atomicLoad(&counters.pieces[queue]), frame.capacity.work) {
        return;
    }
    let piece = pieces[queue * frame.capacity.work + index];
    let instance = instance_at(piece.instance);
    let triangle = model_triangle(piece.triangle);
    strict = strictness(instance);
    limb_strict = limb_strictness(instance);
    measure(piece, instance, triangle);
    for (var k = 0u; k < 3u; k++) {
        let state = states[instance.first_state + triangle.edges[k]];
        model_levels[k] = bitcast<u32>(state.x);
        limb[k] = (bitcast<u32>(state.y) & EDGE_LIMB) != 0u;
    }
    if unseen && (frame.flags & FLAG_INSIDE) != 0u {
        // The image ends somewhere in this piece: what is seen of its corners is drawn as it is.
        emit_work(piece, vec4<u32>(1u), 1u, 1u);
    } else if piece.kind == PIECE_FAN {
        refine_fan(piece, instance);
    } else {
        // Beside the axis light of one triangle leaves in all directions of a cone, and a part of the triangle may be turned away.
        let away = turned_away(instance, triangle, instance.offset, leaving[0], leaving[1], leaving[2]);
        if !away { refine_triangle(piece, instance); }
    }
    hand_over(1u - queue);
}

/// What was measured of a piece: the apparent positions of its points; below, those points of them that are on the triangle, by the axis.
var<private> points: array<vec3<f32>, 17>;
var<private> by_axis: array<vec3<f32>, 12>;
/// Sines of the angles to the triangle under which light leaves it at the corners.
var<private> rising: vec3<f32>;
/// `ring_tangent` in the middles of the sides opposite corners 0, 1, 2; of a fan only the first.
var<private> tangents: array<vec3<f32>, 3>;
/// Directions in which light leaves the corners, rest frame, at T₀ (`before_turning`); w: their radii.
var<private> leaving: array<vec4<f32>, 3>;
/// Whether one of the points is not seen.
var<private> unseen: bool;

/// `strictness` of the instance, and that of its outlines.
var<private> strict: f32;
var<private> limb_strict: f32;
/// Number of segments of the model triangle's edges, from the stage of edges; below, whether they may be outlines.
var<private> model_levels: vec3<u32>;
var<private> limb: array<bool, 3>;

/// The edge opposite corner `side` of a measured triangle, or the outer edge (0) of a fan: its number of segments, and where it is halved.
/// From its ends alone, in the order that both sides of the edge agree on.
struct Side {
    level: u32,
    error: f32,
    /// About the axis, radians.
    turn: f32,
    middle: vec3<f32>,
}

fn side_of(piece: Piece, side: u32, instance: Instance) -> Side {
    let corners = array<vec3<f32>, 3>(piece.corner_a, piece.corner_b, piece.corner_c);
    var i = (side + 1u) % 3u;
    var j = (side + 2u) % 3u;
    if !comes_first(corners[i], corners[j]) {
        let other = i;
        i = j;
        j = other;
    }
    let half = halfway(by_axis[i].xy, by_axis[j].xy);
    var result: Side;
    result.middle = corners[i] + (corners[j] - corners[i]) * half;
    // Beside the axis a small part of an edge may have a large part of the image.
    let part = select(1.0, part_between(corners[i], corners[j]), half == 0.5);
    let nearest = min(length(by_axis[i].xy), length(by_axis[j].xy));
    result.error = side_error(side, slack_of(instance, tangents[side], nearest, by_axis[i].z));
    let fineness = pixel_fineness(points[i], points[j]);
    let pixel = frame.pixel / fineness * length(points[i]);
    let closer = ring_strictness(instance, nearest, pixel, by_axis[i].z);
    // If light grazes a triangle, its image may fold inside it.
    let least = LIMB_SINE + turning_slack(instance);
    let grazed = min(rising[i], rising[j]) < least && max(rising[i], rising[j]) > -least;
    result.level = level_between(corners[i], corners[j], result.error * fineness, closer, grazed, part);
    result.level = min(result.level, most_segments(instance, by_axis[i], by_axis[j], pixel));
    // The points between the ends, in the order of i and j.
    let k = 4u + 3u * side;
    let swapped = i != (side + 1u) % 3u;
    let first = select(k - 1u, k + 1u, swapped);
    result.turn = turn_along(by_axis[i], by_axis[first], by_axis[k], by_axis[2u * k - first], by_axis[j], instance.order);
    let sag = uneven_sag(by_axis[i], by_axis[j], result.level, result.turn, angle_between(points[i], points[j]));
    if result.turn > most_turn(instance) || level_for(sag * fineness * strict * closer, 1.0) > 1u {
        result.error = MUST_SPLIT;
        result.level = max(result.level, BLOCK + 1u);
    }
    return result;
}

/// The number of segments of the edge between two corners, which is `part` of an edge of the model. A whole edge has the number that the
/// stage of edges found, which its other triangle knows too.
fn level_between(a: vec3<f32>, b: vec3<f32>, error: f32, least: f32, grazed: bool, part: f32) -> u32 {
    let whole = max(a.x, max(a.y, a.z)) == 1.0 && max(b.x, max(b.y, b.z)) == 1.0;
    // The edge of the model triangle on which it lies: opposite the corner without weight.
    let absent = a + b;
    var edge = 3u;
    if absent.x == 0.0 { edge = 0u; } else if absent.y == 0.0 { edge = 1u; } else if absent.z == 0.0 { edge = 2u; }
    if whole {
        return model_levels[min(edge, 2u)];
    }
    let closer = select(grazed, limb[min(edge, 2u)], edge < 3u);
    return level_for(error * strict * max(least, select(1.0, limb_strict, closer)), part);
}

/// Measures a piece. Triangle: corners at 0 to 2, then the points at ¼, ½, ¾ of the edges opposite corners 0, 1, 2. Fan: apex, outer
/// corners 1 and 2, the outer edge at ¼, ½, ¾; from 6 the radial side at corner 1 at s = 0, ¼, ½, ¾; from 10 that at corner 2; from 14 the
/// arc at ¼, ½, ¾.
fn measure(piece: Piece, instance: Instance, triangle: ModelTriangle) {
    let corners = array<vec3<f32>, 3>(piece.corner_a, piece.corner_b, piece.corner_c);
    let fan = piece.kind == PIECE_FAN;
    let count = select(12u, 17u, fan);
    let normal = plane_normal(instance, triangle, instance.offset);
    for (var k = 0u; k < count; k++) {
        var corner = corners[min(k, 2u)];
        if k >= 3u && k < 12u {
            let side = select((k - 3u) / 3u, 0u, fan);
            corner = quarter_point(corners[(side + 1u) % 3u], corners[(side + 2u) % 3u], (k - 3u) % 3u + 1u);
        }
        var input = body_input(body_point(instance, triangle, corner));
        if fan && k >= 6u {
            let apex = by_axis[0].z;
            if k < 10u {
                input = fan_input(apex, by_axis[1], f32(k - 6u) * 0.25);
            } else if k < 14u {
                input = fan_input(apex, by_axis[2], f32(k - 10u) * 0.25);
            } else {
                input = fan_input(apex, by_axis[3u + k - 14u], 0.0);
            }
        }
        let found = project_point(instance, input, instance.order);
        points[k] = found.ray.apparent;
        unseen = unseen || !found.ray.valid;
        if k < 3u {
            let left = leaving_direction(found.ray.leaving, momentum_at(instance, found.position));
            leaving[k] = vec4<f32>(before_turning(instance, left, found.ray.delay), length(found.position));
            rising[k] = dot(normal, leaving[k].xyz);
        }
        if k == 4u || k == 7u || k == 10u {
            tangents[(k - 4u) / 3u] = ring_tangent(found.ray);
        }
        if k < 12u {
            by_axis[k] = found.by_axis;
        }
    }
}

/// The point at k quarters from a to b, from whichever end comes first.
fn quarter_point(a: vec3<f32>, b: vec3<f32>, k: u32) -> vec3<f32> {
    return edge_point(a, b, f32(k) * 0.25);
}

/// Error of the edge opposite corner `side` of a measured triangle.
fn side_error(side: u32, slack: Slack) -> f32 {
    let k = 3u + 3u * side;
    return edge_error(points[(side + 1u) % 3u], points[k], points[k + 1u], points[k + 2u], points[(side + 2u) % 3u], slack);
}

/// Hands a triangle with these numbers of segments to the mesh stage: as a grid, or as a strip if its image is narrow, which takes a third
/// of the vertices. Thin images have no strips: a thin ring breaks where triangles are too narrow to be drawn.
fn emit_leaf(piece: Piece, levels: vec3<u32>, instance: Instance) {
    let most = max(levels.x, max(levels.y, levels.z));
    // Turned so that the side with most segments is opposite the first corner.
    let turn = select(select(2u, 1u, levels.y == most), 0u, levels.x == most);
    let turned = vec3<u32>(levels[turn], levels[(turn + 1u) % 3u], levels[(turn + 2u) % 3u]);
    let columns = max(turned.x, turned.y + turned.z);
    if most < 4u || columns > most + 2u || is_thin(instance) || !is_narrow(turn, turned, instance.order) {
        emit_work(piece, vec4<u32>(levels, 1u), most, 1u);
        return;
    }
    let corners = array<vec3<f32>, 3>(piece.corner_a, piece.corner_b, piece.corner_c);
    var strip = piece;
    strip.kind = PIECE_STRIP;
    strip.corner_a = corners[turn];
    strip.corner_b = corners[(turn + 1u) % 3u];
    strip.corner_c = corners[(turn + 2u) % 3u];
    emit_work(strip, vec4<u32>(turned, 1u), 1u, columns);
}

/// Widest strip, pixels: over so little the image does not bend.
const STRIP_WIDTH: f32 = 6.0;

/// Largest displacement of a point of a strip, in pixels. Beside the axis a step across a cell is a larger share of the distance from the
/// axis on one side than on the other, and what lies between is not linear.
const STRIP_SHEAR: f32 = 0.1;

/// Whether the image of a measured triangle is narrow between the side opposite corner `turn` and the other two sides. Their points are
/// compared as a strip joins them. `levels` begin with that of the side opposite that corner.
fn is_narrow(turn: u32, levels: vec3<u32>, order: u32) -> bool {
    let columns = f32(levels.y + levels.z);
    let pixel = frame.pixel / pixel_fineness(points[0], points[1]);
    var widest = 0.0;
    var shear = 0.0;
    for (var k = 1u; k < 4u; k++) {
        let at = 0.25 * f32(k) * columns;
        let on_first = at <= f32(levels.z);
        // From corner turn + 1 to corner `turn` on the side opposite turn + 2, then on to corner turn + 2; both sides count the other way.
        let side = select((turn + 1u) % 3u, (turn + 2u) % 3u, on_first);
        let t = select((at - f32(levels.z)) / f32(levels.y), at / f32(levels.z), on_first);
        let other = point_of_side(side, 1.0 - t);
        let here = 3u + 3u * turn + k - 1u;
        widest = max(widest, angle_between(mix(points[other.start], points[other.end], vec3<f32>(other.t)), points[here]));
        let distances = vec2<f32>(length(by_axis[here].xy),
            length(mix(by_axis[other.start].xy, by_axis[other.end].xy, vec2<f32>(other.t))));
        shear = max(shear, abs(distances.x - distances.y) / max(min(distances.x, distances.y), 1e-20));
    }
    let cell = angle_between(points[(turn + 1u) % 3u], points[(turn + 2u) % 3u]) / columns;
    return widest < STRIP_WIDTH * pixel && (0.25 * cell * shear < STRIP_SHEAR * pixel || !axis_matters(by_axis[0].z, order));
}

/// A point between two measured points, by their indices.
struct Between {
    start: u32,
    end: u32,
    t: f32,
}

/// The point of the side opposite corner `side`, at t from corner side + 1 to side + 2: linear between the measured quarters.
fn point_of_side(side: u32, t: f32) -> Between {
    let k = 3u + 3u * side;
    let quarter = min(u32(4.0 * t), 3u);
    let start = select(k + quarter - 1u, (side + 1u) % 3u, quarter == 0u);
    let end = select(k + quarter, (side + 2u) % 3u, quarter == 3u);
    return Between(start, end, 4.0 * t - f32(quarter));
}

/// From this depth on a piece may be a sliver that splitting only makes thinner.
const SLIVER_DEPTH: u32 = 16u;

/// If a side has a larger turn about the axis than this, in radians, the triangle is not halved on all sides.
const SLICED: f32 = 0.1;

/// Where the axis meets a measured triangle, as `meets_axis`.
fn met(piece: Piece, order: u32) -> vec3<f32> {
    let corners = array<vec3<f32>, 3>(piece.corner_a, piece.corner_b, piece.corner_c);
    // The corners in the order that the triangles of each edge agree on.
    var rank = vec3<u32>(0u, 1u, 2u);
    if !comes_first(corners[rank.x], corners[rank.y]) { rank = rank.yxz; }
    if !comes_first(corners[rank.y], corners[rank.z]) { rank = rank.xzy; }
    if !comes_first(corners[rank.x], corners[rank.y]) { rank = rank.yxz; }
    let at = meets_axis(by_axis[rank.x], by_axis[rank.y], by_axis[rank.z], order);
    var result: vec3<f32>;
    result[rank.x] = at.x;
    result[rank.y] = at.y;
    result[rank.z] = at.z;
    return result;
}

/// At the deepest splitting a piece may still turn too much about the axis, where rounding decides on azimuths. Its chords would run across
/// the ring, so it is left out. This is whether that may be seen. `farthest` is the largest distance of its corners from the axis, in r_s.
fn reaches_out(farthest: f32) -> bool {
    return farthest > AXIS_SHARE * frame.pixel / pixel_fineness(points[1], points[2]) * length(points[1]);
}

/// Whether a measured triangle is a sliver along a side that needs no splitting. It would be split for its other two sides for ever: they
/// come nearer to that side and get no shorter.
fn is_sliver(levels: vec3<u32>) -> bool {
    let lengths = vec3<f32>(angle_between(points[1], points[2]), angle_between(points[2], points[0]), angle_between(points[0], points[1]));
    let longest = max(lengths.x, max(lengths.y, lengths.z));
    let base = select(select(levels.z, levels.y, lengths.y == longest), levels.x, lengths.x == longest);
    return KEEPS_SLIVERS && base <= BLOCK;
}

fn refine_triangle(piece: Piece, instance: Instance) {
    let c0 = piece.corner_a;
    let c1 = piece.corner_b;
    let c2 = piece.corner_c;
    let depth = piece.depth;
    if is_lost(instance, by_axis[0], by_axis[1], by_axis[2]) {
        return;
    }
    // A moving triangle is not flat when it is seen: the axis may meet a part of it although it passes by the corners.
    let at = met(piece, instance.order);
    if at.x >= 0.0 {
        if depth >= DEEPEST {
            atomicAdd(&counters.coarse, 1u);
            return;
        }
        let apex = c0 * at.x + c1 * at.y + c2 * at.z;
        atomicAdd(&counters.cut, 1u);
        emit_piece(piece.instance, piece.triangle, PIECE_FAN, depth + 1u, apex, c1, c2);
        emit_piece(piece.instance, piece.triangle, PIECE_FAN, depth + 1u, apex, c2, c0);
        emit_piece(piece.instance, piece.triangle, PIECE_FAN, depth + 1u, apex, c0, c1);
        return;
    }
    var sides: array<Side, 3>;
    // No piece is deeper. Compilers unroll loops of a known number of turns, and have three times as much to compile.
    let count = select(3u, 0u, depth > DEEPEST);
    for (var k = 0u; k < count; k++) {
        sides[k] = side_of(piece, k, instance);
    }
    let turned = max(sides[0].turn, max(sides[1].turn, sides[2].turn));
    if is_blurred(instance, by_axis[0], by_axis[1], by_axis[2]) {
        if turned < BLURRED_TURN {
            emit_work(piece, vec4<u32>(1u), 1u, 1u);
        }
        return;
    }
    if off_screen(points[0], points[1], points[2], max(sides[0].error, max(sides[1].error, sides[2].error))) {
        return;
    }
    let levels = vec3<u32>(sides[0].level, sides[1].level, sides[2].level);
    let most = max(levels.x, max(levels.y, levels.z));
    let sliver = depth >= SLIVER_DEPTH && is_sliver(levels) && turned <= most_turn(instance);
    if most <= BLOCK || depth >= DEEPEST || sliver {
        if most > BLOCK && !sliver {
            let far = reaches_out(max(length(by_axis[0].xy), max(length(by_axis[1].xy), length(by_axis[2].xy))));
            atomicAdd(&counters.coarse, select(0u, 1u, far));
            if turned > most_turn(instance) {
                return;
            }
        }
        emit_leaf(piece, min(levels, vec3<u32>(BLOCK)), instance);
        return;
    }
    emit_parts(piece, sides, turned);
}

/// Halves those sides of a triangle that need more than eight segments, and hands on the parts. `turned` is the largest turn of a side.
fn emit_parts(piece: Piece, sides: array<Side, 3>, turned: f32) {
    let c0 = piece.corner_a;
    let c1 = piece.corner_b;
    let c2 = piece.corner_c;
    var split_0 = sides[0].level > BLOCK;
    var split_1 = sides[1].level > BLOCK;
    var split_2 = sides[2].level > BLOCK;
    // Round the axis the image bends along the ring and hardly across it. Halving all sides would make as many parts as the square of what
    // the longest side needs. So only that side is halved, and the parts lie side by side.
    if split_0 && split_1 && split_2 && turned > SLICED {
        split_0 = sides[0].turn == turned;
        split_1 = sides[1].turn == turned && !split_0;
        split_2 = !split_0 && !split_1;
    }
    let m0 = sides[0].middle;
    let m1 = sides[1].middle;
    let m2 = sides[2].middle;
    // The parts, three corners each.
    var parts = array<vec3<f32>, 12>(c0, m2, m1, m2, c1, m0, m1, m0, c2, m0, m1, m2);
    let count = u32(split_0) + u32(split_1) + u32(split_2);
    if count == 2u {
        // Turned so that the whole edge is a–b, opposite to c.
        var a = c0; var b = c1; var c = c2; var ma = m0; var mb = m1;
        if !split_0 { a = c1; b = c2; c = c0; ma = m1; mb = m2; }
        else if !split_1 { a = c2; b = c0; c = c1; ma = m2; mb = m0; }
        parts = array<vec3<f32>, 12>(c, mb, ma, mb, a, ma, a, b, ma, c0, c0, c0);
    } else if count == 1u {
        var a = c0; var b = c1; var c = c2; var m = m0;
        if split_1 { a = c1; b = c2; c = c0; m = m1; }
        else if split_2 { a = c2; b = c0; c = c1; m = m2; }
        parts = array<vec3<f32>, 12>(a, b, m, a, m, c, c0, c0, c0, c0, c0, c0);
    }
    for (var k = 0u; k <= count; k++) {
        emit_piece(piece.instance, piece.triangle, PIECE_TRIANGLE, piece.depth + 1u, parts[3u * k], parts[3u * k + 1u], parts[3u * k + 2u]);
    }
}

fn refine_fan(piece: Piece, instance: Instance) {
    let c1 = piece.corner_b;
    let c2 = piece.corner_c;
    if is_lost(instance, by_axis[1], by_axis[2], by_axis[2]) {
        return;
    }
    let side = side_of(piece, 0u, instance);
    let outer = side.level;
    let depth = piece.depth;
    if side.turn > most_turn(instance) && is_blurred(instance, by_axis[1], by_axis[2], by_axis[2]) {
        return;
    }
    if outer > BLOCK && depth < DEEPEST {
        let m = side.middle;
        emit_piece(piece.instance, piece.triangle, PIECE_FAN, depth + 1u, piece.corner_a, c1, m);
        emit_piece(piece.instance, piece.triangle, PIECE_FAN, depth + 1u, piece.corner_a, m, c2);
        return;
    }
    if side.turn > most_turn(instance) {
        atomicAdd(&counters.coarse, select(0u, 1u, reaches_out(max(length(by_axis[1].xy), length(by_axis[2].xy)))));
        return;
    }
    let fineness = pixel_fineness(points[1], points[2]);
    let side_1 = level_for(fineness * strict * edge_error(points[6], points[7], points[8], points[9], points[1], exact()), 1.0);
    let side_2 = level_for(fineness * strict * edge_error(points[10], points[11], points[12], points[13], points[2], exact()), 1.0);
    let arc = level_for(fineness * CHORD_SHARE / ARC_SHARE
        * edge_error(points[6], points[14], points[15], points[16], points[10], exact()), 1.0);
    let levels = vec4<u32>(min(arc, 64u), min(outer, BLOCK), min(side_1, 64u), min(side_2, 64u));
    emit_work(piece, levels, max(levels.z, levels.w), max(levels.x, levels.y));
}
