// A picture enlarged to the size of the output: cubic convolution (Keys 1981), along each row and then along each column. What the
// kernel throws beyond the two texels beside a place is cut off, so that no edge has a halo.

@group(2) @binding(0) var source: texture_2d<f32>;

struct Screen {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> Screen {
    let corner = vec2<f32>(f32((i << 1u) & 2u), f32(i & 2u));
    return Screen(vec4<f32>(corner * 2.0 - 1.0, 0.0, 1.0), vec2<f32>(corner.x, 1.0 - corner.y));
}

/// Keys' parameter: −1/2 is exact for parabolas, −3/4 is sharper and nearest to the full picture.
const SHARPNESS: f32 = -0.75;

/// Weights of the four texels about a place that is `t` past the second.
fn weights(t: f32) -> vec4<f32> {
    let u = 1.0 - t;
    return vec4<f32>(
        SHARPNESS * t * u * u,
        1.0 - t * t * ((SHARPNESS + 3.0) - (SHARPNESS + 2.0) * t),
        1.0 - u * u * ((SHARPNESS + 3.0) - (SHARPNESS + 2.0) * u),
        SHARPNESS * u * t * t,
    );
}

/// The four texels along `along` from one before `first` on, weighed.
fn convolved(first: vec2<i32>, along: vec2<i32>, t: f32) -> vec4<f32> {
    let last = vec2<i32>(textureDimensions(source)) - 1;
    let a = textureLoad(source, clamp(first - along, vec2<i32>(0), last), 0);
    let b = textureLoad(source, clamp(first, vec2<i32>(0), last), 0);
    let c = textureLoad(source, clamp(first + along, vec2<i32>(0), last), 0);
    let d = textureLoad(source, clamp(first + 2 * along, vec2<i32>(0), last), 0);
    let w = weights(t);
    return clamp(w.x * a + w.y * b + w.z * c + w.w * d, min(b, c), max(b, c));
}

/// As wide as the output, as high as the source.
@fragment
fn rows(in: Screen) -> @location(0) vec4<f32> {
    let place = in.uv.x * f32(textureDimensions(source).x) - 0.5;
    let first = floor(place);
    return convolved(vec2<i32>(i32(first), i32(in.position.y)), vec2<i32>(1, 0), place - first);
}

/// As the output.
@fragment
fn columns(in: Screen) -> @location(0) vec4<f32> {
    let place = in.uv.y * f32(textureDimensions(source).y) - 0.5;
    let first = floor(place);
    return convolved(vec2<i32>(i32(in.position.x), i32(first)), vec2<i32>(0, 1), place - first);
}
