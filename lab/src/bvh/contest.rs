//! Who takes part, and with which rays.

use super::others::{Obvhs, Svenstaro};
use super::rays::{Job, SIZES, Trace};
use crate::chart::ChartError;
use crate::straight::{BvhSettings, EyePacket, EyePackets, Hit, Mesh, Packets, Ray, Wide, order};

/// All trees over one scene.
pub struct Built {
    pub mesh: Mesh,
    pub wide: Wide,
    pub obvhs: Obvhs,
    pub svenstaro: Svenstaro,
    #[cfg(feature = "embree")]
    pub embree: super::embree::Embree,
}

impl Built {
    pub fn new(job: &Job) -> Result<Built, ChartError> {
        let triangles = &job.scene.triangles;
        Ok(Built {
            mesh: Mesh::new(triangles, &BvhSettings::default()),
            wide: Wide::new(triangles),
            obvhs: Obvhs::new(triangles),
            svenstaro: Svenstaro::new(triangles),
            #[cfg(feature = "embree")]
            embree: super::embree::Embree::new(triangles).map_err(|error| ChartError::Failed(error.to_string()))?,
        })
    }
}

/// One method with one set of rays.
pub struct Entry<'a> {
    /// primary, shadow, mirrored, scattered.
    pub kind: &'static str,
    pub method: &'static str,
    /// The edge of its packets in pixels; 1 for single rays.
    pub packet: usize,
    /// How many rays one run traces.
    pub rays: usize,
    /// The pixel of each ray, where they are not in rows.
    pub pixels: Vec<u32>,
    pub trace: Trace<'a>,
}

/// Ray by ray.
fn each<'a>(rays: &'a [Ray], trace: impl Fn(&Ray) -> Hit + 'a) -> Trace<'a> {
    Box::new(move |hits| rays.iter().zip(hits).for_each(|(ray, hit)| *hit = trace(ray)))
}

/// Everybody. Rays are made before; what a method derives from them (reciprocals, hulls, planes) is in its time, as is writing the hits.
pub fn entries<'a>(job: &'a Job, built: &'a Built) -> Vec<Entry<'a>> {
    let mut all = primary(job, built);
    job.secondary.iter().for_each(|(kind, rays)| secondary(kind, rays, built, &mut all));
    all
}

/// Rays from the eye.
fn primary<'a>(job: &'a Job, built: &'a Built) -> Vec<Entry<'a>> {
    let mut all = Vec::new();
    let rays = &job.primary;
    let mut add = |method, packet, pixels, trace| all.push(Entry { kind: "primary", method, packet, rays: rays.len(), pixels, trace });
    let tiled = |(pixels, starts): (Vec<u32>, Vec<usize>)| {
        let rays: Vec<Ray> = pixels.iter().map(|&i| rays[i as usize]).collect();
        (pixels, rays, starts)
    };
    add("obvhs", 1, Vec::new(), each(rays, |ray| built.obvhs.closest(ray)));
    add("bvh", 1, Vec::new(), each(rays, |ray| built.svenstaro.closest(ray)));
    #[cfg(feature = "embree")]
    for way in super::embree::WAYS {
        let (pixels, rays, starts) = tiled(order::tiles(job.size, way.tile()));
        add(way.name(), way.packet(), pixels, built.embree.trace(way, rays, starts));
    }
    add("tree of two", 1, Vec::new(), each(rays, |ray| built.mesh.closest(ray)));
    add("tree of eight", 1, Vec::new(), Box::new(|hits| built.wide.closest_each(rays, hits)));
    for size in SIZES {
        for (splits, method) in ["Wald", "split 4", "split 16"].into_iter().enumerate() {
            let (pixels, rays, starts) = tiled(order::squares(job.size, size));
            add(method, size, pixels, paper(job, built, &rays, starts, splits as u32));
        }
        let (pixels, rays, starts) = tiled(order::tiles(job.size, size));
        add("ours", size, pixels, packets(&built.wide, rays, starts));
    }
    all
}

/// Rays on from the first hits. Of shadow rays it is asked only whether they meet anything, but for our packets.
fn secondary<'a>(kind: &'static str, rays: &'a [Ray], built: &'a Built, all: &mut Vec<Entry<'a>>) {
    let mut add = |method, packet, trace| all.push(Entry { kind, method, packet, rays: rays.len(), pixels: Vec::new(), trace });
    let shadow = kind == "shadow";
    add("obvhs", 1, if shadow { each(rays, |ray| built.obvhs.any(ray)) } else { each(rays, |ray| built.obvhs.closest(ray)) });
    #[cfg(feature = "embree")]
    add("Embree", 1, if shadow { built.embree.any(rays.to_vec()) } else { built.embree.single(rays.to_vec(), false) });
    let wide = &built.wide;
    let single: Trace = if shadow { Box::new(|hits| wide.any_each(rays, hits)) } else { Box::new(|hits| wide.closest_each(rays, hits)) };
    add("tree of eight", 1, single);
    let starts = (0..rays.len()).step_by(1024).chain([rays.len()]).collect();
    add("ours", 32, packets(wide, rays.to_vec(), starts));
}

/// Rays in the order of packets, with the places where packets begin.
fn packets(wide: &Wide, rays: Vec<Ray>, starts: Vec<usize>) -> Trace<'_> {
    let mut scratch = Packets::default();
    Box::new(move |hits| {
        for run in starts.windows(2) {
            wide.closest_packet(&rays[run[0]..run[1]], &mut hits[run[0]..run[1]], &mut scratch);
        }
    })
}

/// The packets of Wald et al. 2007 and those of Sei 2008.
fn paper<'a>(job: &'a Job, built: &'a Built, rays: &[Ray], starts: Vec<usize>, splits: u32) -> Trace<'a> {
    let directions: Vec<[f32; 3]> = rays.iter().map(|ray| ray.direction).collect();
    let eye = rays.first().map_or([0.0; 3], |ray| ray.origin);
    let mut scratch = EyePackets::default();
    Box::new(move |hits| {
        for run in starts.windows(2) {
            let packet = EyePacket { eye, directions: &directions[run[0]..run[1]], screen: job.screen };
            built.mesh.closest_packet(&packet, splits, &mut hits[run[0]..run[1]], &mut scratch);
        }
    })
}
