// Stage 0, one thread for each body that is held in place and each of its images: does for it what `instances_of` of
// src/render/instances/mod.rs does for bodies that fly. What may be seen is appended to the instances of the processor, and to the lists of
// the stages.

#import lensrunner::chosen::method::method_ray
#import lensrunner::geometry::bindings::{Arguments, Counters, NO_INSTANCE}
#import lensrunner::geometry::clip::finite_vector
#import lensrunner::gpu::bindings::{frame, TABLE_ROW}
#import lensrunner::gpu::types::{
    Cap, Instance, INSTANCE_MINUS, INSTANCE_NARROW_RING, INSTANCE_STATIC, INSTANCE_THIN, INSTANCE_TWO_SIDED,
}
#import lensrunner::instances::held::{HeldBody, HeldFrame, HeldModel}
#import lensrunner::instances::instance::INSTANCE_TEXELS
#import lensrunner::instances::local_motion::turned_by
#import lensrunner::instances::view::{
    angle_of_sine, anywhere, Extent, extent_of, farthest_in_patch, is_drawn_out, MARGIN, may_be_seen, SCREEN_MARGIN, seen_cap, turn_of,
}
#import lensrunner::lensing::closed_form::{angle, HALF_TURN, sine_cosine}
#import lensrunner::lensing::lookup::{OLD, YOUNG}

@group(1) @binding(0) var<storage, read> held_frame: HeldFrame;
@group(1) @binding(1) var<storage, read> bodies: array<HeldBody>;
@group(1) @binding(2) var<storage, read> models: array<HeldModel>;
@group(1) @binding(3) var<storage, read_write> counters: Counters;
@group(1) @binding(4) var<storage, read_write> arguments: Arguments;
@group(1) @binding(5) var instance_table: texture_storage_2d<rgba32uint, write>;
@group(1) @binding(6) var vertex_chunks: texture_storage_2d<rg32uint, write>;
@group(1) @binding(7) var edge_chunks: texture_storage_2d<rg32uint, write>;
@group(1) @binding(8) var triangle_chunks: texture_storage_2d<rg32uint, write>;

/// An image of a body, before it has a place in the buffers.
struct Image {
    instance: Instance,
    shown: bool,
    /// Of the list of models: what is drawn of it, and what is if there is no room.
    model: u32,
    coarsest: u32,
}

