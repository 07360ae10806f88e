#define_import_path lensrunner::gpu::types

// The types that every pass shares. Each has a Rust mirror of the same name in src/render/gpu/types.rs; tests/render/gpu/types.rs holds
// sizes, offsets and constants equal.
//
// Frames: "rain" axes are the flat axes of the slice T = const carried by observers who fall from rest at infinity; "camera" axes are
// (right, up, back) in the rest frame of the camera. Lengths in r_s, times in r_s/c.

struct Frame {
    /// Lorentz matrix from rain (x, y, z, t) to camera (right, up, back, t).
    camera_from_rain: mat4x4<f32>,
    /// Its inverse.
    rain_from_camera: mat4x4<f32>,
    /// Unit vector from the hole to the camera (rain axes).
    outward: vec3<f32>,
    /// The camera's radius L.
    camera_radius: f32,
    /// Two unit vectors that complete `outward` to a right-handed frame.
    side_a: vec3<f32>,
    /// Least width of a thin image, in pixels.
    least_width: f32,
    side_b: vec3<f32>,
    /// The river's speed β = √(1/L), in c.
    river_speed: f32,
    /// Cotangents of half the field of view across and down.
    focal: vec2<f32>,
    /// Distance of the near plane, in r_s.
    near: f32,
    /// T since the start, for what twinkles, in r_s/c.
    time: f32,
    /// Of the target, in pixels.
    size: vec2<f32>,
    /// Angle of one pixel at the centre, in rad.
    pixel: f32,
    /// The error that geometry may have on the screen, in rad.
    error_budget: f32,
    /// Factor on the exposure.
    exposure_bias: f32,
    /// Luminance of a star of magnitude 0 that is spread over one pixel of the output.
    star_brightness: f32,
    sky_brightness: f32,
    /// Share of the light that is spread.
    bloom: f32,
    least_exposure: f32,
    greatest_exposure: f32,
    /// The share of the way that the exposure goes in this frame, in (0, 1].
    adaptation: f32,
    /// ψ of the edge of the shadow, rain frame, in rad.
    shadow_edge: f32,
    /// Bits of FLAG_*.
    flags: u32,
    /// How often an edge may be halved.
    halvings: u32,
    /// Standard deviation of a star's spot, in pixels of the output.
    star_sigma: f32,
    /// Least flux of a star that is drawn, in units of a star of magnitude 0.
    faintest_star: f32,
    capacity: Capacity,
    /// Least and greatest light of middle grey on the own ship.
    least_fill: f32,
    greatest_fill: f32,
    /// Exposure of the frame before; and 1 once that is known.
    last_exposure: f32,
    exposure_known: f32,
    /// What the meter leaves out, the own ship's circle: its middle, in widths of the picture from its middle, y down.
    unmetered_middle: vec2<f32>,
    /// Its radius, 0 for none.
    unmetered_radius: f32,
    /// The light that the picture is brought to where the disk is in it.
    exposure_key: f32,
    /// Indices of the disk's triangles in the picture, as DiskCounters has them; some number if it is not drawn from arcs.
    disk_indices: vec4<u32>,
    /// The light that the picture is brought to while no disk is in it.
    exposure_key_without_disk: f32,
    /// How far the mean luminance of the picture as shown may rise, where it is bound: by how much of white in this frame,
    most_rise: f32,
    /// and 1 over that of the frame before, 0 over black.
    rise_per_luminance: f32,
    /// How much wider the output is than the picture that is drawn.
    enlargement: f32,
}

/// How the eye has adapted, kept from frame to frame.
struct Adaptation {
    /// Factor on the picture's light.
    exposure: f32,
    /// Mean light of the last frame, weighted by light itself.
    metered: f32,
    /// 1 once a frame has been metered.
    known: f32,
    /// Factor on the picture by which its rise is bound; 1 but for what flashes.wgsl chose.
    steadied: f32,
}

/// What the buffers of geometry hold. Of each but the last a fifth is kept for what is drawn coarsely when the rest is full.
struct Capacity {
    vertices: u32,
    indices: u32,
    work: u32,
    /// Vertices of thin images.
    thin: u32,
}

