//! `lensrunner simulate SCENE --agent`: another program flies the player's ship. For each decision it gets a line of JSON, what is to be
//! seen, and answers with a line of JSON, the player's commands (see `docs/missions.md`).

use std::io::{BufRead, Read as _, Write};

use bevy::prelude::*;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::assist::{AssistMode, Stick};
use super::bolts::Gun;
use super::by_hand::Avoiding;
use super::goals::{ActiveMission, Progress, needed};
use super::guidance::{approach, guidance};
use super::history::History;
use super::intercept::{Advice, ShownWay, Way};
use super::known::Known;
use super::pilot::aim::shot_passes;
use super::pilot::rollout::Point;
use super::player_commands::{ManualControl, PlayerCommands};
use super::replay::{Replay, ReplayLog};
use super::ship::{Engine, Fleet, Fuel, Player, Ship, ShipMotion};
use super::sight::apparition;
use super::simulate::SimulateError;
use super::target::Targets;
use super::{ChaseRules, Clock, app_of, outcome, step};
use crate::scene::document::refusal::in_words;
use crate::scene::mission::{Difficulty, GoalTask};
use crate::scene::pilot_kind::PilotKind;
use crate::scene::ship::Sees;
use crate::scene::{GameConfig, Scene};
use crate::spacetime::Observer;
use crate::spacetime::light::Order;
use crate::spacetime::matter::ShipState;
use crate::user_file::brief;

/// T between two decisions unless an action says otherwise, in r_s/c.
const DECISION: f64 = 0.25;
/// The most bytes of an action.
const MOST_BYTES: u64 = 1 << 16;
/// The longest that an action may last, in r_s/c.
const LONGEST: f64 = 100.0;

/// What is asked of a flight.
#[derive(Clone, Copy, Debug)]
pub struct AgentRequest<'a> {
    /// `game.toml` before the difficulty, for the replay.
    pub config: &'a GameConfig,
    /// Of a mission.
    pub difficulty: Difficulty,
    /// T at which it ends undecided, in r_s/c.
    pub until: f64,
    /// For everything left to chance.
    pub seed: u64,
}

/// What the agent is told, a line of JSON.
#[derive(Clone, Debug, Serialize)]
struct Observation {
    /// Painlevé–Gullstrand time, r_s/c.
    #[serde(rename = "T")]
    time: f64,
    /// Proper time of the own ship, r_s/c.
    tau: f64,
    own: Own,
    others: Vec<Seen>,
    goal: Option<GoalSeen>,
    /// Motion against the target, as the HUD shows it; null where nothing is known of one.
    target: Option<TargetSeen>,
    /// T at which the time is out, r_s/c.
    time_limit: f64,
    /// r_s/c of T in a second of a player's, by which a full turn is measured.
    pace: f64,
    /// The assist has taken the thrust to keep off the hole.
    avoiding: bool,
    /// Present in the last line alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    outcome: Option<&'static str>,
}

/// The own ship.
#[derive(Clone, Debug, Serialize)]
struct Own {
    /// r_s, the hole in the origin.
    position: DVec3,
    /// dx/dT, c.
    velocity: DVec3,
    /// Body axes to coordinate axes: x, y, z, w; the nose is −z.
    attitude: [f64; 4],
    /// Velocity change left, c; null without limit.
    fuel: Option<f64>,
    /// Largest proper acceleration, c²/r_s.
    thrust: f64,
    bolts: u32,
    /// r_s/c until the gun is ready.
    reload: f64,
    /// The fastest turn, rad per own r_s/c.
    turn_rate: f64,
}

/// Motion against the target.
#[derive(Clone, Debug, Serialize)]
struct TargetSeen {
    /// Where it is if it has fallen freely since it was known, r_s, and how old that is, r_s/c.
    position: DVec3,
    age: f64,
    /// Distance, r_s; how fast it shrinks and the speed across, c.
    range: f64,
    closing: f64,
    sideways: f64,
    /// The way of braking, r_s, and the sign: "free", "soon", "now".
    stopping: f64,
    brake: &'static str,
    /// How near both pass if they coast, r_s, and in which time, r_s/c; null if they part.
    pass: Option<[f64; 2]>,
    /// Within this it is caught or flown through, r_s; null where the goal is another.
    reach: Option<f64>,
    /// What leads there: "fall", "push", or as yet nothing, "wait"; null near it, and where nothing is advised.
    leads: Option<&'static str>,
    /// The change of velocity now, on rest-frame axes, c, after which the fall leads there.
    push: Option<DVec3>,
    /// How near a bolt fired now comes to it, r_s; null without bolts.
    bolt: Option<f64>,
}

