//! What is held in place: made ready for the card once, which places its images in each frame (`shaders/geometry/place.wgsl`).

use crate::render::gpu::types::{CHUNK, HeldBody, HeldFrame, HeldModel};
use crate::render::instances::{DrawnObject, ObjectMotion, light_rows, numbers, photon_sphere_strictness};
use crate::render::models::ModelRange;
use crate::render::settings::Settings;
use crate::spacetime::Observer;
use glam::DVec3;

use crate::render::gpu::types::placed::TWO_SIDED;

/// All that a scene holds in place.
#[derive(Clone, Debug, Default)]
pub struct HeldBodies {
    bodies: Vec<HeldBody>,
    models: Vec<HeldModel>,
    /// By a full model: where the list of it and its stand-ins begins, and how many they are.
    known: Vec<(ModelRange, [u32; 2])>,
    count: HeldCount,
}

/// How much is held, or shown of it.
#[derive(Clone, Copy, Debug, Default)]
pub struct HeldCount {
    /// Bodies, or images.
    pub number: u64,
    /// Vertices of their full models.
    pub vertices: u64,
    /// Edges of those.
    pub edges: u64,
    /// Triangles of those.
    pub triangles: u64,
    /// Chunks of vertices, edges and triangles.
    pub chunks: [u64; 3],
}

/// What is held, in one frame.
#[derive(Clone, Copy, Debug)]
pub struct HeldImages {
    /// For the shader.
    pub frame: HeldFrame,
    /// What all images take at most.
    pub most: HeldCount,
}

impl HeldBodies {
    /// Adds an object; one that is not held is none of them.
    pub fn add(&mut self, object: &DrawnObject) {
        let ObjectMotion::Static { position, attitude } = object.motion else { return };
        let known = self.known.iter().find(|(model, _)| *model == object.model).map(|(_, list)| *list);
        let [first_model, model_count] = known.unwrap_or_else(|| self.add_models(object));
        let (rounded, rest) = split(position);
        self.bodies.push(HeldBody {
            position: rounded,
            reach: object.reach as f32,
            position_rest: rest,
            scale: object.scale as f32,
            attitude: attitude.as_quat().to_array(),
            light: light_rows(&object.light),
            first_model,
            model_count,
            object: object.id,
            flatness: object.model.flatness,
        });
        let [vertices, edges, triangles] = [object.model.vertices[1], object.model.edges[1], object.model.triangles[1]];
        self.count.number += 1;
        self.count.vertices += u64::from(vertices);
        self.count.edges += u64::from(edges);
        self.count.triangles += u64::from(triangles);
        for (chunks, count) in self.count.chunks.iter_mut().zip([vertices, edges, triangles]) {
            *chunks += u64::from(count.div_ceil(CHUNK));
        }
    }

    fn add_models(&mut self, object: &DrawnObject) -> [u32; 2] {
        let first = self.models.len() as u32;
        let coarser = object.stand_ins.iter().map(|stand_in| (stand_in.model, stand_in.below as f32));
        self.models.extend(coarser.chain([(object.model, f32::INFINITY)]).map(|(model, below)| HeldModel {
            first_vertex: model.vertices[0],
            vertex_count: model.vertices[1],
            first_edge: model.edges[0],
            edge_count: model.edges[1],
            first_triangle: model.triangles[0],
            triangle_count: model.triangles[1],
            first_material: model.material,
            below,
        }));
        let list = [first, self.models.len() as u32 - first];
        self.known.push((object.model, list));
        list
    }

    /// All bodies.
    pub fn bodies(&self) -> &[HeldBody] {
        &self.bodies
    }

    /// Their models: of each body the coarsest first, the full one last.
    pub fn models(&self) -> &[HeldModel] {
        &self.models
    }

    /// How much they are.
    pub fn count(&self) -> HeldCount {
        self.count
    }
}

impl HeldCount {
    /// What is seen of them by a camera, each image with `flags` (bits of [`placed`](crate::render::gpu::types::placed)) besides; None if
    /// nothing is held.
    pub fn images(&self, camera: &Observer, settings: &Settings, flags: u32) -> Option<HeldImages> {
        let method = settings.method;
        let orders = settings.orders.min(method.orders);
        // From inside the horizon what is inside is seen once more, by light of E < 0.
        let inside = camera.radius() < 1.0;
        let images = orders + u32::from(inside && method.bends);
        let (position, rest) = split(camera.position);
        let frame = HeldFrame {
            camera: position,
            bodies: self.number as u32,
            camera_rest: rest,
            images,
            orders,
            flags: flags | if method.bends { 0 } else { TWO_SIDED },
            bounded: u32::from(method.is_exact && !inside),
            thin_below: settings.thin_below as f32,
            coarse_below: settings.coarse_below as f32,
            least_width: settings.least_width as f32,
            allowed: settings.pixel_error / 0.5,
            strictness: photon_sphere_strictness(camera),
            has_thin: u32::from(settings.min_width > 0.0),
            ..HeldFrame::default()
        };
        let all = |one: u64| one * u64::from(images);
        let most = HeldCount {
            number: all(self.number),
            vertices: all(self.vertices),
            edges: all(self.edges),
            triangles: all(self.triangles),
            chunks: self.chunks.map(all),
        };
        (self.number > 0).then_some(HeldImages { frame, most })
    }
}

/// A vector in f32, and what rounding took from it.
fn split(v: DVec3) -> ([f32; 3], [f32; 3]) {
    (numbers(v), numbers(v - v.as_vec3().as_dvec3()))
}
