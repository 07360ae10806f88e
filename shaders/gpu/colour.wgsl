#define_import_path lensrunner::gpu::colour

// Colour: black bodies and the shift of everything else.

#import lensrunner::gpu::bindings::blackbody

/// Temperatures of the ends of the black-body table, in K; it is uniform in ln T.
const BLACKBODY_COLDEST: f32 = 200.0;
const BLACKBODY_HOTTEST: f32 = 2.0e6;

/// Linear sRGB radiance of a black body, relative to the luminance of one at 5,772 K (the Sun).
fn blackbody_rgb(temperature: f32) -> vec3<f32> {
    let last = f32(textureDimensions(blackbody).x - 1u);
    let t = clamp(temperature, BLACKBODY_COLDEST, BLACKBODY_HOTTEST);
    let x = log(t / BLACKBODY_COLDEST) / log(BLACKBODY_HOTTEST / BLACKBODY_COLDEST) * last;
    let i = min(u32(x), u32(last) - 1u);
    // The table holds logarithms: radiance spans many powers of ten.
    let a = textureLoad(blackbody, vec2<u32>(i, 0u), 0).xyz;
    let b = textureLoad(blackbody, vec2<u32>(i + 1u, 0u), 0).xyz;
    return exp(mix(a, b, vec3<f32>(x - f32(i))));
}

/// Light of a black body seen at frequency ratio g, in the unit of `blackbody_rgb`: that of one at gT. If the shift of colour or of
/// brightness is switched off, that one is as at rest.
fn black_body_seen(temperature: f32, g: f32, doppler: bool, beaming: bool) -> vec3<f32> {
    let shown = blackbody_rgb(temperature * select(1.0, g, doppler));
    if doppler == beaming {
        return shown;
    }
    let felt = blackbody_rgb(temperature * select(1.0, g, beaming));
    return shown * (luminance(felt) / max(luminance(shown), 1e-30));
}

fn luminance(rgb: vec3<f32>) -> f32 {
    // ITU-R BT.709 primaries.
    return dot(rgb, vec3<f32>(0.2126, 0.7152, 0.0722));
}

/// Light of a surface that is not a black body, seen at frequency ratio g. The three channels are read as a spectrum over ln λ, linear
/// between the centres of the channels and falling as a Gaussian outside, which is sampled where the observed light came from. An
/// approximation: three numbers do not hold a spectrum. Radiance per frequency goes as g³ (Liouville: I_ν/ν³ is conserved).
fn shifted_colour(rgb: vec3<f32>, g: f32, doppler: bool, beaming: bool) -> vec3<f32> {
    var colour = rgb;
    if doppler & (g != 1.0) {
        let shift = log(g);
        colour = vec3<f32>(spectrum_at(rgb, LN_RED + shift), spectrum_at(rgb, LN_GREEN + shift), spectrum_at(rgb, LN_BLUE + shift));
    }
    return colour * select(1.0, g * g * g, beaming);
}

// ln of the channels' dominant wavelengths in nm: 611, 549, 464 (sRGB primaries).
const LN_RED: f32 = 6.41510;
const LN_GREEN: f32 = 6.30810;
const LN_BLUE: f32 = 6.13988;
/// Width, in ln λ, of the fall of the spectrum outside the three channels: reflected sunlight falls by half from 0.6 to 0.95 µm.
const SPECTRUM_FALL: f32 = 0.5;

fn spectrum_at(rgb: vec3<f32>, ln_wavelength: f32) -> f32 {
    if ln_wavelength >= LN_RED {
        let x = (ln_wavelength - LN_RED) / SPECTRUM_FALL;
        return rgb.r * exp(-x * x);
    }
    if ln_wavelength <= LN_BLUE {
        let x = (LN_BLUE - ln_wavelength) / SPECTRUM_FALL;
        return rgb.b * exp(-x * x);
    }
    if ln_wavelength >= LN_GREEN {
        return mix(rgb.g, rgb.r, (ln_wavelength - LN_GREEN) / (LN_RED - LN_GREEN));
    }
    return mix(rgb.b, rgb.g, (ln_wavelength - LN_BLUE) / (LN_GREEN - LN_BLUE));
}
