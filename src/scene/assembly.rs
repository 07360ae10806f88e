//! A scene's objects with their models: what a renderer uploads and a tracer builds its tree from.

use std::collections::HashMap;

use glam::{DQuat, DVec3};

use super::config::GameConfig;
use super::load::Scene;
use super::model::import::load_or_placeholder;
use super::model::{Model, SHIP_MODELS};
use super::prop::Shape;
use super::ship::{Ai, ShipSpec};

/// The models of a scene and where each is used.
#[derive(Debug, Clone, Default)]
pub struct Assembly {
    /// Distinct models, in units of their own.
    pub models: Vec<Model>,
    /// Every visible thing: ships first, in the scene's order, then props, then the planet.
    pub objects: Vec<Object>,
    /// What was wrong with a model; a placeholder stands in its place.
    pub warnings: Vec<String>,
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
    /// Held in place: the vertex v of the model is at position + attitude·(scale·v), whatever T. At rest in Schwarzschild's coordinates.
    Held {
        /// In r_s.
        position: DVec3,
        /// Model axes to coordinate axes.
        attitude: DQuat,
    },
    /// The ship with this index in [`Scene::ships`]: the vertex v is at scale·v in the ship's rest frame and body axes.
    Ship(usize),
    /// The scene's planet, in its rest frame and the axes of [`super::planet::Planet::state`].
    Planet,
}

impl Scene {
    /// Makes the scene's models and lists its objects. Never fails: what cannot be read becomes a placeholder with a warning.
    pub fn assemble(&self, config: &GameConfig) -> Assembly {
        let mut assembly = Assembly::default();
        let mut files: HashMap<String, usize> = HashMap::new();
        for (index, ship) in self.ships.iter().enumerate() {
            let model = assembly.file(&mut files, ship.model.as_deref().unwrap_or(default_model(ship)));
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
                let body = Body::Held { position, attitude: prop.attitude };
                assembly.objects.push(Object { name: prop.name.clone(), model, scale: prop.size, body });
            }
        }
        if let Some(planet) = &self.planet {
            assembly.models.push(planet.model());
            let model = assembly.models.len() - 1;
            assembly.objects.push(Object { name: "planet".into(), model, scale: 2.0 * planet.radius, body: Body::Planet });
        }
        assembly
    }
}

/// The quarry's model for a ship that flees, the hunter's for every other.
fn default_model(ship: &ShipSpec) -> &'static str {
    let [hunter, quarry] = SHIP_MODELS;
    if ship.ai == Ai::Flee { quarry } else { hunter }
}

impl Assembly {
    fn file(&mut self, files: &mut HashMap<String, usize>, name: &str) -> usize {
        *files.entry(name.to_owned()).or_insert_with(|| {
            let (model, error) = load_or_placeholder(name);
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