const FLAG_DOPPLER: u32 = 1u;
const FLAG_BEAMING: u32 = 2u;
const FLAG_INSIDE: u32 = 16u;
const FLAG_HOLD_EXPOSURE: u32 = 32u;
const FLAG_MIDPOINT: u32 = 64u;

/// One object seen in one image order. A row of 16 bytes holds a vector and a number.
struct Instance {
    /// The object's centre at its own emission time T₀, minus the camera's position, in r_s.
    offset: vec3<f32>,
    /// T − T₀, in r_s/c.
    delay: f32,
    /// The centre from the hole: near the hole a far camera's offset has lost the digits that r − 1 needs.
    position: vec3<f32>,
    /// What its engines lack of their full light, as a share.
    engines_off: f32,
    /// dx/dT of the centre.
    velocity: vec3<f32>,
    /// r_s per unit of the model where the object moves or turns, else 0.
    scale: f32,
    /// d²x/dT² of the centre.
    acceleration: vec3<f32>,
    /// Where the centre is across the axis of hole and camera, along `side_a` and `side_b`, in r_s: near the axis the offset has lost the
    /// digits that it takes.
    across_a: f32,
    /// d³x/dT³ of the centre.
    jerk: vec3<f32>,
    across_b: f32,
    /// d⁴x/dT⁴ of the centre.
    snap: vec3<f32>,
    /// How often light of this image crosses the plane z = 0 of the disk on its way, −1 if parts of it differ.
    crossings: f32,
    /// Rain-frame momentum per mass, by which light is shifted.
    momentum: vec3<f32>,
    gamma: f32,
    /// The momentum that contracts the body on the slice, at T₀.
    contraction: vec3<f32>,
    /// How far a point may be put beside its place by the rounding of f32, in r_s.
    rounding: f32,
    /// d/dT of it.
    force: vec3<f32>,
    /// The gradient of the light's path at the centre: its part across the axis.
    path_across: f32,
    /// Mean angular velocity about T₀ in 1/T, rain axes.
    spin: vec3<f32>,
    /// By how much the direction of light against a surface, as a sine, may be off what this turn tells.
    spin_slack: f32,
    /// Columns of the matrix from body offsets to offsets on the slice at T₀: size, attitude, contraction.
    shape_x: vec3<f32>,
    /// How much closer chords of a narrow image are held, else 1.
    strictness: f32,
    shape_y: vec3<f32>,
    /// What was recorded of the flight (instances/recorded.wgsl): time of the first node after T₀, in r_s/c.
    first_node: f32,
    shape_z: vec3<f32>,
    /// 1 over the time between two nodes.
    nodes_per_time: f32,
    /// Columns of the rotation from body axes to rain axes, for normals.
    turn_x: vec3<f32>,
    /// Number of times between nodes.
    node_intervals: f32,
    turn_y: vec3<f32>,
    /// Where the first node is in the table of instances.
    node_texel: u32,
    turn_z: vec3<f32>,
    /// The gradient's part along the axis. Both are 0 where a point's path less the centre's is not told by gradients.
    path_along: f32,
    /// Light that falls on a surface of normal n (rain axes), per channel: the linear form of (n, 1), whose last coefficient is ambient.
    light_red: vec4<f32>,
    light_green: vec4<f32>,
    light_blue: vec4<f32>,
    /// Caps of directions that the image keeps to: by its farthest from outwards, its nearest, and about its middle.
    bound_high: Cap,
    bound_low: Cap,
    bound_look: Cap,
    /// The image order.
    order: u32,
    /// The object's id.
    object: u32,
    /// First of its seen vertices and of its edges' states.
    first_seen: u32,
    first_state: u32,
    /// Of the model: where its vertices, edges, triangles and materials begin, and how many there are.
    first_vertex: u32,
    vertex_count: u32,
    first_edge: u32,
    edge_count: u32,
    first_triangle: u32,
    triangle_count: u32,
    first_material: u32,
    /// Bits of INSTANCE_*.
    flags: u32,
}

/// Directions within some angle of one.
struct Cap {
    /// Unit vector, camera axes.
    middle: vec3<f32>,
    /// Square of the chord from there to the rim; positive if the image lies inside, negative if outside, 0 if it may lie anywhere.
    rim: f32,
}

