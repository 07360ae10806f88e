//! A part of the trailer, played: its ships' worldlines, what was heard, and its cameras.

use std::path::PathBuf;

use bevy::prelude::{App, FixedUpdate};
use glam::{DQuat, DVec3};

use crate::play::camera::director::{Cast, Director};
use crate::play::camera::state_of;
use crate::play::session::Session;
use crate::play::sound::heard::Heard;
use crate::play::sound::record::Recorder;
use crate::play::trailer::plan::{Camera, Part, Place, TrailerMoment};
use crate::render::stage::{Stage, static_camera};
use crate::scene::{self, Difficulty, GameConfig, SceneError};
use crate::sim::bolts::Bolts;
use crate::sim::replay::{Replay, ReplayError};
use crate::sim::{Clock, Fleet, History, app_of};
use crate::spacetime::frames;
use crate::spacetime::matter::ShipState;
use crate::spacetime::{Observer, matter};

/// Why a part cannot be played.
#[derive(Debug, thiserror::Error)]
pub enum TakeError {
    /// Its scene is wrong or not there.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Its flight is.
    #[error(transparent)]
    Replay(#[from] ReplayError),
}

/// A part that is played.
pub struct Take {
    part: Part,
    /// The scene, and the settings of its flight; by its rules, not by the player's `game.toml`: the trailer is the same everywhere.
    pub session: Session,
    app: App,
    moments: Vec<Heard>,
    /// Length of a step, in r_s/c: the first of the moments is after the first step.
    step: f64,
    nobody: History,
    director: Director,
}

impl Take {
    /// Plays a part up to its last T.
    pub fn play(part: &Part) -> Result<Take, TakeError> {
        let config = GameConfig::default();
        let session = |scene, config, seed, difficulty| Session {
            scene,
            config,
            config_file: None,
            seed,
            seed_stays: true,
            difficulty,
            set: Vec::new(),
        };
        let (session, mut app) = match part.place {
            Place::Scene(name) => {
                let scene = scene::load(name)?;
                let app = app_of(&scene, &config, 0);
                (session(scene, config, 0, Difficulty::default()), app)
            }
            Place::Flight(mission) => {
                let file = PathBuf::from(format!("{mission}-expert"));
                let replay = Replay::load(&file)?;
                let scene = replay.scene(&file, None)?;
                let app = replay.app(&scene, &config);
                (session(scene, replay.config(&config), replay.seed, replay.difficulty), app)
            }
        };
        let step = app.world().resource::<Clock>().step;
        let mut recorder = (!session.scene.ships.is_empty()).then(|| Recorder::new(&session));
        for _ in 0..(part.span[1] / step).ceil().max(0.0) as u64 {
            app.world_mut().run_schedule(FixedUpdate);
            if let Some(recorder) = &mut recorder {
                recorder.listen(app.world());
            }
        }
        let moments = recorder.map_or(Vec::new(), |recorder| recorder.since(0.0).0);
        Ok(Take { part: *part, session, app, moments, step, nobody: History::nobody(), director: Director::default() })
    }

    /// What is heard at T = `time` (r_s/c); music alone where no ship flies.
    pub fn heard(&self, time: f64) -> Heard {
        let index = ((time / self.step).round() as usize).saturating_sub(1);
        self.moments.get(index.min(self.moments.len().saturating_sub(1))).copied().unwrap_or(Heard::MUSIC)
    }

    /// The worldlines as a stage takes them.
    pub fn histories(&self) -> Vec<&History> {
        let world = self.app.world();
        let mut histories = self.ships();
        // No ghost flies along; bolts come after it.
        histories.push(&self.nobody);
        histories.extend(world.resource::<Bolts>().0.iter().map(|bolt| &bolt.history));
        histories
    }

    /// The worldlines of the ships, in scene order.
    fn ships(&self) -> Vec<&History> {
        let world = self.app.world();
        world.resource::<Fleet>().0.iter().filter_map(|&ship| world.get::<History>(ship)).collect()
    }

    /// The camera at a moment, and the ship that is not drawn.
    pub fn camera(&mut self, stage: &Stage, moment: &TrailerMoment) -> (Observer, Option<usize>) {
        let wide = if self.part.fov > 0.0 { self.part.fov } else { self.session.config.video.fov };
        let (field_of_view, share, time) = (wide.to_radians(), moment.share, moment.time);
        match self.part.camera {
            Camera::Own => (self.own(stage, time), None),
            Camera::Director(shot) => {
                let mut director = std::mem::take(&mut self.director);
                let seen = self.cast().map(|cast| director.shoot(shot, &cast, time, share, field_of_view));
                self.director = director;
                seen.unwrap_or_else(|| (self.own(stage, time), None))
            }
            Camera::Hover(from, to) => {
                let place = between(from, to, share);
                (static_camera(place, -place, DVec3::Z, field_of_view), None)
            }
            Camera::Planet(from, to, at) => {
                let Some(state) = self.session.scene.planet.and_then(|planet| planet.state(time)) else {
                    return (self.own(stage, time), None);
                };
                (beside_planet(&state, between(from, to, share), DVec3::from_array(at), field_of_view), None)
            }
        }
    }

    /// The scene's own camera.
    fn own(&self, stage: &Stage, time: f64) -> Observer {
        let ships: Vec<(&str, ShipState)> = self
            .session
            .scene
            .ships
            .iter()
            .zip(self.ships())
            .map(|(ship, history)| (ship.name.as_str(), state_of(&history.at(time))))
            .collect();
        let mut camera = stage.camera(time, &ships);
        if self.part.fov > 0.0 {
            camera.field_of_view = self.part.fov.to_radians();
        }
        camera
    }

    /// The ships that the director follows.
    fn cast(&self) -> Option<Cast<'_>> {
        let ships = self.ships();
        let of = |ship: usize| ships.get(ship).map(|&history| (history, self.session.length(ship)));
        let hunter = self.session.player();
        Some(Cast { hunter: of(hunter)?, quarry: self.session.target().and_then(of), hunter_index: hunter })
    }
}

/// From the first place to the second, evenly: fades hide the beginning and the end.
fn between(from: [f64; 3], to: [f64; 3], share: f64) -> DVec3 {
    DVec3::from_array(from).lerp(DVec3::from_array(to), share)
}

/// A camera that flies with a planet at `place` beside its middle, and looks at `at`: both outwards from the hole, along the orbit and
/// up, in r_s.
fn beside_planet(planet: &ShipState, place: DVec3, at: DVec3, field_of_view: f64) -> Observer {
    let outward = planet.position.normalize_or(DVec3::X);
    let velocity = matter::velocity(planet);
    let along = (velocity - outward * velocity.dot(outward)).normalize_or(DVec3::Y);
    let up = outward.cross(along);
    let axes = |v: DVec3| outward * v.x + along * v.y + up * v.z;
    let attitude = frames::look(axes(at - place), up).unwrap_or(DQuat::IDENTITY);
    Observer { position: planet.position + axes(place), momentum: planet.momentum, attitude, field_of_view }
}
