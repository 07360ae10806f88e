//! `[[ship]]` in a scene file: where a ship starts, and who flies it.
//!
//! ```toml
//! [[ship]]
//! name = "quarry"
//! position = [10.0, 0.0, 0.0]      # r_s
//! momentum = [0.3162, 0.0, 0.0]    # rain-frame momentum per mass, c
//! # or, instead of both:
//! orbit = { radius = 5.0, inclination = 0.1, node = 0.0, phase = 0.0 }
//! orbit = { semi_latus_rectum = 5.0, eccentricity = 0.5, anomaly = 3.14159, inclination = 0.1, node = 0.0, phase = 0.0 }
//! facing = "quarry"                # or: it looks at where it sees that ship at the start
//! scatter = { radius = 0.5, phase = 0.4, tilt = 0.1 }  # by chance it starts so much farther in or out (r_s), on or back (rad), tilted
//! (rad) attitude = [1.0, 0.0, 0.0, 0.0]  # w, x, y, z: body to rain axes through the pure boost of the momentum; forward is −z
//! ai = "none"                      # or "flee", "pursue"; "hands" throw it about
//! target = "hunter"                # whom the AI flees or pursues; the first other ship if absent
//! sees = "now"                     # what the AI knows of others: "now"; "light", what light has brought; "second-image", older light
//! alone thrust = [{ from = 0.0, until = 10.0, acceleration = [0.0, 0.0, -0.05] }]  # body axes, c²/r_s; with ai = "none" only
//! fuel = 2.0                       # Δv in c (∫ |proper acceleration| dτ); if absent the game's for player and AI, for others without end
//! max_thrust = 0.06                # c²/r_s, for AI and player; the game's value if absent
//! player = true                    # flown from the keyboard when there is one, else by its AI
//! model = "quarry.glb"
//! ```
//! Orbit keys: `radius` (r_s, above 1.5) for a circle, or `semi_latus_rectum` (r_s), `eccentricity` and `anomaly` (χ in r = p/(1 + e cos
//! χ), 0 at the periapsis); `inclination`, `node` (azimuth of the ascending node), `phase` (angle from the node to the ship along its
//! motion) place it. Angles in radians, 0 if absent; inclination π/2 … π goes round the other way.

use super::document::fault::{Fault, fault, in_range};
use std::f64::consts::PI;
use std::ops::Range;

use glam::{DQuat, DVec3};
use serde::Deserialize;
use toml::Spanned;

use super::document::{exactly, exactly_or_none};
use crate::spacetime::matter::{SINGULARITY_RADIUS, ShipState};
use crate::spacetime::orbit::{Elements, OrbitError};

/// The farthest a ship may start, in r_s.
pub(super) const MAX_START_RADIUS: f64 = 1e6;
/// The largest starting momentum per mass, in c. Beyond it γ − βn·p loses the energy to rounding.
pub const MAX_START_MOMENTUM: f64 = 1e6;
/// The largest proper acceleration in a programme or of an engine, in c²/r_s.
const MAX_ACCELERATION: f64 = 1e3;

/// Who flies a ship.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Ai {
    /// Nobody: it coasts, or flies its thrust programme.
    #[default]
    None,
    /// Runs from its target.
    Flee,
    /// Hunts its target.
    Pursue,
    /// Is thrown about by seeded hands.
    Hands,
}

/// By what a pilot knows other ships.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sees {
    /// Where they are, a reaction delay ago.
    #[default]
    Now,
    /// By the light of their primary image, a reaction delay ago.
    Light,
    /// By the light of their second image alone, which went round the hole's far side and is older.
    SecondImage,
}

/// A stretch of constant thrust.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Burn {
    /// Start, T in r_s/c.
    pub from: f64,
    /// End (not included), T in r_s/c.
    pub until: f64,
    /// Proper acceleration in body axes, c²/r_s.
    pub acceleration: DVec3,
}

/// How much a start may differ from the scene's by chance: each evenly from −1 to 1 times this.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter {
    /// Distance from the hole, or the semi-latus rectum of an orbit, which keeps its shape, in r_s.
    pub radius: f64,
    /// Angle round the hole's z axis, in radians.
    pub phase: f64,
    /// Angle by which the orbit's plane is tilted about the line to the hole, in radians.
    pub tilt: f64,
    /// The orbit that is changed; None for a start by position and momentum.
    elements: Option<Elements>,
}