/// Both sides of every triangle are drawn.
const INSTANCE_TWO_SIDED: u32 = 1u;
/// The object does not move; each of its points emits as a static observer there.
const INSTANCE_STATIC: u32 = 2u;

/// Its whole image of this order is thin (`render.thin_below`).
const INSTANCE_THIN: u32 = 4u;
/// The image of a static body inside the horizon by light of E < 0.
const INSTANCE_MINUS: u32 = 8u;
/// The centre strays from its smooth way, as the nodes tell.
const INSTANCE_STRAYS: u32 = 64u;
/// The player's own ship, lit for the picture (`render.fill_least`).
const INSTANCE_OWN: u32 = 32u;
/// Its image, of a higher order or thin, is at most a few pixels wide and drawn out along the ring: much of it is outline.
const INSTANCE_NARROW_RING: u32 = 16u;

fn is_thin(instance: Instance) -> bool {
    return (instance.flags & INSTANCE_THIN) != 0u;
}

fn is_thin_ring(instance: Instance) -> bool {
    return is_thin(instance) && (instance.flags & INSTANCE_NARROW_RING) != 0u;
}

fn two_sided(instance: Instance) -> bool {
    return (instance.flags & INSTANCE_TWO_SIDED) != 0u;
}

struct ModelVertex {
    /// Body axes, model units.
    position: vec3<f32>,
    /// u of the texture.
    u: f32,
    /// Unit normal in body axes.
    normal: vec3<f32>,
    /// v of the texture.
    v: f32,
    /// Counted from the model's own first; a vertex belongs to one material.
    material: u32,
    unused_a: u32,
    unused_b: u32,
    unused_c: u32,
}

struct ModelTriangle {
    /// Three vertices in ascending order, counted from the model's own first.
    vertices: vec3<u32>,
    /// SIDE_*.
    side: u32,
    /// Edge i is opposite to vertex i.
    edges: vec3<u32>,
    unused: u32,
    /// A bit for each direction from which the rest of the model does not hide it (models/hiding.wgsl).
    seen_from: vec4<u32>,
}

/// Which side of a triangle is outside: none (a part of an open sheet), that to which the cross product of its sides 0–1 and 0–2 points, or
/// the other.
const SIDE_OPEN: u32 = 0u;
const SIDE_ALONG: u32 = 1u;
const SIDE_AGAINST: u32 = 2u;
/// Added where the whole model is one closed body: what lies on its back may be left out. Between several that abut, backs fill cracks.
const SIDE_LONE: u32 = 4u;

struct Chunk {
    instance: u32,
    first: u32,
}

/// A vertex as the camera sees it: what the rasteriser draws.
struct SeenVertex {
    /// Direction from the camera times light path, camera axes.
    apparent: vec3<f32>,
    /// The light path (delay T_arrival − T_emission), in r_s; 0 for what is not seen.
    path: f32,
    /// Normal in rain axes (rest frame of the object, pure boost).
    normal: vec3<f32>,
    /// g = ν_observed/ν_emitted.
    shift: f32,
    /// Unit direction in which the light left, rest frame of the object, rain axes.
    leaving: vec3<f32>,
    /// Radius at emission, in r_s.
    radius: f32,
    /// Texture coordinates: of a fan, those of the point of its outer edge.
    uv: vec2<f32>,
    /// Until the mesh stage has seen to it: its work item.
    instance: u32,
    material: u32,
    /// Of a fan: texture coordinates at the axis,
    axis_uv: vec2<f32>,
    /// and how far from there (0) towards the outer edge (1; 1 elsewhere) the vertex is. The product is left to the pixels: over a cell
    /// that narrows to a point of the surface it is not linear.
    from_axis: f32,
    /// Height over the disk's plane at emission, in r_s.
    height: f32,
}

/// Texture coordinates of a vertex.
fn texture_point(vertex: SeenVertex) -> vec2<f32> {
    return mix(vertex.axis_uv, vertex.uv, vec2<f32>(vertex.from_axis));
}

