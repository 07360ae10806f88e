#define_import_path lensrunner::aurora::streaks

// What the passes of the aurora share: streaks, each the light of all electrons that come down on a small part of a curtain; where they
// are, and their light over height. Lengths in km and heights above the planet, in the axes of its magnetic dipole (+z north). The physics
// is in src/scene/aurora; src/render/aurora fills the buffers.

#import lensrunner::aurora::stroke::Stroke
#import lensrunner::gpu::random::{hash, unit}
#import lensrunner::gpu::types::Instance

struct AuroraSettings {
    streaks: u32,
    /// Chords of a streak that is not red.
    chords: u32,
    /// Parts of a streak.
    parts: u32,
    /// Nodes in a row of the history.
    row_nodes: u32,
    /// Which row of the history is the newest.
    newest_row: u32,
    /// Parts of curtains.
    segments: u32,
    /// Room for strokes of one instance in the two finest levels (see allocate_stroke).
    capacity: u32,
    /// AURORA_*.
    flags: u32,
    /// Seconds between rows.
    row_seconds: f32,
    /// By how many seconds the newest row is ahead of the time that is seen.
    ahead: f32,
    /// Time in s for the rays (mod RAYS_PERIOD).
    clock: f32,
    /// Of the rays.
    contrast: f32,
    /// Standard deviation of a luminous point, in km.
    point: f32,
    /// Levels of the pyramid in use.
    levels: u32,
    /// Direction to magnetic midnight; its length is by how much an oval is brighter there.
    midnight: vec2<f32>,
    /// Greatest and least height, in km, of green light and of red.
    green_top: f32,
    green_foot: f32,
    red_top: f32,
    red_foot: f32,
}

/// The walk of Sekiguchi et al.: linear on the screen.
const AURORA_LINEAR: u32 = 1u;
/// Every second streak comes down in the south.
const AURORA_BOTH_POLES: u32 = 2u;

/// A part of a curtain between two nodes.
struct Segment {
    /// Its first streak.
    first_streak: u32,
    /// Its streaks: a multiple of RED_EVERY for each pole.
    streaks: u32,
    /// Its first node, and how many nodes further its last is.
    first_node: u32,
    span: u32,
    /// Collisions of 35 eV in it, in kR km².
    collisions: f32,
    /// In km.
    width: f32,
    length: f32,
}

/// A node of a curtain at the time of a row.
struct CurtainNode {
    /// Position in the plane across the field, in km.
    place: vec2<f32>,
    /// Energy flux over its mean.
    flux: f32,
    /// Position along the curtain at rest, in km.
    along: f32,
}

/// The middle of a part of a curtain, at the height of an end of chords, as the camera sees it.
struct Reference {
    /// Its position, in km.
    body: vec3<f32>,
    /// 1 where it is seen, else 0.
    is_seen: u32,
    /// Apparent place, camera axes, in r_s.
    apparent: vec3<f32>,
    /// Where its light left, by the axis of hole and camera (ProjectedPoint.by_axis), in r_s.
    left: vec3<f32>,
    /// The change of `left` per km in two directions across the field and in one along it (across_field).
    east: vec3<f32>,
    north: vec3<f32>,
    up: vec3<f32>,
    /// The same light as it arrives, a vector of spacetime in the plane of hole, camera and place: light path times its direction along the
    /// axis (x) and across it towards the place (y), and the light path (z), in r_s; and its change per r_s of `left` across and along the
    /// axis. They are smooth on the axis behind the hole, where the apparent place is not.
    arriving: vec3<f32>,
    by_across: vec3<f32>,
    by_along: vec3<f32>,
}

/// One end of a chord as the camera sees it.
struct ChordEnd {
    /// Apparent place, camera axes, in r_s.
    apparent: vec3<f32>,
    /// How it is seen (end_seen).
    seen: f32,
    /// Its change per km along the curtain.
    along: vec3<f32>,
    /// Energy flux over its mean, with the rays, when the green or red light seen there was made.
    waited: f32,
    /// Its change per km across the curtain and the field.
    across: vec3<f32>,
    /// The flux for blue and crimson light, which has no delay.
    prompt: f32,
}

