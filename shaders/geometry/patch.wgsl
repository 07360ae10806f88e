#define_import_path lensrunner::geometry::patch

// What the stages after the vertices share: the axis, the error of an edge, points of a patch.

#import lensrunner::chosen::static_body::static_body_momentum
#import lensrunner::chosen::worldlines::turning_slack
#import lensrunner::geometry::bindings::model_position
#import lensrunner::geometry::clip::pixel_fineness
#import lensrunner::geometry::project::{frequency_ratio, leaving_direction, ProjectedPoint, ProjectionInput, side_towards, Sight}
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::{
    FLAG_MIDPOINT, Instance, INSTANCE_NARROW_RING, INSTANCE_STATIC, INSTANCE_THIN, is_thin, is_thin_ring, ModelTriangle, SeenVertex, SIDE_AGAINST,
    SIDE_LONE, SIDE_OPEN, two_sided,
}
#import lensrunner::instances::instance::{normal_of, shaped}
#import lensrunner::instances::local_motion::turned_by

/// Deepest splitting. An edge that passes the axis at a millionth of its length takes a third of it (`halfway`), and not all edges are
/// halved at the same time.
const DEEPEST: u32 = 24u;
/// Cells of a block of the mesh stage; an edge that needs more segments is split.
const BLOCK: u32 = 8u;

/// The emitter's momentum and γ: the object's own, or for a static body, that of a point of it there.
fn momentum_at(instance: Instance, position: vec3<f32>) -> vec4<f32> {
    if (instance.flags & INSTANCE_STATIC) == 0u {
        return vec4<f32>(instance.momentum, instance.gamma);
    }
    return static_body_momentum(position);
}

/// The seen vertex of a point that was found; `normal` and `attitude` are those of the body there.
fn seen_vertex(instance: Instance, index: u32, found: ProjectedPoint, attitude: vec4<f32>, normal: vec3<f32>, uv: vec2<f32>,
    material: u32) -> SeenVertex {
    let ray = found.ray;
    var vertex: SeenVertex;
    vertex.apparent = ray.apparent;
    vertex.path = ray.delay;
    let momentum = momentum_at(instance, found.position);
    let turned = select(normal_of(instance, normal), turned_by(attitude, normal), dot(attitude, attitude) > 0.0);
    vertex.normal = turned;
    vertex.shift = frequency_ratio(ray.arriving, ray.leaving, momentum);
    vertex.leaving = leaving_direction(ray.leaving, momentum);
    vertex.radius = length(found.position);
    vertex.uv = uv;
    vertex.instance = index;
    vertex.material = material;
    vertex.axis_uv = uv;
    vertex.from_axis = 1.0;
    vertex.height = found.position.z;
    return vertex;
}

/// Whether the image of this order ends at the axis: behind the hole (φ = π) always, on the near side (φ = 0) from order 2 on. `along` is
/// the offset from the camera along the outward radial.
fn axis_matters(along: f32, order: u32) -> bool {
    return frame.camera_radius + along < 0.0 || order >= 2u;
}

/// The offset from the camera, in rain axes, of a position by the axis (`ProjectedPoint.by_axis`).
fn offset_of(by_axis: vec3<f32>) -> vec3<f32> {
    return frame.side_a * by_axis.x + frame.side_b * by_axis.y + frame.outward * by_axis.z;
}

/// The cross product of two positions across the axis: twice the area of the triangle that they make with the axis, positive if b is
/// counterclockwise of a. If the ends of an edge are always given in the order of the model, the sign is the same for all triangles of the
/// edge. Then they agree on which side of the edge the axis is, and of a closed sheet round the axis exactly one triangle contains it.
fn area_with_axis(a: vec2<f32>, b: vec2<f32>) -> f32 {
    return fma(a.x, b.y, -(a.y * b.x));
}

/// Where the axis meets a triangle, barycentric; negative where it does not. The corners are positions by the axis, in the order of the
/// model. A zero counts as positive.
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

