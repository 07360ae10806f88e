//! The disk of polygons: rings that turn with the gas, and one annulus at rest.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use lensrunner::render::disk::DrawnDisk;
use lensrunner::render::gpu::readback;
use lensrunner::render::gpu::types::SeenVertex;
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::static_camera;
use lensrunner::scene::GameConfig;
use lensrunner::scene::disk::polygons::rings;
use lensrunner_lab::disk;

use super::{disk_with, shown};
use crate::gpu::GPU;
use crate::render_support::{camera, renderer, settings};

fn polygons(representation: &str) -> DrawnDisk {
    disk_with(|config| config.disk.representation = representation.into())
}

/// Every corner of every ring is drawn where it was when its light left it: there the exact ray through that point of the picture meets the
/// plane.
#[test]
fn a_ring_is_seen_where_it_was() {
    let size = [1280, 720];
    let mut renderer = renderer(size);
    let disk = polygons("polygons");
    let rings = rings(&disk.config, &disk.gas.radial);
    let time = 1234.5;
    renderer.set_disk(Some(disk.clone()));
    for (l, degrees) in [(27.0, 30.0), (27.0, 80.0), (7.0, 60.0)] {
        let camera = camera(l, degrees, 60f64.to_radians());
        shown(&mut renderer, camera, time, settings());
        let bytes = readback::buffer(&GPU, renderer.disk().unwrap().polygons().unwrap().seen()).unwrap();
        let vertices = bytes.chunks_exact(size_of::<SeenVertex>()).map(bytemuck::pod_read_unaligned::<SeenVertex>);
        let (mut checked, mut worst, mut farthest) = (0, 0.0f64, 0.0f64);
        for vertex in vertices.take_while(|vertex| (vertex.instance as usize) < rings.len()) {
            let ([x, y, z], delay) = (vertex.apparent.map(f64::from), f64::from(vertex.path));
            let Some(at) = camera.pixel(glam::DVec3::new(x, y, z), size) else { continue };
            let crossing = disk::exact::crossings(&disk.gas, &camera, size, at, 1);
            let Some(crossing) = crossing.first().filter(|crossing| crossing.radius < 11.9) else { continue };
            let ring = &rings[vertex.instance as usize];
            let left = time - crossing.path;
            let azimuth = TAU * f64::from(vertex.uv[0]) + ring.rate * left;
            let turned = (crossing.azimuth - azimuth + PI).rem_euclid(TAU) - PI;
            let off = (turned * crossing.radius).hypot(crossing.radius - f64::from(vertex.uv[1]));
            worst = worst.max(off);
            farthest = farthest.max((delay - crossing.path).abs());
            checked += 1;
        }
        println!("L = {l}, {degrees}°: {checked} corners off by at most {worst:.4} r_s, light paths by {farthest:.4} r_s");
        // A pixel covers 0.024 r_s of the disk from 27 r_s: an eighth of one. Measured: 7e-4.
        assert!(checked > 300 && worst < 0.003 && farthest < 0.003);
    }
}

/// Polygons carry no gas with them: whether they turn or rest, the picture is that of the gas in their places.
#[test]
fn rings_that_turn_show_the_gas_of_those_at_rest() {
    let size = [1280, 720];
    let mut renderer = renderer(size);
    for degrees in [30.0, 80.0] {
        let camera = camera(27.0, degrees, 60f64.to_radians());
        let [turning, resting] = ["polygons", "polygons-at-rest"].map(|representation| {
            let mut disk = polygons(representation);
            // Many rings, and no streaks between.
            (disk.config.polygons, disk.config.turbulence) = (5000, 0.0);
            disk.gas = lensrunner::scene::disk::Gas::new(&disk.config, GameConfig::default().hole.mass_solar);
            renderer.set_disk(Some(disk));
            shown(&mut renderer, camera, 100.0, settings())
        });
        let error = disk::compare(&turning, &resting, size, disk::peak(&resting));
        // Where those at rest are seen, and the rings all round, so are the rings: no gap opens between them. Not at the outer rim, where
        // it is dark: the corners of that are elsewhere.
        let brightest = resting.iter().map(|p| p[1]).fold(0.0, f32::max);
        let shines = |picture: &[[f32; 3]], k: usize| picture[k][1] > 0.05 * brightest;
        let width = size[0] as usize;
        let holes = (width..resting.len() - width)
            .filter(|&k| shines(&resting, k) && !shines(&turning, k))
            .filter(|&k| [k - 1, k + 1, k - width, k + width].into_iter().all(|beside| shines(&turning, beside)))
            .count();
        println!("{degrees}°: {:.1} dB, {holes} holes", error.psnr);
        assert!(holes == 0 && error.psnr > 30.0);
    }
}

/// Of a disk seen exactly edge on light comes round the hole on all sides, from the places behind it. There the axis of hole and camera
/// lies in the triangles, and no side of a turning ring may be taken for an outline.
#[test]
fn polygons_are_seen_from_within_their_plane() {
    let size = [240, 135];
    let mut renderer = renderer(size);
    let mut light = |representation: &str, height: f64| {
        renderer.set_disk(Some(polygons(representation)));
        let position = DVec3::new(0.0, -20.0, height);
        let camera = static_camera(position, -position, DVec3::Z, 60f64.to_radians());
        // The game's budget.
        let settings = Settings { pixel_error: GameConfig::default().render.pixel_error_budget as f32, ..settings() };
        shown(&mut renderer, camera, 0.0, settings).iter().flatten().map(|light| f64::from(*light)).sum::<f64>()
    };
    let arcs = light("arcs", 0.0);
    // Chords, over which the falling gas thins out, and the height at which they are drawn. Not all vertices of rings that turn find room
    // from here; which do not is chance.
    for (representation, off) in [("polygons-at-rest", 0.06), ("polygons", 0.12)] {
        let in_plane = light(representation, 0.0);
        println!("{representation}: {:.3} of the light of arcs from within the plane", in_plane / arcs);
        assert!((in_plane / arcs - 1.0).abs() < off);
        for height in [1e-4, -1e-4, 0.01, 0.03] {
            let part = light(representation, height) / in_plane;
            println!("{representation}: {part:.3} of that from {height} r_s");
            assert!((part - 1.0).abs() < off);
        }
    }
}
