//! `[difficulty.easy]`, `.normal` and `.hard` of a mission: keys of `game.toml` that are otherwise there, and the limits of its stars.

use std::fmt;
use std::str::FromStr;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::scene::config::{self, GameConfig, Value};
use crate::scene::document::fault::Fault;
use crate::user_file::short;

/// How hard a mission is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Difficulty {
    /// For the first time.
    Easy,
    /// For those who know how.
    #[default]
    Normal,
    /// For those who are good at it.
    Hard,
}

impl Difficulty {
    /// All, the easiest first.
    pub const ALL: [Difficulty; 3] = [Difficulty::Easy, Difficulty::Normal, Difficulty::Hard];

    /// As files and the command line write it.
    pub fn name(self) -> &'static str {
        ["easy", "normal", "hard"][self as usize]
    }
}

impl fmt::Display for Difficulty {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Difficulty {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Difficulty::ALL.into_iter().find(|difficulty| difficulty.name() == name);
        found.ok_or_else(|| format!("{:?} is no difficulty; known: easy, normal, hard", short(name)))
    }
}

/// What is otherwise on one difficulty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DifficultyLevel {
    /// Dotted keys of `game.toml` and their values, checked.
    keys: Vec<(String, Value)>,
    /// At most such a score for three stars and for two, in r_s/c or c of Δv; none: who wins gets three.
    pub stars: Option<[f64; 2]>,
}

impl DifficultyLevel {
    /// Puts the keys of this level into `config`.
    pub fn apply(&self, config: &mut GameConfig) {
        for (path, value) in &self.keys {
            if let Some(setting) = config::setting(path) {
                // Checked when the file was read.
                let _ = setting.set(config, value.clone());
            }
        }
    }

    /// The number that it gives a setting, if it does.
    pub fn number(&self, path: &str) -> Option<f64> {
        self.keys.iter().find_map(|(key, value)| match value {
            Value::Number(number) if key == path => Some(*number),
            _ => None,
        })
    }

    /// The stars of a win with this score, 1 to 3.
    pub fn stars_at(&self, score: f64) -> u32 {
        match self.stars {
            Some([_, two]) if score > two => 1,
            Some([three, _]) if score > three => 2,
            _ => 3,
        }
    }
}

/// The sections of `game.toml` that a difficulty may change: those that the simulation knows.
const SECTIONS: [&str; 4] = ["ship", "enemy", "assist", "rules"];

/// The levels of a mission's file, in the order of [`Difficulty::ALL`]; those that the file leaves out change nothing. Also all that is
/// wrong with them.
pub fn levels(document: &DeTable<'_>) -> Result<[DifficultyLevel; 3], Vec<Fault>> {
    let mut levels: [DifficultyLevel; 3] = Default::default();
    let Some(section) = document.get("difficulty") else { return Ok(levels) };
    let mut faults = Vec::new();
    let DeValue::Table(section_table) = section.get_ref() else {
        return Err(vec![Fault { span: section.span(), message: "must be sections, written [difficulty.easy]".into() }]);
    };
    for (name, table) in section_table {
        match (name.get_ref().parse::<Difficulty>(), table.get_ref()) {
            (Ok(difficulty), DeValue::Table(table)) => levels[difficulty as usize] = level(table, document, &mut faults),
            (Ok(_), _) => {
                faults.push(Fault { span: table.span(), message: format!("must be a section, written [difficulty.{}]", name.get_ref()) })
            }
            (Err(message), _) => faults.push(Fault { span: name.span(), message }),
        }
    }
    if faults.is_empty() { Ok(levels) } else { Err(faults) }
}

fn level(table: &DeTable<'_>, document: &DeTable<'_>, faults: &mut Vec<Fault>) -> DifficultyLevel {
    let mut config = GameConfig::default();
    let mut given = Vec::new();
    let mut stars = None;
    let before = faults.len();
    for (name, value) in table {
        match (name.get_ref().as_ref(), value.get_ref()) {
            ("stars", _) => match limits(value) {
                Ok(limits) => stars = Some(limits),
                Err(fault) => faults.push(fault),
            },
            (section, DeValue::Table(keys)) if SECTIONS.contains(&section) => {
                faults.extend(config::apply_table(&mut config, section, keys));
                given.extend(keys.iter().map(|(key, _)| format!("{section}.{}", key.get_ref())));
            }
            _ => faults.push(Fault {
                span: name.span(),
                message: format!("unknown; known: stars, and keys of the sections {} of game.toml", SECTIONS.join(", ")),
            }),
        }
    }
    if faults.len() == before
        && let Err(more) = config::check_all(&config, Vec::new(), document)
    {
        faults.extend(more);
    }
    let keys = given.into_iter().filter_map(|path| config::setting(&path).map(|setting| (path, setting.get(&config))));
    DifficultyLevel { keys: keys.collect(), stars }
}

/// `stars = [three, two]`.
fn limits(value: &Spanned<DeValue<'_>>) -> Result<[f64; 2], Fault> {
    let number = |value: &Spanned<DeValue<'_>>| match value.get_ref() {
        DeValue::Float(number) => number.as_str().replace('_', "").parse().ok(),
        DeValue::Integer(number) => number.as_str().replace('_', "").parse().ok(),
        _ => None,
    };
    let pair: Option<Vec<f64>> = match value.get_ref() {
        DeValue::Array(list) => list.iter().map(number).collect(),
        _ => None,
    };
    match pair.as_deref() {
        Some(&[three, two]) if 0.0 < three && three <= two && two <= 1e6 => Ok([three, two]),
        _ => Err(Fault {
            span: value.span(),
            message: "stars must be two scores (r_s/c, or c of Δv with clock = \"fuel\"), the smaller first, above 0 and up to 1e6".into(),
        }),
    }
}
