#define_import_path lensrunner::instances::held

// What is held in place in a scene: uploaded once, placed by geometry/place.wgsl in each frame. Each type has a Rust mirror of the same
// name in src/render/gpu/types.rs.

/// One body.
struct HeldBody {
    /// Its centre, from the hole, in r_s.
    position: vec3<f32>,
    /// Its farthest point from there, in r_s.
    reach: f32,
    /// What rounding took from the position.
    position_rest: vec3<f32>,
    /// r_s per unit of the model.
    scale: f32,
    /// Unit quaternion from body axes to rain axes.
    attitude: vec4<f32>,
    /// As in `Instance`.
    light_red: vec4<f32>,
    light_green: vec4<f32>,
    light_blue: vec4<f32>,
    /// Of the list of models: its coarsest, and how many there are, the full one last.
    first_model: u32,
    model_count: u32,
    /// As in `Instance`.
    object: u32,
    /// Diameter of its ball over the least side of its box.
    flatness: f32,
}

/// One model of a body, or one that stands in for it: where it begins and how much there is, as in `Instance`.
struct HeldModel {
    first_vertex: u32,
    vertex_count: u32,
    first_edge: u32,
    edge_count: u32,
    first_triangle: u32,
    triangle_count: u32,
    first_material: u32,
    /// Stands in for images up to this width, in pixels, where half a pixel is allowed.
    below: f32,
}

/// What of a frame decides how they are placed.
struct HeldFrame {
    /// The camera, from the hole, in r_s.
    camera: vec3<f32>,
    /// Number of bodies.
    bodies: u32,
    /// What rounding took from the camera's position.
    camera_rest: vec3<f32>,
    /// Image orders, and one more for light of E < 0 where the camera is inside the horizon.
    images: u32,
    orders: u32,
    /// Bits of INSTANCE_* that every image gets besides.
    flags: u32,
    /// 1 if the bounds of images are known: by exact methods, from outside the horizon.
    bounded: u32,
    /// Of Settings: widths in pixels.
    thin_below: f32,
    coarse_below: f32,
    least_width: f32,
    /// The error that is allowed, over half a pixel.
    allowed: f32,
    /// Factor on the strictness, of the camera's radius.
    strictness: f32,
    /// 1 if narrow images are thin ones.
    has_thin: u32,
    /// Where the room ends: in the table of instances,
    images_end: u32,
    /// among seen vertices and among states, for images as they should be and, behind those, for what is drawn coarsely when that is full.
    vertices_end: array<u32, 2>,
    states_end: array<u32, 2>,
    unused: array<u32, 2>,
}
