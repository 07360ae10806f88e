#define_import_path lensrunner::sky::table

// Light from infinity. Everything depends on one angle, so the table for the camera's radius has one dimension (render/sky/table.rs):
// Φ∞ is the angle that the ray seen at ψ sweeps on its way to infinity. It grows without bound at the edge of the shadow, as −ln of the
// gap; so with ψ = ψ_shadow (1 − e^{−s}) both Φ(s) and s(Φ) are smooth. Nodes hold value and slope; between them the cubic of Hermite.
//
// sky_slice[i] = (Φ, dΦ/ds at s = i·SKY_S / (n − 1);  s, ds/dΦ at Φ = i·3π / (n − 1)).

#import lensrunner::gpu::bindings::{frame, sky_slice}

const SKY_S: f32 = 12.0;
const SKY_PHI: f32 = 9.42477796;
const PI: f32 = 3.14159265358979;

/// Value and slope at x of the cubic through (0, a) and (1, b) with slopes da, db.
fn hermite(a: f32, da: f32, b: f32, db: f32, x: f32) -> vec2<f32> {
    let c2 = 3.0 * (b - a) - 2.0 * da - db;
    let c3 = 2.0 * (a - b) + da + db;
    return vec2<f32>(a + x * (da + x * (c2 + x * c3)), da + x * (2.0 * c2 + 3.0 * x * c3));
}

/// Swept angle to infinity, and its slope over s.
fn sky_swept(s: f32) -> vec2<f32> {
    let last = textureDimensions(sky_slice).x - 1u;
    let step = SKY_S / f32(last);
    let x = clamp(s / step, 0.0, f32(last));
    let i = min(u32(x), last - 1u);
    let a = textureLoad(sky_slice, vec2<u32>(i, 0u), 0);
    let b = textureLoad(sky_slice, vec2<u32>(i + 1u, 0u), 0);
    let value = hermite(a.x, a.y * step, b.x, b.y * step, x - f32(i));
    return vec2<f32>(value.x, value.y / step);
}

/// The inverse: s of the ray that sweeps Φ, and its slope.
fn sky_seen(swept: f32) -> vec2<f32> {
    let last = textureDimensions(sky_slice).x - 1u;
    let step = SKY_PHI / f32(last);
    let x = clamp(swept / step, 0.0, f32(last));
    let i = min(u32(x), last - 1u);
    let a = textureLoad(sky_slice, vec2<u32>(i, 0u), 0);
    let b = textureLoad(sky_slice, vec2<u32>(i + 1u, 0u), 0);
    let value = hermite(a.z, a.w * step, b.z, b.w * step, x - f32(i));
    return vec2<f32>(value.x, value.y / step);
}

/// Frequency seen by the camera over the rain frame's, for light that comes from `look` (rain axes).
fn camera_doppler(look: vec3<f32>) -> f32 {
    let m = frame.camera_from_rain;
    return m[3].w - (m[0].w * look.x + m[1].w * look.y + m[2].w * look.z);
}

/// ν_observed/ν_infinity for light from infinity that the rain frame sees at ψ.
fn sky_ratio(cos_psi: f32, doppler: f32) -> f32 {
    return doppler / max(1.0 + frame.river_speed * cos_psi, 1e-6);
}
