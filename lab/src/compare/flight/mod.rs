//! Chases flown by the autopilot, judged at many moments: those at which another ship is seen behind the hole among them; or by seeded
//! hands.
//!
//! - [`moments`]: which moments are looked at.
//! - [`hands`], [`eye`]: flights by hands, and from where they are looked at.
//! - [`freeze`]: a moment as a scene file of its own.
//! - [`jump`]: whether images grow and shrink smoothly from frame to frame.
//! - [`command`]: `lensrunner-lab compare --flight`.

pub mod command;
pub mod eye;
pub mod freeze;
pub mod hands;
pub mod jump;
pub mod moments;
