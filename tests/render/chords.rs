//! How many segments stand for a curve: by the shipped shader.

use glam::DVec3;
use lensrunner::render::gpu::shaders::Pass;

use crate::twin::run;

/// What a chord may be off by, radians.
const ALLOWED: f64 = 1e-5;

/// A curve seen from the origin that bends most at t = `place`, over a part of about `width` of it.
fn curve(t: f64, place: f64, width: f64) -> DVec3 {
    DVec3::new(0.05 * t, 0.02 * (t - place).hypot(width), -1.0)
}

/// The greatest angle between the curve and the polyline of `n` equal segments.
fn error(n: u32, place: f64, width: f64) -> f64 {
    let at = |t: f64| curve(t, place, width).normalize();
    let places = (0..8 * n).map(|k| (k / 8, f64::from(k % 8) / 8.0));
    places
        .map(|(segment, s)| {
            let [a, b, here] = [0.0, 1.0, s].map(|s| at((f64::from(segment) + s) / f64::from(n)));
            here.angle_between(a.lerp(b, s))
        })
        .fold(0.0, f64::max)
}

#[test]
fn equal_segments_are_short_enough_where_a_curve_bends_most() {
    let cases: Vec<(f64, f64)> =
        [0.4, 1.0, 4.0].into_iter().flat_map(|width| [0.0, 0.1, 0.25, 0.5, 0.75, 1.0].map(|place| (place, width))).collect();
    let rows: Vec<[f32; 4]> = cases
        .iter()
        .flat_map(|&(place, width)| [0.0, 0.25, 0.5, 0.75, 1.0].map(|t| curve(t, place, width).extend(0.0).as_vec4().to_array()))
        .collect();
    let body = "
    if id.x % 5u != 0u { return; }
    twin_out[id.x] = vec4<f32>(chord_error(twin_rows[id.x].xyz, twin_rows[id.x + 1u].xyz, twin_rows[id.x + 2u].xyz, twin_rows[id.x + 3u].xyz,
        twin_rows[id.x + 4u].xyz), 0.0, 0.0, 0.0);";
    let out = run(Pass::Edges, body, [&[], &[]], &rows, 1);
    for (&(place, width), row) in cases.iter().zip(out.chunks_exact(5)) {
        // As `level_for` counts them.
        let n = (f64::from(row[0][0]) / ALLOWED).sqrt().ceil() as u32;
        let left = error(n, place, width) / ALLOWED;
        // Three places between the ends see half of what the curve does right at an end; where it bends evenly all of it.
        let most = if width < 1.0 { 1.6 } else { 1.1 };
        assert!(left < most, "bent at {place} over {width}: {n} segments are off by {left:.2} times what is allowed");
        // And no more than are needed.
        let wasteful = width > 1.0 && n > 2 && error(n - 2, place, width) < ALLOWED;
        assert!(!wasteful, "bent at {place} over {width}: {n} segments, two less would do");
    }
}
