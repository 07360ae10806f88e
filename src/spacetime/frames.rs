//! Frames and boosts between them. Four-vectors are [`DVec4`] with x, y, z the spatial components and w the time component,
//! signature (+, +, +, −); components are taken on an orthonormal tetrad, usually the rain tetrad (`super::matter`).

use glam::{DMat3, DMat4, DQuat, DVec3, DVec4};

use super::matter::{ShipState, gamma};

/// The Minkowski product of two four-vectors on one orthonormal tetrad.
pub fn dot(a: DVec4, b: DVec4) -> f64 {
    a.truncate().dot(b.truncate()) - a.w * b.w
}

/// The pure boost that takes components on one tetrad to those on the tetrad of an observer moving with momentum `p` in it:
/// V⁰′ = γV⁰ − p·V, V′ = V + p(p·V)/(1+γ) − pV⁰. `boost(-p)` undoes it.
pub fn boost(p: DVec3) -> DMat4 {
    let gamma = gamma(p);
    let spatial = DMat3::IDENTITY + DMat3::from_cols(p * p.x, p * p.y, p * p.z) * (1.0 / (1.0 + gamma));
    DMat4::from_cols(spatial.x_axis.extend(-p.x), spatial.y_axis.extend(-p.y), spatial.z_axis.extend(-p.z), (-p).extend(gamma))
}

/// Rain components to ship (body-axes) components: the pure boost of the momentum, then the inverse attitude. A renderer's camera matrix.
pub fn rain_to_ship(momentum: DVec3, attitude: DQuat) -> DMat4 {
    DMat4::from_quat(attitude.conjugate()) * boost(momentum)
}

/// Ship (body-axes) components to rain components, the inverse of [`rain_to_ship`].
pub fn ship_to_rain(momentum: DVec3, attitude: DQuat) -> DMat4 {
    boost(-momentum) * DMat4::from_quat(attitude)
}

/// A vector in the rest frame of momentum `p` (pure-boost axes, no time component) in rain components (spatial part).
pub fn rest_to_rain(p: DVec3, v: DVec3) -> DVec3 {
    v + p * (p.dot(v) / (1.0 + gamma(p)))
}

/// The momentum of `other` in the rest frame of `p`, pure-boost axes: what an observer with momentum `p` beside it measures.
pub fn relative_momentum(p: DVec3, other: DVec3) -> DVec3 {
    let gamma_p = gamma(p);
    other + p * (p.dot(other) / (1.0 + gamma_p)) - p * gamma(other)
}

/// The velocity, in c, of `other` in the rest frame of `p` (pure-boost axes).
pub fn relative_velocity(p: DVec3, other: DVec3) -> DVec3 {
    let relative = relative_momentum(p, other);
    relative / gamma(relative)
}

/// The direction, in ship axes, towards the source of light that travels along the unit vector `travel` in the rain frame (aberration).
pub fn seen_direction(state: &ShipState, travel: DVec3) -> DVec3 {
    let photon = rain_to_ship(state.momentum, state.attitude) * travel.extend(1.0);
    -photon.truncate() / photon.w
}

/// The attitude whose nose (−z) points along `forward` with +y as near `up` as can be; both on the axes the attitude is to map to.
/// None when either is zero or they are parallel.
pub fn look(forward: DVec3, up: DVec3) -> Option<DQuat> {
    let back = -forward.try_normalize()?;
    let right = up.cross(back).try_normalize()?;
    Some(DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back)))
}
