//! What one frame is made from: a camera, objects, settings. Plain data, made by the stage in the game and by hand in tests.

use crate::render::settings::Settings;
use crate::spacetime::Observer;
use glam::DVec3;

use crate::scene::blackbody;
use crate::scene::sky::milky_way;
use crate::scene::sky::stars::SKY_UNIT;
use crate::spacetime::orbit::static_momentum;
use crate::spacetime::{frames, light};

use crate::render::aurora::AuroraFrame;
use crate::render::gpu::types::{self, Capacity, flags as flag};
use crate::render::instances::Placed;

/// All that a frame shows.
#[derive(Debug)]
pub struct FrameInput {
    /// The camera.
    pub camera: Observer,
    /// The clock T, in r_s/c.
    pub time: f64,
    /// Objects in each order they are seen in.
    pub placed: Vec<Placed>,
    /// Bits of [`placed`](types::placed) that every image of what the scene holds gets besides; None: nothing of it is drawn. What is held
    /// the renderer has ([`SceneUpload`](crate::render::renderer::SceneUpload)).
    pub held: Option<u32>,
    /// The aurora, if there is one in sight.
    pub aurora: Option<AuroraFrame>,
    /// How to draw.
    pub settings: Settings,
}

impl Clone for FrameInput {
    fn clone(&self) -> Self {
        FrameInput { placed: self.placed.clone(), aurora: self.aurora.clone(), ..*self }
    }

    fn clone_from(&mut self, other: &Self) {
        self.placed.clone_from(&other.placed);
        self.aurora.clone_from(&other.aurora);
        (self.camera, self.time, self.held, self.settings) = (other.camera, other.time, other.held, other.settings);
    }
}

impl FrameInput {
    /// Whether bodies are drawn.
    pub fn has_bodies(&self) -> bool {
        self.held.is_some() || !self.placed.is_empty()
    }
}

/// The uniform of a frame of `size` pixels.
pub fn uniform(input: &FrameInput, size: [u32; 2], capacity: Capacity) -> types::Frame {
    let camera = &input.camera;
    let settings = &input.settings;
    let [n, a, b] = camera.axis_frame();
    let radius = camera.radius();
    let cot = 1.0 / (0.5 * camera.field_of_view).tan();
    let pixel = 2.0 / (cot * f64::from(size[0]));
    let mut flags = 0;
    for (on, bit) in [
        (settings.doppler, flag::DOPPLER),
        (settings.beaming, flag::BEAMING),
        (radius < 1.0, flag::INSIDE),
        (settings.hold_exposure, flag::HOLD_EXPOSURE),
        (settings.midpoint, flag::MIDPOINT),
    ] {
        if on {
            flags |= bit;
        }
    }
    let bends = settings.method.bends;
    // Without a hole there is no rain frame: all directions are those of static observers.
    let river = if bends { DVec3::ZERO } else { static_momentum(camera.position).unwrap_or(DVec3::ZERO) };
    let axis = |v: DVec3| v.as_vec3().to_array();
    let edge = if bends { light::shadow_angle(1.0 / radius) } else { std::f64::consts::PI };
    let enlargement = 1.0 / settings.resolution.clamp(1e-3, 1.0);
    types::Frame {
        camera_from_rain: (camera.camera_from_rain() * frames::boost(-river)).as_mat4().to_cols_array_2d(),
        rain_from_camera: (frames::boost(river) * camera.rain_from_camera()).as_mat4().to_cols_array_2d(),
        outward: axis(n),
        camera_radius: radius as f32,
        side_a: axis(a),
        least_width: settings.min_width,
        side_b: axis(b),
        river_speed: if bends { (1.0 / radius).sqrt() as f32 } else { 0.0 },
        focal: [cot as f32, (cot * f64::from(size[0]) / f64::from(size[1])) as f32],
        near: settings.near,
        time: input.time as f32,
        size: size.map(|pixels| pixels as f32),
        pixel: pixel as f32,
        error_budget: (pixel * f64::from(settings.pixel_error)) as f32,
        exposure_bias: settings.exposure_bias,
        // A spot spreads a star's light over pixels of the output, of this solid angle.
        star_brightness: settings.star_brightness * SKY_UNIT / (pixel * pixel) as f32 * (enlargement * enlargement),
        sky_brightness: if settings.milky_way { settings.sky_brightness * SKY_UNIT * milky_way::PEAK } else { 0.0 },
        bloom: settings.bloom,
        least_exposure: settings.exposure_range[0],
        greatest_exposure: settings.exposure_range[1],
        adaptation: settings.adaptation,
        shadow_edge: edge as f32,
        flags,
        halvings: settings.halvings,
        star_sigma: settings.star_sigma,
        faintest_star: settings.faintest_star,
        capacity,
        least_fill: settings.fill[0],
        greatest_fill: settings.fill[1],
        // The exposure of the frame before is copied in on the device.
        last_exposure: 1.0,
        exposure_known: 0.0,
        unmetered_middle: [settings.unmetered[0], settings.unmetered[1]],
        unmetered_radius: settings.unmetered[2],
        exposure_key: settings.exposure_key,
        disk_indices: [0; 4],
        exposure_key_without_disk: settings.exposure_key,
        most_rise: settings.rise,
        // Over what, the renderer knows.
        rise_per_luminance: 0.0,
        enlargement,
    }
}

/// Temperatures of the ends of [`blackbody_table`], in K; as in gpu/colour.wgsl.
pub const BLACKBODY_COLDEST: f32 = 200.0;
/// The upper end, in K.
pub const BLACKBODY_HOTTEST: f32 = 2.0e6;

/// The table of black bodies: ln of linear sRGB radiance over ln T, relative to the luminance at 5,772 K.
pub fn blackbody_table() -> Vec<[f32; 4]> {
    blackbody::table(512, BLACKBODY_COLDEST, BLACKBODY_HOTTEST)
}
