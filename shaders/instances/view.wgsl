#define_import_path lensrunner::instances::view

// Where a camera sees a ball, how wide its image is, and what bounds it: the twin of view.rs, visibility.rs and bounds.rs of
// src/render/instances/, function for function but for their lookups, which geometry/place.wgsl makes. What differs by little is worked out
// as a difference, for f32.

#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::types::Cap
#import lensrunner::lensing::closed_form::{angle, HALF_TURN, sine_cosine}

/// Where the image of a ball is seen, in the rain frame.
struct Extent {
    /// The direction of its centre, a unit vector in rain axes.
    look: vec3<f32>,
    /// Radius, in radians, of a cone about `look` that holds the image.
    radius: f32,
    /// Largest width on the screen, in pixels.
    width: f32,
    /// How long it is across that, round the axis, in pixels.
    length: f32,
    /// Half its extent in azimuth round the axis, in radians.
    round: f32,
}

/// As in src/render/instances/view.rs.
const DRAWN_OUT: f32 = 4.0;
const DRAWN_OUT_ROUND: f32 = 0.25;

/// Whether light draws it out along the ring, so that it shows sections of the body at many azimuths.
fn is_drawn_out(extent: Extent) -> bool {
    return extent.round > DRAWN_OUT_ROUND && extent.length > DRAWN_OUT * extent.width;
}

/// Factor by which an extent is enlarged.
const MARGIN: f32 = 3.0;
/// Margin of what may be on the screen, in radians.
const SCREEN_MARGIN: f32 = 0.01;
/// By how many pixels an image may be drawn beyond that of its ball.
const MARGIN_PIXELS: f32 = 2.0;

/// A direction in rain axes as the camera has it: light from there, not of unit length.
fn wave(look: vec3<f32>) -> vec3<f32> {
    return (frame.camera_from_rain * vec4<f32>(look, -1.0)).xyz;
}

/// By how much that changes with the direction.
fn wave_change(change: vec3<f32>) -> vec3<f32> {
    return (frame.camera_from_rain * vec4<f32>(change, 0.0)).xyz;
}

/// The angle between a direction of any length and one that differs from it by `change`.
fn angle_apart(from_there: vec3<f32>, change: vec3<f32>) -> f32 {
    let across = length(cross(from_there, change));
    let along = dot(from_there, from_there + change);
    return angle(across, along, length(vec2<f32>(across, along)));
}

/// The angle whose sine is `part` over `whole`, up to a quarter turn.
fn angle_of_sine(part: f32, whole: f32) -> f32 {
    return angle(part, sqrt(max((whole - part) * (whole + part), 0.0)), whole);
}

/// The extent of what may be seen anywhere.
fn anywhere() -> Extent {
    return Extent(frame.outward, HALF_TURN, HALF_TURN / frame.pixel, 2.0 * HALF_TURN / frame.pixel, HALF_TURN);
}

/// The sense in which light of an order turns round the axis.
fn turn_of(order: u32) -> f32 {
    return select(1.0, -1.0, order == 2u);
}

/// The extent of a ball of radius `reach` at radius `r`, `beside` the axis, whose points are seen at angles from `low` to `high` from
/// outwards, its centre at `centre` by light of this path.
fn extent_of(low: f32, high: f32, centre: f32, path: f32, beside: vec2<f32>, r: f32, reach: f32, order: u32) -> Extent {
    let n = frame.outward;
    let distance = length(beside);
    var round = HALF_TURN;
    if reach < distance {
        round = angle_of_sine(reach, distance);
    }
    // On the axis any side will do: what is left across it there is rounding.
    var side = frame.side_b;
    if distance > 1e-6 * r {
        side = (frame.side_a * beside.x + frame.side_b * beside.y) * (turn_of(order) / distance);
    }
    let at = sine_cosine(centre);
    let enlarged = enlargement(side, low, high, round);
    let width = min(high - low, 2.0 * reach / max(path, 1e-9)) * enlarged;
    let straddles = low < 0.5 * HALF_TURN && high > 0.5 * HALF_TURN;
    let steepest = select(max(sine_cosine(low).x, sine_cosine(high).x), 1.0, straddles);
    let radius = max(high - centre, centre - low) + round * steepest;
    return Extent(n * at.y + side * at.x, radius, width, 2.0 * round * steepest * enlarged, round);
}

