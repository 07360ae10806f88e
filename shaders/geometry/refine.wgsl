// Stage 4: splitting. One thread per piece: if an edge needs more than eight segments it is halved, else the piece goes to the mesh stage.
// An edge is judged by its end points alone, so both its sides split it alike.

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let queue = counters.turn;
    let index = group.x * 64u + lane;
    if index >= min(atomicLoad(&counters.pieces[queue]), frame.capacity.z) {
        return;
    }
    let piece = pieces[queue * frame.capacity.z + index];
    let placement = placement_at(piece.what.x);
    let triangle = model_triangles[piece.what.y];
    strict = strictness(placement);
    limb_strict = limb_strictness(placement);
    measure(piece, placement, triangle);
    for (var k = 0u; k < 3u; k++) {
        let state = edge_states[placement.ids.w + triangle.edges[k]];
        model_levels[k] = bitcast<u32>(state.x);
        limb[k] = (bitcast<u32>(state.y) & EDGE_LIMB) != 0u;
    }
    if unseen && (frame.switches.x & FLAG_INSIDE) != 0u {
        // The image ends somewhere in this piece: what is seen of its corners is drawn as it is.
        emit_work(piece, vec4<u32>(1u), 1u, 1u);
    } else if piece.what.z == PIECE_FAN {
        refine_fan(piece);
    } else {
        refine_triangle(piece);
    }
    hand_over(1u - queue);
}

/// What was measured of a piece: its points as they are seen, and for a fan their offsets.
var<private> points: array<vec3<f32>, 17>;
var<private> offsets: array<vec3<f32>, 6>;
/// Whether one of them is not seen.
var<private> unseen: bool;

/// `strictness` of the placement, and that of its outlines.
var<private> strict: f32;
var<private> limb_strict: f32;
/// Levels of the model triangle's edges, and whether they may be outlines, from the stage of edges.
var<private> model_levels: vec3<u32>;
var<private> limb: array<bool, 3>;

/// The level of the edge between two corners: a whole edge of the model has the level that its other triangle knows too.
fn level_between(a: vec3<f32>, b: vec3<f32>, error: f32) -> u32 {
    let whole = max(a.x, max(a.y, a.z)) == 1.0 && max(b.x, max(b.y, b.z)) == 1.0;
    // The edge of the model triangle that it lies on, opposite to the corner that has no weight.
    let absent = a + b;
    var edge = 3u;
    if absent.x == 0.0 { edge = 0u; } else if absent.y == 0.0 { edge = 1u; } else if absent.z == 0.0 { edge = 2u; }
    if whole {
        return model_levels[min(edge, 2u)];
    }
    // Where light grazes a triangle the image folds inside it: the outline comes in over one of its edges and leaves over another.
    let fold = (limb[0] && limb[1]) || (limb[1] && limb[2]) || (limb[2] && limb[0]);
    let closer = select(fold, limb[min(edge, 2u)], edge < 3u);
    return level_for(error * strict * select(1.0, limb_strict, closer), part_between(a, b));
}

/// Triangle: corners at 0 to 2, then the points at ¼, ½, ¾ of the edges opposite 0, 1, 2. Fan: apex, outer corners 1 and 2, the outer edge
/// at ¼, ½, ¾; then from 6 the radial side at corner 1 at s = 0, ¼, ½, ¾, from 10 that at corner 2, from 14 the arc at ¼, ½, ¾.
fn measure(piece: Piece, placement: Placement, triangle: ModelTriangle) {
    let corners = array<vec3<f32>, 3>(piece.corner_0.xyz, piece.corner_1.xyz, piece.corner_2.xyz);
    let fan = piece.what.z == PIECE_FAN;
    let count = select(12u, 17u, fan);
    for (var k = 0u; k < count; k++) {
        var corner = corners[min(k, 2u)];
        if k >= 3u && k < 12u {
            let side = select((k - 3u) / 3u, 0u, fan);
            corner = quarter_point(corners[(side + 1u) % 3u], corners[(side + 2u) % 3u], (k - 3u) % 3u + 1u);
        }
        var query = query_body(body_point(placement, triangle, corner));
        if fan && k >= 6u {
            let apex = apex_offset(offsets[0]);
            if k < 10u {
                query = query_fan(apex, offsets[1], f32(k - 6u) * 0.25);
            } else if k < 14u {
                query = query_fan(apex, offsets[2], f32(k - 10u) * 0.25);
            } else {
                query = query_fan(apex, offsets[3u + k - 14u], 0.0);
            }
        }
        let found = answer(placement, query, placement.ids.x);
        points[k] = found.ray.apparent;
        unseen = unseen || !found.ray.valid;
        if k < 6u {
            offsets[k] = found.offset;
        }
    }
}

