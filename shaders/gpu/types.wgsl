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
    /// Unit vector from the hole to the camera (rain axes); w: the camera's radius L.
    radial: vec4<f32>,
    /// Two unit vectors that complete `radial` to a right-handed frame; w of the first: least width of a thin image in pixels, of the
    /// second: the river's speed β = √(1/L).
    side_a: vec4<f32>,
    side_b: vec4<f32>,
    /// x, y: cotangents of half the field of view across and down; z: near distance in r_s; w: time T since the start, for what twinkles.
    projection: vec4<f32>,
    /// x, y: size of the target in pixels; z: angle of one pixel in radians at the centre; w: error budget in radians.
    size: vec4<f32>,
    /// x: exposure bias (stops, as a factor), y: star brightness, z: sky brightness, w: bloom strength.
    light: vec4<f32>,
    /// x: least exposure, y: greatest exposure, z: adaptation factor of this frame in (0, 1], w: ψ of the edge of the shadow, rain frame.
    exposure: vec4<f32>,
    /// x: bits of FLAG_*; y: how often an edge may be halved; z: unused; w: number of image orders drawn.
    switches: vec4<u32>,
    /// Rotation from rain axes to the axes of the sky (ICRS), columns. w: the light that the picture is brought to, with the disk if there
    /// is one; standard deviation of a star's spot in pixels; least flux of a star.
    sky_x: vec4<f32>,
    sky_y: vec4<f32>,
    sky_z: vec4<f32>,
    /// Capacities: x vertices, y indices, z work items, w thin vertices. Of each but the last a fifth is kept for what is drawn coarsely
    /// when the rest is full.
    capacity: vec4<u32>,
    /// x, y: least and greatest light of middle grey on the own ship; z: exposure of the frame before, w: 1 once that is known.
    fill: vec4<f32>,
    /// What the meter leaves out, the own ship's circle: x, y: its middle, in widths of the picture from its middle, y down; z: its radius,
    /// 0 for none. w: the light that the picture is brought to while no disk is in it.
    unmetered: vec4<f32>,
    /// Indices of the disk's triangles in the picture, as DiskCounters has them; some number if it is not drawn from arcs.
    disk: vec4<u32>,
    /// How far the mean luminance of the picture as shown may rise, where it is bound: x: by how much of white in this frame, y: 1 over
    /// that of the frame before, 0 over black.
    rise: vec4<f32>,
}

const FLAG_DOPPLER: u32 = 1u;
const FLAG_BEAMING: u32 = 2u;
const FLAG_INSIDE: u32 = 16u;
const FLAG_HOLD_EXPOSURE: u32 = 32u;
const FLAG_MIDPOINT: u32 = 64u;

/// One object seen in one image order.
struct Instance {
    /// The object's centre at its own emission time T₀, minus the camera's position; w: T − T₀.
    offset: vec4<f32>,
    /// x, y: where the centre is across the axis of hole and camera, along `side_a` and `side_b`: near the axis the offset has lost the
    /// digits that it takes. z: how far a point may be put beside its place by the rounding of f32; all in r_s. w: how much closer chords
    /// of a slim image are held, else 1.
    axis: vec4<f32>,
    /// The centre from the hole: near the hole a far camera's offset has lost the digits that r − 1 needs.
    /// w: what its engines lack of their full light, as a share.
    position: vec4<f32>,
    /// dx/dT of the centre; w: r_s per unit of the model where the object moves or turns, else 0.
    velocity: vec4<f32>,
    /// Rain-frame momentum per mass; w: γ.
    momentum: vec4<f32>,
    /// Columns of the matrix from body offsets to offsets on the slice at T₀: size, attitude, contraction. w: d²x/dT² of the centre.
    shape_x: vec4<f32>,
    shape_y: vec4<f32>,
    shape_z: vec4<f32>,
    /// Mean angular velocity about T₀ in 1/T, rain axes; w: by how much the direction of light against a surface, as a sine, may be off
    /// what this turn tells.
    spin: vec4<f32>,
    /// What was recorded of the flight (instances/recorded.wgsl). x: time of the first node after T₀; y: 1 over the time between two;
    /// z: number of times between them; w: texel of the first in the table (bits of a u32).
    nodes: vec4<f32>,
    /// The momentum p that contracts the body on the slice, at T₀; w unused.
    drift: vec4<f32>,
    /// dp/dT; w: 1 if the centre strays from its smooth way, as the nodes tell, else 0.
    force: vec4<f32>,
    /// Columns of the rotation from body axes to rain axes, for normals; w: d³x/dT³ of the centre.
    turn_x: vec4<f32>,
    turn_y: vec4<f32>,
    turn_z: vec4<f32>,
    /// d⁴x/dT⁴ of the centre; w: how often light of this image crosses the plane z = 0 of the disk on its way, −1 if parts of it differ.
    snap: vec4<f32>,
    /// Light that falls on a surface of normal n (rain axes): ambient + direction·n, per channel.
    light_red: vec4<f32>,
    light_green: vec4<f32>,
    light_blue: vec4<f32>,
    /// Caps of directions, camera axes, that the image keeps to: by its farthest from outwards, its nearest, and about its middle. xyz: the
    /// cap's middle; w: the square of the chord from there to its rim, positive if the image lies inside, negative if outside, 0 if it may
    /// lie anywhere.
    bound_high: vec4<f32>,
    bound_low: vec4<f32>,
    bound_look: vec4<f32>,
    /// x: image order, y: object id, z: first out vertex, w: first edge state.
    ids: vec4<u32>,
    /// x: first model vertex, y: vertex count, z: first model edge, w: edge count.
    vertices: vec4<u32>,
    /// x: first model triangle, y: triangle count, z: first material, w: INSTANCE_*.
    triangles: vec4<u32>,
}

