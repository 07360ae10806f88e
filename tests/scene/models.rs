//! Procedural shapes, glTF import, textures.

use std::collections::HashMap;

use glam::{DVec3, Vec3};
use lensrunner::scene::model::SHIP_MODELS;
use lensrunner::scene::model::import::{ModelError, load_model, load_or_placeholder};
use lensrunner::scene::model::shapes::{Anchor, icosphere, square, uv_sphere};
use lensrunner::scene::model::texture;
use lensrunner::scene::{Material, Model, assets_folder};

/// How often each edge of the surface is used, vertices being the same where their positions are, bit by bit.
fn edges(model: &Model) -> HashMap<([u32; 3], [u32; 3]), u32> {
    let place = |index: u32| model.vertices[index as usize].position.map(|x| (x + 0.0).to_bits());
    let mut edges = HashMap::new();
    for triangle in &model.triangles {
        for side in 0..3 {
            let (a, b) = (place(triangle[side]), place(triangle[(side + 1) % 3]));
            *edges.entry((a.min(b), a.max(b))).or_insert(0) += 1;
        }
    }
    edges
}

fn volume(model: &Model) -> f32 {
    let corner = |index: u32| Vec3::from(model.vertices[index as usize].position);
    model.triangles.iter().map(|t| corner(t[0]).cross(corner(t[1])).dot(corner(t[2])) / 6.0).sum()
}

#[test]
fn spheres_are_closed_and_turned_outwards() {
    let spheres = [
        uv_sphere(8, Material::default()),
        uv_sphere(1200, Material::default()),
        icosphere(20, Material::default()),
        icosphere(300, Material::default()),
    ];
    for sphere in spheres {
        assert!(sphere.fault().is_none());
        assert!(edges(&sphere).values().all(|&uses| uses == 2), "{} triangles", sphere.triangles.len());
        // The volume of a ball of diameter 1 is 0.5236; a coarse polyhedron inside it has less.
        assert!((0.1..std::f32::consts::FRAC_PI_6).contains(&volume(&sphere)), "{}", volume(&sphere));
        for vertex in &sphere.vertices {
            assert!((Vec3::from(vertex.position).length() - 0.5).abs() < 1e-6);
            assert!(Vec3::from(vertex.normal).distance(2.0 * Vec3::from(vertex.position)) < 1e-6);
        }
    }
}

#[test]
fn shapes_have_the_triangles_asked_for() {
    assert_eq!(uv_sphere(1200, Material::default()).triangles.len(), 1224);
    assert_eq!(icosphere(20, Material::default()).triangles.len(), 20);
    assert_eq!(icosphere(21, Material::default()).triangles.len(), 80);
    for count in [2, 200, 2_000, 20_000] {
        assert_eq!(square(count, Anchor::Centre, Material::default()).triangles.len(), count as usize);
    }
}

#[test]
fn a_square_has_edge_one_and_faces_plus_z() {
    for anchor in [Anchor::Centre, Anchor::Inside, Anchor::Edge, Anchor::Vertex] {
        let model = square(2_000, anchor, Material::default());
        let corner = |index: u32| Vec3::from(model.vertices[index as usize].position);
        let normals = model.triangles.iter().map(|t| (corner(t[1]) - corner(t[0])).cross(corner(t[2]) - corner(t[0])));
        let area: f32 = normals.map(|normal| 0.5 * normal.z).sum();
        assert!((area - 1.0).abs() < 1e-4, "{anchor:?}: {area}");
        assert_eq!(edges(&model).values().filter(|&&uses| uses == 1).count(), 2 * (25 + 40));
        let (low, high) = model.vertices.iter().fold((Vec3::MAX, Vec3::MIN), |(low, high), vertex| {
            (low.min(Vec3::from(vertex.position)), high.max(Vec3::from(vertex.position)))
        });
        assert!(low.z == 0.0 && low.x < -0.4 && low.y < -0.4 && high.x > 0.4 && high.y > 0.4, "{low} {high}");
    }
}

#[test]
fn the_ships_are_sound() {
    for name in SHIP_MODELS {
        let path = assets_folder().join("models").join(name);
        assert!(std::fs::metadata(&path).unwrap().len() < 600_000);
        let model = load_model(&path).unwrap();
        assert!((1_500..=6_000).contains(&model.triangles.len()), "{name}: {} triangles", model.triangles.len());
        assert!(model.materials.len() >= 4 && model.materials.iter().any(|material| material.emissive != [0.0; 3]), "{name}");
        let (low, high) = model.vertices.iter().fold((Vec3::MAX, Vec3::MIN), |(low, high), vertex| {
            (low.min(Vec3::from(vertex.position)), high.max(Vec3::from(vertex.position)))
        });
        // Length 1 along z, about the origin, wider than high.
        assert!((high.z - low.z - 1.0).abs() < 0.05 && (high.z + low.z).abs() < 0.1, "{name}: {low} to {high}");
        assert!((high.x + low.x).abs() < 0.02 && high.x - low.x > high.y - low.y, "{name}: {low} to {high}");
        // Light leaves at the back: most emissive area of the engines lies at +z.
        assert!(volume(&model) > 0.0, "{name} is turned inside out");
    }
}

