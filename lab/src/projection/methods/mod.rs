//! The methods of projection that the chart races: the game's, and what others have published.

mod analytic;
mod batch;
mod integrate;
mod paper;

use lensrunner::lensing::methods::table::look_up;
use lensrunner::lensing::methods::{Exact, Flat, Projector, Table, Vertex, filed};
use lensrunner::lensing::{self, FULL_NODES, Scheme, Slice};
use lensrunner::spacetime::light::{Branch, Order};

pub use analytic::Approximation;
pub use batch::{Batch, LANES, LensRays, lens_lookup_batch};
pub use integrate::Integrate;
pub use paper::{Paper, PaperBatch};

/// A method of projection as it is timed.
pub trait Method: Projector {
    /// The method made ready for the frames of a camera at the radius `l`, as a game would use it.
    fn frame(&self, l: f64) -> Box<dyn Frame + '_>;

    /// Bytes of tables that it keeps.
    fn memory(&self) -> usize {
        0
    }
}

/// A method ready for one camera radius. It gives what the method itself gives (an angle, or a direction with momenta), without
/// converting it into a `Sight`: this is what is timed.
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

impl Method for Exact {
    fn frame(&self, _l: f64) -> Box<dyn Frame + '_> {
        each(|point, order| self.project(point.query, order, Branch::Plus))
    }
}

impl Method for Table {
    fn frame(&self, l: f64) -> Box<dyn Frame + '_> {
        let slice = Slice::new(&self.0, l);
        each(move |point, order| look_up(&slice, point, order, Branch::Plus))
    }

    fn memory(&self) -> usize {
        size_of_val(self.0.values.as_slice())
    }
}

impl Method for Flat {
    fn frame(&self, _l: f64) -> Box<dyn Frame + '_> {
        each(|point, _| {
            let direction = 1.0 / point.along.hypot(point.across);
            [point.along * direction, point.across * direction]
        })
    }
}

/// A method in the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Its name in the chart.
    pub name: &'static str,
    /// Which family it belongs to: an index into [`FAMILIES`].
    pub family: usize,
}

/// The families of methods, as the chart colours them.
pub const FAMILIES: [&str; 5] = ["residual tables (ours)", "Yamashita 2012", "closed approximations", "integration", "exact"];

const fn entry(name: &'static str, family: usize) -> Entry {
    Entry { name, family }
}

/// Every method.
pub const CATALOGUE: &[Entry] = &[
    // The ray in closed form, f64.
    entry("exact", 4),
    // What the game draws with; eight points at once; the same from the full table.
    entry("table", 0),
    entry("table-batch", 0),
    entry("table-full", 0),
    // The tables of Yamashita 2012 with so many nodes an axis, on the meshes of its equations 3 to 7; eight points at once.
    entry("paper1-16", 1),
    entry("paper1-32", 1),
    entry("paper1-64", 1),
    entry("paper1-128", 1),
    entry("paper1-128-batch", 1),
    // The same on uniform meshes.
    entry("paper1-uniform-16", 1),
    entry("paper1-uniform-32", 1),
    entry("paper1-uniform-64", 1),
    entry("paper1-uniform-128", 1),
    // Shooting, each shot so many steps of Runge and Kutta's fourth-order rule, f64.
    entry("rk4-16", 3),
    entry("rk4-64", 3),
    entry("rk4-256", 3),
    // Beloborodov 2002, Poutanen 2020, straight lines.
    entry("beloborodov", 2),
    entry("poutanen", 2),
    entry("flat", 2),
];

/// The names of [`CATALOGUE`], for a person to choose from.
pub fn names() -> String {
    CATALOGUE.iter().map(|entry| entry.name).collect::<Vec<_>>().join(", ")
}

/// The method called `name`, or None. Tables that are not there yet are baked, which stderr is told of, and kept beside the committed one.
pub fn named(name: &str) -> Option<Box<dyn Method>> {
    let nodes = |prefix: &str| name.strip_prefix(prefix).and_then(|text| text.parse().ok());
    Some(match name {
        "exact" => Box::new(Exact),
        "table" => Box::new(Table(lensing::default_table())),
        "table-batch" => Box::new(Batch(Table(lensing::default_table()))),
        "table-full" => Box::new(Table(filed("full.lut", Scheme::Residual, FULL_NODES))),
        "paper1-128-batch" => Box::new(PaperBatch(Paper(filed("paper-128.lut", Scheme::Paper, 128)))),
        "beloborodov" => Box::new(Approximation::Beloborodov),
        "poutanen" => Box::new(Approximation::Poutanen),
        "flat" => Box::new(Flat),
        _ if !CATALOGUE.iter().any(|entry| entry.name == name) => return None,
        _ => {
            if let Some(steps) = nodes("rk4-") {
                Box::new(Integrate { steps })
            } else if let Some(count) = nodes("paper1-uniform-") {
                Box::new(Paper(filed(&format!("paper-uniform-{count}.lut"), Scheme::PaperUniform, count)))
            } else {
                let count = nodes("paper1-")?;
                Box::new(Paper(filed(&format!("paper-{count}.lut"), Scheme::Paper, count)))
            }
        }
    })
}