/// Another ship, as far as is known of it.
#[derive(Clone, Debug, Serialize)]
struct Seen {
    name: String,
    /// Age of what is known, r_s/c.
    age: f64,
    position: DVec3,
    velocity: DVec3,
    /// Where its first and its second image are, on body axes; null where none is.
    images: [Option<DVec3>; 2],
    /// How old these are, r_s/c.
    image_ages: [Option<f64>; 2],
}

/// What is to be done now.
#[derive(Clone, Debug, Serialize)]
struct GoalSeen {
    text: String,
    number: usize,
    of: usize,
    /// 0 to 1.
    done: f64,
    /// Middle of the next gate, r_s.
    gate: Option<DVec3>,
    /// Radii between which it is to be done, r_s; null where it names none.
    radius: Option<[f64; 2]>,
    /// The fastest that counts against the target, c; null where it does not matter.
    speed: Option<f64>,
    /// Within which distance, r_s, and time, r_s/c, a hunter catches the ship; null where nobody does.
    caught: Option<[f64; 2]>,
    /// How much of it is all, in its unit: of a hold r_s/c.
    needs: f64,
}

/// The player's commands, a line of JSON. What is left out is at rest.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Action {
    /// Right, up, backwards: each −1 to 1 of the engine's thrust.
    thrust: [f64; 3],
    /// Pitch up, yaw left, roll left: each −1 to 1 of the fastest turn.
    turn: [f64; 3],
    fire: bool,
    look: bool,
    assist: Assist,
    /// Take away all motion against the target.
    #[serde(rename = "match")]
    matching: bool,
    /// For so long, r_s/c of T; 0.25 if absent.
    #[serde(rename = "for")]
    span: Option<f64>,
}

/// true and false, or what the assist holds to.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "assist must be true, false, \"orbit\", \"target\" or \"off\"")]
enum Assist {
    On(bool),
    To(AssistMode),
}

impl Default for Assist {
    fn default() -> Assist {
        Assist::On(false)
    }
}

impl Action {
    /// The commands, and for how long.
    fn check(&self) -> Result<(PlayerCommands, f64), String> {
        for (name, axes) in [("thrust", self.thrust), ("turn", self.turn)] {
            if let Some(axis) = axes.iter().find(|axis| !(-1.0..=1.0).contains(*axis)) {
                return Err(format!("{name}: {axis} must be from -1 to 1"));
            }
        }
        let span = self.span.unwrap_or(DECISION);
        if !(span > 0.0 && span <= LONGEST) {
            return Err(format!("for: {span} must be above 0 and at most {LONGEST} r_s/c"));
        }
        let stick = Stick { thrust: self.thrust.into(), turn: self.turn.into() };
        let assist = match self.assist {
            Assist::On(true) => AssistMode::Orbit,
            Assist::On(false) => AssistMode::Off,
            Assist::To(mode) => mode,
        };
        Ok((
            PlayerCommands { fire: self.fire, looking: self.look, assist, matching: self.matching, ..PlayerCommands::holding(&stick) },
            span,
        ))
    }
}

