//! The tree of packets: squares of rays, each with the two planes that cut it in four (Sei 2008, section 4.2).

use glam::Vec3;

use super::bounds::Bounds;
use super::bundle::{EyePacket, Ready, slack};

/// A plane through the eye between two halves of a packet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    normal: [f32; 3],
    /// Whether it does part the halves; a packet whose rays do not lie in a grid is not split.
    parts: bool,
}

/// On which side of a plane a box lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// Against the normal.
    Back,
    /// Along the normal.
    Front,
    /// On both.
    Both,
}

impl Side {
    /// Whether something on the front (or back) half can meet it.
    #[inline]
    pub fn reaches(self, front: bool) -> bool {
        match self {
            Side::Both => true,
            Side::Front => front,
            Side::Back => !front,
        }
    }
}

impl Plane {
    /// Sei 2008, section 4.2.2: of the box's corners only the farthest along the normal and the one opposite are looked at.
    #[inline]
    pub fn side(&self, bounds: &Bounds<f32>, eye: [f32; 3], wide: f32) -> Side {
        if !self.parts {
            return Side::Both;
        }
        let (mut least, mut most) = (0.0, 0.0);
        for axis in 0..3 {
            let [low, high] = [bounds.min[axis], bounds.max[axis]].map(|v| (v - eye[axis]) * self.normal[axis]);
            least += low.min(high);
            most += low.max(high);
        }
        let slack = slack(self.normal, wide);
        if least > slack {
            Side::Front
        } else if most < -slack {
            Side::Back
        } else {
            Side::Both
        }
    }
}

/// A run of rays that descends together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bundle {
    pub first: usize,
    pub end: usize,
    /// The first of four bundles that it splits into; 0 for none.
    pub parts: usize,
    /// Between left and right, between upper and lower.
    pub planes: [Plane; 2],
    pub eye: [f32; 3],
    /// By axis: least and greatest reciprocal of the directions; None if they go both ways.
    inverse: [Option<[f32; 2]>; 3],
    wide_eye: [[f32; 3]; 2],
}

impl Bundle {
    /// Early miss exit by interval arithmetic (Boulos, Wald, Shirley 2006): no ray of the bundle meets the box.
    #[inline]
    pub fn misses(&self, bounds: &Bounds<f32>) -> bool {
        let (mut near, mut far) = (0f32, f32::INFINITY);
        for axis in 0..3 {
            let Some([least, greatest]) = self.inverse[axis] else { continue };
            let (first, last) = if least < 0.0 { (bounds.max[axis], bounds.min[axis]) } else { (bounds.min[axis], bounds.max[axis]) };
            let [first, last] = [first - self.wide_eye[0][axis], last - self.wide_eye[1][axis]];
            // What is not a number says nothing.
            let enter = (first * least).min(first * greatest);
            let leave = (last * least).max(last * greatest);
            if enter > near {
                near = enter;
            }
            if leave < far {
                far = leave;
            }
        }
        near > far
    }
}

/// Makes the tree of bundles over a packet, the whole packet first.
pub(super) fn bundles(packet: &EyePacket, rays: &[Ready], split: bool, list: &mut Vec<Bundle>) {
    list.clear();
    list.push(bundle(packet, rays, 0, rays.len()));
    if !split || !rays.len().is_power_of_two() || rays.len().trailing_zeros() % 2 == 1 {
        return;
    }
    let mut at = 0;
    while at < list.len() {
        let Bundle { first, end, .. } = list[at];
        let quarter = (end - first) / 4;
        if quarter > 0 {
            list[at].parts = list.len();
            list[at].planes = planes(packet, first, quarter);
            for part in 0..4 {
                let first = first + part * quarter;
                list.push(bundle(packet, rays, first, first + quarter));
            }
        }
        at += 1;
    }
}

fn bundle(packet: &EyePacket, rays: &[Ready], first: usize, end: usize) -> Bundle {
    let inverse = std::array::from_fn(|axis| {
        let (mut least, mut greatest) = (f32::INFINITY, f32::NEG_INFINITY);
        for ray in &rays[first..end] {
            least = least.min(ray.inverse()[axis]);
            greatest = greatest.max(ray.inverse()[axis]);
        }
        (least > 0.0 || greatest < 0.0).then_some([least, greatest])
    });
    let shifts = rays[first].shifts();
    let none = Plane { normal: [0.0; 3], parts: false };
    Bundle { first, end, parts: 0, planes: [none; 2], eye: packet.eye, inverse, wide_eye: shifts }
}

/// N_h = V_up × D_p and N_v = V_right × D_p, D_p the mean direction (Sei 2008, section 4.2.1), turned to the right and downwards.
fn planes(packet: &EyePacket, first: usize, quarter: usize) -> [Plane; 2] {
    let direction = |i: usize| Vec3::from(packet.directions[first + i]);
    let mean: Vec3 = (0..4 * quarter).map(direction).sum();
    let [right, up] = packet.screen.map(Vec3::from);
    let turned = |normal: Vec3, towards: Vec3| if normal.dot(towards) < 0.0 { -normal } else { normal };
    let normals = [turned(up.cross(mean), right), turned(right.cross(mean), -up)];
    std::array::from_fn(|k| {
        let normal = normals[k].normalize_or_zero();
        let parts = (0..4 * quarter).all(|i| {
            let side = normal.dot(direction(i));
            if (i / quarter) >> k & 1 == 1 { side >= 0.0 } else { side <= 0.0 }
        });
        Plane { normal: normal.to_array(), parts: parts && normal != Vec3::ZERO }
    })
}
