//! `[camera]` in a scene file: from where the scene is seen.
//!
//! ```toml
//! [camera]
//! position = [20.0, 0.0, 5.0]   # r_s
//! momentum = [0.1, 0.0, 0.0]    # rain-frame momentum per mass, c; the camera then falls freely from T = 0.
//!                               # Absent: held in place (a static observer) outside r = 1, falling with the rain inside
//! look = [-1.0, 0.0, 0.0]       # direction in the camera's own axes by the pure boost of its momentum; towards the hole if absent
//! up = [0.0, 1.0, 0.0]          # +y if absent (+x where the camera looks along y)
//! fov = 60.0                    # horizontal field of view, degrees
//! # or, instead of position and momentum, with a ship:
//! follow = "hunter"
//! offset = [0.0, 0.3, 1.0]      # r_s, in the ship's body axes (+x right, +y up, −z forward)
//! # or, instead of all these, with the planet, turning as it does:
//! above = [1.18, 0.0, 10.0]     # magnetic latitude and longitude (radians), height (km; the planet's radius is 6371)
//! look = [0.0, 0.9, 0.4]        # east, north, up; up if absent
//! up = [0.0, 0.0, 1.0]          # the same axes; up if absent (north where the camera looks up)
//! ```

pub mod viewpoint;

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DMat3, DQuat, DVec3};
use serde::Deserialize;
use toml::Spanned;

use crate::scene::aurora::dipole::PLANET_RADIUS;
use crate::scene::document::exactly_or_none;
use crate::scene::document::fault::{Fault, fault, in_range};
use crate::scene::planet::Planet;
use crate::scene::ship::{MAX_START_MOMENTUM, ShipSpec};
use crate::spacetime::frames;
use crate::spacetime::matter::ShipState;
use crate::spacetime::orbit::static_momentum;
use crate::user_file::short;

/// The nearest a camera may start to the singularity, in r_s.
const MIN_CAMERA_RADIUS: f64 = 0.02;
/// The farthest a camera may start, in r_s (the tables reach as far).
const MAX_CAMERA_RADIUS: f64 = 1e4;

/// From where a scene is seen.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneCamera {
    /// How it moves.
    pub mount: Mount,
    /// Horizontal field of view, in radians.
    pub fov: f64,
}

/// How a camera moves.
#[derive(Debug, Clone, PartialEq)]
pub enum Mount {
    /// Held in place by an engine, at rest in Schwarzschild's coordinates; outside r = 1 only.
    Static(ShipState),
    /// In free fall from this state at T = 0.
    Falling(ShipState),
    /// With a ship.
    Follow {
        /// The ship's name.
        ship: String,
        /// Where the camera is, in the ship's body axes, in r_s.
        offset: DVec3,
        /// Direction of view in the ship's body axes, of unit length.
        look: DVec3,
        /// Upwards in the ship's body axes.
        up: DVec3,
    },
    /// With the planet, turning as it does.
    Planet {
        /// Place in the axes of the planet's dipole, in its radii.
        place: DVec3,
        /// Camera axes to the dipole's.
        view: DQuat,
        /// The planet.
        planet: Planet,
    },
}

impl Default for SceneCamera {
    /// Static at 20 r_s on the +z axis, looking into the hole.
    fn default() -> Self {
        let position = DVec3::new(0.0, 0.0, 20.0);
        let state = ShipState { attitude: DQuat::IDENTITY, ..ShipState::new(position, static_momentum(position).unwrap_or_default()) };
        SceneCamera { mount: Mount::Static(state), fov: 60f64.to_radians() }
    }
}

/// The size of a picture, `WIDTHxHEIGHT`.
pub fn picture_size(text: &str) -> Result<[u32; 2], String> {
    let wrong = || format!("`{}` is no size: WIDTHxHEIGHT in pixels, each from 1 to 8192, as 1280x720", short(text));
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(wrong)?;
    let side = |text: &str| text.parse().ok().filter(|side| (1..=8192).contains(side)).ok_or_else(wrong);
    Ok([side(width)?, side(height)?])
}

/// `[camera]` as the file has it, before any check.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraEntry {
    #[serde(default, deserialize_with = "exactly_or_none")]
    position: Option<Spanned<[f64; 3]>>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    momentum: Option<Spanned<[f64; 3]>>,
    follow: Option<Spanned<String>>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    offset: Option<Spanned<[f64; 3]>>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    above: Option<Spanned<[f64; 3]>>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    look: Option<Spanned<[f64; 3]>>,
    #[serde(default, deserialize_with = "exactly_or_none")]
    up: Option<Spanned<[f64; 3]>>,
    fov: Option<Spanned<f64>>,
}

/// Checks the camera against its ranges and the ships or the planet it may go with.
pub fn check_camera(entry: &Spanned<CameraEntry>, ships: &[ShipSpec], planet: Option<&Planet>) -> Result<SceneCamera, Fault> {
    let whole = entry;
    let entry = entry.get_ref();
    let fov = entry.fov.as_ref().map_or(Ok(60.0), |fov| in_range(fov, "fov", 1.0..=170.0, "degrees"))?.to_radians();
    let mount = match (&entry.position, &entry.follow, &entry.above) {
        (Some(position), None, None) => free(entry, position)?,
        (None, Some(ship), None) => follow(entry, ship, ships)?,
        (None, None, Some(above)) => over(entry, above, planet)?,
        _ => {
            return fault(whole, "needs either position, follow or above (and only one)".into());
        }
    };
    Ok(SceneCamera { mount, fov })
}

