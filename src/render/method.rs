//! How a vertex is projected: one file of `shaders/methods/` each, put into the passes that look rays up.

/// A method of projection, `render.method` of `game.toml`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Method {
    /// The residual table.
    #[default]
    Table,
    /// Straight light in a space without a hole.
    Flat,
}

impl Method {
    /// All methods.
    pub const ALL: [Method; 2] = [Method::Table, Method::Flat];

    /// The name in `game.toml`.
    pub fn name(self) -> &'static str {
        match self {
            Method::Table => "table",
            Method::Flat => "flat",
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

    /// Its shader.
    pub fn source(self) -> &'static str {
        match self {
            Method::Table => include_str!("../../shaders/methods/table.wgsl"),
            Method::Flat => include_str!("../../shaders/methods/flat.wgsl"),
        }
    }
}
