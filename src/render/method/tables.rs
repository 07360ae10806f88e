//! The tables that methods of projection read, each loaded or baked when it is first drawn with.

use std::collections::HashMap;
use std::sync::Arc;

use crate::lensing::{self, FULL_NODES, Scheme, Slice, Table, TableError, paper};

use crate::render::method::Method;

/// A table besides the one that the game draws with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Kind {
    /// The full residual table.
    Full,
    /// The same in half precision.
    Rounded,
    /// The tables of Yamashita 2012.
    Paper { nodes: u32, uniform: bool },
}

/// The tables.
#[derive(Debug)]
pub struct Tables {
    small: Arc<Table>,
    others: HashMap<Kind, Arc<Table>>,
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

    /// The full residual table, instead of its file.
    pub fn set_full(&mut self, table: Arc<Table>) {
        self.others.insert(Kind::Full, table);
    }

    /// The tables of a method `Method::Paper1`, instead of their file.
    pub fn set_paper(&mut self, nodes: u32, uniform: bool, table: Arc<Table>) {
        self.others.insert(Kind::Paper { nodes, uniform }, table);
    }

    fn other(&mut self, kind: Kind) -> Arc<Table> {
        if let Some(table) = self.others.get(&kind) {
            return table.clone();
        }
        let table = Arc::new(match kind {
            Kind::Full => filed("full.lut", Scheme::Residual, FULL_NODES),
            Kind::Rounded => self.other(Kind::Full).rounded(),
            Kind::Paper { nodes, uniform } => {
                let (scheme, name) = if uniform { (Scheme::PaperUniform, "paper-uniform") } else { (Scheme::Paper, "paper") };
                filed(&format!("{name}-{nodes}.lut"), scheme, nodes as usize)
            }
        });
        self.others.insert(kind, table.clone());
        table
    }

    /// What the shader's `lens_texel` reads for a camera at the radius `l`, r_s; `slice` is that of the small table there.
    pub fn texels(&mut self, method: Method, l: f64, slice: &Slice) -> Vec<[f32; 4]> {
        match method {
            Method::TableFull | Method::ResidualCubic { half: false } => Slice::new(&self.other(Kind::Full), l).texels().to_vec(),
            Method::ResidualCubic { half: true } => Slice::new(&self.other(Kind::Rounded), l).texels().to_vec(),
            Method::ResidualLinear { half } => Slice::trilinear(&self.other(Kind::Full), l, half),
            Method::Paper1 { nodes, uniform } => paper::slice(&self.other(Kind::Paper { nodes, uniform }), l),
            Method::TableLinear => slice.nodes(),
            Method::TableHalf => slice.halves(),
            _ => slice.texels().to_vec(),
        }
    }
}

/// The table of the file `name` beside the committed one, baked where it is missing or unusable: from a fraction of a second to a minute.
fn filed(name: &str, scheme: Scheme, nodes: usize) -> Table {
    let file = lensing::default_file().with_file_name(name);
    let complain = |error: &TableError| bevy::log::warn!("{error}; the table is baked");
    lensing::load_or_bake(&file, scheme, nodes, complain, |_| ())
}
