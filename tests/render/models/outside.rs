//! Triangles that a closed body hides are left out, and nothing else is.

use glam::Vec3;
use lensrunner::render::gpu::readback;
use lensrunner::render::models::outside::{AGAINST, ALONG, LONE, OPEN, sides};
use lensrunner::render::models::{ALONE, Prepared};
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::Stage;
use lensrunner::scene::model::Vertex;
use lensrunner::scene::model::shapes::{Anchor, icosphere, square, uv_sphere};
use lensrunner::scene::{self, GameConfig, Material, Model};

use crate::gpu::GPU;
use crate::render::support::renderer;

/// The cross product of a triangle's sides, and its middle.
fn normal_and_middle(model: &Model, triangle: [u32; 3]) -> (Vec3, Vec3) {
    let [a, b, c] = triangle.map(|vertex| Vec3::from(model.vertices[vertex as usize].position));
    ((b - a).cross(c - a), (a + b + c) / 3.0)
}

#[test]
fn the_outside_of_a_sphere_is_known_however_it_is_wound() {
    for model in [icosphere(80, Material::default()), uv_sphere(300, Material::default())] {
        let mut mixed = model.clone();
        for triangle in &mut mixed.triangles {
            triangle.reverse();
        }
        for model in [&model, &mixed] {
            for (&triangle, side) in model.triangles.iter().zip(sides(model)) {
                let (normal, middle) = normal_and_middle(model, triangle);
                if normal.length() < 1e-9 {
                    continue;
                }
                assert_eq!(side, LONE | if normal.dot(middle) > 0.0 { ALONG } else { AGAINST }, "at {middle}");
            }
        }
    }
}

#[test]
fn what_is_not_closed_has_no_outside() {
    assert!(sides(&square(20, Anchor::Inside, Material::default())).iter().all(|&side| side == OPEN));
    let mut holed = icosphere(80, Material::default());
    holed.triangles.pop();
    holed.triangle_materials.pop();
    assert!(sides(&holed).iter().all(|&side| side == OPEN));
    // One triangle wound the wrong way.
    let mut wrong = icosphere(80, Material::default());
    wrong.triangles[7].reverse();
    assert!(sides(&wrong).iter().all(|&side| side == OPEN));
}

#[test]
fn a_model_of_two_bodies_has_no_lone_one() {
    let mut two = icosphere(20, Material::default());
    let count = two.vertices.len() as u32;
    let far = two.vertices.iter().map(|vertex| scene::Vertex { position: vertex.position.map(|x| x + 3.0), ..*vertex }).collect::<Vec<_>>();
    two.vertices.extend(far);
    let again: Vec<[u32; 3]> = two.triangles.iter().map(|triangle| triangle.map(|vertex| vertex + count)).collect();
    two.triangles.extend(again);
    two.triangle_materials.extend(two.triangle_materials.clone());
    assert!(sides(&two).iter().all(|&side| side == ALONG));
}

/// The picture is the same as with both sides of every triangle drawn, and takes fewer triangles.
#[test]
fn nothing_that_is_seen_is_left_out() {
    /// As in shaders/gpu/types.wgsl.
    const TWO_SIDED: u32 = 1;
    let size = [320, 180];
    // What stays are fronts and outlines, which have the shortest chords.
    for (name, kept) in [("ring", 0.75), ("parade", 0.75)] {
        let scene = scene::load(name).unwrap();
        let config = GameConfig::default();
        let mut renderer = renderer(size);
        let mut stage = Stage::new(&mut renderer, &scene, &config);
        // Thin images count layers, and leave out the backs of closed bodies by another rule.
        let settings = Settings { stars: false, milky_way: false, bloom: 0.0, min_width: 0.0, ..Settings::finest() };
        let mut seen = |both: bool| {
            let mut frame = stage.frame(stage.camera(0.0, &[]), size, 0.0, &[], None, &settings);
            frame.held = Some(if both { TWO_SIDED } else { 0 });
            let picture = renderer.picture(&frame, true).unwrap();
            let counters = readback::buffer(&GPU, renderer.geometry().counters()).unwrap();
            let indices = bytemuck::pod_collect_to_vec::<u8, u32>(&counters)[1];
            (picture.linear, picture.layers, indices)
        };
        let (light, layers, fewer) = seen(false);
        let (light_of_all, layers_of_all, all) = seen(true);
        assert!(f64::from(fewer) < kept * f64::from(all), "{name}: {fewer} of {all} corners are drawn");
        let drawn = layers.iter().filter(|pixel| pixel[0] > 0.0).count();
        // Where a front and a back meet at an outline, either may win the depth test: the front that bends less than its back, or another
        // object right behind it.
        let other = layers.iter().zip(&layers_of_all).filter(|(a, b)| a[..2] != b[..2]).count();
        let lit = light.iter().zip(&light_of_all).filter(|(a, b)| (0..3).any(|c| (a[c] - b[c]).abs() > 0.02 * (a[c] + b[c]))).count();
        assert!(other * 2000 <= drawn, "{name}: {other} of {drawn} pixels show another object");
        assert!(lit * 500 <= drawn, "{name}: {lit} of {drawn} pixels are lit otherwise");
    }
}

/// Outlines are found by the triangles on both sides of an edge, also where a body with corners keeps two vertices at one place for their
/// normals.
#[test]
fn an_edge_knows_the_corners_across_it() {
    let smooth = icosphere(20, Material::default());
    let mut cornered = Model { vertices: Vec::new(), ..smooth.clone() };
    for triangle in &mut cornered.triangles {
        let (normal, _) = normal_and_middle(&smooth, *triangle);
        *triangle = triangle.map(|vertex| {
            cornered.vertices.push(Vertex { normal: normal.normalize().to_array(), ..smooth.vertices[vertex as usize] });
            cornered.vertices.len() as u32 - 1
        });
    }
    for (model, edges) in [(&smooth, 30), (&cornered, 60)] {
        let prepared = Prepared::new(model);
        assert_eq!(prepared.edges.len(), edges);
        let place = |vertex: u32| prepared.vertices[vertex as usize].position.map(f32::to_bits);
        let is_triangle = |corners: [u32; 3]| {
            let sorted = |corners: [u32; 3]| {
                let mut places = corners.map(place);
                places.sort_unstable();
                places
            };
            prepared.triangles.iter().any(|t| sorted([t.vertices[0], t.vertices[1], t.vertices[2]]) == sorted(corners))
        };
        for &[a, b, c, d] in &prepared.edges {
            assert!(place(c) != place(d) && is_triangle([a, b, c]) && is_triangle([a, b, d]), "edge {a}–{b}: {c}, {d}");
        }
    }
    // A sheet of 2 × 2 cells: of its 16 edges 8 are its border.
    let sheet = Prepared::new(&square(8, Anchor::Centre, Material::default()));
    assert_eq!((sheet.edges.len(), sheet.edges.iter().filter(|edge| edge[2] == ALONE).count()), (16, 8));
    assert!(sheet.edges.iter().all(|edge| (edge[2] == ALONE) == (edge[3] == ALONE)));
}
