//! A scene on the renderer: its models uploaded, and a frame made of its objects at any T.

use crate::spacetime::Observer;
use std::sync::Arc;

use bevy::tasks::block_on;
use glam::{DQuat, DVec3};

use crate::breath::breath;
use crate::lensing::{Slice, Table};
use crate::scene::camera::viewpoint;
use crate::scene::config::AuroraConfig;
use crate::scene::lighting::Lights;
use crate::scene::ship::Ai;
use crate::scene::{self, Assembly, Body, GameConfig, Model, Planet, Scene};
use crate::sim::History;
use crate::spacetime::frames;
use crate::spacetime::matter::ShipState;
use crate::spacetime::orbit::static_momentum;

use crate::lensing::methods::{self, flat};
use crate::render::Renderer;
use crate::render::aurora::{AuroraAnimation, AuroraFrame, PlanetLine};
use crate::render::disk::DrawnDisk;
use crate::render::frame::FrameInput;
use crate::render::gpu::types::placed::OWN;
use crate::render::instances::held::HeldBodies;
use crate::render::instances::{DrawnObject, Illumination, InstanceView, ObjectMotion, Placed, PlacedList, StandIn, place};
use crate::render::models::coarse::stand_ins;
use crate::render::models::{ModelRange, ModelSet};
use crate::render::post_process::upscale::drawn_size;
use crate::render::quality::costs::SceneClass;
use crate::render::renderer::SceneUpload;
use crate::render::settings::Settings;

/// A scene's objects, ready to be placed.
#[derive(Debug)]
pub struct Stage {
    /// All but what is held in place, which the renderer has.
    objects: Vec<StagedObject>,
    /// Whether anything is held in place.
    holds: bool,
    table: Arc<Table>,
    /// The table at the radius of the last frame's camera; None before the first.
    slice: Option<Slice>,
    /// Memory of images that are not shown any more.
    placed: PlacedList,
    camera: scene::SceneCamera,
    sky: (bool, bool, f32),
    lights: Lights,
    /// For each ship of the scene: whether it flees, and its greatest thrust (c²/r_s) if the scene gives it.
    engines: Vec<(bool, Option<f64>)>,
    planet: Option<Planet>,
    /// The planet's worldline.
    globe: PlanetLine,
    /// Inner and outer radius of the disk.
    disk: Option<[f64; 2]>,
    /// What of a stage goes on from frame to frame: the aurora of the planet, if it has one.
    animation: Option<AuroraAnimation>,
}

/// How far a stand-in may be from its model where half a pixel is allowed, in pixels: chords have the rest.
const MOST_MOVED: f64 = 0.25;
/// Images wider than this, in pixels, show the model itself: their outlines are seen, and a quarter of a pixel there is 6 of 160 pixels.
const OUTLINED: f64 = 30.0;

/// A model, its coarsest stand-in, and all of them, the coarsest first, each up to a width in pixels where half a pixel is allowed.
#[derive(Clone, Debug)]
struct LevelsOfDetail {
    model: ModelRange,
    coarse: ModelRange,
    stand_ins: Vec<StandIn>,
}

/// An object, ready to be placed.
#[derive(Clone, Debug)]
struct StagedObject {
    object: scene::Object,
    model: LevelsOfDetail,
    /// Farthest vertex from its centre, in r_s.
    reach: f64,
    /// Its number for the layers of a picture, from 1.
    id: u32,
}

impl StagedObject {
    /// As it moves, under what shines on it.
    fn drawn<'a>(&'a self, motion: ObjectMotion<'a>, light: Illumination) -> DrawnObject<'a> {
        let LevelsOfDetail { model, coarse, stand_ins } = &self.model;
        let (reach, scale, id) = (self.reach, self.object.scale, self.id);
        DrawnObject { model: *model, coarse: *coarse, stand_ins, motion, reach, scale, id, light }
    }
}

impl Stage {
    /// Uploads the models of the scene. Warnings about models are logged.
    pub fn new(renderer: &mut Renderer, scene: &Scene, config: &GameConfig) -> Stage {
        Stage::of(renderer, scene, scene.assemble(config), config, None)
    }

    /// The same with models made elsewhere; `mark` changes each before it is uploaded, those too that stand in for finer ones.
    pub fn of(renderer: &mut Renderer, scene: &Scene, assembly: Assembly, config: &GameConfig, mark: Option<fn(&Model) -> Model>) -> Stage {
        let (stage, upload) = block_on(Stage::prepare(&renderer.table().clone(), scene, assembly, config, mark));
        renderer.upload(&upload);
        stage
    }

