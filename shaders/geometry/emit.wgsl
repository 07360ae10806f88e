#define_import_path lensrunner::geometry::emit

// How a stage hands pieces on: to the rasteriser, to the mesh stage, or back to the queue of pieces. Every index is kept inside its buffer.

#import lensrunner::chosen::worldlines::before_turning
#import lensrunner::geometry::bindings::{counters, indices, model_triangle, pieces, seen, thin, work}
#import lensrunner::geometry::clip::clip_position
#import lensrunner::geometry::patch::{BLOCK, Facing, facing_of}
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::{Capacity, Instance, is_thin, is_thin_ring, Piece, PIECE_FAN, PIECE_STRIP, PIECE_TRIANGLE, ThinVertex, WorkItem}
#import lensrunner::instances::bounds::leaves_bounds
#import lensrunner::instances::instance::{in_body_axes, instance_at}
#import lensrunner::models::hiding::seen_part

/// Height of a triangle on the screen over its longest side, in pixels; negative if its corners run clockwise. A triangle of a thin image
/// that is lower than `render.min_width` is widened to that, with the covered share as alpha, so that narrow images are lines and not dots.
/// Higher ones are drawn as they are, but added to the same sums: else a part of the others' light would be hidden under them.
fn height_on_screen(p0: vec2<f32>, p1: vec2<f32>, p2: vec2<f32>) -> f32 {
    let a = p1 - p0;
    let b = p2 - p0;
    let area = a.x * b.y - a.y * b.x;
    let longest = sqrt(max(dot(a, a), max(dot(b, b), dot(b - a, b - a))));
    return area / max(longest, 1e-6);
}

fn pixels(clip: vec4<f32>) -> vec2<f32> {
    return clip.xy / clip.w * 0.5 * frame.size;
}

/// Triangles lower than this, in pixels, are not stretched: f32 pixels (3e-5 at 500) do not resolve their shapes.
const LEAST_HEIGHT: f32 = 1e-3;
/// The shortest triangles that are drawn, in pixels: of shorter ones not even the area is resolved.
const LEAST_DRAWN: f32 = 1e-4;
/// Triangles shorter than this, in pixels, are drawn on the middle of the pixel that they are in. Those of an image so small lie in one
/// place, and however they were stretched they would all meet a pixel's middle or all miss it.
const SHORT: f32 = 1.0;

/// How a thin triangle is drawn: its corners and its area, both on the screen, in pixels.
struct Drawn {
    corners: mat3x2<f32>,
    area: f32,
}

/// A thin triangle stretched about its centroid, along its longest side and across it, to the least width. Of one that f32 does not resolve
/// half of a rectangle about its longest side is drawn, this half or that: together such halves cover a pixel's middle as often as they
/// should. The longest side is that of the first two corners.
fn widened(a: vec2<f32>, b: vec2<f32>, c: vec2<f32>, height: f32, other_half: bool) -> Drawn {
    let least = frame.least_width;
    let centre = (a + b + c) / 3.0;
    let along = length(b - a);
    if along < SHORT {
        let middle = floor(centre + 0.5 * frame.size) + 0.5 - 0.5 * frame.size;
        return Drawn(mat3x2<f32>(middle + vec2<f32>(-0.3, -0.2), middle + vec2<f32>(0.3, -0.2), middle + vec2<f32>(0.0, 0.4)), 1.0);
    }
    let direction = (b - a) / along;
    let across = vec2<f32>(-direction.y, direction.x);
    if height < LEAST_HEIGHT {
        let v = 0.5 * least * across;
        let start = a - v;
        let end = b + v;
        return Drawn(mat3x2<f32>(start, end, select(b - v, a + v, other_half)), 0.5 * along * least);
    }
    let stretch = max(vec2<f32>(1.0), least / vec2<f32>(along, height));
    let turned = mat3x2<f32>(a - centre, b - centre, c - centre);
    let longer = stretch.x * (direction * turned);
    let higher = stretch.y * (across * turned);
    let corners = mat3x2<f32>(centre + direction * longer.x + across * higher.x, centre + direction * longer.y + across * higher.y,
        centre + direction * longer.z + across * higher.z);
    return Drawn(corners, 0.5 * along * height * stretch.x * stretch.y);
}

