//! Who looks: where, how it moves, which way it faces.

use glam::{DMat4, DQuat, DVec3};

use super::frames;

/// A camera: where it is, how it moves, which way it looks, how wide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observer {
    /// Position on the slice T = const, in r_s.
    pub position: DVec3,
    /// Rain-frame momentum per mass, in c.
    pub momentum: DVec3,
    /// Attitude: camera axes (+x right, +y up, −z forward) to rain axes through the pure boost of `momentum`.
    pub attitude: DQuat,
    /// Horizontal field of view in radians.
    pub field_of_view: f64,
}

impl Observer {
    /// The camera's radius L, in r_s.
    pub fn radius(&self) -> f64 {
        self.position.length()
    }

    /// The unit vectors (n, a, b): outward, and two across, which make a right-handed frame.
    pub fn axis_frame(&self) -> [DVec3; 3] {
        let n = self.position.normalize();
        let (a, b) = n.any_orthonormal_pair();
        // a × b = n for glam's pair.
        [n, a, b]
    }

    /// Lorentz matrix from rain components to camera components.
    pub fn camera_from_rain(&self) -> DMat4 {
        frames::rain_to_ship(self.momentum, self.attitude)
    }

    /// Its inverse.
    pub fn rain_from_camera(&self) -> DMat4 {
        frames::ship_to_rain(self.momentum, self.attitude)
    }

    /// The direction in rain axes of the light seen in the camera's direction `seen` (camera axes, −z forward).
    pub fn rain_direction(&self, seen: DVec3) -> DVec3 {
        (self.rain_from_camera() * seen.normalize().extend(-1.0)).truncate().normalize()
    }

    /// Where the camera sees light that comes, in rain axes, from `look`: a unit vector in camera axes.
    pub fn seen_direction(&self, look: DVec3) -> DVec3 {
        // The boost of (look, −1), without its matrix: images of bodies ask for this thousands of times in a frame.
        let boosted = frames::rest_to_rain(self.momentum, look.normalize()) + self.momentum;
        (self.attitude.conjugate() * boosted).normalize()
    }

    /// Pixel coordinates (x right, y down, origin at the upper left corner) of a direction in camera axes, or None behind the camera.
    pub fn pixel(&self, seen: DVec3, size: [u32; 2]) -> Option<[f64; 2]> {
        if seen.z >= 0.0 {
            return None;
        }
        let [width, height] = size.map(f64::from);
        let focal = 0.5 * width / libm::tan(0.5 * self.field_of_view);
        Some([0.5 * width - focal * seen.x / seen.z, 0.5 * height + focal * seen.y / seen.z])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seen_direction_is_that_of_the_boosted_wave_vector() {
        let attitude = DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 1.3);
        let momentum = DVec3::new(0.4, -1.7, 0.9);
        let camera = Observer { position: DVec3::X * 9.0, momentum, attitude, field_of_view: 1.0 };
        for look in [DVec3::X, DVec3::new(-0.3, 2.0, 0.7), DVec3::new(0.1, 0.2, -5.0), momentum, -momentum] {
            let wave = camera.camera_from_rain() * look.normalize().extend(-1.0);
            let seen = camera.seen_direction(look);
            assert!((seen - wave.truncate().normalize()).length() < 1e-12, "{look}: {seen}");
            assert!((camera.rain_direction(seen) - look.normalize()).length() < 1e-12, "{look}");
        }
    }
}
