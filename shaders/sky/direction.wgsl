#define_import_path lensrunner::sky::direction

// Where the light of a pixel comes from: its place on the panorama of the Milky Way, and how it is changed on the way.

#import lensrunner::gpu::bindings::frame
#import lensrunner::sky::table::{camera_doppler, PI, sky_ratio, sky_swept}

/// What is seen of the sky at one place of the screen.
struct SkyView {
    /// Place on the equirectangular panorama, [0, 1) × [0, 1].
    uv: vec2<f32>,
    /// How much sky one pixel covers, in radians.
    size: f32,
    /// ν_observed/ν_infinity.
    g: f32,
    /// False within the shadow.
    lit: bool,
}

/// Where a direction (ICRS) lies on the panorama: right ascension grows to the right, the north pole is above.
fn panorama_place(icrs: vec3<f32>) -> vec2<f32> {
    return vec2<f32>(fract(atan2(icrs.y, icrs.x) / (2.0 * PI)), acos(clamp(icrs.z, -1.0, 1.0)) / PI);
}

/// Linear RGB of luminance 1 of the faintest and of the brightest parts of the Milky Way: black bodies of 7,200 and 4,700 K.
const PANORAMA_FAINT: vec3<f32> = vec3<f32>(0.9916903, 0.98867637, 1.1366854);
const PANORAMA_BRIGHT: vec3<f32> = vec3<f32>(1.25817, 0.9537894, 0.6971495);

/// The light of a part of the Milky Way, from the root of its brightness and the colours of its faintest and of its brightest parts.
fn panorama_light(root: f32, faint: vec3<f32>, bright: vec3<f32>) -> vec3<f32> {
    return (root * root) * mix(faint, bright, vec3<f32>(root));
}

/// The sky at a place of the screen (normalised device coordinates).
fn sky_view(ndc: vec2<f32>) -> SkyView {
    let pixel = normalize(vec3<f32>(ndc / frame.focal, -1.0));
    // Light that arrives from `pixel` is the null vector (pixel, −1) seen into the past.
    let past = frame.rain_from_camera * vec4<f32>(pixel, -1.0);
    let look = past.xyz / length(past.xyz);
    let n = frame.outward;
    let cos_psi = clamp(dot(look, n), -1.0, 1.0);
    let across = look - n * cos_psi;
    let sin_psi = length(across);
    let psi = atan2(sin_psi, cos_psi);
    let edge = frame.shadow_edge;
    if psi >= edge {
        return SkyView(vec2<f32>(0.0), 1.0, 1.0, false);
    }
    let s = -log(max(1.0 - psi / edge, 1e-7));
    let swept = sky_swept(s);
    let tangent = across / max(sin_psi, 1e-9);
    let direction = n * cos(swept.x) + tangent * sin(swept.x);

    // How much sky one pixel covers: along the radius dΦ/dψ, across it sinΦ/sinψ; aberration scales both by 1/D.
    let doppler = camera_doppler(look);
    let along = swept.y / max(edge - psi, 1e-7);
    let sideways = abs(sin(swept.x)) / max(sin_psi, 1e-5);
    let size = frame.pixel * max(along, max(sideways, 1e-3)) * doppler;

    return SkyView(panorama_place(direction), size, sky_ratio(cos_psi, doppler), true);
}

/// The level of the panorama, `height` texels high, whose texels are as large as the pixel.
fn panorama_level(size: f32, height: u32) -> f32 {
    return log2(max(size * f32(height) / PI, 1e-6));
}