    /// The stage, and what is to be uploaded before a frame of it is drawn: for where there is no renderer at hand. As [`of`](Stage::of).
    pub async fn prepare(
        table: &Arc<Table>,
        scene: &Scene,
        assembly: Assembly,
        config: &GameConfig,
        mark: Option<fn(&Model) -> Model>,
    ) -> (Stage, SceneUpload) {
        for warning in &assembly.warnings {
            bevy::log::warn!("{warning}");
        }
        let mut models = ModelSet::default();
        let marked = |model: &Model| mark.map(|mark| mark(model));
        let add = |models: &mut ModelSet, model: &Model| models.add(marked(model).as_ref().unwrap_or(model));
        // A smaller globe needs fewer triangles, but stays round.
        let globe =
            assembly.objects.iter().find(|object| object.body == Body::Planet).map(|object| object.model).zip(scene.planet.as_ref());
        let mut ranges: Vec<LevelsOfDetail> = Vec::new();
        for (number, model) in assembly.models.iter().enumerate() {
            let is_globe = globe.is_some_and(|(of, _)| of == number);
            let coarser = match globe {
                Some((_, planet)) if is_globe => planet.stand_ins(model),
                _ => stand_ins(model).into_iter().map(|coarser| ((MOST_MOVED / coarser.moved).min(OUTLINED), coarser.model)).collect(),
            };
            breath().await;
            models.add_images(marked(model).as_ref().unwrap_or(model));
            breath().await;
            let fine = add(&mut models, model);
            let mut stand_ins: Vec<StandIn> = Vec::new();
            for (below, model) in &coarser {
                breath().await;
                stand_ins.push(StandIn { below: *below, model: add(&mut models, model) });
            }
            ranges.push(LevelsOfDetail { model: fine, coarse: stand_ins.first().map_or(fine, |coarsest| coarsest.model), stand_ins });
            breath().await;
        }
        let radii: Vec<f64> = assembly.models.iter().map(|model| f64::from(model.radius())).collect();
        let lights = Lights::of(scene, config);
        let mut held = HeldBodies::default();
        let mut objects = Vec::new();
        for (id, object) in (1..).zip(assembly.objects) {
            let (model, reach) = (ranges[object.model].clone(), radii[object.model] * object.scale);
            let staged = StagedObject { object, model, reach, id };
            match staged.object.body {
                Body::Static { position, attitude } => {
                    let light = lights.on(&staged.object.body, position);
                    held.add(&staged.drawn(ObjectMotion::Static { position, attitude }, light));
                }
                _ => objects.push(staged),
            }
        }
        let disk = scene.disk(config);
        let holds = !held.bodies().is_empty();
        let upload = SceneUpload { models, held, disk: disk.clone().map(|disk| DrawnDisk::new(disk, config)), rehearsal: Vec::new() };
        let disk = disk.map(|disk| [disk.inner, disk.outer]);
        let stage = Stage {
            objects,
            holds,
            table: table.clone(),
            slice: None,
            placed: PlacedList::default(),
            camera: scene.camera.clone(),
            sky: (scene.sky.stars, scene.sky.milky_way, scene.sky.brightness as f32),
            lights,
            engines: scene.ships.iter().map(|ship| (ship.ai == Ai::Flee && !ship.player, ship.max_thrust)).collect(),
            planet: scene.planet,
            globe: PlanetLine::default(),
            disk,
            animation: scene.planet.as_ref().and_then(|planet| AuroraAnimation::new(planet, disk, &config.aurora)),
        };
        (stage, upload)
    }

    /// Limits the aurora's simulation per frame, for scenes that are watched as they run. Its state then depends on earlier frames.
    pub fn watched(self) -> Stage {
        Stage { animation: self.animation.map(AuroraAnimation::watched), ..self }
    }

    /// Gives the aurora other settings; nothing else is made anew. For a stage in real time.
    pub fn change_aurora(&mut self, config: &AuroraConfig) {
        if self.animation.as_mut().is_none_or(|animation| !animation.change(config)) {
            self.animation =
                self.planet.as_ref().and_then(|planet| AuroraAnimation::new(planet, self.disk, config)).map(AuroraAnimation::watched);
        }
    }

    /// Lets the aurora follow the times (ms) of all passes of an earlier frame: it takes no more than `aurora.share` of them.
    pub fn ration_aurora(&mut self, passes: &[(&str, f32)]) {
        if let Some(animation) = &mut self.animation {
            animation.ration(passes);
        }
    }

    /// Whether that holds its aurora to a share, so that passes must be timed.
    pub fn rations_aurora(&self) -> bool {
        self.animation.as_ref().is_some_and(AuroraAnimation::is_rationed)
    }

    /// What of it takes time.
    pub fn class(&self) -> SceneClass {
        SceneClass::of(self.holds || !self.objects.is_empty(), self.disk.is_some(), self.animation.is_some())
    }

    /// The scene's own camera at T = `time`; `ships` are the states of the ships then, by name.
    pub fn camera(&self, time: f64, ships: &[(&str, ShipState)]) -> Observer {
        self.camera.viewpoint(time, ships)
    }