/// The share of a triangle whose light crosses the disk's plane as often as the image order says; that of the rest crosses it once less. As
/// `plane_crossings` of Rust, for images whose parts differ, from the heights of the corners over the plane.
fn share_across(instance: Instance, heights: vec3<f32>) -> f32 {
    let order = instance.order;
    if instance.crossings >= 0.0 {
        return select(0.0, 1.0, instance.crossings == f32(order));
    }
    // First the corner that is alone on its side of the plane, if there is one: the plane cuts off its share of the area.
    let below = heights < vec3<f32>(0.0);
    var h = heights;
    if below.y != below.x && below.y != below.z { h = heights.yxz; }
    if below.z != below.x && below.z != below.y { h = heights.zxy; }
    let cut = (h.x < 0.0) != (h.y < 0.0);
    let part = select(1.0, h.x * h.x / ((h.x - h.y) * (h.x - h.z)), cut);
    let above = select(part, 1.0 - part, h.x < 0.0);
    let other_side = select(1.0 - above, above, frame.outward.z < 0.0);
    return select(other_side, 1.0 - other_side, order % 2u == 0u);
}

/// How a point of an image lies round the axis: where it is seen, across the axis and in the rain frame; and how it moves on the screen as
/// its azimuth grows, in pixels a radian.
struct OnRing {
    across: vec2<f32>,
    tangent: vec2<f32>,
}

fn on_ring(apparent: vec3<f32>) -> OnRing {
    let m = frame.camera_from_rain;
    // The inverse of a Lorentz matrix is its transpose between two changes of the sign of time.
    let rain = (transpose(m) * vec4<f32>(apparent, length(apparent))).xyz;
    let moved = clip_position((m * vec4<f32>(cross(frame.outward, rain), 0.0)).xyz);
    let clip = clip_position(apparent);
    let tangent = (moved.xy - clip.xy * (moved.w / clip.w)) / clip.w * 0.5 * frame.size;
    return OnRing(vec2<f32>(dot(rain, frame.side_a), dot(rain, frame.side_b)), tangent);
}

/// The area between the arc round the axis from one point to another and its chord, in square pixels; positive where the arc lies to the
/// right of it. The sides of a ring are arcs, and their chords cut off or add more than a thin one covers. Of two triangles one loses what
/// the other gains. R² (θ − sin θ)/2 of a circle to third order.
fn bulge(start: OnRing, end: OnRing) -> f32 {
    let a = start.across;
    let b = end.across;
    let turn = atan2(a.x * b.y - a.y * b.x, dot(a, b));
    return turn * turn * (start.tangent.x * end.tangent.y - start.tangent.y * end.tangent.x) / 12.0;
}

fn thin_vertex(place: vec2<f32>, id: u32, coverage: f32, order: u32, share: f32) -> ThinVertex {
    let clip = clip_position(seen[id].apparent);
    return ThinVertex(vec4<f32>(place * clip.w, clip.zw), id, coverage, order, share);
}