@group(1) @binding(0) var<uniform> aurora: AuroraSettings;
@group(1) @binding(1) var<storage, read> aurora_instances: array<Instance>;
/// A ring buffer of HISTORY_ROWS rows of nodes; from the newest on, each is older than the one before. Each curve has one more node at
/// either end (between_nodes).
@group(1) @binding(2) var<storage, read> nodes: array<CurtainNode>;
@group(1) @binding(3) var<storage, read> segments: array<Segment>;
/// Photons (ROWS × (PARTS + 1) × 4), delays (DELAYS × 2), heights (ROWS × KINDS × (PARTS + 1)): scene::aurora::quantiles.
@group(1) @binding(4) var<storage, read> falls: array<f32>;
@group(1) @binding(5) var<storage, read_write> chords: array<ChordEnd>;
@group(1) @binding(6) var<storage, read_write> strokes: array<Stroke>;
/// Of each instance, four numbers a level: vertices, instances, first vertex, first instance. Then strokes in each pair of levels,
/// and a bit for each tile of the screen that may be lit (lit_tiles.wgsl).
@group(1) @binding(7) var<storage, read_write> stroke_draws: array<atomic<u32>>;
@group(1) @binding(8) var<storage, read_write> references: array<Reference>;
/// x: least, y: greatest depth of what is drawn, in depth tiles of 8 × 8 pixels and upwards.
@group(1) @binding(9) var ranges: texture_2d<f32>;

/// Rows of the history; as ROWS in src/render/aurora/node_history.rs.
const HISTORY_ROWS: u32 = 128u;
const ROWS: u32 = 32u;
const LEAST_FLUX: f32 = 0.05;
const MOST_FLUX: f32 = 4.0;
const PARTS: u32 = 32u;
const KINDS: u32 = 2u;
const DELAYS: u32 = 64u;
const FIRST_DELAY: u32 = 4224u;
const FIRST_HEIGHT: u32 = 4352u;
const PLANET_RADIUS: f32 = 6371.0;
const REFERENCE_HEIGHT: f32 = 110.0;

/// Kinds of streaks: green with blue and crimson, and red.
const GREEN: u32 = 0u;
const RED: u32 = 1u;

/// Greatest and least height of a kind, km.
fn height_range(kind: u32) -> vec2<f32> {
    return select(vec2<f32>(aurora.green_top, aurora.green_foot), vec2<f32>(aurora.red_top, aurora.red_foot), kind == RED);
}

/// Chords of a streak. Red light has twice as many: it is delayed, and the delay changes fast with height.
fn chords_of(kind: u32) -> u32 {
    return select(aurora.chords, 2u * aurora.chords, kind == RED);
}

/// Room for the ends of a streak's chords.
fn chord_room() -> u32 {
    return 2u * aurora.chords + 1u;
}

/// Height of the end `k` of `count` chords: evenly spaced; those of red closer together further down, where the delay is seconds and not
/// minutes.
fn chord_height(kind: u32, k: u32, count: u32) -> f32 {
    let range = height_range(kind);
    let left = 1.0 - f32(k) / f32(count);
    return mix(range.y, range.x, select(left, left * left, kind == RED));
}

/// The chord of `count` that a height lies in.
fn chord_at(kind: u32, height: f32, count: u32) -> u32 {
    let range = height_range(kind);
    let left = clamp((height - range.y) / (range.x - range.y), 0.0, 1.0);
    return min(u32((1.0 - select(left, sqrt(left), kind == RED)) * f32(count)), count - 1u);
}

/// Number of ends of chords at which a part of a curtain is projected: first those of green, then those of red.
fn reference_capacity() -> u32 {
    return 3u * aurora.chords + 2u;
}

/// Index of the first of them for a part, in the north or in the south, in one instance.
fn first_reference(segment: u32, south: bool, instance: u32) -> u32 {
    let poles = select(1u, 2u, (aurora.flags & AURORA_BOTH_POLES) != 0u);
    return ((instance * aurora.segments + segment) * poles + select(0u, 1u, south)) * reference_capacity();
}

/// How an end of a chord is seen: 0 not at all, 1 well, 2 to 3 on the ring that the axis behind the hole is drawn out to: then the fraction
/// is where on it, `towards` being the unit vector across the axis.
fn end_seen(is_seen: bool, on_ring: bool, towards: vec2<f32>) -> f32 {
    let turns = fract(atan2(towards.y, towards.x) * 0.15915494);
    return select(0.0, select(1.0, 2.0 + turns, on_ring), is_seen);
}

/// The longest part of the ring that a chord stands for, in turns.
const MOST_RING: f32 = 0.04;

/// Whether there is a chord between two ends that are seen so.
fn is_chord(a: f32, b: f32) -> bool {
    let apart = abs(a - b);
    return min(a, b) > 0.0 && (min(a, b) < 2.0 || min(apart, 1.0 - apart) < MOST_RING);
}

struct Streak {
    segment: u32,
    /// Share of the segment's length from its first node.
    along: f32,
    /// Distance to the next of its kind, as a share of the segment.
    apart: f32,
    /// Square of the standard deviation of its light along the curtain and across it, km².
    spread: vec2<f32>,
    kind: u32,
    /// Its share of the light of its kind in the segment.
    share: f32,
    south: bool,
    /// In [0, 1): quantile of the delay of its light.
    wait: f32,
    /// In [−½, ½): offset of the parts in which it is drawn against those of its neighbours, as a share of a part.
    phase: f32,
}