/// Flies `scene` (with its difficulty in `config`) as `actions` say until it is decided, until T = `until`, or until there are no more. The
/// replay of it.
pub fn fly(
    scene: &Scene,
    config: &GameConfig,
    request: &AgentRequest<'_>,
    actions: &mut dyn BufRead,
    observations: &mut dyn Write,
) -> Result<Replay, SimulateError> {
    let mut app = app_of(scene, config, request.seed);
    let world = app.world_mut();
    let own = world.query_filtered::<Entity, With<Player>>().iter(world).next();
    let Some(own) = own else {
        return Err(SimulateError::Input(format!("scene {}: none of its ships has player = true, so there is none to fly", scene.name)));
    };
    let sees = scene.ships.get(world.get::<Ship>(own).map_or(0, |ship| ship.index)).map_or(Sees::Now, |spec| spec.sees);
    let pace = config.clock.pace;
    let AgentRequest { difficulty, seed, .. } = *request;
    world.insert_resource(ReplayLog(Replay::begin(scene, request.config, difficulty, PilotKind::Expert, seed)));
    for number in 1.. {
        let decided = outcome(world).map(|(outcome, _)| outcome.name());
        let over = decided.or((world.resource::<Clock>().time >= request.until).then_some("undecided"));
        let line = serde_json::to_string(&observe(world, own, sees, over)).map_err(std::io::Error::other)?;
        writeln!(observations, "{line}")?;
        observations.flush()?;
        let mut answer = String::new();
        let wrong = |problem: String| SimulateError::Input(format!("standard input, line {number}: {problem}"));
        let mut read = || match (&mut *actions).take(MOST_BYTES + 1).read_line(&mut answer) {
            Err(error) if error.kind() == std::io::ErrorKind::InvalidData => Err(wrong("is no text in UTF-8".into())),
            other => Ok(other?),
        };
        if over.is_some() || read()? == 0 {
            break;
        }
        if answer.len() as u64 > MOST_BYTES {
            return Err(wrong(format!("is longer than {MOST_BYTES} bytes, the most that an action has")));
        }
        if !answer.trim_start().starts_with('{') {
            return Err(SimulateError::Input(format!("standard input, line {number}: an action is an object: {{\"thrust\": [0, 0, -1]}}")));
        }
        let action: Action = serde_json::from_str(&answer).map_err(|error| wrong(said(&error)))?;
        let (commands, span) = action.check().map_err(wrong)?;
        world.insert_resource(PlayerCommands { pace, ..commands });
        let steps = (span / world.resource::<Clock>().step).round().max(1.0) as u64;
        for _ in 0..steps {
            step(world);
            if outcome(world).is_some() {
                break;
            }
        }
    }
    let mut log = world.remove_resource::<ReplayLog>().ok_or_else(|| SimulateError::Input("nothing was recorded".into()))?;
    log.0.finish(world);
    Ok(log.0)
}

/// What the reader says of a line, at its column.
fn said(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let without_place = text.rfind(" at line ").map_or(text.as_str(), |end| &text[..end]);
    format!("column {}: {}", error.column(), brief(&in_words(without_place)))
}

fn observe(world: &mut World, own: Entity, sees: Sees, outcome: Option<&'static str>) -> Observation {
    let state = world.get::<ShipMotion>(own).map(|motion| motion.0).unwrap_or(ShipState::new(DVec3::X, DVec3::ZERO));
    let target = target_seen(world, own, &state);
    let (clock, pace) = (world.resource::<Clock>(), world.resource::<PlayerCommands>().pace);
    let fuel = world.get::<Fuel>(own).map(|fuel| fuel.left).filter(|fuel| fuel.is_finite());
    let others = world.resource::<Fleet>().0.iter().filter(|&&ship| ship != own);
    Observation {
        time: clock.time,
        tau: state.proper_time,
        own: Own {
            position: state.position,
            velocity: Point::from(&state).velocity(),
            attitude: state.attitude.to_array(),
            fuel,
            thrust: world.get::<Engine>(own).map_or(0.0, |engine| engine.max_thrust),
            bolts: world.get::<Gun>(own).map_or(0, |gun| gun.left),
            reload: world.get::<Gun>(own).map_or(0.0, |gun| (gun.ready - clock.time).max(0.0)),
            turn_rate: world.resource::<ManualControl>().turn_rate / pace,
        },
        target,
        time_limit: world.resource::<ChaseRules>().0.time_limit,
        pace,
        avoiding: world.get_resource::<Avoiding>().is_some_and(|avoiding| avoiding.0),
        others: others.filter_map(|&ship| see(world, &state, ship, sees)).collect(),
        goal: goal(world),
        outcome,
    }
}

