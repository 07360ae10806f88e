//! What a frame needs to know of the disk, in f64: its axes as the camera sees them, the circles to draw in each order, the streaks' generations.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::lensing::Slice;
use crate::lensing::lookup::lens_lookup_at;
use crate::render::frame::{Camera, FrameInput};
use crate::scene::disk::{DISK_UNIT, RENEWAL, SHEARED};

use super::Disk;
use super::types::{Circle, DiskFrame};

/// Least |sine| of the camera's height over the plane. In the plane itself the disk is seen edge on and its image has no width.
const LEAST_HEIGHT: f64 = 1e-5;
/// Rings whose images are narrower than this where they are widest, in pixels, are drawn together: between two circles the place in the gas goes
/// straight, which is off by an eighth of the square of a ring's share of the radius, under half a pixel for such rings. A rasteriser works in
/// squares of pixels, and narrower triangles leave most of each empty.
const LEAST_RING: f64 = 12.0;
/// The same for the length of an arc, on the outermost circle: halving finds what is lost.
const LEAST_ARC: f64 = 32.0;
/// Nearer to the disk than this, in r_s, its finest octaves are seen: their smallest cells are 0.006 r wide.
const CLOSE: f64 = 4.0;
/// Longest light path past the hole, for orders up to 3, over that of light that goes straight, in r_s.
const DETOUR: f64 = 60.0;

/// The disk as one frame's camera sees it.
#[derive(Clone, Debug)]
pub struct DiskView {
    /// For the shaders; the arc pass fills in the places in its buffers.
    pub frame: DiskFrame,
    /// Rows of all orders.
    pub circles: Vec<Circle>,
    /// θ of the cuts, in rad.
    pub cuts: Vec<f32>,
    /// Rows on either side of each ring, and its order.
    pub rings: Vec<[u32; 4]>,
    /// Whether the camera is so near that fine structure is seen.
    pub close: bool,
}

impl DiskView {
    /// For the camera and time of `input` and a picture `width` pixels wide.
    pub fn new(disk: &Disk, input: &FrameInput, slice: &Slice, width: u32) -> DiskView {
        let camera = &input.camera;
        let l = camera.radius();
        let n = camera.position / l;
        let height = if n.z.abs() < LEAST_HEIGHT { LEAST_HEIGHT.copysign(n.z) } else { n.z };
        let towards = DVec3::new(n.x, n.y, 0.0).try_normalize().unwrap_or(DVec3::X);
        let sideways = DVec3::Z.cross(towards);
        let level = (1.0 - n.z * n.z).max(0.0).sqrt();
        let upwards = DVec3::Z * level - towards * n.z;
        let [_, end] = disk.gas.extent();
        let origin = towards.y.atan2(towards.x);

        let mut circles = Vec::new();
        let mut rings = Vec::new();
        for order in 1..=input.settings.orders.min(3) {
            let chosen = chosen_rings(disk, camera, slice, width, order);
            let first = circles.len() as u32;
            let (rows, pairs) = rows_of(disk, chosen);
            let last = first + rows.len() as u32 - 1;
            circles.extend(rows.into_iter().map(|r| circle(disk, r, level, l, [order, first, last, 0])));
            rings.extend(pairs.into_iter().map(|[a, b]| [first + a, first + b, order, 0]));
        }

        // Streaks: time at the camera counted from the first generation that can be seen.
        let nearest = (l - end).max(0.0);
        let base = ((input.time - nearest - 2.0 * end - DETOUR) / RENEWAL).floor() - 1.0;
        let offsets = std::array::from_fn(|k| {
            let [x, y] = disk.gas.offset(base as i64 + k as i64);
            [x as f32, y as f32, 0.0, 0.0]
        });
        let cuts = chosen_cuts(disk, camera, width);
        let row = |v: DVec3, w: f64| [v.x as f32, v.y as f32, v.z as f32, w as f32];
        let close = camera.position.z.abs() < CLOSE && l < end + CLOSE;
        DiskView {
            frame: DiskFrame {
                towards: row(towards, height),
                sideways: row(sideways, level),
                upwards: row(upwards, height.abs()),
                renewal: [(input.time / RENEWAL - base) as f32, (1.0 / RENEWAL) as f32, RENEWAL as f32, SHEARED as f32],
                gas: [disk.gas.contrast as f32, 0.0, disk.config.error_budget as f32, disk.min_width as f32],
                sizes: [2 * cuts.len() as u32 - 1, cuts.len() as u32 - 1, circles.len() as u32, rings.len() as u32],
                regions: [0; 4],
                room: [0, u32::from(close), (disk.gas.thickness as f32).to_bits(), 0],
                sprites: [(0.7 * disk.sprite_radius()) as f32, DISK_UNIT as f32, 0.0, 0.0],
                offsets,
            },
            circles,
            cuts: cuts.iter().map(|azimuth| (azimuth - origin) as f32).collect(),
            rings,
            close,
        }
    }
}

