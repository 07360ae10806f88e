//! Chains of curves that join end to end, so that what runs along them shows no joint: where each curve begins along its chain, and whether
//! the chain is closed.

use crate::scene::aurora::curve::Curve;

/// Where a curve lies in its chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// Which chain, by its first curve.
    pub chain: usize,
    /// Length of the chain before this curve, km.
    pub start: f64,
    /// Length of the whole chain, km.
    pub total: f64,
    /// Whether the chain ends where it began.
    pub closed: bool,
    /// The curve (it may be this one) that ends where this one starts, and the one that starts where this one ends.
    pub joined: [Option<usize>; 2],
}

/// Ends closer together than this, in km, are joined.
const JOINT: f64 = 1.0;

/// The links of all curves, with their lengths in km.
pub fn links(curves: &[Curve], lengths: &[f64]) -> Vec<Link> {
    let next = |k: usize| curves.iter().position(|curve| curve.point(0.0).distance(curves[k].point(1.0)) < JOINT);
    let before = |k: usize| (0..curves.len()).find(|&other| next(other) == Some(k));
    let mut links: Vec<Option<Link>> = vec![None; curves.len()];
    // Open chains from their beginnings; then rings, from any of their curves.
    let starts = (0..curves.len()).filter(|&k| before(k).is_none()).chain((0..curves.len()).filter(|&k| before(k).is_some()));
    for chain in starts {
        let mut own = Vec::new();
        let mut at = Some(chain);
        while let Some(k) = at.filter(|&k| links[k].is_none()) {
            links[k] = Some(Link {
                chain,
                start: own.iter().map(|&k: &usize| lengths[k]).sum(),
                total: 0.0,
                closed: false,
                joined: [before(k), next(k)],
            });
            own.push(k);
            at = next(k);
        }
        let total = own.iter().map(|&k| lengths[k]).sum();
        for &k in &own {
            if let Some(link) = &mut links[k] {
                (link.total, link.closed) = (total, at == Some(chain));
            }
        }
    }
    links.into_iter().flatten().collect()
}
