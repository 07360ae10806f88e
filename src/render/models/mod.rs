//! Models on the GPU: vertices, edges and triangles of all models in shared buffers, materials, and their textures in one array.

pub mod coarse;
pub mod collapse;
pub mod hiding;
mod mips;
pub mod outside;
pub mod patches;

use std::collections::HashMap;
use std::sync::Arc;

use image::RgbaImage;

use crate::scene::model::{Image, Model};

use crate::render::Gpu;
use crate::render::gpu::layout::{Growing, TableTexture, new_texture};
use crate::render::gpu::types::{Material, ModelTriangle, ModelVertex};
use crate::render::models::hiding::seen_from;
use crate::render::models::mips::{TEXTURE_SIZE, mips};
use crate::render::models::outside::{AGAINST, ALONG, OPEN, sides};

/// Layers of the texture array: a scene has few images.
const TEXTURE_LAYERS: u32 = 4;

/// Where a model lies in the shared buffers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ModelRange {
    /// First vertex and their number.
    pub vertices: [u32; 2],
    /// First edge and their number.
    pub edges: [u32; 2],
    /// First triangle and their number.
    pub triangles: [u32; 2],
    /// First material.
    pub material: u32,
    /// As [`Model::flatness`].
    pub flatness: f32,
}

/// No vertex is opposite to an edge, or more than two are; as in shaders/geometry/bindings.wgsl.
pub const ALONE: u32 = u32::MAX;

/// A model made ready: vertices in the order that edges need, and its edges.
#[derive(Debug, Default)]
pub struct Prepared {
    /// Vertices, each of one material, sorted by position.
    pub vertices: Vec<ModelVertex>,
    /// The two vertices of an edge, the lower first, and those opposite to it in the two triangles that meet there. If another number of
    /// triangles meets there, [`ALONE`] twice.
    pub edges: Vec<[u32; 4]>,
    /// Triangles with ascending vertices.
    pub triangles: Vec<ModelTriangle>,
}

impl Prepared {
    /// Sorts vertices by position and triangles by vertex. Then an edge has one direction, the same for all triangles that share it, even
    /// if the model has two vertices at one position for their normals. So its points have the same bits from every side, and no crack
    /// opens.
    pub fn new(model: &Model) -> Prepared {
        let mut corners: Vec<(u32, u32)> = Vec::new();
        for (triangle, &material) in model.triangles.iter().zip(&model.triangle_materials) {
            corners.extend(triangle.iter().map(|&vertex| (vertex, material)));
        }
        corners.sort_unstable();
        corners.dedup();
        let key = |&(vertex, material): &(u32, u32)| {
            let vertex = &model.vertices[vertex as usize];
            let bits = |v: [f32; 3]| v.map(|x| (x + 0.0).to_bits());
            (vertex.position.map(Total), bits(vertex.normal), vertex.uv.map(f32::to_bits), material)
        };
        corners.sort_by_key(key);
        let place: HashMap<(u32, u32), u32> = corners.iter().enumerate().map(|(i, &corner)| (corner, i as u32)).collect();
        let vertices: Vec<ModelVertex> = corners
            .iter()
            .map(|&(vertex, material)| {
                let v = &model.vertices[vertex as usize];
                let [u, v_of_texture] = v.uv;
                ModelVertex { position: v.position, u, normal: v.normal, v: v_of_texture, material, unused: [0; 3] }
            })
            .collect();
        let mut edges = Vec::new();
        let mut numbers: HashMap<[u32; 2], u32> = HashMap::new();
        let mut triangles = Vec::with_capacity(model.triangles.len());
        let sides = sides(model);
        let seen = seen_from(model, &sides);
        let known = sides.into_iter().zip(seen);
        for ((triangle, &material), (side, seen)) in model.triangles.iter().zip(&model.triangle_materials).zip(known) {
            let mut v = triangle.map(|vertex| place[&(vertex, material)]);
            let side = if in_turn(v) || side == OPEN { side } else { side ^ (ALONG | AGAINST) };
            v.sort_unstable();
            if v[0] == v[1] || v[1] == v[2] {
                continue;
            }
            let mut edge = |a: u32, b: u32| {
                *numbers.entry([a, b]).or_insert_with(|| {
                    edges.push([a, b, ALONE, ALONE]);
                    edges.len() as u32 - 1
                })
            };
            triangles.push(ModelTriangle {
                vertices: v,
                side,
                edges: [edge(v[1], v[2]), edge(v[0], v[2]), edge(v[0], v[1])],
                unused: 0,
                seen_from: seen,
            });
        }
        find_opposite(&vertices, &triangles, &mut edges);
        Prepared { vertices, edges, triangles }
    }
}

