// The disk of sprites, drawn. Where the middles of four spots stand round a place, its light goes from one to the other as a bilinear
// sample does. Spots are drawn in a known order, ring by ring outwards and along each ring, so each knows how much of a pixel those that
// are drawn later will take.

#import lensrunner::disk::sprites_types::SeenSprite
#import lensrunner::gpu::bindings::frame

@group(1) @binding(0) var<storage, read> seen_sprites: array<SeenSprite>;

struct Spot {
    @builtin(position) position: vec4<f32>,
    /// Across the orbits and along them, 1 at the ends.
    @location(0) place: vec2<f32>,
    /// Over how many rings on either side it is spread, and how many there are beyond its own.
    @location(2) @interpolate(flat) rings: vec2<f32>,
    @location(1) @interpolate(flat) colour: vec4<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Spot {
    let sprite = seen_sprites[index / 3u];
    // One triangle round what the spot covers: where that ends it is nothing.
    let corners = array<vec2<f32>, 3>(vec2<f32>(-1.0, -1.0), vec2<f32>(3.0, -1.0), vec2<f32>(-1.0, 3.0));
    let corner = corners[index % 3u];
    let place = sprite.middle + corner.x * sprite.across + corner.y * sprite.along;
    let rings = vec2<f32>(sprite.spread, sprite.rings_beyond);
    return Spot(vec4<f32>(place.xy, frame.near, place.z), corner, rings, vec4<f32>(sprite.light, sprite.opacity));
}

/// The share that the `count` rings beyond its own have in a place `across` from the middle of a spot, of tents that reach over `spread`
/// rings on either side.
fn later_rings(across: f32, spread: f32, count: f32) -> f32 {
    return all_later(across * spread, spread) - all_later(across * spread - count, spread);
}

/// The same of rings without end, for a place so many `rings` from the middle: Σ_{k ≥ 1} max(0, 1 − |rings − k|/spread)/spread, which goes
/// straight between whole numbers.
fn all_later(from_middle: f32, spread: f32) -> f32 {
    let rings = clamp(from_middle, -spread, spread);
    let whole = floor(rings);
    let left = spread - abs(whole);
    let before = select(0.5 * left * (left - 1.0), spread * spread - 0.5 * left * (left + 1.0), whole > 0.0);
    return (before + (rings - whole) * left) / (spread * spread);
}

/// So much of its colour that, when all are drawn, each has its share of the light and all of them together let as much through as one.
@fragment
fn fragment(in: Spot) -> @location(0) vec4<f32> {
    let ring = max(1.0 - abs(in.place.x), 0.0) / in.rings.x;
    let share = ring * max(1.0 - abs(in.place.y), 0.0);
    let later = later_rings(in.place.x, in.rings.x, in.rings.y) + ring * max(in.place.y, 0.0);
    let alpha = clamp(in.colour.a * share / max(1.0 - in.colour.a * later, 1e-6), 0.0, 1.0);
    return vec4<f32>(in.colour.rgb * alpha, alpha);
}
