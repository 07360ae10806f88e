// The parameter in which an image of the disk is smooth all round.

/// σ = θ + δ(θ)/2, the mean of θ and of the angle round the axis at which the point is seen. Where the disk passes behind the hole
/// the one hardly moves while the other takes half a turn; in σ the image is smooth everywhere.
fn sigma(theta: f32) -> f32 {
    let h = disk.upwards.w;
    let s = sin(theta);
    let c = cos(theta);
    return theta + 0.5 * atan2((1.0 - h) * s * c, h * c * c + s * s);
}

/// dσ/dθ.
fn sigma_slope(theta: f32) -> f32 {
    let h = disk.upwards.w;
    let s = sin(theta);
    let c = cos(theta);
    return 0.5 + 0.5 * h / max(h * h * c * c + s * s, 1e-12);
}

/// θ between a and b at the fraction t of σ between them: Newton, held in the bracket.
fn theta_between(a: f32, b: f32, t: f32) -> f32 {
    // The ends are known.
    return theta_of(mix(sigma(a), sigma(b), t), a, b, mix(a, b, t), t > 0.0 && t < 1.0);
}

/// θ of a σ, between a and b and near a guess, which it stays if it is not `sought`.
fn theta_of(wanted: f32, a: f32, b: f32, guess: f32, sought: bool) -> f32 {
    var low = a;
    var high = b;
    var theta = guess;
    // No constant: compilers unroll loops of a known length.
    let steps = select(0u, 16u, sought);
    for (var i = 0u; i < steps; i++) {
        let miss = sigma(theta) - wanted;
        // What rounding leaves of a sum near π.
        if abs(miss) < 3e-7 {
            break;
        }
        if miss > 0.0 { high = theta; } else { low = theta; }
        let next = theta - miss / sigma_slope(theta);
        theta = select(0.5 * (low + high), next, next > low && next < high);
    }
    return theta;
}
