//! `[[prop]]` in a scene file: things held in place, at rest in Schwarzschild's coordinates (x fixed while T runs).
//!
//! ```toml
//! [[prop]]
//! name = "target"
//! model = "sphere"               # "sphere", "icosphere", "square", "lattice" or a .glb file under assets/models/
//! position = [0.0, 0.0, -12.0]   # r_s; outside r = 1, where alone a thing can be held
//! attitude = [1.0, 0.0, 0.0, 0.0] # w, x, y, z: model axes to coordinate axes
//! size = 4.0                     # r_s: diameter of a sphere, edge of a square, length of the model's unit
//! triangles = 1200               # of the whole sphere or square; of one sphere of a lattice
//! anchor = "centre"              # "square" only: "centre", or the point of the grid at position: "inside" a triangle, "edge", "vertex"
//! texture = "checker"            # or "galaxy"; none if absent
//! colour = [0.8, 0.8, 0.8]       # linear, multiplied by the texture; black is no surface and mirrors nothing
//! emissive = [0.0, 0.0, 0.0]     # light given off (times the texture)
//! temperature = 0.0              # K: glows as a black body besides, in the unit of the disk's light; 0 does not
//! count = [14, 14, 14]           # "lattice" only: spheres along x, y, z, centred on position
//! spacing = 2.0                  # "lattice" only: r_s between neighbours
//! clearance = 1.2                # "lattice" only: spheres that come nearer to the hole than this are left out, r_s
//! ```

use std::ops::RangeInclusive;

use glam::{DQuat, DVec3};
use serde::Deserialize;
use toml::Spanned;

use super::document::exactly_or_none;
use super::document::fault::{Fault, fault, in_range};
use super::model::shapes::{self, Anchor};
use super::model::texture;
use super::model::{Material, Model};

/// The most spheres in all lattices of a scene, those too near to the hole included.
const MAX_LATTICE: u64 = 200_000;
/// Most triangles of one shape, and of all shapes of a scene: what the smallest buffers hold that a graphics adapter must offer (128 MiB),
/// in three image orders.
const MAX_TRIANGLES_EACH: u32 = super::model::MOST_TRIANGLES as u32;
/// Those of all shapes of a scene.
const MAX_TRIANGLES: u64 = 800_000;

/// Something held in place.
#[derive(Debug, Clone, PartialEq)]
pub struct Prop {
    /// Its name; `prop 3` if the file has none (counted from 0).
    pub name: String,
    /// What it looks like.
    pub shape: Shape,
    /// Where, in r_s; each entry is one copy (one for all but a lattice).
    pub positions: Vec<DVec3>,
    /// Model axes to coordinate axes.
    pub attitude: DQuat,
    /// Length of the model's unit, in r_s.
    pub size: f64,
    /// Surface of a procedural shape, without its texture.
    pub material: Material,
    /// What is painted on it: made when the model is, since a scene that is only listed needs no picture.
    texture: Option<TextureName>,
}

/// What a prop looks like.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A sphere of meridians and parallels, of about so many triangles.
    Sphere(u32),
    /// A subdivided icosahedron, of at least so many triangles.
    Icosphere(u32),
    /// A square grid.
    Square(u32, Anchor),
    /// A glTF file, relative to `assets/models/` unless it exists as given.
    File(String),
}

