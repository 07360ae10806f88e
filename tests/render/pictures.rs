//! Pictures against exact projection: vertices land where their light comes from, images are closed, the shadow is dark.

use glam::DVec3;
use lensrunner::lensing::Slice;
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::readback::{self, ReadbackPicture};
use lensrunner::render::gpu::types::SeenVertex;
use lensrunner::render::instances::{DrawnObject, Illumination as Light, InstanceView, ObjectMotion, instances_of};
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::static_camera;
use lensrunner::scene::{self, Body, GameConfig};
use lensrunner::spacetime::Observer;
use lensrunner::spacetime::light::{self, Branch, Order};

use crate::gpu::GPU;
use crate::render::support::{renderer, settings};

/// A scene's picture with its layers.
fn picture(name: &str, size: [u32; 2]) -> (ReadbackPicture, Observer) {
    let scene = scene::load(name).unwrap();
    let config = GameConfig::default();
    let mut renderer = renderer(size);
    let mut stage = lensrunner::render::stage::Stage::new(&mut renderer, &scene, &config);
    let camera = stage.camera(0.0, &[]);
    let frame = stage.frame(camera, size, 0.0, &[], None, &settings());
    (renderer.picture(&frame, true).unwrap(), camera)
}

/// Where the light of order `order` from `point` is seen, by the closed form: a direction in camera axes.
pub fn exact(camera: &Observer, point: DVec3, order: Order) -> Option<DVec3> {
    let (l, r) = (camera.radius(), point.length());
    let n = camera.position / l;
    let across = point - n * point.dot(n);
    let phi = across.length().atan2(point.dot(n));
    let ray = light::connect(1.0 / r, order.swept(phi.max(1e-12)), 1.0 / l, Branch::Plus)?;
    let psi = light::rain_angle(ray.slope, ray.energy, 1.0 / l);
    let side = across.normalize() * if order.flips() { -1.0 } else { 1.0 };
    Some(camera.seen_direction(n * psi.cos() + side * psi.sin()))
}

/// Every vertex of `parade`, in both orders, within half a pixel of its exact place at 1280 × 720 (Yamashita 2012, figure 9).
#[test]
fn vertices_of_the_parade_land_where_they_are_seen() {
    let size = [1280, 720];
    let scene = scene::load("parade").unwrap();
    let assembly = scene.assemble(&GameConfig::default());
    let mut renderer = renderer(size);
    let camera = static_camera(DVec3::new(9.0, 7.0, 30.0), DVec3::new(-9.0, -7.0, -30.0), DVec3::Y, 60f64.to_radians());
    let slice = Slice::new(renderer.table(), camera.radius());
    // Pixels so small that no image is left out as too thin.
    let settings = Settings::finest();
    let view = InstanceView { camera: &camera, slice: &slice, pixel: 1e-9, aspect: None, settings: &settings };
    let model = renderer.add_model(&assembly.models[0]);
    let prepared = lensrunner::render::models::Prepared::new(&assembly.models[0]);
    let mut placed = Vec::new();
    let mut points = Vec::new();
    for object in &assembly.objects {
        let Body::Static { position, attitude } = object.body else { panic!("the parade does not move") };
        let held = DrawnObject {
            model,
            coarse: model,
            stand_ins: &[],
            motion: ObjectMotion::Static { position, attitude },
            reach: object.scale,
            scale: object.scale,
            id: 1,
            light: Light::default(),
        };
        for (order, one) in Order::ALL.into_iter().zip(instances_of(&view, 0.0, &held, 2)) {
            placed.push(one);
            points.extend(prepared.vertices.iter().map(|v| {
                let body = DVec3::new(f64::from(v.position[0]), f64::from(v.position[1]), f64::from(v.position[2]));
                (position + attitude * (body * object.scale), order)
            }));
        }
    }
    let frame = FrameInput { camera, time: 0.0, placed, held: None, aurora: None, settings: Settings::finest() };
    renderer.picture(&frame, false).unwrap();
    let bytes = readback::buffer(&GPU, renderer.geometry().seen()).unwrap();
    // A buffer that grew has room to spare.
    let seen: &[SeenVertex] = bytemuck::cast_slice(&bytes[..bytes.len() / size_of::<SeenVertex>() * size_of::<SeenVertex>()]);
    let (mut checked, mut worst) = ([0; 2], 0.0f64);
    for (vertex, (point, order)) in seen.iter().zip(&points) {
        let Some(want) = exact(&camera, *point, *order).and_then(|direction| camera.pixel(direction, size)) else { continue };
        if want[0] < 0.0 || want[1] < 0.0 || want[0] > 1280.0 || want[1] > 720.0 {
            continue;
        }
        let [x, y, z] = vertex.apparent;
        let got = camera.pixel(DVec3::new(f64::from(x), f64::from(y), f64::from(z)), size).expect("in front of the camera");
        let off = (got[0] - want[0]).hypot(got[1] - want[1]);
        worst = worst.max(off);
        checked[order.number() as usize - 1] += 1;
        assert!(off < 0.5, "order {}, point {point}: at {got:?}, must be at {want:?}, {off:.3} px off", order.number());
    }
    assert!(checked[0] > 10_000 && checked[1] > 10_000, "too few vertices were on the screen: {checked:?}");
    println!("worst displacement {worst:.4} px over {checked:?} vertices");
}

