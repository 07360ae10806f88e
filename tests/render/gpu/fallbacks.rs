//! Adapters that lack what is optional draw the same pictures.

use lensrunner::render::gpu::readback::ReadbackPicture;
use lensrunner::render::renderer::Surroundings;
use lensrunner::render::stage::{Stage, settings};
use lensrunner::render::{Gpu, Renderer};
use lensrunner::scene::{self, GameConfig};

use crate::gpu::GPU;
use crate::render::support::{apart, surroundings, total};

fn drawn(gpu: &Gpu, surroundings: &Surroundings, name: &str, size: [u32; 2]) -> ReadbackPicture {
    let mut config = GameConfig::default();
    config.aurora.streaks = 4000;
    let mut renderer = Renderer::new(gpu, surroundings, wgpu::TextureFormat::Rgba8UnormSrgb, size);
    let mut stage = Stage::new(&mut renderer, &scene::load(name).unwrap(), &config);
    let mut settings = settings(&config);
    (settings.stars, settings.milky_way, settings.bloom) = (false, false, 0.0);
    let input = stage.frame(stage.camera(0.0, &[]), size, 0.0, &[], None, &settings);
    renderer.picture(&input, false).unwrap()
}

/// Without timestamps, and without tables filtered and light added up in 32-bit floats: the aurora is added up in halves then, which lose
/// half a per cent of its light here.
#[test]
fn without_optional_features_the_picture_is_the_same() {
    let plain = Gpu::headless_with(wgpu::Features::empty()).unwrap();
    let size = [256, 144];
    let surroundings = surroundings();
    for (name, allowed, light_allowed) in [("aurora-orbit", 0.02, 0.015), ("aurora-below", 0.02, 0.015), ("disk-80", 1e-3, 1e-3)] {
        let [got, want] = [&plain, &GPU].map(|gpu| drawn(gpu, &surroundings, name, size));
        assert!(plain.watch.complaint().is_none(), "{name}: {:?}", plain.watch.complaint());
        let (off, ratio) = (apart(&got, &want), total(&got) / total(&want));
        println!("{name}: off by {off:.4} (root mean square), {ratio:.4} of the light");
        assert!(total(&want) > 0.0 && off < allowed && (ratio - 1.0).abs() < light_allowed);
    }
}
