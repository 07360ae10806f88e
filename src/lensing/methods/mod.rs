//! The methods of projection, a file each: what `project --method` and `render.method` of `game.toml` choose from by name.

pub mod exact;
pub mod flat;
pub mod paper;
pub mod table;

use std::fmt;

use crate::lensing::{self, Scheme, TableError};
use crate::spacetime::light::{self, Branch, Order};

pub use exact::Exact;
pub use flat::Flat;
pub use paper::Paper;
pub use table::Table;

/// A point and a camera, r_s = 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProjectionInput {
    /// The point's radius.
    pub r: f64,
    /// The angle at the hole between camera and point, radians, in (0, π).
    pub phi: f64,
    /// The camera's radius.
    pub camera: f64,
}

/// How a point is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// ψ in the rain frame at the camera, radians from the outward radial direction, in [0, π].
    pub psi_rain: f64,
    /// ψ in the static frame at the camera, radians; None at and under the horizon.
    pub psi_static: Option<f64>,
    /// T_arrival − T_emission in Painlevé–Gullstrand time, r_s/c.
    pub delay: f64,
}

impl Sight {
    /// From what a static camera at the radius `l` > 1 sees.
    pub fn from_static(psi: f64, delay: f64, l: f64) -> Sight {
        Sight { psi_rain: rain_from_static(psi, l), psi_static: Some(psi), delay }
    }
}

/// A point as a frame hands it to a method: in f64, and as the offset from the camera that f32 code works with.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// r, φ, L.
    pub input: ProjectionInput,
    /// r cos φ − L.
    pub along: f32,
    /// r sin φ.
    pub across: f32,
    /// r cos φ.
    pub height: f32,
}

impl From<ProjectionInput> for Vertex {
    fn from(input: ProjectionInput) -> Self {
        let ProjectionInput { r, phi, camera } = input;
        let half = (0.5 * phi).sin();
        // r cos φ − L in a form that keeps its digits near the camera.
        let along = (r - camera) - 2.0 * r * half * half;
        Vertex { input, along: along as f32, across: (r * phi.sin()) as f32, height: (r * phi.cos()) as f32 }
    }
}

/// A method of projection: the exact solution, a table, no hole at all.
pub trait Projector: Sync {
    /// How the image of order `order` is seen, or None where the method has no answer. The branch matters only where camera and point
    /// are both inside the horizon.
    fn project(&self, input: ProjectionInput, order: Order, branch: Branch) -> Option<Sight>;
}

/// ψ in the rain frame of what a static camera at the radius `l` > 1 sees at `psi`: aberration by β = 1/√l, written with half angles so
/// that it keeps its digits near π.
pub fn rain_from_static(psi: f64, l: f64) -> f64 {
    let beta = (1.0 / l).sqrt();
    2.0 * ((0.5 * psi).sin() * ((1.0 + beta) / (1.0 - beta)).sqrt()).atan2((0.5 * psi).cos())
}

/// Every method, the game's own first.
pub const METHODS: [Method; 4] = [table::METHOD, exact::METHOD, paper::METHOD, flat::METHOD];

/// Their names, in the same order.
pub const NAMES: [&str; METHODS.len()] = {
    let mut names = [""; METHODS.len()];
    let mut k = 0;
    while k < names.len() {
        names[k] = METHODS[k].name;
        k += 1;
    }
    names
};

/// A method of projection, as its file describes it.
#[derive(Clone, Copy)]
pub struct Method {
    /// Its name, on the command line and in `game.toml`.
    pub name: &'static str,
    /// What it does, in a few words.
    pub about: &'static str,
    /// Makes it, with the tables that it is given for a scheme and a number of nodes.
    pub make: fn(Load) -> Box<dyn Projector>,
    /// The same on the GPU: the file of `shaders/method/` and its text.
    pub shader: (&'static str, &'static str),
    /// The table that this looks up beside the constants of the camera: its scheme, and nodes along each axis.
    pub table: Option<(Scheme, usize)>,
    /// How many orders of images it knows.
    pub orders: u32,
    /// Whether light bends: else there is one image of each thing, and what hovers is at rest.
    pub bends: bool,
    /// Whether its images lie within the exact bounds, outside of which triangles are left out.
    pub is_exact: bool,
}

/// Where a method gets its table from, by scheme and nodes: [`filed`].
pub type Load<'a> = &'a dyn Fn(Scheme, usize) -> lensing::Table;

impl Method {
    /// The method, made. Tables that are not there yet are baked, which stderr is told of, and kept beside the committed one.
    pub fn made(&self) -> Box<dyn Projector> {
        (self.make)(&filed)
    }
}

impl Default for Method {
    fn default() -> Method {
        METHODS[0]
    }
}

impl PartialEq for Method {
    fn eq(&self, other: &Method) -> bool {
        self.name == other.name
    }
}

impl fmt::Debug for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// One line for each method.
pub fn help() -> String {
    let lines = METHODS.map(|method| format!("{:12} {}", method.name, method.about));
    format!(
        "Methods:\n  {}\n\nTables answer cameras at 0.05 to 5,000 r_s and points at 1.0005 to 10,000 r_s (those of Yamashita 2012 \
         from 1.01), and leave fields empty beyond.",
        lines.join("\n  ")
    )
}

/// The method called `name`, or None.
pub fn named(name: &str) -> Option<Method> {
    METHODS.into_iter().find(|method| method.name == name)
}

/// The table of a scheme with so many nodes: the committed one, or one from its file beside that, baked and written there if need be, with
/// a progress bar on stderr.
pub fn filed(scheme: Scheme, nodes: usize) -> lensing::Table {
    if (scheme, nodes) == (Scheme::Residual, lensing::SMALL_NODES) {
        return lensing::default_table();
    }
    let bar = std::sync::OnceLock::new();
    let finished = std::sync::Mutex::new(0.0);
    let complain = |wrong: &TableError| match wrong {
        TableError::Missing(path) => eprintln!("baking {} (once)", path.display()),
        wrong => eprintln!("lensrunner: {wrong}; baking the table again"),
    };
    let done = |share: f64| {
        if let Ok(mut sum) = finished.lock() {
            *sum += 1000.0 * share;
            bar.get_or_init(|| indicatif::ProgressBar::new(1000)).set_position(*sum as u64);
        }
    };
    let table = lensing::load_or_bake(&lensing::table_file(scheme, nodes), scheme, nodes, complain, done);
    if let Some(bar) = bar.get() {
        bar.finish_and_clear();
    }
    table
}

/// ψ in both frames of a ray that reaches a camera at u = 1/L, with its delay.
pub fn sight(slope: f64, energy: f64, delay: f64, u: f64) -> Sight {
    Sight { psi_rain: light::rain_angle(slope, energy, u), psi_static: light::static_angle(slope, energy, u), delay }
}
