//! `lensrunner-lab compare --flight`: seeded chases flown by the autopilot or by seeded hands, judged at many moments.

use crate::say::say;
use std::time::Instant;

use super::eye::{Eye, eye};
use super::freeze::freeze;
use super::hands::{self, Tally};
use super::jump::{Jump, jumps};
use super::moments::{choose, survey};
use crate::compare::Shown;
use crate::compare::command::{CompareError, DrawCase};
use crate::compare::fault::{Fault, Kind, main_fault};
use crate::compare::judged::{Judged, judge};
use crate::compare::random::case_file::CaseFile;
use crate::compare::random::collect;
use crate::compare::random::command::{Run, bar, leave, one, report};
use crate::compare::random::outcome::{Outcome, Row, summary};
use lensrunner::judge::case::{Case, TraceError};
use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner::scene::{self, GameConfig, Scene};
use lensrunner::sim::Moment;

/// Draws what each pixel shows, and no light.
pub type Shower<'a> = dyn Fn(&Case) -> Result<Vec<Shown>, String> + 'a;

/// What to judge.
#[derive(Clone, Debug)]
pub struct FlightCompareRequest {
    /// The scene's name or file.
    pub scene: String,
    /// Who flies the player's ship. Hands fly at five paces by turns, and their flights are seen as a player looks.
    pub pilot: PilotKind,
    /// How many chases.
    pub seeds: u64,
    /// The seed of the first; those of the others follow it.
    pub first: u64,
    /// Moments of each.
    pub moments: usize,
    /// The only moment, T in r_s/c; None: they are chosen.
    pub at: Option<f64>,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// How each is judged, and where what fails goes.
    pub run: Run,
}

/// Flies and judges; leaves each moment that fails in the folder as a scene of its own; prints a table. Gives a row for each moment.
pub fn run(request: &FlightCompareRequest, contestant: &DrawCase, shower: &Shower) -> Result<Vec<Row>, CompareError> {
    if let Some(at) = request.at.filter(|at| !(0.0..=1e5).contains(at)) {
        return Err(TraceError::Input(format!("--at {at}: T must be a number from 0 to 100000 r_s/c")).into());
    }
    let scene = scene::load(&request.scene).map_err(TraceError::from)?;
    if scene.ships.is_empty() {
        return Err(TraceError::Input(format!("--flight {}: the scene has no ship to fly", request.scene)).into());
    }
    let config = request.run.begin()?;
    let text = scene.text.to_string();
    let count = request.at.map_or(request.moments, |_| 1) as u64;
    let bar = bar(request.seeds * count);
    let mut flight = Flight {
        request,
        scene: &scene,
        text: &text,
        config: config.clone(),
        contestant,
        shower,
        rows: Vec::new(),
        tally: Tally::default(),
    };
    let by_hands = request.pilot == PilotKind::Hands;
    for seed in request.first..request.first.saturating_add(request.seeds) {
        bar.set_message(format!("seed {seed}: flying"));
        let step = config.clock.step;
        if by_hands {
            flight.config.clock.pace = hands::pace(seed);
        }
        let chosen = match request.at {
            Some(at) => vec![(at / step).round() as u64],
            None if by_hands => hands::choose(&scene, &flight.config, seed, scene.rules(&config).time_limit, request.moments),
            None => choose(&survey(&scene, &config, seed, scene.rules(&config).time_limit, request.pilot), request.moments, step, seed),
        };
        // What was flown short has fewer.
        bar.dec_length(count - (chosen.len() as u64).min(count));
        bar.set_message(format!("seed {seed}"));
        flight.judge(seed, &chosen, &mut |row| report(&bar, row))?;
    }
    bar.finish_and_clear();
    say(summary(&flight.rows).trim_end());
    if by_hands {
        say(flight.tally.text().trim_end());
        flight.tally.save(&request.run.output.join("hands.csv"))?;
    }
    if let Some(csv) = &request.run.collected {
        let seeds = format!("{} to {}", request.first, request.first + (request.seeds - 1));
        collect::add(csv, &scene.name, &seeds, &request.run.terms, &flight.rows)?;
    }
    Ok(flight.rows)
}

struct Flight<'a> {
    request: &'a FlightCompareRequest,
    scene: &'a Scene,
    text: &'a str,
    config: GameConfig,
    contestant: &'a DrawCase<'a>,
    shower: &'a Shower<'a>,
    rows: Vec<Row>,
    tally: Tally,
}

/// A frame of the game.
struct Still {
    case: Case,
    /// From where it is seen in a flight by hands.
    eye: Option<Eye>,
    shown: Result<Vec<Shown>, String>,
}