/// Draws a triangle of a thin image with coverage; true if that was done, or if the triangle faces away. Only objects whose whole image is
/// thin have such triangles: a sliver inside a wide image is covered by its neighbours and stays opaque. `seen_from` has the directions
/// from which it is not hidden.
///
/// A triangle narrower than the error of its corners (chords, f32) may be folded over: it covers what the next one covers again. So areas
/// count with the sense in which the corners run, and over all triangles the double cover cancels.
fn emit_thin(i0: u32, i1: u32, i2: u32, instance: Instance, facing: Facing, seen_from: vec4<u32>) -> bool {
    if !is_thin(instance) || frame.least_width <= 0.0 {
        return false;
    }
    let c0 = clip_position(seen[i0].apparent);
    let c1 = clip_position(seen[i1].apparent);
    let c2 = clip_position(seen[i2].apparent);
    let near = frame.near;
    if c0.w < near || c1.w < near || c2.w < near {
        return false;
    }
    let p0 = pixels(c0);
    let p1 = pixels(c1);
    let p2 = pixels(c2);
    let turned = height_on_screen(p0, p1, p2);
    let height = abs(turned);
    // The sum of coverages is right only if each line of sight meets one layer, so backs of closed bodies are left out.
    let leaving = before_turning(instance, seen[i0].leaving + seen[i1].leaving + seen[i2].leaving, seen[i0].path);
    let from_behind = dot(facing.normal, leaving) < 0.0;
    if facing.closed && from_behind {
        return true;
    }
    // The corners from the longest side on.
    let lengths = vec3<f32>(distance(p0, p1), distance(p1, p2), distance(p2, p0));
    let longest = max(lengths.x, max(lengths.y, lengths.z));
    let area = 0.5 * turned * longest;
    if longest < LEAST_DRAWN || area == 0.0 {
        return true;
    }
    let first = select(select(2u, 1u, lengths.y == longest), 0u, lengths.x == longest);
    let ids = select(select(vec3<u32>(i2, i0, i1), vec3<u32>(i1, i2, i0), first == 1u), vec3<u32>(i0, i1, i2), first == 0u);
    var places = array<vec2<f32>, 5>(p0, p1, p2, p0, p1);
    let drawn = widened(places[first], places[first + 1u], places[first + 2u], height, ((i0 ^ i1 ^ i2) & 1u) != 0u);
    let towards_eye = select(1.0, -1.0, from_behind);
    let sense = select(1.0, sign(turned) * facing.turn * towards_eye, facing.turn != 0.0);
    // The share of the drawn area that it covers, times its share that no other part of the model hides.
    let part = seen_part(seen_from, in_body_axes(instance, facing.normal * towards_eye),
        in_body_axes(instance, leaving / max(length(leaving), 1e-20)));
    var covers = area;
    if is_thin_ring(instance) {
        let r0 = on_ring(seen[i0].apparent);
        let r1 = on_ring(seen[i1].apparent);
        let r2 = on_ring(seen[i2].apparent);
        covers += bulge(r0, r1) + bulge(r1, r2) + bulge(r2, r0);
    }
    let coverage = sense * part * sign(area) * covers / drawn.area;
    if coverage == 0.0 {
        return true;
    }
    let slot = atomicAdd(&counters.thin, 3u);
    if slot + 3u > frame.capacity.thin {
        atomicSub(&counters.thin, 3u);
        return false;
    }
    let order = instance.order;
    let share = share_across(instance, vec3<f32>(seen[i0].height, seen[i1].height, seen[i2].height));
    let scale = 2.0 / frame.size;
    thin[slot] = thin_vertex(drawn.corners[0] * scale, ids.x, coverage, order, share);
    thin[slot + 1u] = thin_vertex(drawn.corners[1] * scale, ids.y, coverage, order, share);
    thin[slot + 2u] = thin_vertex(drawn.corners[2] * scale, ids.z, coverage, order, share);
    return true;
}

/// Draws the triangle of three seen vertices.
fn emit_triangle(i0: u32, i1: u32, i2: u32, instance: Instance, facing: Facing, seen_from: vec4<u32>) {
    if leaves_bounds(instance, i0, i1, i2) || emit_thin(i0, i1, i2, instance, facing, seen_from) {
        return;
    }
    let slot = atomicAdd(&counters.indices, 3u);
    if slot + 3u > frame.capacity.indices {
        atomicAdd(&counters.lost, 1u);
        return;
    }
    indices[slot] = i0;
    indices[slot + 1u] = i1;
    indices[slot + 2u] = i2;
}

