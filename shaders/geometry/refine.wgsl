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
    let placement = placements[piece.what.x];
    let triangle = model_triangles[piece.what.y];
    if piece.what.z == PIECE_FAN {
        refine_fan(piece, placement, triangle, 1u - queue);
    } else {
        refine_triangle(piece, placement, triangle, 1u - queue);
    }
}

fn refine_triangle(piece: Piece, placement: Placement, triangle: ModelTriangle, queue: u32) {
    let c0 = piece.corner_0.xyz;
    let c1 = piece.corner_1.xyz;
    let c2 = piece.corner_2.xyz;
    let error_0 = edge_error(placement, triangle, c1, c2);
    let error_1 = edge_error(placement, triangle, c2, c0);
    let error_2 = edge_error(placement, triangle, c0, c1);
    if off_screen(apparent_corner(placement, triangle, c0), apparent_corner(placement, triangle, c1), apparent_corner(placement, triangle, c2),
            max(error_0, max(error_1, error_2))) {
        return;
    }
    let levels = vec3<u32>(level_for(error_0), level_for(error_1), level_for(error_2));
    let most = max(levels.x, max(levels.y, levels.z));
    let depth = piece.what.w;
    if most <= BLOCK || depth >= DEEPEST {
        if most > BLOCK {
            atomicAdd(&counters.coarse, 1u);
        }
        let held = min(levels, vec3<u32>(BLOCK));
        _ = emit_work(piece, vec4<u32>(held, 1u), max(held.x, max(held.y, held.z)), 1u);
        return;
    }
    let split_0 = levels.x > BLOCK;
    let split_1 = levels.y > BLOCK;
    let split_2 = levels.z > BLOCK;
    let m0 = edge_point(c1, c2, 0.5);
    let m1 = edge_point(c2, c0, 0.5);
    let m2 = edge_point(c0, c1, 0.5);
    let p = piece.what.x;
    let t = piece.what.y;
    let d = depth + 1u;
    let k = PIECE_TRIANGLE;
    let count = u32(split_0) + u32(split_1) + u32(split_2);
    if count == 3u {
        emit_piece(queue, p, t, k, d, c0, m2, m1);
        emit_piece(queue, p, t, k, d, m2, c1, m0);
        emit_piece(queue, p, t, k, d, m1, m0, c2);
        emit_piece(queue, p, t, k, d, m0, m1, m2);
    } else if count == 2u {
        // Turned so that the whole edge is a–b, opposite to c.
        var a = c0; var b = c1; var c = c2; var ma = m0; var mb = m1;
        if !split_0 { a = c1; b = c2; c = c0; ma = m1; mb = m2; }
        else if !split_1 { a = c2; b = c0; c = c1; ma = m2; mb = m0; }
        emit_piece(queue, p, t, k, d, c, mb, ma);
        emit_piece(queue, p, t, k, d, mb, a, ma);
        emit_piece(queue, p, t, k, d, a, b, ma);
    } else {
        var a = c0; var b = c1; var c = c2; var m = m0;
        if split_1 { a = c1; b = c2; c = c0; m = m1; }
        else if split_2 { a = c2; b = c0; c = c1; m = m2; }
        emit_piece(queue, p, t, k, d, a, b, m);
        emit_piece(queue, p, t, k, d, a, m, c);
    }
}

fn refine_fan(piece: Piece, placement: Placement, triangle: ModelTriangle, queue: u32) {
    let order = placement.ids.x;
    let c1 = piece.corner_1.xyz;
    let c2 = piece.corner_2.xyz;
    let apex = apex_offset(emitted_offset(placement, body_point(placement, triangle, piece.corner_0.xyz), order));
    let outer_1 = emitted_offset(placement, body_point(placement, triangle, c1), order);
    let outer_2 = emitted_offset(placement, body_point(placement, triangle, c2), order);
    let outer_error = edge_error(placement, triangle, c1, c2);
    let outer = level_for(outer_error);
    let depth = piece.what.w;
    if outer > BLOCK && depth < DEEPEST {
        let m = edge_point(c1, c2, 0.5);
        emit_piece(queue, piece.what.x, piece.what.y, PIECE_FAN, depth + 1u, piece.corner_0.xyz, c1, m);
        emit_piece(queue, piece.what.x, piece.what.y, PIECE_FAN, depth + 1u, piece.corner_0.xyz, m, c2);
        return;
    }
    let side_1_error = radial_error(apex, outer_1, order);
    let side_2_error = radial_error(apex, outer_2, order);
    // The arc at the axis, over the azimuths of the outer edge.
    let arc_error = chord_error(
        fan_sight(apex, outer_1, 0.0, order).apparent,
        fan_sight(apex, fan_outer(placement, triangle, c1, c2, 0.25), 0.0, order).apparent,
        fan_sight(apex, fan_outer(placement, triangle, c1, c2, 0.5), 0.0, order).apparent,
        fan_sight(apex, fan_outer(placement, triangle, c1, c2, 0.75), 0.0, order).apparent,
        fan_sight(apex, outer_2, 0.0, order).apparent);
    let levels = vec4<u32>(
        min(level_for(arc_error), 64u),
        min(outer, BLOCK),
        min(level_for(side_1_error), 64u),
        min(level_for(side_2_error), 64u));
    _ = emit_work(piece, levels, max(levels.z, levels.w), max(levels.x, levels.y));
}

/// The offset of the outer point of a fan at fraction t from corner 1 to corner 2.
fn fan_outer(placement: Placement, triangle: ModelTriangle, c1: vec3<f32>, c2: vec3<f32>, t: f32) -> vec3<f32> {
    return emitted_offset(placement, body_point(placement, triangle, edge_point(c1, c2, t)), placement.ids.x);
}
