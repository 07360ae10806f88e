//! A scene's objects with their models: what a renderer uploads and a tracer builds its tree from.

use std::collections::HashMap;

use glam::{DQuat, DVec3};

use super::config::GameConfig;
use super::load::Scene;
use super::model::import::{load_or_placeholder, placeholder};
use super::model::{Material, Model, SHIP_MODELS, shapes};
use super::prop::Shape;
use super::ship::{Ai, ShipSpec};

/// The models of a scene and where each is used.
#[derive(Debug, Clone, Default)]
pub struct Assembly {
    /// Distinct models, in units of their own.
    pub models: Vec<Model>,
    /// Every visible thing: ships first, in the scene's order, then props, the planet, a mission's gates, and room for bolts.
    pub objects: Vec<Object>,
    /// What was wrong with a model; a placeholder stands in its place.
    pub warnings: Vec<String>,
    /// Those that the models from files take.
    bytes: usize,
}

/// One visible thing.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// The name of the ship or prop; copies in a lattice share it.
    pub name: String,
    /// Index into [`Assembly::models`].
    pub model: usize,
    /// Length of the model's unit, in r_s.
    pub scale: f64,
    /// How it moves.
    pub body: Body,
}

/// How a thing moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Body {
    /// Static: the vertex v of the model is at position + attitude·(scale·v), whatever T. At rest in Schwarzschild's coordinates.
    Static {
        /// In r_s.
        position: DVec3,
        /// Model axes to coordinate axes.
        attitude: DQuat,
    },
    /// The ship with this index in [`Scene::ships`]: the vertex v is at scale·v in the ship's rest frame and body axes.
    Ship(usize),
    /// The scene's planet, in its rest frame and the axes of [`super::planet::Planet::state`].
    Planet,
    /// The ship of an earlier flight that flies along, if there is one.
    Ghost,
    /// The bolt with this number among those that are kept, if there is one.
    Bolt(usize),
}

/// The most bytes that all models from files take; one alone may take half of it.
const MOST_BYTES: usize = 1 << 30;
/// Bolts that are kept, flying or seen by their light.
pub const MOST_BOLTS: usize = 24;
/// Diameter of a bolt, in r_s.
const BOLT_SIZE: f64 = 0.07;
/// Light of a bolt, of 1 for a white surface in full light: one that flies away at 0.8 c is beamed down to 1/81 of it
/// and reddened.
const BOLT_LIGHT: [f32; 3] = [300.0, 450.0, 900.0];
/// Light of a gate.
const GATE_LIGHT: [f32; 3] = [0.25, 2.4, 1.6];
/// Light of a ghost.
const GHOST_LIGHT: [f32; 3] = [0.02, 0.05, 0.09];
/// Diameter of a gate's tube over that of the gate.
const GATE_THICKNESS: f64 = 0.035;

impl Scene {
    /// Makes the scene's models and lists its objects. Never fails: what cannot be read becomes a placeholder with a warning.
    pub fn assemble(&self, config: &GameConfig) -> Assembly {
        let mut assembly = Assembly::default();
        let mut files: HashMap<String, usize> = HashMap::new();
        for (index, ship) in self.ships.iter().enumerate() {
            let model = assembly.file(&mut files, model_of(ship));
            let scale = if ship.ai == Ai::Flee { config.enemy.size } else { config.ship.size };
            assembly.objects.push(Object { name: ship.name.clone(), model, scale, body: Body::Ship(index) });
        }
        for prop in &self.props {
            let model = match &prop.shape {
                Shape::File(file) => assembly.file(&mut files, file),
                _ => {
                    assembly.models.extend(prop.model());
                    assembly.models.len() - 1
                }
            };
            for &position in &prop.positions {
                let body = Body::Static { position, attitude: prop.attitude };
                assembly.objects.push(Object { name: prop.name.clone(), model, scale: prop.size, body });
            }
        }
        if let Some(planet) = &self.planet {
            assembly.models.push(planet.model());
            let model = assembly.models.len() - 1;
            assembly.objects.push(Object { name: "planet".into(), model, scale: 2.0 * planet.radius, body: Body::Planet });
        }
        self.assemble_mission(config, &mut assembly);
        assembly
    }

