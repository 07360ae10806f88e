//! The renderer when something is wrong, and what each of its settings does.

use glam::{DQuat, DVec3};
use lensrunner::render::Gpu;
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::readback::PictureError;
use lensrunner::render::instances::{ObjectMotion, Placed};
use lensrunner::render::renderer::Renderer;
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::static_camera;
use lensrunner::scene::Material;
use lensrunner::scene::model::shapes;
use lensrunner::spacetime::Observer;
use lensrunner::spacetime::light;

use crate::render::lookup::{Bench, bench};
use crate::render::support::{settings, surroundings};

fn camera() -> Observer {
    static_camera(DVec3::new(0.0, 0.0, 15.0), DVec3::NEG_Z, DVec3::Y, 60f64.to_radians())
}

fn ball(bench: &Bench, position: DVec3, size: f64, settings: &Settings) -> Vec<Placed> {
    bench.place(&camera(), 0.0, &bench.object(ObjectMotion::Static { position, attitude: DQuat::IDENTITY }, size, 1), settings)
}

fn frame(placed: Vec<Placed>, settings: Settings) -> FrameInput {
    FrameInput { camera: camera(), time: 0.0, placed, held: None, aurora: None, settings }
}

/// A device that is lost: an error in words, then and afterwards, and no panic.
#[test]
fn a_lost_device_is_an_error_in_words() {
    let gpu = Gpu::headless().expect("a driver");
    let mut renderer = Renderer::new(&gpu, &surroundings(), wgpu::TextureFormat::Rgba8UnormSrgb, [16, 16]);
    gpu.device.destroy();
    let _ = gpu.device.poll(wgpu::PollType::Poll);
    for _ in 0..2 {
        match renderer.picture(&frame(Vec::new(), settings()), false) {
            Err(PictureError::Device(what)) => assert!(what.contains("lost") || what.contains("destroyed"), "{what}"),
            other => panic!("{:?}", other.map(|picture| picture.size)),
        }
    }
    assert!(renderer.counters().is_err());
    assert!(!renderer.prepare(&frame(Vec::new(), settings())));
}

/// A window without a size: nothing is drawn until it has one again.
#[test]
fn a_picture_without_a_size_waits() {
    let mut bench = bench();
    let size = bench.renderer.size();
    for none in [[0, 0], [0, 9], [9, 0]] {
        bench.renderer.resize(none);
        assert!(!bench.renderer.prepare(&frame(Vec::new(), settings())));
        assert!(matches!(bench.renderer.picture(&frame(Vec::new(), settings()), false), Err(PictureError::Nothing)));
    }
    bench.renderer.resize(size);
    assert!(bench.renderer.picture(&frame(Vec::new(), settings()), false).is_ok());
}

/// Numbers that are not finite are caught on input, counted, and not drawn; what is beside them is.
#[test]
fn what_is_not_finite_is_counted_and_not_drawn() {
    let mut bench = bench();
    let settings = Settings { orders: 1, ..settings() };
    let good = ball(&bench, DVec3::new(3.0, 0.0, 4.0), 1.0, &settings);
    let picture = bench.renderer.picture(&frame(good.clone(), settings), true).unwrap();
    assert!(picture.layers.iter().any(|texel| texel[0] == 1.0));
    assert_eq!(bench.renderer.counters().unwrap().caught, 0);
    for wrong in [f32::NAN, f32::INFINITY] {
        let mut bad = good.clone();
        bad[0].instance.object = 2;
        bad[0].instance.shape_y[2] = wrong;
        let both = bad.iter().chain(&good).cloned().collect();
        let picture = bench.renderer.picture(&frame(both, settings), true).unwrap();
        assert!(picture.layers.iter().all(|texel| texel[0] != 2.0), "it was drawn");
        assert!(picture.layers.iter().any(|texel| texel[0] == 1.0), "its neighbour was not");
        assert!(picture.linear.iter().flatten().all(|x| x.is_finite()));
        let counters = bench.renderer.counters().unwrap();
        assert_eq!(counters.caught, 1);
        assert!(counters.complaint().unwrap().contains("not finite"));
    }
    // Finite, but past what f32 can square: caught where it arises.
    let mut huge = good.clone();
    huge[0].instance.shape_x[0] = 3e38;
    let picture = bench.renderer.picture(&frame(huge, settings), true).unwrap();
    assert!(picture.linear.iter().flatten().all(|x| x.is_finite()));
    assert!(bench.renderer.counters().unwrap().caught > 0);
    // A camera that is nowhere draws nothing.
    let mut lost = frame(good, settings);
    lost.camera.position.x = f64::NAN;
    assert!(matches!(bench.renderer.picture(&lost, false), Err(PictureError::Nothing)));
}