/// A part of a triangle on its way from the object stage to the mesh stage. Corners are barycentric coordinates in the model triangle,
/// whose vertices are sorted by index: that makes every point of an edge the same bits from both its sides.
struct Piece {
    instance: u32,
    /// The model triangle.
    triangle: u32,
    /// PIECE_*.
    kind: u32,
    /// How often it was split.
    depth: u32,
    corner_a: vec3<f32>,
    corner_b: vec3<f32>,
    corner_c: vec3<f32>,
}

/// A triangle, tessellated on a barycentric grid.
const PIECE_TRIANGLE: u32 = 0u;
/// A triangle whose corner 0 is the axis: there its image is an arc, so it is tessellated as a quad (from the axis, along the edge).
const PIECE_FAN: u32 = 1u;
/// A triangle whose image is narrow between the edge opposite corner 0 and the other two: only its sides are cut, and joined across.
const PIECE_STRIP: u32 = 2u;

/// One block of at most 8 × 8 cells for a workgroup of the mesh stage.
struct WorkItem {
    piece: Piece,
    /// Levels of the sides. Triangle and strip: of the edge opposite corner 0, 1, 2. Fan: arc at the axis, outer edge, radial sides at
    /// corner 1 and 2.
    levels: vec4<u32>,
    /// Cells of the whole grid (from the axis, along the edge; a triangle has as many rows as columns, a strip one row along the edge
    /// opposite corner 0).
    rows: u32,
    columns: u32,
    /// First row and column of the block.
    first_row: u32,
    first_column: u32,
    /// First seen vertex and first index.
    first_vertex: u32,
    first_index: u32,
    vertex_count: u32,
    triangle_count: u32,
}

struct Material {
    /// Linear base colour.
    base: vec3<f32>,
    alpha: f32,
    /// Emitted radiance, linear.
    emissive: vec3<f32>,
    roughness: f32,
    metallic: f32,
    /// Of the textures, or −1.
    layer: f32,
    /// In K: it glows as a black body besides; 0 does not.
    temperature: f32,
    /// 1 if it shines as the engines burn.
    nozzle: f32,
}

struct Star {
    /// Unit direction on the sky, rain axes.
    direction: vec3<f32>,
    /// In units of a star of magnitude 0.
    flux: f32,
    /// In K.
    temperature: f32,
    /// Luminance of a black body of that temperature, as blackbody_rgb gives it.
    luminance: f32,
    unused_a: f32,
    unused_b: f32,
}

/// Orders in which stars are projected: the third is within a ten-thousandth of the shadow's edge and carries as little of the light.
const STAR_ORDERS: u32 = 2u;
/// Clusters of stars per workgroup of the projection.
const STAR_CLUSTERS: u32 = 8u;

/// Stars that are near each other on the sky, the brightest first.
struct StarCluster {
    /// Unit direction of their middle, rain axes.
    middle: vec3<f32>,
    /// Angle of the farthest of them from it, in rad,
    spread: f32,
    /// and its sine.
    sine: f32,
    /// Number of the first, and how many they are: whole numbers.
    first: f32,
    count: f32,
    unused: f32,
}

struct SeenStar {
    /// Centre in NDC.
    place: vec2<f32>,
    /// Of its spot, in pixels of the output: a faint star ends sooner.
    radius: f32,
    /// Linear light of the whole star, to be spread over its spot.
    colour: vec3<f32>,
}

/// What is seen of the sky at one corner of a cell of the screen.
struct SkyCorner {
    /// On the panorama.
    place: vec2<f32>,
    /// How much sky a pixel covers, in radians.
    size: f32,
    /// 0 within the shadow, else 1.
    lit: f32,
    /// The seen colours of its faintest and of its brightest parts.
    faint: vec3<f32>,
    /// Normalised device coordinates.
    ndc_x: f32,
    bright: vec3<f32>,
    ndc_y: f32,
}

/// A vertex of a triangle of a thin image.
struct ThinVertex {
    /// Clip position, widened to at least a pixel.
    position: vec4<f32>,
    /// The seen vertex.
    vertex: u32,
    /// The share of the drawn area that is covered.
    coverage: f32,
    order: u32,
    /// The share whose light crosses the disk's plane as often as the order says, and not once less.
    across: f32,
}
