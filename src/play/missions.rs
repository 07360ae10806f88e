//! The missions that can be chosen, and what a flight of one leaves behind: its score, its replay, its ghost.

use std::sync::Arc;

use bevy::prelude::*;

use crate::play::hud::notice::Notice;
use crate::play::menus::screens::Screen;
use crate::play::player_state::PlayerState;
use crate::play::records::{Best, Records};
use crate::play::schedule::GameSet;
use crate::play::session::Session;
use crate::scene::mission::{Mission, ScoredBy};
use crate::scene::{self, Scene};
use crate::sim::replay::{Playback, Replay, ReplayLog};
use crate::sim::{Fleet, Fuel, History, ShipMotion, outcome};

/// The missions in the order in which they are shown, and the scene that the game was started with.
#[derive(Resource, Clone, Debug)]
pub struct Catalogue {
    /// Their scenes.
    pub missions: Vec<Scene>,
    /// What is behind the title.
    pub home: Scene,
    /// What is flown freely; the home scene first.
    pub free: Vec<Scene>,
}

impl Catalogue {
    /// Reads `assets/missions` and `assets/scenes`; those that are wrong are left out and said.
    pub fn read(home: Scene) -> (Catalogue, Vec<String>) {
        let (mut missions, mut wrong) = (Vec::new(), Vec::new());
        for name in scene::mission_names() {
            match scene::load(&name) {
                Ok(scene) if scene.mission.is_some() => missions.push(scene),
                Ok(_) => wrong.push(format!("{name}: it is no mission")),
                Err(error) => wrong.push(error.to_string()),
            }
        }
        let mut free = vec![home.clone()];
        for name in scene::names().into_iter().filter(|name| *name != home.name) {
            match scene::load(&name).map(Scene::with_a_ship) {
                Ok(scene) if scene.ships.is_empty() => (),
                Ok(scene) => free.push(scene),
                Err(error) => wrong.push(error.to_string()),
            }
        }
        (Catalogue { missions, home, free }, wrong)
    }

    /// The scene of a choice: a mission, or past the last the one chosen for free flight.
    pub fn scene(&self, choice: usize, free: usize) -> &Scene {
        self.missions.get(choice).or_else(|| self.free.get(free)).unwrap_or(&self.home)
    }

    /// The scene that was flown in a replay.
    pub fn find(&self, replay: &Replay) -> Option<&Scene> {
        self.missions.iter().chain(&self.free).find(|scene| scene.name == replay.scene && scene.fingerprint == replay.fingerprint)
    }

    /// How many choices there are.
    pub fn len(&self) -> usize {
        self.missions.len() + 1
    }

    /// Never: free flight is always there.
    pub fn is_empty(&self) -> bool {
        false
    }
}

/// The replay that is watched instead of flying.
#[derive(Resource, Clone, Debug)]
pub struct Watched(pub Replay);

/// The settings of the player, while a flight is watched that was flown by others: a flight of no step.
#[derive(Resource, Clone, Debug)]
pub struct BeforeWatching(pub Replay);

/// The flight behind the title, which no hands fly.
#[derive(Resource, Clone, Debug)]
pub struct TitleFlight(pub Replay);

/// The best flight so far of the mission that is flown, as a ship among the others.
#[derive(Resource, Clone, Debug)]
pub struct Ghost(pub History);

/// How the last flight came out.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct LastFlight {
    /// Its score, if it was won.
    pub won: Option<Best>,
    /// It is the best so far.
    pub is_best: bool,
    /// What was best before it.
    pub before: Option<Best>,
    /// Its replay.
    pub replay: Option<Replay>,
    /// The link to it, or how many letters that would have.
    pub link: Option<Result<String, usize>>,
}

/// Records flights and keeps the best.
#[derive(Clone, Debug, Default)]
pub struct MissionsPlugin {
    /// Where the best flights are kept; None: in the user's data folder.
    pub folder: Option<std::path::PathBuf>,
}

/// Where the best flights are kept, if it was said.
#[derive(Resource)]
struct RecordsFolder(Option<std::path::PathBuf>);

impl Plugin for MissionsPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(RecordsFolder(self.folder.clone()))
            .init_resource::<LastFlight>()
            .init_resource::<Records>()
            .add_systems(Startup, read_records)
            .add_systems(Update, keep_score.in_set(GameSet::Window).run_if(resource_exists::<ReplayLog>));
    }
}

