//! How large each image of each object is, to the judge and as it is shown: also those that the judge does not see at all.

use std::collections::BTreeMap;

use super::grid::{FULL, Grid};
use crate::compare::ContestantFrame;
use crate::compare::fault::{Fault, Kind, Limits};
use lensrunner::judge::picture::TracedPicture;

/// The size of one image of one object.
#[derive(Clone, Debug, PartialEq)]
pub struct Area {
    /// The object's number, from 1.
    pub object: u32,
    /// Its name.
    pub name: String,
    /// The image order.
    pub order: u32,
    /// What the judge sees of it, in pixels.
    pub judge: f64,
    /// What is shown of it, in pixels.
    pub shown: f64,
    /// Pixels of which the judge sees it in more than none.
    pub pixels: usize,
    /// Pixels just outside of those.
    pub rim: usize,
    /// The variance of its area by chance, in pixels squared: 1/4 for each pixel of which the judge sees it in a part, c(1 − c) for each
    /// that shows it with a coverage c.
    pub variance: f64,
}

impl Area {
    /// What is wrong with it; None if nothing is.
    pub fn fault(&self, limits: &Limits) -> Option<Fault> {
        let allowed = limits.area(self.pixels, self.rim, self.variance);
        let off = (self.shown - self.judge).abs();
        (off > allowed).then(|| {
            let Area { name, order, judge, shown, .. } = self;
            let text = format!("{name} order {order}: an area of {shown:.1} px, not {judge:.1} (give or take {allowed:.1})");
            Fault::new(Kind::Area, off, allowed, text)
        })
    }
}

/// The areas of all images that either picture shows, by object and order. `is_thin` tells the images that are compared by the area they
/// cover.
pub fn areas(judge: &TracedPicture, frame: &ContestantFrame, names: &[String], is_thin: &dyn Fn(u32, u32) -> bool) -> Vec<Area> {
    let grid = Grid::of(judge.size);
    let mut found: BTreeMap<(u32, u32), Area> = BTreeMap::new();
    let mut of = |object: u32, order: u32, change: &dyn Fn(&mut Area)| {
        let name = || names.get((object as usize).wrapping_sub(1)).cloned().unwrap_or_else(|| "?".into());
        let new = || Area { object, name: name(), order, judge: 0.0, shown: 0.0, pixels: 0, rim: 0, variance: 0.0 };
        change(found.entry((object, order)).or_insert_with(new));
    };
    for i in 0..judge.layers.len() {
        for &(object, order, share) in &judge.shares[i] {
            of(object, order, &|area| {
                area.judge += f64::from(share);
                area.pixels += 1;
                area.variance += if share < FULL { 0.25 } else { 0.0 };
            });
        }
        let has = |j: usize, key: (u32, u32)| judge.shares[j].iter().any(|share| (share.0, share.1) == key);
        let mut near: Vec<(u32, u32)> = grid.around(i).into_iter().flat_map(|j| &judge.shares[j]).map(|share| (share.0, share.1)).collect();
        near.sort_unstable();
        near.dedup();
        for key in near.into_iter().filter(|key| !has(i, *key)) {
            of(key.0, key.1, &|area| area.rim += 1);
        }
        let shown = &frame.shown[i];
        if shown.object == 0 {
            continue;
        }
        let coverage = f64::from(shown.coverage);
        let parts = if shown.coverage < 1.0 {
            grid.thin_parts(&judge.shares, i, shown.image(), is_thin)
        } else {
            vec![((shown.object, shown.order), 1.0)]
        };
        for ((object, order), part) in parts {
            of(object, order, &|area| {
                area.shown += coverage * part;
                area.variance += coverage * (1.0 - coverage) * part;
            });
        }
        // What a thin image leaves free shows what is behind, which is not told: that is as the judge sees it there.
        let other = |share: &(u32, u32, f32)| (share.0, share.1) != (shown.object, shown.order) && !is_thin(share.0, share.1);
        let behind = judge.shares[i].iter().filter(|share| shown.coverage < 1.0 && other(share));
        let thin: f64 = judge.shares[i].iter().filter(|share| is_thin(share.0, share.1)).map(|share| f64::from(share.2)).sum();
        for &(object, order, share) in behind {
            let part = (1.0 - coverage) * f64::from(share) / (1.0 - thin).max(f64::from(share));
            of(object, order, &|area| {
                area.shown += part;
                area.variance += part * (1.0 - part);
            });
        }
    }
    found.into_values().collect()
}
