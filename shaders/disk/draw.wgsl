// The rasteriser's part of the disk of arcs. One draw per image order, the farthest first; each is laid over what is behind it.

@group(1) @binding(0) var<storage, read> disk_vertices: array<DiskVertex>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Gas {
    return gas_of(disk_vertices[index]);
}

/// From far rings are so narrow on the screen that the height in the pattern goes straight over a triangle (src/render/disk/view.rs sees to that), and the
/// places of both generations have it.
@vertex
fn far_vertex(@builtin(vertex_index) index: u32) -> Gas {
    let seen = disk_vertices[index];
    var gas = gas_of(seen);
    gas.even.y += seen.gas.y;
    gas.odd.y += seen.gas.y;
    return gas;
}

fn gas_of(seen: DiskVertex) -> Gas {
    let light = gas_light(seen.gas.z - seen.more.x, seen.more.x);
    return gas_at(clip_position(seen.apparent.xyz), seen.gas.x, seen.gas.y, seen.apparent.w, seen.gas.w, light, seen.more.zw, seen.more.y);
}

/// From far: the slant is in the vertices. Order 1 is wide; where gaps are closed gas has a part of its place.
@fragment
fn far_fragment(in: Gas) -> @location(0) vec4<f32> {
    return far_colour(in) * in.seen.x;
}

/// Orders 2 and 3, from far.
@fragment
fn thin_fragment(in: Gas) -> @location(0) vec4<f32> {
    return far_colour(in) * (coverage(in.seen.x, in.seen.y) * disk.gas.y);
}

/// What the orbits have turned the gas by does not go straight: each pixel follows them.
fn far_colour(in: Gas) -> vec4<f32> {
    let rate = disk_rate_at(max(in.slope.w, 1.0));
    let even = vec2<f32>(in.even.x - rate * in.even.z, in.even.y);
    let odd = vec2<f32>(in.odd.x - rate * in.odd.z, in.odd.y);
    return gas_colour(in.light.rgb, in.slope.xyz, in.light.w, two_looks(streaks_at(in, even, odd, 2.0 * STEP)));
}

/// Columns and rows of the finest level of the pattern without its finest octaves: powers of two, so that a place is brought back into it by a mask.
const NEAR_SIZE: vec2<i32> = vec2<i32>(1024, 512);
/// The coarsest level of it, of two columns and one row.
const NEAR_LEVELS: f32 = 9.0;

/// The pattern without its finest octaves, without a grain: between texels by weights 3t² − 2t³. Those are the same, eight times finer.
fn close_pattern(place: vec2<f32>, level: f32) -> f32 {
    let which = u32(clamp(level + 0.5, 0.0, NEAR_LEVELS));
    let size = NEAR_SIZE >> vec2<u32>(which);
    let texel = place * vec2<f32>(size) - 0.5;
    let whole = floor(texel);
    let straight = texel - whole;
    // A texel that is smaller than a pixel is filtered as it is.
    let t = select(straight, straight * straight * (3.0 - 2.0 * straight), level < 0.0);
    // The first level is on the left, the others one below the other beside it.
    let corner = vec2<i32>(select(0, NEAR_SIZE.x, which > 0u), max(NEAR_SIZE.y - 2 * size.y, 0));
    let v = textureLoad(near_pattern, (vec2<i32>(whole) & (size - 1)) + corner, 0);
    let row = mix(v.xz, v.yw, vec2<f32>(t.x));
    return mix(row.x, row.y, t.y);
}

/// Places along a pixel that streaks are looked up at, at most, from near: low over the plane pixels are longest.
const CLOSE_TAPS: u32 = 16u;
/// Lengths of a pixel, in texels of the pattern, between which the look without a grain goes over to places along it from far: over a longer one no grain
/// is left to be seen, and each place costs half as much.
const LONG: vec2<f32> = vec2<f32>(1.5, 3.0);

/// From one place along a pixel to the next that the finest octaves are looked up at without a grain, in texels of the pattern: their cells are half a texel
/// by a quarter, and one place in a longer pixel is a coincidence, which made stairs and dashes of streaks.
const FINE_STEP: f32 = 0.5;
/// Such places, at most.
const FINE_TAPS: f32 = 4.0;
/// The finest octaves over the others.
const FINE: f32 = 0.35;

/// The streaks of both generations without a grain: once, and the finest octaves at `taps` places along a pixel. What differs there has one colour, by its
/// mean and its variance.
fn near_along(at: Streaks, taps: u32) -> Cooling {
    let level = 0.5 * log2(max(at.square, 1e-12));
    let share = 1.0 / f32(max(taps, 1u));
    var sum = 0.0;
    var squares = 0.0;
    for (var k = 0u; k < taps; k++) {
        let t = (f32(k) + 0.5) * share - 0.5;
        let even = close_pattern(8.0 * (at.even + t * at.even_side), level + 3.0);
        let odd = close_pattern(8.0 * (at.odd + t * at.odd_side), level + 3.0);
        let power = FINE * dot(at.shares, vec2<f32>(even, odd));
        sum += power;
        squares += power * power;
    }
    let mean = sum * share;
    let power = dot(at.shares, vec2<f32>(close_pattern(at.even, level), close_pattern(at.odd, level)));
    return Cooling(power + mean, unseen_of(at, unseen_variance(level)) + 0.48045301 * max(squares * share - mean * mean, 0.0));
}

/// Order 1 says that it is wider than this, in pixels.
const WIDE: f32 = 1e5;

/// From near: the slant in each pixel, streaks without a grain.
@fragment
fn near_fragment(in: Gas) -> @location(0) vec4<f32> {
    let at = streaks_of(in, STEP * f32(CLOSE_TAPS));
    let long = sqrt(at.long);
    let share = smoothstep(LONG.x, LONG.y, long);
    // Places that do not count are not looked at.
    let far = far_along(at, select(0u, taps_of(at, CLOSE_TAPS), share > 0.0));
    let near = near_along(at, select(0u, u32(clamp(ceil(long / FINE_STEP), 1.0, FINE_TAPS)), share < 1.0));
    let cooling = Cooling(mix(near.power, far.power, share), mix(near.unseen, far.unseen, share));
    let depth = in.light.w * disk_slant(in.seen.w, in.seen.z, near_half_height(in.slope.w));
    let part = select(coverage(in.seen.x, in.seen.y) * disk.gas.y, in.seen.x, in.seen.y > WIDE);
    return gas_colour(in.light.rgb, in.slope.xyz, depth, cooling) * part;
}

/// What of order 1 is farther away than a close look reaches, of a disk that is seen from near: the slant in each pixel, streaks as from far.
@fragment
fn beyond_fragment(in: Gas) -> @location(0) vec4<f32> {
    let depth = in.light.w * disk_slant(in.seen.w, in.seen.z, near_half_height(in.slope.w));
    return gas_colour(in.light.rgb, in.slope.xyz, depth, two_looks(streaks_of(in, 2.0 * STEP))) * in.seen.x;
}

/// Half height of the disk at a radius of the pattern: thickness times that.
fn near_half_height(radius: f32) -> f32 {
    return max(bitcast<f32>(disk.room.z) * radius, 1e-3);
}
