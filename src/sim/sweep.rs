//! `lensrunner simulate --sweep`: the same scene with all combinations of some settings, outcome and duration of each flight a row.

use std::io::{self, Write};

use rayon::prelude::*;

use super::check::outcome_name;
use super::run::{FlightReport, RunRequest, run_levelled};
use crate::scene::config::{self, Value};
use crate::scene::{GameConfig, Scene};
use crate::user_file::short;

/// The most flights of a sweep.
pub const MOST_FLIGHTS: usize = 1_000_000;

/// One setting and the values that it is to have.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Its dotted key.
    pub path: String,
    /// Checked values.
    pub values: Vec<Value>,
}

impl std::str::FromStr for Axis {
    type Err = String;

    /// `enemy.thrust=0.02:0.06:5` (so many values from the first to the second) or `ship.fuel=3,5,7`.
    fn from_str(text: &str) -> Result<Axis, String> {
        let usage = "written KEY=FROM:TO:COUNT or KEY=VALUE,VALUE,…, as enemy.thrust=0.02:0.06:5";
        let (path, values) = text.split_once('=').ok_or_else(|| format!("{:?} must be {usage}", short(text)))?;
        let setting = config::setting(path).ok_or_else(|| format!("{:?} is no setting of game.toml", short(path)))?;
        let number = |word: &str| word.trim().parse::<f64>().map_err(|_| format!("{path}: {:?} is no number; {usage}", short(word)));
        let one = |word: &str| setting.read(word);
        let values = match values.split(':').collect::<Vec<_>>()[..] {
            [from, to, count] => {
                let count: usize = count
                    .trim()
                    .parse()
                    .ok()
                    .filter(|count| (2..=10_000).contains(count))
                    .ok_or_else(|| format!("{path}: COUNT = {:?} must be a whole number, 2 to 10000", short(count)))?;
                let (from, to) = (number(from)?, number(to)?);
                // Twelve digits: 0.04 and not 0.039999999999999994.
                let at = |index: usize| format!("{:.11e}", from + (to - from) * index as f64 / (count - 1) as f64);
                (0..count).map(|index| one(&at(index))).collect::<Result<_, _>>()?
            }
            [list] => list.split(',').map(one).collect::<Result<_, _>>()?,
            _ => return Err(format!("{:?} must be {usage}", short(text))),
        };
        Ok(Axis { path: path.to_owned(), values })
    }
}

/// A key that stands in two axes.
pub fn repeated(axes: &[Axis]) -> Option<&str> {
    axes.iter()
        .enumerate()
        .find(|(index, axis)| axes[..*index].iter().any(|before| before.path == axis.path))
        .map(|(_, axis)| axis.path.as_str())
}

/// The settings of every flight, the last axis changing the fastest; None if there are more than [`MOST_FLIGHTS`].
pub fn combinations(axes: &[Axis], seeds: u64) -> Option<Vec<Vec<Value>>> {
    let count = axes.iter().try_fold(1usize, |count, axis| count.checked_mul(axis.values.len()))?;
    let flights = count.checked_mul(usize::try_from(seeds).ok()?)?;
    (flights <= MOST_FLIGHTS).then(|| {
        axes.iter().fold(vec![Vec::new()], |rows, axis| {
            rows.iter()
                .flat_map(|row| axis.values.iter().map(move |value| [row.as_slice(), std::slice::from_ref(value)].concat()))
                .collect()
        })
    })
}

/// Flies them all in parallel, `request` each with its own settings and seeds from `request.seed` on; rows in order, the same bits whatever
/// the number of threads.
pub fn sweep(
    scene: &Scene,
    config: &GameConfig,
    axes: &[Axis],
    rows: &[Vec<Value>],
    (request, seeds): (&RunRequest, u64),
    out: &mut dyn Write,
) -> io::Result<()> {
    for axis in axes {
        write!(out, "{},", axis.path)?;
    }
    writeln!(out, "seed,outcome,T,tau,fuel,least_r,greatest_r,hash")?;
    let flights: Vec<(&Vec<Value>, u64)> =
        rows.iter().flat_map(|row| (request.seed..request.seed.saturating_add(seeds)).map(move |seed| (row, seed))).collect();
    // The difficulty first, so that what is swept goes before it.
    let levelled = scene.config(config, request.difficulty);
    let fly = |&(row, seed): &(&Vec<Value>, u64)| {
        let mut config = levelled.clone();
        for (axis, value) in axes.iter().zip(row) {
            if let Some(setting) = config::setting(&axis.path) {
                // Checked when it was read.
                let _ = setting.set(&mut config, value.clone());
            }
        }
        run_levelled(scene, &config, &RunRequest { seed, ..*request })
    };
    let reports: Vec<FlightReport> = flights.par_iter().map(fly).collect();
    for ((row, seed), report) in flights.iter().zip(&reports) {
        for value in row.iter() {
            match value {
                Value::Number(number) => write!(out, "{number},")?,
                Value::Integer(number) => write!(out, "{number},")?,
                Value::Switch(on) => write!(out, "{on},")?,
                Value::Word(word) => write!(out, "{word},")?,
            }
        }
        let FlightReport { outcome, time, proper_time, fuel, radius, hash, .. } = report;
        writeln!(out, "{seed},{},{time},{proper_time},{fuel},{},{},{hash}", outcome_name(*outcome), radius[0], radius[1])?;
    }
    out.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_read_and_refused() {
        let axis: Axis = "enemy.thrust=0.02:0.06:5".parse().expect("a range");
        assert_eq!(axis.values.len(), 5);
        assert_eq!(axis.values[0], Value::Number(0.02));
        assert_eq!(axis.values[4], Value::Number(0.06));
        assert_eq!("ship.bolts=3,5".parse::<Axis>().expect("a list").values, [Value::Integer(3), Value::Integer(5)]);
        assert_eq!("assist.enabled=true,false".parse::<Axis>().expect("switches").values.len(), 2);
        for wrong in [
            "enemy.thrust", "enemy.speed=1", "enemy.thrust=a", "enemy.thrust=1:2", "enemy.thrust=0:99:3", "ship.bolts=1.5",
            "enemy.thrust=0:1:1",
        ] {
            assert!(wrong.parse::<Axis>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn all_combinations_are_there_once() {
        let axes: Vec<Axis> = ["enemy.thrust=1,2", "ship.fuel=3,4,5"].map(|text| text.parse().expect("an axis")).into();
        let rows = combinations(&axes, 2).expect("few");
        assert_eq!(rows.len(), 6);
        assert!((0..6).all(|k| !rows[..k].contains(&rows[k])));
        assert_eq!(combinations(&[], 1).expect("one").len(), 1);
        assert!(combinations(&axes, u64::MAX).is_none());
        assert_eq!((repeated(&axes), repeated(&[axes[0].clone(), axes[0].clone()])), (None, Some("enemy.thrust")));
    }

    /// The same rows from one thread and from two.
    #[test]
    fn threads_do_not_change_the_rows() {
        let scene = crate::scene::load("02-first-pursuit").expect("a mission");
        let axes: Vec<Axis> = vec!["enemy.thrust=0.01,0.03".parse().expect("an axis")];
        let rows = combinations(&axes, 2).expect("few");
        let request = RunRequest { until: Some(8.0), ..RunRequest::default() };
        let flown = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let mut out = Vec::new();
            pool.install(|| sweep(&scene, &GameConfig::default(), &axes, &rows, (&request, 2), &mut out)).expect("memory");
            String::from_utf8(out).expect("text")
        };
        let one = flown(1);
        assert_eq!(one.lines().count(), 5);
        assert_eq!(one, flown(2));
    }
}
