//! How a vertex is projected: one file of `shaders/method/` each, which the passes that look rays up import.

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

/// What is held in place, for methods with a hole and without.
const HELD: File = ("shaders/method/held.wgsl", include_str!("../../../shaders/method/held.wgsl"));
const AT_REST: File = ("shaders/method/at_rest.wgsl", include_str!("../../../shaders/method/at_rest.wgsl"));

/// A file of shaders: its path in the repository, and its text.
type File = (&'static str, &'static str);

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

    /// The files that are imported as `lensrunner::chosen::method` and `lensrunner::chosen::held`.
    pub fn files(self) -> [(&'static str, &'static str); 2] {
        match self {
            Method::Table => [("shaders/method/table.wgsl", include_str!("../../../shaders/method/table.wgsl")), HELD],
            Method::Exact => [("shaders/method/exact.wgsl", include_str!("../../../shaders/method/exact.wgsl")), HELD],
            Method::Paper1 => [("shaders/method/paper1.wgsl", include_str!("../../../shaders/method/paper1.wgsl")), HELD],
            Method::Flat => [("shaders/method/flat.wgsl", include_str!("../../../shaders/method/flat.wgsl")), AT_REST],
        }
    }
}