/// Distance between two streaks over the least standard deviation at which a row of Gaussians shows no ripple (2 exp(−2π²/1.6²) is 1/1000).
const SMOOTH: f32 = 1.6;
/// One streak in so many is red; as in src/render/aurora/animation/streaks.rs.
const RED_EVERY: u32 = 5u;
/// Steps of a sequence that is even in two dimensions: one over the plastic number, and its square (Roberts 2018).
const EVEN: vec2<f32> = vec2<f32>(0.7548777, 0.5698403);

/// A streak by its number. Streaks of a kind lie evenly along their segment; any few of them are also even in delay and phase.
fn streak_of(index: u32) -> Streak {
    var low = 0u;
    var high = aurora.segments - 1u;
    while low < high {
        let middle = (low + high + 1u) / 2u;
        if segments[middle].first_streak <= index {
            low = middle;
        } else {
            high = middle - 1u;
        }
    }
    let segment = segments[low];
    let number = index - segment.first_streak;
    var streak: Streak;
    streak.segment = low;
    // One in five is red, which is faint and blurred by its delay.
    let turn = number % RED_EVERY;
    let many = RED_EVERY - 1u;
    streak.kind = select(GREEN, RED, turn == many);
    let both = (aurora.flags & AURORA_BOTH_POLES) != 0u;
    streak.south = both & (((number / RED_EVERY) & 1u) == 1u);
    // Its number among those of its kind and pole, and their number.
    let turns = RED_EVERY * select(1u, 2u, both);
    let own = select(many * (number / turns) + turn, number / turns, turn == many);
    let all = select(many, 1u, turn == many) * max(segment.streaks / turns, 1u);
    streak.share = select(1.0, 0.5, both) / f32(all);
    streak.apart = 1.0 / f32(all);
    streak.along = (f32(own) + 0.5) * streak.apart;
    // Spread over its part of the curtain.
    let point = aurora.point * aurora.point;
    let gap = segment.length * streak.apart / SMOOTH;
    streak.spread = vec2<f32>(max(point, gap * gap), point + segment.width * segment.width / 12.0);
    let even = fract(EVEN * f32(own) + unit(hash(2u * low + streak.kind)));
    streak.wait = even.x;
    streak.phase = even.y - 0.5;
    return streak;
}

/// Mean delay, in s, of green or red light at a height.
fn mean_wait(kind: u32, height: f32) -> f32 {
    let x = clamp((height - 80.0) / 420.0, 0.0, 1.0) * f32(DELAYS - 1u);
    let k = min(u32(x), DELAYS - 2u);
    let column = FIRST_DELAY + select(0u, 1u, kind == RED);
    return mix(falls[column + 2u * k], falls[column + 2u * k + 2u], x - f32(k));
}

/// Largest delay of a streak, in mean lives of its light: the last fiftieth would be single streaks where the curtain was long before.
const LATEST: f32 = 4.0;
/// Decay rate, in lives over that time, of an exponential that is cut off there and has the same mean: 1/x − 1/(eˣ − 1) = 1/4.
const DECAY: f32 = 3.5934;

/// The delay of one streak: over all streaks they are distributed as the light decays.
fn waits(streak: Streak, height: f32) -> f32 {
    return -LATEST / DECAY * log(1.0 - streak.wait * (1.0 - exp(-DECAY))) * mean_wait(streak.kind, height);
}

/// Row of the table of falls at so many times the mean energy flux.
fn fall_at(flux: f32) -> f32 {
    let first = sqrt(LEAST_FLUX);
    return (sqrt(clamp(flux, LEAST_FLUX, MOST_FLUX)) - first) / (sqrt(MOST_FLUX) - first) * f32(ROWS - 1u);
}

/// Photons of each line above the height at which the share `part` (0 to 1) of the light of a kind has been made.
fn photons_of(row: f32, kind: u32, part: f32) -> vec4<f32> {
    let y = clamp(part, 0.0, 1.0) * f32(PARTS);
    let j = min(u32(y), PARTS - 1u);
    let i = min(u32(row), ROWS - 2u);
    var made: vec4<f32>;
    for (var k = 0u; k < 4u; k++) {
        let at = 4u * (i * (PARTS + 1u) + j) + k;
        let next = at + 4u * (PARTS + 1u);
        made[k] = mix(mix(falls[at], falls[at + 4u], y - f32(j)), mix(falls[next], falls[next + 4u], y - f32(j)), row - f32(i));
    }
    return select(vec4<f32>(made.xy, 0.0, made.w), vec4<f32>(0.0, 0.0, made.z, 0.0), kind == RED);
}