/// One triangle in a node that is moved, inside a node that mirrors x and doubles: transforms multiply, the triangle keeps its outside.
#[test]
fn nodes_are_flattened_and_mirrored_triangles_turned() {
    // Positions (0,0,0), (1,0,0), (0,1,0) as little-endian f32.
    let positions = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"scale":[-2,2,2],"children":[1]}},{{"mesh":0,"translation":[0,0,5]}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"material":0}}]}}],
        "materials":[{{"emissiveFactor":[1,0.5,0],"extensions":{{"KHR_materials_emissive_strength":{{"emissiveStrength":4}}}}}}],
        "extensionsUsed":["KHR_materials_emissive_strength"],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,{positions}"}}]}}"#
    );
    let folder = crate::support::Folder::new();
    let path = folder.path().join("one.gltf");
    std::fs::write(&path, text).unwrap();
    let model = load_model(&path).unwrap();
    let corners = model.triangles[0].map(|index| Vec3::from(model.vertices[index as usize].position));
    assert_eq!(corners, [Vec3::new(0.0, 0.0, 10.0), Vec3::new(0.0, 2.0, 10.0), Vec3::new(-2.0, 0.0, 10.0)]);
    assert_eq!(Vec3::from(model.vertices[0].normal), Vec3::Z);
    assert_eq!(model.materials[0].emissive, [4.0, 2.0, 0.0]);
}

#[test]
fn a_missing_or_broken_model_is_named_and_replaced() {
    let (model, error) = load_or_placeholder("no-such-ship.glb");
    assert!(error.unwrap().to_string().contains("no-such-ship.glb"));
    assert!(model.fault().is_none() && edges(&model).values().all(|&uses| uses == 2) && volume(&model) > 0.0);
    let folder = crate::support::Folder::new();
    let path = folder.path().join("broken.glb");
    let whole = std::fs::read(assets_folder().join("models/hunter.glb")).unwrap();
    for bytes in [&b"not a model"[..], &whole[..whole.len() / 2], &[]] {
        std::fs::write(&path, bytes).unwrap();
        let error = load_model(&path).unwrap_err();
        assert!(matches!(error, ModelError::Gltf { .. }) && error.to_string().contains("broken.glb"), "{error}");
    }
}

#[test]
fn textures_look_like_what_they_are() {
    let chequer = texture::checker();
    let light = chequer.rgba.chunks_exact(4).filter(|pixel| pixel[0] > 128).count();
    assert_eq!(2 * light, (chequer.width * chequer.height) as usize);
    let galaxy = texture::galaxy();
    assert_eq!((galaxy.width, galaxy.height), (1024, 1024));
    let pixel = |x: u32, y: u32| &galaxy.rgba[4 * (y * 1024 + x) as usize..][..4];
    assert!(pixel(512, 512)[0] > 200 && pixel(512, 512)[0] > pixel(512, 512)[2], "the core is bright and warm");
    assert_eq!(&pixel(2, 2)[..3], [0, 0, 0], "the corners are dark");
    let arms = galaxy.rgba.chunks_exact(4).filter(|p| p[2] > p[0].saturating_add(20) && p[2] > 90).count();
    assert!(arms > 20_000, "{arms} blue pixels");
}

#[test]
fn a_globe_of_fewer_triangles_covers_as_much_as_the_full_one() {
    let scene = lensrunner::scene::load("chase").unwrap();
    let planet = scene.planet.unwrap();
    let full = planet.model();
    // What a convex body covers, seen along a direction: half of what its triangles do, each seen from both sides.
    let covered = |model: &Model, look: DVec3| -> f64 {
        let area = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|i| DVec3::from(model.vertices[i as usize].position.map(f64::from)));
            0.25 * (b - a).cross(c - a).dot(look).abs()
        };
        model.triangles.iter().map(area).sum()
    };
    for (below, globe) in planet.stand_ins(&full) {
        // An image so wide, of an outline off by so little, differs in a fifth of the pixels that it may.
        let allowed = 0.2 * (0.002f64).max(1.0 / (0.25 * std::f64::consts::PI * below * below));
        for k in 0..12 {
            let look = DVec3::new((0.7 * f64::from(k)).cos(), 0.3 * f64::from(k) - 1.5, (0.7 * f64::from(k)).sin()).normalize();
            let off = covered(&globe, look) / covered(&full, look) - 1.0;
            assert!(off.abs() < allowed, "{} triangles: {off} of the area too much along {look}", globe.triangles.len());
        }
    }
}
