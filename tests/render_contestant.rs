//! What the game hands in to the judge.

use glam::DVec3;
use lensrunner::measure::trace::Case;
use lensrunner::play::contestant;
use lensrunner::reference::picture::Quality;
use lensrunner::scene::{self, GameConfig};

#[test]
fn a_globe_of_fewer_triangles_tells_which_points_it_shows() {
    // The planet of `chase` is ten pixels wide here.
    let case = Case::new(scene::load("chase").unwrap(), GameConfig::default(), 0.0, [160, 90]);
    let planet = case.assembly.objects.iter().position(|object| object.body == scene::Body::Planet).unwrap() as u32 + 1;
    let frame = contestant::draw(&case).unwrap();
    let judge = case.trace(&Quality { samples: 1, tolerance: 1e-9, packet: 8 }, false, &|_| ());
    let both = judge
        .layers
        .iter()
        .zip(&frame.shown)
        .filter(|(layer, shown)| (layer.object, layer.order) == (planet, 1) && (shown.object, shown.order) == (planet, 1));
    let radius = f64::from(case.assembly.models[case.assembly.objects[planet as usize - 1].model].radius());
    let mut count = 0;
    for (layer, shown) in both {
        let off = DVec3::from(shown.body.map(f64::from)).distance(case.body(layer));
        assert!(off < 0.1 * radius, "the judge sees {}, shown is {:?}", case.body(layer), shown.body);
        count += 1;
    }
    assert!(count > 40, "only {count} pixels show the planet");
}
