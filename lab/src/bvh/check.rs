//! Hit by hit: every method against every other, and against brute force in f64.

use glam::Vec3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::contest::Built;
use super::rays::{Job, SIZES, tiled};
use super::request::ChartError;
use crate::straight::scenes::Triangle;
use crate::straight::{EyePacket, EyePackets, Hit, Packets, Ray, order};

/// Rays that are tried against every triangle.
const SAMPLE: usize = 2000;

/// Checks one scene, says on stderr what it found, and returns the number of hits that are wrong.
pub fn check(job: &Job) -> Result<usize, ChartError> {
    let built = Built::new(job)?;
    let single: Vec<Hit> = job.primary.iter().map(|ray| built.mesh.closest(ray)).collect();
    let differ = primary_that_differ(job, &built, &single) + secondary_that_differ(job, &built);
    Ok(differ + wrong_by_brute_force(job, &built, &single))
}

/// How many hits of our methods are not those of `single` rays, bit for bit.
fn primary_that_differ(job: &Job, built: &Built, single: &[Hit]) -> usize {
    let mut all = 0;
    for (name, hits) in ours(job, built) {
        let differ = differences(&hits, single);
        if differ > 0 {
            eprintln!("{}: {name}: {differ} of {} rays differ from single rays", job.scene.name, single.len());
        }
        all += differ;
    }
    all
}

/// How many hits of rays that go on from the first hits differ between packets and single rays.
fn secondary_that_differ(job: &Job, built: &Built) -> usize {
    let mut all = 0;
    for (kind, rays) in &job.secondary {
        let single: Vec<Hit> = rays.iter().map(|ray| built.mesh.closest(ray)).collect();
        let mut hits = vec![Hit::MISS; rays.len()];
        let mut packets = Packets::default();
        for (rays, hits) in rays.chunks(1024).zip(hits.chunks_mut(1024)) {
            built.wide.closest_packet(rays, hits, &mut packets);
        }
        let differ = differences(&hits, &single);
        eprintln!("{}: {kind}: {differ} of {} rays differ between packets and single rays", job.scene.name, rays.len());
        all += differ;
    }
    all
}

fn differences(hits: &[Hit], others: &[Hit]) -> usize {
    hits.iter().zip(others).filter(|(a, b)| a != b).count()
}

/// How many of our hits are wrong, of some rays and of all where others meet another triangle: they may, by rounding.
fn wrong_by_brute_force(job: &Job, built: &Built, single: &[Hit]) -> usize {
    let theirs = theirs(job, built);
    let disputed = disputed(job, single, &theirs);
    let random = &mut StdRng::seed_from_u64(9);
    let mut judged: Vec<usize> = (0..SAMPLE).map(|_| random.random_range(0..single.len())).collect();
    judged.extend(&disputed);
    let (mut within, mut wrong) = (0, 0);
    let mut their_wrong = vec![0; theirs.len()];
    for &i in &judged {
        let (ray, own) = (&job.primary[i], single[i]);
        match verdict(&job.scene.triangles, ray, own) {
            Verdict::Right => (),
            Verdict::Rounding => within += 1,
            Verdict::Wrong => {
                eprintln!("{}: {ray:?}: {own:?} is wrong", job.scene.name);
                wrong += 1;
            }
        }
        // What differs from ours is judged for itself; what does not was judged with it.
        for ((_, hits), wrong) in theirs.iter().zip(&mut their_wrong) {
            let same = hits[i].triangle == own.triangle;
            *wrong += usize::from(!same && verdict(&job.scene.triangles, ray, hits[i]) == Verdict::Wrong);
        }
    }
    let theirs: Vec<String> = theirs.iter().zip(their_wrong).map(|((name, _), wrong)| format!("{name} on {wrong}")).collect();
    eprintln!(
        "{}: of {} rays tried against every triangle in f64 ({} disputed) ours differs on {within} within rounding, is wrong on {wrong}; {}",
        job.scene.name,
        judged.len(),
        disputed.len(),
        theirs.join(", "),
    );
    wrong
}

/// The rays for which another meets another triangle, in order. Says how many they are for each.
fn disputed(job: &Job, single: &[Hit], theirs: &[(String, Vec<Hit>)]) -> Vec<usize> {
    let mut disputed: Vec<usize> = Vec::new();
    for (name, hits) in theirs {
        let others: Vec<usize> = (0..single.len()).filter(|&i| hits[i].triangle != single[i].triangle).collect();
        let clear = others.iter().filter(|&&i| !together(hits[i], single[i])).count();
        eprintln!(
            "{}: {name}: another triangle at {} of {} rays, {clear} of them not at the same place",
            job.scene.name,
            others.len(),
            single.len()
        );
        disputed.extend(others);
    }
    disputed.sort_unstable();
    disputed.dedup();
    disputed
}