/// Height below which `part` (0 to 1) of the light of a kind has been passed.
fn height_of(row: f32, kind: u32, part: f32) -> f32 {
    let y = clamp(part, 0.0, 1.0) * f32(PARTS);
    let j = min(u32(y), PARTS - 1u);
    let i = min(u32(row), ROWS - 2u);
    let at = FIRST_HEIGHT + (i * KINDS + kind) * (PARTS + 1u) + j;
    let next = at + KINDS * (PARTS + 1u);
    let low = mix(falls[at], falls[at + 1u], y - f32(j));
    let high = mix(falls[next], falls[next + 1u], y - f32(j));
    return mix(low, high, row - f32(i));
}

/// The point at a height on the field line through a place of the plane across the field; twin of scene::aurora::dipole::on_field_line.
fn on_field_line(place: vec2<f32>, height: f32) -> vec3<f32> {
    let reference = PLANET_RADIUS + REFERENCE_HEIGHT;
    let distance = length(place);
    var along = vec2<f32>(1.0, 0.0);
    if distance > 0.0 {
        along = place / distance;
    }
    let colatitude = min(distance / reference, 1.5707963);
    let radius = max(PLANET_RADIUS + height, 0.0);
    let sine = min(sin(colatitude) * sqrt(radius / reference), 1.0);
    return vec3<f32>(along * sine, sqrt(1.0 - sine * sine)) * radius;
}

/// The same in the north or in the south.
fn at_height(place: vec2<f32>, height: f32, south: bool) -> vec3<f32> {
    let body = on_field_line(place, height);
    return vec3<f32>(body.xy, select(body.z, -body.z, south));
}

/// Unit vectors east, north and up along the dipole's field at a place, columns.
fn across_field(body: vec3<f32>) -> mat3x3<f32> {
    let n = body / max(length(body), 1.0);
    let up = normalize(n * (3.0 * n.z) - vec3<f32>(0.0, 0.0, 1.0));
    let east = normalize(cross(vec3<f32>(0.0, 0.0, 1.0), n) + vec3<f32>(1e-6, 0.0, 0.0));
    return mat3x3<f32>(east, cross(up, east), up);
}

/// A node `age` seconds ago; before the oldest row it rests.
fn node_at(node: u32, age: f32) -> CurtainNode {
    let x = clamp(age / aurora.row_seconds, 0.0, f32(HISTORY_ROWS - 1u));
    let row = min(u32(x), HISTORY_ROWS - 2u);
    let newer = nodes[((aurora.newest_row + row) % HISTORY_ROWS) * aurora.row_nodes + node];
    let older = nodes[((aurora.newest_row + row + 1u) % HISTORY_ROWS) * aurora.row_nodes + node];
    let t = x - f32(row);
    return CurtainNode(mix(newer.place, older.place, vec2<f32>(t)), mix(newer.flux, older.flux, t), mix(newer.along, older.along, t));
}

/// A vector of length `long` in the direction of `v`; zero if `v` is.
fn as_long(v: vec2<f32>, long: f32) -> vec2<f32> {
    return v * (long / max(length(v), 1e-6));
}

/// The point at `t` of the way from one node of a curtain to the next (xy) and its derivative by t (zw), given also the node before and the
/// node after; twin of scene::aurora::curve::between_nodes.
fn between_nodes(before: vec2<f32>, a: vec2<f32>, b: vec2<f32>, after: vec2<f32>, t: f32) -> vec4<f32> {
    let chord = b - a;
    let at_a = as_long(b - before, length(chord));
    let at_b = as_long(after - a, length(chord));
    let place = a + chord * (t * t * (3.0 - 2.0 * t)) + (at_a * (1.0 - t) - at_b * t) * (t * (1.0 - t));
    let step = chord * (6.0 * t * (1.0 - t)) + at_a * ((1.0 - t) * (1.0 - 3.0 * t)) + at_b * (t * (3.0 * t - 2.0));
    return vec4<f32>(place, step);
}

/// The middle of a part of a curtain `age` seconds ago; twin of `middle_of` in src/render/aurora/node_history.rs.
fn middle_of(segment: Segment, age: f32) -> vec2<f32> {
    let node = segment.first_node + (segment.span - 1u) / 2u;
    let t = select(1.0, 0.5, segment.span % 2u == 1u);
    let before = node_at(node - 1u, age).place;
    let after = node_at(node + 2u, age).place;
    return between_nodes(before, node_at(node, age).place, node_at(node + 1u, age).place, after, t).xy;
}
