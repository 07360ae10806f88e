//! The laboratory: it stands above the game and may see all of it; nothing in the game knows the laboratory.
//!
//! - [`compare`]: the verdict on the game's picture, by the judge; [`contestant`] draws that picture.
//! - [`projection`], [`disk`], [`aurora`], [`bvh`], [`thin_disk`], [`flight`], [`tessellation`]: each a chart of error against time;
//!   [`frame_times`] times whole frames, [`bodies`] frames of more and more bodies, [`window_rates`] frames in a window.
//! - [`dial`]: what each option of the quality costs and saves, and whether that predicts.
//! - [`quarry`]: how long the game's quarry lasts beside blind ones.
//! - [`steps`]: what a step of the simulation costs; [`overlay_cost`], [`hud_cost`]: what overlay and HUD cost the processor.
//! - [`straight`]: straight rays through trees of boxes (Sei 2008), which `bvh` measures.
//! - [`products`]: every chart, table and picture of the documents, and whether it is up to date.
//! - [`chart`], [`plot`]: CSV files with their provenance, and how they are drawn; [`offscreen`]: whole frames to be timed.
//! - [`flip`]: the difference of two pictures as an eye sees it.

pub mod aurora;
pub mod bodies;
pub mod bvh;
pub mod chart;
pub mod compare;
pub mod contestant;
pub mod dial;
pub mod disk;
pub mod drivers;
pub mod flight;
pub mod flip;
pub mod frame_times;
pub mod hands_frames;
pub mod hud_cost;
pub mod motion;
pub mod offscreen;
pub mod overlay_cost;
pub mod plot;
pub mod products;
pub mod projection;
pub mod quarry;
pub mod say;
pub mod soak;
pub mod stability;
pub mod steps;
mod stopwatch;
pub mod straight;
pub mod tessellation;
pub mod thin_disk;
pub mod window_rates;
