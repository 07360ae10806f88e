//! `compare` on the command line: what it is asked for, and its exit codes.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use lensrunner::argument::{number, whole};
use lensrunner::judge::case::{self, Case};
use lensrunner::judge::picture::DEFAULT_PACKET;
use lensrunner::picture_file::moment::moment_of;
use lensrunner::scene;
use lensrunner::scene::pilot_kind::PilotKind;
use lensrunner_lab::compare::{command, flight, judged::Terms, random};
use lensrunner_lab::contestant::GameContestant;

use crate::fail;

/// Judges the game's picture of a scene by the exact one: for each object and image order how far surface points are displaced, which
/// pixels differ, the difference in colour (FLIP); ends with code 1 where a limit is passed.
///
/// Displacements are in pixels: mean, 99 of 100, greatest, and how many pixels were counted apart because what they show is magnified
/// beyond f32. Mismatched pixels are given in per cent of the object's pixels and its rim, and those inside, away from any edge. Thin
/// images are a pixel or two wide: their area to the judge and as shown.
#[derive(Args)]
pub struct CompareArgs {
    /// The scene: a TOML file, the name of one in assets/scenes, or `all`: each of those, at T = 0 and some later times. Or the file of a
    /// moment that the dev overlay has saved.
    #[arg(long, value_name = "NAME|FILE|all")]
    #[arg(long_help = scene::help("The scene: a TOML file, the name of one in assets/scenes, or `all`: each, at T = 0 and some later times. Or a moment."))]
    #[arg(required_unless_present_any = ["random", "case", "flight", "from"], conflicts_with_all = ["random", "case", "flight", "from"])]
    scene: Option<String>,
    /// Judges the moment that a PNG of the game carries: its flight, T, camera and settings.
    #[arg(long, value_name = "PICTURE.png", conflicts_with_all = ["random", "case", "flight", "at", "config", "table"])]
    from: Option<PathBuf>,
    /// Judges N scenes that nobody chose, half of them drawn where methods fail. Those that fail are left in the folder -o.
    #[arg(long, value_name = "N", conflicts_with_all = ["case", "flight", "size", "at", "samples", "table"])]
    #[arg(allow_negative_numbers = true, value_parser = whole::<u64>(1, 1_000_000))]
    random: Option<u64>,
    /// Where the scenes of --random are drawn from.
    #[arg(long, value_name = "S", default_value_t = 1, allow_negative_numbers = true, value_parser = whole::<u64>(0, u64::MAX))]
    seed: u64,
    /// The number of the first scene of --random, or the seed of the first chase of --flight: each can be judged alone.
    #[arg(long, value_name = "K", default_value_t = 0, allow_negative_numbers = true, value_parser = whole::<u64>(0, u64::MAX))]
    first: u64,
    /// Judges case files, as --random leaves them, and those of folders: scene files whose first comment lines say size and T.
    #[arg(long, value_name = "FILE|DIR", num_args = 1.., conflicts_with_all = ["flight", "size", "at", "samples", "table"])]
    case: Vec<PathBuf>,
    /// Judges chases of this scene, flown by the autopilot, at many moments: half of them those at which another ship is seen behind the
    /// hole. Or at the one moment --at. Moments that fail are left in the folder -o as scenes of their own.
    #[arg(long, value_name = "NAME|FILE", conflicts_with_all = ["samples", "table"])]
    flight: Option<String>,
    /// Who flies the player's ship in --flight: naive, apprentice, expert, or hands. Hands throw it about, at five paces by turns, and are
    /// looked at as a player looks: from behind, from the cockpit, from all around, and from beside.
    #[arg(long, value_name = "NAME", default_value_t, requires = "flight", conflicts_with = "scene")]
    pilot: PilotKind,
    /// How many chases --flight flies.
    #[arg(long, value_name = "N", default_value_t = 20, allow_negative_numbers = true, value_parser = whole::<u64>(1, 100_000))]
    seeds: u64,
    /// At how many moments --flight judges each chase.
    #[arg(long, value_name = "N", default_value_t = 200, allow_negative_numbers = true, value_parser = whole::<usize>(1, 100_000))]
    moments: usize,
    /// Leaves what fails as it was drawn, instead of making it smaller for as long as it fails, which takes up to three minutes a case.
    #[arg(long, conflicts_with = "scene")]
    whole: bool,
    /// Adds what came of --random or --flight to this table, in the place of an earlier run of the same cases, and writes FILE.md beside
    /// it.
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["scene", "case"])]
    collect: Option<PathBuf>,
    /// Seconds that the judge may take over a picture; one not traced by then is given up, and it is said how far it came [default: none,
    /// with --random, --case and --flight 60]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = number)]
    limit: Option<f64>,
    /// Width and height in pixels [default: 1280x720, with --flight 160x90, with --from that of the picture].
    #[arg(long, value_name = "WxH", value_parser = scene::picture_size)]
    size: Option<[u32; 2]>,
    /// The time T, in r_s/c, rounded to a step of the simulation (clock.step in game.toml: 0.03125, 1/32, unless changed) [default: 0].
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = number)]
    at: Option<f64>,
    /// The judge's rays a pixel: a square number, 1 to 256.
    #[arg(long, value_name = "N", default_value_t = 9, allow_negative_numbers = true, value_parser = whole::<u32>(1, 256))]
    samples: u32,
    /// Error of each step of a ray, relative to r (1e-17 to 1e-3).
    /// [default: 1e-12, with --random, --case and --flight 1e-10]
    #[arg(long, value_name = "E", allow_negative_numbers = true, value_parser = number)]
    tolerance: Option<f64>,
    /// The game's configuration [default: game.toml here, else the one that the game comes with; with --random, --case and --flight every
    /// value its default].
    #[arg(long, value_name = "game.toml")]
    config: Option<PathBuf>,
    /// Adds the verdict to this table, in the place of an earlier one of the same scene, T and rays, and writes FILE.md beside it. `all`
    /// has a table of its own, in its folder.
    #[arg(long, value_name = "FILE.csv")]
    table: Option<PathBuf>,
    /// The game's picture, the judge's and their difference, side by side. For `all` a folder: a picture each, verdict.csv and verdict.md.
    /// For --random, --case and --flight a folder for what fails.
    #[arg(short, value_name = "FILE.png|DIR", required_unless_present_any = ["random", "case", "flight"])]
    output: Option<PathBuf>,
}