/// Fills in the vertices opposite to each edge. Vertices at one position are one corner of the body, whatever their normals.
fn find_opposite(vertices: &[ModelVertex], triangles: &[ModelTriangle], edges: &mut [[u32; 4]]) {
    let mut corners: HashMap<[u32; 3], u32> = HashMap::new();
    let corner: Vec<u32> = (0u32..)
        .zip(vertices)
        .map(|(i, vertex)| *corners.entry([0, 1, 2].map(|k| (vertex.position[k] + 0.0).to_bits())).or_insert(i))
        .collect();
    let key = |a: u32, b: u32| {
        let [a, b] = [a, b].map(|vertex| corner[vertex as usize]);
        [a.min(b), a.max(b)]
    };
    let mut opposite: HashMap<[u32; 2], Vec<u32>> = HashMap::new();
    for triangle in triangles {
        let [a, b, c] = triangle.vertices;
        for (edge, third) in [(key(b, c), a), (key(a, c), b), (key(a, b), c)] {
            opposite.entry(edge).or_default().push(third);
        }
    }
    for edge in edges {
        if let Some(&[c, d]) = opposite.get(&key(edge[0], edge[1])).map(Vec::as_slice) {
            (edge[2], edge[3]) = (c, d);
        }
    }
}

/// Whether sorting three vertices keeps the sense in which they go round.
fn in_turn([a, b, c]: [u32; 3]) -> bool {
    (a < b) ^ (b < c) ^ (a < c)
}

/// f32 with a total order, for sorting.
#[derive(Clone, Copy, PartialEq)]
struct Total(f32);

impl Eq for Total {}

impl PartialOrd for Total {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Total {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        // −0 and 0 are the same position.
        (self.0 + 0.0).total_cmp(&(other.0 + 0.0))
    }
}

/// Models made ready for the GPU, in shared arrays: data of the processor alone, so that it can be made where there is no device.
#[derive(Clone, Debug, Default)]
pub struct ModelSet {
    vertices: Vec<ModelVertex>,
    edges: Vec<[u32; 4]>,
    triangles: Vec<ModelTriangle>,
    materials: Vec<Material>,
    images: Vec<(Arc<Image>, Arc<[RgbaImage]>)>,
}

impl ModelSet {
    /// Adds a model and says where it lies.
    pub fn add(&mut self, model: &Model) -> ModelRange {
        let prepared = Prepared::new(model);
        let range = ModelRange {
            vertices: [self.vertices.len() as u32, prepared.vertices.len() as u32],
            edges: [self.edges.len() as u32, prepared.edges.len() as u32],
            triangles: [self.triangles.len() as u32, prepared.triangles.len() as u32],
            material: self.materials.len() as u32,
            flatness: model.flatness(),
        };
        self.vertices.extend(prepared.vertices);
        self.edges.extend(prepared.edges);
        self.triangles.extend(prepared.triangles);
        for material in &model.materials {
            let layer = material.texture.as_ref().and_then(|image| self.layer(image));
            let [red, green, blue, alpha] = material.base_colour;
            self.materials.push(Material {
                base: [red, green, blue],
                alpha,
                emissive: material.emissive,
                roughness: material.roughness,
                metallic: material.metallic,
                layer: layer.map_or(-1.0, |layer| layer as f32),
                temperature: material.temperature,
                nozzle: f32::from(u8::from(material.drive)),
            });
        }
        range
    }

