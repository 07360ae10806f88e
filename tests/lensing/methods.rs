//! The methods of projection: what they answer where there is no light, and at the horizon.

use lensrunner::lensing::methods::{Exact, Flat, Paper, Projector, Table};
use lensrunner::lensing::{Scheme, bake};

use crate::projector::{does_not_jump_on_the_fall, says_where_no_ray_is};
use crate::support::table;

#[test]
fn no_ray_is_said_by_every_method() {
    let paper = bake(Scheme::Paper, 8, |_| ());
    let all: [(&str, &dyn Projector); 4] =
        [("exact", &Exact), ("table", &Table(table().clone())), ("paper", &Paper(paper)), ("flat", &Flat)];
    for (name, method) in all {
        says_where_no_ray_is(name, method);
    }
}

/// By the methods that answer a camera on both sides of the horizon.
#[test]
fn no_pixel_jumps_on_the_fall_through_the_horizon() {
    does_not_jump_on_the_fall("exact", 1e-12, &Exact);
    does_not_jump_on_the_fall("table", 3e-6, &Table(table().clone()));
}
