//! The history of the curtains: rows of nodes in a ring of slots, so that a step writes no more than its own row.

use std::sync::Arc;

use glam::DVec2;

use crate::render::aurora::{CurtainNode, Segment};
use crate::scene::aurora::curve::between_nodes;
use crate::scene::aurora::motion::Node;

/// Rows of nodes, one each [`ROW`] seconds, over which red light may be delayed; HISTORY_ROWS in shaders/aurora/streaks.wgsl.
pub const ROWS: usize = 128;
/// Seconds between two of them.
pub const ROW: f64 = 1.0;

/// Nodes of all curtains at one time, as the shaders read them.
pub type NodeRow = Arc<Vec<CurtainNode>>;

/// The rows of a history. A clone shares them.
#[derive(Clone, Debug, Default)]
pub struct NodeHistory {
    /// By slot. From the newest on, each row is older than the one before, round the ring.
    slots: Arc<Vec<NodeRow>>,
    newest: usize,
}

impl NodeHistory {
    /// A past in which nothing happened: all rows are this one.
    pub fn still(row: NodeRow) -> NodeHistory {
        NodeHistory { slots: Arc::new(vec![row; ROWS]), newest: 0 }
    }

    /// Adds a row in place of the oldest.
    pub fn push(&mut self, row: NodeRow) {
        self.newest = (self.newest + ROWS - 1) % ROWS;
        if let Some(slot) = Arc::make_mut(&mut self.slots).get_mut(self.newest) {
            *slot = row;
        }
    }

    /// The rows by their slots; none if there is no history.
    pub fn slots(&self) -> &[NodeRow] {
        &self.slots
    }

    /// The slot of the newest.
    pub fn newest(&self) -> usize {
        self.newest
    }

    /// The row so many rows ago, from 0.
    pub fn row(&self, ago: usize) -> Option<&NodeRow> {
        self.slots.get((self.newest + ago) % ROWS)
    }

    /// The nodes so many rows ago, from 0; none if there is no history.
    pub fn ago(&self, rows: usize) -> &[CurtainNode] {
        self.slots.get((self.newest + rows) % ROWS).map_or(&[], |row| row)
    }

    /// Slots with another row than in an earlier history.
    pub fn changed<'a>(&'a self, before: &'a NodeHistory) -> impl Iterator<Item = (usize, &'a NodeRow)> {
        let same = |&(slot, row): &(usize, &NodeRow)| before.slots.get(slot).is_some_and(|old| Arc::ptr_eq(old, row));
        self.slots.iter().enumerate().filter(move |row| !same(row))
    }

    /// Where a node was `age` seconds before the newest row, in km in the plane across the field; before the oldest row it rests. Twin of
    /// `node_at` in shaders/aurora/streaks.wgsl.
    pub fn node_at(&self, node: usize, age: f64) -> DVec2 {
        let x = (age / ROW).clamp(0.0, (ROWS - 1) as f64);
        let row = (x as usize).min(ROWS - 2);
        place(self.ago(row), node).lerp(place(self.ago(row + 1), node), x - row as f64)
    }

    /// The middle of a part of a curtain `age` seconds before the newest row; twin of `middle_of` in shaders/aurora/streaks.wgsl.
    pub fn middle_of(&self, segment: &Segment, age: f64) -> DVec2 {
        let [first, span] = [segment.first_node, segment.span].map(|number| number as usize);
        let node = first + (span - 1) / 2;
        let t = if span % 2 == 1 { 0.5 } else { 1.0 };
        between_nodes([0, 1, 2, 3].map(|k| self.node_at(node + k - 1, age)), t)[0]
    }
}

/// A row of these nodes.
pub fn row(nodes: impl Iterator<Item = Node>) -> NodeRow {
    let told =
        |Node { place, flux, along }: Node| CurtainNode { place: place.as_vec2().to_array(), flux: flux as f32, along: along as f32 };
    Arc::new(nodes.map(told).collect())
}

/// Where a node of a row is, km in the plane across the field.
pub fn place(row: &[CurtainNode], node: usize) -> DVec2 {
    row.get(node).map_or(DVec2::ZERO, |node| DVec2::from(node.place.map(f64::from)))
}
