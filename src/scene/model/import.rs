//! glTF files to [`Model`]s: all meshes of the default scene in one, transforms applied, textures decoded.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};
use gltf::mesh::Mode;

use super::{Image, Material, Model, Vertex};
use crate::scene::assets::assets_folder;

/// Why a model could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ModelError {
    /// Missing, unreadable or malformed.
    #[error("model {}: {source}", path.display())]
    Gltf {
        /// The file.
        path: PathBuf,
        /// What the reader says.
        source: gltf::Error,
    },
    /// Readable, but of no use.
    #[error("model {}: {reason}", path.display())]
    Unusable {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
}

/// Reads a `.glb` or `.gltf` file.
pub fn load_model(path: &Path) -> Result<Model, ModelError> {
    let unusable = |reason: &str| ModelError::Unusable { path: path.to_path_buf(), reason: reason.into() };
    let (document, buffers, images) = gltf::import(path).map_err(|source| ModelError::Gltf { path: path.to_path_buf(), source })?;
    let images: Vec<Option<Arc<Image>>> = images.into_iter().map(|image| decode(image).map(Arc::new)).collect();
    let mut model =
        Model { materials: document.materials().map(|material| read_material(&material, &images)).collect(), ..Model::default() };
    let default_material = model.materials.len() as u32;
    model.materials.push(Material::default());
    let scene = document.default_scene().or_else(|| document.scenes().next()).ok_or_else(|| unusable("has no scene"))?;
    let mut open: Vec<(gltf::Node<'_>, Mat4)> = scene.nodes().map(|node| (node, Mat4::IDENTITY)).collect();
    while let Some((node, parent)) = open.pop() {
        let place = parent * Mat4::from_cols_array_2d(&node.transform().matrix());
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            if primitive.mode() == Mode::Triangles {
                let material = primitive.material().index().map_or(default_material, |index| index as u32);
                append(&mut model, &primitive, &buffers, place, material)
                    .ok_or_else(|| unusable("a mesh has no positions or indices out of range"))?;
            }
        }
        open.extend(node.children().map(|child| (child, place)));
    }
    if model.triangles.is_empty() {
        return Err(unusable("has no triangles"));
    }
    match model.fault() {
        Some(fault) => Err(unusable(fault)),
        None => Ok(model),
    }
}

/// The file of a model: of this name under `assets/models/`, else the one at this path.
pub fn model_path(name: &str) -> PathBuf {
    let inside = assets_folder().join("models").join(name);
    if inside.is_file() || !Path::new(name).is_file() { inside } else { PathBuf::from(name) }
}

/// Reads a model by its name under `assets/models/` (or its path); on failure a placeholder and the reason.
pub fn load_or_placeholder(name: &str) -> (Model, Option<ModelError>) {
    match load_model(&model_path(name)) {
        Ok(model) => (model, None),
        Err(error) => (placeholder(), Some(error)),
    }
}

/// A magenta dart of length 1, nose at −z: what is drawn for a model that could not be read.
pub fn placeholder() -> Model {
    let corners = [Vec3::new(0.0, 0.0, -0.5), Vec3::new(-0.3, 0.0, 0.5), Vec3::new(0.3, 0.0, 0.5), Vec3::new(0.0, 0.2, 0.5)];
    let mut model = Model {
        materials: vec![Material { base_colour: [1.0, 0.0, 1.0, 1.0], emissive: [0.5, 0.0, 0.5], ..Material::default() }],
        ..Model::default()
    };
    for face in [[0, 1, 3], [0, 3, 2], [0, 2, 1], [1, 2, 3]] {
        let [a, b, c] = face.map(|index: usize| corners[index]);
        let normal = (b - a).cross(c - a).normalize();
        let first = model.vertices.len() as u32;
        model.vertices.extend([a, b, c].map(|corner| Vertex { position: corner.to_array(), normal: normal.to_array(), uv: [0.0; 2] }));
        model.triangles.push([first, first + 1, first + 2]);
        model.triangle_materials.push(0);
    }
    model
}