/// A ship as a scene describes it, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct ShipSpec {
    /// Its name, unique in the scene; no commas, quotes or line ends.
    pub name: String,
    /// Its state at T = 0.
    pub state: ShipState,
    /// How much that differs by chance.
    pub scatter: Option<Scatter>,
    /// The ship that it looks at at the start, whatever its attitude.
    pub facing: Option<String>,
    /// Who flies it.
    pub ai: Ai,
    /// Whom its AI flees or pursues; the first other ship if none.
    pub target: Option<String>,
    /// By what its AI knows others.
    pub sees: Sees,
    /// Its thrust programme, in order of time, without overlap.
    pub programme: Vec<Burn>,
    /// Δv left, in c; infinite if the scene does not say.
    pub fuel: f64,
    /// The most proper acceleration its engine gives, c²/r_s; None leaves it to the game's configuration.
    pub max_thrust: Option<f64>,
    /// Flown by the player where there is one.
    pub player: bool,
    /// The model file that shows it.
    pub model: Option<String>,
}

impl ShipSpec {
    /// A coasting ship without limits: what a scene file with only a name and a state gives.
    pub fn coasting(name: impl Into<String>, state: ShipState) -> Self {
        ShipSpec {
            name: name.into(),
            state,
            scatter: None,
            facing: None,
            ai: Ai::None,
            target: None,
            sees: Sees::Now,
            programme: Vec::new(),
            fuel: f64::INFINITY,
            max_thrust: None,
            player: false,
            model: None,
        }
    }
}

/// `[[ship]]` as the file has it, before any check.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShipEntry {
    name: Spanned<String>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    position: Option<Spanned<[f64; 3]>>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    momentum: Option<Spanned<[f64; 3]>>,
    orbit: Option<Spanned<OrbitEntry>>,
    scatter: Option<Spanned<ScatterEntry>>,
    facing: Option<Spanned<String>>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    attitude: Option<Spanned<[f64; 4]>>,
    #[serde(default)]
    ai: Ai,
    target: Option<Spanned<String>>,
    #[serde(default)]
    sees: Sees,
    thrust: Option<Vec<Spanned<BurnEntry>>>,
    fuel: Option<Spanned<f64>>,
    max_thrust: Option<Spanned<f64>>,
    #[serde(default)]
    player: bool,
    model: Option<Spanned<String>>,
}