/// What may be taken: all, or so much that there is room left for what is drawn coarsely.
fn room_for(coarse: bool) -> Capacity {
    let all = frame.capacity;
    if coarse {
        return all;
    }
    return Capacity(all.vertices - all.vertices / 5u, all.indices - all.indices / 5u, all.work - all.work / 5u, all.thin - all.thin / 5u);
}

/// Takes room for the blocks of a piece, so that a full buffer is noticed while a coarser way is left. False if there is less room than
/// `most` allows.
fn emit_blocks(piece: Piece, levels: vec4<u32>, rows: u32, columns: u32, most: Capacity) -> bool {
    let fan = piece.kind != PIECE_TRIANGLE;
    var row = 0u;
    loop {
        if row >= rows { break; }
        var column = 0u;
        loop {
            if column >= columns { break; }
            let h = min(BLOCK, rows - row);
            let w = min(BLOCK, columns - column);
            let vertex_count = select((h + 1u) * (h + 2u) / 2u, (h + 1u) * (w + 1u), fan);
            let index_count = 3u * select(h * h, 2u * h * w, fan);
            if atomicLoad(&counters.work) >= most.work || atomicLoad(&counters.vertices) + vertex_count > most.vertices
                || atomicLoad(&counters.indices) + index_count > most.indices {
                return false;
            }
            // On a graphics card thousands of threads may have passed that test. Without vertices nothing else is taken, so that there are
            // always indices for the triangles of the model.
            let first_vertex = atomicAdd(&counters.vertices, vertex_count);
            if first_vertex + vertex_count > frame.capacity.vertices {
                return false;
            }
            let slot = atomicAdd(&counters.work, 1u);
            let first_index = atomicAdd(&counters.indices, index_count);
            if slot >= frame.capacity.work || first_index + index_count > frame.capacity.indices {
                // Other threads took the rest meanwhile. What was taken is left empty, so that no stale data is drawn.
                if slot < frame.capacity.work {
                    work[slot].vertex_count = 0u;
                    work[slot].triangle_count = 0u;
                }
                for (var i = first_index; i < min(first_index + index_count, frame.capacity.indices); i++) {
                    indices[i] = 0u;
                }
                return false;
            }
            work[slot] = WorkItem(piece, levels, rows, columns, row, column, first_vertex, first_index, vertex_count, index_count / 3u);
            // A thread of the mesh stage finds the item of its vertex by this.
            for (var i = 0u; i < vertex_count; i++) {
                seen[first_vertex + i].instance = slot;
            }
            column += BLOCK;
        }
        row += BLOCK;
    }
    return true;
}

/// What a thread hands on. It is collected first and handed over in one loop: compilers copy functions into every call, and with one call
/// per piece two passes took half a minute to compile.
struct Handed {
    piece: Piece,
    levels: vec4<u32>,
    /// Of the grid.
    rows: u32,
    columns: u32,
    /// HANDED_*.
    kind: u32,
}

/// To be split further.
const HANDED_PIECE: u32 = 0u;
/// To the mesh stage.
const HANDED_WORK: u32 = 1u;
/// The triangle of the model, as it is.
const HANDED_TRIANGLE: u32 = 2u;

var<private> handed: array<Handed, 4>;
var<private> handed_count: u32 = 0u;

fn hand(piece: Piece, levels: vec4<u32>, rows: u32, columns: u32, kind: u32) {
    handed[min(handed_count, 3u)] = Handed(piece, levels, rows, columns, kind);
    handed_count += 1u;
}

/// For the queue that the next pass of splitting reads.
fn emit_piece(instance: u32, triangle: u32, kind: u32, depth: u32, c0: vec3<f32>, c1: vec3<f32>, c2: vec3<f32>) {
    let piece = Piece(instance, triangle, kind, depth, c0, c1, c2);
    hand(piece, vec4<u32>(1u), 1u, 1u, HANDED_PIECE);
}

