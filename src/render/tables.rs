//! The tables that the shaders of methods of projection look up.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use crate::lensing::methods::Method;
use crate::lensing::{self, Scheme, Slice, Table, TableError, paper};

/// The tables.
#[derive(Debug)]
pub struct Tables {
    small: Arc<Table>,
    /// Others by scheme and nodes, loaded or baked when they are first drawn with.
    others: HashMap<(Scheme, usize), Arc<Table>>,
}

impl Tables {
    /// With the residual table that the game draws with.
    pub fn new(small: Arc<Table>) -> Tables {
        Tables { small, others: HashMap::new() }
    }

    /// The residual table that the game draws with.
    pub fn small(&self) -> &Arc<Table> {
        &self.small
    }

    /// The table that `method` reads, instead of its file.
    pub fn set(&mut self, method: Method, table: Arc<Table>) {
        self.others.extend(method.table.map(|kind| (kind, table)));
    }

    /// What the shader's `lens_texel` reads for a camera at the radius `l`, r_s; `slice` is that of the small table there.
    pub fn texels<'a>(&mut self, method: Method, l: f64, slice: &'a Slice) -> Cow<'a, [[f32; 4]]> {
        match method.table {
            None | Some((Scheme::Residual, _)) => slice.texels().into(),
            Some(kind) => paper::slice(self.others.entry(kind).or_insert_with(|| Arc::new(filed(kind))), l).into(),
        }
    }
}

/// A table from its file beside the committed one, baked where that is missing or unusable.
fn filed((scheme, nodes): (Scheme, usize)) -> Table {
    let complain = |error: &TableError| bevy::log::warn!("{error}; the table is baked");
    lensing::load_or_bake(&lensing::table_file(scheme, nodes), scheme, nodes, complain, |_| ())
}
