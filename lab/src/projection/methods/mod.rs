//! The methods of projection that the chart races: the game's, and what others have published.

mod analytic;
mod batch;
mod integrate;
mod paper;

use lensrunner::lensing::methods::table::look_up;
use lensrunner::lensing::methods::{self as game, Flat, Load, ProjectionInput, Projector, Sight, Table, Vertex, filed};
use lensrunner::lensing::{FULL_NODES, SMALL_NODES, Scheme, Slice};
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

/// A method of the game that is timed as it answers.
struct Plain(Box<dyn Projector>);

impl Projector for Plain {
    fn project(&self, input: ProjectionInput, order: Order, branch: Branch) -> Option<Sight> {
        self.0.project(input, order, branch)
    }
}

impl Method for Plain {
    fn frame(&self, _l: f64) -> Box<dyn Frame + '_> {
        each(|point, order| self.project(point.input, order, Branch::Plus))
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

/// A method as the chart knows it.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Its name in the chart.
    pub name: &'static str,
    /// Which family it belongs to: an index into [`FAMILIES`].
    pub family: usize,
    /// Makes it with the tables that it is given; None: the game's method of that name, timed as it answers.
    make: Option<fn(Load) -> Box<dyn Method>>,
}

impl Entry {
    /// The method, made with tables from `load`.
    pub fn made(&self, load: Load) -> Option<Box<dyn Method>> {
        match self.make {
            Some(make) => Some(make(load)),
            None => Some(Box::new(Plain((game::named(self.name)?.make)(load)))),
        }
    }
}

/// The families of methods, as the chart colours them.
pub const FAMILIES: [&str; 6] =
    ["residual tables (ours)", "Yamashita 2012", "closed approximations", "integration", "exact", "other methods of the game"];

const fn entry(name: &'static str, family: usize, make: fn(Load) -> Box<dyn Method>) -> Entry {
    Entry { name, family, make: Some(make) }
}

/// The laboratory's own methods, and those of the game that it times otherwise than as they answer, or shows in a family.
const OWN: &[Entry] = &[
    // The ray in closed form, f64.
    Entry { name: "exact", family: 4, make: None },
    // What the game draws with; eight points at once; the same from the full table.
    entry("table", 0, |load| Box::new(Table(load(Scheme::Residual, SMALL_NODES)))),
    entry("table-batch", 0, |load| Box::new(Batch(Table(load(Scheme::Residual, SMALL_NODES))))),
    entry("table-full", 0, |load| Box::new(Table(load(Scheme::Residual, FULL_NODES)))),
    // The tables of Yamashita 2012 with so many nodes an axis, on the meshes of its equations 3 to 7; eight points at once.
    entry("paper1-16", 1, |load| Box::new(Paper(load(Scheme::Paper, 16)))),
    entry("paper1-32", 1, |load| Box::new(Paper(load(Scheme::Paper, 32)))),
    entry("paper1-64", 1, |load| Box::new(Paper(load(Scheme::Paper, 64)))),
    entry("paper1-128", 1, |load| Box::new(Paper(load(Scheme::Paper, 128)))),
    entry("paper1-128-batch", 1, |load| Box::new(PaperBatch(Paper(load(Scheme::Paper, 128))))),
    // The same on uniform meshes.
    entry("paper1-uniform-16", 1, |load| Box::new(Paper(load(Scheme::PaperUniform, 16)))),
    entry("paper1-uniform-32", 1, |load| Box::new(Paper(load(Scheme::PaperUniform, 32)))),
    entry("paper1-uniform-64", 1, |load| Box::new(Paper(load(Scheme::PaperUniform, 64)))),
    entry("paper1-uniform-128", 1, |load| Box::new(Paper(load(Scheme::PaperUniform, 128)))),
    // Shooting, each shot so many steps of Runge and Kutta's fourth-order rule, f64.
    entry("rk4-16", 3, |_| Box::new(Integrate { steps: 16 })),
    entry("rk4-64", 3, |_| Box::new(Integrate { steps: 64 })),
    entry("rk4-256", 3, |_| Box::new(Integrate { steps: 256 })),
    // Beloborodov 2002, Poutanen 2020, straight lines.
    entry("beloborodov", 2, |_| Box::new(Approximation::Beloborodov)),
    entry("poutanen", 2, |_| Box::new(Approximation::Poutanen)),
    entry("flat", 2, |_| Box::new(Flat)),
];

/// Every method: the laboratory's list, then what else the game has.
pub fn catalogue() -> Vec<Entry> {
    let others = game::NAMES.into_iter().filter(|name| !OWN.iter().any(|entry| entry.name == *name));
    OWN.iter().copied().chain(others.map(|name| Entry { name, family: FAMILIES.len() - 1, make: None })).collect()
}

/// What the catalogue says of the method called `name`.
pub fn find(name: &str) -> Option<Entry> {
    catalogue().into_iter().find(|entry| entry.name == name)
}

/// The method called `name`, or None. Tables that are not there yet are baked, which stderr is told of, and kept beside the committed one.
pub fn named(name: &str) -> Option<Box<dyn Method>> {
    find(name)?.made(&filed)
}
