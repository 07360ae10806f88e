//! How a vertex is projected: one file of `shaders/methods/` each, put into the passes that look rays up after what it needs of
//! `shaders/functions/`.

use crate::lensing::Slice;

/// A method of projection, `render.method` of `game.toml`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Method {
    /// The residual table, cubic.
    #[default]
    Table,
    /// The same, linear between its nodes.
    TableLinear,
    /// The same, cubic, in half precision.
    TableHalf,
    /// The table, then one Newton step on the closed form.
    Newton,
    /// The closed form solved for each vertex.
    Exact,
    /// Direct integration in 16 steps a shot.
    Rk4Coarse,
    /// Direct integration in 64 steps a shot.
    Rk4,
    /// Paper 1's tables and its filter of triangles.
    Paper1,
    /// Beloborodov's cosine relation.
    Beloborodov,
    /// Poutanen's closed form.
    Poutanen,
    /// Straight light in a space without a hole.
    Flat,
}

/// The parts that methods share.
const HELD: &str = include_str!("../../shaders/methods/held.wgsl");
const RESIDUALS: &str = include_str!("../../shaders/functions/residuals.wgsl");
const ORBIT: &str = include_str!("../../shaders/functions/orbit.wgsl");
const SHOOTING: &str = include_str!("../../shaders/functions/shooting.wgsl");
const EXACT: &str = include_str!("../../shaders/functions/exact.wgsl");
const REFINE: &str = include_str!("../../shaders/functions/refine.wgsl");
const INTEGRATE: &str = include_str!("../../shaders/functions/integrate.wgsl");
const STATIC_RAY: &str = include_str!("../../shaders/functions/static_ray.wgsl");
const CLOSED: &str = include_str!("../../shaders/functions/closed.wgsl");

impl Method {
    /// All methods.
    pub const ALL: [Method; 11] = [
        Method::Table,
        Method::TableLinear,
        Method::TableHalf,
        Method::Newton,
        Method::Exact,
        Method::Rk4Coarse,
        Method::Rk4,
        Method::Paper1,
        Method::Beloborodov,
        Method::Poutanen,
        Method::Flat,
    ];

    /// The name in `game.toml`.
    pub fn name(self) -> &'static str {
        match self {
            Method::Table => "table",
            Method::TableLinear => "table-linear",
            Method::TableHalf => "table-half",
            Method::Newton => "newton",
            Method::Exact => "exact",
            Method::Rk4Coarse => "rk4-16",
            Method::Rk4 => "rk4-64",
            Method::Paper1 => "paper1",
            Method::Beloborodov => "beloborodov",
            Method::Poutanen => "poutanen",
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

    /// How many orders of images it knows.
    pub fn orders(self) -> u32 {
        match self {
            Method::Flat | Method::Beloborodov | Method::Poutanen => 1,
            Method::Paper1 => 2,
            _ => 3,
        }
    }

    /// What the shader's `lens_texel` reads for a camera, from the slice of the residual table. Paper 1's tables are cut by
    /// `lensing::paper::slice`.
    pub fn texels(self, slice: &Slice) -> Vec<[f32; 4]> {
        match self {
            Method::TableLinear => slice.nodes(),
            Method::TableHalf => slice.halves(),
            _ => slice.texels().to_vec(),
        }
    }

    /// Its shader, which goes behind `functions/lensing.wgsl` and `functions/lensing_camera.wgsl`.
    pub fn source(self) -> String {
        let parts: &[&str] = match self {
            Method::Table => &[RESIDUALS, HELD, include_str!("../../shaders/methods/table.wgsl")],
            Method::TableLinear => &[HELD, include_str!("../../shaders/methods/table_linear.wgsl")],
            Method::TableHalf => &[HELD, include_str!("../../shaders/methods/table_half.wgsl")],
            Method::Newton => &[RESIDUALS, ORBIT, SHOOTING, EXACT, REFINE, HELD, include_str!("../../shaders/methods/newton.wgsl")],
            Method::Exact => &[RESIDUALS, ORBIT, SHOOTING, EXACT, HELD, include_str!("../../shaders/methods/exact.wgsl")],
            Method::Rk4Coarse => &[RESIDUALS, ORBIT, SHOOTING, INTEGRATE, HELD, include_str!("../../shaders/methods/rk4_16.wgsl")],
            Method::Rk4 => &[RESIDUALS, ORBIT, SHOOTING, INTEGRATE, HELD, include_str!("../../shaders/methods/rk4_64.wgsl")],
            Method::Paper1 => &[RESIDUALS, STATIC_RAY, HELD, include_str!("../../shaders/methods/paper1.wgsl")],
            Method::Beloborodov => &[RESIDUALS, STATIC_RAY, CLOSED, HELD, include_str!("../../shaders/methods/beloborodov.wgsl")],
            Method::Poutanen => &[RESIDUALS, STATIC_RAY, CLOSED, HELD, include_str!("../../shaders/methods/poutanen.wgsl")],
            Method::Flat => &[RESIDUALS, include_str!("../../shaders/methods/flat.wgsl")],
        };
        parts.join("\n")
    }
}
