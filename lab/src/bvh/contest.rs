//! Who takes part, and with which rays.

use super::others::{Obvhs, Svenstaro, bearable, within};
use super::rays::{Job, SIZES, tiled};
use super::request::ChartError;
use crate::straight::{EyePacket, EyePackets, Hit, Mesh, Packets, Ray, Settings, Wide, order};

/// All trees over one scene.
pub struct Built {
    pub mesh: Mesh,
    pub wide: Wide,
    /// None where its tree or its rays take too long.
    pub obvhs: Option<Obvhs>,
    /// The same.
    pub svenstaro: Option<Svenstaro>,
    #[cfg(feature = "embree")]
    pub embree: super::embree::Embree,
}

impl Built {
    pub fn new(job: &Job) -> Result<Built, ChartError> {
        let triangles = &job.scene.triangles;
        let scene = job.scene.name;
        let obvhs = within(scene, "obvhs", triangles, Obvhs::new);
        let svenstaro = within(scene, "bvh", triangles, Svenstaro::new);
        Ok(Built {
            mesh: Mesh::new(triangles, &Settings::default()),
            wide: Wide::new(triangles),
            obvhs: obvhs.filter(|tree| bearable(scene, "obvhs", &job.primary, |ray| tree.closest(ray))),
            svenstaro: svenstaro.filter(|tree| bearable(scene, "bvh", &job.primary, |ray| tree.closest(ray))),
            #[cfg(feature = "embree")]
            embree: super::embree::Embree::new(triangles)?,
        })
    }
}

/// One method with one set of rays.
pub struct Entry<'a> {
    /// primary, walking, shadow, mirrored, scattered.
    pub kind: &'static str,
    pub method: String,
    /// The edge of its packets in pixels; 1 for single rays.
    pub packet: usize,
    /// How many rays one run traces.
    pub rays: usize,
    /// Traces them and says how many hit.
    pub run: Box<dyn FnMut() -> usize + 'a>,
}

impl<'a> Entry<'a> {
    fn new(kind: &'static str, method: &str, packet: usize, rays: usize, run: Box<dyn FnMut() -> usize + 'a>) -> Entry<'a> {
        Entry { kind, method: method.to_owned(), packet, rays, run }
    }
}

fn count(hits: &[Hit]) -> usize {
    hits.iter().filter(|hit| hit.is_hit()).count()
}

/// Runs that write hits for a fixed list of rays.
fn each<'a>(rays: &'a [Ray], trace: impl Fn(&Ray) -> Hit + 'a) -> Box<dyn FnMut() -> usize + 'a> {
    let mut hits = vec![Hit::MISS; rays.len()];
    Box::new(move || {
        for (ray, hit) in rays.iter().zip(&mut hits) {
            *hit = trace(ray);
        }
        count(&hits)
    })
}

/// Runs that write their hits themselves.
#[cfg(feature = "embree")]
fn counted<'a>(number: usize, mut trace: super::embree::Trace) -> Box<dyn FnMut() -> usize + 'a> {
    let mut hits = vec![Hit::MISS; number];
    Box::new(move || {
        trace(&mut hits);
        count(&hits)
    })
}

/// Everybody. Rays are made before; what a method derives from them (reciprocals, hulls, planes) is in its time, as is writing the hits.
pub fn entries<'a>(job: &'a Job, built: &'a Built) -> Vec<Entry<'a>> {
    let mut all = primary(job, built);
    all.extend(walking(job, built));
    for (kind, rays) in &job.secondary {
        all.extend(secondary(kind, rays, built));
    }
    all
}

/// Rays from the eye.
fn primary<'a>(job: &'a Job, built: &'a Built) -> Vec<Entry<'a>> {
    let mut all = Vec::new();
    let rays = &job.primary;
    let mut add = |method: &str, packet, run| all.push(Entry::new("primary", method, packet, rays.len(), run));
    if let Some(tree) = &built.obvhs {
        add("obvhs", 1, each(rays, |ray| tree.closest(ray)));
    }
    if let Some(tree) = &built.svenstaro {
        add("bvh", 1, each(rays, |ray| tree.closest(ray)));
    }
    #[cfg(feature = "embree")]
    for way in super::embree::WAYS {
        let (tiles, starts) = tiled(rays, job.size, way.tile());
        add(way.name(), way.packet(), counted(rays.len(), built.embree.trace(way, tiles, starts)));
    }
    add("tree of two", 1, each(rays, |ray| built.mesh.closest(ray)));
    add("tree of eight", 1, singles(&built.wide, rays));
    for size in SIZES {
        for (splits, method) in ["Wald", "split 4", "split 16"].into_iter().enumerate() {
            add(method, size, paper(job, built, rays, size, splits as u32));
        }
        add("ours", size, packets(&built.wide, vec![tiled(rays, job.size, size)]));
    }
    all
}