/// What the images of this group take together: vertices, edges; then instances and chunks of vertices, edges, triangles.
var<workgroup> wanted: array<atomic<u32>, 6>;
/// Where that begins.
var<workgroup> granted: array<u32, 6>;
/// 1 if there was room for all of its vertices and edges.
var<workgroup> is_granted: u32;
/// Chunks to list: the instance of each thread, and for each kind the first one and how many.
var<workgroup> chunk_instances: array<u32, 64>;
var<workgroup> first_chunks: array<vec3<u32>, 64>;
var<workgroup> chunk_counts: array<vec3<u32>, 64>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    var image = image_of((group.y * groups.x + group.x) * 64u + lane);
    var first = vec2<u32>(0u);
    if image.shown {
        first = vec2<u32>(atomicAdd(&wanted[0], models[image.model].vertex_count), atomicAdd(&wanted[1], models[image.model].edge_count));
    }
    workgroupBarrier();
    if lane == 0u {
        let taken = take(0u, vec2<u32>(atomicLoad(&wanted[0]), atomicLoad(&wanted[1])));
        granted[0] = taken.first.x;
        granted[1] = taken.first.y;
        is_granted = select(0u, 1u, taken.fits);
    }
    workgroupBarrier();
    if is_granted == 1u {
        first += vec2<u32>(granted[0], granted[1]);
    } else if image.shown {
        // Each for itself; then more coarsely.
        var taken: Taken;
        for (var room = 0u; room < 2u && !taken.fits; room++) {
            image.model = select(image.model, image.coarsest, room == 1u);
            taken = take(room, vec2<u32>(models[image.model].vertex_count, models[image.model].edge_count));
            if taken.fits && room == 1u {
                atomicAdd(&counters.simpler, 1u);
            }
        }
        first = taken.first;
        if !taken.fits {
            atomicAdd(&counters.left_out, 1u);
            image.shown = false;
        }
    }
    var slot = 0u;
    var chunk = vec3<u32>(0u);
    var counts = vec3<u32>(0u);
    if image.shown {
        let model = models[image.model];
        counts = (vec3<u32>(model.vertex_count, model.edge_count, model.triangle_count) + 63u) / 64u;
        slot = atomicAdd(&wanted[2], 1u);
        chunk = vec3<u32>(atomicAdd(&wanted[3], counts.x), atomicAdd(&wanted[4], counts.y), atomicAdd(&wanted[5], counts.z));
    }
    workgroupBarrier();
    if lane == 0u {
        granted[2] = atomicAdd(&counters.images, atomicLoad(&wanted[2]));
        granted[3] = atomicAdd(&counters.chunks[0], atomicLoad(&wanted[3]));
        granted[4] = atomicAdd(&counters.chunks[1], atomicLoad(&wanted[4]));
        granted[5] = atomicAdd(&counters.chunks[2], atomicLoad(&wanted[5]));
    }
    workgroupBarrier();
    slot += granted[2];
    if image.shown && slot >= held_frame.images_end {
        atomicAdd(&counters.left_out, 1u);
        image.shown = false;
    }
    chunk_instances[lane] = select(NO_INSTANCE, slot, image.shown);
    first_chunks[lane] = chunk + vec3<u32>(granted[3], granted[4], granted[5]);
    chunk_counts[lane] = counts;
    if image.shown {
        let model = models[image.model];
        image.instance.first_seen = first.x;
        image.instance.first_state = first.y;
        image.instance.first_vertex = model.first_vertex;
        image.instance.vertex_count = model.vertex_count;
        image.instance.first_edge = model.first_edge;
        image.instance.edge_count = model.edge_count;
        image.instance.first_triangle = model.first_triangle;
        image.instance.triangle_count = model.triangle_count;
        image.instance.first_material = model.first_material;
        write_instance(slot, image.instance);
    }
    workgroupBarrier();
    // All threads together, for a model may have many.
    for (var of_lane = 0u; of_lane < 64u; of_lane++) {
        let listed = chunk_counts[of_lane];
        let begin = first_chunks[of_lane];
        let instance = chunk_instances[of_lane];
        for (var k = lane; k < max(listed.x, max(listed.y, listed.z)); k += 64u) {
            let words = vec4<u32>(instance, k * 64u, 0u, 0u);
            if k < listed.x {
                textureStore(vertex_chunks, table_place(begin.x + k), words);
            }
            if k < listed.y {
                textureStore(edge_chunks, table_place(begin.y + k), words);
            }
            if k < listed.z {
                textureStore(triangle_chunks, table_place(begin.z + k), words);
            }
        }
    }
}

/// After all: how much the stages have to do.
@compute @workgroup_size(1)
fn finish() {
    let coarse = min(atomicLoad(&counters.held_vertices[1]), held_frame.vertices_end[1]);
    let fine = min(atomicLoad(&counters.held_vertices[0]), held_frame.vertices_end[0]);
    let vertices = select(fine, coarse, coarse > held_frame.vertices_end[0]);
    atomicStore(&counters.vertices, vertices);
    counters.model_vertices = vertices;
    arguments.vertices = dispatch_of(0u);
    arguments.edges = dispatch_of(1u);
    arguments.triangles = dispatch_of(2u);
}

/// Most groups along one dimension of a dispatch; as in src/render/geometry/lists.rs.
const GROUPS: u32 = 32768u;

