// What is drawn of a streak: a part of it that is straight on the screen and evenly bright, blurred. Between those who lay strokes out and those who fill them.

struct Stroke {
    /// NDC of its middle.
    middle: array<f32, 2>,
    /// From there to the end of it along the streak, with its blur, and to its side, SIGMAS standard deviations away; NDC.
    along: array<f32, 2>,
    across: array<f32, 2>,
    depth: f32,
    /// Its length without the blur over that which the blur takes from nothing to all at an end.
    length: f32,
    /// kR of the line where its ends are far: the first two lines and the others, in halves.
    light: array<u32, 2>,
}

/// Standard deviations to either side of a stroke that are filled, with all but 1 % of its light.
const SIGMAS: f32 = 2.6;
/// How much of it: erf(2.6/√2).
const FILLED: f32 = 0.9906776;
/// Vertices of a stroke: two triangles.
const CORNERS: u32 = 6u;