/// What is known of a ship; None before any light of it has come.
fn see(world: &World, own: &ShipState, ship: Entity, sees: Sees) -> Option<Seen> {
    let (history, name) = (world.get::<History>(ship)?, world.get::<Ship>(ship)?.name.clone());
    let now = world.resource::<Clock>().time;
    let eye = Observer { position: own.position, momentum: own.momentum, attitude: own.attitude, field_of_view: 1.0 };
    let images = [0, 1].map(|order| apparition(&eye, now, history, Order::ALL[order]));
    let age = match sees {
        Sees::Now => 0.0,
        Sees::Light => images[0].as_ref()?.age,
        Sees::SecondImage => images[1].as_ref()?.age,
    };
    let sample = history.at(now - age);
    let velocity = Point { x: sample.position, p: sample.momentum }.velocity();
    Some(Seen {
        name,
        age,
        position: sample.position,
        velocity,
        images: images.map(|image| image.map(|image| image.direction)),
        image_ages: images.map(|image| image.map(|image| image.age)),
    })
}

/// Motion against what the present goal is about.
fn target_seen(world: &mut World, own: Entity, state: &ShipState) -> Option<TargetSeen> {
    let time = world.resource::<Clock>().time;
    let (known, reach, advice) = world.run_system_cached_with(known_target, (own, *state, time)).ok().flatten()?;
    let thrust = world.get::<Engine>(own)?.max_thrust;
    let point = Point::from(state);
    let guide = guidance(&point, &known.point, thrust, reach.unwrap_or(0.0));
    Some(TargetSeen {
        position: known.point.x,
        age: known.age,
        range: guide.apart.length(),
        closing: guide.closing(),
        sideways: guide.sideways(),
        stopping: guide.stopping,
        brake: ["free", "soon", "now"][guide.brake as usize],
        pass: approach(&point, &known).map(|near| [near.distance, near.ahead]),
        reach,
        leads: advice.map(|advice| match advice {
            Advice::Coast => "fall",
            Advice::Thrust(_) => "push",
            Advice::Wait => "wait",
        }),
        push: advice.and_then(Advice::thrust).map(|advice| advice.push),
        bolt: world.get::<Gun>(own).filter(|gun| gun.left > 0).map(|_| shot_passes(state, &known.point)),
    })
}

/// What is known of the target, how near it must be, and what leads there.
type TargetKnown = (Known, Option<f64>, Option<Advice>);

fn known_target(
    In((own, state, time)): In<(Entity, ShipState, f64)>,
    targets: Targets,
    commands: Res<PlayerCommands>,
    mut ships: Query<(&Engine, &Way, &mut ShownWay)>,
) -> Option<TargetKnown> {
    let known = targets.known(own, &state, time)?;
    let (engine, way, mut shown) = ships.get_mut(own).ok()?;
    // Where the nose turns to.
    if commands.facing {
        shown.0 = *way;
    }
    let advice = targets.advice((own, &mut shown.0), &state, &known, time, engine.max_thrust);
    Some((known, targets.reach(own), advice))
}

