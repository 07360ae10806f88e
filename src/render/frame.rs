//! What one frame needs from below: a camera, things to see, settings. Plain data, made by `extract` in the game and by hand in tests.

use crate::spacetime::Observer;
use glam::DVec3;

use crate::scene::stars::SKY_UNIT;
use crate::scene::{blackbody, milky_way};
use crate::spacetime::orbit::static_momentum;
use crate::spacetime::{frames, light};

use super::aurora::AuroraFrame;
use super::method::Method;
use super::placements::Placed;
use super::types::{self, flags};

/// How the picture is made; the numbers come from `game.toml`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Greatest error of any drawn point, in pixels.
    pub pixel_error: f32,
    /// Image orders drawn, 1 to 3.
    pub orders: u32,
    /// How a vertex is projected.
    pub method: Method,
    /// Moving things are seen where they were when the light left.
    pub light_delay: bool,
    /// How often an edge of a model may be halved.
    pub halvings: u32,
    /// Room for the vertices of the mesh stage.
    pub vertex_budget: u32,
    /// Triangles of thin images are drawn at least this wide, in pixels; 0: there are no thin images.
    pub min_width: f32,
    /// Images narrower than this are thin ones, in pixels: from two down single triangles would miss pixel centres.
    pub thin_below: f64,
    /// Images narrower than this show the coarse model, in pixels: at six its cells (a sixth of the object) are a pixel wide.
    pub coarse_below: f64,
    /// Images of order 2 and 3 narrower than this are not drawn, in pixels: a line of which they cover a twentieth is lost among the stars that
    /// crowd at the edge of the shadow, and the stages of geometry would take longer over it than over the ship itself.
    pub least_width: f64,
    /// Light changes its colour with g.
    pub doppler: bool,
    /// Light changes its strength with g.
    pub beaming: bool,
    /// Stars are drawn.
    pub stars: bool,
    /// The Milky Way is drawn.
    pub milky_way: bool,
    /// Factor on the light of stars.
    pub star_brightness: f32,
    /// Standard deviation of a star's spot, in pixels.
    pub star_sigma: f32,
    /// Stars of less flux (1 for magnitude 0) are left out.
    pub faintest_star: f32,
    /// Factor on the light of the Milky Way.
    pub sky_brightness: f32,
    /// Share of the light that the lens spreads.
    pub bloom: f32,
    /// Least and greatest exposure.
    pub exposure_range: [f32; 2],
    /// The light that the metered part of the picture is brought to, of 1 for white.
    pub exposure_key: f32,
    /// Factor on the exposure that was found.
    pub exposure_bias: f32,
    /// How far the exposure moves in this frame towards what it should be, (0, 1]; 1 at once.
    pub adaptation: f32,
    /// The exposure stays as it is.
    pub hold_exposure: bool,
    /// The player's own ship, by its number among the scene's: lit for the picture and not metered. None for what is measured.
    pub own_ship: Option<usize>,
    /// Greatest thrust (c²/r_s) of ships that hunt and of those that flee, where the scene does not say it: nozzles shine by what share of it the ship
    /// burns. None: as at full thrust.
    pub engines: Option<[f64; 2]>,
    /// Least and greatest light that middle grey on the own ship is brought to, of 1 for white.
    pub fill: [f32; 2],
    /// The circle of the picture that the meter leaves out: its middle from the picture's, right and down, and its radius (0: none), in widths of the picture.
    /// The stage says it.
    pub unmetered: [f32; 3],
    /// Outlines of bodies are smoothed.
    pub smooth: bool,
    /// Nearest drawn distance, in r_s.
    pub near: f32,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            pixel_error: 0.25,
            orders: 3,
            method: Method::Table,
            light_delay: true,
            halvings: 13,
            vertex_budget: 600_000,
            min_width: 1.0,
            thin_below: 1.0,
            coarse_below: 0.0,
            least_width: 0.05,
            doppler: true,
            beaming: true,
            stars: true,
            milky_way: true,
            star_brightness: 1.0,
            star_sigma: 0.7,
            faintest_star: 0.0,
            sky_brightness: 1.0,
            bloom: 0.08,
            exposure_range: [1e-4, 40.0],
            exposure_key: 0.35,
            exposure_bias: 1.0,
            adaptation: 1.0,
            hold_exposure: false,
            own_ship: None,
            engines: None,
            fill: [0.0, f32::MAX],
            unmetered: [0.0; 3],
            smooth: true,
            near: 1e-3,
        }
    }
}

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

/// Room in the buffers of geometry: past it patches are drawn coarser, and counted.
#[derive(Clone, Copy, Debug)]
pub struct Capacity {
    /// Seen vertices.
    pub vertices: u32,
    /// Indices of opaque triangles.
    pub indices: u32,
    /// Pieces and work items.
    pub work: u32,
    /// Vertices of thin triangles.
    pub thin: u32,
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
    ] {
        if on {
            switches |= bit;
        }
    }
    let bends = settings.method.bends();
    // Without a hole there is no rain: all directions are those of what hovers.
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
    }
}

/// Temperatures of the ends of [`blackbody_table`], in K; as in functions/colour.wgsl.
pub const BLACKBODY_COLDEST: f32 = 200.0;
/// The upper end, in K.
pub const BLACKBODY_HOTTEST: f32 = 2.0e6;

/// The table of black bodies: ln of linear sRGB radiance over ln T, relative to the luminance at 5,772 K.
pub fn blackbody_table() -> Vec<[f32; 4]> {
    blackbody::table(512, BLACKBODY_COLDEST, BLACKBODY_HOTTEST)
}
