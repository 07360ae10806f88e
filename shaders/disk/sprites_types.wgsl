#define_import_path lensrunner::disk::sprites_types

// A spot of gas as the camera sees it.

struct SeenSprite {
    /// The middle: x, y and w of clip space.
    middle: vec3<f32>,
    /// Over how many times its own width across the orbits the spot is spread (a whole number).
    spread: f32,
    /// From the middle to its end across the orbits, in the same. Nothing where the spot is not seen.
    across: vec3<f32>,
    /// Rings beyond its own.
    rings_beyond: f32,
    /// The same along the orbits.
    along: vec3<f32>,
    /// Opacity of the gas there.
    opacity: f32,
    /// Its light.
    light: vec3<f32>,
}
