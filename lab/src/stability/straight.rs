//! Straight rays: those that go through corners and edges of closed bodies, from outside to the middle. None may get in without a hit.

use glam::Vec3;

use super::Finding;
use crate::bvh::others::{Obvhs, Svenstaro};
use crate::straight::scenes::{Triangle, bunny::ball};
use crate::straight::{Hit, Packets, Ray, Wide};

/// Balls of twenty times the square of the frequency triangles: where, and how large.
const PLACES: [(&str, usize, [f32; 3], f32); 4] = [
    ("corners and edges of an icosahedron", 1, [0.0; 3], 1.0),
    ("corners and edges of a ball of 1,280 triangles", 8, [0.0; 3], 1.0),
    ("the same of 0.3, 33 from the origin", 8, [30.0, -7.0, 11.0], 0.3),
    ("the same of 10⁴", 8, [0.0; 3], 1e4),
];

/// Through every corner and the middle of every edge, from three radii away through the middle, and from beside it.
fn rays(triangles: &[Triangle], centre: Vec3) -> Vec<Ray> {
    let mut rays = Vec::new();
    for corners in triangles {
        let [a, b, c] = corners.map(Vec3::from);
        for target in [a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)] {
            let outside = centre + (target - centre) * 3.0;
            rays.push(Ray::new(outside.to_array(), (centre - outside).to_array()));
            let inside = centre + (target - centre).cross(Vec3::new(0.3, 0.2, 0.1)) * 0.5;
            rays.push(Ray::new(inside.to_array(), (target - inside).to_array()));
        }
    }
    rays
}

/// A finding for each tracer and place.
pub fn measure() -> Vec<Finding> {
    let mut found = Vec::new();
    for (place, frequency, centre, radius) in PLACES {
        let triangles = ball(frequency, centre.into(), radius);
        let rays = rays(&triangles, centre.into());
        let wide = Wide::new(&triangles);
        let mut single = vec![Hit::MISS; rays.len()];
        wide.closest_each(&rays, &mut single);
        let mut packets = vec![Hit::MISS; rays.len()];
        wide.closest_packet(&rays, &mut packets, &mut Packets::default());
        let (obvhs, other) = (Obvhs::new(&triangles), Svenstaro::new(&triangles));
        let hits = [
            ("tree of eight", true, single),
            ("hull packets", true, packets),
            ("obvhs", false, rays.iter().map(|ray| obvhs.closest(ray)).collect()),
            ("bvh", false, rays.iter().map(|ray| other.closest(ray)).collect()),
        ];
        for (method, ours, hits) in hits {
            let missed = hits.iter().filter(|hit| !hit.is_hit()).count();
            found.push(Finding {
                part: "straight rays",
                place,
                method: method.to_owned(),
                ours,
                value: 100.0 * missed as f64 / rays.len() as f64,
                unit: "% leak",
                limit: 0.0,
            });
        }
    }
    found
}
