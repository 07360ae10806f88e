#define_import_path lensrunner::lensing::lookup

// The lookup: from a point's place to the direction in which it is seen and the time its light takes. The twin of
// src/lensing/lookup/mod.rs,
// function for function.

#import lensrunner::lensing::closed_form::{
    axes, basis, bent_sweep, delay_across, delay_along, delay_factor, emission_scale, finite, half_angle, HALF_TURN, lens_equation,
    LensCamera, light_cones, log1p, near_axis, slopes, SMALLEST_SWEEP, source_point, SourcePoint, stumpffs, turned_slopes,
}
#import lensrunner::lensing::inside::inside
#import lensrunner::lensing::slice::{lens_camera, lens_texel, residuals}

/// Whether the camera may be inside the horizon. Passes that never look from there at what is inside compile in half the time.
const SEES_INSIDE: bool = #{SEES_INSIDE};
/// The least 1 − 1/r that the logarithm of the horizon is taken of.
const LEAST_LAPSE2: f32 = 1e-7;

/// What the lookup returns: directions in the rain frame, momenta per angular momentum (in 1/r_s).
struct LensRay {
    cos_psi: f32,              // the look direction from the outward radial
    sin_psi: f32,
    delay: f32,                // T_arrival − T_emission, r_s/c
    frequency: f32,            // of the photon in the rain frame at the camera
    emission_radial: f32,      // of the photon's rain-frame momentum at the point: outward,
    emission_tangential: f32,  // against the sweep,
    emission_frequency: f32,   // and its frequency
    slope: f32,                // w
    emission_slope: f32,       // w_e
    energy: f32,               // e, negative where E < 0
    valid: bool,
}

fn joined(w: f32, w_e: f32, cam: LensCamera, c: f32, lapse2: f32) -> vec3<f32> {
    let here = cam.a * cam.a * cam.lapse_squared;
    let there = c * c * lapse2;
    if cam.lapse_squared <= 0.0 {
        // Inside, e is a small difference of large terms at the camera, a sum at the point; the ray comes from above.
        let square = max(w_e * w_e + there, 0.0);
        return vec3<f32>(-sqrt(square - here), sqrt(square), w_e);
    }
    let square = max(w * w + here, 0.0);
    // Away from a turning point the energy gives the magnitude more precisely.
    let rest = square - there;
    let root = sqrt(max(rest, 0.0));
    return vec3<f32>(w, sqrt(square), select(w_e, select(root, -root, w_e < 0.0), rest > 0.3 * square));
}

/// Light of no age, and of any: where there are two rays, E > 0 or E < 0.
const YOUNG: f32 = 0.0;
const OLD: f32 = 3e38;

/// The answer where there is none.
fn no_ray() -> LensRay {
    return LensRay(1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, false);
}

fn ray_of(cam: LensCamera, c: f32, lapse2: f32, w: f32, e: f32, w_e: f32, delay: f32) -> LensRay {
    let cones = light_cones(vec2<f32>(w, w_e), e, vec2<f32>(cam.a, c), vec2<f32>(cam.beta, sqrt(c)), vec2<f32>(cam.lapse_squared, lapse2));
    return ray_with(cam, c, vec4<f32>(w, e, w_e, delay), cones);
}

fn ray_with(cam: LensCamera, c: f32, ray: vec4<f32>, cones: vec4<f32>) -> LensRay {
    let twice = cones.x + cones.z;
    let left = cones.y + cones.w;
    if !finite(abs(twice) + abs(left) + abs(ray.x) + abs(ray.z) + abs(ray.w)) {
        return no_ray();
    }
    let inverse = 1.0 / twice;
    return LensRay((cones.z - cones.x) * inverse, 2.0 * cam.a * inverse, ray.w, 0.5 * twice, 0.5 * (cones.y - cones.w), c, 0.5 * left,
        ray.x, ray.z, ray.y, true);
}

fn lookup(cam: LensCamera, at: SourcePoint, sweep: f32, elapsed: f32) -> LensRay {
    if !(finite(at.r) && finite(at.dr) && finite(sweep) && at.r > 1e-3 && sweep >= 0.0) {
        return no_ray();
    }
    let swept = max(sweep, SMALLEST_SWEEP);
    let c = 1.0 / at.r;
    var lapse2 = at.lapse_squared;
    if lapse2 > 0.0 {
        lapse2 = max(lapse2, LEAST_LAPSE2);
        let bent = bent_sweep(swept);
        let square = half_angle(cam, bent);
        let halves = stumpffs(vec2<f32>(0.25 * bent * bent, square));
        let guesses = slopes(cam, -at.dr * c * cam.a, basis(cam, bent, square, halves.zw));
        let lens = lens_equation(cam, c, bent, halves.xy);
        let logs = log(vec3<f32>(c + cam.soft, near_axis(swept), 0.5 * lens.y));
        let xy = axes(cam, sqrt(lapse2), swept, logs);
        let across = delay_across(cam, at.r, c, lapse2, at.dr, lens, vec2<f32>(log1p(at.dr * cam.a), logs.z));
        let table = residuals(cam, xy.x, xy.y);
        let w = turned_slopes(guesses, vec2<f32>(cam.a, emission_scale(cam, c)), table.xz);
        let joint = joined(w.x, w.y, cam, c, lapse2);
        let cones = light_cones(joint.xz, joint.y, vec2<f32>(cam.a, c), vec2<f32>(cam.beta, sqrt(c)), vec2<f32>(cam.lapse_squared, lapse2));
        let delay = delay_along(cam, at.r, c, at.dr, cones) + delay_factor(cam, c, lens.x, joint.y) * (across + table.y);
        return ray_with(cam, c, vec4<f32>(joint, delay), cones);
    }
    if SEES_INSIDE && cam.lapse_squared < 0.0 {
        let ray = inside(cam, at, swept, elapsed);
        if ray.w > 0.0 {
            return ray_of(cam, c, lapse2, ray.x, ray.y, ray.z, ray.w);
        }
    }
    return no_ray();
}

/// Φ of `order` for the point at `at`.
fn swept(at: SourcePoint, order: u32) -> f32 {
    // No branch: where the order is the same for a whole pass a driver would compile it anew for each.
    return select(at.phi, select(2.0 * HALF_TURN - at.phi, 2.0 * HALF_TURN + at.phi, order == 3u), order != 1u);
}

/// The ray of `order` from the point `along` outward and `across` from the axis, away from the camera; `height` = L + along; `elapsed` is
/// the time since the light left as far as it is known: where camera and point are both inside it decides between E > 0 and E < 0.
fn lens_lookup_aged(along: f32, across: f32, height: f32, order: u32, elapsed: f32) -> LensRay {
    // Far from the camera the place is known without it: it must be a number all the same.
    if !finite(along) {
        return no_ray();
    }
    let cam = lens_camera();
    let at = source_point(cam, along, across, height);
    return lookup(cam, at, swept(at, order), elapsed);
}

fn lens_lookup_at(along: f32, across: f32, height: f32, order: u32) -> LensRay {
    return lens_lookup_aged(along, across, height, order, YOUNG);
}

/// The same where only the offset is at hand.
fn lens_lookup(along: f32, across: f32, order: u32) -> LensRay {
    return lens_lookup_at(along, across, lens_texel(0u).x + along, order);
}