impl Prop {
    /// The model of a procedural shape, `None` for a file.
    pub fn model(&self) -> Option<Model> {
        let texture = self.texture.map(|name| match name {
            TextureName::Checker => texture::checker(),
            TextureName::Galaxy => texture::galaxy(),
        });
        let material = Material { texture, ..self.material.clone() };
        match self.shape {
            Shape::Sphere(triangles) => Some(shapes::uv_sphere(triangles, material)),
            Shape::Icosphere(triangles) => Some(shapes::icosphere(triangles, material)),
            Shape::Square(triangles, anchor) => Some(shapes::square(triangles, anchor, material)),
            Shape::File(_) => None,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum TextureName {
    Checker,
    Galaxy,
}

/// `[[prop]]` as the file has it, before any check.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PropEntry {
    name: Option<String>,
    model: Spanned<String>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    position: Option<Spanned<[f64; 3]>>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    attitude: Option<Spanned<[f64; 4]>>,
    size: Option<Spanned<f64>>,
    triangles: Option<Spanned<u32>>,
    anchor: Option<Spanned<Anchor>>,
    texture: Option<TextureName>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    colour: Option<Spanned<[f64; 3]>>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    emissive: Option<Spanned<[f64; 3]>>,
    temperature: Option<Spanned<f64>>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    count: Option<Spanned<[u32; 3]>>,
    spacing: Option<Spanned<f64>>,
    clearance: Option<Spanned<f64>>,
}

impl PropEntry {
    /// The file of its model, and where it is named; none of a shape.
    pub(super) fn file(&self) -> Option<&Spanned<String>> {
        Some(&self.model).filter(|model| is_file(model.get_ref()))
    }
}

/// Checks all props of a scene.
pub fn check_props(entries: &[Spanned<PropEntry>]) -> Result<Vec<Prop>, Fault> {
    let mut props = Vec::with_capacity(entries.len());
    // Summed up as they come: together they may be more than memory holds.
    let (mut total, mut spheres) = (0, 0);
    for (index, entry) in entries.iter().enumerate() {
        let prop = check_prop(index, entry.get_ref(), &mut spheres)?;
        let each = match &prop.shape {
            Shape::Sphere(each) | Shape::Square(each, _) => *each,
            Shape::Icosphere(each) => shapes::icosphere_triangles(*each),
            Shape::File(_) => 0,
        };
        total += u64::from(each) * prop.positions.len() as u64;
        if total > MAX_TRIANGLES {
            let message = format!("up to here the scene has {total} triangles, allowed {MAX_TRIANGLES}: lower triangles or count");
            return Err(Fault { span: entry.get_ref().triangles.as_ref().map_or(entry.span(), Spanned::span), message });
        }
        props.push(prop);
    }
    Ok(props)
}

/// `spheres`: how many all lattices before it have, and then it too.
fn check_prop(index: usize, entry: &PropEntry, spheres: &mut u64) -> Result<Prop, Fault> {
    let shape = shape(entry)?;
    let size = number(&entry.size, "size", 1e-4..=1e4, "r_s", 1.0)?;
    let attitude = attitude(entry)?;
    let material = material(entry)?;
    Ok(Prop {
        name: entry.name.clone().unwrap_or_else(|| format!("prop {index}")),
        shape,
        positions: positions(entry, size, spheres)?,
        attitude,
        size,
        material,
        texture: entry.texture,
    })
}

/// A number inside `range`, or the default where the key is absent.
fn number(value: &Option<Spanned<f64>>, key: &str, range: RangeInclusive<f64>, unit: &str, default: f64) -> Result<f64, Fault> {
    value.as_ref().map_or(Ok(default), |value| in_range(value, key, range, unit))
}

/// Whether the name of a model is that of a file.
fn is_file(model: &str) -> bool {
    model.ends_with(".glb") || model.ends_with(".gltf")
}

fn shape(entry: &PropEntry) -> Result<Shape, Fault> {
    let triangles = match &entry.triangles {
        Some(count) if !(2..=MAX_TRIANGLES_EACH).contains(count.get_ref()) => {
            return fault(count, format!("triangles = {} must be from 2 to {MAX_TRIANGLES_EACH}", count.get_ref()));
        }
        Some(count) => Some(*count.get_ref()),
        None => None,
    };
    let model = entry.model.get_ref().as_str();
    let shape = match model {
        "sphere" => Shape::Sphere(triangles.unwrap_or(480)),
        "icosphere" => Shape::Icosphere(triangles.unwrap_or(320)),
        "lattice" => Shape::Icosphere(triangles.unwrap_or(20)),
        "square" => Shape::Square(triangles.unwrap_or(200), entry.anchor.as_ref().map(|anchor| *anchor.get_ref()).unwrap_or_default()),
        file if is_file(file) => Shape::File(file.to_owned()),
        _ => {
            return fault(
                &entry.model,
                format!("model = {model:?} must be \"sphere\", \"icosphere\", \"square\", \"lattice\" or a .glb file"),
            );
        }
    };
    match &entry.anchor {
        Some(anchor) if model != "square" => fault(anchor, "anchor goes with model = \"square\" only".into()),
        _ => Ok(shape),
    }
}

fn attitude(entry: &PropEntry) -> Result<DQuat, Fault> {
    let Some(written) = &entry.attitude else { return Ok(DQuat::IDENTITY) };
    let [w, x, y, z] = *written.get_ref();
    let attitude = DQuat::from_xyzw(x, y, z, w);
    if !(1e-6..1e6).contains(&attitude.length()) {
        return fault(written, "attitude must be a quaternion [w, x, y, z] of finite length, not zero".into());
    }
    Ok(attitude.normalize())
}

fn material(entry: &PropEntry) -> Result<Material, Fault> {
    let [r, g, b] = colour(&entry.colour, "colour", 1.0, [0.8; 3])?;
    // What only shines is a light and no surface: it mirrors nothing. In glTF's model a black metal without gloss is that.
    let surface = if [r, g, b] == [0.0; 3] { (1.0, 1.0) } else { (Material::default().metallic, Material::default().roughness) };
    Ok(Material {
        base_colour: [r, g, b, 1.0],
        metallic: surface.0,
        roughness: surface.1,
        emissive: colour(&entry.emissive, "emissive", 1e6, [0.0; 3])?,
        temperature: number(&entry.temperature, "temperature", 0.0..=1e9, "K", 0.0)? as f32,
        drive: false,
        texture: None,
    })
}

/// Centres of the prop, in r_s: one, or those of a lattice.
fn positions(entry: &PropEntry, size: f64, spheres: &mut u64) -> Result<Vec<DVec3>, Fault> {
    let centre = DVec3::from_array(entry.position.as_ref().map_or([0.0; 3], |position| *position.get_ref()));
    let is_lattice = entry.model.get_ref() == "lattice";
    let radius = centre.length();
    let nearest = if is_lattice { 0.0 } else { 1.001 };
    if !(nearest..=1e4).contains(&radius) {
        let message = format!("position is {radius} r_s from the hole, allowed {nearest} to 10000 r_s: inside r = 1 nothing can be held");
        return match &entry.position {
            Some(position) => fault(position, message),
            None => fault(&entry.model, message),
        };
    }
    if is_lattice {
        return lattice(entry, centre, size, spheres);
    }
    let count = entry.count.as_ref().map(Spanned::span);
    let misplaced = [count, entry.spacing.as_ref().map(Spanned::span), entry.clearance.as_ref().map(Spanned::span)];
    match misplaced.into_iter().flatten().next() {
        Some(span) => Err(Fault { span, message: "count, spacing and clearance go with model = \"lattice\" only".into() }),
        None => Ok(vec![centre]),
    }
}

/// Centres of the spheres of a lattice about `centre`; those too near to the hole are left out.
fn lattice(entry: &PropEntry, centre: DVec3, size: f64, spheres: &mut u64) -> Result<Vec<DVec3>, Fault> {
    let Some(written) = &entry.count else {
        return fault(&entry.model, "a lattice needs count = [nx, ny, nz]".into());
    };
    let count = *written.get_ref();
    let total: u64 = count.iter().map(|&n| u64::from(n).min(MAX_LATTICE + 1)).fold(1, u64::saturating_mul);
    if !(1..=MAX_LATTICE).contains(&total) {
        return fault(written, format!("count makes {total} spheres, allowed 1 to {MAX_LATTICE}"));
    }
    *spheres += total;
    if *spheres > MAX_LATTICE {
        return fault(written, format!("count: up to here all lattices have {spheres} spheres, allowed {MAX_LATTICE}"));
    }
    let spacing = number(&entry.spacing, "spacing", 1e-3..=1e3, "r_s", 2.0)?;
    let clearance = number(&entry.clearance, "clearance", 1.0..=1e4, "r_s", 1.2)?;
    let along = |index: u32, axis: usize| (f64::from(index) - 0.5 * f64::from(count[axis] - 1)) * spacing;
    let mut positions = Vec::with_capacity(total as usize);
    for x in 0..count[0] {
        for y in 0..count[1] {
            for z in 0..count[2] {
                let position = centre + DVec3::new(along(x, 0), along(y, 1), along(z, 2));
                if position.length() - 0.5 * size >= clearance {
                    positions.push(position);
                }
            }
        }
    }
    Ok(positions)
}

fn colour(value: &Option<Spanned<[f64; 3]>>, key: &str, most: f64, default: [f32; 3]) -> Result<[f32; 3], Fault> {
    match value {
        None => Ok(default),
        Some(colour) if colour.get_ref().iter().all(|channel| (0.0..=most).contains(channel)) => {
            Ok(colour.get_ref().map(|channel| channel as f32))
        }
        Some(colour) => fault(colour, format!("{key} = {:?} must be three numbers from 0 to {most}", colour.get_ref())),
    }
}
