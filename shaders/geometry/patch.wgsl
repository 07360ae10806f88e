// What the stages after the vertices share: the axis, the error of an edge, points of a patch.

/// Deepest splitting. A third of it is what an edge takes that passes the axis at a millionth of its length (`halfway`), and not all edges are halved at a time.
const DEEPEST: u32 = 24u;
/// Cells of a block of the mesh stage; an edge that needs more segments is split.
const BLOCK: u32 = 8u;

/// The emitter's momentum and γ: the object's own, or for one that is held in place everywhere, that of what is held there.
fn momentum_at(instance: Instance, position: vec3<f32>) -> vec4<f32> {
    if (instance.triangles.w & INSTANCE_HELD) == 0u {
        return instance.momentum;
    }
    return held_momentum(position);
}

fn seen_vertex(instance: Instance, index: u32, found: Answer, normal: vec3<f32>, uv: vec2<f32>, material: u32) -> SeenVertex {
    let ray = found.ray;
    var vertex: SeenVertex;
    vertex.apparent = vec4<f32>(ray.apparent, ray.delay);
    let momentum = momentum_at(instance, found.position);
    vertex.normal = vec4<f32>(normal, frequency_ratio(ray.arriving, ray.leaving, momentum));
    vertex.leaving = vec4<f32>(leaving_direction(ray.leaving, momentum), length(found.position));
    vertex.surface = vec4<f32>(uv, bitcast<f32>(index), bitcast<f32>(material));
    vertex.fan = vec4<f32>(uv, 1.0, found.position.z);
    return vertex;
}

/// Whether the axis is an edge of the image of this order: behind the hole (φ = π) always, on the near side (φ = 0) from order 2 on.
/// `along` is the offset from the camera along the outward radial.
fn axis_matters(along: f32, order: u32) -> bool {
    return frame.radial.w + along < 0.0 || order >= 2u;
}

/// The offset from the camera, rain axes, of a place given by the axis (`Answer.by_axis`).
fn offset_of(by_axis: vec3<f32>) -> vec3<f32> {
    return frame.side_a.xyz * by_axis.x + frame.side_b.xyz * by_axis.y + frame.radial.xyz * by_axis.z;
}

/// The cross product of two places across the axis: twice the area that they make with the axis, positive if b lies counterclockwise of a. Asked
/// with the ends of an edge in the order of the model, its sign is the same for all triangles of the edge: then they agree on which side of the edge the
/// axis is, and of a closed sheet round it exactly one triangle has it inside.
fn area_with_axis(a: vec2<f32>, b: vec2<f32>) -> f32 {
    return fma(a.x, b.y, -(a.y * b.x));
}

/// Where the axis meets the triangle of three corners that are given by the axis, barycentric; negative where it does not. The corners in the
/// order of the model. A zero counts as positive.
fn meets_axis(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, order: u32) -> vec3<f32> {
    let ab = area_with_axis(a.xy, b.xy);
    let bc = area_with_axis(b.xy, c.xy);
    let ac = area_with_axis(a.xy, c.xy);
    let sum = ab + bc - ac;
    let round = (ab >= 0.0) == (bc >= 0.0) && (ab >= 0.0) != (ac >= 0.0);
    if !round || sum == 0.0 {
        return vec3<f32>(-1.0);
    }
    let at = vec3<f32>(bc, -ac, ab) / sum;
    return select(vec3<f32>(-1.0), at, axis_matters(dot(at, vec3<f32>(a.z, b.z, c.z)), order));
}

/// The most that an edge may turn about the axis, radians: one that turns farther is split, whatever its error. Of a triangle whose sides turn by less than a
/// third of a circle the inside cannot reach across the ring; and where they turn much less, equal parts of them turn about equally. In thin and narrow images,
/// most of which lies near the ring, they must do so the better.
fn most_turn(instance: Instance) -> f32 {
    return select(0.5, 0.25, (instance.triangles.w & (INSTANCE_THIN | INSTANCE_NARROW)) != 0u);
}

/// By how much an edge between two places that are given by the axis turns about it, radians; 0 where the axis is a place as any other.
fn turn_about_axis(a: vec3<f32>, b: vec3<f32>, order: u32) -> f32 {
    let turn = abs(atan2(area_with_axis(a.xy, b.xy), dot(a.xy, b.xy)));
    return select(0.0, turn, axis_matters(a.z, order) || axis_matters(b.z, order));
}

