//! The tables of Yamashita 2012.

use super::{Method, ProjectionInput, Projector, Sight};
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
pub fn answers(input: ProjectionInput, order: Order) -> bool {
    let [l_low, l_high, r_low, r_high, ..] = paper_format::RANGES;
    order.number() <= 2 && (l_low..=l_high).contains(&input.camera) && (r_low..=r_high).contains(&input.r)
}

impl Projector for Paper {
    fn project(&self, input: ProjectionInput, order: Order, _branch: Branch) -> Option<Sight> {
        let ProjectionInput { r, phi, camera } = input;
        answers(input, order).then(|| {
            let [psi, delay] = paper::lookup(&self.0, [r, phi, camera], order.number());
            Sight::from_static(psi, delay, camera)
        })
    }
}
