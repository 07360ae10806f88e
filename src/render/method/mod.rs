//! How a vertex is projected: one file of `shaders/methods/` each, put into the passes that look rays up after what it needs of
//! `shaders/functions/`.

pub mod tables;

/// A method of projection, `render.method` of `game.toml`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Method {
    /// The residual table, cubic.
    #[default]
    Table,
    /// The closed form solved for each vertex.
    Exact,
    /// The tables of Yamashita 2012 and its filter of triangles.
    Paper1,
    /// Straight light in a space without a hole.
    Flat,
}

/// All methods by their names in `game.toml`, the same as those of `project --method`.
const NAMES: [(Method, &str); 4] =
    [(Method::Table, "table"), (Method::Exact, "exact"), (Method::Paper1, "paper1-128"), (Method::Flat, "flat")];

/// The parts that methods share.
const HELD: &str = include_str!("../../../shaders/methods/held.wgsl");
const RESIDUALS: &str = include_str!("../../../shaders/functions/residuals.wgsl");
const ORBIT: &str = include_str!("../../../shaders/functions/orbit.wgsl");
const EXACT: &str = include_str!("../../../shaders/functions/exact.wgsl");
const STATIC_RAY: &str = include_str!("../../../shaders/functions/static_ray.wgsl");

impl Method {
    /// All methods.
    pub fn all() -> impl Iterator<Item = Method> {
        NAMES.into_iter().map(|(method, _)| method)
    }

    /// The name in `game.toml`.
    pub fn name(self) -> &'static str {
        NAMES.into_iter().find(|(method, _)| *method == self).map_or("", |(_, name)| name)
    }

    /// The method of that name.
    pub fn named(name: &str) -> Option<Method> {
        NAMES.into_iter().find(|(_, other)| *other == name).map(|(method, _)| method)
    }

    /// Whether light bends: else there is one image of each thing, and what hovers is at rest.
    pub fn bends(self) -> bool {
        self != Method::Flat
    }

    /// How many orders of images it knows.
    pub fn orders(self) -> u32 {
        match self {
            Method::Flat => 1,
            Method::Paper1 => 2,
            Method::Table | Method::Exact => 3,
        }
    }

    /// Its shader, which goes behind `functions/lensing.wgsl` and `functions/lensing_camera.wgsl`.
    pub fn source(self) -> String {
        let parts: &[&str] = match self {
            Method::Table => &[HELD, include_str!("../../../shaders/methods/table.wgsl")],
            Method::Exact => &[ORBIT, EXACT, HELD, include_str!("../../../shaders/methods/exact.wgsl")],
            Method::Paper1 => &[STATIC_RAY, HELD, include_str!("../../../shaders/methods/paper1.wgsl")],
            Method::Flat => &[include_str!("../../../shaders/methods/flat.wgsl")],
        };
        [&[RESIDUALS], parts].concat().join("\n")
    }
}