    /// The model files that the scene is made of, each once, as the scene names them.
    pub fn model_files(&self) -> Vec<String> {
        let ships = self.ships.iter().map(model_of);
        let props = self.props.iter().filter_map(|prop| if let Shape::File(file) = &prop.shape { Some(file.as_str()) } else { None });
        let mut files: Vec<String> = ships.chain(props).map(String::from).collect();
        files.sort();
        files.dedup();
        files
    }

    /// Adds a mission's gates and bolts.
    fn assemble_mission(&self, config: &GameConfig, assembly: &mut Assembly) {
        let Some(mission) = &self.mission else { return };
        if !mission.gates.is_empty() {
            let model = assembly.add(shapes::torus(48, 8, GATE_THICKNESS, glowing(GATE_LIGHT)));
            for (number, gate) in mission.gates.iter().enumerate() {
                let body = Body::Static { position: gate.position, attitude: DQuat::from_rotation_arc(DVec3::Z, gate.normal) };
                assembly.objects.push(Object { name: format!("gate {}", number + 1), model, scale: 2.0 * gate.radius, body });
            }
        }
        if let Some(own) = self.ships.iter().find(|ship| ship.player) {
            let mut files = HashMap::new();
            let solid = assembly.file(&mut files, model_of(own));
            // A file of its own in the list, as it shines otherwise.
            let ghost = ghostly(&assembly.models[solid]);
            assembly.models[solid] = ghost;
            assembly.objects.push(Object { name: "ghost".into(), model: solid, scale: config.ship.size, body: Body::Ghost });
        }
        if config.ship.bolts > 0 {
            let model = assembly.add(shapes::icosphere(80, glowing(BOLT_LIGHT)));
            let bolt = |number| Object { name: format!("bolt {number}"), model, scale: BOLT_SIZE, body: Body::Bolt(number) };
            assembly.objects.extend((0..MOST_BOLTS).map(bolt));
        }
    }
}

/// A ship that shines by itself, faintly, and mirrors little: not to be taken for a real one.
fn ghostly(model: &Model) -> Model {
    let mut model = model.clone();
    for material in &mut model.materials {
        let [r, g, b, a] = material.base_colour;
        *material = Material { base_colour: [0.2 * r, 0.2 * g, 0.2 * b, a], emissive: GHOST_LIGHT, drive: false, ..material.clone() };
    }
    model
}

/// What only shines.
fn glowing(emissive: [f32; 3]) -> Material {
    Material { base_colour: [0.0, 0.0, 0.0, 1.0], metallic: 1.0, roughness: 1.0, emissive, ..Material::default() }
}

/// The name of a ship's model: its own, else the quarry's for a ship that flees and the hunter's for every other.
pub fn model_of(ship: &ShipSpec) -> &str {
    let [hunter, quarry] = SHIP_MODELS;
    ship.model.as_deref().unwrap_or(if ship.ai == Ai::Flee { quarry } else { hunter })
}

impl Assembly {
    fn add(&mut self, model: Model) -> usize {
        self.models.push(model);
        self.models.len() - 1
    }

    fn file(&mut self, files: &mut HashMap<String, usize>, name: &str) -> usize {
        *files.entry(name.to_owned()).or_insert_with(|| {
            let (mut model, error) = load_or_placeholder(name);
            let all = self.bytes + model.bytes();
            if all > MOST_BYTES {
                self.warnings.push(format!("model {name}: with it the models of the scene take {all} bytes, allowed {MOST_BYTES}"));
                model = placeholder();
            }
            self.bytes += model.bytes();
            self.warnings.extend(error.map(|error| error.to_string()));
            self.models.push(model);
            self.models.len() - 1
        })
    }

    /// Triangles of all objects together.
    pub fn triangles(&self) -> usize {
        self.objects.iter().map(|object| self.models[object.model].triangles.len()).sum()
    }
}
