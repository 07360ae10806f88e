#define_import_path lensrunner::disk::sprites_types

// A spot of gas as the camera sees it.

struct SeenSprite {
    /// The middle: x, y and w of clip space; w: over how many times its own width across the orbits the spot is spread (a whole number).
    place: vec4<f32>,
    /// From there to its ends across the orbits and along them, in the same; w of the first: rings beyond its own, of the second unused.
    /// Nothing where the spot is not seen.
    across: vec4<f32>,
    along: vec4<f32>,
    /// Light, and opacity, of the gas there.
    colour: vec4<f32>,
}
