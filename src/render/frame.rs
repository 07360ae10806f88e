//! What one frame is made from: a camera, objects, settings. Plain data, made by the stage in the game and by hand in tests.

use crate::render::settings::{Capacity, Settings};
use crate::spacetime::Observer;
use glam::DVec3;

use crate::scene::blackbody;
use crate::scene::sky::milky_way;
use crate::scene::sky::stars::SKY_UNIT;
use crate::spacetime::orbit::static_momentum;
use crate::spacetime::{frames, light};

use crate::render::aurora::AuroraFrame;
use crate::render::gpu::types::{self, flags};
use crate::render::instances::Placed;

/// All that a frame shows.
#[derive(Clone, Debug)]
pub struct FrameInput {
    /// The camera.
    pub camera: Observer,
    /// The clock T, in r_s/c.
    pub time: f64,
    /// Objects in each order they are seen in.
    pub placed: Vec<Placed>,
    /// The aurora, if there is one in sight.
    pub aurora: Option<AuroraFrame>,
    /// How to draw.
    pub settings: Settings,
}

/// The uniform of a frame of `size` pixels.
pub fn uniform(input: &FrameInput, size: [u32; 2], capacity: Capacity) -> types::Frame {
    let camera = &input.camera;
    let settings = &input.settings;
    let [n, a, b] = camera.axis_frame();
    let radius = camera.radius();
    let cot = 1.0 / (0.5 * camera.field_of_view).tan();
    let pixel = 2.0 / (cot * f64::from(size[0]));
    let mut switches = 0;
    for (on, bit) in [
        (settings.doppler, flags::DOPPLER),
        (settings.beaming, flags::BEAMING),
        (radius < 1.0, flags::INSIDE),
        (settings.hold_exposure, flags::HOLD_EXPOSURE),
        (settings.midpoint, flags::MIDPOINT),
    ] {
        if on {
            switches |= bit;
        }
    }
    let bends = settings.method.bends();
    // Without a hole there is no rain frame: all directions are those of static observers.
    let river = if bends { DVec3::ZERO } else { static_momentum(camera.position).unwrap_or(DVec3::ZERO) };
    let row = |v: DVec3, w: f64| [v.x as f32, v.y as f32, v.z as f32, w as f32];
    let edge = if bends { light::shadow_angle(1.0 / radius) } else { std::f64::consts::PI };
    types::Frame {
        camera_from_rain: (camera.camera_from_rain() * frames::boost(-river)).as_mat4().to_cols_array_2d(),
        rain_from_camera: (frames::boost(river) * camera.rain_from_camera()).as_mat4().to_cols_array_2d(),
        radial: row(n, radius),
        side_a: row(a, f64::from(settings.min_width)),
        side_b: row(b, if bends { (1.0 / radius).sqrt() } else { 0.0 }),
        projection: [cot as f32, (cot * f64::from(size[0]) / f64::from(size[1])) as f32, settings.near, input.time as f32],
        size: [size[0] as f32, size[1] as f32, pixel as f32, (pixel * f64::from(settings.pixel_error)) as f32],
        light: [
            settings.exposure_bias,
            // A spot spreads a star's light over pixels of this solid angle.
            settings.star_brightness * SKY_UNIT / (pixel * pixel) as f32,
            if settings.milky_way { settings.sky_brightness * SKY_UNIT * milky_way::PEAK } else { 0.0 },
            settings.bloom,
        ],
        exposure: [settings.exposure_range[0], settings.exposure_range[1], settings.adaptation, edge as f32],
        switches: [switches, settings.halvings, 0, settings.orders],
        sky_x: [1.0, 0.0, 0.0, settings.exposure_key],
        sky_y: [0.0, 1.0, 0.0, settings.star_sigma],
        sky_z: [0.0, 0.0, 1.0, settings.faintest_star],
        capacity: [capacity.vertices, capacity.indices, capacity.work, capacity.thin],
        // The exposure of the frame before is copied in on the device.
        fill: [settings.fill[0], settings.fill[1], 1.0, 0.0],
        unmetered: [settings.unmetered[0], settings.unmetered[1], settings.unmetered[2], settings.exposure_key],
        disk: [0; 4],
        // Over what, the renderer knows.
        rise: [settings.rise, 0.0, 0.0, 0.0],
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
