//! The parameter in which an image of the disk is smooth all round; `shaders/disk/sigma.wgsl` is its twin and says why.

use std::f64::consts::PI;

/// σ of the azimuth `theta` from the camera's, where the sine of the camera's height over the plane is `height` > 0, both angles in rad:
/// the mean of θ and of the angle α round the axis of hole and camera, tan α = tan θ/height.
pub fn sigma(theta: f64, height: f64) -> f64 {
    let (s, c) = theta.sin_cos();
    theta + 0.5 * ((1.0 - height) * s * c).atan2(height * c * c + s * s)
}

/// The inverse: θ, its cosine and its sine.
pub fn bearing(sigma: f64, height: f64) -> [f64; 3] {
    let half_turns = (sigma / PI).round();
    let rest = sigma - half_turns * PI;
    let (s, c) = (2.0 * rest).sin_cos();
    let middle = (1.0 + height) * c.abs();
    let sum = middle + (middle * middle + 4.0 * height * s * s).sqrt();
    let [x, y] = if c > 0.0 { [sum, 2.0 * height * s.abs()] } else { [2.0 * s.abs(), sum] };
    let theta = half_turns * PI + y.copysign(rest).atan2(x);
    [theta, theta.cos(), theta.sin()]
}
