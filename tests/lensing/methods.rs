//! The methods of projection: what they answer where there is no light, and at the horizon.

use lensrunner::lensing::methods::{Exact, METHODS, Table};

use crate::projector::{does_not_jump_on_the_fall, says_where_no_ray_is, small};
use crate::support::table;

#[test]
fn no_ray_is_said_by_every_method() {
    for method in METHODS {
        says_where_no_ray_is(method.name, (method.make)(&small).as_ref());
    }
}

/// By the methods that answer a camera on both sides of the horizon.
#[test]
fn no_pixel_jumps_on_the_fall_through_the_horizon() {
    does_not_jump_on_the_fall("exact", 1e-12, &Exact);
    does_not_jump_on_the_fall("table", 3e-6, &Table(table().clone()));
}
