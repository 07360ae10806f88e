//! What is seen where the camera comes to the horizon: light from there climbs slowly, and each point of a ship is seen at a very different
//! time.

use lensrunner::judge::case::Case;
use lensrunner::judge::picture::Sampling;
use lensrunner::scene::{self, GameConfig};
use lensrunner_lab::contestant;

/// The camera of `plunge` at r = 1.12, 1.02 and 0.97: which ship a pixel shows is the judge's answer for all but rims. A pixel next to
/// another ship's is a rim, where a hundredth of a pixel decides; of what is left one in fifty may differ, for parts narrower than a pixel.
#[test]
fn ships_are_whole_where_the_camera_crosses_the_horizon() {
    let size = [96, 54];
    for at in [1.1, 1.2, 1.25] {
        let case = Case::new(scene::load("plunge").unwrap(), GameConfig::default(), at, size);
        let frame = contestant::draw(&case).unwrap();
        let judge = case.trace(&Sampling { samples: 1, tolerance: 1e-9, packet: 8 }, false, &|_| ());
        let wanted = |x: usize, y: usize| judge.layers[y * size[0] as usize + x].object;
        let (mut inner, mut wrong) = (0, 0);
        for y in 1..size[1] as usize - 1 {
            for x in 1..size[0] as usize - 1 {
                let object = wanted(x, y);
                if [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)].iter().any(|&(x, y)| wanted(x, y) != object) {
                    continue;
                }
                inner += u32::from(object != 0);
                wrong += u32::from(frame.shown[y * size[0] as usize + x].object != object);
            }
        }
        assert!(inner > 150, "T = {at}: only {inner} pixels show ships");
        assert!(50 * wrong <= inner, "T = {at}: {wrong} pixels show another ship than the judge's, {inner} show ships");
    }
}

/// The camera of `plunge` at r = 0.69, a ship beside it: of its parts, some a hundredth of r_s behind others, the nearest is seen. A point
/// of the ship is where the judge sees it to a fiftieth of its length but for rims of parts; of the pixels that show ships one in three
/// hundred may differ.
#[test]
fn parts_of_a_ship_beside_the_camera_hide_each_other() {
    let size = [160, 90];
    let case = Case::new(scene::load("plunge").unwrap(), GameConfig::default(), 1.5, size);
    let frame = contestant::draw(&case).unwrap();
    let judge = case.trace(&Sampling { samples: 1, tolerance: 1e-9, packet: 8 }, false, &|_| ());
    let (mut inner, mut wrong) = (0, 0);
    for y in 1..size[1] as usize - 1 {
        for x in 1..size[0] as usize - 1 {
            let at = |x: usize, y: usize| &judge.layers[y * size[0] as usize + x];
            let here = at(x, y);
            let body = case.body(here);
            let around = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
            if here.object == 0 || around.iter().any(|&(x, y)| at(x, y).object != here.object || case.body(at(x, y)).distance(body) > 0.02)
            {
                continue;
            }
            let shown = frame.shown[y * size[0] as usize + x];
            inner += 1;
            wrong += u32::from(shown.object != here.object || glam::DVec3::from(shown.body.map(f64::from)).distance(body) > 0.02);
        }
    }
    assert!(inner > 2000, "only {inner} pixels show ships");
    assert!(300 * wrong <= inner, "{wrong} of {inner} pixels show another part of a ship than the judge sees");
}
