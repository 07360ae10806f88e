//! The light and opacity of the disk's gas where a ray crosses its plane: what `shaders/disk/light.wgsl` and `gas.wgsl` do, for each point
//! and without arcs.

use glam::{DVec3, Vec3};

use super::shade::{LightShift, black_body_seen};
use crate::scene::blackbody;
use crate::scene::disk::{DISK_UNIT, Gas};
use crate::spacetime::matter::gamma;

/// A ray on its way through the plane of the disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneCrossing {
    /// Where, in r_s; z = 0.
    pub position: DVec3,
    /// Rain-frame momentum of the light there, in units of the frequency that a rain observer at the camera sees.
    pub momentum: DVec3,
    /// T_camera − T, r_s/c.
    pub delay: f64,
}

/// Ends of the table of black bodies, in K, as in gpu/colour.wgsl.
const COLDEST: f32 = 200.0;
const HOTTEST: f32 = 2.0e6;

/// The disk with the colours of its light.
#[derive(Clone, Debug)]
pub struct Disk {
    gas: Gas,
    colours: Vec<[f32; 4]>,
}

impl Disk {
    /// The disk of this gas.
    pub fn new(gas: Gas) -> Disk {
        // Steps of 0.2 % in T: linear interpolation of logarithms is right to 1e-5.
        Disk { gas, colours: blackbody::table(4096, COLDEST, HOTTEST) }
    }

    /// The light that a crossing adds to a ray at camera time `time`, and the share of light from behind that it stops. `blue` is ν_camera
    /// over the frequency that a rain observer at the camera sees.
    pub fn light(&self, crossing: &PlaneCrossing, blue: f64, time: f64, shift: LightShift) -> (Vec3, f32) {
        let position = crossing.position;
        let r = position.truncate().length();
        let [inner, outer] = self.gas.extent();
        if !(r > inner && r < outer) {
            return (Vec3::ZERO, 0.0);
        }
        let momentum = self.gas.momentum(position);
        let k = crossing.momentum;
        let g = blue / (gamma(momentum) * k.length() - momentum.dot(k));
        let emission = self.gas.emission(r, position.y.atan2(position.x), time - crossing.delay);
        let opacity = emission.opacity(Gas::cosine(momentum, k), crossing.delay);
        let black_body = |t: f64| Vec3::from(blackbody::lookup(&self.colours, COLDEST, HOTTEST, t as f32));
        (black_body_seen(black_body, emission.temperature, g, shift) * (DISK_UNIT * opacity) as f32, opacity as f32)
    }
}