/// The largest turn of an edge about the axis, in radians. An edge with a larger one is split, whatever its error. A triangle whose sides
/// turn by less than a third of a circle does not reach across the ring, and with much smaller turns equal parts of an edge turn about
/// equally. Thin images and narrow rings lie mostly near the ring, so their limit is smaller.
fn most_turn(instance: Instance) -> f32 {
    return select(0.5, 0.25, (instance.flags & (INSTANCE_THIN | INSTANCE_NARROW_RING)) != 0u);
}

/// The turn of an edge about the axis, in radians, from its ends as positions by the axis; 0 where the image does not end at the axis.
fn turn_about_axis(a: vec3<f32>, b: vec3<f32>, order: u32) -> f32 {
    let turn = abs(atan2(area_with_axis(a.xy, b.xy), dot(a.xy, b.xy)));
    return select(0.0, turn, axis_matters(a.z, order) || axis_matters(b.z, order));
}

/// The same for an edge of which three points between its ends are known. The edge of a moving body is curved: one that passes close by the
/// axis may swing round it although both its ends are seen on the same side.
fn turn_along(a: vec3<f32>, quarter: vec3<f32>, middle: vec3<f32>, three_quarters: vec3<f32>, b: vec3<f32>, order: u32) -> f32 {
    return max(turn_about_axis(a, b, order), turn_about_axis(a, quarter, order) + turn_about_axis(quarter, middle, order)
        + turn_about_axis(middle, three_quarters, order) + turn_about_axis(three_quarters, b, order));
}