/// The dispatch over the chunks of a kind; those beyond the last are made none.
fn dispatch_of(kind: u32) -> vec4<u32> {
    let count = atomicLoad(&counters.chunks[kind]);
    let rows = max((count + GROUPS - 1u) / GROUPS, 1u);
    let columns = (count + rows - 1u) / rows;
    let none = vec4<u32>(NO_INSTANCE, 0u, 0u, 0u);
    for (var chunk = count; chunk < rows * columns; chunk++) {
        switch kind {
            case 0u: { textureStore(vertex_chunks, table_place(chunk), none); }
            case 1u: { textureStore(edge_chunks, table_place(chunk), none); }
            default: { textureStore(triangle_chunks, table_place(chunk), none); }
        }
    }
    return vec4<u32>(columns, rows, 1u, 0u);
}

fn table_place(texel: u32) -> vec2<u32> {
    return vec2<u32>(texel % TABLE_ROW, texel / TABLE_ROW);
}

/// Where vertices and edges begin that were taken from a room, if there was room for all of them.
struct Taken {
    first: vec2<u32>,
    fits: bool,
}

fn take(room: u32, counts: vec2<u32>) -> Taken {
    let end = vec2<u32>(held_frame.vertices_end[room], held_frame.states_end[room]);
    // Nothing is taken in vain, but where others take the rest meanwhile.
    let before = vec2<u32>(atomicLoad(&counters.held_vertices[room]), atomicLoad(&counters.held_states[room]));
    if any(before + counts > end) {
        return Taken(before, false);
    }
    let first = vec2<u32>(atomicAdd(&counters.held_vertices[room], counts.x), atomicAdd(&counters.held_states[room], counts.y));
    return Taken(first, all(first + counts <= end));
}

/// Factor on the ball's radius for bounds.
const LARGER: f32 = 1.1;
/// A ball whose radius is below this share of its distances from the axis and from the horizon is seen in one small patch.
const FAR: f32 = 0.3;
/// Number of points that are looked up for the extent, and those on the ball's circle in the plane of the axis for bounds.
const EXTENT_POINTS: u32 = 5u;
const PLACES: u32 = 32u;
/// Least radius, in r_s, of points that send light to a camera outside: of those of bounds, and of the extent.
const LEAST_RADIUS: f32 = 1.0001;
const LEAST_LOW_SIDE: f32 = 1.001;
/// As in src/render/instances/mod.rs: least size of a thin image for its stand-in, roundings of a point and of what is put beside them,
/// widths in pixels, and strictness.
const THIN_SIZE: f32 = 8.0;
const BESIDE: f32 = 4.0;
const ROUNDING: f32 = 4e-7;
const NARROW_RING_BELOW: f32 = 10.0;
const THIN_STRICTNESS: f32 = 4.0;
const THIN_RING_BELOW: f32 = 2.0;
const MOST_THIN_RING: f32 = 64.0;
const FLAT: f32 = 2.0;
const NARROW_IMAGE_BELOW: f32 = 16.0;
const MOST_NARROW_STRICTNESS: f32 = 8.0;

/// A ball by the axis of hole and camera.
struct Ball {
    /// From the camera outward; the distance from the axis; from the hole along the axis; r.
    along: f32,
    across: f32,
    height: f32,
    radius: f32,
    reach: f32,
}

