//! Where a point is, as the lookup asks for it.

use crate::lensing::closed_form::elementary::single::{above, least, most, short_arctan};
use crate::lensing::single::{HALF_TURN, LensCamera};

/// Where a point is, as the lookup needs it, free of cancellation near the camera.
#[derive(Clone, Copy, Debug)]
pub struct SourcePoint {
    /// r, in r_s.
    pub r: f32,
    /// 1 − 1/r.
    pub lapse2: f32,
    /// r − L, in r_s.
    pub dr: f32,
    /// φ, the angle at the hole, in 0..=π.
    pub phi: f32,
}

/// The angle in 0..=π of the point `across` ≥ 0 from the axis and `height` along it, at the distance `r`: by the tangent of half of it,
/// which is accurate near 0 and π and the same on every platform.
#[inline]
pub fn angle(across: f32, height: f32, r: f32) -> f32 {
    let ahead = height.abs();
    let from = [0.0, 0.5 * HALF_TURN, HALF_TURN, 0.5 * HALF_TURN][usize::from(across > ahead) + 2 * usize::from(height < 0.0)];
    let twice = [-2.0, 2.0][usize::from((across > ahead) == (height < 0.0))];
    from + twice * short_arctan(least(across, ahead) / (r + most(across, ahead)))
}

/// The position of a point `along` outward and `across` from the axis, away from the camera; `height` = L + along. All three are
/// rounded from f64: near the camera the offset counts, elsewhere the height.
#[inline]
pub fn source_point(cam: &LensCamera, along: f32, across: f32, height: f32) -> SourcePoint {
    let square = along * along + across * across;
    let r = (height * height + across * across).sqrt();
    let inverse = 1.0 / r;
    let phi = angle(across, height, r);
    let near = 0.25 * cam.l * cam.l - square;
    let offset = (2.0 * cam.l * along + square) / (r + cam.l);
    // r − 1 and r − L: near the camera from the offset, elsewhere from the position.
    let height = above(near, cam.lapse2 * cam.l + offset, r - 1.0);
    SourcePoint { r, lapse2: height * inverse, dr: above(near, offset, r - cam.l), phi }
}
