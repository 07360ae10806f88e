//! A frame in which nothing new appears makes nothing: no buffer, texture, bind group, shader or pipeline.

use lensrunner::render::Renderer;
use lensrunner::render::gpu::layout::made;
use lensrunner::render::gpu::targets::target;
use lensrunner::render::shot::Moment;
use lensrunner::render::stage::{Stage, settings};
use lensrunner::scene::{GameConfig, load};

use crate::gpu::GPU;
use crate::render::support::renderer;

const SIZE: [u32; 2] = [160, 90];
/// Frames until all has been seen once.
const WARM: usize = 4;

/// The frames of a scene, a hundredth of r_s/c apart; what each makes.
fn makes(renderer: &mut Renderer, scene: &str) -> Vec<u64> {
    let config = GameConfig::default();
    let scene = load(scene).unwrap();
    let mut stage = Stage::new(renderer, &scene, &config);
    let moment = Moment::new(&scene, &config, 2.0, 1);
    let (_, view) = target(&GPU.device, "steady", SIZE, wgpu::TextureFormat::Rgba8UnormSrgb);
    let finest = settings(&config);
    let frame = |number: usize| {
        let time = moment.time() + 0.01 * number as f64;
        let frame = stage.frame(stage.camera(time, &moment.ships()), SIZE, time, &moment.histories(), None, &finest);
        let before = made();
        renderer.prepare(&frame);
        let mut encoder = GPU.device.create_command_encoder(&Default::default());
        renderer.encode(&mut encoder, &view);
        GPU.queue.submit([encoder.finish()]);
        GPU.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        made() - before
    };
    (0..WARM + 6).map(frame).collect()
}

#[test]
fn a_frame_without_anything_new_makes_nothing() {
    let mut renderer = renderer(SIZE);
    for scene in ["chase", "disk", "parade", "aurora-orbit"] {
        let makes = makes(&mut renderer, scene);
        println!("{scene}: {makes:?}");
        assert!(makes[0] > 0, "{scene}: the first frame makes what it needs");
        assert!(makes[WARM..].iter().all(|&made| made == 0), "{scene}: {makes:?}");
    }
}
