#define_import_path lensrunner::disk::types

// The types of the disk of arcs. A row is a circle of the disk in one image order. A column is a position on it: even ones are the cuts
// between arcs, odd ones the middles of arcs. θ is the azimuth from the camera's.

struct DiskFrame {
    /// Unit vector in the disk's plane towards the camera.
    towards: vec3<f32>,
    /// Sine h of the camera's height over the plane, kept away from 0.
    camera_sine: f32,
    /// Unit vector in the plane, a quarter turn on.
    sideways: vec3<f32>,
    /// √(1 − h²).
    camera_cosine: f32,
    /// Unit vector across the axis and upwards, which completes (radial, sideways).
    upwards: vec3<f32>,
    /// |h|.
    steepness: f32,
    /// Time at the camera since the first generation of streaks, in renewals.
    renewals: f32,
    /// Renewals per r_s/c.
    renewals_per_time: f32,
    /// One renewal, in r_s/c.
    renewal: f32,
    /// Age of a new-born, in r_s/c.
    newborn: f32,
    /// Standard deviation of ln density.
    contrast: f32,
    /// The share of the area that has gas, in rings whose gaps are closed.
    filled: f32,
    /// Of an arc, in rad.
    error_budget: f32,
    /// Of thin images, in pixels.
    least_width: f32,
    /// Columns of a row, arcs round the hole, rows, and rings over all orders.
    columns: u32,
    arcs: u32,
    rows: u32,
    rings: u32,
    /// First indices of the lists of triangles: orders 1, 2, 3, and the part of order 1 that is far from a close camera.
    regions: vec4<u32>,
    /// Vertices for which there is room.
    vertex_room: u32,
    /// Orders up to this one are drawn as from near (finest octaves, slant in each pixel).
    near_orders: u32,
    /// Half height over radius.
    thickness: f32,
    /// The end of the last list of triangles.
    regions_end: u32,
    /// The scene's unit of light over that of the table of black bodies.
    unit: f32,
    /// For a close camera, the light path in r_s beyond which arcs of order 1 are drawn as from far.
    close: f32,
    /// Most positions along a pixel at which a close camera looks gas up.
    most_looks: f32,
    unused: f32,
    /// Position in the pattern of the first generation, and the step to the next.
    offset: vec2<f32>,
    offset_step: vec2<f32>,
}