/// Hits of the others in the order of pixels.
fn theirs(job: &Job, built: &Built) -> Vec<(String, Vec<Hit>)> {
    #[allow(unused_mut)]
    let mut all: Vec<(String, Vec<Hit>)> =
        built.obvhs.iter().map(|tree| ("obvhs".to_owned(), job.primary.iter().map(|ray| tree.closest(ray)).collect())).collect();
    #[cfg(feature = "embree")]
    for way in super::embree::WAYS {
        let (rays, starts) = tiled(&job.primary, job.size, way.tile());
        let (pixels, _) = order::tiles(job.size, way.tile());
        let mut found = vec![Hit::MISS; rays.len()];
        built.embree.trace(way, rays, starts)(&mut found);
        let mut hits = vec![Hit::MISS; found.len()];
        for (pixel, hit) in pixels.into_iter().zip(found) {
            hits[pixel as usize] = hit;
        }
        all.push((format!("{} {}", way.name(), way.packet()), hits));
    }
    all
}

/// Whether both missed, or met something within rounding of the same place.
fn together(a: Hit, b: Hit) -> bool {
    if a.is_hit() && b.is_hit() { (a.t - b.t).abs() <= 2e-5 * (1.0 + a.t) } else { a.is_hit() == b.is_hit() }
}

fn ours(job: &Job, built: &Built) -> Vec<(String, Vec<Hit>)> {
    let rays = &job.primary;
    let mut each = vec![Hit::MISS; rays.len()];
    built.wide.closest_each(rays, &mut each);
    let mut all = vec![("tree of eight".to_owned(), each)];
    for size in SIZES.into_iter().chain([1]) {
        let mut hits = vec![Hit::MISS; rays.len()];
        let (tiles, starts) = tiled(rays, job.size, size);
        let (pixels, _) = order::tiles(job.size, size);
        let mut packets = Packets::default();
        for run in starts.windows(2) {
            let mut found = vec![Hit::MISS; run[1] - run[0]];
            built.wide.closest_packet(&tiles[run[0]..run[1]], &mut found, &mut packets);
            for (&pixel, hit) in pixels[run[0]..run[1]].iter().zip(found) {
                hits[pixel as usize] = hit;
            }
        }
        all.push((format!("ours {size}"), hits));
        for splits in 0..=2 {
            let (pixels, starts) = order::squares(job.size, size);
            let mut hits = vec![Hit::MISS; rays.len()];
            let mut scratch = EyePackets::default();
            for run in starts.windows(2) {
                let pixels = &pixels[run[0]..run[1]];
                let directions: Vec<_> = pixels.iter().map(|&i| rays[i as usize].direction).collect();
                let mut found = vec![Hit::MISS; pixels.len()];
                let packet = EyePacket { eye: rays[0].origin, directions: &directions, screen: job.screen };
                built.mesh.closest_packet(&packet, splits, &mut found, &mut scratch);
                for (&pixel, hit) in pixels.iter().zip(found) {
                    hits[pixel as usize] = hit;
                }
            }
            all.push((format!("{splits} splits, {size}"), hits));
        }
    }
    all
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    Right,
    /// Another triangle at the same place, or an edge passed within rounding of f32.
    Rounding,
    Wrong,
}

/// Tries every triangle in f64 (Möller–Trumbore).
fn verdict(triangles: &[Triangle], ray: &Ray, hit: Hit) -> Verdict {
    let (origin, direction) = (Vec3::from(ray.origin).as_dvec3(), Vec3::from(ray.direction).as_dvec3());
    let (mut best, mut number, mut margin) = (f64::INFINITY, Hit::NONE, f64::INFINITY);
    for (i, corners) in triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|p| Vec3::from(p).as_dvec3());
        let (along, across, from) = (b - a, c - a, origin - a);
        let p = direction.cross(across);
        let q = from.cross(along);
        let whole = along.dot(p);
        let (u, v, t) = (from.dot(p) / whole, direction.dot(q) / whole, across.dot(q) / whole);
        let least = u.min(v).min(1.0 - u - v);
        // Not a number where the triangle is seen edge-on.
        if least.is_nan() || !(0.0..=f64::from(ray.until)).contains(&t) {
            continue;
        }
        if t <= best * (1.0 + 1e-6) || i as u32 == hit.triangle {
            margin = margin.min(least.abs());
        }
        if least >= 0.0 && t < best {
            (best, number) = (t, i as u32);
        }
    }
    let near = hit.is_hit() && (f64::from(hit.t) - best).abs() <= 2e-5 * (1.0 + best);
    if hit.triangle == number && (near || !hit.is_hit()) {
        Verdict::Right
    } else if near || margin < 1e-3 {
        Verdict::Rounding
    } else {
        Verdict::Wrong
    }
}
