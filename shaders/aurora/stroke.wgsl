#define_import_path lensrunner::aurora::stroke

// A stroke: a part of a streak that is straight on the screen and evenly bright, blurred. The walk writes strokes, the draw reads them.

struct Stroke {
    /// NDC of its middle.
    middle: vec2<f32>,
    /// From there to its end along the streak, with its blur; and to its side, SIGMAS standard deviations away; NDC.
    along: vec2<f32>,
    across: vec2<f32>,
    depth: f32,
    /// Its length without the blur, over the length in which the blur at an end goes from nothing to all.
    length: f32,
    /// kR of each line far from its ends, in pairs of half floats.
    green_and_blue: u32,
    red_and_crimson: u32,
}

/// Standard deviations to either side of a stroke that are filled; they have all but 1 % of its light.
const SIGMAS: f32 = 2.6;
/// That share: erf(2.6/√2).
const FILLED: f32 = 0.9906776;
/// Vertices of a stroke: two triangles.
const CORNERS: u32 = 6u;