fn free(entry: &CameraEntry, position: &Spanned<[f64; 3]>) -> Result<Mount, Fault> {
    if let Some(offset) = &entry.offset {
        return fault(offset, "goes with follow only".into());
    }
    let x = vector(position)?;
    let r = x.length();
    if !(MIN_CAMERA_RADIUS..=MAX_CAMERA_RADIUS).contains(&r) {
        return fault(position, format!("is {r} r_s from the hole, allowed {MIN_CAMERA_RADIUS} to {MAX_CAMERA_RADIUS} r_s"));
    }
    let momentum = entry.momentum.as_ref().map(vector).transpose()?;
    if let (Some(p), Some(place)) = (momentum, &entry.momentum)
        && p.length() > MAX_START_MOMENTUM
    {
        return fault(place, format!("has length {}, allowed 0 to {MAX_START_MOMENTUM:e} c", p.length()));
    }
    let (look, up) = axes(entry, -x)?;
    let attitude = frames::look(look, up).unwrap_or_default();
    let state = |p| ShipState { attitude, ..ShipState::new(x, p) };
    Ok(match (momentum, static_momentum(x)) {
        (Some(p), _) => Mount::Falling(state(p)),
        (None, Some(p)) => Mount::Static(state(p)),
        (None, None) => Mount::Falling(state(DVec3::ZERO)),
    })
}

fn follow(entry: &CameraEntry, ship: &Spanned<String>, ships: &[ShipSpec]) -> Result<Mount, Fault> {
    if let Some(momentum) = &entry.momentum {
        return fault(momentum, "goes with position only".into());
    }
    if !ships.iter().any(|known| &known.name == ship.get_ref()) {
        let names: Vec<&str> = ships.iter().map(|ship| ship.name.as_str()).collect();
        return fault(ship, format!("{:?} is no ship of the scene: {names:?}", ship.get_ref()));
    }
    let offset = entry.offset.as_ref().map_or(Ok(DVec3::ZERO), vector)?;
    if let (Some(place), true) = (&entry.offset, offset.length() > 100.0) {
        return fault(place, format!("has length {}, allowed 0 to 100 r_s", offset.length()));
    }
    let (look, up) = axes(entry, DVec3::NEG_Z)?;
    Ok(Mount::Follow { ship: ship.get_ref().clone(), offset, look, up })
}

fn over(entry: &CameraEntry, above: &Spanned<[f64; 3]>, planet: Option<&Planet>) -> Result<Mount, Fault> {
    let Some(planet) = planet else {
        return fault(above, "goes with a [planet] only".into());
    };
    if let Some(place) = entry.momentum.as_ref().or(entry.offset.as_ref()) {
        return fault(place, "does not go with above".into());
    }
    let [latitude, longitude, height] = vector(above)?.to_array();
    if latitude.abs() > FRAC_PI_2 || longitude.abs() > TAU || !(1.0..=1e5).contains(&height) {
        return fault(above, format!("is [{latitude}, {longitude}, {height}], allowed [-π/2 to π/2 rad, -2π to 2π rad, 1 to 100000 km]"));
    }
    let (sine, cosine) = longitude.sin_cos();
    let east = DVec3::new(-sine, cosine, 0.0);
    let upwards = DVec3::new(cosine * latitude.cos(), sine * latitude.cos(), latitude.sin());
    let ground = DQuat::from_mat3(&DMat3::from_cols(east, upwards.cross(east), upwards));
    let look = entry.look.as_ref().map_or(Ok(DVec3::Z), vector)?;
    if let (Some(place), true) = (&entry.look, look.length() < 1e-9) {
        return fault(place, "must not be zero".into());
    }
    let default_up = if look.normalize().cross(DVec3::Z).length() > 1e-3 { DVec3::Z } else { DVec3::Y };
    let up = entry.up.as_ref().map_or(Ok(default_up), vector)?;
    let Some(view) = frames::look(look, up) else {
        return fault(above, "look and up must not lie along one line".into());
    };
    Ok(Mount::Planet { place: upwards * (1.0 + height / PLANET_RADIUS), view: ground * view, planet: *planet })
}

/// Direction of view and upwards, of unit length and not along one line.
fn axes(entry: &CameraEntry, default_look: DVec3) -> Result<(DVec3, DVec3), Fault> {
    let look = entry.look.as_ref().map_or(Ok(default_look), vector)?;
    if let (Some(place), true) = (&entry.look, look.length() < 1e-9) {
        return fault(place, "must not be zero".into());
    }
    let look = look.normalize();
    let Some(place) = &entry.up else {
        return Ok((look, if look.cross(DVec3::Y).length() > 1e-3 { DVec3::Y } else { DVec3::X }));
    };
    let up = vector(place)?;
    if look.cross(up.normalize_or_zero()).length() < 1e-6 {
        return fault(place, "must not be zero, nor along the direction of view".into());
    }
    Ok((look, up.normalize()))
}

/// Three finite numbers.
fn vector(value: &Spanned<[f64; 3]>) -> Result<DVec3, Fault> {
    let vector = DVec3::from_array(*value.get_ref());
    if vector.is_finite() { Ok(vector) } else { fault(value, format!("{vector} must be finite")) }
}
