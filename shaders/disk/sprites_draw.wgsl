// The disk of sprites, drawn as small discs.

@group(1) @binding(0) var<storage, read> seen_sprites: array<SeenSprite>;

struct Spot {
    @builtin(position) position: vec4<f32>,
    @location(0) place: vec2<f32>,
    @location(1) @interpolate(flat) colour: vec4<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) instance: u32) -> Spot {
    let sprite = seen_sprites[instance];
    let corners = array<vec2<f32>, 6>(vec2<f32>(-1.0, -1.0), vec2<f32>(1.0, -1.0), vec2<f32>(1.0, 1.0),
        vec2<f32>(-1.0, -1.0), vec2<f32>(1.0, 1.0), vec2<f32>(-1.0, 1.0));
    let corner = corners[i];
    return Spot(vec4<f32>(sprite.place.xy + corner * sprite.place.w * 2.0 / frame.size.xy, sprite.place.z, 1.0), corner, sprite.colour);
}

@fragment
fn fragment(in: Spot) -> @location(0) vec4<f32> {
    return in.colour * select(0.0, 1.0, dot(in.place, in.place) <= 1.0);
}