/// From within a closed body (a ball of radius 0.5) its inner side is seen, on every pixel and lit.
#[test]
fn from_within_a_body_its_inner_side_is_seen() {
    let mut bench = bench();
    let settings = Settings { orders: 1, ..settings() };
    for aside in [0.0, 0.3] {
        let placed = ball(&bench, camera().position + DVec3::new(aside, 0.1, 0.05), 1.0, &settings);
        let picture = bench.renderer.picture(&frame(placed, settings), true).unwrap();
        let covered = picture.layers.iter().filter(|texel| texel[0] == 1.0).count();
        assert_eq!(covered, picture.layers.len(), "{aside} from the middle");
        assert!(picture.linear.iter().all(|pixel| pixel[1] > 0.1), "dark, {aside} from the middle");
    }
}

/// A full vertex buffer: patches are drawn coarsely, the counters say so, and the picture keeps its shape.
#[test]
fn a_full_vertex_buffer_is_said_and_nothing_vanishes() {
    let mut bench = bench();
    let size = bench.renderer.size();
    bench.renderer.resize([160, 90]);
    // A galaxy's square exactly behind the hole: fans and splitting on every side.
    let square = bench.renderer.add_model(&shapes::square(200, shapes::Anchor::Inside, Material::default()));
    let mut lit = Vec::new();
    // The most that is allowed as well, which some devices' buffers cannot hold.
    for vertex_budget in [600_000, 1_000, 2_000_000] {
        let settings = Settings { orders: 2, vertex_budget, ..settings() };
        let motion = ObjectMotion::Static { position: DVec3::new(0.0, 0.0, -12.0), attitude: DQuat::IDENTITY };
        let mut object = bench.object(motion, 8.0, 1);
        (object.model, object.coarse) = (square, square);
        let placed = bench.place(&camera(), 0.0, &object, &settings);
        let picture = bench.renderer.picture(&frame(placed, settings), true).unwrap();
        let counters = bench.renderer.counters().unwrap();
        println!("{vertex_budget}: {counters:?}");
        assert_eq!(counters.coarse > 0, vertex_budget == 1_000, "{counters:?}");
        assert_eq!(counters.complaint().is_some(), vertex_budget == 1_000);
        lit.push(picture.layers.iter().map(|texel| texel[0] == 1.0).collect::<Vec<bool>>());
    }
    bench.renderer.resize(size);
    let all = lit[0].iter().filter(|&&on| on).count();
    let kept = lit[0].iter().zip(&lit[1]).filter(|&(&a, &b)| a && b).count();
    assert!(all > 1000 && kept * 10 > all * 8, "{kept} of {all} pixels are left");
}

/// Settings of tessellation and of narrow images reach the shaders.
#[test]
fn the_settings_of_geometry_do_what_they_say() {
    let mut bench = bench();
    let far = DVec3::new(0.0, 0.3, -12.0);
    let counters = |bench: &mut Bench, settings: Settings, size: f64, pixel: bool| {
        let settings = Settings { orders: 2, ..settings };
        let mut placed = ball(bench, far, size, &settings);
        if pixel {
            // The bench places by tiny pixels; here the image is thin.
            placed.iter_mut().for_each(|one| one.instance.flags |= lensrunner::render::gpu::types::placed::THIN);
        }
        bench.renderer.picture(&frame(placed, settings), false).unwrap();
        bench.renderer.counters().unwrap()
    };
    let fine = counters(&mut bench, settings(), 2.0, false);
    let coarse = counters(&mut bench, Settings { halvings: 1, ..settings() }, 2.0, false);
    let made = |c: lensrunner::render::gpu::types::Counters| c.vertices - c.model_vertices;
    assert!(made(fine) > 2 * made(coarse) && made(coarse) > 0, "{} and {} vertices", made(fine), made(coarse));
    let thin = counters(&mut bench, settings(), 0.02, true);
    assert!(thin.thin > 0);
    let none = counters(&mut bench, Settings { min_width: 0.0, ..settings() }, 0.02, true);
    assert_eq!(none.thin, 0);

    // Thresholds of the instances, by a pixel of 0.01 rad.
    use lensrunner::render::gpu::types::placed::THIN;
    let stand_in = bench.renderer.add_model(&shapes::icosphere(20, Material::default()));
    let mut object = bench.object(ObjectMotion::Static { position: DVec3::new(9.0, 0.0, 0.0), attitude: DQuat::IDENTITY }, 0.2, 1);
    object.coarse = stand_in;
    let images = |settings: Settings| bench.place_by(0.01, &camera(), 0.0, &object, &Settings { orders: 3, ..settings });
    let count = |settings: Settings| images(settings).len();
    // The ball is 2.3 pixels wide in the first order.
    let first = |settings: Settings| images(settings)[0].clone();
    assert_eq!(count(Settings { least_width: 0.0, ..settings() }), 3);
    assert_eq!(count(Settings { least_width: 10.0, ..settings() }), 1);
    assert_eq!(first(Settings { coarse_below: 6.0, ..settings() }).model.triangles, stand_in.triangles);
    assert_ne!(first(Settings { coarse_below: 1.0, ..settings() }).model.triangles, stand_in.triangles);
    assert_eq!(first(Settings { thin_below: 3.0, ..settings() }).instance.flags & THIN, THIN);
    assert_eq!(first(Settings { thin_below: 0.5, ..settings() }).instance.flags & THIN, 0);
}

