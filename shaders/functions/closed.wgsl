// Closed approximations of light bending: the twin of src/lensing/closed.rs. Both relations read 1 − cos α = X(u, y), y = 1 − cos χ, with
// the angle α of the ray from the outward radial in the static frame and χ, the angle it still sweeps on its way to infinity; the impact
// parameter is the same at both ends. The method that includes this file supplies fn tilt(u: f32, y: f32) -> f32, X

/// b² of the ray at 1/u that sweeps `chi` more.
fn impact(u: f32, lapse2: f32, chi: f32) -> f32 {
    let half = sin(0.5 * chi);
    let x = tilt(u, 2.0 * half * half);
    return x * (2.0 - x) / (u * u * lapse2);
}

/// α.
fn local_angle(u: f32, chi: f32) -> f32 {
    let half = sin(0.5 * chi);
    let sine = min(sqrt(0.5 * tilt(u, 2.0 * half * half)), 1.0);
    return 2.0 * atan2(sine, sqrt(max(1.0 - sine * sine, 0.0)));
}

/// The excess of the delay over that of the radial ray (Poutanen and Beloborodov 2006).
fn lag(u: f32, chi: f32) -> f32 {
    let half = sin(0.5 * chi);
    let y = 2.0 * half * half;
    return y / u * (1.0 + u * y / 8.0 * (1.0 + y * (1.0 / 3.0 - u / 14.0)));
}

/// Steps of false position.
const CLOSED_STEPS: u32 = 40u;

/// Order 1, both ends outside.
fn closed_ray(cam: LensCamera, at: SourcePoint, order: u32) -> LensRay {
    if !(order == 1u && at.lapse2 > 0.0 && cam.lapse2 > 0.0 && finite(at.r)) {
        return no_ray();
    }
    let c = 1.0 / at.r;
    let camera_beyond = at.dr <= 0.0;
    let outer = select(c, cam.a, camera_beyond);
    let inner = select(cam.a, c, camera_beyond);
    let outer_lapse2 = select(at.lapse2, cam.lapse2, camera_beyond);
    let inner_lapse2 = select(cam.lapse2, at.lapse2, camera_beyond);
    // Illinois: b falls short at the outer end while χ is small, and overshoots where the ray goes on inward.
    var low = 1e-6;
    var high = HALF_TURN - 0.5 * at.phi;
    var at_low = impact(outer, outer_lapse2, low) - impact(inner, inner_lapse2, low + at.phi);
    var at_high = impact(outer, outer_lapse2, high) - impact(inner, inner_lapse2, high + at.phi);
    if !(at_low < 0.0 && at_high > 0.0) {
        return no_ray();
    }
    var chi = low;
    for (var i = 0u; i < CLOSED_STEPS; i++) {
        let next = (low * at_high - high * at_low) / (at_high - at_low);
        let done = abs(next - chi) <= 3e-7 * next;
        chi = next;
        let value = impact(outer, outer_lapse2, chi) - impact(inner, inner_lapse2, chi + at.phi);
        if done || value == 0.0 {
            break;
        }
        if value < 0.0 {
            low = chi;
            at_low = value;
            at_high *= 0.5;
        } else {
            high = chi;
            at_high = value;
            at_low *= 0.5;
        }
    }
    let psi = select(local_angle(cam.a, chi + at.phi), HALF_TURN - local_angle(outer, chi), camera_beyond);
    let radial = abs(at.dr) + log(inner * outer_lapse2 / (outer * inner_lapse2));
    let time = radial + lag(inner, chi + at.phi) - lag(outer, chi);
    // From Schwarzschild's time to Painlevé and Gullstrand's.
    let l = sqrt(cam.l);
    let r = sqrt(at.r);
    let ends = (1.0 + r) / (1.0 + l);
    let rain = 2.0 * at.dr / (l + r) - log(cam.l * cam.lapse2 / (at.r * at.lapse2) * ends * ends);
    return static_ray(cam, at, order, psi, time - rain);
}
