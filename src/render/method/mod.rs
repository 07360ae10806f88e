//! How a vertex is projected: one file of `shaders/methods/` each, put into the passes that look rays up after what it needs of
//! `shaders/functions/`.

pub mod race;
pub mod tables;

/// A method of projection, `render.method` of `game.toml`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Method {
    /// The residual table, cubic.
    #[default]
    Table,
    /// The same of the full table.
    TableFull,
    /// The table, linear between its nodes.
    TableLinear,
    /// The table, cubic, its slice in half precision.
    TableHalf,
    /// The full residual table, cubic in all three dimensions: the one along L is taken once a frame.
    ResidualCubic {
        /// Stored in half precision.
        half: bool,
    },
    /// The full residual table, trilinear, likewise.
    ResidualLinear {
        /// Stored in half precision.
        half: bool,
    },
    /// The table, then one Newton step on the closed form.
    Newton,
    /// The closed form solved for each vertex.
    Exact,
    /// Direct integration.
    Rk4 {
        /// Steps a shot.
        steps: u32,
    },
    /// The tables of Yamashita 2012 and its filter of triangles.
    Paper1 {
        /// Nodes along each axis.
        nodes: u32,
        /// On uniform meshes instead of the paper's optimised ones.
        uniform: bool,
    },
    /// Beloborodov's cosine relation.
    Beloborodov,
    /// Poutanen's closed form.
    Poutanen,
    /// Straight light in a space without a hole.
    Flat,
}

const fn paper(nodes: u32, uniform: bool) -> Method {
    Method::Paper1 { nodes, uniform }
}

/// All methods by their names in `game.toml`, the same as those of `project --method`.
const NAMES: [(Method, &str); 24] = [
    (Method::Table, "table"),
    (Method::TableFull, "table-full"),
    (Method::TableLinear, "table-linear"),
    (Method::TableHalf, "table-half"),
    (Method::Newton, "newton"),
    (Method::ResidualCubic { half: false }, "residual-cubic-f32"),
    (Method::ResidualCubic { half: true }, "residual-cubic-f16"),
    (Method::ResidualLinear { half: false }, "residual-linear-f32"),
    (Method::ResidualLinear { half: true }, "residual-linear-f16"),
    (Method::Exact, "exact"),
    (Method::Rk4 { steps: 16 }, "rk4-16"),
    (Method::Rk4 { steps: 64 }, "rk4-64"),
    (Method::Rk4 { steps: 256 }, "rk4-256"),
    (paper(16, false), "paper1-16"),
    (paper(32, false), "paper1-32"),
    (paper(64, false), "paper1-64"),
    (paper(128, false), "paper1-128"),
    (paper(16, true), "paper1-uniform-16"),
    (paper(32, true), "paper1-uniform-32"),
    (paper(64, true), "paper1-uniform-64"),
    (paper(128, true), "paper1-uniform-128"),
    (Method::Beloborodov, "beloborodov"),
    (Method::Poutanen, "poutanen"),
    (Method::Flat, "flat"),
];

/// The parts that methods share.
const HELD: &str = include_str!("../../../shaders/methods/held.wgsl");
const RESIDUALS: &str = include_str!("../../../shaders/functions/residuals.wgsl");
const ORBIT: &str = include_str!("../../../shaders/functions/orbit.wgsl");
const SHOOTING: &str = include_str!("../../../shaders/functions/shooting.wgsl");
const EXACT: &str = include_str!("../../../shaders/functions/exact.wgsl");
const REFINE: &str = include_str!("../../../shaders/functions/refine.wgsl");
const INTEGRATE: &str = include_str!("../../../shaders/functions/integrate.wgsl");
const STATIC_RAY: &str = include_str!("../../../shaders/functions/static_ray.wgsl");
const CLOSED: &str = include_str!("../../../shaders/functions/closed.wgsl");

impl Method {
    /// All methods.
    pub fn all() -> impl Iterator<Item = Method> {
        NAMES.into_iter().map(|(method, _)| method)
    }

    /// The name in `game.toml`; nothing for steps and nodes that have none.
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
            Method::Flat | Method::Beloborodov | Method::Poutanen => 1,
            Method::Paper1 { .. } => 2,
            _ => 3,
        }
    }

    /// Its shader, which goes behind `functions/lensing.wgsl` and `functions/lensing_camera.wgsl`.
    pub fn source(self) -> String {
        let parts: &[&str] = match self {
            Method::Table | Method::TableFull | Method::ResidualCubic { .. } => {
                &[RESIDUALS, HELD, include_str!("../../../shaders/methods/table.wgsl")]
            }
            Method::TableLinear | Method::ResidualLinear { .. } => &[HELD, include_str!("../../../shaders/methods/table_linear.wgsl")],
            Method::TableHalf => &[HELD, include_str!("../../../shaders/methods/table_half.wgsl")],
            Method::Newton => &[RESIDUALS, ORBIT, SHOOTING, EXACT, REFINE, HELD, include_str!("../../../shaders/methods/newton.wgsl")],
            Method::Exact => &[RESIDUALS, ORBIT, SHOOTING, EXACT, HELD, include_str!("../../../shaders/methods/exact.wgsl")],
            Method::Rk4 { .. } => &[RESIDUALS, ORBIT, SHOOTING, INTEGRATE, HELD, include_str!("../../../shaders/methods/rk4.wgsl")],
            Method::Paper1 { .. } => &[RESIDUALS, STATIC_RAY, HELD, include_str!("../../../shaders/methods/paper1.wgsl")],
            Method::Beloborodov => &[RESIDUALS, STATIC_RAY, CLOSED, HELD, include_str!("../../../shaders/methods/beloborodov.wgsl")],
            Method::Poutanen => &[RESIDUALS, STATIC_RAY, CLOSED, HELD, include_str!("../../../shaders/methods/poutanen.wgsl")],
            Method::Flat => &[RESIDUALS, include_str!("../../../shaders/methods/flat.wgsl")],
        };
        let mut source = parts.join("\n");
        if let Method::Rk4 { steps } = self {
            source += &format!("\nconst SHOT_STEPS: u32 = {steps}u;\n");
        }
        source
    }
}
