//! The drawn disk against the exact one.

mod chase;
mod near;
mod order;
mod pictures;
mod polygons;
mod sprites;
mod thin;
