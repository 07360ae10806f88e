//! Hit by hit: every method against every other, and against brute force in f64.

use glam::Vec3;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::contest::{Built, Entry, entries};
use super::rays::Job;
use crate::chart::ChartError;
use crate::straight::scenes::Triangle;
use crate::straight::{Hit, Ray};

/// Rays that are tried against every triangle.
const SAMPLE: usize = 2000;

/// A method and its hits, in the order of pixels.
type Found = (String, Vec<Hit>);

/// Checks one scene, says on stderr what it found, and returns the number of hits that are wrong.
pub fn check(job: &Job) -> Result<usize, ChartError> {
    let built = Built::new(job)?;
    let closest = |rays: &[Ray]| -> Vec<Hit> { rays.iter().map(|ray| built.mesh.closest(ray)).collect() };
    let single = closest(&job.primary);
    let (mut theirs, mut differ): (Vec<Found>, usize) = (Vec::new(), 0);
    for entry in &mut entries(job, &built) {
        let name = format!("{} {}, {}", entry.method, entry.packet, entry.kind);
        let is_theirs = entry.method == "obvhs" || entry.method.starts_with("Embree");
        if entry.kind == "primary" && is_theirs {
            theirs.push((name, hits_of(entry)));
        } else if (entry.kind == "primary" && entry.method != "bvh") || entry.method == "ours" {
            let rays = job.secondary.iter().find(|(kind, _)| *kind == entry.kind).map(|(_, rays)| closest(rays));
            let expected = rays.as_ref().unwrap_or(&single);
            let others = hits_of(entry).iter().zip(expected).filter(|(a, b)| a != b).count();
            eprintln!("{}: {name}: {others} of {} rays differ from single rays", job.scene.name, expected.len());
            differ += others;
        }
    }
    Ok(differ + wrong_by_brute_force(job, &single, &theirs))
}

fn hits_of(entry: &mut Entry) -> Vec<Hit> {
    let mut found = vec![Hit::MISS; entry.rays];
    (entry.trace)(&mut found);
    let mut hits = found.clone();
    entry.pixels.iter().zip(found).for_each(|(&pixel, hit)| hits[pixel as usize] = hit);
    hits
}

/// How many of our hits are wrong, of some rays and of all where others meet another triangle: they may, by rounding.
fn wrong_by_brute_force(job: &Job, single: &[Hit], theirs: &[Found]) -> usize {
    let disputed = disputed(job, single, theirs);
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
fn disputed(job: &Job, single: &[Hit], theirs: &[Found]) -> Vec<usize> {
    let mut disputed: Vec<usize> = Vec::new();
    for (name, hits) in theirs {
        let others: Vec<usize> = (0..single.len()).filter(|&i| hits[i].triangle != single[i].triangle).collect();
        let clear = others.iter().filter(|&&i| !together(hits[i], single[i])).count();
        let (scene, count, all) = (job.scene.name, others.len(), single.len());
        eprintln!("{scene}: {name}: another triangle at {count} of {all} rays, {clear} of them not at the same place");
        disputed.extend(others);
    }
    disputed.sort_unstable();
    disputed.dedup();
    disputed
}

/// Whether both missed, or met something within rounding of the same place.
fn together(a: Hit, b: Hit) -> bool {
    if a.is_hit() && b.is_hit() { (a.t - b.t).abs() <= 2e-5 * (1.0 + a.t) } else { a.is_hit() == b.is_hit() }
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