/// The rings of orders 2 and 3 of a ball, a twentieth of a pixel wide: the second is an unbroken line, the third nearly.
#[test]
fn rings_of_orders_two_and_three_are_unbroken() {
    let mut bench = bench();
    let old = bench.renderer.size();
    let size = [320, 180];
    bench.renderer.resize(size);
    for (order, position, radius) in [(2, DVec3::new(0.0, 0.0, 9.0), 1.0), (3, DVec3::new(0.0, 0.0, -12.0), 4.0)] {
        let settings = Settings { orders: 3, least_width: 0.0, ..settings() };
        let eye = camera();
        let object = bench.object(ObjectMotion::Static { position, attitude: DQuat::IDENTITY }, radius, 1);
        let placed = bench.place_by(2.0 * (0.5 * eye.field_of_view).tan() / 320.0, &eye, 0.0, &object, &settings);
        assert_eq!(placed.len(), 3);
        let picture = bench.renderer.picture(&frame(placed, settings), true).unwrap();
        // Seen on the axis: Φ = 2π or 3π.
        let swept = std::f64::consts::PI * f64::from(order);
        let ray = light::connect(1.0 / position.length(), swept, 1.0 / 15.0, light::Branch::Plus).unwrap();
        let psi = light::rain_angle(ray.slope, ray.energy, 1.0 / 15.0);
        let mut gaps = 0;
        for k in 0..720 {
            let (sine, cosine) = (std::f64::consts::TAU * f64::from(k) / 720.0).sin_cos();
            let look = DVec3::Z * psi.cos() + DVec3::new(cosine, sine, 0.0) * psi.sin();
            let [x, y] = eye.pixel(eye.seen_direction(look), size).unwrap();
            let near = (-1i32..=1).flat_map(|dx| (-1i32..=1).map(move |dy| (dx, dy))).any(|(dx, dy)| {
                let at = (y as i32 + dy) * 320 + x as i32 + dx;
                let (layers, light) = (picture.layers[at as usize], picture.linear[at as usize]);
                layers[0] == 1.0 && layers[1] >= 2.0 && light[0] + light[1] + light[2] > 0.0
            });
            gaps += usize::from(!near);
        }
        // The third image is thinner than f32 tells beside the axis: it is broken in places (docs/lab/verdict.md). Measured 33 to 41 of
        // 720: the order in which threads draw its triangles differs from run to run.
        let allowed = if order == 3 { 60 } else { 0 };
        assert!(gaps <= allowed, "the ring at Φ = {order}π has {gaps} gaps of 720");
    }
    bench.renderer.resize(old);
}

/// Every method that `game.toml` may name exists, and the switches of the picture reach the renderer.
#[test]
fn game_toml_reaches_the_renderer() {
    use lensrunner::lensing::methods::{Method, flat};
    use lensrunner::render::stage::settings;
    use lensrunner::scene::GameConfig;
    use lensrunner::scene::config::{Allowed, setting};
    let Allowed::Choice(names) = setting("render.method").unwrap().allowed else { panic!("a choice") };
    let mut config = GameConfig::default();
    let with = |config: &GameConfig| settings(config);
    let plain = with(&config);
    assert_eq!((plain.method, plain.light_delay), (Method::default(), true));
    for name in names {
        config.render.method = (*name).to_owned();
        assert_eq!(with(&config).method.name, *name);
    }
    config.render.lensing = false;
    config.render.light_delay = false;
    config.render.min_width = 0.5;
    config.render.vertex_budget = 5000;
    config.render.tessellation_max_level = 3;
    (config.render.thin_below, config.render.coarse_below, config.render.least_width) = (1.5, 7.0, 0.2);
    let changed = with(&config);
    assert_eq!((changed.method, changed.light_delay, changed.min_width), (flat::METHOD, false, 0.5));
    assert_eq!((changed.vertex_budget, changed.halvings), (5000, 3));
    assert_eq!((changed.thin_below, changed.coarse_below, changed.least_width), (1.5, 7.0, 0.2));
}
