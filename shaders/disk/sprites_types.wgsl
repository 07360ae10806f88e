// A bit of gas as the camera sees it.

struct SeenSprite {
    /// Clip position over w, and the radius of the spot in pixels in w; depth in z.
    place: vec4<f32>,
    /// Premultiplied light and opacity.
    colour: vec4<f32>,
}