/// The edge of the shadow in camera axes: the angle from the direction to the hole (for a camera that looks at it and hovers), exact.
fn shadow_radius(camera: &Observer, size: [u32; 2]) -> f64 {
    let psi = light::shadow_angle(1.0 / camera.radius());
    let n = camera.position.normalize();
    let a = n.any_orthonormal_vector();
    let edge = camera.pixel(camera.seen_direction(n * psi.cos() + a * psi.sin()), size).unwrap();
    let centre = camera.pixel(camera.seen_direction(-n), size).unwrap();
    (edge[0] - centre[0]).hypot(edge[1] - centre[1])
}

/// The galaxy exactly behind the hole, the axis inside a triangle, on an edge, on a vertex: its image is a closed annulus round the
/// Einstein ring, and no pixel inside the shadow is lit.
#[test]
fn a_galaxy_on_the_axis_is_a_closed_annulus_and_the_shadow_is_dark() {
    let size = [480, 480];
    for name in ["galaxy-axis", "galaxy-axis-edge", "galaxy-axis-vertex"] {
        let (picture, camera) = picture(name, size);
        let dark = shadow_radius(&camera, size);
        let n = camera.position.normalize();
        let centre = camera.pixel(camera.seen_direction(-n), size).unwrap();
        let id = |x: usize, y: usize| picture.layers[y * 480 + x][0];
        let (mut inside, mut lit) = (0, 0);
        for y in 0..480 {
            for x in 0..480 {
                let distance = (x as f64 + 0.5 - centre[0]).hypot(y as f64 + 0.5 - centre[1]);
                if distance < dark - 1.0 {
                    inside += 1;
                    let [r, g, b, _] = picture.linear[y * 480 + x];
                    if r + g + b > 0.0 || id(x, y) != 0.0 {
                        lit += 1;
                        println!("{name}: lit at {x}, {y}: {:?} {:?}", [r, g, b], picture.layers[y * 480 + x]);
                    }
                }
            }
        }
        assert!(inside > 1000, "{name}: the shadow is only {inside} pixels");
        assert_eq!(lit, 0, "{name}: {lit} of {inside} pixels of the shadow are lit");
        // Along every ray from the centre: once the annulus has begun it has no hole up to two Einstein radii.
        let ring = exact(&camera, -n * 15.0 + n.any_orthonormal_vector() * 1e-9, Order::ALL[0]).unwrap();
        let ring = camera.pixel(ring, size).map(|p| (p[0] - centre[0]).hypot(p[1] - centre[1])).unwrap();
        let mut holes = 0;
        for k in 0..720 {
            let (sine, cosine) = (std::f64::consts::TAU * f64::from(k) / 720.0).sin_cos();
            let mut begun = false;
            for step in 0..4000 {
                let distance = dark + 0.05 * f64::from(step);
                let (x, y) = (centre[0] + distance * cosine, centre[1] + distance * sine);
                if distance > 1.25 * ring || x < 0.0 || y < 0.0 || x >= 480.0 || y >= 480.0 {
                    break;
                }
                let here = id(x as usize, y as usize) == 1.0;
                begun |= here;
                if begun && !here && distance > 0.9 * ring {
                    holes += 1;
                    println!("{name}: hole at {x:.1}, {y:.1}");
                }
            }
            assert!(begun, "{name}: nothing at azimuth {k}/720");
        }
        assert_eq!(holes, 0, "{name}: the annulus has {holes} holes");
    }
}

