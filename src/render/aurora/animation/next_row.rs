//! The next row of a watched aurora, made before it is due: by another thread or, where there is none, in parts from frame to frame. What
//! is made does not depend on when that is.

use std::sync::Arc;

use bevy::tasks::{AsyncComputeTaskPool, Task, block_on};
use glam::DVec2;

use crate::render::aurora::animation::streaks::RowPlaces;
use crate::render::aurora::ground::{Ground, GroundMaps};
use crate::render::aurora::node_history::{NodeRow, ROW, row};
use crate::scene::aurora::motion::{AuroraMotion, STEP};

/// Whether there are other threads: in a browser there is one.
const THREADS: bool = cfg!(not(target_arch = "wasm32"));
/// Steps of the motion from one row to the next.
const STEPS: usize = (ROW / STEP) as usize;

/// A row of nodes, and what of it depends on no camera.
#[derive(Clone, Debug)]
pub struct MadeRow {
    /// Its time, s.
    pub time: f64,
    /// The nodes as the shaders read them.
    pub nodes: NodeRow,
    /// Where they are.
    pub places: Arc<RowPlaces>,
    /// The light of it and of the row before on the ground, if that was asked for.
    pub maps: Option<GroundMaps>,
}

impl MadeRow {
    /// The curtains as they are now.
    pub fn of(motion: &AuroraMotion) -> MadeRow {
        let nodes = row(motion.row());
        MadeRow { time: motion.time(), places: Arc::new(RowPlaces::of(&nodes)), nodes, maps: None }
    }

    /// The row after that of `motion`, made at once.
    pub fn after(motion: &mut AuroraMotion) -> MadeRow {
        for _ in 0..STEPS {
            motion.step();
        }
        MadeRow::of(motion)
    }
}

/// What is asked of the light on the ground that a row brings.
#[derive(Clone, Debug)]
pub struct WantedMaps {
    /// Makes it.
    pub ground: Arc<Ground>,
    /// The row before it.
    pub before: NodeRow,
    /// Midnight at the times of the row and of the one before ([`Ground::maps`]).
    pub midnights: [DVec2; 2],
    /// The maps that are there.
    pub old: Option<GroundMaps>,
}

impl WantedMaps {
    fn of(&self, nodes: &NodeRow) -> GroundMaps {
        self.ground.maps([nodes, &self.before], self.midnights, self.old.as_ref())
    }
}

/// A row that is made in parts, none of which takes much longer than another.
#[derive(Debug)]
pub struct RowInParts {
    motion: AuroraMotion,
    wanted: Option<WantedMaps>,
    /// Parts of the motion that are done, and all of them.
    done: usize,
    all: usize,
    row: Option<MadeRow>,
}

impl RowInParts {
    fn new(motion: AuroraMotion, wanted: Option<WantedMaps>) -> RowInParts {
        RowInParts { all: STEPS * motion.parts_of_step(), motion, wanted, done: 0, row: None }
    }

    /// Makes the next part. False if there is none.
    fn part(&mut self) -> bool {
        match &mut self.row {
            None if self.done < self.all => {
                self.motion.part_of_step();
                self.done += 1;
            }
            None => self.row = Some(MadeRow::of(&self.motion)),
            Some(row) => match self.wanted.take() {
                Some(wanted) => row.maps = Some(wanted.of(&row.nodes)),
                None => return false,
            },
        }
        true
    }

    /// The share of the parts that is done.
    fn share(&self) -> f64 {
        let last = usize::from(self.row.is_some()) + usize::from(self.wanted.is_none());
        (self.done + last) as f64 / (self.all + 2) as f64
    }

    /// Makes what is left.
    fn finish(mut self) -> (AuroraMotion, MadeRow) {
        while self.part() {}
        let row = self.row.unwrap_or_else(|| MadeRow::of(&self.motion));
        (self.motion, row)
    }
}

/// A row that is being made.
#[derive(Debug)]
pub enum NextRow {
    /// By another thread.
    Task(Task<(AuroraMotion, MadeRow)>),
    /// From frame to frame.
    Parts(Box<RowInParts>),
}

impl NextRow {
    /// Begins with the row after that of `motion`.
    pub fn begin(motion: AuroraMotion, wanted: Option<WantedMaps>) -> NextRow {
        NextRow::begin_by(THREADS, motion, wanted)
    }

    fn begin_by(threads: bool, motion: AuroraMotion, wanted: Option<WantedMaps>) -> NextRow {
        let parts = RowInParts::new(motion, wanted);
        if threads {
            NextRow::Task(AsyncComputeTaskPool::get_or_init(Default::default).spawn(async move { parts.finish() }))
        } else {
            NextRow::Parts(Box::new(parts))
        }
    }

    /// Sees to it that this share of the row is made by now, if no other thread makes it.
    pub fn go_on(&mut self, share: f64) {
        if let NextRow::Parts(parts) = self {
            while parts.share() < share && parts.part() {}
        }
    }

    /// The row, and the motion as it is then. Waits for what is not made yet.
    pub fn take(self) -> (AuroraMotion, MadeRow) {
        match self {
            NextRow::Task(task) => block_on(task),
            NextRow::Parts(parts) => parts.finish(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::aurora::ground::Glow;
    use crate::scene::aurora::curtains::curtains;
    use crate::scene::aurora::fall::Spectrum;
    use crate::scene::aurora::motion::Plan;
    use crate::scene::aurora::quantiles::Quantiles;
    use crate::scene::planet::AuroraShape;

    #[test]
    fn a_row_is_the_same_however_it_is_made() {
        let plan = Plan { curves: curtains(AuroraShape::Arcs, 2), nodes: 1200, field: 60.0, renewal: 60.0, contrast: 0.7, seed: 2 };
        let mut direct = AuroraMotion::new(plan.clone(), 0.0);
        let glow = Glow::of(&Quantiles::new(&Spectrum { accelerated: 4.0, thermal: 1.5 }));
        let ground = Arc::new(Ground::new(&plan.curves, direct.layout(), glow));
        let mut others = [true, false].map(|threads| (threads, Some(AuroraMotion::new(plan.clone(), 0.0))));
        let (mut before, mut old) = (MadeRow::of(&direct).nodes, None);
        for number in 1..=5 {
            let midnights = [number, number - 1].map(|k| DVec2::from_angle(0.1 * f64::from(k)));
            let wanted = Some(WantedMaps { ground: ground.clone(), before: before.clone(), midnights, old: old.take() });
            let mut want = MadeRow::after(&mut direct);
            want.maps = wanted.as_ref().map(|wanted| wanted.of(&want.nodes));
            for (threads, motion) in &mut others {
                let mut next = NextRow::begin_by(*threads, motion.take().expect("it was given back"), wanted.clone());
                // Frames that come at uneven times.
                for share in [0.1, 0.3, 0.35, 0.9] {
                    next.go_on(share);
                    if let NextRow::Parts(parts) = &next {
                        let over = parts.share() - share;
                        assert!((0.0..0.11).contains(&over) && parts.share() < 1.0, "{share}: {over} more than was asked for");
                    }
                }
                let (moved, row) = next.take();
                assert!(row.time == want.time && row.nodes == want.nodes, "row {number}, by another thread: {threads}");
                let texels = [&row, &want].map(|row| row.maps.as_ref().map(GroundMaps::texels));
                assert!(texels[0].is_some() && texels[0] == texels[1], "light of row {number}, by another thread: {threads}");
                *motion = Some(moved);
            }
            assert!(want.nodes != before, "nothing moves");
            (before, old) = (want.nodes, want.maps);
        }
    }
}