/// Both sides of every triangle are drawn.
const INSTANCE_TWO_SIDED: u32 = 1u;
/// The object does not move; each of its points emits as a static observer there.
const INSTANCE_HELD: u32 = 2u;

/// Its whole image of this order is narrow (`render.thin_below`).
const INSTANCE_THIN: u32 = 4u;
/// The image of something held inside the horizon by light of E < 0.
const INSTANCE_MINUS: u32 = 8u;
/// The player's own ship, lit for the picture (`render.fill_least`).
const INSTANCE_OWN: u32 = 32u;
/// Its image, of a higher order, is a few pixels wide and drawn out along the ring: much of it is outline.
const INSTANCE_NARROW: u32 = 16u;

fn is_thin(instance: Instance) -> bool {
    return (instance.triangles.w & INSTANCE_THIN) != 0u;
}

fn two_sided(instance: Instance) -> bool {
    return (instance.triangles.w & INSTANCE_TWO_SIDED) != 0u;
}

struct ModelVertex {
    /// Body axes, model units; w: u of the texture.
    position: vec4<f32>,
    /// Unit normal in body axes; w: v of the texture.
    normal: vec4<f32>,
    /// x: material, counted from the model's own first; a vertex belongs to one material. yzw unused.
    info: vec4<u32>,
}

struct ModelTriangle {
    /// Three vertices in ascending order, counted from the model's own first; w: SIDE_*.
    vertices: vec4<u32>,
    /// Edge i is opposite to vertex i; w: a bit for each direction from which no other part of the model hides it (models/hiding.wgsl).
    edges: vec4<u32>,
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
    /// Direction from the camera times light path, camera axes; w: the light path (delay T_arrival − T_emission).
    apparent: vec4<f32>,
    /// Normal in rain axes (rest frame of the object, pure boost); w: g = ν_observed/ν_emitted.
    normal: vec4<f32>,
    /// Unit direction in which the light left, rest frame of the object, rain axes; w: radius at emission.
    leaving: vec4<f32>,
    /// x, y: texture coordinates; z: instance, w: material (bits).
    surface: vec4<f32>,
    /// z: how far from the axis, of a fan (1 elsewhere): between the axis, with the texture coordinates x, y, and the point of the outer
    /// edge that `surface` tells. The product is left to the pixels: over a cell that narrows to a point of the surface it is not linear.
    /// w: height over the disk's plane at emission, in r_s.
    fan: vec4<f32>,
}

/// Texture coordinates of a vertex.
fn texture_point(vertex: SeenVertex) -> vec2<f32> {
    return mix(vertex.fan.xy, vertex.surface.xy, vec2<f32>(vertex.fan.z));
}

/// A part of a triangle on its way from the object stage to the mesh stage. Corners are barycentric coordinates in the model triangle,
/// whose vertices are sorted by index: that makes every point of an edge the same bits from both its sides.
struct Piece {
    /// x: instance, y: model triangle, z: kind (PIECE_*), w: depth of splitting.
    what: vec4<u32>,
    corner_a: vec4<f32>,
    corner_b: vec4<f32>,
    corner_c: vec4<f32>,
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
    /// x, y: cells of the whole grid (from the axis, along the edge; a triangle has x = y, a strip one row along the edge opposite corner
    /// 0), z, w: first row and column of the block.
    grid: vec4<u32>,
    /// x: first seen vertex, y: first index, z: vertices, w: triangles.
    place: vec4<u32>,
}

struct Material {
    /// Linear base colour; w: alpha.
    base: vec4<f32>,
    /// Emitted radiance, linear; w: roughness.
    emissive: vec4<f32>,
    /// x: metallic, y: texture layer or −1, z: 1 if the base colour shines by itself, w: 1 if it shines as the engines burn.
    surface: vec4<f32>,
}

struct Star {
    /// Unit direction on the sky, rain axes; w: flux, in units of a star of magnitude 0.
    direction: vec4<f32>,
    /// x: temperature in K; y: luminance of a black body of that temperature, as blackbody_rgb gives it; zw unused.
    colour: vec4<f32>,
}

struct SeenStar {
    /// x, y: centre in NDC; z: radius of its spot in pixels (a faint star ends sooner); w unused.
    place: vec4<f32>,
    /// Linear light of the whole star, to be spread over its spot.
    colour: vec4<f32>,
}

/// What is seen of the sky at one corner of a cell of the screen.
struct SkyCorner {
    /// x, y: place on the panorama; z: how much sky a pixel covers, in radians; w: 0 within the shadow, else 1.
    place: vec4<f32>,
    /// The seen colours of its faintest and of its brightest parts; w: normalised device coordinates.
    faint: vec4<f32>,
    bright: vec4<f32>,
}

/// A vertex of a triangle of a thin image.
struct ThinVertex {
    /// Clip position, widened to at least a pixel.
    position: vec4<f32>,
    /// x: seen vertex (bits of a u32), y: coverage, the share of the drawn area that is covered, z: image order, w: the share whose light
    /// crosses the disk's plane as often as the order says, and not once less.
    data: vec4<f32>,
}
