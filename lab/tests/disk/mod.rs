//! The drawn disk against the exact one.

mod chase;
mod near;
mod order;
mod pictures;
mod polygons;
mod sprites;
mod thin;

use lensrunner::render::Renderer;
use lensrunner::render::disk::DrawnDisk;
use lensrunner::render::frame::FrameInput;
use lensrunner::render::settings::Settings;
use lensrunner::scene::GameConfig;
use lensrunner::spacetime::Observer;

use crate::render_support::settings;

/// The disk of a configuration that is the game's but for `change`.
fn disk_with(change: impl FnOnce(&mut GameConfig)) -> DrawnDisk {
    let mut config = GameConfig::default();
    change(&mut config);
    DrawnDisk::new(config.disk.clone(), &config)
}

/// So many image orders. With a budget of many pixels there is no third one unasked.
fn of_orders(orders: u32) -> Settings {
    Settings { orders, pixel_error: 100.0, ..settings() }
}

/// Linear light of the renderer's disk alone.
fn shown(renderer: &mut Renderer, camera: Observer, time: f64, settings: Settings) -> Vec<[f32; 3]> {
    let input = FrameInput { camera, time, placed: Vec::new(), held: None, aurora: None, settings };
    renderer.picture(&input, false).unwrap().linear.iter().map(|p| [p[0], p[1], p[2]]).collect()
}

/// The green of a picture in all.
fn green(picture: &[[f32; 3]]) -> f64 {
    picture.iter().map(|p| f64::from(p[1])).sum()
}
