//! How the picture is made.

use crate::lensing::methods::Method;

/// How the picture is made; the numbers come from `game.toml`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Width of the picture that is drawn, as a share of the output's, in (0, 1]; it is enlarged to the output.
    pub resolution: f32,
    /// Greatest error of any drawn point, in pixels of what is drawn.
    pub pixel_error: f32,
    /// Image orders drawn, 1 to 3.
    pub orders: u32,
    /// How a vertex is projected.
    pub method: Method,
    /// Moving things are seen where they were when the light left.
    pub light_delay: bool,
    /// How often an edge of a model may be halved.
    pub halvings: u32,
    /// Edges are divided by the criterion of Yamashita 2025 instead, to be measured beside: the error of the midpoint alone, all edges
    /// alike.
    pub midpoint: bool,
    /// Room for the vertices of the mesh stage.
    pub vertex_budget: u32,
    /// Triangles of thin images are drawn at least this wide, in pixels; 0: there are no thin images.
    pub min_width: f32,
    /// Images narrower than this are thin ones, in pixels: from two down single triangles would miss pixel centres.
    pub thin_below: f64,
    /// Images narrower than this show the coarse model, in pixels: at six its cells (a sixth of the object) are a pixel wide.
    pub coarse_below: f64,
    /// Images of order 2 and 3 narrower than this are not drawn, in pixels. At 0.05 px they cover 5 % of a line of pixels. They are
    /// invisible among the stars at the edge of the shadow, yet cost more geometry than the ship itself.
    pub least_width: f64,
    /// Factor on the errors that rings and arcs of the disk may have: greater ones make wider rings.
    pub ring_error: f32,
    /// Most positions along a pixel at which a camera close to the disk looks gas up, 1 to 16; from far they are two.
    pub gas_looks: f32,
    /// Share of the aurora's streaks that is drawn, wider in turn.
    pub streaks: f32,
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
    /// Standard deviation of a star's spot, in pixels of the output.
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
    /// How far the mean luminance of the picture as shown may rise in this frame, of 1 for white; infinite: as it likes. See
    /// [`greatest_rise`].
    pub rise: f32,
    /// The exposure stays as it is.
    pub hold_exposure: bool,
    /// The player's own ship, by its number among the scene's: lit for the picture and not metered. None for what is measured.
    pub own_ship: Option<usize>,
    /// Greatest thrust (c²/r_s) of ships that hunt and of those that flee, if the scene does not give it: nozzles shine by the share of it
    /// that the ship burns. None: as at full thrust.
    pub engines: Option<[f64; 2]>,
    /// Least and greatest light that middle grey on the own ship is brought to, of 1 for white.
    pub fill: [f32; 2],
    /// The circle of the picture that the meter leaves out: its middle from the picture's, right and down, and its radius (0: none), in
    /// widths of the picture. The stage says it.
    pub unmetered: [f32; 3],
    /// Outlines of bodies are smoothed.
    pub smooth: bool,
    /// Nearest drawn distance, in r_s.
    pub near: f32,
}

/// Light that any middle grey may have: the own ship is drawn as it is lit.
pub const ANY_FILL: [f32; 2] = [0.0, f32::MAX];

/// How fast the mean luminance of the picture may rise with `accessibility.reduced_flashes`, of 1 for white, in 1/s.
pub const GREATEST_RISE: f64 = 0.1;
/// A frame that took longer counts as this, in s: after a wait the picture must not jump by what has gathered.
const LONGEST_FRAME: f64 = 0.1;

/// [`Settings::rise`] of a frame that took `seconds`, if it is bound.
pub fn greatest_rise(reduced_flashes: bool, seconds: f64) -> f32 {
    if reduced_flashes { (GREATEST_RISE * seconds.clamp(0.0, LONGEST_FRAME)) as f32 } else { f32::INFINITY }
}

impl Settings {
    /// All that can be drawn, at its finest, as it shines: what tests measure. The game draws by [`super::stage::settings`].
    pub fn finest() -> Self {
        Settings {
            resolution: 1.0,
            pixel_error: 0.25,
            orders: 3,
            method: Method::default(),
            light_delay: true,
            halvings: 13,
            midpoint: false,
            vertex_budget: 1_200_000,
            min_width: 1.0,
            thin_below: 2.0,
            coarse_below: 0.0,
            least_width: 0.05,
            ring_error: 1.0,
            gas_looks: 16.0,
            streaks: 1.0,
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
            rise: f32::INFINITY,
            hold_exposure: false,
            own_ship: None,
            engines: None,
            fill: ANY_FILL,
            unmetered: [0.0; 3],
            smooth: true,
            near: 1e-3,
        }
    }
}
