// One Newton step on the closed form after the lookup: the twin of src/lensing/shooting.rs.

/// The largest turn of a slope that is believed, radians: more than the table is ever off, and less than half a pixel. Beyond it, what
/// speaks is the rounding of the closed form.
const MOST_REFINED: f32 = 5e-5;

/// `ray` with the slopes that the step gives; its delay stays.
fn refined_ray(cam: LensCamera, at: SourcePoint, sweep: f32, ray: LensRay) -> LensRay {
    if !ray.valid || at.lapse2 <= 0.0 {
        return ray;
    }
    let c = 1.0 / at.r;
    let phi = max(sweep, SMALLEST_SWEEP);
    let s = fan_shift(cam);
    let e = ray.energy;
    let x = select(ray.slope, -e * e / (s + sqrt(s * s + e * e)), cam.lapse2 < 0.0);
    let fired = fire(cam, x, phi);
    let rise = -at.dr * c * cam.a;
    let moved = x + newton_change(cam.a, c, rise - fired.rise, fired.rise, fired.rate);
    let w = moved - s;
    // Both turns as sines: (a, −w) against (a, −slope).
    let a = cam.a;
    let turn = abs(a * (w - ray.slope)) / sqrt((a * a + w * w) * (a * a + ray.slope * ray.slope));
    if fired.fate != MET || !(turn < MOST_REFINED) || (cam.lapse2 < 0.0 && moved >= 0.0) {
        return ray;
    }
    return ray_of(cam, c, max(at.lapse2, LEAST_LAPSE2), w, fan_energy(cam, moved), ray.emission_slope, ray.delay);
}