fn goal(world: &World) -> Option<GoalSeen> {
    let (mission, progress) = (&world.get_resource::<ActiveMission>()?.0, world.get_resource::<Progress>()?);
    let goal = mission.goals.get(progress.goal)?;
    Some(GoalSeen {
        text: goal.text.clone(),
        number: progress.goal + 1,
        of: mission.goals.len(),
        done: progress.share(mission, world.resource::<ChaseRules>()),
        gate: mission.gates.get(progress.gates).map(|gate| gate.position),
        radius: match goal.task {
            GoalTask::Reach { least, most, .. } | GoalTask::Whirl { least, most, .. } | GoalTask::Survive { least, most, .. } => {
                Some([least, most])
            }
            _ => None,
        },
        speed: if let GoalTask::Match { speed, .. } = goal.task { Some(speed) } else { None },
        caught: (!mission.caught_by.is_empty())
            .then(|| world.resource::<ChaseRules>().0)
            .map(|rules| [rules.capture_radius, rules.hold_time]),
        needs: needed(&goal.task, mission, world.resource::<ChaseRules>()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    fn flown(actions: &str, until: f64) -> Result<Vec<serde_json::Value>, String> {
        let scene = scene::load("02-first-pursuit").expect("a mission");
        let mut out = Vec::new();
        let config = GameConfig::default();
        let request = AgentRequest { until, seed: 1, config: &config, difficulty: Difficulty::Normal };
        let levelled = scene.config(&config, Difficulty::Normal);
        let replay = fly(&scene, &levelled, &request, &mut actions.as_bytes(), &mut out).map_err(|e| e.to_string())?;
        if replay.ticks > 0 {
            replay.verify(std::path::Path::new("r"), None, &config).map_err(|e| e.to_string())?;
        }
        let text = String::from_utf8(out).expect("text");
        Ok(text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect())
    }

    #[test]
    fn each_action_gets_an_observation_and_the_last_says_the_end() {
        let lines = flown("{}\n{\"thrust\":[0,0,-1],\"for\":1}\n{}\n", 1.25).expect("a flight");
        let times: Vec<f64> = lines.iter().map(|line| line["T"].as_f64().expect("a number")).collect();
        assert_eq!(times, [0.0, 0.25, 1.25]);
        assert_eq!(lines[2]["outcome"], "undecided");
        assert!(lines[1].get("outcome").is_none());
        let spent = lines[1]["own"]["fuel"].as_f64().unwrap_or(0.0) - lines[2]["own"]["fuel"].as_f64().unwrap_or(0.0);
        // Full thrust for 1 r_s/c; a little less of the ship's own time.
        assert!((0.05..=0.06).contains(&spent), "{spent}");
        assert_eq!(lines[0]["others"][0]["name"], "freighter");
        assert_eq!(lines[0]["goal"]["of"], 1);
        let target = &lines[0]["target"];
        assert!(target["brake"] == "free" && target["range"].as_f64().is_some_and(|range| range > 3.0), "{target}");
        assert_eq!([&target["reach"], &lines[0]["goal"]["needs"], &lines[0]["time_limit"]], [0.7, 3.0, 270.0]);
        assert_eq!([&target["bolt"], &lines[0]["goal"]["speed"], &lines[0]["goal"]["caught"]], [&serde_json::Value::Null; 3]);
        assert_eq!(flown("", 5.0).expect("a flight").len(), 1, "nothing more is asked for");
    }

    #[test]
    fn the_assist_matches_the_target() {
        let speed = |line: &serde_json::Value| ["closing", "sideways"].map(|key| line["target"][key].as_f64().expect("a number").abs());
        let lines = flown("{}\n{\"assist\":\"target\",\"match\":true,\"for\":8}\n", 9.0).expect("a flight");
        let [before, after] = [&lines[0], &lines[2]].map(|line| speed(line).into_iter().fold(0.0, f64::max));
        assert!(after < 0.5 * before, "{before} {after}");
    }

    #[test]
    fn a_scene_in_which_nobody_plays_is_refused() {
        let scene = scene::load("plunge").expect("a scene");
        let config = GameConfig::default();
        let request = AgentRequest { until: 1.0, seed: 1, config: &config, difficulty: Difficulty::Normal };
        let said = fly(&scene, &config, &request, &mut &b"{}"[..], &mut Vec::new()).expect_err("refused").to_string();
        assert!(said.contains("player = true"), "{said}");
    }

    #[test]
    fn wrong_actions_are_refused_with_their_line() {
        for (actions, words) in [
            ("{}\n{\"thrust\":[2,0,0]}\n", ["line 2", "from -1 to 1"]),
            ("{\"burn\":1}\n", ["line 1", "burn"]),
            ("{\"for\":0}\n", ["line 1", "above 0"]),
            ("{\"assist\":\"hole\"}\n", ["line 1", "\"target\""]),
            ("nonsense\n", ["line 1", "an object"]),
            ("[]\n", ["line 1", "an object"]),
        ] {
            let said = flown(actions, 9.0).expect_err(actions);
            assert!(words.iter().all(|word| said.contains(word)), "{said}");
        }
        let said = flown(&format!("{{}}\n{{{}}}\n", " ".repeat(1_000_000)), 9.0).expect_err("too long");
        assert!(said.contains("line 2: is longer than 65536 bytes"), "{said}");
    }
}