/// The image of a thread: bodies first, then their next image.
fn image_of(thread: u32) -> Image {
    var image: Image;
    if thread >= held_frame.bodies * held_frame.images {
        return image;
    }
    let body = bodies[thread % held_frame.bodies];
    let number = thread / held_frame.bodies;
    let minus = number == held_frame.orders;
    let order = select(number + 1u, 1u, minus);
    let reach = body.reach;
    let offset = (body.position - held_frame.camera) + (body.position_rest - held_frame.camera_rest);
    let distance = length(offset);
    let r = length(body.position);
    let from_camera = frame.camera_radius;
    // From inside the horizon higher orders show only what is outside of it, and light of E < 0 only what is inside.
    if (order > 1u && r + reach < 1.0) || (minus && r - reach >= 1.0) {
        return image;
    }
    // The camera is on the axis: the shorter way tells better how far a position is from there.
    let way = select(body.position, offset, distance < r);
    let beside = vec2<f32>(dot(way, frame.side_a), dot(way, frame.side_b));
    let ball = Ball(dot(offset, frame.outward), length(beside), dot(body.position, frame.outward), r, reach);
    let age = select(YOUNG, OLD, minus);
    let low_side = select(max(r - reach, LEAST_LOW_SIDE), max(r - reach, from_camera + 0.01 * (r - from_camera)), from_camera < 1.0);
    let larger = LARGER * reach;
    let is_bounded = held_frame.bounded == 1u && r >= larger && distance >= larger;
    let is_far = larger < FAR * min(ball.across, r - 1.0);
    let surrounds = reach >= r || distance <= reach;
    var extent = anywhere();
    var low = 0.0;
    var high = 0.0;
    var centre = 0.0;
    var path = 0.0;
    var known = true;
    // Nothing is looked up of what surrounds the hole or the camera.
    var count = select(EXTENT_POINTS, 0u, surrounds);
    for (var i = 0u; i < count; i++) {
        var point = vec3<f32>(0.0);
        if i < EXTENT_POINTS {
            point = point_of_extent(ball, low_side, i);
        } else {
            point = point_of_bounds(ball, larger, i - EXTENT_POINTS);
        }
        let ray = method_ray(point.x, point.y, point.z, order, age);
        let psi = angle(ray.sin_psi, ray.cos_psi, 1.0);
        known = known && ray.valid;
        centre = select(centre, psi, i == 0u);
        path = select(path, ray.delay, i == 0u);
        let begins = i == 0u || i == EXTENT_POINTS;
        low = select(min(low, psi), psi, begins);
        high = select(max(high, psi), psi, begins);
        if i + 1u == EXTENT_POINTS {
            // If a part of the object is not seen, its image may end anywhere.
            if known {
                extent = extent_of(low, high, centre, path, beside, r, reach, order);
            }
            if !may_be_seen(extent.look, MARGIN * extent.radius, SCREEN_MARGIN) {
                return image;
            }
            known = is_bounded && !is_far;
            count += select(0u, PLACES + select(2u, 0u, larger < ball.across), known);
        }
    }
    let width = extent.width;
    if width < held_frame.least_width && order > 1u {
        return image;
    }
    var instance: Instance;
    if is_bounded && is_far {
        instance.bound_look = seen_cap(extent.look, MARGIN * extent.radius);
    } else if known && !surrounds {
        let round = select(HALF_TURN, angle_of_sine(larger, ball.across), larger < ball.across);
        let turned = turn_of(order) / ball.across;
        let side = select(frame.side_a, (frame.side_a * beside.x + frame.side_b * beside.y) * turned, larger < ball.across);
        let middle = sine_cosine(0.5 * (low + high));
        instance.bound_high = seen_cap(frame.outward, high);
        instance.bound_low = seen_cap(-frame.outward, HALF_TURN - low);
        instance.bound_look = seen_cap(frame.outward * middle.y + side * middle.x, farthest_in_patch(low, high, round));
    }
    instance.offset = offset;
    instance.position = body.position;
    instance.gamma = 1.0;
    let x = turned_by(body.attitude, vec3<f32>(1.0, 0.0, 0.0));
    let y = turned_by(body.attitude, vec3<f32>(0.0, 1.0, 0.0));
    let z = turned_by(body.attitude, vec3<f32>(0.0, 0.0, 1.0));
    instance.turn_x = x;
    instance.turn_y = y;
    instance.turn_z = z;
    instance.shape_x = x * body.scale;
    instance.shape_y = y * body.scale;
    instance.shape_z = z * body.scale;
    instance.light_red = body.light_red;
    instance.light_green = body.light_green;
    instance.light_blue = body.light_blue;
    instance.order = order;
    instance.object = body.object;
    instance.rounding = ROUNDING * reach;
    instance.across_a = beside.x + 0.79 * BESIDE * instance.rounding;
    instance.across_b = beside.y + 0.61 * BESIDE * instance.rounding;
    let whole = abs(body.position.z) > MARGIN * reach;
    instance.crossings = select(-1.0, f32(plane_crossings(frame.outward.z, body.position.z, order)), whole);
    let thin = is_thin(body, extent);
    instance.flags = INSTANCE_STATIC | held_frame.flags | select(0u, INSTANCE_TWO_SIDED, distance < reach)
        | select(0u, INSTANCE_MINUS, minus)
        | select(0u, INSTANCE_NARROW_RING, select(width < NARROW_RING_BELOW && order > 1u, is_drawn_out(extent), thin))
        | select(0u, INSTANCE_THIN, thin);
    let thin_strictness = select(THIN_STRICTNESS, clamp(THIN_RING_BELOW / width, THIN_STRICTNESS, MOST_THIN_RING), is_drawn_out(extent));
    instance.strictness = held_frame.strictness
        * select(clamp(NARROW_IMAGE_BELOW / width, 1.0, MOST_NARROW_STRICTNESS), thin_strictness, thin);
    let has_numbers = finite_vector(offset) && finite_vector(vec3<f32>(beside, instance.strictness))
        && finite_vector(instance.bound_high.middle + instance.bound_low.middle + instance.bound_look.middle);
    if !has_numbers {
        atomicAdd(&counters.caught, 1u);
        return image;
    }
    image.instance = instance;
    image.shown = true;
    image.coarsest = body.first_model;
    image.model = body.first_model + body.model_count - 1u;
    if reach < 0.1 * r {
        image.model = model_for(body, extent);
    }
    return image;
}