/// `None` where positions are missing or an index points nowhere.
fn append(model: &mut Model, primitive: &gltf::Primitive<'_>, buffers: &[gltf::buffer::Data], place: Mat4, material: u32) -> Option<()> {
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(|data| data.0.as_slice()));
    let positions: Vec<Vec3> = reader.read_positions()?.map(|position| place.transform_point3(Vec3::from(position))).collect();
    let turn = Mat3::from_mat4(place).inverse().transpose();
    // A mirrored node turns its triangles inside out.
    let mirrored = place.determinant() < 0.0;
    let uvs: Vec<Vec2> = reader.read_tex_coords(0).map(|uvs| uvs.into_f32().map(Vec2::from).collect()).unwrap_or_default();
    let mut triangles: Vec<[u32; 3]> = match reader.read_indices() {
        Some(indices) => indices.into_u32().collect::<Vec<u32>>().chunks_exact(3).map(|three| [three[0], three[1], three[2]]).collect(),
        None => (0..positions.len() as u32 / 3).map(|first| [3 * first, 3 * first + 1, 3 * first + 2]).collect(),
    };
    if triangles.iter().flatten().any(|&index| index as usize >= positions.len()) {
        return None;
    }
    if mirrored {
        triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    let normals: Vec<Vec3> = match reader.read_normals() {
        Some(normals) => normals.map(|normal| (turn * Vec3::from(normal)).normalize_or(Vec3::Y)).collect(),
        None => smooth_normals(&positions, &triangles),
    };
    let first = model.vertices.len() as u32;
    model.vertices.extend(positions.iter().enumerate().map(|(index, position)| Vertex {
        position: position.to_array(),
        normal: normals.get(index).copied().unwrap_or(Vec3::Y).to_array(),
        uv: uvs.get(index).copied().unwrap_or_default().to_array(),
    }));
    model.triangle_materials.extend(std::iter::repeat_n(material, triangles.len()));
    model.triangles.extend(triangles.iter().map(|triangle| triangle.map(|index| index + first)));
    Some(())
}

/// Normals averaged over the faces at each vertex, weighted by area.
fn smooth_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|index| positions[index as usize]);
        for &index in triangle {
            sums[index as usize] += (b - a).cross(c - a);
        }
    }
    sums.into_iter().map(|sum| sum.normalize_or(Vec3::Y)).collect()
}

/// The material of nozzles, by name: what shines as the engines burn.
const DRIVE: &str = "drive";

fn read_material(material: &gltf::Material<'_>, images: &[Option<Arc<Image>>]) -> Material {
    let surface = material.pbr_metallic_roughness();
    let texture = surface.base_color_texture().or_else(|| material.emissive_texture());
    let strength = material.emissive_strength().unwrap_or(1.0);
    Material {
        base_colour: Vec4::from(surface.base_color_factor()).clamp(Vec4::ZERO, Vec4::ONE).to_array(),
        emissive: material.emissive_factor().map(|channel| channel * strength),
        temperature: 0.0,
        metallic: surface.metallic_factor().clamp(0.0, 1.0),
        roughness: surface.roughness_factor().clamp(0.0, 1.0),
        drive: material.name() == Some(DRIVE),
        texture: texture.and_then(|texture| images.get(texture.texture().source().index()).cloned().flatten()),
    }
}

/// To 8-bit RGBA; `None` for floating-point and 16-bit images, which base colours do not use.
fn decode(image: gltf::image::Data) -> Option<Image> {
    use gltf::image::Format;
    let rgba = match image.format {
        Format::R8G8B8A8 => image.pixels,
        Format::R8G8B8 => image.pixels.chunks_exact(3).flat_map(|p| [p[0], p[1], p[2], 255]).collect(),
        Format::R8 => image.pixels.iter().flat_map(|&p| [p, p, p, 255]).collect(),
        Format::R8G8 => image.pixels.chunks_exact(2).flat_map(|p| [p[0], p[0], p[0], p[1]]).collect(),
        _ => return None,
    };
    Some(Image { width: image.width, height: image.height, rgba })
}