/// The sphere exactly behind the hole: every pixel away from an edge shows the sphere or not as the judge says, who integrates each ray.
#[test]
fn the_ring_is_where_the_judge_sees_it() {
    use crate::judge::brute::{Mesh, Seen, trace};
    use lensrunner::judge::trace::PixelCamera;
    let size = [320, 180];
    let (picture, camera) = picture("ring", size);
    let scene = scene::load("ring").unwrap();
    let assembly = scene.assemble(&GameConfig::default());
    let Body::Static { position, attitude } = assembly.objects[0].body else { panic!("the sphere does not move") };
    let model = &assembly.models[assembly.objects[0].model];
    let mesh = Mesh {
        vertices: model
            .vertices
            .iter()
            .map(|v| position + attitude * (glam::Vec3::from(v.position).as_dvec3() * assembly.objects[0].scale))
            .collect(),
        triangles: model.triangles.clone(),
    };
    let judge = PixelCamera { observer: camera, size };
    let id = |x: usize, y: usize| picture.layers[y * 320 + x][0];
    let (mut hits, mut wrong, mut checked) = (0, 0, 0);
    for y in (2..178).step_by(5) {
        for x in (2..318).step_by(5) {
            let here = id(x, y);
            // At an edge the pixel's centre may fall either way.
            if [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)].iter().any(|&(x, y)| id(x, y) != here) {
                continue;
            }
            let (look, _) = judge.look(x as f64 + 0.5, y as f64 + 0.5);
            let seen = matches!(trace(std::slice::from_ref(&mesh), camera.position, look, 1e-9), Seen::Hit(_));
            checked += 1;
            hits += usize::from(seen);
            wrong += usize::from(seen != (here == 1.0));
        }
    }
    assert!(checked > 1500 && hits > 100, "{checked} pixels, {hits} hits");
    assert_eq!(wrong, 0, "{wrong} of {checked} pixels differ");
}

/// The sky's stars and the disk are exposed alike, however fine the picture: a star's spot is brighter and smaller in a finer one.
#[test]
fn the_exposure_does_not_depend_on_the_size_of_the_picture() {
    use lensrunner::render::shot::{ShotRequest, shot};
    let mean = |size: [u32; 2]| {
        let request = ShotRequest { scene: "disk", size, at: 0.0, layers: false, fill: false };
        let mut config = GameConfig::default();
        // The limits of the exposure are not to hide it.
        (config.render.exposure_min, config.render.exposure_max) = (-30.0, 30.0);
        let picture = shot(&request, &config).unwrap();
        // Squares stand for light well enough to compare two pictures of the same.
        picture.display.iter().map(|&value| f64::from(value).powi(2)).sum::<f64>() / picture.display.len() as f64
    };
    let [coarse, fine] = [mean([320, 180]), mean([1280, 720])];
    assert!((fine / coarse - 1.0).abs() < 0.1, "mean squares {coarse:.1} and {fine:.1}");
}