/// Point i of the extent of a ball, as `method_ray` takes it: its centre, its outermost points on both sides in the plane of the axis, its
/// nearest to the hole, and its farthest.
fn point_of_extent(ball: Ball, low_side: f32, i: u32) -> vec3<f32> {
    let sine = ball.reach / ball.radius;
    let cosine = sqrt(max((ball.radius - ball.reach) * (ball.radius + ball.reach), 0.0)) / ball.radius;
    if i == 1u || i == 2u {
        // Towards the axis before the hole, or behind it.
        let towards = select(-1.0, 1.0, i == 1u);
        let across = ball.across * cosine - ball.height * sine * towards;
        if across < 0.0 {
            // Beyond the axis it is the point there.
            let more = towards * ball.across * ball.across / (ball.radius + towards * ball.height);
            return vec3<f32>(ball.along + more, 0.0, towards * ball.radius);
        }
        let more = ball.across * sine * towards - ball.height * (sine * sine / (1.0 + cosine));
        return vec3<f32>(ball.along + more, across, ball.height + more);
    }
    let share = select(select(sine, (low_side - ball.radius) / ball.radius, i == 3u), 0.0, i == 0u);
    return vec3<f32>(ball.along + ball.height * share, ball.across * (1.0 + share), ball.height * (1.0 + share));
}

/// Point i of the circle round a ball in the plane of the axis, then where that meets the axis.
fn point_of_bounds(ball: Ball, reach: f32, i: u32) -> vec3<f32> {
    let turned = sine_cosine(2.0 * HALF_TURN * f32(i) / f32(PLACES) - HALF_TURN) * reach;
    let half = sqrt(max((reach - ball.across) * (reach + ball.across), 0.0));
    let on_axis = i >= PLACES;
    let along = select(turned.y, select(half, -half, i == PLACES), on_axis);
    let across = select(abs(ball.across + turned.x), 0.0, on_axis);
    let height = ball.height + along;
    let nearer = max(LEAST_RADIUS / max(length(vec2<f32>(height, across)), 1e-6), 1.0);
    return vec3<f32>(ball.along + along + height * (nearer - 1.0), across * nearer, height * nearer);
}