@group(#{DATA_GROUP}) @binding(0) var<uniform> disk: DiskFrame;

/// The gas at a radius.
struct RadialGas {
    /// The radius, in r_s.
    radius: f32,
    /// Azimuth by which falling gas is ahead, in rad.
    lead: f32,
    /// ln of the temperature in K.
    ln_temperature: f32,
    /// Optical depth straight through.
    depth: f32,
    /// Rain-frame momentum per mass outward and along the rotation.
    outward: f32,
    along: f32,
    /// Half height of the disk, in r_s.
    half_height: f32,
    /// Height in the pattern: ln of the radius that the pattern there comes from, over the pattern's whole height.
    pattern_height: f32,
}

/// Between the gas at two radii.
fn mixed_gas(a: RadialGas, b: RadialGas, t: f32) -> RadialGas {
    return RadialGas(mix(a.radius, b.radius, t), mix(a.lead, b.lead, t), mix(a.ln_temperature, b.ln_temperature, t),
        mix(a.depth, b.depth, t), mix(a.outward, b.outward, t), mix(a.along, b.along, t), mix(a.half_height, b.half_height, t),
        mix(a.pattern_height, b.pattern_height, t));
}

struct Circle {
    gas: RadialGas,
    /// How far its nearest point to the camera is beyond the camera, along the axis: radius·√(1 − h²) − L, computed in f64.
    beyond: f32,
    /// Radius of the middle of the gap beside it; for the outermost circle the edge of the disk.
    gap_radius: f32,
    /// The gap over the whole ring.
    gap: f32,
    /// The whole gap's width over the distance from this circle to `gap_radius`: 2, for the outermost 1.
    gap_sides: f32,
    /// Image order, and the innermost and the outermost row of that order.
    order: u32,
    first_row: u32,
    last_row: u32,
    /// For orders 2 and 3 the first of the circles behind the rows: THIN_SAMPLES for each of THIN_AZIMUTHS azimuths, on radii that divide
    /// the seen width of that image equally there.
    first_sample: u32,
    /// Of those circles: the gas of the second image through which light of the third comes: optical depth straight through (0 in the
    /// second image itself), rain-frame momentum per mass outward and along the rotation, radius in r_s.
    nearer_depth: f32,
    nearer_outward: f32,
    nearer_along: f32,
    nearer_radius: f32,
}

struct DiskVertex {
    /// Direction from the camera times light path, camera axes.
    apparent: vec3<f32>,
    /// The light path, in r_s; 0 for what is not seen.
    path: f32,
    /// Azimuth less lead, in turns.
    turns: f32,
    /// Height in the pattern.
    pattern_height: f32,
    /// ln of the temperature that is seen, in K.
    ln_temperature: f32,
    /// Optical depth along the ray (close look: straight through).
    depth: f32,
    ln_g: f32,
    /// |cos| to the normal, in the frame of the gas.
    cosine: f32,
    /// The share of the drawn area that has gas.
    filled: f32,
    /// Distance from the middle of a thin image and its half width, in pixels; for order 1 0 and 10⁶.
    from_middle: f32,
    half_width: f32,
    /// For the ring that begins here, how far its middle deviates from the straight line between its circles: height in the pattern;
    /// logarithm of light, over itself with its sign turned; optical depth, over that of the line, so that it holds at any slant.
    bend_height: f32,
    bend_light: f32,
    bend_depth: f32,
    /// 0 and 1 alternately from row to row, so that over a ring it is the share of the ring's width, from one side or the other.
    side: f32,
}

/// A part of an arc of a circle that ends at a vertex past the grid.
struct Job {
    /// The arc, counted along all rows.
    arc: u32,
    /// Number of that end, from 1, of so many segments.
    number: u32,
    count: u32,
}

/// An arc of a circle.
struct Segments {
    /// How many it has.
    count: u32,
    /// Its first vertex past the grid.
    first: u32,
    /// Error of its middle, in rad.
    error: f32,
    /// Sides of the screen beyond which all of it is, as bits.
    beyond: u32,
}

struct Counters {
    /// Vertices past the grid.
    vertices: atomic<u32>,
    /// Indices in each list of triangles.
    indices: array<atomic<u32>, 4>,
    /// Number of arcs drawn; below, of arcs drawn coarser than asked, and of results that were not finite.
    arcs: atomic<u32>,
    coarse: atomic<u32>,
    caught: atomic<u32>,
    /// 1 once the vertices of the grid are there.
    stage: u32,
}

/// Half widths, in pixels, between which an image goes over from the mean of all its gas to the gas of each circle, and is no longer drawn
/// wider. An image narrower than that is drawn wider than it is; a pixel would show whichever circle its centre falls on, a row of dots. A
/// wide image does not need that, since the gas thins out towards its edges, and widening would move the gas aside.
const MEAN: vec2<f32> = vec2<f32>(0.75, 2.0);

/// The share of a circle's own gas that an image of this half width (pixels) shows.
fn own_share(half_width: f32) -> f32 {
    return smoothstep(MEAN.x, MEAN.y, half_width);
}

/// The share of a pixel that a thin image covers, `d` pixels from its middle: its share of a tent two least widths wide. With a box, a line
/// thinner than a pixel would move in steps of whole pixels, which along a diagonal look like beads. The tent narrows as the image is drawn
/// no wider than it is, so that all of its light is there at any width.
fn coverage(d: f32, half_width: f32) -> f32 {
    let width = max(disk.least_width * (1.0 - own_share(half_width)), 0.05);
    return tent_below((d + half_width) / width) - tent_below((d - half_width) / width);
}

/// The area of the tent 1 − |x| below x.
fn tent_below(x: f32) -> f32 {
    let t = 1.0 - min(abs(x), 1.0);
    return select(0.5 * t * t, 1.0 - 0.5 * t * t, x > 0.0);
}
