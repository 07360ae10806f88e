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
    twin_out[id.x].x = lensrunner::geometry::patch::chord_error(
        twin_rows[id.x].xyz, twin_rows[id.x + 1u].xyz, twin_rows[id.x + 2u].xyz, twin_rows[id.x + 3u].xyz, twin_rows[id.x + 4u].xyz,
        lensrunner::geometry::patch::exact(),
    );";
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

/// A straight edge along x whose middle is moved, and a slack of 1e-3 along x: beside the axis rounding moves points along their ring.
#[test]
fn what_rounding_may_displace_along_the_ring_is_no_error() {
    // Displacement of the middle along the slack and across it, and four times what of it counts.
    let cases = [
        ([0.0, 0.0], 0.0),
        ([0.9e-3, 0.0], 0.0),
        ([-0.9e-3, 0.0], 0.0),
        ([3e-3, 0.0], 8e-3),
        ([0.0, 0.9e-3], 3.6e-3),
        ([0.9e-3, 1e-3], 4e-3),
    ];
    let rows: Vec<[f32; 4]> = cases
        .iter()
        .flat_map(|&([along, across], _)| {
            [-0.04, -0.02, 0.0, 0.02, 0.04].map(|x: f64| {
                let (dx, dy) = if x == 0.0 { (along, across) } else { (0.0, 0.0) };
                DVec3::new(x + dx, dy, -1.0).extend(0.0).as_vec4().to_array()
            })
        })
        .collect();
    let body = "
    if id.x % 5u != 0u { return; }
    let slack = lensrunner::geometry::patch::Slack(vec3<f32>(1.0, 0.0, 0.0), 1e-3);
    twin_out[id.x].x = lensrunner::geometry::patch::chord_error(
        twin_rows[id.x].xyz, twin_rows[id.x + 1u].xyz, twin_rows[id.x + 2u].xyz, twin_rows[id.x + 3u].xyz, twin_rows[id.x + 4u].xyz,
        slack,
    );";
    let out = run(Pass::Edges, body, [&[], &[]], &rows, 1);
    for ((moved, expected), row) in cases.iter().zip(out.chunks_exact(5)) {
        let found = f64::from(row[0][0]);
        // Measured: 3.7e-5 at most. At the quarters the slack's direction is 0.02 rad off the tangent, and so much of it counts.
        assert!((found - expected).abs() < 5e-5 + 0.01 * expected, "moved by {moved:?}: {found:.2e}, not {expected:.2e}");
    }
}
