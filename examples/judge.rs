//! One picture by the judge, which integrates a light ray for every pixel: `cargo run --release --example judge` writes judge.png.

use std::path::Path;

use lensrunner::judge::case::{DEFAULT_TOLERANCE, TraceError, TraceRequest, trace_to_file};
use lensrunner::judge::picture::DEFAULT_PACKET;

fn main() -> Result<(), TraceError> {
    let request = TraceRequest {
        scene: "ring".into(),
        size: [160, 90],
        at: 0.0,
        samples: 4,
        threads: 0,
        tolerance: DEFAULT_TOLERANCE,
        packet: DEFAULT_PACKET,
        limit: None,
    };
    let rate = trace_to_file(&request, None, Path::new("judge.png"), false)?;
    println!("judge.png: {rate:.0} rays per second and thread");
    Ok(())
}