/// One frame of the walk a run: everything that depends on the camera is made anew.
fn walking<'a>(job: &'a Job, built: &'a Built) -> [Entry<'a>; 2] {
    let entry = |method: &str, run| Entry::new("walking", method, 64, job.primary.len(), run);
    let walk = job.walk.iter().map(|rays| tiled(rays, job.size, 64)).collect();
    let ours = packets(&built.wide, walk);
    let frames = job.walk.len();
    let mut papers: Vec<_> = job.walk.iter().map(|rays| paper(job, built, rays, 64, 2)).collect();
    let mut step = 0;
    let walking = move || {
        step += 1;
        papers[step % frames]()
    };
    [entry("ours", ours), entry("split 16", Box::new(walking))]
}

/// Rays on from the first hits. Of shadow rays it is asked only whether they meet anything, but for our packets.
fn secondary<'a>(kind: &'static str, rays: &'a [Ray], built: &'a Built) -> Vec<Entry<'a>> {
    let mut all = Vec::new();
    let mut add = |method: &str, packet, run| all.push(Entry::new(kind, method, packet, rays.len(), run));
    let shadow = kind == "shadow";
    if let Some(tree) = &built.obvhs {
        let obvhs: Box<dyn FnMut() -> usize> =
            if shadow { Box::new(|| rays.iter().filter(|ray| tree.occluded(ray)).count()) } else { each(rays, |ray| tree.closest(ray)) };
        add("obvhs", 1, obvhs);
    }
    #[cfg(feature = "embree")]
    if shadow {
        add("Embree", 1, built.embree.occluded(rays.to_vec()));
    } else {
        add("Embree", 1, counted(rays.len(), built.embree.single(rays.to_vec(), false)));
    }
    let single = if shadow { any(&built.wide, rays) } else { singles(&built.wide, rays) };
    add("tree of eight", 1, single);
    let starts = (0..rays.len()).step_by(1024).chain([rays.len()]).collect();
    add("ours", 32, packets(&built.wide, vec![(rays.to_vec(), starts)]));
    all
}

/// Whether each ray meets anything, ray by ray.
fn any<'a>(wide: &'a Wide, rays: &'a [Ray]) -> Box<dyn FnMut() -> usize + 'a> {
    let mut hits = vec![Hit::MISS; rays.len()];
    Box::new(move || {
        wide.any_each(rays, &mut hits);
        count(&hits)
    })
}

fn singles<'a>(wide: &'a Wide, rays: &'a [Ray]) -> Box<dyn FnMut() -> usize + 'a> {
    let mut hits = vec![Hit::MISS; rays.len()];
    Box::new(move || {
        wide.closest_each(rays, &mut hits);
        count(&hits)
    })
}

/// Frames of rays in the order of packets, with the places where packets begin; each run traces the next frame.
fn packets<'a>(wide: &'a Wide, frames: Vec<(Vec<Ray>, Vec<usize>)>) -> Box<dyn FnMut() -> usize + 'a> {
    let mut hits = vec![Hit::MISS; frames[0].0.len()];
    let mut scratch = Packets::default();
    let mut step = 0;
    Box::new(move || {
        step += 1;
        let (rays, starts) = &frames[step % frames.len()];
        for run in starts.windows(2) {
            wide.closest_packet(&rays[run[0]..run[1]], &mut hits[run[0]..run[1]], &mut scratch);
        }
        count(&hits)
    })
}

/// The packets of Wald et al. 2007 and those of Sei 2008.
fn paper<'a>(job: &'a Job, built: &'a Built, rays: &[Ray], size: usize, splits: u32) -> Box<dyn FnMut() -> usize + 'a> {
    let (pixels, starts) = order::squares(job.size, size);
    let directions: Vec<[f32; 3]> = pixels.iter().map(|&i| rays[i as usize].direction).collect();
    let eye = rays.first().map_or([0.0; 3], |ray| ray.origin);
    let mut hits = vec![Hit::MISS; directions.len()];
    let mut scratch = EyePackets::default();
    Box::new(move || {
        for run in starts.windows(2) {
            let packet = EyePacket { eye, directions: &directions[run[0]..run[1]], screen: job.screen };
            built.mesh.closest_packet(&packet, splits, &mut hits[run[0]..run[1]], &mut scratch);
        }
        count(&hits)
    })
}
