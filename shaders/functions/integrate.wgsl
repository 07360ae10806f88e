// Direct integration for each vertex: the twin of src/lensing/shooting.rs. The method that includes this file supplies
//   const SHOT_STEPS: u32

/// u − a, w, ∂u/∂w, ∂w/∂w₀ along a shot.
fn shot_rates(a: f32, state: vec4<f32>) -> vec4<f32> {
    let u = a + state.x;
    return vec4<f32>(state.y, u * (1.5 * u - 1.0), state.w, (3.0 * u - 1.0) * state.z);
}

/// dT/dΦ of the photon, which runs against Φ: ingoing, then outgoing light.
fn shot_time(u: f32, w: f32) -> f32 {
    let e = energy(w, u, 1.0 - u);
    let beta = sqrt(max(u, 0.0));
    if w <= 0.0 {
        return (w * w + u * u) / (u * u * (e - beta * w));
    }
    return (e + beta * w) / (u * u * (1.0 - u));
}

/// SHOT_STEPS steps of Runge and Kutta's fourth-order rule.
fn fire(cam: LensCamera, x: f32, phi: f32) -> Fired {
    let a = cam.a;
    // Unknown to the compiler, which would copy the loop's body SHOT_STEPS times.
    let steps = min(SHOT_STEPS, cam.ny * 1000u);
    let h = phi / f32(steps);
    var state = vec4<f32>(0.0, fan_start(cam, x).x, 0.0, 1.0);
    var time = 0.0;
    for (var i = 0u; i < steps; i++) {
        let k1 = shot_rates(a, state);
        let s2 = state + 0.5 * h * k1;
        let k2 = shot_rates(a, s2);
        let s3 = state + 0.5 * h * k2;
        let k3 = shot_rates(a, s3);
        let s4 = state + h * k3;
        let k4 = shot_rates(a, s4);
        let middle = shot_time(a + s2.x, s2.y) + shot_time(a + s3.x, s3.y);
        time += h / 6.0 * (shot_time(a + state.x, state.y) + 2.0 * middle + shot_time(a + s4.x, s4.y));
        state += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
        let u = a + state.x;
        if !(u < max(100.0, 2.0 * a)) {
            return Fired(FELL, 0.0, 0.0, 1.0, 0.0);
        }
        // Past the sky the equation leads back to false points.
        if u < -0.5 || (u < 0.0 && state.y > 0.0) {
            return Fired(LEFT, 0.0, 0.0, 1.0, 0.0);
        }
    }
    return Fired(MET, state.x, state.y, state.z, time);
}

/// The ray of a point outside.
fn integrated_ray(cam: LensCamera, at: SourcePoint, sweep: f32) -> LensRay {
    if !(finite(at.r) && finite(at.dr) && at.r > 1e-3 && at.lapse2 > 0.0) {
        return no_ray();
    }
    let c = 1.0 / at.r;
    let ray = shot_ray(cam, c, -at.dr * c * cam.a, max(sweep, SMALLEST_SWEEP));
    if !ray.found {
        return no_ray();
    }
    return ray_of(cam, c, max(at.lapse2, 1e-4), ray.slope, ray.energy, ray.emission_slope, ray.time);
}
