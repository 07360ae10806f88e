//! Procedural shapes, glTF import, textures.

use std::collections::HashMap;

use glam::{DVec3, Vec3};
use lensrunner::scene::model::SHIP_MODELS;
use lensrunner::scene::model::import::{ModelError, load_model, load_or_placeholder};
use lensrunner::scene::model::shapes::{Anchor, icosphere, square, uv_sphere};
use lensrunner::scene::model::texture;
use lensrunner::scene::{Material, Model};

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

/// The simulation knows how far its ships reach without reading their models.
#[test]
fn ships_reach_as_far_as_their_models() {
    let radii = SHIP_MODELS.map(|name| f64::from(load_or_placeholder(name).0.radius()));
    assert_eq!(radii, lensrunner::sim::setup::RADII);
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
        let path = crate::support::root().join("assets/models").join(name);
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
    let whole = std::fs::read(crate::support::root().join("assets/models/hunter.glb")).unwrap();
    for bytes in [&b"not a model"[..], &whole[..whole.len() / 2], &[]] {
        std::fs::write(&path, bytes).unwrap();
        let error = load_model(&path).unwrap_err();
        assert!(!matches!(error, ModelError::Read { .. }) && error.to_string().contains("broken.glb"), "{error}");
    }
    // Each part of the outline, at its place.
    for (at, word, said) in [
        (4, 1, "header: version 1, allowed 2"),
        (8, 90_000_000, "header: length 90000000, but the file ends after"),
        (12, 90_000_000, "JSON chunk, byte 12: length 90000000, allowed 0 to"),
        (16, 0x41, "JSON chunk, byte 16: its kind is \"A␀␀␀\", allowed \"JSON\""),
    ] {
        std::fs::write(&path, [&whole[..at], &u32::to_le_bytes(word), &whole[at + 4..]].concat()).unwrap();
        let error = load_model(&path).unwrap_err().to_string();
        assert!(error.contains("broken.glb") && error.contains(said), "{error}");
    }
    // A length that ends before its own header.
    std::fs::write(&path, [&whole[..8], &4u32.to_le_bytes(), &whole[12..]].concat()).unwrap();
    let said = load_model(&path).unwrap_err().to_string();
    assert!(said.contains("broken.glb") && said.contains("length 4, allowed 20"), "{said}");
}

/// A model of a text in glTF whose first buffer holds `bytes`, and what became of it.
fn model_of(bytes: &[u8], text: &str) -> Result<Model, String> {
    let folder = crate::support::Folder::new();
    let path = folder.path().join("one.gltf");
    let data = format!("data:application/octet-stream;base64,{}", data_encoding::BASE64.encode(bytes));
    std::fs::write(&path, text.replace("LENGTH", &bytes.len().to_string()).replace("DATA", &data)).unwrap();
    std::fs::write(folder.path().join("beside file.bin"), bytes).unwrap();
    let made = load_model(&path).map_err(|error| error.to_string());
    made.inspect(|model| assert_eq!(model.fault(), None))
}