    /// The greatest thrust of a ship, in c²/r_s; None where nozzles shine as at full thrust anyway.
    fn full_thrust(&self, ship: usize, settings: &Settings) -> Option<f64> {
        let [hunting, fleeing] = settings.engines?;
        let &(flees, said) = self.engines.get(ship)?;
        Some(said.unwrap_or(if flees { fleeing } else { hunting }))
    }

    /// Makes the next frame in the memory of this one, which is not shown any more.
    pub fn reuse(&mut self, frame: FrameInput) {
        self.placed.reuse(frame.placed);
        if let Some((animation, aurora)) = self.animation.as_mut().zip(frame.aurora) {
            animation.reuse(aurora);
        }
    }

    /// A frame seen by `camera` at T = `time`; `histories` are the worldlines of the ships in scene order, then
    /// that of the ghost and those of the bolts. `hidden` is a ship that is not
    /// drawn (the cockpit's own); `size` is that of the picture in pixels.
    pub fn frame(
        &mut self,
        camera: Observer,
        size: [u32; 2],
        time: f64,
        histories: &[&History],
        hidden: Option<usize>,
        settings: &Settings,
    ) -> FrameInput {
        let slice = match self.slice.take() {
            Some(mut slice) => {
                slice.move_to(&self.table, camera.radius());
                slice
            }
            None => Slice::new(&self.table, camera.radius()),
        };
        let size = drawn_size(size, settings.resolution);
        let pixel = 2.0 * (0.5 * camera.field_of_view).tan() / f64::from(size[0].max(1));
        let aspect = Some(f64::from(size[1].max(1)) / f64::from(size[0].max(1)));
        let view = InstanceView { camera: &camera, slice: &slice, pixel, aspect, settings };
        // Light of the higher orders goes once round the hole.
        let back = self.planet.as_ref().map_or(0.0, |planet| 1.5 * (camera.radius() + planet.orbit.semi_latus_rectum) + 60.0);
        let mut line = std::mem::take(&mut self.globe);
        let globe = self.planet.as_ref().and_then(|planet| line.about(planet, time, back));
        let mut list = std::mem::take(&mut self.placed);
        let mut unmetered = [0.0; 3];
        for staged in &self.objects {
            let body = &staged.object.body;
            let ship = match *body {
                Body::Ship(index) => Some(index),
                _ => None,
            };
            if ship.is_some() && ship == hidden {
                continue;
            }
            let Some(line) = self.worldline(body, histories, globe) else { continue };
            let object = staged.drawn(ObjectMotion::Flying(line), self.lights.on(body, line.at(time).position));
            let images = place(&mut list, &view, time, &object, settings.orders);
            if let Some(ship) = ship {
                if let Some(full) = self.full_thrust(ship, settings) {
                    shine(images, histories[ship], time, full);
                }
                if settings.own_ship == Some(ship) {
                    images.iter_mut().for_each(|image| image.instance.flags |= OWN);
                    unmetered = images.first().map_or([0.0; 3], |image| circle(&camera, image, object.reach));
                }
            }
        }
        self.globe = line;
        let aurora = self.aurora(&view, time, back);
        self.slice = Some(slice);
        let placed = std::mem::take(&mut list.placed);
        self.placed = list;
        let held = self.holds.then_some(0);
        FrameInput { camera, time, placed, held, aurora, settings: Settings { unmetered, ..self.with_sky(settings) } }
    }

    /// The worldline of a body that flies; None of any other, or if it is not known.
    fn worldline<'a>(&self, body: &Body, histories: &[&'a History], globe: Option<&'a History>) -> Option<&'a History> {
        match *body {
            Body::Static { .. } => None,
            Body::Ship(index) if index < self.engines.len() => histories.get(index).copied(),
            Body::Ship(_) => None,
            Body::Ghost => histories.get(self.engines.len()).copied(),
            Body::Bolt(number) => histories.get(self.engines.len() + 1 + number).copied(),
            Body::Planet => globe,
        }
    }

    /// The planet's aurora at T = `time`, if it has one and that is seen; light comes from `back` r_s/c before at most.
    fn aurora(&mut self, view: &InstanceView, time: f64, back: f64) -> Option<AuroraFrame> {
        let mut aurora = self.animation.as_mut()?.frame(view, time, back, view.settings.orders)?;
        // Only the planet is lit by it.
        let globe = self.objects.iter().find(|staged| staged.object.body == Body::Planet);
        if let (Some(ground), Some(globe)) = (aurora.ground.as_mut(), globe) {
            ground.light.planet = globe.id;
        }
        Some(aurora)
    }

    /// The settings with what the scene says of its sky.
    fn with_sky(&self, settings: &Settings) -> Settings {
        let (stars, milky_way, brightness) = self.sky;
        Settings {
            stars: settings.stars && stars,
            milky_way: settings.milky_way && milky_way,
            star_brightness: settings.star_brightness * brightness,
            sky_brightness: settings.sky_brightness * brightness,
            ..*settings
        }
    }
}