/// The point at k quarters from a to b, from whichever end comes first.
fn quarter_point(a: vec3<f32>, b: vec3<f32>, k: u32) -> vec3<f32> {
    return edge_point(a, b, f32(k) * 0.25);
}

/// Error of the edge opposite corner `side` of a measured triangle.
fn side_error(side: u32) -> f32 {
    let k = 3u + 3u * side;
    return chord_error(points[(side + 1u) % 3u], points[k], points[k + 1u], points[k + 2u], points[(side + 2u) % 3u]);
}

fn refine_triangle(piece: Piece) {
    let c0 = piece.corner_0.xyz;
    let c1 = piece.corner_1.xyz;
    let c2 = piece.corner_2.xyz;
    let errors = vec3<f32>(side_error(0u), side_error(1u), side_error(2u));
    if off_screen(points[0], points[1], points[2], max(errors.x, max(errors.y, errors.z))) {
        return;
    }
    let levels = vec3<u32>(level_between(c1, c2, errors.x), level_between(c2, c0, errors.y), level_between(c0, c1, errors.z));
    let most = max(levels.x, max(levels.y, levels.z));
    let depth = piece.what.w;
    if most <= BLOCK || depth >= DEEPEST {
        if most > BLOCK {
            atomicAdd(&counters.coarse, 1u);
        }
        let held = min(levels, vec3<u32>(BLOCK));
        emit_work(piece, vec4<u32>(held, 1u), max(held.x, max(held.y, held.z)), 1u);
        return;
    }
    let split_0 = levels.x > BLOCK;
    let split_1 = levels.y > BLOCK;
    let split_2 = levels.z > BLOCK;
    let m0 = edge_point(c1, c2, 0.5);
    let m1 = edge_point(c2, c0, 0.5);
    let m2 = edge_point(c0, c1, 0.5);
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
        emit_piece(piece.what.x, piece.what.y, PIECE_TRIANGLE, depth + 1u, parts[3u * k], parts[3u * k + 1u], parts[3u * k + 2u]);
    }
}

fn refine_fan(piece: Piece) {
    let c1 = piece.corner_1.xyz;
    let c2 = piece.corner_2.xyz;
    let outer = level_between(c1, c2, chord_error(points[1], points[3], points[4], points[5], points[2]));
    let depth = piece.what.w;
    if outer > BLOCK && depth < DEEPEST {
        let m = edge_point(c1, c2, 0.5);
        emit_piece(piece.what.x, piece.what.y, PIECE_FAN, depth + 1u, piece.corner_0.xyz, c1, m);
        emit_piece(piece.what.x, piece.what.y, PIECE_FAN, depth + 1u, piece.corner_0.xyz, m, c2);
        return;
    }
    let side_1 = level_for(strict * chord_error(points[6], points[7], points[8], points[9], points[1]), 1.0);
    let side_2 = level_for(strict * chord_error(points[10], points[11], points[12], points[13], points[2]), 1.0);
    let arc = level_for(CHORD_SHARE / ARC_SHARE * chord_error(points[6], points[14], points[15], points[16], points[10]), 1.0);
    let levels = vec4<u32>(min(arc, 64u), min(outer, BLOCK), min(side_1, 64u), min(side_2, 64u));
    emit_work(piece, levels, max(levels.z, levels.w), max(levels.x, levels.y));
}
