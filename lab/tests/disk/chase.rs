//! The scripted chase and the recorded flight of the disk's charts.

use lensrunner_lab::chart::Sheet;
use lensrunner_lab::disk::flight;
use lensrunner_lab::disk::script::{CROSSING, script};

/// The scripted chase is one flight, and passes through every situation however few places of it are looked at.
#[test]
fn the_scripted_chase_passes_through_every_situation() {
    for steps in [8, 12, 16, 25, 100] {
        let stops: Vec<_> = (0..steps).map(|step| script((f64::from(step) + 0.5) / f64::from(steps), 3.0)).collect();
        for name in ["from far", "inside the inner edge", "skimming", "crossing", "below"] {
            assert!(stops.iter().any(|stop| stop.2 == name), "{steps} places and none {name}");
        }
        for (eye, _, name) in &stops {
            let (r, z) = (eye.position.length(), eye.position.z);
            assert_eq!(*name == "inside the inner edge", r < 3.0, "{name} at r = {r}");
            assert_eq!(*name == "crossing", r > 3.0 && z.abs() <= CROSSING, "{name} at z = {z}");
        }
    }
    let mut last: Option<(glam::DVec3, glam::DQuat, f64)> = None;
    let mut nearest = f64::INFINITY;
    for step in 0..=4000 {
        let (eye, time, _) = script(f64::from(step) / 4000.0, 3.0);
        nearest = nearest.min(eye.position.length());
        if let Some((position, attitude, before)) = last {
            assert!(time > before && eye.position.distance(position) < 0.03, "a jump at {step}: {position} to {}", eye.position);
            assert!(eye.attitude.angle_between(attitude) < 0.02, "the look jumps at {step}");
        }
        last = Some((eye.position, eye.attitude, time));
    }
    assert!(nearest < 2.0, "never nearer than {nearest}");
}

/// Of 1,000 frames 1 to 1,000 ms long, 999 are no longer than 999 ms.
#[test]
fn the_flight_is_summed_up() {
    let mut sheet = Sheet::new(&["frame", "situation", "passes_ms", "disk_ms", "before_submission_ms", "disk_fragments"]);
    for k in 0..1000u32 {
        // In no order of length.
        let time = f64::from(k * 7 % 1000) + 1.0;
        sheet.push([k.to_string(), "from far".into(), time.to_string(), (0.5 * time).to_string(), "3".into(), (1_000_000 + k).to_string()]);
    }
    let summary = flight::summary(&sheet);
    let of = |row: usize| ["mean", "p99", "p99_9", "worst"].map(|column| summary.number(&summary.rows[row], column));
    assert_eq!(of(0), [500.5, 990.0, 999.0, 1000.0]);
    assert_eq!(of(1), [250.25, 495.0, 499.5, 500.0]);
    assert_eq!(of(2), [3.0; 4]);
    assert_eq!(of(3), [1_000_499.5, 1_000_989.0, 1_000_998.0, 1_000_999.0]);
}
