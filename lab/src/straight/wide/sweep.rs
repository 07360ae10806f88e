//! A first look at the rays of a packet: their common direction, and the hull of each group.

use super::best::GROUP;
use super::eye::Laid;
use super::group::{ALL, EIGHT, NO_END, filled, lanes};
use super::hull::{Axes, Hull};
use super::lanes::{Eight, Mask, Sixteen};
use super::tree::Wide;
use crate::straight::ray::{Ray, widening};
use crate::straight::triangle::fastest;

/// Of seven times sixteen numbers, which are sixteen rays of seven, those that are not of an origin: one bit each.
const OTHER: [u32; 7] = {
    let mut other = [0; 7];
    let mut at = 0;
    while at < 7 * GROUP {
        if at % 7 > 2 {
            other[at / GROUP] |= 1 << (at % GROUP);
        }
        at += 1;
    }
    other
};

/// The axes of a packet, z last, and the sense along z, by the ray in its middle.
fn axes_of(rays: &[Ray]) -> ([usize; 3], f32) {
    let middle = rays[rays.len() / 2].direction;
    let z = fastest(middle);
    ([(z + 1) % 3, (z + 2) % 3, z], 1f32.copysign(middle[z]))
}

/// The common direction of rays that all start in one point, the hull of each group, and each group laid out; None if they have no such
/// direction or point.
#[inline(always)]
pub(super) fn from_eye<S: Sixteen>(wide: &Wide, rays: &[Ray], hulls: &mut Vec<Hull>, laid: &mut Vec<Laid>) -> Option<Axes> {
    let eye = rays[0].origin;
    if rays[rays.len() - 1].origin != eye {
        return None;
    }
    let (axes, sign) = axes_of(rays);
    let [x, y, z] = axes;
    let axes = Axes { axes, sign, front: eye[z], widening: widening(&wide.root, eye) };
    hulls.clear();
    laid.clear();
    let mut spare = [rays[0]; GROUP];
    let origins: [[f32; GROUP]; 7] = bytemuck::cast([Ray::new(eye, [0.0; 3]); GROUP]);
    for rays in rays.chunks(GROUP) {
        let rays: &[[f32; 7]; GROUP] = bytemuck::cast_ref(filled(rays, &mut spare));
        let [along_a, along_b, along_c, until] = S::last_columns(rays);
        let until = until.max(S::splat(NO_END));
        let direction = [along_a, along_b, along_c];
        let along = direction[z].mul(S::splat(sign));
        let mut fit = S::splat(0.0).less(along).bits();
        // Sixteen rays of seven numbers are seven times sixteen: origins are compared as they lie.
        let rows: &[[f32; GROUP]; 7] = bytemuck::cast_ref(rays);
        for ((row, origin), other) in rows.iter().zip(&origins).zip(OTHER) {
            let (row, origin) = (S::load(row), S::load(origin));
            fit &= row.at_most(origin).and(origin.at_most(row)).bits() | other;
        }
        let slopes = [direction[x].div(along), direction[y].div(along)];
        let [left, right, down, up] = S::spans(slopes[0], slopes[1]);
        let endless = S::splat(f32::INFINITY).at_most(until).bits() == ALL;
        let end = if endless { f32::INFINITY } else { along.mul(until).greatest() };
        let hull = Hull { sides: [eye[x], -eye[x], eye[y], -eye[y], left, right, down, up], depth: [0.0, -end] };
        if fit != ALL || !hull.is_gentle() {
            return None;
        }
        hulls.push(hull);
        laid.push(Laid { slopes: [slopes[0].store(), slopes[1].store()], along: along.store(), until: until.store() });
    }
    Some(axes)
}

/// The common direction of any rays and the hull of each group; None if they have none.
#[inline(always)]
pub(super) fn from_anywhere<L: Eight>(wide: &Wide, rays: &[Ray], hulls: &mut Vec<Hull>) -> Option<Axes> {
    let mut spare = [rays[0]; EIGHT];
    let (axes, sign) = axes_of(rays);
    let z = axes[2];
    let (mut low, mut high) = ([L::splat(f32::INFINITY); 3], [L::splat(f32::NEG_INFINITY); 3]);
    for rays in rays.chunks(EIGHT) {
        let (origin, ..) = lanes::<L>(filled(rays, &mut spare));
        for axis in 0..3 {
            low[axis] = origin[axis].min(low[axis]);
            high[axis] = origin[axis].max(high[axis]);
        }
    }
    let low = [low[0].least(), low[1].least(), low[2].least()];
    let high = [high[0].greatest(), high[1].greatest(), high[2].greatest()];
    let front = if sign > 0.0 { low[z] } else { high[z] };
    let widening = widening(&wide.root, low).max(widening(&wide.root, high));
    let axes = Axes { axes, sign, front, widening };
    hulls.clear();
    for (number, rays) in rays.chunks(EIGHT).enumerate() {
        let (origin, direction, until) = lanes::<L>(filled(rays, &mut spare));
        let until = until.max(L::splat(NO_END));
        let along = direction[z].mul(L::splat(sign));
        let depth = origin[z].sub(L::splat(front)).mul(L::splat(sign));
        let end = depth.add(along.mul(until));
        let [x, y] = [axes.axes[0], axes.axes[1]];
        let (slope_x, slope_y) = (direction[x].div(along), direction[y].div(along));
        let (offset_x, offset_y) = (origin[x].sub(slope_x.mul(depth)), origin[y].sub(slope_y.mul(depth)));
        let lower_and_upper =
            [offset_x, offset_x.negative(), offset_y, offset_y.negative(), slope_x, slope_x.negative(), slope_y, slope_y.negative()];
        let hull = Hull { sides: L::leasts(lower_and_upper).store(), depth: [depth.least(), -end.greatest()] };
        // The comparison also fails where something is not a number.
        if L::splat(0.0).less(along).bits() != 0xff || !hull.is_gentle() {
            return None;
        }
        if number % (GROUP / EIGHT) == 0 {
            hulls.push(hull);
        } else if let Some(last) = hulls.last_mut() {
            *last = last.union(&hull);
        }
    }
    Some(axes)
}
