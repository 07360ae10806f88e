//! A ship in free fall, without graphics: an orbit whose closest point turns around the hole.
//!
//! `cargo run --release --example orbit` prints T, r and azimuth; r_s = c = 1.

use std::error::Error;
use std::io::Write;

use glam::DVec3;
use lensrunner::spacetime::matter::{energy, step};
use lensrunner::spacetime::orbit::circular_orbit;

fn main() -> Result<(), Box<dyn Error>> {
    // The momentum of a circle at r = 8, a twentieth less of it: the ship comes nearer and goes out again.
    let mut ship = circular_orbit(8.0, 0.0)?;
    ship.momentum *= 0.95;
    let start = energy(&ship);
    // A reader that closes the pipe ends the program with an error, not with a panic.
    let mut out = std::io::stdout();
    writeln!(out, "T,r,azimuth")?;
    let every = 10.0;
    for k in 0..=60 {
        writeln!(out, "{},{:.6},{:.6}", f64::from(k) * every, ship.position.length(), ship.position.y.atan2(ship.position.x))?;
        // No thrust, no turning.
        ship = step(&ship, every, DVec3::ZERO, DVec3::ZERO);
    }
    writeln!(out, "# energy at infinity: {start:.12} at the start, {:.12} at the end", energy(&ship))?;
    Ok(())
}
