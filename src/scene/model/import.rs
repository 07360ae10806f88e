//! glTF files to [`Model`]s: all meshes of the default scene in one, transforms applied, textures decoded.

use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

use glam::{DVec3, Mat3, Mat4, Vec2, Vec3, Vec4};
use gltf::mesh::Mode;
use image::{ImageFormat, ImageReader, Limits};

pub use super::error::ModelError;
use super::gltf_file::{self, GltfFile};
use super::{Image, MOST_TRIANGLES, Material, Model, Vertex, accessors};
use crate::game_files::{self, GameFile};
use crate::user_file::short;

/// How far the farthest vertex of a model may be from its origin, in units of the model, after all transforms.
const SIZES: std::ops::RangeInclusive<f32> = 1e-3..=1e3;
/// The most that a material gives off, in units of [`Material::emissive`].
const MOST_EMISSION: f32 = 1e6;
/// The most parts of meshes that are put together.
const MOST_PARTS: usize = 100_000;
/// The most pixels along a side of an image.
const MOST_PIXELS: u32 = 8192;
/// The most bytes of all images together, 4 a pixel.
const MOST_IMAGE_BYTES: u64 = 512 << 20;

/// Reads a `.glb` or `.gltf` file.
pub fn load_model(path: &Path) -> Result<Model, ModelError> {
    read_model(&GameFile::at(path))
}

fn read_model(file: &GameFile) -> Result<Model, ModelError> {
    let mut parts = gltf_file::read(file)?;
    let model = make(&mut parts).map_err(|reason| ModelError::Unusable { path: file.path.clone(), reason })?;
    Ok(model)
}

fn make(file: &mut GltfFile) -> Result<Model, String> {
    let materials = read_materials(file)?;
    let default_material = materials.len() as u32;
    let mut model = Model { materials, ..Model::default() };
    model.materials.push(Material::default());
    let (document, root) = (&file.document, file.document.as_json());
    let scene = document.default_scene().or_else(|| document.scenes().next()).ok_or("has no scene")?;
    let mut open: Vec<(gltf::Node<'_>, Mat4)> = scene.nodes().map(|node| (node, Mat4::IDENTITY)).collect();
    let mut seen = vec![false; document.nodes().len()];
    let (mut parts, mut triangles, mut vertices) = (0, 0, 0);
    while let Some((node, parent)) = open.pop() {
        let name = format!("nodes[{}]", node.index());
        if std::mem::replace(&mut seen[node.index()], true) {
            return Err(format!("{name} hangs in two places or in a circle, allowed is one"));
        }
        let place = parent * Mat4::from_cols_array_2d(&node.transform().matrix());
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            parts += 1;
            if parts > MOST_PARTS {
                return Err(format!("{name}: more than {MOST_PARTS} parts of meshes, allowed {MOST_PARTS}"));
            }
            if primitive.mode() != Mode::Triangles {
                continue;
            }
            // Counted before anything is made room for.
            let mesh = node.mesh().map_or(0, |mesh| mesh.index());
            let told = &root.meshes[mesh].primitives[primitive.index()];
            triangles += accessors::triangles(root, told);
            vertices += accessors::vertices(root, told);
            if triangles > MOST_TRIANGLES as u64 {
                return Err(format!("{name}: more than {MOST_TRIANGLES} triangles in all, allowed {MOST_TRIANGLES}"));
            }
            if vertices > 3 * MOST_TRIANGLES as u64 {
                return Err(format!("{name}: more than {0} vertices in all, allowed {0}", 3 * MOST_TRIANGLES));
            }
            let material = primitive.material().index().map_or(default_material, |index| index as u32);
            let part = format!("meshes[{mesh}].primitives[{}]", primitive.index());
            append(&mut model, &primitive, &file.buffers, place, material).map_err(|wrong| format!("{part} in {name}: {wrong}"))?;
        }
        open.extend(node.children().map(|child| (child, place)));
    }
    if model.triangles.is_empty() {
        return Err("has no triangles".into());
    }
    if !SIZES.contains(&model.radius()) {
        let (radius, least, most) = (model.radius(), SIZES.start(), SIZES.end());
        return Err(format!("its farthest vertex is {radius} from the origin, allowed {least} to {most}"));
    }
    if !has_area(&model) {
        return Err("none of its triangles has an area".into());
    }
    model.fault().map_or(Ok(model), |fault| Err(fault.into()))
}

/// Whether any triangle has an area.
fn has_area(model: &Model) -> bool {
    let corner = |index: u32| DVec3::from(model.vertices[index as usize].position.map(f64::from));
    model.triangles.iter().any(|triangle| {
        let [a, b, c] = triangle.map(corner);
        (b - a).cross(c - a).length_squared() > 0.0
    })
}

/// The file of a model: of this name under `assets/models/`, else the one at this path.
pub fn model_file(name: &str) -> GameFile {
    let known = game_files::find(&format!("assets/models/{name}"));
    let path = Path::new(name);
    if known.is_there() || !path.exists() { known } else { GameFile::at(path) }
}

