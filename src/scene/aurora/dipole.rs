//! The planet's magnetic field as a centred dipole, and the plane in which the aurora moves.
//!
//! Axes are the dipole's: +z is the north magnetic pole. A field line is r = L cos²λ with λ the magnetic latitude, so a point of the plane
//! and a height give a position in closed form. The origin of the plane across the field is the magnetic pole. A point (x, y) in km has the
//! colatitude √(x² + y²)/R₀ and the longitude atan2(y, x), both on the reference sphere of radius R₀ = planet + [`REFERENCE_HEIGHT`].
//! Lengths are right along meridians; at the auroral oval (23°) circles of latitude are 2.7 % too long.

use glam::{DVec2, DVec3};

/// Height (km) of the sphere on which the plane across the field is laid: where auroras of a few keV are brightest.
pub const REFERENCE_HEIGHT: f64 = 110.0;
/// The Earth's mean radius, km: all planets here are the Earth's size, scaled as a whole.
pub const PLANET_RADIUS: f64 = 6371.0;

/// The point (km from the planet's centre, dipole axes) at height `z` km on the field line through the place `p` (km) of the plane.
/// Held at the line's top where the height is above it.
pub fn on_field_line(p: DVec2, z: f64) -> DVec3 {
    let reference = PLANET_RADIUS + REFERENCE_HEIGHT;
    let distance = p.length();
    let along = if distance > 0.0 { p / distance } else { DVec2::X };
    let colatitude = (distance / reference).min(std::f64::consts::FRAC_PI_2);
    // r = L sin²θ with θ the colatitude, so sin θ grows as √r.
    let radius = (PLANET_RADIUS + z).max(0.0);
    let sine = (colatitude.sin() * (radius / reference).sqrt()).min(1.0);
    let cosine = (1.0 - sine * sine).sqrt();
    DVec3::new(along.x * sine, along.y * sine, cosine) * radius
}

/// The unit vector along the field, upwards, at a point (dipole axes): (3 (m·n) n − m) with m = +z for the northern half.
pub fn upwards(point: DVec3) -> DVec3 {
    let n = point.normalize_or(DVec3::Z);
    let field = n * (3.0 * n.z) - DVec3::Z;
    let up = field.normalize_or(DVec3::Z);
    if up.dot(n) < 0.0 { -up } else { up }
}

/// The inclination of the field below the horizon at a magnetic latitude, both in radians: tan I = 2 tan λ.
pub fn inclination(latitude: f64) -> f64 {
    (2.0 * latitude.tan()).atan()
}
