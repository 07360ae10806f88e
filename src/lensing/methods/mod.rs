//! The methods of projection, each by its name: what is raced in the chart `projection` and chosen in `project --method`.

mod analytic;
mod exact;
mod integrate;
mod paper;
mod residual;
mod slice;

use crate::lensing::{self, Scheme, TableError};
use crate::spacetime::light::{self, Branch, Order};

pub use analytic::{Approximation, Flat};
pub use exact::Exact;
pub use integrate::Integrate;
pub use paper::{Paper, PaperBatch};
pub use residual::{Interpolation, Residual, Texels};
pub use slice::{Batch, Newton, Reformatted, Table};

/// A point and a camera, r_s = 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Query {
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
    fn from_static(psi: f64, delay: f64, l: f64) -> Sight {
        Sight { psi_rain: rain_from_static(psi, l), psi_static: Some(psi), delay }
    }
}

/// A point as a frame hands it to a method: in f64, and as the offset from the camera that f32 code works with.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// r, φ, L.
    pub query: Query,
    /// r cos φ − L.
    pub along: f32,
    /// r sin φ.
    pub across: f32,
    /// r cos φ.
    pub height: f32,
}

impl From<Query> for Vertex {
    fn from(query: Query) -> Self {
        let Query { r, phi, camera } = query;
        let half = (0.5 * phi).sin();
        // r cos φ − L in a form that keeps its digits near the camera.
        let along = (r - camera) - 2.0 * r * half * half;
        Vertex { query, along: along as f32, across: (r * phi.sin()) as f32, height: (r * phi.cos()) as f32 }
    }
}

/// A method of projection: the exact solution, a table, an approximation.
pub trait Projector: Sync {
    /// How the image of order `order` is seen, or None where the method has no answer. The branch matters only where camera and point
    /// are both inside the horizon.
    fn project(&self, query: Query, order: Order, branch: Branch) -> Option<Sight>;

    /// The method made ready for the frames of a camera at the radius `l`, as the game would use it.
    fn frame(&self, l: f64) -> Box<dyn Frame + '_>;

    /// Bytes of tables that it keeps.
    fn memory(&self) -> usize {
        0
    }
}

/// A method ready for one camera radius. It gives what the method itself gives (an angle, or a direction with momenta), without
/// converting it into a [`Sight`]: this is what is timed.
pub trait Frame {
    /// Looks every point up in `order` and drops the answers where the compiler cannot see it.
    fn look_up(&self, points: &[Vertex], order: Order);
}

/// A frame that answers by calling a function for each point.
struct Each<F>(F);

impl<R, F: Fn(&Vertex, Order) -> R> Frame for Each<F> {
    fn look_up(&self, points: &[Vertex], order: Order) {
        for point in points {
            std::hint::black_box((self.0)(point, order));
        }
    }
}

fn each<'a, R: 'a>(answer: impl Fn(&Vertex, Order) -> R + 'a) -> Box<dyn Frame + 'a> {
    Box::new(Each(answer))
}

/// ψ in the rain frame of what a static camera at the radius `l` > 1 sees at `psi`: aberration by β = 1/√l, written with half angles so
/// that it keeps its digits near π.
pub fn rain_from_static(psi: f64, l: f64) -> f64 {
    let beta = (1.0 / l).sqrt();
    2.0 * ((0.5 * psi).sin() * ((1.0 + beta) / (1.0 - beta)).sqrt()).atan2((0.5 * psi).cos())
}

/// A method in the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Its name on the command line and in the chart.
    pub name: &'static str,
    /// Which family it belongs to: an index into [`FAMILIES`].
    pub family: usize,
    /// What it does, in a few words.
    pub about: &'static str,
}

/// The families of methods, as the chart colours them.
pub const FAMILIES: [&str; 5] = ["residual tables (ours)", "paper 1", "closed approximations", "integration", "exact"];

const fn entry(name: &'static str, family: usize, about: &'static str) -> Entry {
    Entry { name, family, about }
}

