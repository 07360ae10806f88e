//! Triangle models: what a renderer or a tracer needs of a thing's shape and surface.

mod accessors;
pub mod error;
mod gltf_file;
pub mod import;
pub mod shapes;
pub mod texture;

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

/// The ships of the game, in `assets/models/`: the hunter's and the quarry's.
pub const SHIP_MODELS: [&str; 2] = ["hunter.glb", "quarry.glb"];

/// A corner of a triangle, in the model's own axes (+y up, −z forward), lengths in units of the model.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Vertex {
    /// Position.
    pub position: [f32; 3],
    /// Outward unit normal.
    pub normal: [f32; 3],
    /// Texture coordinates, (0, 0) at the upper left corner of the image.
    pub uv: [f32; 2],
}

/// An sRGB-encoded image with straight alpha, rows from the top.
#[derive(Clone, PartialEq, Eq)]
pub struct Image {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue (sRGB-encoded) and alpha (linear), 4 bytes a pixel.
    pub rgba: Vec<u8>,
}

impl std::fmt::Debug for Image {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Image({} × {})", self.width, self.height)
    }
}

/// How a surface looks, after glTF's metallic-roughness model. Colours are linear with sRGB primaries.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Albedo (metals: reflectance) and alpha; multiplied by the texture.
    pub base_colour: [f32; 4],
    /// Light given off in the surface's rest frame, in the unit of the scene's radiance (1 = a white surface in full light).
    pub emissive: [f32; 3],
    /// Temperature in K of a surface that glows as a black body and is seen at g·T; 0 does not glow.
    pub temperature: f32,
    /// 0 for a dielectric, 1 for a metal.
    pub metallic: f32,
    /// Perceptual roughness in [0, 1].
    pub roughness: f32,
    /// It shines as the ship's engines burn: `emissive` is its light at full thrust.
    pub drive: bool,
    /// The image multiplied into `base_colour` (and into `emissive`). Materials that share an image share the `Arc`.
    pub texture: Option<Arc<Image>>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            base_colour: [0.8, 0.8, 0.8, 1.0],
            emissive: [0.0; 3],
            temperature: 0.0,
            metallic: 0.0,
            roughness: 0.6,
            drive: false,
            texture: None,
        }
    }
}

/// A triangle mesh with its materials. Triangles are counter-clockwise seen from outside.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Model {
    /// Corners. Shared by triangles that agree in position, normal and uv.
    pub vertices: Vec<Vertex>,
    /// Three indices into `vertices` each.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle its index into `materials`.
    pub triangle_materials: Vec<u32>,
    /// Surfaces; at least one where there is a triangle.
    pub materials: Vec<Material>,
}

/// Most triangles of a model: what the smallest buffers hold that a graphics adapter must offer (128 MiB).
pub const MOST_TRIANGLES: usize = 500_000;

impl Model {
    /// The largest distance of a vertex from the model's origin, in units of the model.
    pub fn radius(&self) -> f32 {
        self.vertices.iter().map(|vertex| glam::Vec3::from(vertex.position).length()).fold(0.0, f32::max)
    }

    /// How thin sections of it are: the diameter of the ball about the model's origin that holds it, over the least side of its box; 1 to 8.
    /// A sheet without thickness has 1: it is seen from its face.
    pub fn flatness(&self) -> f32 {
        let corners = || self.vertices.iter().map(|vertex| glam::Vec3::from(vertex.position));
        let least = corners().reduce(glam::Vec3::min).unwrap_or_default();
        let side = (corners().reduce(glam::Vec3::max).unwrap_or_default() - least).min_element();
        let diameter = 2.0 * self.radius();
        if side > 1e-3 * diameter { (diameter / side).clamp(1.0, 8.0) } else { 1.0 }
    }

    /// Bytes that it takes, an image that several materials share once.
    pub fn bytes(&self) -> usize {
        let mut images: Vec<&Arc<Image>> = self.materials.iter().filter_map(|material| material.texture.as_ref()).collect();
        images.sort_by_key(|image| Arc::as_ptr(image));
        images.dedup_by_key(|image| Arc::as_ptr(image));
        let triangle = size_of::<[u32; 3]>() + size_of::<u32>();
        let pixels: usize = images.iter().map(|image| image.rgba.len()).sum();
        self.vertices.len() * size_of::<Vertex>() + self.triangles.len() * triangle + pixels
    }

    /// `None` if the model is sound, or what is wrong with it: indices out of range, lengths that disagree, numbers that are not finite.
    pub fn fault(&self) -> Option<&'static str> {
        let corners = self.vertices.len() as u32;
        if self.triangles.len() > MOST_TRIANGLES {
            return Some("more than 500,000 triangles");
        }
        if self.triangle_materials.len() != self.triangles.len() {
            return Some("not every triangle has a material");
        }
        if self.triangles.iter().flatten().any(|&index| index >= corners) {
            return Some("a triangle points to a vertex that does not exist");
        }
        if self.triangle_materials.iter().any(|&index| index as usize >= self.materials.len()) {
            return Some("a triangle points to a material that does not exist");
        }
        let finite = |vertex: &Vertex| vertex.position.iter().chain(&vertex.normal).chain(&vertex.uv).all(|number| number.is_finite());
        (!self.vertices.iter().all(finite)).then_some("a vertex is not finite")
    }
}