/// For the mesh stage.
fn emit_work(piece: Piece, levels: vec4<u32>, rows: u32, columns: u32) {
    hand(piece, levels, rows, columns, HANDED_WORK);
}

/// The triangle of the model as it is.
fn emit_whole(instance: u32, triangle: u32) {
    let none = vec3<f32>(0.0);
    hand(Piece(instance, triangle, PIECE_TRIANGLE, 0u, none, none, none), vec4<u32>(1u), 1u, 1u, HANDED_TRIANGLE);
}

/// So many times the room for work items, pieces may be split in a frame: halving makes as many pieces as there are parts in the end, and
/// more parts have no room. It bounds the time of a frame where splitting does not end, as for a ship at the horizon.
const MOST_SPLIT: u32 = 2u;

/// Hands over what was collected; pieces go to `queue`. A fifth of the buffers is kept back. If the rest is full, a piece is drawn without
/// subdivision; if that fifth is used up too, the triangle of the model is drawn in its place.
fn hand_over(queue: u32) {
    for (var k = 0u; k < min(handed_count, 4u); k++) {
        let item = handed[k];
        var piece = item.piece;
        let kind = item.kind;
        var done = false;
        if kind == HANDED_PIECE {
            let slot = atomicAdd(&counters.pieces[queue], 1u);
            if slot < frame.capacity.work && counters.split < MOST_SPLIT * frame.capacity.work && counters.is_last == 0u {
                pieces[queue * frame.capacity.work + slot] = piece;
                done = true;
            } else {
                atomicSub(&counters.pieces[queue], 1u);
            }
        }
        let whole = piece.kind != PIECE_FAN && piece.depth == 0u;
        // First as asked, then without subdivision.
        for (var attempt = select(1u, 0u, kind == HANDED_WORK); attempt < 2u; attempt++) {
            if done || kind == HANDED_TRIANGLE {
                break;
            }
            let coarse = attempt == 1u;
            if coarse {
                atomicAdd(&counters.coarse, 1u);
                if whole {
                    break;
                }
                piece.kind = select(piece.kind, PIECE_TRIANGLE, piece.kind == PIECE_STRIP);
            }
            let room = room_for(coarse);
            let size = select(vec2<u32>(item.rows, item.columns), vec2<u32>(1u), coarse);
            done = emit_blocks(piece, select(item.levels, vec4<u32>(1u), coarse), size.x, size.y, room);
        }
        if !done {
            let instance = instance_at(piece.instance);
            let triangle = model_triangle(piece.triangle);
            let corners = triangle.vertices + vec3<u32>(instance.first_seen);
            emit_triangle(corners.x, corners.y, corners.z, instance, facing_of(instance, triangle, instance.offset), triangle.seen_from);
        }
    }
}

/// Whether a patch with these corners is surely off the screen: all corners are beyond one side, or before the near plane, by more than the
/// patch sags.
fn off_screen(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, error: f32) -> bool {
    let fx = frame.focal.x;
    let fy = frame.focal.y;
    let sx = inverseSqrt(1.0 + fx * fx);
    let sy = inverseSqrt(1.0 + fy * fy);
    // A third more than the measured error: the curve may bulge most between the measured points.
    let sag = min(1.34 * error, 3.0);
    let margin = vec3<f32>(length(a), length(b), length(c)) * sag;
    let x = vec3<f32>(a.x, b.x, c.x);
    let y = vec3<f32>(a.y, b.y, c.y);
    let z = -vec3<f32>(a.z, b.z, c.z);
    return all((z - x * fx) * sx < -margin) || all((z + x * fx) * sx < -margin)
        || all((z - y * fy) * sy < -margin) || all((z + y * fy) * sy < -margin) || all(z - frame.near < -margin);
}
