//! Drawing: how far surface points are displaced on the picture by ways to divide triangles, beside the judge's.

use super::Finding;
use crate::chart::{ChartError, Output};
use crate::tessellation::{self, NAMES, TessellationRequest};

/// Bound and limit, in pixels.
const BOUND: f64 = 0.5;
const SIZE: [u32; 2] = [320, 180];

/// Scenes by the place that they show: names, or files beside the laboratory's sources.
const PLACES: [(&str, &str); 10] = [
    ("axis behind the hole through a face", "galaxy-axis"),
    ("axis behind the hole through an edge", "galaxy-axis-edge"),
    ("axis behind the hole through a vertex", "galaxy-axis-vertex"),
    ("2,744 balls round the hole", "parade"),
    ("camera 0.01 r_s above a ball of 1 r_s", "near.toml"),
    ("square of 10 r_s that passes under the camera and behind it", "around.toml"),
    ("camera held 0.001 r_s above the horizon", "hovering.toml"),
    ("camera inside the horizon, at 0.9 r_s", "inside.toml"),
    ("ball of 10⁻⁴ r_s, beside the near plane", "tiny.toml"),
    ("square of 10⁴ r_s", "huge.toml"),
];

/// The scene's name or file.
fn scene(name: &str) -> String {
    if name.ends_with(".toml") { format!("{}/scenes/{name}", env!("CARGO_MANIFEST_DIR")) } else { name.to_owned() }
}

/// A finding for each way and place.
pub fn measure() -> Result<Vec<Finding>, ChartError> {
    let mut found = Vec::new();
    for (place, name) in PLACES {
        let request = TessellationRequest {
            output: Output { folder: Default::default(), redraw: false },
            scenes: vec![scene(name)],
            size: SIZE,
            bounds: vec![BOUND],
            rounds: 1,
        };
        let sheet = tessellation::measure(&request)?;
        for row in &sheet.rows {
            let method = sheet.text(row, "way");
            found.push(Finding {
                part: "drawing",
                place,
                method: method.to_owned(),
                ours: method == NAMES[0],
                value: sheet.number(row, "p99_px"),
                unit: "px",
                limit: BOUND,
            });
        }
    }
    Ok(found)
}
