// Fourth pass of the aurora: strokes are added up, in kR of each of the four lines; each in its level of the pyramid. Depth is that of the
// stroke's middle.

#import lensrunner::aurora::stroke::{CORNERS, SIGMAS, Stroke}

@group(1) @binding(0) var<uniform> level: Level;
@group(1) @binding(1) var<storage, read> strokes: array<Stroke>;

struct Level {
    /// From NDC of the screen to those of the level with its margin: times this, plus that.
    scale: vec2<f32>,
    offset: vec2<f32>,
}

struct Spot {
    @builtin(position) position: vec4<f32>,
    /// x: along the stroke, from 0 where it begins to 1 where all of its blur there has been passed; y: across it in standard deviations.
    @location(0) place: vec2<f32>,
    @location(1) @interpolate(flat) light: vec4<f32>,
    @location(2) @interpolate(flat) length: f32,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> Spot {
    let stroke = strokes[i / CORNERS];
    let k = i % CORNERS;
    let corner = vec2<f32>(select(-1.0, 1.0, (k & 1u) == 1u), select(-1.0, 1.0, (k >= 2u) & (k != 3u)));
    let screen = stroke.middle + stroke.along * corner.x + stroke.across * corner.y;
    let place = vec2<f32>(0.5 * (corner.x + 1.0) * (1.0 + stroke.length), SIGMAS * corner.y);
    let light = vec4<f32>(unpack2x16float(stroke.green_and_blue), unpack2x16float(stroke.red_and_crimson));
    return Spot(vec4<f32>(screen * level.scale + level.offset, stroke.depth, 1.0), place, light, stroke.length);
}

/// An evenly bright line from 0 on, blurred over one: smoothstep is the blur by a parabola.
fn end_of(x: f32) -> f32 {
    let s = saturate(x);
    return s * s * (3.0 - 2.0 * s);
}

@fragment
fn fragment(in: Spot) -> @location(0) vec4<f32> {
    let along = end_of(in.place.x) - end_of(in.place.x - in.length);
    // exp(−y²/2): a driver reads a table no faster.
    return in.light * (along * exp2(-0.7213475 * in.place.y * in.place.y));
}