/// Whether three places that are given by the axis are so near to it that f32 tells nothing of their azimuths. Between them there is nothing to see.
fn is_lost(instance: Instance, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> bool {
    let farthest = max(length(a.xy), max(length(b.xy), length(c.xy)));
    return farthest < 8.0 * instance.axis.z && axis_matters(a.z, instance.ids.x);
}

/// How far from the axis a vertex or an edge of a model counts as on it, in r_s: as far as rounding may have moved it, and so far that nobody sees the
/// difference. It is the same for all triangles of the vertex or the edge, so what is drawn stays closed. A point beside the axis, moved so far, is turned about it
/// and seen elsewhere on the ring: at a tenth of a pixel from the axis half a pixel at most, on a ring as wide as the screen. In a thin image areas count, and of
/// its pixels the object may be a small part: there it is rounding alone.
fn axis_core(instance: Instance, apparent: vec3<f32>) -> f32 {
    let pixel = frame.size.z / pixel_fineness(apparent, apparent) * length(apparent);
    return max(instance.axis.z, select(0.1 * pixel / frame.size.x, 0.0, is_thin(instance)));
}

/// How many segments, at most, an edge needs between two places that are given by the axis, where a pixel spans `pixel`: within a fiftieth of a pixel of the
/// axis, where azimuths are lost in the rounding of f32, there is no more to see than that the ring is whole.
fn most_segments(instance: Instance, a: vec3<f32>, b: vec3<f32>, pixel: f32) -> u32 {
    let core = max(length(a.xy), length(b.xy)) < 0.02 * pixel && axis_matters(a.z, instance.ids.x);
    return select(0xffffu, BLOCK, core);
}

/// Error of an edge that must be split, radians: a right angle and more.
const MUST_SPLIT: f32 = 3.0;

fn angle_between(a: vec3<f32>, b: vec3<f32>) -> f32 {
    return atan2(length(cross(a, b)), dot(a, b));
}

/// How much of the budget a chord may use. What a patch shows inside is off by more than its sides are: in a triangle by up to 4/3 of it
/// (where a quadratic map has the same error on all sides), in a cell of a fan by the sum of row, column and diagonal.
const CHORD_SHARE: f32 = 0.45;
/// How much of the budget the arc of a fan at the axis may be off. Two orders meet there, each with chords of its own.
const ARC_SHARE: f32 = 0.015625;

/// The level that brings the error of a chord under its share of the budget: the error falls as the square of the number of segments. A whole
/// edge of the model may be halved `switches.y` times; `part` is how much of it the chord spans, so that both sides of it agree.
fn level_for(error: f32, part: f32) -> u32 {
    let n = ceil(sqrt(error / (CHORD_SHARE * frame.size.w)));
    // Not-a-number compares false.
    if n > 1.0 {
        return u32(clamp(n, 1.0, max(part * f32(1u << frame.switches.y), 1.0)));
    }
    return 1u;
}

/// How much of an edge of the model the line between two barycentric corners spans.
fn part_between(a: vec3<f32>, b: vec3<f32>) -> f32 {
    let d = abs(b - a);
    return max(d.x, max(d.y, d.z));
}

/// How much closer all chords of an image are held than the budget says, told by how wide it is and how fine its model.
fn strictness(instance: Instance) -> f32 {
    return instance.axis.w;
}

/// The same for images that are a few pixels wide and not thin: there every edge is near an outline and would bulge over it.
fn slimness(instance: Instance) -> f32 {
    return select(instance.axis.w, 1.0, is_thin(instance));
}

/// Outlines are held closer than what lies inside them: there an error shows as surface where there is none.
const LIMB_STRICTNESS: f32 = 9.0;
/// The same for images of higher orders a few pixels wide, of which hardly more than the outline is seen, and that drawn out along the ring.
const NARROW_LIMB_STRICTNESS: f32 = 24.0;

/// The same for thin images, on top of their own: what counts is their area and that they are whole.
const THIN_LIMB_STRICTNESS: f32 = 3.0;

/// By how much closer outlines are held than other edges of the same image.
fn limb_strictness(instance: Instance) -> f32 {
    if is_thin(instance) {
        return THIN_LIMB_STRICTNESS;
    }
    let outline = select(LIMB_STRICTNESS, NARROW_LIMB_STRICTNESS, (instance.triangles.w & INSTANCE_NARROW) != 0u);
    return max(outline / slimness(instance), 1.0);
}

/// How much closer the edges beside the axis are held in the image: there the order's image ends, and a chord that bulges farther than the ring is away shows
/// surface beyond it. `nearest` is the distance of the edge's ends from the axis, `pixel` what a pixel spans there.
fn ring_strictness(nearest: f32, pixel: f32, along: f32, order: u32) -> f32 {
    let pixels_away = nearest / pixel;
    return select(1.0, clamp(1.0 / max(pixels_away, 1e-6), 1.0, LIMB_STRICTNESS), axis_matters(along, order));
}

/// A triangle from which light leaves under a sine below this may be seen edge-on here or there: so far a ship may turn while light crosses it.
const LIMB_SINE: f32 = 0.15;

/// Whether the edge of a model between two triangles may be an outline: light leaves one of them outward and the other inward, or so differently
/// at its two ends. Normals of vertices, which are there for the light, do not tell that of a body with corners; nor do places on the screen, where
/// an edge drawn out along the ring bends by more than its triangles are wide. `edge` has the two vertices and those opposite to it.
fn on_limb(instance: Instance, edge: vec4<u32>, leaving_a: vec3<f32>, leaving_b: vec3<f32>, offset: vec3<f32>) -> bool {
    let first = instance.vertices.x;
    let corner = model_vertices[first + edge.x].position.xyz;
    let along = shaped(instance, model_vertices[first + edge.y].position.xyz - corner);
    let c = shaped(instance, model_vertices[first + edge.z].position.xyz - corner);
    let d = shaped(instance, model_vertices[first + edge.w].position.xyz - corner);
    // Of both triangles the normal on the same side of the surface.
    let n = at_rest(instance, cross(along, c), offset);
    let m = at_rest(instance, cross(d, along), offset);
    let sines = vec4<f32>(dot(n, leaving_a), dot(n, leaving_b), dot(m, leaving_a), dot(m, leaving_b));
    return !(all(sines > vec4<f32>(LIMB_SINE)) || all(sines < vec4<f32>(-LIMB_SINE)));
}

/// The greatest angle between points of the seen curve a–b (those at ¼, ½, ¾) and the chord that would replace it; or, where the curve bends most in
/// one part, between that part and its own chord, times the four by which the error of a curve that bends evenly falls when it is halved: equal
/// segments, which `level_for` counts, must be short enough for the part that bends most.
fn chord_error(a: vec3<f32>, quarter: vec3<f32>, middle: vec3<f32>, three_quarters: vec3<f32>, b: vec3<f32>) -> f32 {
    let whole = max(slant(middle, a + b), max(slant(quarter, a * 3.0 + b), slant(three_quarters, a + b * 3.0)));
    let part = max(slant(middle, quarter + three_quarters), max(slant(quarter, a + middle), slant(three_quarters, middle + b)));
    return atan(max(sqrt(whole), 4.0 * sqrt(part)));
}

/// The square of the tangent of the angle between two directions; from a right angle on, as good as infinite.
fn slant(a: vec3<f32>, b: vec3<f32>) -> f32 {
    let across = cross(a, b);
    let along = dot(a, b);
    return select(1e12, min(dot(across, across) / (along * along), 1e12), along > 0.0);
}

/// The body point of barycentric coordinates in a model triangle. Products are fused with sums, said so and in this order: a driver that fuses as it
/// likes makes other bits of an edge's point in one of its triangles than in the other.
fn body_point(instance: Instance, triangle: ModelTriangle, corner: vec3<f32>) -> vec3<f32> {
    let first = instance.vertices.x;
    let a = model_vertices[first + triangle.vertices.x].position.xyz * corner.x;
    let b = fma(model_vertices[first + triangle.vertices.y].position.xyz, vec3<f32>(corner.y), a);
    return fma(model_vertices[first + triangle.vertices.z].position.xyz, vec3<f32>(corner.z), b);
}

/// The unit normal that points out of the closed body a model triangle is a part of, in the rest frame of what is at `offset` from the camera;
/// zero where no side is outside, or both are drawn.
fn outward_normal(instance: Instance, triangle: ModelTriangle, offset: vec3<f32>) -> vec3<f32> {
    let sign = select(1.0, -1.0, (triangle.vertices.w & SIDE_AGAINST) != 0u);
    return plane_normal(instance, triangle, offset) * select(sign, 0.0, triangle.vertices.w == SIDE_OPEN || two_sided(instance));
}

/// A unit normal of a model triangle in the rest frame of what is at `offset` from the camera.
fn plane_normal(instance: Instance, triangle: ModelTriangle, offset: vec3<f32>) -> vec3<f32> {
    let first = instance.vertices.x;
    let corner = model_vertices[first + triangle.vertices.x].position.xyz;
    let a = shaped(instance, model_vertices[first + triangle.vertices.y].position.xyz - corner);
    let b = shaped(instance, model_vertices[first + triangle.vertices.z].position.xyz - corner);
    return at_rest(instance, cross(a, b), offset);
}

/// The side of a model triangle by which it is told whether its image is turned over.
struct Facing {
    /// A unit normal in the rest frame: outward of a closed body, else to that side from which the corners run counterclockwise.
    normal: vec3<f32>,
    /// The sense in which the corners run on the screen where that side is seen, +1 counterclockwise; 0 where it cannot be told.
    turn: f32,
    /// Whether the other side is never seen.
    closed: bool,
}

/// The facing of a model triangle at `offset` from the camera. Light that has passed the axis once shows what it left mirrored: even orders.
fn facing_of(instance: Instance, triangle: ModelTriangle, offset: vec3<f32>) -> Facing {
    let sign = select(1.0, -1.0, (triangle.vertices.w & SIDE_AGAINST) != 0u);
    let mirrored = select(1.0, -1.0, instance.ids.x == 2u);
    let both = two_sided(instance);
    return Facing(plane_normal(instance, triangle, offset) * sign, select(sign * mirrored, 0.0, both), triangle.vertices.w != SIDE_OPEN && !both);
}

/// The unit normal of a plane on the slice as it is in the rest frame of what is at `offset` from the camera: lengths along the motion are γ times
/// longer there.
fn at_rest(instance: Instance, on_slice: vec3<f32>, offset: vec3<f32>) -> vec3<f32> {
    let momentum = momentum_at(instance, frame.radial.xyz * frame.radial.w + offset);
    let n = on_slice - momentum.xyz * (dot(momentum.xyz, on_slice) / (momentum.w * (1.0 + momentum.w)));
    return n / max(length(n), 1e-30);
}

/// Whether a comes before b on an edge they share: the lower vertex first, which both triangles of the edge agree on.
fn comes_first(a: vec3<f32>, b: vec3<f32>) -> bool {
    if a.x != b.x {
        return a.x > b.x;
    }
    if a.y != b.y {
        return a.y > b.y;
    }
    return a.z >= b.z;
}

/// The point at fraction t from a to b, the same bits whichever end is called a.
fn edge_point(a: vec3<f32>, b: vec3<f32>, t: f32) -> vec3<f32> {
    if comes_first(a, b) {
        return a + (b - a) * t;
    }
    return b + (a - b) * (1.0 - t);
}

/// A point of the fan round the axis: `outer` is a point of its outer edge, by the axis, `apex` how far along the axis its innermost point is, `s` runs
/// from the axis (0) to the edge (1). The azimuth is that of the outer point for every s, also on the axis itself.
fn query_fan(apex: f32, outer: vec3<f32>, s: f32) -> Query {
    let along = mix(apex, outer.z, s);
    return Query(vec3<f32>(0.0), true, along, length(outer.xy) * s, frame.radial.w + along, side_towards(outer.xy));
}

/// An edge that turns by less about the axis is as any other, radians.
const LEAST_TURN: f32 = 0.05;

/// Where an edge between two places is halved, as a part of the way from a to b. Beside the axis its image runs along the ring near the foot of the axis on
/// it, and out along two radii beyond: where an edge turns about the axis, halves are equal in asinh of the distance from the foot over that of the axis, so
/// that an edge that passes the axis at a millionth of its length takes five halvings and not twenty.
fn halfway(a: vec2<f32>, b: vec2<f32>) -> f32 {
    let area = abs(area_with_axis(a, b));
    if dot(a, b) > 0.0 && area < LEAST_TURN * dot(a, b) {
        return 0.5;
    }
    let d = b - a;
    let reach = max(length(d), 1e-30);
    let miss = max(area / reach, 1e-6 * reach);
    let start = dot(a, d) / reach;
    let middle = miss * sinh(0.5 * (inverse_sinh(start / miss) + inverse_sinh((start + reach) / miss)));
    return clamp((middle - start) / reach, 1e-3, 0.999);
}

/// asinh, whose built-in is lost for large negative numbers.
fn inverse_sinh(x: f32) -> f32 {
    return sign(x) * log(abs(x) + sqrt(x * x + 1.0));
}
