//! What photo mode has been set to.

use bevy::prelude::*;

use crate::play::menus::entries::PhotoKnob;
use crate::play::photo::camera::{CameraMotion, FreeCamera};
use crate::render::settings::Settings;
use crate::render::stage::settings;
use crate::scene::GameConfig;
use crate::sim::snapshot::FrameCamera;

/// Sizes of saved pictures, in pixels; the largest has 16 million. None is that of the window.
pub(super) const SIZES: [Option<[u32; 2]>; 5] = [None, Some([1280, 720]), Some([1920, 1080]), Some([3840, 2160]), Some([5312, 2988])];
/// Field of view, in degrees: least, greatest, step.
pub(super) const FIELD: (f64, f64, f64) = (20.0, 130.0, 5.0);
/// Stops: least, greatest, step.
pub(super) const STOPS: (f64, f64, f64) = (-4.0, 4.0, 0.5);
/// Light that the lens spreads: least, greatest, step.
const BLOOM: (f64, f64, f64) = (0.0, 1.0, 0.05);

/// What photo mode has been set to.
#[derive(Resource, Clone, Copy, Debug)]
pub struct Photo {
    /// Where the camera is.
    pub camera: FreeCamera,
    /// The frame that photo mode began with: which ship is hidden or lit.
    pub(super) frame: FrameCamera,
    /// Stops lighter or darker.
    pub(super) stops: f64,
    /// Share of light that the lens spreads.
    pub(super) bloom: f64,
    /// Place in [`SIZES`].
    pub(super) size: usize,
    /// The panel is shown.
    pub panel: bool,
    /// For so many frames it is off, for a picture without it.
    pub makes_way: u32,
}

impl Photo {
    /// The camera of the frame. Away from its ship the camera sees that too.
    pub fn frame(&self) -> FrameCamera {
        let away = self.camera.position.distance(self.camera.home.position) > 1e-9;
        let camera = self.camera.observer();
        FrameCamera { camera, hidden: self.frame.hidden.filter(|_| !away), lit: self.frame.lit.filter(|_| !away) }
    }

    /// The configuration that the picture is drawn by.
    pub fn config(&self, config: &GameConfig) -> GameConfig {
        let mut config = config.clone();
        config.video.fov = self.camera.field_of_view.to_degrees();
        config.render.bloom = self.bloom;
        config.render.exposure_key = self.exposed(config.render.exposure_key, 1.0);
        config.disk.exposure_key = self.exposed(config.disk.exposure_key, 8.0);
        config
    }

    /// The renderer's settings by that configuration.
    pub fn settings(&self, config: &GameConfig) -> Settings {
        let exposure_key = self.exposed(config.render.exposure_key, 1.0) as f32;
        Settings { bloom: self.bloom as f32, exposure_key, ..settings(config) }
    }

    /// The light that what shines is brought to: without stops `key`, never more than `most`.
    fn exposed(&self, key: f64, most: f64) -> f64 {
        (key * self.stops.exp2()).clamp(0.01, most)
    }

    /// Width and height of the saved picture in pixels; None for those of the window.
    pub fn size(&self) -> Option<[u32; 2]> {
        SIZES[self.size]
    }

    /// The number of a knob, and between which ends it is turned.
    pub(super) fn number(&mut self, knob: PhotoKnob) -> Option<(&mut f64, (f64, f64, f64))> {
        match knob {
            PhotoKnob::Exposure => Some((&mut self.stops, STOPS)),
            PhotoKnob::Bloom => Some((&mut self.bloom, BLOOM)),
            _ => None,
        }
    }

    pub(super) fn turn(&mut self, knob: PhotoKnob, by: i32) {
        let round = |place: usize, count: usize| (place as i32 + by).rem_euclid(count as i32) as usize;
        match knob {
            PhotoKnob::FieldOfView => {
                let degrees = self.camera.field_of_view.to_degrees().round() + f64::from(by) * FIELD.2;
                self.camera.field_of_view = degrees.clamp(FIELD.0, FIELD.1).to_radians();
            }
            PhotoKnob::Motion => {
                let place = CameraMotion::ALL.iter().position(|motion| *motion == self.camera.motion).unwrap_or(0);
                self.camera.motion = CameraMotion::ALL[round(place, CameraMotion::ALL.len())];
            }
            PhotoKnob::Size => self.size = round(self.size, SIZES.len()),
            _ => {
                if let Some((number, (least, most, step))) = self.number(knob) {
                    *number = (*number + f64::from(by) * step).clamp(least, most);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::config::settings;
    use glam::DVec3;

    /// Whatever is turned stays allowed.
    #[test]
    fn every_knob_has_ends() {
        let camera = crate::spacetime::Observer {
            position: DVec3::X * 9.0,
            momentum: DVec3::ZERO,
            attitude: glam::DQuat::IDENTITY,
            field_of_view: 1.0,
        };
        let frame = FrameCamera { camera, hidden: Some(0), lit: Some(0) };
        let mut photo = Photo { camera: FreeCamera::at(camera), frame, stops: 0.0, bloom: 0.3, size: 0, panel: true, makes_way: 0 };
        assert_eq!(photo.frame().hidden, Some(0));
        for knob in [PhotoKnob::FieldOfView, PhotoKnob::Exposure, PhotoKnob::Bloom, PhotoKnob::Motion, PhotoKnob::Size] {
            for by in [1, -1] {
                for _ in 0..50 {
                    photo.turn(knob, by);
                    let config = photo.config(&GameConfig::default());
                    for setting in settings() {
                        assert!(setting.check(setting.get(&config)).is_ok(), "{knob:?}: {}", setting.path());
                    }
                }
            }
        }
        assert!(SIZES.iter().flatten().all(|[width, height]| width * height <= 16_000_000));
        photo.camera.moved(DVec3::X * 0.1, DVec3::ZERO);
        assert_eq!(photo.frame().hidden, None, "from aside the ship is seen");
    }
}