    /// Makes the images of a model ready, which [`add`](ModelSet::add) else does.
    pub fn add_images(&mut self, model: &Model) {
        for image in model.materials.iter().filter_map(|material| material.texture.as_ref()) {
            self.layer(image);
        }
    }

    /// The layer of the texture array for an image. None when the array is full: the surface is then plain.
    fn layer(&mut self, image: &Arc<Image>) -> Option<usize> {
        if let Some(known) = self.images.iter().position(|(other, _)| Arc::ptr_eq(other, image)) {
            return Some(known);
        }
        if self.images.len() >= TEXTURE_LAYERS as usize {
            bevy::log::warn!("a scene can have {TEXTURE_LAYERS} different images; one more is left out");
            return None;
        }
        self.images.push((image.clone(), mips(image)));
        Some(self.images.len() - 1)
    }
}

/// The tables and the texture array of all models.
#[derive(Debug)]
pub struct Models {
    /// What they hold.
    set: ModelSet,
    /// All vertices.
    pub vertices: TableTexture,
    /// All edges.
    pub edges: TableTexture,
    /// All triangles.
    pub triangles: TableTexture,
    /// All materials.
    pub material_buffer: Growing,
    /// All images.
    pub texture: wgpu::Texture,
}

impl Models {
    /// No models yet.
    pub fn new(device: &wgpu::Device) -> Self {
        let storage = wgpu::BufferUsages::STORAGE;
        let texture = new_texture(
            device,
            "surface textures",
            [TEXTURE_SIZE, TEXTURE_SIZE],
            [TEXTURE_LAYERS, TEXTURE_SIZE.ilog2() + 1],
            wgpu::TextureFormat::Rgba8UnormSrgb,
            wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        );
        Models {
            set: ModelSet::default(),
            vertices: TableTexture::new(device, "model vertices", true),
            edges: TableTexture::new(device, "model edges", true),
            triangles: TableTexture::new(device, "model triangles", true),
            material_buffer: Growing::new(device, "materials", storage),
            texture,
        }
    }

    /// Uploads these models instead of all others. Buffers may be replaced: bind groups must be made after this.
    pub fn upload(&mut self, gpu: &Gpu, set: ModelSet) {
        self.set = set;
        self.write(gpu, 0);
    }

    /// Adds a model and says where it lies; as [`upload`](Models::upload).
    pub fn add(&mut self, gpu: &Gpu, model: &Model) -> ModelRange {
        let images = self.set.images.len();
        let range = self.set.add(model);
        self.write(gpu, images);
        range
    }

    /// Writes all of the set but the first `written` images, which are there.
    fn write(&mut self, gpu: &Gpu, written: usize) {
        for (layer, (_, mips)) in (0u32..).zip(&self.set.images).skip(written) {
            self.write_image(gpu, mips, layer);
        }
        self.vertices.write(gpu, &self.set.vertices);
        self.edges.write(gpu, &self.set.edges);
        self.triangles.write(gpu, &self.set.triangles);
        self.material_buffer.write(gpu, &self.set.materials);
    }

    /// Writes an image with all its levels into a layer of the texture array.
    fn write_image(&self, gpu: &Gpu, mips: &[RgbaImage], layer: u32) {
        for (mip, level) in (0u32..).zip(mips) {
            let size = level.width();
            gpu.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    texture: &self.texture,
                    mip_level: mip,
                    origin: wgpu::Origin3d { x: 0, y: 0, z: layer },
                    aspect: wgpu::TextureAspect::All,
                },
                level,
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * size), rows_per_image: None },
                wgpu::Extent3d { width: size, height: size, depth_or_array_layers: 1 },
            );
        }
    }
}
