//! What the game hands in to the judge.

use glam::DVec3;
use lensrunner::judge::case::Case;
use lensrunner::judge::picture::Sampling;
use lensrunner::scene::{self, GameConfig};
use lensrunner_lab::contestant;

#[test]
fn a_globe_of_fewer_triangles_tells_which_points_it_shows() {
    // The planet of `chase` is ten pixels wide here.
    let case = Case::new(scene::load("chase").unwrap(), GameConfig::default(), 0.0, [160, 90]);
    let planet = case.assembly.objects.iter().position(|object| object.body == scene::Body::Planet).unwrap() as u32 + 1;
    let frame = contestant::draw(&case).unwrap();
    let judge = case.trace(&Sampling { samples: 1, tolerance: 1e-9, packet: 8 }, false, &|_| ());
    let both = judge
        .layers
        .iter()
        .zip(&frame.shown)
        .filter(|(layer, shown)| (layer.object, layer.order) == (planet, 1) && (shown.object, shown.order) == (planet, 1));
    let radius = f64::from(case.assembly.models[case.assembly.objects[planet as usize - 1].model].radius());
    // At the rim a tenth of a pixel is a long way on the globe: the mean counts.
    let off: Vec<f64> = both.map(|(layer, shown)| DVec3::from(shown.body.map(f64::from)).distance(case.body(layer))).collect();
    assert!(off.len() > 40, "only {} pixels show the planet", off.len());
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    println!("{} pixels, mean {} of the radius", off.len(), mean / radius);
    // Measured 0.0032.
    assert!(mean < 0.01 * radius);
}

#[test]
fn thin_images_of_a_ship_cover_what_the_judge_sees_of_them() {
    use lensrunner_lab::compare::measure::narrow;
    use lensrunner_lab::compare::measure::probe::probe;
    // The ship ahead of the camera is drawn out to a ring of the second order, a hundredth of a pixel wide.
    let mut config = GameConfig::default();
    config.render.least_width = 0.001;
    let case = Case::new(scene::load("plunge").unwrap(), config, 0.0, [1280, 720]);
    let frame = contestant::draw(&case).unwrap();
    let mut judge = case.trace(&Sampling { samples: 1, tolerance: 1e-8, packet: 8 }, false, &|_| ());
    narrow::see_again(&mut judge, &frame, &probe(&case, 1e-8));
    let seen: f32 = judge.shares.iter().flatten().filter(|share| share.1 == 2).map(|share| share.2).sum();
    let drawn: Vec<f32> = frame.shown.iter().filter(|shown| shown.order == 2).map(|shown| shown.coverage).collect();
    let sum: f32 = drawn.iter().sum();
    println!("{sum} drawn in {} pixels, {seen} seen", drawn.len());
    // Nine rays a pixel meet it about a hundred times.
    assert!(drawn.len() > 40 && (sum / seen - 1.0).abs() < 0.3);
}

/// A ship exactly behind the hole, and a little beside: its ring is a tenth of a pixel wide at most azimuths.
#[test]
fn a_ring_thinner_than_a_pixel_is_as_bright_as_it_should_be() {
    use lensrunner_lab::compare::deadline::Deadline;
    use lensrunner_lab::compare::fault::Limits;
    use lensrunner_lab::compare::measure::light::lights;
    use lensrunner_lab::compare::measure::probe::probe;
    for z in [0.0, 0.06] {
        let text = format!(
            "[camera]\nposition = [6.0, 0.0137, {z}]\nlook = [-1.0, 0.0, 0.0]\nfov = 60.0\n\
             [[ship]]\nname = \"hunter\"\nmodel = \"hunter\"\nposition = [-6.0, 0.0, 0.0]\nmomentum = [-0.40825, 0.0, 0.0]\n\
             [sky]\nstars = false\nmilky_way = false\n"
        );
        let scene = scene::Scene::from_toml(std::path::Path::new("test.toml"), &text).unwrap();
        let case = Case::new(scene, GameConfig::default(), 0.0, [192, 108]);
        let frame = contestant::draw(&case).unwrap();
        assert!(frame.shown.iter().filter(|shown| shown.object > 0).all(|shown| shown.coverage < 1.0), "it is not drawn by centres");
        let judge = case.trace(&Sampling { samples: 1, tolerance: 1e-8, packet: 8 }, false, &|_| ());
        let names = ["hunter".to_owned()];
        let limits = Limits::default();
        let found = lights(&judge, &frame, &probe(&case, 1e-8), &names, &limits, 16, &Deadline::never());
        let drawn: Vec<_> = found.iter().filter(|light| light.image.1 <= 2).collect();
        assert!(drawn.len() >= 2, "two orders, and both together where they share pixels");
        for light in drawn {
            println!("z = {z}, order {}: {} by the judge {} ± {}", light.image.1, light.shown.x, light.judge.x, light.noise.x);
            // Measured ratios of 0.99 to 1.05, the judge's noise being 0.015 of them. By centres of pixels they were 0.84 to 1.22.
            assert!((light.shown.x / light.judge.x - 1.0).abs() < 0.08 && light.noise.x < 0.03 * light.judge.x);
            assert_eq!(light.fault(&limits), None);
        }
    }
}
