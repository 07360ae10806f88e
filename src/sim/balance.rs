//! `lensrunner balance`: flies every mission on every difficulty by every pilot, many times, and counts how they end.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::check::{CommandError, files, outcome_name};
use super::rules::Outcome;
use super::run::{FlightReport, RunRequest, run};
use crate::argument::whole;
use crate::scene::mission::{Difficulty, Mission};
use crate::scene::pilot_kind::PilotKind;
use crate::scene::{self, GameConfig, Scene};
use crate::user_file::write_whole;

/// Flies missions on all difficulties by all pilots, for many seeds in parallel, and writes how they end: balance.csv, a row a flight, and
/// balance.md.
#[derive(clap::Args, Clone, Debug)]
pub struct BalanceArgs {
    /// Names, files or folders of missions [default: all of assets/missions].
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub missions: Vec<String>,
    /// Who flies.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', default_values_t = PilotKind::RATED)]
    pub pilots: Vec<PilotKind>,
    /// Flights of each.
    #[arg(long, value_name = "N", default_value_t = 200, allow_negative_numbers = true, value_parser = whole::<u32>(1, 100_000))]
    pub seeds: u32,
    /// The first seed.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = whole::<u64>(0, u64::MAX))]
    pub first: u64,
    /// The game's configuration [default: game.toml here, else the one that the game comes with].
    #[arg(long, value_name = "game.toml")]
    pub config: Option<PathBuf>,
    /// The folder for the tables.
    #[arg(short, value_name = "DIR")]
    pub output: PathBuf,
}

/// One flight.
#[derive(Clone, Debug, PartialEq)]
pub struct BalanceRow {
    /// Index of the mission.
    pub mission: usize,
    /// How hard.
    pub difficulty: Difficulty,
    /// Who flew.
    pub pilot: PilotKind,
    /// For chance.
    pub seed: u64,
    /// What became of it.
    pub report: FlightReport,
}

/// Every difficulty and pilot, in the order of the tables.
fn pairs(pilots: &[PilotKind]) -> impl Iterator<Item = (Difficulty, PilotKind)> {
    Difficulty::ALL.into_iter().flat_map(move |difficulty| pilots.iter().map(move |&pilot| (difficulty, pilot)))
}

/// Flies them all; `done` is told of each.
fn fly_all(
    missions: &[Scene],
    config: &GameConfig,
    pilots: &[PilotKind],
    seeds: std::ops::Range<u64>,
    done: &(dyn Fn() + Sync),
) -> Vec<BalanceRow> {
    let all: Vec<_> = (0..missions.len())
        .flat_map(|mission| pairs(pilots).map(move |(difficulty, pilot)| (mission, difficulty, pilot)))
        .flat_map(|(mission, difficulty, pilot)| seeds.clone().map(move |seed| (mission, difficulty, pilot, seed)))
        .collect();
    all.into_par_iter()
        .map(|(mission, difficulty, pilot, seed)| {
            let report = run(&missions[mission], config, &RunRequest { difficulty, pilot, seed, until: None });
            done();
            BalanceRow { mission, difficulty, pilot, seed, report }
        })
        .collect()
}

/// The share of wins among rows, of 1; 0 of none.
pub fn wins<'a>(rows: impl Iterator<Item = &'a BalanceRow>) -> f64 {
    let (won, all) = rows.fold((0u32, 0u32), |(won, all), row| (won + u32::from(row.report.outcome.is_some_and(Outcome::is_won)), all + 1));
    f64::from(won) / f64::from(all.max(1))
}

/// Runs the command.
pub fn run_command(args: &BalanceArgs) -> Result<(), CommandError> {
    let config = scene::config::find(args.config.as_deref())?;
    let names = if args.missions.is_empty() { scene::mission_names() } else { args.missions.clone() };
    let missions = names.iter().map(|name| missions(name)).collect::<Result<Vec<_>, _>>()?.concat();
    std::fs::create_dir_all(&args.output).map_err(|error| named(&args.output, error))?;
    let flights = missions.len() as u64 * 3 * args.pilots.len() as u64 * u64::from(args.seeds);
    let bar = indicatif::ProgressBar::new(flights);
    let seeds = seeds(args)?;
    let rows = fly_all(&missions, &config, &args.pilots, seeds, &|| bar.inc(1));
    bar.finish_and_clear();
    for (file, text) in [("balance.csv", csv(&missions, &rows)), ("balance.md", table(&missions, &rows, args))] {
        let path = args.output.join(file);
        write_whole(&path, text.as_bytes()).map_err(|error| named(&path, error))?;
    }
    Ok(())
}

/// The seeds that were asked for.
fn seeds(args: &BalanceArgs) -> Result<std::ops::Range<u64>, CommandError> {
    let BalanceArgs { first, seeds, .. } = *args;
    let last = first.checked_add(u64::from(seeds));
    last.map(|last| first..last).ok_or_else(|| CommandError::Argument(format!("--first {first} and --seeds {seeds} go past the last seed")))
}

