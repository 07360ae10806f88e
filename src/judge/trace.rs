//! The camera of a picture, and where a ray meets what it shows.

use glam::DVec3;

use crate::spacetime::observer::Observer;

/// A picture of so many pixels that an observer sees.
#[derive(Clone, Copy, Debug)]
pub struct PixelCamera {
    /// Who looks.
    pub observer: Observer,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

impl PixelCamera {
    /// The direction, in the rain frame, of the light seen at (x, y) in pixels from the upper left corner, and how much bluer than
    /// for a rain observer it is seen: ν_camera/ν_rain.
    pub fn look(&self, x: f64, y: f64) -> (DVec3, f64) {
        let [width, height] = self.size.map(f64::from);
        let half = (0.5 * self.observer.field_of_view).tan();
        let across = (2.0 * x / width - 1.0) * half;
        let up = (1.0 - 2.0 * y / height) * half * height / width;
        // The photon moves against the look; its momentum with frequency 1 goes from the ship's frame to the rain frame by the boost of p.
        let photon = -(self.observer.attitude * DVec3::new(across, up, -1.0).normalize());
        let gamma = (1.0 + self.observer.momentum.length_squared()).sqrt();
        let along = self.observer.momentum.dot(photon);
        let rain = photon + self.observer.momentum * (along / (1.0 + gamma) + 1.0);
        let frequency = gamma + along;
        (-rain / frequency, 1.0 / frequency)
    }

    /// The inverse: where, in pixels, light is seen that comes from `look` (rain frame, unit), and ν_camera/ν_rain; None behind the camera.
    pub fn seen_at(&self, look: DVec3) -> Option<([f64; 2], f64)> {
        let gamma = (1.0 + self.observer.momentum.length_squared()).sqrt();
        let photon = -look;
        let blue = gamma - self.observer.momentum.dot(photon);
        let boosted = photon + self.observer.momentum * (self.observer.momentum.dot(photon) / (1.0 + gamma) - 1.0);
        let seen = self.observer.attitude.conjugate() * -boosted;
        if seen.z >= 0.0 {
            return None;
        }
        let [width, height] = self.size.map(f64::from);
        let focal = 0.5 * width / (0.5 * self.observer.field_of_view).tan();
        Some(([0.5 * width - focal * seen.x / seen.z, 0.5 * height + focal * seen.y / seen.z], blue))
    }
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The index of the mesh.
    pub object: usize,
    /// The index of the triangle in it.
    pub triangle: usize,
    /// Weights of its three vertices; they sum to 1.
    pub barycentrics: [f64; 3],
    /// The image order: half turns swept, plus one.
    pub order: u32,
    /// The angle swept from the camera, radians.
    pub swept: f64,
    /// T_camera − T, r_s/c.
    pub delay: f64,
    /// Where, in r_s.
    pub position: DVec3,
    /// Rain-frame momentum of the light where it left, in units of the frequency that a rain observer at the camera sees.
    pub momentum: DVec3,
}
