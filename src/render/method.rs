//! How a vertex is projected: one file of `shaders/methods/` each, put into the passes that look rays up.

/// A method of projection, `render.method` of `game.toml`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Method {
    /// The residual table.
    #[default]
    Table,
    /// Straight light in a space without a hole.
    Flat,
    /// Paper 1's tables and its filter of triangles.
    Paper1,
}

impl Method {
    /// All methods.
    pub const ALL: [Method; 3] = [Method::Table, Method::Flat, Method::Paper1];

    /// The name in `game.toml`.
    pub fn name(self) -> &'static str {
        match self {
            Method::Table => "table",
            Method::Flat => "flat",
            Method::Paper1 => "paper1",
        }
    }

    /// The method of that name.
    pub fn named(name: &str) -> Option<Method> {
        Method::ALL.into_iter().find(|method| method.name() == name)
    }

    /// Whether light bends: else there is one image of each thing, and what hovers is at rest.
    pub fn bends(self) -> bool {
        self != Method::Flat
    }

    /// How many orders of images it knows.
    pub fn orders(self) -> u32 {
        match self {
            Method::Table => 3,
            Method::Flat => 1,
            Method::Paper1 => 2,
        }
    }

    /// Its shader.
    pub fn source(self) -> &'static str {
        match self {
            Method::Table => include_str!("../../shaders/methods/table.wgsl"),
            Method::Flat => include_str!("../../shaders/methods/flat.wgsl"),
            Method::Paper1 => include_str!("../../shaders/methods/paper1.wgsl"),
        }
    }
}
