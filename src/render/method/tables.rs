//! The tables that methods of projection read.

use std::sync::Arc;

use crate::lensing::{self, Scheme, Slice, Table, TableError, paper};

use crate::render::method::Method;

/// Nodes along each axis of the tables of Yamashita 2012.
const PAPER_NODES: usize = 128;

/// The tables.
#[derive(Debug)]
pub struct Tables {
    small: Arc<Table>,
    /// Those of Yamashita 2012, loaded or baked when they are first drawn with.
    paper: Option<Arc<Table>>,
}

impl Tables {
    /// With the residual table that the game draws with.
    pub fn new(small: Arc<Table>) -> Tables {
        Tables { small, paper: None }
    }

    /// The residual table that the game draws with.
    pub fn small(&self) -> &Arc<Table> {
        &self.small
    }

    /// The tables of `Method::Paper1`, instead of their file.
    pub fn set_paper(&mut self, table: Arc<Table>) {
        self.paper = Some(table);
    }

    /// What the shader's `lens_texel` reads for a camera at the radius `l`, r_s; `slice` is that of the small table there.
    pub fn texels(&mut self, method: Method, l: f64, slice: &Slice) -> Vec<[f32; 4]> {
        match method {
            Method::Paper1 => paper::slice(self.paper.get_or_insert_with(|| Arc::new(filed())), l),
            _ => slice.texels().to_vec(),
        }
    }
}

/// The tables of Yamashita 2012 from their file beside the committed one, baked where it is missing or unusable.
fn filed() -> Table {
    let file = lensing::table_file(&format!("paper-{PAPER_NODES}.lut"));
    let complain = |error: &TableError| bevy::log::warn!("{error}; the table is baked");
    lensing::load_or_bake(&file, Scheme::Paper, PAPER_NODES, complain, |_| ())
}
