#define_import_path lensrunner::disk::light

// The light of the gas at a vertex, and how it changes with temperature.

#import lensrunner::disk::types::disk
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::colour::{blackbody_rgb, luminance}
#import lensrunner::gpu::types::{FLAG_BEAMING, FLAG_DOPPLER}

struct GasLight {
    /// Linear light in the scene's unit.
    rgb: vec3<f32>,
    /// d ln rgb/d ln T.
    slope: vec3<f32>,
}

/// Light of gas of this ln T seen at this ln g: a black body at gT. If the shift of colour or of brightness is switched off, that one is as
/// at rest.
fn gas_light(ln_temperature: f32, ln_g: f32) -> GasLight {
    let doppler = (frame.flags & FLAG_DOPPLER) != 0u;
    let beaming = (frame.flags & FLAG_BEAMING) != 0u;
    let shifted = ln_temperature + ln_g;
    let shown = select(ln_temperature, shifted, doppler);
    let rgb = blackbody_rgb(exp(shown));
    // The temperature that determines brightness, and with it the slope: another than that of the colour if one of both is switched off.
    let felt = select(ln_temperature, shifted, beaming);
    var gain = disk.unit;
    var glow = rgb;
    if (doppler != beaming) & (ln_g != 0.0) {
        glow = blackbody_rgb(exp(felt));
        gain *= luminance(glow) / max(luminance(rgb), 1e-30);
    }
    // Mean slope over a tenth of T: where light falls off fast, the mean over what streaks do to the temperature.
    let above = blackbody_rgb(exp(felt + 0.1));
    // The slope is limited. Cold gas is black whatever its slope; 45 is that of blue light at 700 K. Where there is hardly any green or
    // blue, the table keeps them above zero and its slope is not Planck's. So they stay below the ratios to the slope of red that hold from
    // 2,500 to 9,000 K; light is then right to 2 % of its luminance over what streaks do. With the ratios of inverse wavelengths, 1.12 and
    // 1.33, bright streaks lacked 6 % of their green and 16 % of their blue.
    let steep = min(log(max(above, vec3<f32>(1e-30)) / max(glow, vec3<f32>(1e-30))) / (1.0 - exp(-0.1)), vec3<f32>(45.0));
    let slope = min(steep, steep.x * vec3<f32>(1.0, 1.22, 1.8));
    return GasLight(min(rgb * gain, vec3<f32>(6e4)), slope);
}
