//! The Schwarzschild metric in Painlevé–Gullstrand coordinates, r_s = c = 1.
//!
//! ds² = −dT² + |dx + β n dT|², n = x/r, β = r^{-1/2}. The slices T = const are flat; the rain frame, falling from rest at
//! infinity, has e₀ = ∂_T − βn·∂ and e_i = ∂_i, and is regular for every r > 0.

/// The impact parameter of the light that winds for ever around r = 3/2, in r_s: b_c = 3√3/2.
pub const CRITICAL_IMPACT: f64 = 2.598_076_211_353_316;

/// β = r^{-1/2}: the inward speed, in c, of the rain frame at radius `r` (in r_s).
pub fn river_speed(r: f64) -> f64 {
    1.0 / r.sqrt()
}