/// The light that a disk is brought to is asked for while it is in the picture: with the back to it stars are exposed as where there is
/// none, and are no field of snow.
#[test]
fn with_the_back_to_the_disk_stars_are_exposed_as_without_one() {
    let size = [160, 90];
    let mut renderer = crate::render::support::renderer_under(&lensrunner::render::shot::surroundings(), size);
    let config = GameConfig::default();
    let disk = || lensrunner::render::disk::DrawnDisk::new(config.disk.clone(), &config);
    let mut light = |ahead: DVec3, with: bool| {
        renderer.set_disk(with.then(disk));
        let camera = static_camera(DVec3::new(0.0, -16.0, 1.0), ahead, DVec3::Z, 1.0);
        let frame = FrameInput { camera, time: 0.0, placed: Vec::new(), held: None, aurora: None, settings: Settings::finest() };
        renderer.picture(&frame, false).unwrap().display.iter().map(|&byte| f64::from(byte)).sum::<f64>()
    };
    let [away, alone] = [true, false].map(|with| light(DVec3::NEG_Y, with));
    println!("{away} with the back to a disk, {alone} without one");
    // Stars that the exposure before could not show are not metered, which is next to nothing.
    assert!((away / alone - 1.0).abs() < 0.01);
}

/// A prop with a temperature, seen at g = 1.29 from nearer to the hole: a pixel is what the judge makes of Planck's law at gT, and as at
/// rest what of the shift is switched off.
#[test]
fn a_hot_prop_glows_as_the_judge_says() {
    use lensrunner::judge::case::Case;
    use lensrunner::judge::picture::Sampling;
    const SCENE: &str = "[camera]\nposition = [2.0, 0.0, 0.0]\nlook = [1.0, 0.0, 0.0]\n\
        [[prop]]\nmodel = \"icosphere\"\nposition = [6.0, 0.0, 0.0]\nsize = 2.0\n";
    let size = [33, 17];
    let middle = 8 * 33 + 16;
    let mut renderer = renderer(size);
    let mut light = |surface: &str, [doppler, beaming]: [bool; 2]| {
        let scene = scene::Scene::from_toml("hot.toml".as_ref(), &format!("{SCENE}{surface}")).unwrap();
        let mut config = GameConfig::default();
        (config.render.doppler, config.render.beaming) = (doppler, beaming);
        let mut stage = lensrunner::render::stage::Stage::new(&mut renderer, &scene, &config);
        let frame = stage.frame(stage.camera(0.0, &[]), size, 0.0, &[], None, &Settings { doppler, beaming, ..settings() });
        let drawn = renderer.picture(&frame, true).unwrap();
        assert_eq!(drawn.layers[middle][0], 1.0, "the prop is not in the middle of the picture");
        let sampling = Sampling { samples: 1, tolerance: 1e-10, packet: 8 };
        let judged = Case::new(scene, config, 0.0, size).trace(&sampling, false, &|_| ());
        let [red, green, blue, _] = drawn.linear[middle];
        ([red, green, blue], judged.light[middle])
    };
    for temperature in [2000.0, 4000.0, 12_000.0] {
        for shifts in [[true, true], [false, false], [true, false], [false, true]] {
            // Black gives off its heat alone; what is lit gives off that besides.
            for colour in ["[0.0, 0.0, 0.0]", "[0.6, 0.3, 0.2]"] {
                let (drawn, judged) = light(&format!("temperature = {temperature}\ncolour = {colour}\n"), shifts);
                println!("{temperature} K, {shifts:?}, colour {colour}: {drawn:?}, judged {judged:?}");
                // Halves, and a table of black bodies that is right to half a per cent of their luminance.
                let allowed = 0.01 * judged.iter().copied().fold(0.0, f32::max);
                assert!(judged[0] > 1e-3 && drawn.iter().zip(judged).all(|(a, b)| (a - b).abs() <= allowed), "{drawn:?} {judged:?}");
            }
        }
    }
    // A black body of the Sun's temperature that is not shifted has the luminance that the disk's gas of that temperature has.
    let (sun, _) = light("temperature = 5772.0\ncolour = [0.0, 0.0, 0.0]\n", [false, false]);
    let luminance = lensrunner::scene::blackbody::luminance(sun.map(f64::from));
    assert!((luminance / lensrunner::scene::disk::DISK_UNIT - 1.0).abs() < 0.01, "{luminance}");
    let (cold, _) = light("colour = [0.0, 0.0, 0.0]\n", [true, true]);
    assert_eq!(cold, [0.0; 3]);
}
