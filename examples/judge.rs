//! One picture by the judge, which integrates a light ray for every pixel: `cargo run --release --example judge` writes judge.png.

use std::path::Path;

use lensrunner::judge::case::{DEFAULT_TOLERANCE, TraceError, TraceRequest};
use lensrunner::judge::picture::DEFAULT_PACKET;
use lensrunner::judge::to_file::{Output, trace_to_file};
use lensrunner::scene::config;

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
    let output = Output { file: Path::new("judge.png"), layers: false, text: None, progress: None };
    let rate = trace_to_file(&request, &config::find(None)?, &output)?;
    println!("judge.png: {rate:.0} rays per second and thread");
    Ok(())
}