/// Judges.
pub fn run(args: &CompareArgs) -> ExitCode {
    let contestant = GameContestant::default();
    let (config, draw) = (args.config.as_deref(), |case: &Case| contestant.draw(case));
    let usual = Terms::default();
    let terms = Terms { seconds: args.limit.unwrap_or(usual.seconds), tolerance: args.tolerance.unwrap_or(usual.tolerance), ..usual };
    let reduce = !args.whole;
    let failed = |rows: Vec<random::outcome::Row>| rows.iter().any(|row| row.failed());
    let many = |folder: &str| random::command::Run {
        terms,
        config: args.config.clone(),
        output: args.output.clone().unwrap_or_else(|| PathBuf::from(folder)),
        reduce,
        collected: args.collect.clone(),
    };
    let judged = if let Some(count) = args.random {
        random::command::run(args.seed, args.first, count, &many("out/random"), &draw).map(failed)
    } else if !args.case.is_empty() {
        let keep = args.output.as_deref().map(|folder| random::command::Keep { folder, reduce });
        random::command::run_files(&args.case, config, &terms, keep, &draw).map(failed)
    } else if let Some(scene) = args.flight.clone() {
        let (pilot, seeds, first, moments, at) = (args.pilot, args.seeds, args.first, args.moments, args.at);
        let (size, run) = (args.size.unwrap_or(random::case_file::SIZE), many("out/flight"));
        let request = flight::command::FlightCompareRequest { scene, pilot, seeds, first, moments, at, size, run };
        flight::command::run(&request, &draw, &|case: &Case| contestant.show(case)).map(failed)
    } else if let Some(from) = &moment_of(args.scene.as_deref(), args.from.as_deref()) {
        if args.at.is_some() || args.config.is_some() || args.table.is_some() {
            return fail(&"a moment has its own T and settings: --at, --config and --table do not go with it", 2);
        }
        let output = args.output.clone().unwrap_or_default();
        let (snapshot, moment) = match case::flown_again(from, args.size) {
            Ok(flown) => flown,
            Err(error) => return fail(&error, 2),
        };
        let (scene, size, at) = (moment.scene.name.clone(), snapshot.size, snapshot.time);
        let case = Case::again(&snapshot, &moment, size);
        command::run_case(&case, &trace_request(args, scene, size, at), &output, None, &draw).map(|faults| !faults.is_empty())
    } else {
        let (scene, output) = (args.scene.clone().unwrap_or_default(), args.output.clone().unwrap_or_default());
        let request = trace_request(args, scene, args.size.unwrap_or([1280, 720]), args.at.unwrap_or(0.0));
        if request.scene == command::ALL && args.table.is_some() {
            return fail(&"--table: not with --scene all, which writes verdict.csv in its folder", 2);
        }
        let judged = if request.scene == command::ALL {
            command::run_all(&request, config, &output, &draw)
        } else {
            command::run(&request, config, &output, args.table.as_deref(), &draw)
        };
        judged.map(|faults| !faults.is_empty())
    };
    match judged {
        Ok(failed) => ExitCode::from(u8::from(failed)),
        Err(error) => fail(&error, if error.is_input() { 2 } else { 1 }),
    }
}

/// What the judge is to trace.
fn trace_request(args: &CompareArgs, scene: String, size: [u32; 2], at: f64) -> case::TraceRequest {
    let tolerance = args.tolerance.unwrap_or(case::DEFAULT_TOLERANCE);
    case::TraceRequest { scene, size, at, samples: args.samples, threads: 0, tolerance, packet: DEFAULT_PACKET, limit: args.limit }
}