/// The largest number of pixels per radian of ψ on the screen, by aberration and by the projection onto the plane screen. For directions
/// between two angles from outwards, up to `round` (radians of azimuth) on both sides of `side`.
fn enlargement(side: vec3<f32>, low: f32, high: f32, round: f32) -> f32 {
    let n = frame.outward;
    let middle = sine_cosine(0.5 * (low + high));
    let half = max(0.5 * (high - low), 1e-4);
    let open = sine_cosine(half);
    // Sine and cosine at the lower end, and by how much they change up to the other.
    let lower = vec2<f32>(middle.x * open.y - middle.y * open.x, middle.y * open.y + middle.x * open.x);
    let change = 2.0 * open.x * vec2<f32>(middle.y, -middle.x);
    let edge = 1.1 * max(1.0 / frame.focal.x, 1.0 / frame.focal.y);
    // A tenth of a radian is enlarged alike all along it.
    let step = select(1, 4, round < 0.1);
    var largest = 0.0;
    for (var k = -4; k <= 4; k += step) {
        let turned = sine_cosine(0.25 * f32(k) * round);
        let there = side * turned.y + cross(n, side) * turned.x;
        let a = wave(n * lower.y + there * lower.x);
        let on = wave_change(n * change.y + there * change.x);
        let b = a + on;
        // Off the screen the projection does not count.
        var length_there = angle_apart(a, on);
        if is_on_screen(a, edge) || is_on_screen(b, edge) {
            length_there = length((on.xy * a.z - a.xy * on.z) / (a.z * b.z));
        }
        largest = max(largest, length_there / (2.0 * half * frame.pixel));
    }
    return largest;
}

fn is_on_screen(seen: vec3<f32>, edge: f32) -> bool {
    return seen.z < 0.0 && max(abs(seen.x), abs(seen.y)) < -edge * seen.z;
}

/// Two unit vectors across a unit vector, as glam has them.
fn any_orthonormal_pair(v: vec3<f32>) -> mat2x3<f32> {
    let s = select(1.0, -1.0, v.z < 0.0);
    let a = -1.0 / (s + v.z);
    let b = v.x * v.y * a;
    return mat2x3<f32>(vec3<f32>(1.0 + s * v.x * v.x * a, s * b, -s * v.x), vec3<f32>(b, s + v.y * v.y * a, -v.y));
}

/// Whether any of a cone of directions may fall on the screen. The cone has `radius` (radians) about `look`, in rain axes; `margin`
/// (radians) is added in the camera's frame. In doubt the answer is yes.
fn may_be_seen(look: vec3<f32>, radius: f32, margin: f32) -> bool {
    if !(radius <= 0.5) {
        return true;
    }
    let centre = wave(look);
    let pair = any_orthonormal_pair(look);
    let open = sine_cosine(radius);
    let inwards = look * (-open.x * open.x / (1.0 + open.y));
    var rim = 0.0;
    for (var k = 0u; k < 4u; k++) {
        let outwards = select(pair[0], pair[1], k >= 2u) * select(open.x, -open.x, k % 2u == 1u);
        rim = max(rim, angle_apart(centre, wave_change(outwards + inwards)));
    }
    return cone_may_be_seen(normalize(centre), 1.5 * rim + margin);
}

/// Whether any of a cone of directions about `centre` (a unit vector, camera axes) may fall on the screen; `radius` in radians. In doubt
/// the answer is yes.
fn cone_may_be_seen(centre: vec3<f32>, radius: f32) -> bool {
    if !(radius <= 0.5 * HALF_TURN) {
        return true;
    }
    let tangents = 1.0 / frame.focal;
    let across = length(tangents);
    let corner = angle(across, 1.0, sqrt(1.0 + across * across));
    let inside = (-centre.z * tangents - abs(centre.xy)) / sqrt(1.0 + tangents * tangents);
    return angle(length(centre.xy), -centre.z, 1.0) <= corner + radius && all(inside > vec2<f32>(-sine_cosine(radius).x));
}

/// The cap of directions within `radius` of `middle` (rain axes) as the camera sees it, wider by the margin.
///
/// The cap is d · middle ≥ cos radius for directions d. This is linear in the light's (d, −1), which the Lorentz matrix takes to the
/// camera. It keeps (sin radius)², the square of (middle, cos radius).
fn seen_cap(middle: vec3<f32>, radius: f32) -> Cap {
    if radius >= HALF_TURN {
        return Cap(vec3<f32>(0.0), 0.0);
    }
    let open = sine_cosine(radius);
    let row = vec4<f32>(middle, open.y) * frame.rain_from_camera;
    let across = length(row.xyz);
    let seen = angle(open.x, row.w, length(vec2<f32>(open.x, row.w))) + MARGIN_PIXELS * frame.pixel;
    if seen <= 0.5 * HALF_TURN {
        return Cap(row.xyz / across, chord(seen));
    }
    return Cap(-row.xyz / across, -chord(max(HALF_TURN - seen, 0.0)));
}

/// The square of the chord of an angle.
fn chord(radians: f32) -> f32 {
    let half = sine_cosine(0.5 * radians).x;
    return 4.0 * half * half;
}

/// The farthest direction from the middle of a patch between two angles from outwards, up to `round` on both sides in azimuth, in radians.
fn farthest_in_patch(low: f32, high: f32, round: f32) -> f32 {
    if round >= 0.5 * HALF_TURN {
        return HALF_TURN;
    }
    let middle = 0.5 * (low + high);
    let aside = chord(round) * sine_cosine(middle).x;
    var farthest = 0.0;
    for (var k = 0u; k <= 8u; k++) {
        let psi = mix(low, high, f32(k) / 8.0);
        let square = clamp(0.25 * (chord(abs(psi - middle)) + aside * sine_cosine(psi).x), 0.0, 1.0);
        farthest = max(farthest, 2.0 * angle(sqrt(square), sqrt(1.0 - square), 1.0));
    }
    return farthest;
}