fn read_records(folder: Res<RecordsFolder>, mut records: ResMut<Records>, mut notice: Option<ResMut<Notice>>, real: Res<Time<Real>>) {
    let (found, said) = folder.0.as_deref().map_or_else(Records::load, Records::load_from);
    *records = found;
    if let (Some(text), Some(notice)) = (said, &mut notice) {
        **notice = Notice { text, until: real.elapsed_secs_f64() + 10.0, share: None };
    }
}

/// Begins to record the flight that was just started; or, if a replay is watched, to play that. Brings the ghost of the best flight.
pub fn begin_log(world: &mut World, screen: Screen) {
    world.remove_resource::<ReplayLog>();
    world.remove_resource::<Playback>();
    world.remove_resource::<TitleFlight>();
    let session = world.resource::<Session>().clone();
    let ghost = ghost(world, &session);
    world.insert_resource(Ghost(ghost.unwrap_or_else(History::nobody)));
    let pilot = world.resource::<PlayerState>().pilot.unwrap_or_default();
    let begun = Replay::begin(&session.scene, &session.config, session.difficulty, pilot, session.seed);
    if screen != Screen::Playing {
        world.insert_resource(TitleFlight(begun));
        return;
    }
    if let Some(watched) = world.get_resource::<Watched>() {
        let playback = Playback::of(&watched.0);
        let pilot = watched.0.pilot;
        world.insert_resource(playback);
        crate::sim::board(world, pilot);
    } else {
        world.insert_resource(ReplayLog(begun));
    }
}

/// Flies the best flight of this mission again and takes the player's worldline from it.
fn ghost(world: &World, session: &Session) -> Option<History> {
    session.scene.mission.as_ref()?;
    if world.contains_resource::<Watched>() {
        return None;
    }
    let replay = world.get_resource::<Records>()?.replay(&session.scene.record_name(), session.difficulty)?;
    if replay.fingerprint != session.scene.fingerprint {
        return None;
    }
    let mut app = replay.app(&session.scene, &session.config);
    for _ in 0..replay.ticks {
        app.world_mut().run_schedule(FixedUpdate);
    }
    let ship = *app.world().resource::<Fleet>().0.get(session.player())?;
    let mut history = app.world().get::<History>(ship)?.clone();
    history.begins(0.0);
    history.ends(history.latest());
    Some(history)
}

/// When the mission is decided: its score, and the replay.
fn keep_score(world: &mut World) {
    let Some((outcome, time)) = outcome(world) else { return };
    let Some(mut recording) = world.remove_resource::<ReplayLog>() else { return };
    recording.0.finish(world);
    let session = world.resource::<Session>().clone();
    let mut last = LastFlight { replay: Some(recording.0.clone()), link: Some(recording.0.to_link()), ..LastFlight::default() };
    if let Some(mission) = &session.scene.mission {
        last.before = world.resource::<Records>().best(&session.scene.record_name(), session.difficulty);
        let flown_by_hand = !world.resource::<PlayerState>().flown.by_autopilot;
        if outcome.is_won() {
            let best = score(world, &session, mission, time);
            last.won = Some(best);
            // The autopilot's flights are nobody's best.
            if flown_by_hand {
                let mut records = world.resource_mut::<Records>();
                let (is_best, wrong) = records.take(&session.scene.record_name(), session.difficulty, best, &recording.0);
                last.is_best = is_best;
                if let Some(text) = wrong {
                    let until = world.resource::<Time<Real>>().elapsed_secs_f64() + 8.0;
                    world.insert_resource(Notice { text, until, share: None });
                }
            }
        }
    }
    world.insert_resource(last);
}

/// The score of a won flight.
fn score(world: &World, session: &Session, mission: &Arc<Mission>, time: f64) -> Best {
    let own = world.resource::<Fleet>().0.get(session.player()).copied();
    let score = match mission.clock {
        ScoredBy::Far => time,
        ScoredBy::Own => own.and_then(|own| world.get::<ShipMotion>(own)).map_or(time, |motion| motion.0.proper_time),
        ScoredBy::Fuel => own.and_then(|own| world.get::<Fuel>(own)).map_or(0.0, Fuel::spent),
    };
    Best { score, stars: mission.levels[session.difficulty as usize].stars_at(score) }
}
