//! What several tests of the renderer need.

use std::ops::{Deref, DerefMut};
use std::sync::{Mutex, PoisonError};

use glam::DVec3;
use lensrunner::render::Renderer;
use lensrunner::render::disk::DrawnDisk;
use lensrunner::render::frame::FrameInput;
use lensrunner::render::gpu::readback::ReadbackPicture;
use lensrunner::render::renderer::{SceneUpload, Surroundings};
use lensrunner::render::settings::Settings;
use lensrunner::render::stage::{self, Stage, static_camera};
use lensrunner::scene::GameConfig;
use lensrunner::spacetime::Observer;

use crate::gpu::GPU;
use crate::support::shared_table;

/// A sky without light, seen through the committed table.
pub fn surroundings() -> Surroundings {
    Surroundings { table: shared_table(), stars: Vec::new(), milky_way: vec![(1, 1, vec![0.0])] }
}

/// A renderer of pictures of a size under such a sky.
pub fn renderer_under(surroundings: &Surroundings, size: [u32; 2]) -> Renderer {
    Renderer::new(&GPU, surroundings, wgpu::TextureFormat::Rgba8UnormSrgb, size)
}

/// The same under a sky without light, one that another test has done with if there is one: most of a renderer's time here is the compiling
/// of its passes.
pub fn renderer(size: [u32; 2]) -> LentRenderer {
    let idle = IDLE.lock().unwrap_or_else(PoisonError::into_inner).pop();
    let mut renderer = idle.unwrap_or_else(|| renderer_under(&surroundings(), size));
    renderer.resize(size);
    renderer.upload(&SceneUpload::default());
    renderer.set_counting(false);
    renderer.nothing_shown();
    LentRenderer(Some(renderer))
}

/// Renderers that no test uses now.
static IDLE: Mutex<Vec<Renderer>> = Mutex::new(Vec::new());

/// A renderer that the next test gets.
pub struct LentRenderer(Option<Renderer>);

impl Deref for LentRenderer {
    type Target = Renderer;

    fn deref(&self) -> &Renderer {
        self.0.as_ref().expect("it is given back last")
    }
}

impl DerefMut for LentRenderer {
    fn deref_mut(&mut self) -> &mut Renderer {
        self.0.as_mut().expect("it is given back last")
    }
}

impl Drop for LentRenderer {
    fn drop(&mut self) {
        // What a failed test leaves is not trusted.
        if !std::thread::panicking() {
            IDLE.lock().unwrap_or_else(PoisonError::into_inner).extend(self.0.take());
        }
    }
}

/// A hovering camera `degrees` from the disk's axis at radius `l`, looking at the hole.
pub fn camera(l: f64, degrees: f64, field_of_view: f64) -> Observer {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let position = DVec3::new(0.0, -l * sine, l * cosine);
    static_camera(position, -position, DVec3::new(0.1, 0.0, 1.0), field_of_view)
}

/// The disk of the game.
pub fn a_disk() -> DrawnDisk {
    let config = GameConfig::default();
    DrawnDisk::new(config.disk.clone(), &config)
}

/// Without a sky and without what blurs.
pub fn settings() -> Settings {
    Settings { stars: false, milky_way: false, bloom: 0.0, ..Settings::finest() }
}

/// The aurora alone: no planet, no sky.
pub fn aurora_alone(stage: &mut Stage, camera: Observer, size: [u32; 2], time: f64, config: &GameConfig) -> FrameInput {
    let mut settings = stage::settings(config);
    (settings.stars, settings.milky_way, settings.bloom) = (false, false, 0.0);
    let mut frame = stage.frame(camera, size, time, &[], None, &settings);
    frame.placed.clear();
    frame.held = None;
    frame
}

/// Light of an sRGB byte, from 0 to 1.
pub fn linear(encoded: u8) -> f64 {
    let value = f64::from(encoded) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// The root mean square of the difference from `want`, over that of `want`.
pub fn apart(got: &ReadbackPicture, want: &ReadbackPicture) -> f64 {
    let square = |p: &[f32; 4], q: &[f32; 4]| (0..3).map(|k| f64::from(p[k] - q[k]).powi(2)).sum::<f64>();
    let off: f64 = got.linear.iter().zip(&want.linear).map(|(p, q)| square(p, q)).sum();
    let all: f64 = want.linear.iter().map(|p| square(p, &[0.0; 4])).sum();
    (off / all).sqrt()
}

/// The light in a picture.
pub fn total(picture: &ReadbackPicture) -> f64 {
    picture.linear.iter().map(|p| f64::from(p[0] + p[1] + p[2])).sum()
}