impl ShipEntry {
    /// What it says of its model, and where.
    pub(super) fn model(&self) -> Option<&Spanned<String>> {
        self.model.as_ref()
    }
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct OrbitEntry {
    radius: Option<Spanned<f64>>,
    semi_latus_rectum: Option<Spanned<f64>>,
    eccentricity: Option<Spanned<f64>>,
    anomaly: Option<Spanned<f64>>,
    inclination: Option<Spanned<f64>>,
    node: Option<Spanned<f64>>,
    phase: Option<Spanned<f64>>,
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct ScatterEntry {
    radius: Option<Spanned<f64>>,
    phase: Option<Spanned<f64>>,
    tilt: Option<Spanned<f64>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct BurnEntry {
    from: Spanned<f64>,
    until: Spanned<f64>,
    #[serde(deserialize_with = "exactly")]
    acceleration: Spanned<[f64; 3]>,
}

/// The most ships of a scene.
pub(super) const MOST_SHIPS: usize = 1000;

/// Checks all ships of a scene: each by itself, names unique, targets known. Those of swarms, which are checked, come last.
pub fn check_ships(entries: &[Spanned<ShipEntry>], swarms: Vec<ShipSpec>) -> Result<Vec<ShipSpec>, Fault> {
    if let Some(entry) = entries.get(MOST_SHIPS) {
        return Err(Fault { span: entry.span(), message: format!("{} ships, allowed are {MOST_SHIPS}", entries.len()) });
    }
    let mut ships: Vec<ShipSpec> = Vec::with_capacity(entries.len());
    for entry in entries {
        let ship = check_ship(entry)?;
        if ships.iter().chain(&swarms).any(|other| other.name == ship.name) {
            return fault(&entry.get_ref().name, format!("name = {:?} is taken by another ship; names must differ", ship.name));
        }
        ships.push(ship);
    }
    ships.extend(swarms);
    for entry in entries {
        let entry = entry.get_ref();
        let wrong =
            |named: &&Spanned<String>| named.get_ref() == entry.name.get_ref() || !ships.iter().any(|ship| &ship.name == named.get_ref());
        if let Some(target) = [&entry.target, &entry.facing].into_iter().flatten().find(wrong) {
            let names: Vec<&str> = ships.iter().map(|ship| ship.name.as_str()).filter(|name| name != entry.name.get_ref()).collect();
            let others = if names.is_empty() { "there is none".into() } else { format!("{names:?}") };
            return fault(target, format!("{:?} must be another ship of the scene: {others}", target.get_ref()));
        }
        if matches!(entry.ai, Ai::Flee | Ai::Pursue) && ships.len() < 2 {
            return fault(&entry.name, "ai = \"flee\" and \"pursue\" need another ship in the scene".into());
        }
    }
    Ok(ships)
}

/// Checks one ship.
fn check_ship(entry: &Spanned<ShipEntry>) -> Result<ShipSpec, Fault> {
    let whole = entry.span();
    let entry = entry.get_ref();
    let name = entry.name.get_ref();
    if name.is_empty() || name.len() > 64 || name.chars().any(|c| c == ',' || c == '"' || c.is_control()) {
        return fault(&entry.name, format!("name = {name:?} must have 1 to 64 characters, without commas, quotes and control characters"));
    }
    let mut state = start(entry, whole)?;
    if let Some(attitude) = &entry.attitude {
        let [w, x, y, z] = *attitude.get_ref();
        let attitude_length = DQuat::from_xyzw(x, y, z, w).length();
        if !(attitude_length > 1e-6 && attitude_length < 1e6) {
            return fault(
                attitude,
                format!("attitude = {:?} must be a quaternion [w, x, y, z] of finite length, not zero", attitude.get_ref()),
            );
        }
        state.attitude = DQuat::from_xyzw(x, y, z, w) * (1.0 / attitude_length);
    }
    let programme = programme(entry)?;
    let scatter = entry.scatter.as_ref().map(|scatter| check_scatter(scatter, entry, &state)).transpose()?;
    Ok(ShipSpec {
        name: name.clone(),
        state,
        scatter,
        facing: entry.facing.as_ref().map(|facing| facing.get_ref().clone()),
        ai: entry.ai,
        target: entry.target.as_ref().map(|target| target.get_ref().clone()),
        sees: entry.sees,
        programme,
        fuel: optional(&entry.fuel, "fuel", 0.0..=f64::MAX, "c")?.unwrap_or(f64::INFINITY),
        max_thrust: optional(&entry.max_thrust, "max_thrust", 0.0..=MAX_ACCELERATION, "c²/r_s")?,
        player: entry.player,
        model: entry.model.as_ref().map(|model| model.get_ref().clone()),
    })
}

fn start(entry: &ShipEntry, whole: Range<usize>) -> Result<ShipState, Fault> {
    match (&entry.position, &entry.momentum, &entry.orbit) {
        (Some(position), Some(momentum), None) => {
            let x = DVec3::from_array(*position.get_ref());
            let p = DVec3::from_array(*momentum.get_ref());
            if !(x.length() > SINGULARITY_RADIUS && x.length() <= MAX_START_RADIUS) {
                return fault(
                    position,
                    format!(
                        "position = {:?} must lie between {SINGULARITY_RADIUS} and {MAX_START_RADIUS:e} r_s from the hole, not {}",
                        x.to_array(),
                        x.length()
                    ),
                );
            }
            if !(0.0..=MAX_START_MOMENTUM).contains(&p.length()) {
                return fault(momentum, format!("momentum = {:?} must be finite and at most {MAX_START_MOMENTUM:e} c", p.to_array()));
            }
            Ok(ShipState::new(x, p))
        }
        (None, None, Some(orbit)) => start_on_orbit(orbit),
        _ => Err(Fault {
            span: whole,
            message: format!("ship {:?} needs either position and momentum, or orbit (and not both)", entry.name.get_ref()),
        }),
    }
}

fn start_on_orbit(orbit: &Spanned<OrbitEntry>) -> Result<ShipState, Fault> {
    elements(orbit)?.state().or_else(|error: OrbitError| fault(orbit, format!("orbit: {error}")))
}

fn elements(orbit: &Spanned<OrbitEntry>) -> Result<Elements, Fault> {
    let keys = orbit.get_ref();
    let angle = |value: &Option<Spanned<f64>>, key| optional(value, key, -1e6..=1e6, "rad").map(Option::unwrap_or_default);
    let (semi_latus_rectum, eccentricity, anomaly) = match (&keys.radius, &keys.semi_latus_rectum, &keys.eccentricity, &keys.anomaly) {
        (Some(radius), None, None, None) => (in_range(radius, "radius", 1.5..=MAX_START_RADIUS, "r_s")?, 0.0, 0.0),
        (None, Some(p), e, _) => (
            in_range(p, "semi_latus_rectum", 1.5..=MAX_START_RADIUS, "r_s")?,
            optional(e, "eccentricity", 0.0..=1.0, "")?.unwrap_or_default(),
            angle(&keys.anomaly, "anomaly")?,
        ),
        _ => {
            return fault(orbit, "orbit needs either radius, or semi_latus_rectum with eccentricity and anomaly (and not both)".into());
        }
    };
    Ok(Elements {
        semi_latus_rectum,
        eccentricity,
        inclination: optional(&keys.inclination, "inclination", 0.0..=PI, "rad")?.unwrap_or_default(),
        node: angle(&keys.node, "node")?,
        phase: angle(&keys.phase, "phase")?,
        anomaly,
    })
}

fn check_scatter(written: &Spanned<ScatterEntry>, ship: &ShipEntry, state: &ShipState) -> Result<Scatter, Fault> {
    let keys = written.get_ref();
    let scatter = Scatter {
        radius: optional(&keys.radius, "radius", 0.0..=MAX_START_RADIUS, "r_s")?.unwrap_or_default(),
        phase: optional(&keys.phase, "phase", 0.0..=PI, "rad")?.unwrap_or_default(),
        tilt: optional(&keys.tilt, "tilt", 0.0..=PI, "rad")?.unwrap_or_default(),
        elements: ship.orbit.as_ref().map(elements).transpose()?,
    };
    // The nearest start to the hole is the one that may fail.
    match scatter.apply(state, [-1.0, 0.0, 0.0]) {
        Some(_) => Ok(scatter),
        None => fault(written, format!("scatter.radius = {} leads to starts that there are not: too near to the hole", scatter.radius)),
    }
}

impl Scatter {
    /// The start `state` changed by `shares`, each from −1 to 1, of radius, phase and tilt; None if there is no such start.
    pub fn apply(&self, state: &ShipState, shares: [f64; 3]) -> Option<ShipState> {
        let farther = self.radius * shares[0];
        let placed = match self.elements {
            Some(elements) => Elements { semi_latus_rectum: elements.semi_latus_rectum + farther, ..elements }.state().ok()?,
            None => {
                let r = state.position.length();
                let farther = state.position * ((r + farther) / r);
                (r + self.radius * shares[0] > SINGULARITY_RADIUS).then(|| ShipState::new(farther, state.momentum))?
            }
        };
        let turn = DQuat::from_axis_angle(placed.position.normalize(), self.tilt * shares[2]);
        let turn = DQuat::from_rotation_z(self.phase * shares[1]) * turn;
        Some(ShipState { position: turn * placed.position, momentum: turn * placed.momentum, attitude: turn * state.attitude, ..*state })
    }
}

fn programme(entry: &ShipEntry) -> Result<Vec<Burn>, Fault> {
    let Some(burns) = &entry.thrust else { return Ok(Vec::new()) };
    if let (Some(first), true) = (burns.first(), entry.ai != Ai::None) {
        return fault(first, "thrust is a programme for ai = \"none\"; an AI flies by itself".into());
    }
    let mut checked: Vec<(Range<usize>, Burn)> = Vec::with_capacity(burns.len());
    for burn in burns {
        let entry = burn.get_ref();
        let from = in_range(&entry.from, "from", 0.0..=1e9, "r_s/c")?;
        let until = in_range(&entry.until, "until", 0.0..=1e9, "r_s/c")?;
        if until <= from {
            return fault(&entry.until, format!("until = {until} must be later than from = {from}"));
        }
        let acceleration = DVec3::from_array(*entry.acceleration.get_ref());
        if !(0.0..=MAX_ACCELERATION).contains(&acceleration.length()) {
            return fault(
                &entry.acceleration,
                format!("acceleration = {:?} must be finite and at most {MAX_ACCELERATION} c²/r_s", acceleration.to_array()),
            );
        }
        checked.push((burn.span(), Burn { from, until, acceleration }));
    }
    checked.sort_by(|a, b| a.1.from.total_cmp(&b.1.from));
    for pair in checked.windows(2) {
        let ((_, earlier), (span, later)) = (&pair[0], &pair[1]);
        if later.from < earlier.until {
            return Err(Fault {
                span: span.clone(),
                message: format!("thrust from = {} begins before the one from {} until {} ends", later.from, earlier.from, earlier.until),
            });
        }
    }
    Ok(checked.into_iter().map(|(_, burn)| burn).collect())
}

fn optional(value: &Option<Spanned<f64>>, key: &str, range: std::ops::RangeInclusive<f64>, unit: &str) -> Result<Option<f64>, Fault> {
    value.as_ref().map(|value| in_range(value, key, range, unit)).transpose()
}
