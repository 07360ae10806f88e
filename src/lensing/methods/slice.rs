//! The residual table as the game uses it: sliced once a frame, looked up in f32; and with a Newton step after it.

use super::{Frame, Projector, Query, Sight, Vertex, each, sight};
use crate::lensing::batch::{LANES, LensRays, lens_lookup_batch};
use crate::lensing::lookup::source_point::source_point;
use crate::lensing::lookup::{OLD, YOUNG, lens_lookup_aged, lookup_with, residuals_half, residuals_linear, swept};
use crate::lensing::single::LensCamera;
use crate::lensing::table::slice::Cut;
use crate::lensing::{self, LensRay, Slice};
use crate::spacetime::light::{self, Branch, Order};

/// The lensing table as the GPU evaluates it: a slice at the camera's radius, then the lookup in f32.
pub struct Table(pub lensing::Table);

/// Whether the tables reach so far.
pub(super) fn in_range(query: Query) -> bool {
    let [low, high] = lensing::table::grid::CAMERA_RANGE;
    (low..=high).contains(&query.camera) && 1.0 / query.r >= lensing::double::POINT_RANGE[0]
}

fn look_up(slice: &Slice, point: &Vertex, order: Order, branch: Branch) -> LensRay {
    let elapsed = if branch == Branch::Minus { OLD } else { YOUNG };
    lens_lookup_aged(slice, point.along, point.across, point.height, u32::from(order.number()), elapsed)
}

impl Table {
    fn ray(&self, query: Query, order: Order, branch: Branch) -> Option<LensRay> {
        if !in_range(query) {
            return None;
        }
        let ray = look_up(&Slice::new(&self.0, query.camera), &query.into(), order, branch);
        ray.valid.then_some(ray)
    }
}

/// What the f32 lookup found.
pub(super) fn seen(ray: &LensRay, query: Query) -> Sight {
    Sight {
        psi_rain: f64::from(ray.sin_psi).atan2(f64::from(ray.cos_psi)),
        psi_static: light::static_angle(f64::from(ray.slope), f64::from(ray.energy), 1.0 / query.camera),
        delay: f64::from(ray.delay),
    }
}

impl Projector for Table {
    fn project(&self, query: Query, order: Order, branch: Branch) -> Option<Sight> {
        Some(seen(&self.ray(query, order, branch)?, query))
    }

    fn frame(&self, l: f64) -> Box<dyn Frame + '_> {
        let slice = Slice::new(&self.0, l);
        each(move |point, order| look_up(&slice, point, order, Branch::Plus))
    }

    fn memory(&self) -> usize {
        size_of_val(self.0.values.as_slice())
    }
}

/// The table, eight points at once.
pub struct Batch(pub Table);

/// The answers for at most eight points; the last is repeated to fill the batch.
fn look_up_batch(slice: &Slice, points: &[Vertex], order: Order) -> LensRays {
    let last = points.len() - 1;
    let of = |field: fn(&Vertex) -> f32| std::array::from_fn(|i| field(&points[i.min(last)]));
    lens_lookup_batch(slice, of(|p| p.along), of(|p| p.across), of(|p| p.height), u32::from(order.number()))
}

struct Batches(Slice);

impl Frame for Batches {
    fn look_up(&self, points: &[Vertex], order: Order) {
        for points in points.chunks(LANES) {
            std::hint::black_box(look_up_batch(&self.0, points, order));
        }
    }
}

impl Projector for Batch {
    fn project(&self, query: Query, order: Order, branch: Branch) -> Option<Sight> {
        if branch == Branch::Minus || !in_range(query) {
            return self.0.project(query, order, branch);
        }
        let ray = look_up_batch(&Slice::new(&self.0.0, query.camera), &[query.into()], order).ray(0);
        ray.valid.then(|| seen(&ray, query))
    }

    fn frame(&self, l: f64) -> Box<dyn Frame + '_> {
        Box::new(Batches(Slice::new(&self.0.0, l)))
    }

    fn memory(&self) -> usize {
        self.0.memory()
    }
}

/// The slice in other formats, as the GPU's methods of these names read it.
pub struct Reformatted {
    /// The table that is sliced.
    pub table: lensing::Table,
    /// Half precision, cubic; else single precision, linear.
    pub half: bool,
}

impl Reformatted {
    fn look_up(
        &self,
        cam: &LensCamera,
        size: [u32; 2],
        texel: impl Fn(usize) -> [f32; 4],
        point: &Vertex,
        order: Order,
        branch: Branch,
    ) -> LensRay {
        let at = source_point(cam, point.along, point.across, point.height);
        let elapsed = if branch == Branch::Minus { OLD } else { YOUNG };
        let sweep = swept(at, u32::from(order.number()));
        if self.half {
            lookup_with(cam, at, sweep, elapsed, |x, y| residuals_half(&texel, size, x, y))
        } else {
            lookup_with(cam, at, sweep, elapsed, |x, y| residuals_linear(&texel, size, x, y))
        }
    }
}

impl Projector for Reformatted {
    fn project(&self, query: Query, order: Order, branch: Branch) -> Option<Sight> {
        if !in_range(query) {
            return None;
        }
        // One point of a camera: its own texels alone.
        let cut = Cut::new(&self.table, query.camera);
        let texel = |index: usize| if self.half { cut.half(index) } else { cut.node(index) };
        let ray = self.look_up(&cut.camera, cut.size, texel, &query.into(), order, branch);
        ray.valid.then(|| seen(&ray, query))
    }

    fn frame(&self, l: f64) -> Box<dyn Frame + '_> {
        let slice = Slice::new(&self.table, l);
        let texels = if self.half { slice.halves() } else { slice.nodes() };
        each(move |point, order| self.look_up(&slice.camera, slice.size, |index| texels[index], point, order, Branch::Plus))
    }

    fn memory(&self) -> usize {
        size_of_val(self.table.values.as_slice())
    }
}

/// The table, then one Newton step on the closed form: the direction is improved, the delay stays the table's.
pub struct Newton(pub Table);

/// The direction after the step; the table's own where the step leads nowhere.
fn improved(ray: &LensRay, query: Query, order: Order, branch: Branch) -> Sight {
    let (u_point, u_camera) = (1.0 / query.r, 1.0 / query.camera);
    let delay = f64::from(ray.delay);
    let guess = [f64::from(ray.slope), f64::from(ray.energy)];
    match light::newton_step(u_point, order.swept(query.phi), u_camera, branch, guess) {
        Some(better) => sight(better.slope, better.energy, delay, u_camera),
        None => seen(ray, query),
    }
}

impl Projector for Newton {
    fn project(&self, query: Query, order: Order, branch: Branch) -> Option<Sight> {
        let branch = if query.r < 1.0 && query.camera < 1.0 { branch } else { Branch::Plus };
        Some(improved(&self.0.ray(query, order, branch)?, query, order, branch))
    }

    fn frame(&self, l: f64) -> Box<dyn Frame + '_> {
        let slice = Slice::new(&self.0.0, l);
        each(move |point, order| improved(&look_up(&slice, point, order, Branch::Plus), point.query, order, Branch::Plus))
    }

    fn memory(&self) -> usize {
        self.0.memory()
    }
}