/// The mission of that name, or those of a folder.
fn missions(name: &str) -> Result<Vec<Scene>, CommandError> {
    if !Path::new(name).is_dir() {
        return Ok(vec![mission(name)?]);
    }
    files(Path::new(name))?.iter().map(|file| mission(&file.to_string_lossy())).collect()
}

/// A scene that is a mission.
fn mission(name: &str) -> Result<Scene, CommandError> {
    let scene = scene::load(name)?;
    if scene.mission.is_none() {
        return Err(CommandError::Argument(format!("{name}: it is no mission; missions: {}", scene::mission_names().join(", "))));
    }
    Ok(scene)
}

fn named(path: &Path, error: std::io::Error) -> std::io::Error {
    std::io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}

/// A row for each flight.
fn csv(missions: &[Scene], rows: &[BalanceRow]) -> String {
    let mut text = String::from("mission,difficulty,pilot,seed,outcome,T,tau,fuel,least_r,greatest_r,hash\n");
    for row in rows {
        let FlightReport { outcome, time, proper_time, fuel, radius, hash, .. } = &row.report;
        let (mission, outcome) = (&missions[row.mission].name, outcome_name(*outcome));
        // Writing to a string never fails.
        _ = writeln!(
            text,
            "{mission},{},{},{},{outcome},{time},{proper_time:.4},{fuel:.3},{:.3},{:.3},{hash}",
            row.difficulty, row.pilot, row.seed, radius[0], radius[1]
        );
    }
    text
}

/// The table of the documents.
fn table(missions: &[Scene], rows: &[BalanceRow], args: &BalanceArgs) -> String {
    let seeds = args.seeds;
    let named = if args.missions.is_empty() { String::new() } else { format!(" --missions {}", args.missions.join(",")) };
    let first = if args.first == 0 { String::new() } else { format!(" --first {}", args.first) };
    let pilots = &args.pilots;
    let by = if pilots == &PilotKind::RATED { String::new() } else { format!(" --pilots {}", join(pilots, ",")) };
    let mut text = format!(
        "# Balance\n\nShare of {seeds} flights that are won, and how the others end. Scores are medians of won flights: r_s/c on the mission's \
         clock, or\nc of Δv where it scores fuel.\n\n| pilot | flies |\n|---|---|\n"
    );
    for pilot in pilots {
        _ = writeln!(text, "| `{pilot}` | {} |", pilot.about());
    }
    _ = writeln!(text, "\nMade by `lensrunner balance --seeds {seeds}{first}{named}{by}`.\n");
    let [slow, quick] = [pilots.first(), pilots.last()].map(|pilot| pilot.copied().unwrap_or_default());
    _ = writeln!(text, "| mission | difficulty | {} | score {slow} | score {quick} | how the others end |", join(pilots, " | "));
    _ = writeln!(text, "|---|---|{}---|---|---|", "---|".repeat(pilots.len()));
    for (index, scene) in missions.iter().enumerate() {
        let Some(mission) = &scene.mission else { continue };
        for difficulty in Difficulty::ALL {
            let of = |pilot: PilotKind| {
                rows.iter().filter(move |row| row.mission == index && row.difficulty == difficulty && row.pilot == pilot)
            };
            let shares: Vec<String> = pilots.iter().map(|&pilot| format!("{:.0} %", 100.0 * wins(of(pilot)))).collect();
            let [slow, quick] = [slow, quick].map(|pilot| middle(of(pilot), mission));
            let ends = ends(rows.iter().filter(|row| row.mission == index && row.difficulty == difficulty));
            _ = writeln!(text, "| {} | {difficulty} | {} | {slow} | {quick} | {ends} |", mission.title, shares.join(" | "));
        }
    }
    text
}

/// Names, one after the other.
fn join(pilots: &[PilotKind], between: &str) -> String {
    pilots.iter().map(|pilot| pilot.name()).collect::<Vec<_>>().join(between)
}

/// The median of the scores of won flights.
fn middle<'a>(rows: impl Iterator<Item = &'a BalanceRow>, mission: &Mission) -> String {
    let won = rows.filter(|row| row.report.outcome.is_some_and(Outcome::is_won));
    let mut scores: Vec<f64> = won.map(|row| row.report.score(mission.clock)).collect();
    scores.sort_by(f64::total_cmp);
    scores.get(scores.len() / 2).map_or("–".into(), |score| if *score < 20.0 { format!("{score:.1}") } else { format!("{score:.0}") })
}

/// How those end that are not won, the most frequent first.
fn ends<'a>(rows: impl Iterator<Item = &'a BalanceRow>) -> String {
    let mut counts: Vec<(&str, u32)> = Vec::new();
    for row in rows.filter(|row| !row.report.outcome.is_some_and(Outcome::is_won)) {
        let name = outcome_name(row.report.outcome);
        match counts.iter_mut().find(|(known, _)| *known == name) {
            Some((_, count)) => *count += 1,
            None => counts.push((name, 1)),
        }
    }
    counts.sort_by_key(|&(_, count)| std::cmp::Reverse(count));
    counts.iter().map(|(name, count)| format!("{name} {count}")).collect::<Vec<_>>().join(", ")
}
