//! A failing case made smaller for as long as it fails in the same way: fewer things, a smaller picture, fewer triangles, a plainer camera,
//! rounder numbers.
//!
//! It works on the tables of the scene file and knows nothing of what they mean: what no scene may hold is refused by whoever judges.

use toml::{Table, Value};

use super::case_file::CaseFile;
use super::text::rounded_to;

/// Keys that a scene can do without, in the order in which they are tried.
const SPARE: [(&str, &[&str]); 3] = [
    ("ship", &["thrust", "attitude", "model", "fuel", "max_thrust", "player", "target"]),
    ("prop", &["texture", "attitude", "colour", "emissive", "temperature"]),
    ("camera", &["up", "momentum", "look", "fov"]),
];
/// Numbers of triangles that are tried, the fewest first.
const TRIANGLES: [i64; 5] = [20, 80, 320, 1280, 5120];
/// Widths of pictures that are tried, in pixels, the smallest first; the shape stays.
const WIDTHS: [u32; 4] = [48, 80, 120, 160];

/// The smallest case that was found in which `fails` still holds, and how often it was asked. `fails` holds for `case` itself; once it says
/// that there is no more time, by None, what has been found by then is given.
pub fn reduce(case: &CaseFile, fails: &mut dyn FnMut(&CaseFile) -> Option<bool>) -> (CaseFile, usize) {
    let Ok(table) = case.text.parse::<Table>() else { return (case.clone(), 0) };
    let mut state = State { best: case.clone(), table, asked: 0, fails };
    // Twice: what could not be left out at first may be spared when other things are gone.
    for _ in 0..2 {
        let before = state.best.text.clone();
        if state.pass().is_none() || state.best.text == before {
            break;
        }
    }
    (state.best, state.asked)
}

struct State<'a> {
    best: CaseFile,
    /// The scene of the best.
    table: Table,
    asked: usize,
    fails: &'a mut dyn FnMut(&CaseFile) -> Option<bool>,
}

impl State<'_> {
    /// All that can be tried, once; None if there is no more time.
    fn pass(&mut self) -> Option<()> {
        for section in ["disk", "planet", "rules"] {
            self.change(|table| table.remove(section).is_some())?;
        }
        for section in ["ship", "prop"] {
            let mut k = 0;
            while k < self.many(section) {
                let gone = self.change(|table| {
                    entries(table, section).is_some_and(|all| {
                        all.remove(k);
                        true
                    })
                })?;
                k += usize::from(!gone);
            }
        }
        for width in WIDTHS {
            if self.shrink(width)? {
                break;
            }
        }
        if self.best.at != 0.0 && !self.retime(0.0)? {
            self.retime(self.best.at.round())?;
        }
        for (section, keys) in SPARE {
            for k in 0..self.many(section) {
                for key in keys {
                    self.change(|table| entry(table, section, k).is_some_and(|entry| entry.remove(*key).is_some()))?;
                }
            }
        }
        for k in 0..self.many("prop") {
            for triangles in TRIANGLES {
                if self.change(|table| fewer(entry(table, "prop", k), triangles))? {
                    break;
                }
            }
        }
        self.round()
    }

    /// Rounds all numbers together as far as it goes, then each list and number by itself.
    fn round(&mut self) -> Option<()> {
        let mut rough = 5;
        for digits in 1..5 {
            if self.change(|table| round_all(table, digits))? {
                rough = digits;
                break;
            }
        }
        for section in ["camera", "ship", "prop", "planet", "disk"] {
            for k in 0..self.many(section) {
                let keys: Vec<String> = entry(&mut self.table, section, k).map(|entry| entry.keys().cloned().collect()).unwrap_or_default();
                for key in keys {
                    for digits in 0..rough {
                        let rounder = |table: &mut Table| {
                            entry(table, section, k).and_then(|entry| entry.get_mut(&key)).is_some_and(|value| round_value(value, digits))
                        };
                        if self.change(rounder)? {
                            break;
                        }
                    }
                }
            }
        }
        Some(())
    }

    /// How many entries a section has.
    fn many(&self, section: &str) -> usize {
        match self.table.get(section) {
            Some(Value::Array(all)) => all.len(),
            Some(_) => 1,
            None => 0,
        }
    }

    /// Changes the scene if it then still fails; None if there is no more time. `change` says whether it changed anything.
    fn change(&mut self, change: impl FnOnce(&mut Table) -> bool) -> Option<bool> {
        let mut table = self.table.clone();
        if !change(&mut table) {
            return Some(false);
        }
        table.retain(|_, value| value.as_array().is_none_or(|all| !all.is_empty()));
        let Ok(text) = toml::to_string(&table) else { return Some(false) };
        let kept = self.take(CaseFile { text, ..self.best.clone() })?;
        if kept {
            self.table = table;
        }
        Some(kept)
    }

    fn shrink(&mut self, width: u32) -> Option<bool> {
        let [across, down] = self.best.size;
        if width >= across {
            return Some(false);
        }
        self.take(CaseFile { size: [width, (down * width / across).max(1)], ..self.best.clone() })
    }

    fn retime(&mut self, at: f64) -> Option<bool> {
        if at == self.best.at {
            return Some(false);
        }
        self.take(CaseFile { at, ..self.best.clone() })
    }

    fn take(&mut self, case: CaseFile) -> Option<bool> {
        self.asked += 1;
        let fails = (self.fails)(&case)?;
        if fails {
            self.best = case;
        }
        Some(fails)
    }
}

/// The entries of a list of sections.
fn entries<'a>(table: &'a mut Table, section: &str) -> Option<&'a mut Vec<Value>> {
    table.get_mut(section)?.as_array_mut()
}

/// An entry of a list of sections, or the section.
fn entry<'a>(table: &'a mut Table, section: &str, k: usize) -> Option<&'a mut Table> {
    match table.get_mut(section)? {
        Value::Array(all) => all.get_mut(k)?.as_table_mut(),
        Value::Table(table) => Some(table),
        _ => None,
    }
}

fn fewer(entry: Option<&mut Table>, triangles: i64) -> bool {
    let Some(Value::Integer(there)) = entry.and_then(|entry| entry.get_mut("triangles")) else { return false };
    let less = *there > triangles;
    *there = triangles.min(*there);
    less
}

fn round_all(table: &mut Table, digits: i32) -> bool {
    table.iter_mut().fold(false, |changed, (_, value)| changed | round_value(value, digits))
}

/// Rounds all real numbers in a value to so many digits, to 0 with none; in a list of numbers to that digit of the greatest. Says whether
/// any changed.
fn round_value(value: &mut Value, digits: i32) -> bool {
    match value {
        Value::Float(number) => round_number(number, number.abs(), digits),
        Value::Table(table) => round_all(table, digits),
        Value::Array(all) => {
            let greatest = all.iter().filter_map(Value::as_float).fold(0.0, |most: f64, number| most.max(number.abs()));
            all.iter_mut().fold(false, |changed, value| {
                changed
                    | match value {
                        Value::Float(number) => round_number(number, greatest, digits),
                        other => round_value(other, digits),
                    }
            })
        }
        _ => false,
    }
}

fn round_number(number: &mut f64, greatest: f64, digits: i32) -> bool {
    let before = *number;
    // In a list what is small against the greatest goes first: its parts share one grid.
    let place = greatest.abs().log10().floor() - number.abs().log10().floor();
    let left = digits - if place.is_finite() { place as i32 } else { 0 };
    *number = if *number == 0.0 || left <= 0 { 0.0 } else { rounded_to(*number, left) };
    *number != before
}
