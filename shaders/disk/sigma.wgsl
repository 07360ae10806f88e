#define_import_path lensrunner::disk::sigma

// The parameter in which an image of the disk is smooth all round: σ, the mean of the azimuth θ from the camera's and of the angle α round
// the axis of hole and camera at which the point is seen, tan α = tan θ/h. Where the disk passes behind the hole θ hardly changes while α
// takes half a turn; as a function of σ the image is smooth everywhere. The twin of src/render/disk/sigma.rs.

#import lensrunner::lensing::closed_form::{angle, HALF_TURN, sine_cosine}

/// Position of a point on its circle: θ in rad, its cosine and its sine.
struct Bearing {
    theta: f32,
    cosine: f32,
    sine: f32,
}

/// The position at σ, for a camera whose height over the plane has the sine h > 0: tan 2σ = tan(θ + α) is a quadratic equation for tan θ.
/// Cosine and sine come from it and not from θ: for a camera close to the plane, θ in f32 has only some forty values near half a turn while
/// α takes half a turn, and a ring would become chords.
fn bearing(sigma: f32, h: f32) -> Bearing {
    // θ, α and σ are the same at each quarter turn.
    let half_turns = round(sigma / HALF_TURN);
    let rest = sigma - half_turns * HALF_TURN;
    let twice = sine_cosine(2.0 * rest);
    let s = abs(twice.x);
    let c = twice.y;
    let middle = (1.0 + h) * abs(c);
    let sum = middle + sqrt(middle * middle + 4.0 * h * s * s);
    let sense = select(-1.0, 1.0, rest > 0.0);
    let way = normalize(select(vec2<f32>(2.0 * s, sum), vec2<f32>(sum, 2.0 * h * s), c > 0.0)) * vec2<f32>(1.0, sense);
    let turned = way * select(1.0, -1.0, (i32(half_turns) & 1) != 0);
    return Bearing(half_turns * HALF_TURN + sense * angle(abs(way.y), way.x, 1.0), turned.x, turned.y);
}