/// The radii to draw and the pairs of them with gas between, for `count` rings.
fn rows_of(disk: &Disk, count: usize) -> (Vec<f64>, Vec<[u32; 2]>) {
    let all = disk.arcs.rings.len();
    if count >= all || disk.config.gap > 0.0 {
        return (disk.arcs.circles.clone(), disk.arcs.rings.clone());
    }
    let rows = (0..=count).map(|k| disk.arcs.circles[k * all / count]).collect();
    (rows, (0..count as u32).map(|k| [k, k + 1]).collect())
}

/// The cuts between arcs long enough to be told apart.
fn chosen_cuts(disk: &Disk, camera: &Camera, width: u32) -> Vec<f64> {
    let all = disk.arcs.cuts.len() - 1;
    let [_, end] = disk.gas.extent();
    let l = camera.radius();
    if l < 1.5 * end {
        return disk.arcs.cuts.clone();
    }
    let pixel = 2.0 * (0.5 * camera.field_of_view).tan() / f64::from(width.max(1));
    let round = TAU * end / l / pixel / LEAST_ARC;
    let count = (round.ceil() as usize).clamp(16.min(all), all);
    (0..=count).map(|k| disk.arcs.cuts[k * all / count]).collect()
}

/// How many rings of an order are wide enough to be told apart.
fn chosen_rings(disk: &Disk, camera: &Camera, slice: &Slice, width: u32, order: u32) -> usize {
    let all = disk.arcs.rings.len();
    let [start, end] = disk.gas.extent();
    let l = camera.radius();
    if order == 1 && l < 1.5 * end {
        return all;
    }
    let n = camera.position / l;
    let level = (1.0 - n.z * n.z).max(0.0).sqrt();
    let pixel = 2.0 * (0.5 * camera.field_of_view).tan() / f64::from(width.max(1));
    let psi = |r: f64, theta: f64| {
        let (sine, cosine) = theta.sin_cos();
        let (along, across) = (r * cosine * level, r * (n.z * cosine).hypot(sine));
        let ray = lens_lookup_at(slice, (along - l) as f32, across as f32, along as f32, order);
        f64::from(ray.sin_psi).atan2(f64::from(ray.cos_psi))
    };
    let widest =
        (0..12).map(|k| TAU * (f64::from(k) + 0.5) / 12.0).map(|theta| (psi(start, theta) - psi(end, theta)).abs()).fold(0.0, f64::max);
    // Aberration can make it twice as wide.
    let rings = (2.0 * widest / pixel / LEAST_RING).ceil();
    if rings.is_finite() { (rings as usize).clamp(4.min(all), all) } else { all }
}

fn circle(disk: &Disk, r: f64, level: f64, l: f64, rows: [u32; 4]) -> Circle {
    let radial = &disk.gas.radial;
    let [outward, along] = radial.momentum(r);
    let pattern = radial.pattern_radius(r).ln() / crate::scene::disk::PATTERN_HEIGHT;
    Circle {
        gas: [r as f32, radial.lag(r) as f32, radial.temperature(r).ln() as f32, radial.depth(r) as f32],
        motion: [outward as f32, along as f32, disk.gas.half_height(r) as f32, pattern as f32],
        place: [(r * level - l) as f32, 0.0, 0.0, 0.0],
        rows,
    }
}