/// Three positions and three indices: 36 bytes and 3 shorts. Words in capitals are put in by [`model_of`].
const TRIANGLE: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],"materials":[{"emissiveFactor":[1,0.5,0]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
    {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
    "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
    "buffers":[{"byteLength":LENGTH,"uri":"DATA"}]}"#;

fn corners(numbers: [f32; 9], indices: [u16; 3]) -> Vec<u8> {
    let numbers = numbers.iter().flat_map(|number| number.to_le_bytes());
    numbers.chain(indices.iter().flat_map(|index| index.to_le_bytes())).collect()
}

const CORNERS: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];

#[test]
fn a_model_is_refused_by_place_value_and_range() {
    let right = corners(CORNERS, [0, 1, 2]);
    assert_eq!(model_of(&right, TRIANGLE).unwrap().triangles, [[0, 1, 2]]);
    for (from, to, parts) in [
        (r#"0,"byteLength":36"#, r#"0,"byteLength":36,"byteStride":13"#, ["bufferViews[0].byteStride = 13", "multiples of 4"]),
        (r#"0,"byteLength":36"#, r#"0,"byteLength":36,"byteStride":8"#, ["accessors[0]: elements of 12 bytes", "byteStride = 8"]),
        (r#""componentType":5123"#, r#""componentType":5122"#, ["primitives[0].indices = 1", "unsigned whole numbers"]),
        (r#""componentType":5123"#, r#""componentType":5126"#, ["accessors[1]: 3 elements of 4 bytes", "the 6 of bufferViews[1]"]),
        (r#""count":3,"type":"SCALAR""#, r#""count":6,"type":"SCALAR""#, ["accessors[1]: 6 elements", "the 6 of bufferViews[1]"]),
        (r#""count":3,"type":"SCALAR""#, r#""count":2,"type":"SCALAR""#, ["indices: 2 corners", "a multiple of 3"]),
        (r#""count":3,"type":"SCALAR""#, r#""count":0,"type":"SCALAR""#, ["accessors[1].count = 0", "1 or more"]),
        (r#""count":3,"type":"VEC3""#, r#""count":3,"type":"VEC2""#, ["attributes.POSITION = 0", "three floats"]),
        (r#""POSITION":0"#, r#""POSITION":0,"TEXCOORD_0":1"#, ["attributes.TEXCOORD_0 = 1", "two floats"]),
        (r#""POSITION":0"#, r#""POSITION":9"#, ["meshes[0].primitives[0].attributes.POSITION = 9", "there are 2 accessors"]),
        (
            r#""emissiveFactor":[1,0.5,0]}]"#,
            r#""emissiveTexture":{"index":0}}],"textures":[{"source":0}],"images":[{}]"#,
            ["images[0]", "neither a uri nor"],
        ),
        (
            r#""emissiveFactor":[1,0.5,0]}]"#,
            r#""emissiveTexture":{"index":0}}],"textures":[{"source":0}],"images":[{"bufferView":0}]"#,
            ["images[0]", "neither PNG nor JPEG"],
        ),
        (r#""POSITION":0"#, r#""NORMAL":0"#, ["attributes[\"POSITION\"]", "Missing data"]),
        (r#""byteOffset":36"#, r#""byteOffset":40"#, ["bufferViews[1]: 6 bytes from 40 on", "the 42 of its buffer"]),
        (r#""byteOffset":36"#, r#""byteOffset":18446744073709551615"#, ["bufferViews[1]: 6 bytes from 18446744073709551615", "42"]),
        (r#""byteLength":LENGTH"#, r#""byteLength":48"#, ["buffers[0].byteLength = 48", "42 bytes"]),
        (r#"{"mesh":0}"#, r#"{"mesh":0,"children":[0]}"#, ["nodes[0]", "in a circle"]),
        (r#"{"mesh":0}"#, r#"{"mesh":0,"scale":[1e30,1,1]}"#, ["vertex 1 is at", "-1000 to 1000"]),
        (r#"{"mesh":0}"#, r#"{"mesh":0,"scale":[1e-30,1e-30,1]}"#, ["from the origin", "0.001 to 1000"]),
        (r#"{"mesh":0}"#, r#"{"mesh":0,"scale":[1,0,1]}"#, ["none of its triangles", "area"]),
        ("[1,0.5,0]", "[1,-0.5,0]", ["materials[0]: emissiveFactor [1.0, -0.5, 0.0]", "allowed 0 to"]),
        ("DATA", "/etc/hostname", ["buffers[0].uri = \"/etc/hostname\"", "beside the model"]),
        ("DATA", "../one.gltf", ["buffers[0].uri = \"../one.gltf\"", "beside the model"]),
        ("DATA", "%2e%2e/one.gltf", ["buffers[0].uri", "beside the model"]),
        ("DATA", "file:///dev/zero", ["buffers[0].uri = \"file:///dev/zero\"", "beside the model"]),
        ("DATA", "none.bin", ["buffers[0].uri = \"none.bin\"", ""]),
        ("DATA", ".", ["buffers[0].uri", "a folder"]),
        ("DATA", "data:,plain", ["buffers[0].uri", ";base64,"]),
        (r#""count":3,"type":"VEC3""#, r#""count":99999999999,"type":"VEC3""#, ["accessors[0]: 99999999999 elements", "36"]),
        (
            r#"{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}"#,
            r#"{"componentType":5125,"count":3000000000,"type":"SCALAR","sparse":{"count":1,
                "indices":{"bufferView":0,"componentType":5125},"values":{"bufferView":0}}}"#,
            ["primitives[0].indices: 1000000000 triangles", "allowed 500000"],
        ),
    ] {
        assert!(TRIANGLE.contains(from), "{from}");
        let said = model_of(&right, &TRIANGLE.replacen(from, to, 1)).expect_err(to);
        assert!(said.contains("one.gltf: ") && parts.iter().all(|part| said.contains(part)), "{to} gave {said}, lacking one of {parts:?}");
        assert!(said.len() < 400, "{said}");
    }
    let said = model_of(&corners(CORNERS, [0, 1, 7]), TRIANGLE).expect_err("past its end");
    assert!(said.contains("index 7") && said.contains("3 vertices"), "{said}");
    for far in [1e10, f32::MAX, f32::INFINITY, f32::NAN] {
        let mut numbers = CORNERS;
        numbers[3] = far;
        let said = model_of(&corners(numbers, [0, 1, 2]), TRIANGLE).expect_err("far");
        assert!(said.contains("vertex 1 is at") && said.contains("-1000 to 1000"), "{said}");
    }
    let said = model_of(&right, &TRIANGLE.replace("\"nodes\":[0]", &format!("\"name\":{}", "x".repeat(1_000_000)))).expect_err("long");
    assert!(said.len() < 400, "{said}");
}

/// Forty levels of two children each that are the same node: a million million triangles of a few bytes.
#[test]
fn a_node_hangs_in_one_place() {
    let levels: Vec<String> = (1..=40).map(|level| format!(r#"{{"children":[{level},{level}]}}"#)).collect();
    let nodes = format!(r#""nodes":[{},{{"mesh":0}}]"#, levels.join(","));
    let said = model_of(&corners(CORNERS, [0, 1, 2]), &TRIANGLE.replace(r#""nodes":[{"mesh":0}]"#, &nodes)).expect_err("shared");
    assert!(said.contains("hangs in two places"), "{said}");
    // A million of nodes take more memory than their text.
    let many = vec!["{}"; 1_000_000].join(",");
    let said = model_of(&[], &TRIANGLE.replace(r#"{"mesh":0}"#, &many)).expect_err("too many");
    assert!(said.contains("entries, allowed are 500000"), "{said}");
}

#[test]
fn the_triangles_of_all_nodes_are_counted_before_they_are_made() {
    // Indices without a buffer are zeros but for one.
    let indices = r#"{"componentType":5125,"count":300000,"type":"SCALAR","sparse":{"count":1,
        "indices":{"bufferView":0,"componentType":5125},"values":{"bufferView":0}}}"#;
    let text = TRIANGLE.replace(r#"{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}"#, indices);
    let six = text.replace(r#""scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}]"#, &{
        let nodes = [r#"{"mesh":0}"#; 6].join(",");
        format!(r#""scenes":[{{"nodes":[0,1,2,3,4,5]}}],"nodes":[{nodes}]"#)
    });
    let said = model_of(&corners(CORNERS, [0, 1, 2]), &six).expect_err("600,000");
    assert!(said.contains("more than 500000 triangles"), "{said}");
}

#[test]
fn files_beside_the_model_are_read_and_no_others() {
    let right = corners(CORNERS, [0, 1, 2]);
    assert_eq!(model_of(&right, &TRIANGLE.replace("DATA", "beside%20file.bin")).unwrap().triangles, [[0, 1, 2]]);
    #[cfg(unix)]
    {
        let folder = crate::support::Folder::new();
        let path = folder.path().join("one.gltf");
        std::os::unix::fs::symlink("/dev/zero", folder.path().join("zero.bin")).unwrap();
        std::fs::write(&path, TRIANGLE.replace("DATA", "zero.bin").replace("LENGTH", "42")).unwrap();
        let said = load_model(&path).unwrap_err().to_string();
        assert!(said.contains("buffers[0].uri = \"zero.bin\": it is a device"), "{said}");
        let said = load_model(std::path::Path::new("/dev/zero")).unwrap_err().to_string();
        assert!(said.contains("model /dev/zero: it is a device"), "{said}");
    }
    // Of a length that it does not fill.
    let folder = crate::support::Folder::new();
    let path = folder.path().join("long.glb");
    std::fs::File::create(&path).and_then(|file| file.set_len(12 << 30)).unwrap();
    let said = load_model(&path).unwrap_err().to_string();
    assert!(said.contains("it has 12884901888 bytes, allowed are at most 268435456"), "{said}");
}

/// The picture of a material: of a size that it may have, and no other kind of file.
#[test]
fn images_of_a_model_are_bounded() {
    let picture = |width: u32, height: u32| {
        let mut png = Vec::new();
        let encoder = image::codecs::png::PngEncoder::new(&mut png);
        let pixels = vec![9; (width * height) as usize];
        image::ImageEncoder::write_image(encoder, &pixels, width, height, image::ExtendedColorType::L8).unwrap();
        png
    };
    let with = |bytes: &[u8]| {
        let data = format!("data:image/png;base64,{}", data_encoding::BASE64.encode(bytes));
        let shown = format!(
            r#""materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],"textures":[{{"source":0}}],
            "images":[{{"uri":"{data}"}}]"#
        );
        model_of(&corners(CORNERS, [0, 1, 2]), &TRIANGLE.replace(r#""materials":[{"emissiveFactor":[1,0.5,0]}]"#, &shown))
    };
    let texture = with(&picture(3, 2)).unwrap().materials[0].texture.clone().unwrap();
    assert_eq!((texture.width, texture.height, texture.rgba[..4].to_vec()), (3, 2, vec![9, 9, 9, 255]));
    let said = with(&picture(8193, 1)).expect_err("too wide");
    assert!(said.contains("images[0]: 8193 × 1 pixels, allowed 8192"), "{said}");
    assert!(with(b"GIF89a").expect_err("another kind").contains("images[0] is neither PNG nor JPEG"));
    assert!(with(&picture(30, 20)[..60]).expect_err("cut off").contains("images[0]: "));
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