/// Every method.
pub const CATALOGUE: &[Entry] = &[
    entry("exact", 4, "the ray in closed form (elliptic functions), f64, solved for each point"),
    entry("table", 0, "what the game draws with: the small residual table, sliced at the camera's radius for a frame, cubic, f32"),
    entry("table-batch", 0, "table, eight points at once in SIMD registers"),
    entry("table-full", 0, "the same from the full table"),
    entry("table-linear", 0, "table, linear between the nodes of the slice"),
    entry("table-half", 0, "table, its slice in half precision"),
    entry("newton", 0, "table, then one Newton step on the closed form in f64"),
    entry("residual-cubic-f32", 0, "the full residual table without a slice: cubic in three dimensions"),
    entry("residual-cubic-f16", 0, "the same, stored in half precision"),
    entry("residual-linear-f32", 0, "the full residual table, trilinear"),
    entry("residual-linear-f16", 0, "the same, stored in half precision"),
    entry("paper1-16", 1, "paper 1's ψ(r, φ, L) on its optimised meshes (equations 3 to 7), trilinear, 16 nodes an axis"),
    entry("paper1-32", 1, "the same, 32 nodes"),
    entry("paper1-64", 1, "the same, 64 nodes"),
    entry("paper1-128", 1, "the same, 128 nodes"),
    entry("paper1-128-batch", 1, "the same, eight points at once in SIMD registers"),
    entry("paper1-uniform-16", 1, "paper 1 on uniform meshes, 16 nodes an axis"),
    entry("paper1-uniform-32", 1, "the same, 32 nodes"),
    entry("paper1-uniform-64", 1, "the same, 64 nodes"),
    entry("paper1-uniform-128", 1, "the same, 128 nodes"),
    entry("rk4-16", 3, "shooting by Newton's method, each shot 16 steps of Runge and Kutta's fourth order, f64"),
    entry("rk4-64", 3, "the same, 64 steps"),
    entry("rk4-256", 3, "the same, 256 steps"),
    entry("beloborodov", 2, "Beloborodov's cosine relation (2002)"),
    entry("poutanen", 2, "Poutanen's closed form (2020)"),
    entry("flat", 2, "straight lines"),
];

/// The names of [`CATALOGUE`], for a person to choose from.
pub fn names() -> String {
    CATALOGUE.iter().map(|entry| entry.name).collect::<Vec<_>>().join(", ")
}

/// One line for each method.
pub fn help() -> String {
    let lines: Vec<String> = CATALOGUE.iter().map(|entry| format!("{:20} {}", entry.name, entry.about)).collect();
    format!(
        "Methods:\n  {}\n\nTables answer cameras at 0.05 to 5,000 r_s and points at 1.0005 to 10,000 r_s (paper 1's from 1.01), and leave fields empty beyond.",
        lines.join("\n  ")
    )
}

/// The method called `name`, or None. Tables that are not there yet are baked, which stderr is told of, and kept beside the committed one.
pub fn named(name: &str) -> Option<Box<dyn Projector>> {
    let nodes = |prefix: &str| name.strip_prefix(prefix).and_then(|text| text.parse().ok());
    let full = || table("full.lut", Scheme::Residual, lensing::FULL_NODES);
    Some(match name {
        "exact" => Box::new(Exact),
        "table" => Box::new(Table(lensing::default_table())),
        "table-batch" => Box::new(Batch(Table(lensing::default_table()))),
        "table-full" => Box::new(Table(full())),
        "table-linear" => Box::new(Reformatted { table: lensing::default_table(), half: false }),
        "table-half" => Box::new(Reformatted { table: lensing::default_table(), half: true }),
        "newton" => Box::new(Newton(Table(lensing::default_table()))),
        "residual-cubic-f32" => Box::new(Residual::<[f32; 3]>::new(&full(), Interpolation::Cubic)),
        "residual-cubic-f16" => Box::new(Residual::<[half::f16; 3]>::new(&full(), Interpolation::Cubic)),
        "residual-linear-f32" => Box::new(Residual::<[f32; 3]>::new(&full(), Interpolation::Linear)),
        "residual-linear-f16" => Box::new(Residual::<[half::f16; 3]>::new(&full(), Interpolation::Linear)),
        "paper1-128-batch" => Box::new(PaperBatch(Paper(table("paper-128.lut", Scheme::Paper, 128)))),
        "beloborodov" => Box::new(Approximation::Beloborodov),
        "poutanen" => Box::new(Approximation::Poutanen),
        "flat" => Box::new(Flat),
        _ if !CATALOGUE.iter().any(|entry| entry.name == name) => return None,
        _ => {
            if let Some(steps) = nodes("rk4-") {
                Box::new(Integrate { steps })
            } else if let Some(count) = nodes("paper1-uniform-") {
                Box::new(Paper(table(&format!("paper-uniform-{count}.lut"), Scheme::PaperUniform, count)))
            } else {
                let count = nodes("paper1-")?;
                Box::new(Paper(table(&format!("paper-{count}.lut"), Scheme::Paper, count)))
            }
        }
    })
}

/// The table of the file `path` beside the committed one, baked and written there if need be, with a progress bar on stderr.
fn table(path: &str, scheme: Scheme, nodes: usize) -> lensing::Table {
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
    let table = lensing::load_or_bake(&lensing::default_file().with_file_name(path), scheme, nodes, complain, done);
    if let Some(bar) = bar.get() {
        bar.finish_and_clear();
    }
    table
}

/// ψ in both frames of a ray that reaches a camera at u = 1/L, with its delay.
fn sight(slope: f64, energy: f64, delay: f64, u: f64) -> Sight {
    Sight { psi_rain: light::rain_angle(slope, energy, u), psi_static: light::static_angle(slope, energy, u), delay }
}