impl Flight<'_> {
    /// Flies one chase and judges it after these steps.
    fn judge(&mut self, seed: u64, steps: &[u64], done: &mut dyn FnMut(&Row)) -> Result<(), CompareError> {
        let mut moment = Moment::with_pilot(self.scene, &self.config, seed, self.request.pilot);
        let mut now = 0;
        // Of the frame at the step `now`, if it was drawn.
        let mut kept: Option<Still> = None;
        for &step in steps {
            let started = Instant::now();
            let before = step.saturating_sub(1);
            if before > now {
                moment.advance(before - now);
                (now, kept) = (before, None);
            }
            let earlier = match kept.take() {
                Some(still) if now == before => Some(still),
                _ if now == before && step > 0 => self.still(&moment, seed, step),
                _ => None,
            };
            moment.advance(step - now);
            now = step;
            let Some(still) = self.still(&moment, seed, step) else { continue };
            if still.case.check().is_err() {
                break;
            }
            let row = self.moment(seed, earlier.as_ref(), &still, started)?;
            done(&row);
            self.rows.push(row);
            kept = Some(still);
        }
        Ok(())
    }

    /// A frame of the moment `number`; none where the camera of hands is nowhere.
    fn still(&self, moment: &Moment, seed: u64, number: u64) -> Option<Still> {
        let (scene, config, size) = (self.scene.clone(), self.config.clone(), self.request.size);
        let (case, eye) = if self.request.pilot == PilotKind::Hands {
            let (eye, camera, hidden) = eye(self.scene, &self.config, moment, seed, number)?;
            (Case::seen(scene, config, moment, camera, hidden, size), Some(eye))
        } else {
            (Case::of(scene, config, moment, size), None)
        };
        let shown = (self.shower)(&case);
        Some(Still { case, eye, shown })
    }

    /// Judges a moment, and the one before it where an image jumps between them.
    fn moment(&mut self, seed: u64, earlier: Option<&Still>, still: &Still, started: Instant) -> Result<Row, CompareError> {
        let name = format!("{}-seed-{seed}-T-{}", self.scene.name, still.case.time);
        let row = |outcome: Outcome| Row {
            name: name.clone(),
            corner: still.eye.map_or("flight", Eye::name).into(),
            size: self.request.size,
            outcome,
            seconds: started.elapsed().as_secs_f64(),
        };
        let mut judged = match judge(&still.case, &self.request.run.terms, self.contestant) {
            Ok(judged) => judged,
            Err(gave_up) => return Ok(row(Outcome::GaveUp(gave_up.to_string()))),
        };
        let found = match (earlier.map(|earlier| (earlier, &earlier.shown)), &still.shown) {
            (Some((earlier, Ok(before))), Ok(after)) => {
                jumps(before, after, self.request.size).into_iter().map(|jump| (earlier, jump)).collect()
            }
            _ => Vec::new(),
        };
        if let Some((earlier, jump)) = found.first()
            && judged.faults.is_empty()
        {
            // The picture after the jump is right; is the one before it?
            judged.faults.extend(self.jump(earlier, still, jump));
        }
        if let Some(eye) = still.eye {
            self.tally.add(self.scene, self.config.clock.pace, eye, &judged);
        }
        let outcome = Outcome::of(&judged);
        if main_fault(&judged.faults).is_some() {
            let wrong =
                if judged.faults[0].kind == Kind::Jump { earlier.map_or(&still.case, |earlier| &earlier.case) } else { &still.case };
            self.leave(&name, seed, wrong, &judged)?;
        }
        Ok(row(outcome))
    }

    /// What is wrong with the frame from which an image jumps to the next; None if it is right, so that things really move so fast.
    fn jump(&self, earlier: &Still, still: &Still, jump: &Jump) -> Option<Fault> {
        let judged = judge(&earlier.case, &self.request.run.terms, self.contestant);
        let (excess, at_first) = match &judged {
            Ok(judged) => {
                let fault = main_fault(&judged.faults)?;
                (fault.excess, format!("{}: {fault}", fault.kind))
            }
            // What nobody has judged does not count as right.
            Err(gave_up) => (1.0, gave_up.to_string()),
        };
        let name = self.scene_object(&earlier.case, jump.object);
        let ([a, b], order) = (jump.areas, jump.order);
        let text = format!(
            "{name} order {order} goes from {a:.1} to {b:.1} px between T = {} and {}; at the first: {at_first}",
            earlier.case.time, still.case.time
        );
        Some(Fault { kind: Kind::Jump, excess, text })
    }

    fn scene_object(&self, case: &Case, number: u32) -> String {
        case.assembly.objects.get((number as usize).wrapping_sub(1)).map_or_else(|| "?".into(), |object| object.name.clone())
    }

    /// Leaves the moment as a scene of its own, made smaller if it still fails; else as it is, with how to see it.
    fn leave(&self, name: &str, seed: u64, case: &Case, judged: &Judged) -> Result<(), CompareError> {
        let [width, height] = self.request.size;
        let command = format!(
            "lensrunner-lab compare --flight {} --pilot {} --seeds 1 --first {seed} --at {} --size {width}x{height}",
            self.request.scene, self.request.pilot, case.time
        );
        let notes = vec![format!("T = {} of the flight of {} with seed {seed}: {command}", case.time, self.scene.name)];
        let Some(text) = freeze(self.text, case) else { return Ok(()) };
        let file = CaseFile { notes, text, at: 0.0, size: self.request.size };
        let run = &self.request.run;
        let frozen = one(name, "flight", &file, &self.config, &run.terms, run.keep(), self.contestant)?;
        if !frozen.failed() {
            // The ships have coasted to here in the file, and not in the flight.
            let mut file = file;
            file.notes.push("this scene does not fail: what fails depends on what the ships burnt before, so judge the flight".into());
            leave(&run.output, name, &file, case, judged)?;
        }
        Ok(())
    }
}