/// How often light of an image order crosses the plane z = 0 on its way from a height to that of the camera.
fn plane_crossings(camera_height: f32, height: f32, order: u32) -> u32 {
    let is_across = (height < 0.0) != (camera_height < 0.0);
    return select(order, order - 1u, is_across == (order % 2u == 0u));
}

/// Whether an image is so narrow that a ray a pixel may miss it.
fn is_thin(body: HeldBody, extent: Extent) -> bool {
    let wider = select(1.0, max(body.flatness / FLAT, 1.0), is_drawn_out(extent));
    return extent.width < held_frame.thin_below * wider && held_frame.has_thin == 1u;
}

/// What is drawn of a body in an image of this extent: the first that may stand for it in one so small, or itself.
fn model_for(body: HeldBody, extent: Extent) -> u32 {
    let full = body.first_model + body.model_count - 1u;
    if extent.width < held_frame.coarse_below {
        return body.first_model;
    }
    // Light may draw an image out along the ring.
    let size = max(max(extent.width, extent.length), select(0.0, THIN_SIZE, is_thin(body, extent)));
    for (var model = body.first_model; model < full; model++) {
        if size < held_frame.allowed * models[model].below {
            return model;
        }
    }
    return full;
}

/// Writes an instance where `instance_at` reads it.
fn write_instance(index: u32, instance: Instance) {
    write_numbers(index, 0u, vec4<f32>(instance.offset, instance.delay));
    write_numbers(index, 1u, vec4<f32>(instance.position, instance.engines_off));
    write_numbers(index, 2u, vec4<f32>(instance.velocity, instance.scale));
    write_numbers(index, 3u, vec4<f32>(instance.acceleration, instance.across_a));
    write_numbers(index, 4u, vec4<f32>(instance.jerk, instance.across_b));
    write_numbers(index, 5u, vec4<f32>(instance.snap, instance.crossings));
    write_numbers(index, 6u, vec4<f32>(instance.momentum, instance.gamma));
    write_numbers(index, 7u, vec4<f32>(instance.contraction, instance.rounding));
    write_numbers(index, 8u, vec4<f32>(instance.force, instance.path_across));
    write_numbers(index, 9u, vec4<f32>(instance.spin, instance.spin_slack));
    write_numbers(index, 10u, vec4<f32>(instance.shape_x, instance.strictness));
    write_numbers(index, 11u, vec4<f32>(instance.shape_y, instance.first_node));
    write_numbers(index, 12u, vec4<f32>(instance.shape_z, instance.nodes_per_time));
    write_numbers(index, 13u, vec4<f32>(instance.turn_x, instance.node_intervals));
    write_numbers(index, 14u, vec4<f32>(instance.turn_y, 0.0));
    write_numbers(index, 15u, vec4<f32>(instance.turn_z, instance.path_along));
    write_numbers(index, 16u, instance.light_red);
    write_numbers(index, 17u, instance.light_green);
    write_numbers(index, 18u, instance.light_blue);
    write_numbers(index, 19u, vec4<f32>(instance.bound_high.middle, instance.bound_high.rim));
    write_numbers(index, 20u, vec4<f32>(instance.bound_low.middle, instance.bound_low.rim));
    write_numbers(index, 21u, vec4<f32>(instance.bound_look.middle, instance.bound_look.rim));
    write_words(index, 22u, vec4<u32>(instance.order, instance.object, instance.first_seen, instance.first_state));
    write_words(index, 23u, vec4<u32>(instance.first_vertex, instance.vertex_count, instance.first_edge, instance.edge_count));
    write_words(index, 24u, vec4<u32>(instance.first_triangle, instance.triangle_count, instance.first_material, instance.flags));
}

fn write_numbers(index: u32, k: u32, row: vec4<f32>) {
    write_words(index, k, bitcast<vec4<u32>>(row));
}

fn write_words(index: u32, k: u32, row: vec4<u32>) {
    textureStore(instance_table, table_place(index * INSTANCE_TEXELS + k), row);
}