/// Reads a model by its name under `assets/models/` (or its path); on failure a placeholder and the reason.
pub fn load_or_placeholder(name: &str) -> (Model, Option<ModelError>) {
    match read_model(&model_file(name)) {
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

/// Adds the triangles of a primitive that has been checked.
fn append(model: &mut Model, primitive: &gltf::Primitive<'_>, buffers: &[Vec<u8>], place: Mat4, material: u32) -> Result<(), String> {
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
    let positions = reader.read_positions().ok_or("has no positions")?;
    let positions: Vec<Vec3> = positions.map(|position| place.transform_point3(Vec3::from(position))).collect();
    let most = *SIZES.end();
    let is_far = |position: &Vec3| position.to_array().iter().any(|x| x.is_nan() || x.abs() > most);
    if let Some((k, far)) = positions.iter().enumerate().find(|(_, position)| is_far(position)) {
        return Err(format!("vertex {k} is at {far}, allowed are coordinates from -{most} to {most}"));
    }
    let turn = Mat3::from_mat4(place).inverse().transpose();
    // A mirrored node turns its triangles inside out.
    let mirrored = place.determinant() < 0.0;
    let uvs: Vec<Vec2> = reader.read_tex_coords(0).map(|uvs| uvs.into_f32().map(Vec2::from).collect()).unwrap_or_default();
    let mut triangles: Vec<[u32; 3]> = match reader.read_indices() {
        Some(indices) => indices.into_u32().collect::<Vec<u32>>().chunks_exact(3).map(|three| [three[0], three[1], three[2]]).collect(),
        None => (0..positions.len() as u32 / 3).map(|first| [3 * first, 3 * first + 1, 3 * first + 2]).collect(),
    };
    if let Some(index) = triangles.iter().flatten().find(|index| **index as usize >= positions.len()) {
        return Err(format!("index {index} points past its {} vertices", positions.len()));
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
    Ok(())
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

fn read_materials(file: &mut GltfFile) -> Result<Vec<Material>, String> {
    // Only images that are drawn are read.
    let chosen: Vec<Option<usize>> = file.document.materials().map(|material| image_of(&material)).collect();
    let mut images: HashMap<usize, Arc<Image>> = HashMap::new();
    let mut left = MOST_IMAGE_BYTES;
    for index in chosen.iter().flatten() {
        if !images.contains_key(index) {
            let image = read_image(file, *index, left).map_err(|wrong| format!("images[{index}]{wrong}"))?;
            left -= image.rgba.len() as u64;
            images.insert(*index, Arc::new(image));
        }
    }
    let one = |(material, image): (gltf::Material<'_>, &Option<usize>)| {
        read_material(&material, image.and_then(|index| images.get(&index).cloned()))
    };
    file.document.materials().zip(&chosen).map(one).collect()
}

/// The number of the image that a material shows.
fn image_of(material: &gltf::Material<'_>) -> Option<usize> {
    let texture = material.pbr_metallic_roughness().base_color_texture().or_else(|| material.emissive_texture());
    texture.map(|texture| texture.texture().source().index())
}

fn read_material(material: &gltf::Material<'_>, texture: Option<Arc<Image>>) -> Result<Material, String> {
    let surface = material.pbr_metallic_roughness();
    let (factor, strength) = (material.emissive_factor(), material.emissive_strength().unwrap_or(1.0));
    let emissive = factor.map(|channel| channel * strength);
    if !emissive.iter().all(|light| (0.0..=MOST_EMISSION).contains(light)) {
        let place = material.index().map_or_else(String::new, |index| format!("materials[{index}]"));
        return Err(format!("{place}: emissiveFactor {factor:?} times a strength of {strength}, allowed 0 to {MOST_EMISSION}"));
    }
    Ok(Material {
        base_colour: Vec4::from(surface.base_color_factor()).clamp(Vec4::ZERO, Vec4::ONE).to_array(),
        emissive,
        temperature: 0.0,
        metallic: surface.metallic_factor().clamp(0.0, 1.0),
        roughness: surface.roughness_factor().clamp(0.0, 1.0),
        drive: material.name() == Some(DRIVE),
        texture,
    })
}

/// An image as 8-bit RGBA, of at most `left` bytes.
fn read_image(file: &mut GltfFile, index: usize, left: u64) -> Result<Image, String> {
    // Not asked of the reader, which takes one of the two and a kind to be there.
    let told = file.document.as_json().images.get(index).map(|image| (image.uri.clone(), image.buffer_view));
    let (uri, view) = told.unwrap_or_default();
    let bytes = match uri {
        Some(uri) => file.fetch(&uri).map_err(|wrong| format!(".uri = {:?}: {wrong}", short(&uri)))?,
        None => {
            let view = view.ok_or(" has neither a uri nor a bufferView")?;
            let view = file.document.views().nth(view.value());
            view.and_then(|view| file.view(&view)).ok_or(" is not in its buffer")?.to_vec()
        }
    };
    let format = image::guess_format(&bytes).ok().filter(|format| matches!(format, ImageFormat::Png | ImageFormat::Jpeg));
    let format = format.ok_or(" is neither PNG nor JPEG")?;
    let failed = |error: image::ImageError| format!(": {}", short(&error.to_string()));
    let reader = || ImageReader::with_format(Cursor::new(&bytes), format);
    let (width, height) = reader().into_dimensions().map_err(failed)?;
    if width.max(height) > MOST_PIXELS {
        return Err(format!(": {width} × {height} pixels, allowed {MOST_PIXELS} along a side"));
    }
    if 4 * u64::from(width) * u64::from(height) > left {
        return Err(format!(": {width} × {height} pixels are too many, allowed are {MOST_IMAGE_BYTES} bytes in all images"));
    }
    let mut reader = reader();
    let mut limits = Limits::default();
    limits.max_alloc = Some(MOST_IMAGE_BYTES);
    reader.limits(limits);
    let picture = reader.decode().map_err(failed)?.into_rgba8();
    Ok(Image { width: picture.width(), height: picture.height(), rgba: picture.into_raw() })
}