/// Lets the nozzles in the images of a ship at T = `time` shine by its thrust; `full` (c²/r_s) is all that it has.
fn shine(images: &mut [Placed], history: &History, time: f64, full: f64) {
    for image in images {
        let emitted = time - f64::from(image.instance.delay);
        image.instance.engines_off = (1.0 - glow(history, emitted, full)) as f32;
    }
}

/// Light of nozzles that burn nothing, as a share of that at full thrust.
const IDLE_GLOW: f64 = 1e-3;
/// Time in which nozzles become bright or dark, in r_s/c: a quarter of a second at the usual pace.
const GLOW_SPAN: f64 = 0.375;

/// The light of a ship's nozzles at T = `time`, as a share of that at the thrust `full` (c²/r_s).
fn glow(history: &History, time: f64, full: f64) -> f64 {
    let share = (history.thrust(time, GLOW_SPAN) / full.max(1e-12)).clamp(0.0, 1.0);
    // Steeper than the thrust: in front of a dark sky, with a long exposure, the small thrust of the assist would look like full thrust.
    IDLE_GLOW + (1.0 - IDLE_GLOW) * share * share
}

/// Where a ship of radius `reach` (r_s) is seen, approximately: along straight light through space that falls evenly. Its middle and
/// radius, in widths of the picture. That is exact enough within a few lengths, and farther away ships are small.
fn circle(camera: &Observer, image: &Placed, reach: f64) -> [f32; 3] {
    let delay = f64::from(image.instance.delay);
    // Space falls inwards at √(1/r) and takes the light with it.
    let radius = camera.radius().max(1e-3);
    let offset = DVec3::from_array(image.instance.offset.map(f64::from)) - camera.position / radius * (delay / radius.sqrt());
    let apparent = (camera.camera_from_rain() * offset.extend(-offset.length())).truncate();
    if image.instance.order != 1 || apparent.z >= -1e-3 {
        return [0.0; 3];
    }
    let scale = 0.5 / ((0.5 * camera.field_of_view).tan() * -apparent.z);
    [apparent.x * scale, -apparent.y * scale, reach * scale].map(|share| share as f32)
}

/// Standard deviation of a star's spot over its radius. 0.7 pixels at the default radius is the narrowest Gaussian whose light, sampled at
/// pixel centres, changes by less than 1 % as it moves (its transform at the sampling frequency is e^{−2π²·0.49} = 6e-5).
const SPOT_SIGMA: f64 = 0.7 / 1.1;

/// The settings that `game.toml` asks for.
pub fn settings(config: &GameConfig) -> Settings {
    let render = &config.render;
    Settings {
        pixel_error: render.pixel_error_budget as f32,
        orders: render.orders,
        // The reader of `game.toml` lets only names of methods in.
        method: if render.lensing { methods::named(&render.method).unwrap_or_default() } else { flat::METHOD },
        light_delay: render.light_delay,
        halvings: render.tessellation_max_level,
        vertex_budget: render.vertex_budget,
        min_width: render.min_width as f32,
        thin_below: render.thin_below,
        coarse_below: render.coarse_below,
        least_width: render.least_width,
        doppler: render.doppler,
        beaming: render.beaming,
        star_brightness: config.sky.star_brightness as f32,
        sky_brightness: config.sky.milky_way_brightness as f32,
        bloom: render.bloom as f32,
        smooth: render.antialiasing,
        exposure_key: render.exposure_key as f32,
        star_sigma: (config.sky.star_size * SPOT_SIGMA) as f32,
        faintest_star: 10f64.powf(-0.4 * config.sky.faintest_magnitude) as f32,
        fill: [render.fill_least, render.fill_most].map(|light| light as f32),
        exposure_range: [render.exposure_min, render.exposure_max].map(|stops| stops.exp2() as f32),
        ..Settings::finest()
    }
}

/// A camera beside a ship: at `offset` in the ship's rest frame, moving as the ship does, outside r = 1 as long as the ship is.
pub fn third_person(state: &ShipState, offset: DVec3, view: DQuat, field_of_view: f64) -> Observer {
    viewpoint::beside(state, offset, view, field_of_view)
}

/// A hovering camera, looking along `look` (its own axes); falling with the rain inside r = 1.
pub fn static_camera(position: DVec3, look: DVec3, up: DVec3, field_of_view: f64) -> Observer {
    Observer {
        position,
        momentum: static_momentum(position).unwrap_or(DVec3::ZERO),
        attitude: frames::look(look, up).unwrap_or(DQuat::IDENTITY),
        field_of_view,
    }
}
