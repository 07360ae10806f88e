//! The closed form of a lensed ray in both precisions, from one text (`formulas.rs`), and the elementary functions that it calls.

pub mod elementary;

/// The formulas in f64, for the bake.
#[allow(clippy::unnecessary_cast, clippy::excessive_precision)]
pub mod double {
    use crate::lensing::closed_form::elementary::double::{above, ln, stumpff};

    /// The precision of this copy.
    pub type Real = f64;
    /// Four of them.
    pub type Four = wide::f64x4;
    include!("formulas.rs");
}

/// The formulas in f32, the twins of the shader's.
#[allow(clippy::unnecessary_cast, clippy::excessive_precision)]
pub mod single {
    use crate::lensing::closed_form::elementary::single::{above, ln, stumpff};

    /// The precision of this copy.
    pub type Real = f32;
    /// Four of them.
    pub type Four = wide::f32x4;
    include!("formulas.rs");
}