/// Whether three positions by the axis are so near to it that f32 tells nothing of their azimuths. Nothing is visible between them.
fn is_lost(instance: Instance, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> bool {
    let farthest = max(length(a.xy), max(length(b.xy), length(c.xy)));
    return farthest < 8.0 * instance.rounding && axis_matters(a.z, instance.order);
}

/// Whether three positions by the axis are so near to it that rounding decides on the last percents of a turn. A piece there is drawn by
/// its corners alone, if it turns little, or left out: its part of the ring is a small part of a pixel wide, but a chord would be seen.
fn is_blurred(instance: Instance, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> bool {
    let farthest = max(length(a.xy), max(length(b.xy), length(c.xy)));
    return farthest < BLURRED_ROUNDINGS * instance.rounding && axis_matters(a.z, instance.order);
}

/// Roundings from the axis within which positions are blurred.
const BLURRED_ROUNDINGS: f32 = 128.0;
/// The largest turn about the axis, in radians, of a blurred piece that is drawn. Its chord sags by 0.1²/8 of the ring's radius.
const BLURRED_TURN: f32 = 0.1;

/// An edge turns unevenly about the axis if one of its segments turns this many times as much as their mean. The quarters at which its
/// error is measured then miss the part that bends most.
const UNEVEN: f32 = 2.0;

/// The sag of that segment of an edge which turns most about the axis, in radians; 0 if all turn about equally. The edge has `level` equal
/// segments and turns by `turn` in all; its ends are positions by the axis. Its image runs along the ring first and outwards later, so at
/// most all of its length `seen_under` (radians) belongs to the turn: the ring's radius is at most `seen_under` / `turn`, and an arc of
/// radius R and angle δ sags by R δ²/8.
fn uneven_sag(a: vec3<f32>, b: vec3<f32>, level: u32, turn: f32, seen_under: f32) -> f32 {
    let a_is_near = dot(a.xy, a.xy) < dot(b.xy, b.xy);
    let near = select(b.xy, a.xy, a_is_near);
    let far = select(a.xy, b.xy, a_is_near);
    let next = mix(near, far, vec2<f32>(1.0 / f32(level)));
    let first = abs(atan2(area_with_axis(near, next), dot(near, next)));
    return select(0.0, 0.125 * seen_under * first * first / turn, turn > LEAST_TURN && first * f32(level) > UNEVEN * turn);
}

/// Roundings from the axis within which a vertex or an edge counts as on it. Objects are drawn `BESIDE` = 4 roundings beside their true
/// position (src/render/instances/mod.rs). So what was put on the axis is counted on it: at four roundings azimuths have one digit.
const CORE_ROUNDINGS: f32 = 8.0;

/// Distance from the axis, in r_s, within which a vertex or an edge of a model counts as on it: the larger of the rounding error and a
/// tenth of a pixel over the picture's width. It is the same for all triangles of the vertex or the edge, so the surface stays closed. A
/// point moved onto the axis is seen elsewhere on the ring: from a tenth of a pixel beside the axis, half a pixel off at most, on a ring as
/// wide as the screen. In a thin image areas count, and the object may be a small part of a pixel: there only rounding counts.
fn axis_core(instance: Instance, apparent: vec3<f32>) -> f32 {
    let pixel = frame.pixel / pixel_fineness(apparent, apparent) * length(apparent);
    return select(max(CORE_ROUNDINGS * instance.rounding, 0.1 * pixel / frame.size.x), instance.rounding, is_thin(instance));
}

/// Within this share of a pixel of the axis all that is visible is that the ring is whole.
const AXIS_SHARE: f32 = 0.02;

/// The most segments that an edge needs between two positions by the axis, where a pixel spans `pixel`, in r_s.
fn most_segments(instance: Instance, a: vec3<f32>, b: vec3<f32>, pixel: f32) -> u32 {
    let core = max(length(a.xy), length(b.xy)) < AXIS_SHARE * pixel && axis_matters(a.z, instance.order);
    return select(0xffffu, BLOCK, core);
}

/// Error of an edge that must be split, radians: a right angle and more.
const MUST_SPLIT: f32 = 3.0;

fn angle_between(a: vec3<f32>, b: vec3<f32>) -> f32 {
    return atan2(length(cross(a, b)), dot(a, b));
}

/// Share of the budget that a chord may use. Inside a patch the error is larger than on its sides: in a triangle up to 4/3 of it (for a
/// quadratic map with the same error on all sides), in a cell of a fan the sum of row, column and diagonal.
const CHORD_SHARE: f32 = 0.45;
/// Share of the budget for the arc of a fan at the axis. Two orders meet there, each with its own chords.
const ARC_SHARE: f32 = 0.015625;

/// The number of segments that brings the error of a chord (radians) under its share of the budget: the error falls as the square of that
/// number. A whole edge of the model may be halved `switches.y` times; `part` is the share of it that the chord spans, so that both of its
/// sides agree.
fn level_for(error: f32, part: f32) -> u32 {
    let n = ceil(sqrt(error / (select(CHORD_SHARE, 1.0, by_midpoint()) * frame.error_budget)));
    // Not-a-number compares false.
    if n > 1.0 {
        return u32(clamp(n, 1.0, max(part * f32(1u << frame.halvings), 1.0)));
    }
    return 1u;
}

/// The share of an edge of the model that the line between two barycentric corners spans.
fn part_between(a: vec3<f32>, b: vec3<f32>) -> f32 {
    let d = abs(b - a);
    return max(d.x, max(d.y, d.z));
}

/// Whether edges are divided by their midpoints alone, all alike: the criterion of Yamashita 2025.
fn by_midpoint() -> bool {
    return (frame.flags & FLAG_MIDPOINT) != 0u;
}

/// Factor by which the error of all chords of an image counts more, from its width and the fineness of its model.
fn strictness(instance: Instance) -> f32 {
    return select(instance.strictness, 1.0, by_midpoint());
}

/// The same for narrow images that are not thin: all their edges are near an outline and would bulge over it.
fn narrow_strictness(instance: Instance) -> f32 {
    return select(instance.strictness, 1.0, is_thin(instance));
}

/// Factor for outlines: there an error shows as surface where there is none.
const LIMB_STRICTNESS: f32 = 9.0;
/// The same for narrow rings (images of orders 2 and 3), which are little more than outline, stretched along the ring.
const NARROW_RING_LIMB_STRICTNESS: f32 = 24.0;

/// The same for thin images, on top of their own factor: what counts is their area and that they are unbroken.
const THIN_LIMB_STRICTNESS: f32 = 3.0;

/// Factor for outlines relative to other edges of the same image.
fn limb_strictness(instance: Instance) -> f32 {
    if is_thin(instance) {
        // Of a thin ring what chords cut off is added to the coverage (emit.wgsl).
        return select(THIN_LIMB_STRICTNESS, 1.0, is_thin_ring(instance));
    }
    let outline = select(LIMB_STRICTNESS, NARROW_RING_LIMB_STRICTNESS, (instance.flags & INSTANCE_NARROW_RING) != 0u);
    return select(max(outline / narrow_strictness(instance), 1.0), 1.0, by_midpoint());
}

/// Factor for edges beside the axis: there the image of the order ends, and a chord that bulges farther than its distance from the ring
/// shows surface beyond it. The strictness of narrow images is divided out. `nearest` is the distance of the edge's ends from the axis,
/// `pixel` what a pixel spans there, both in r_s.
fn ring_strictness(instance: Instance, nearest: f32, pixel: f32, along: f32) -> f32 {
    let pixels_away = nearest / pixel;
    let closer = clamp(1.0 / max(pixels_away, 1e-6), 1.0, LIMB_STRICTNESS);
    let matters = axis_matters(along, instance.order) && !by_midpoint() && !is_thin_ring(instance);
    return select(1.0, max(closer / narrow_strictness(instance), 1.0), matters);
}

/// If light leaves a triangle under a sine below this, it may be seen edge on somewhere.
const LIMB_SINE: f32 = 0.15;

/// Whether the edge of a model between two triangles may be an outline: light leaves one of them outward and the other inward, or does so
/// differently at its two ends (directions at T₀, `before_turning`). Normals of vertices, which are for shading, do not tell this for a
/// body with corners. Nor do positions on the screen: an edge stretched along the ring bends by more than the width of its triangles.
/// `edge` has the two vertices of the edge and the two opposite to it.
fn on_limb(instance: Instance, edge: vec4<u32>, leaving_a: vec3<f32>, leaving_b: vec3<f32>, offset: vec3<f32>) -> bool {
    let first = instance.first_vertex;
    let corner = model_position(first + edge.x);
    let along = shaped(instance, model_position(first + edge.y) - corner);
    let c = shaped(instance, model_position(first + edge.z) - corner);
    let d = shaped(instance, model_position(first + edge.w) - corner);
    // The normals of both triangles on the same side of the surface.
    let n = at_rest(instance, cross(along, c), offset);
    let m = at_rest(instance, cross(d, along), offset);
    let sines = vec4<f32>(dot(n, leaving_a), dot(n, leaving_b), dot(m, leaving_a), dot(m, leaving_b));
    let least = vec4<f32>(LIMB_SINE + turning_slack(instance));
    return !(all(sines > least) || all(sines < -least));
}

/// The error of the chord of a seen curve from a to b, in radians. It is the greatest angle between the points at ¼, ½, ¾ and the chord;
/// or, if that is more, four times the greatest angle between one of these points and the chord of its two neighbours. Halving an evenly
/// bent curve divides the error by four. So the second term makes equal segments, which `level_for` counts, short enough for the part that
/// bends most.
///
/// What rounding may displace (`Slack`) is no error: it does not become less by halving, and nobody sees it.
fn chord_error(a: vec3<f32>, quarter: vec3<f32>, middle: vec3<f32>, three_quarters: vec3<f32>, b: vec3<f32>, slack: Slack) -> f32 {
    let whole = max(slant(middle, a + b, slack), max(slant(quarter, a * 3.0 + b, slack), slant(three_quarters, a + b * 3.0, slack)));
    let part = max(slant(middle, quarter + three_quarters, slack),
        max(slant(quarter, a + middle, slack), slant(three_quarters, middle + b, slack)));
    return atan(max(sqrt(whole), 4.0 * sqrt(part)));
}

/// The error that an edge is divided by: that of its chord, or the displacement of its midpoint alone, where that is asked for.
fn edge_error(a: vec3<f32>, quarter: vec3<f32>, middle: vec3<f32>, three_quarters: vec3<f32>, b: vec3<f32>, slack: Slack) -> f32 {
    let midpoint = atan(sqrt(slant(middle, normalize(a) + normalize(b), exact())));
    return select(chord_error(a, quarter, middle, three_quarters, b, slack), midpoint, by_midpoint());
}

/// How far rounding may displace a point along its ring: a point beside the axis is seen at an azimuth that has the error of its place over
/// its distance from the axis.
struct Slack {
    /// Unit vector along the ring, camera axes; 0 if the image does not end at the axis.
    along: vec3<f32>,
    /// Radians.
    most: f32,
}

/// No slack.
fn exact() -> Slack {
    return Slack(vec3<f32>(0.0), 0.0);
}

/// How what is seen by `ray` moves for a turn about the axis: along its ring, by the ring's radius. Radians, camera axes.
fn ring_tangent(ray: Sight) -> vec3<f32> {
    let seen_at = -ray.arriving.xyz / ray.arriving.w;
    // The light's null vector (seen_at, −1) and its change for a turn about the axis, both in camera axes.
    let light = ray.apparent / ray.delay;
    let turned = (frame.camera_from_rain * vec4<f32>(cross(frame.outward, seen_at), 0.0)).xyz;
    return (turned - light * (dot(light, turned) / dot(light, light))) * inverseSqrt(dot(light, light));
}

/// The slack of an edge in whose middle the ring has this tangent. Its nearest end is `nearest` (r_s) from the axis, and `along` as in
/// `axis_matters`.
fn slack_of(instance: Instance, tangent: vec3<f32>, nearest: f32, along: f32) -> Slack {
    let radius = length(tangent);
    if !axis_matters(along, instance.order) || !(radius > 1e-6) {
        return exact();
    }
    // Two points may be displaced against each other by twice that.
    return Slack(tangent / radius, 2.0 * radius * instance.rounding / max(nearest, instance.rounding));
}

/// The square of the tangent of the angle between two directions, less what is slack; from a right angle on, as good as infinite.
fn slant(a: vec3<f32>, b: vec3<f32>, slack: Slack) -> f32 {
    let cosine = dot(a, b);
    let beside = cross(a, b);
    let square = min(dot(beside, beside) / (cosine * cosine), 1e12);
    let along = dot(a, slack.along) * dot(b, b) / cosine - dot(b, slack.along);
    let length_along = abs(along) * inverseSqrt(dot(b, b));
    let counted = max(length_along - slack.most, 0.0);
    return select(1e12, max(square - length_along * length_along, 0.0) + counted * counted, cosine > 0.0);
}

/// The body point of barycentric coordinates in a model triangle. The fused products are written out, in this order: a driver that fuses as
/// it likes would give the point of an edge other bits in each of its two triangles.
fn body_point(instance: Instance, triangle: ModelTriangle, corner: vec3<f32>) -> vec3<f32> {
    let first = instance.first_vertex;
    let a = model_position(first + triangle.vertices.x) * corner.x;
    let b = fma(model_position(first + triangle.vertices.y), vec3<f32>(corner.y), a);
    return fma(model_position(first + triangle.vertices.z), vec3<f32>(corner.z), b);
}

/// The unit normal that points out of the closed body of a model triangle, in the rest frame of what is at `offset` from the camera. Zero
/// if the surface is not closed or both sides are drawn.
fn outward_normal(instance: Instance, triangle: ModelTriangle, offset: vec3<f32>) -> vec3<f32> {
    let sign = select(1.0, -1.0, (triangle.side & SIDE_AGAINST) != 0u);
    return plane_normal(instance, triangle, offset) * select(sign, 0.0, triangle.side == SIDE_OPEN || two_sided(instance));
}

/// If light leaves a triangle below its plane by more than this, as a sine, the body itself hides it. Between the corners the directions of
/// light vary about as much as among them; this is for what curvature adds.
const TURNED_AWAY: f32 = 0.05;
/// Nearer to the horizon than this radius, in r_s, nothing is left out: static observers there see the body stretched without bound.
const LEAST_RADIUS_TURNED: f32 = 1.05;

/// Whether all light that a piece of a closed body's triangle sends to the camera leaves on its inner side, so that the body itself hides
/// it. l0, l1, l2: the directions in which light leaves its corners, rest frame, at T₀ (`before_turning`); w: their radii.
fn turned_away(instance: Instance, triangle: ModelTriangle, offset: vec3<f32>, l0: vec4<f32>, l1: vec4<f32>, l2: vec4<f32>) -> bool {
    let n = outward_normal(instance, triangle, offset);
    let most = max(dot(n, l0.xyz), max(dot(n, l1.xyz), dot(n, l2.xyz)));
    let spread = max(distance(l0.xyz, l1.xyz), max(distance(l1.xyz, l2.xyz), distance(l2.xyz, l0.xyz)));
    // The crack between two bodies that abut is a small part of a pixel in a narrow image.
    let closed = (triangle.side & SIDE_LONE) != 0u || narrow_strictness(instance) > 1.0;
    return closed && min(l0.w, min(l1.w, l2.w)) > LEAST_RADIUS_TURNED && most < -(TURNED_AWAY + turning_slack(instance) + spread);
}

/// A unit normal of a model triangle in the rest frame of what is at `offset` from the camera.
fn plane_normal(instance: Instance, triangle: ModelTriangle, offset: vec3<f32>) -> vec3<f32> {
    let first = instance.first_vertex;
    let corner = model_position(first + triangle.vertices.x);
    let a = shaped(instance, model_position(first + triangle.vertices.y) - corner);
    let b = shaped(instance, model_position(first + triangle.vertices.z) - corner);
    return at_rest(instance, cross(a, b), offset);
}

/// The side of a model triangle by which it is decided whether its image is turned over.
struct Facing {
    /// A unit normal in the rest frame: outward for a closed body, else on the side from which the corners run counterclockwise.
    normal: vec3<f32>,
    /// Sense in which the corners run on the screen where that side is seen, +1 counterclockwise; 0 if it cannot be told.
    turn: f32,
    /// Whether the other side is never seen.
    closed: bool,
}

/// The facing of a model triangle at `offset` from the camera. Light that has passed the axis once (even orders) shows its source mirrored.
fn facing_of(instance: Instance, triangle: ModelTriangle, offset: vec3<f32>) -> Facing {
    let sign = select(1.0, -1.0, (triangle.side & SIDE_AGAINST) != 0u);
    let mirrored = select(1.0, -1.0, instance.order == 2u);
    let both = two_sided(instance);
    return Facing(plane_normal(instance, triangle, offset) * sign, select(sign * mirrored, 0.0, both),
        triangle.side != SIDE_OPEN && !both);
}

/// The unit normal of a plane on the slice, transformed to the rest frame of what is at `offset` from the camera: along the motion lengths
/// are γ times longer there.
fn at_rest(instance: Instance, on_slice: vec3<f32>, offset: vec3<f32>) -> vec3<f32> {
    let momentum = momentum_at(instance, frame.outward * frame.camera_radius + offset);
    let n = on_slice - momentum.xyz * (dot(momentum.xyz, on_slice) / (momentum.w * (1.0 + momentum.w)));
    return n / max(length(n), 1e-30);
}

/// Whether barycentric corner a comes before b on their edge: the one nearer to the lower vertex first, which both triangles of the edge
/// agree on.
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

/// A point of a fan round the axis. `outer` is a point of the outer edge, by the axis; `apex` is the position along the axis of the
/// innermost point; `s` runs from the axis (0) to the edge (1). The azimuth is that of the outer point for every s, also on the axis
/// itself.
fn fan_input(apex: f32, outer: vec3<f32>, s: f32) -> ProjectionInput {
    let along = mix(apex, outer.z, s);
    return ProjectionInput(vec3<f32>(0.0), true, along, length(outer.xy) * s, frame.camera_radius + along, side_towards(outer.xy));
}

/// An edge with a smaller turn about the axis, in radians, is halved in its middle.
const LEAST_TURN: f32 = 0.05;

/// Where an edge is halved, as a share of the way from a to b (positions across the axis). The image of an edge that passes beside the axis
/// runs along the ring near the foot of the axis, and along two radii beyond. So the halves are equal in asinh(s/h), s along the edge from
/// the foot and h the distance of the axis. An edge that passes the axis at a millionth of its length then takes five halvings and not
/// twenty.
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

/// asinh; the built-in one loses its digits for large negative numbers.
fn inverse_sinh(x: f32) -> f32 {
    return sign(x) * log(abs(x) + sqrt(x * x + 1.0));
}
