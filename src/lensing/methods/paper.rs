//! The tables of Yamashita 2012.

use super::{Method, Projector, Query, Sight};
use crate::lensing::{Scheme, Table, paper, paper_format};
use crate::spacetime::light::{Branch, Order};

/// The method.
pub const METHOD: Method = Method {
    name: "paper1-128",
    about: "the tables of Yamashita 2012, ψ(r, φ, L) on its optimised meshes, trilinear, 128 nodes an axis",
    make: |load| Box::new(Paper(load(Scheme::Paper, NODES))),
    shader: ("shaders/method/paper1.wgsl", include_str!("../../../shaders/method/paper1.wgsl")),
    table: Some((Scheme::Paper, NODES)),
    orders: 2,
    bends: true,
    is_exact: false,
};

const NODES: usize = 128;

/// The four tables of Yamashita 2012.
pub struct Paper(pub Table);

/// Whether they reach so far.
pub fn answers(query: Query, order: Order) -> bool {
    let [l_low, l_high, r_low, r_high, ..] = paper_format::RANGES;
    order.number() <= 2 && (l_low..=l_high).contains(&query.camera) && (r_low..=r_high).contains(&query.r)
}

impl Projector for Paper {
    fn project(&self, query: Query, order: Order, _branch: Branch) -> Option<Sight> {
        let Query { r, phi, camera } = query;
        answers(query, order).then(|| {
            let [psi, delay] = paper::lookup(&self.0, [r, phi, camera], order.number());
            Sight::from_static(psi, delay, camera)
        })
    }
}
