//! The guard: what lies outside of where an object's image can be is not drawn, and counted. That nothing does in scenes is told by every
//! test that compares them.

use glam::{DQuat, DVec3};
use lensrunner::lensing::Slice;
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::readback::Picture;
use lensrunner::render::instances::{Motion, Placed, View, instances_of};
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::static_camera;
use lensrunner::spacetime::Observer;

use crate::render::lookup::{Bench, bench};

fn camera() -> Observer {
    static_camera(DVec3::new(0.0, 0.0, 15.0), DVec3::NEG_Z, DVec3::Y, 60f64.to_radians())
}

fn ball(bench: &Bench, position: DVec3, settings: &Settings) -> Vec<Placed> {
    let (camera, object) = (camera(), bench.object(Motion::Held { position, attitude: DQuat::IDENTITY }, 1.0, 1));
    let slice = Slice::new(bench.renderer.table(), camera.radius());
    let pixel = camera.field_of_view / f64::from(bench.renderer.size()[0]);
    instances_of(&View { camera: &camera, slice: &slice, pixel, aspect: None, settings }, 0.0, &object, settings.orders)
}

/// How many pixels show the ball, and how many of its triangles were left out.
fn drawn(bench: &mut Bench, placed: Vec<Placed>, settings: Settings) -> (usize, u32, Picture) {
    let picture = bench.renderer.picture(&FrameInput { camera: camera(), time: 0.0, placed, aurora: None, settings }, true).unwrap();
    let counters = bench.renderer.counters().unwrap();
    assert_eq!(counters.complaint().is_some_and(|text| text.contains("outside")), counters.outside > 0);
    (picture.layers.iter().filter(|texel| texel[0] == 1.0).count(), counters.outside, picture)
}

#[test]
fn what_is_out_of_bounds_is_left_out_and_counted() {
    let mut bench = bench();
    let settings = Settings { stars: false, milky_way: false, bloom: 0.0, min_width: 0.0, orders: 2, ..Settings::finest() };
    // Behind the hole on the axis and beside it, with both images round the shadow; beside it, and before it.
    let places = [[0.0, 0.0, -9.0], [0.3, 0.2, -9.0], [4.0, 0.0, -9.0], [-5.0, 0.0, 0.0], [2.0, -1.0, 6.0]].map(DVec3::from_array);
    for here in places {
        let placed = ball(&bench, here, &settings);
        assert!(placed.iter().all(|placed| placed.instance.bounds.iter().any(|cap| cap[3] != 0.0)));
        let mut free = placed.clone();
        free.iter_mut().for_each(|placed| placed.instance.bounds = Default::default());
        let (shown, outside, picture) = drawn(&mut bench, placed, settings);
        assert_eq!(outside, 0, "{here}");
        assert!(shown > 0, "{here}: {shown}");
        let (_, _, unguarded) = drawn(&mut bench, free, settings);
        assert_eq!(picture.layers, unguarded.layers, "{here}");
    }
    // With the bounds of a place whose first image is elsewhere nothing is left of the first.
    for (here, there) in [(2, 3), (3, 2), (4, 3), (3, 4)] {
        let bounds = ball(&bench, places[there], &settings)[0].instance.bounds;
        let mut placed = ball(&bench, places[here], &settings);
        placed.truncate(1);
        placed[0].instance.bounds = bounds;
        let (shown, outside, _) = drawn(&mut bench, placed, settings);
        assert!(shown == 0 && outside > 0, "{}: {shown} {outside}", places[here]);
    }
    // On the axis with the bounds of a smaller ring: what reaches across the shadow, or out of the ring, is left out.
    let mut placed = ball(&bench, places[0], &settings);
    for placed in &mut placed {
        let [high, low, _] = placed.instance.bounds;
        placed.instance.bounds = [[high[0], high[1], high[2], high[3] * 1.5], low, [0.0; 4]];
    }
    assert!(drawn(&mut bench, placed, settings).1 > 0);
}
