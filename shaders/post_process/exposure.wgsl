// Exposure: one workgroup reads two coarse levels of the bloom chain and moves the exposure towards the target.

#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::colour::luminance
#import lensrunner::gpu::types::{Adaptation, FLAG_HOLD_EXPOSURE}

/// Cells across the picture that is metered: the levels are mixed to what a level of this width would say, so that the exposure does not
/// jump with the resolution.
const METERED_WIDTH: f32 = 80.0;

@group(2) @binding(0) var finer: texture_2d<f32>;
@group(2) @binding(1) var coarser: texture_2d<f32>;
/// That of the last frame.
@group(2) @binding(2) var<storage, read_write> adaptation: Adaptation;

var<workgroup> sums: array<vec4<f32>, 64>;

/// Weight of a texel: 0 on the player's own ship, since the ship is lit for the exposure and not the exposure chosen for the ship. The
/// circle's edge is soft, so that nothing jumps as it moves.
fn metered_part(texel: vec2<f32>, size: vec2<f32>) -> f32 {
    let radius = max(frame.unmetered_radius, 1e-6);
    let place = (texel + 0.5 - 0.5 * size) / size.x;
    return select(smoothstep(radius, 1.25 * radius, distance(place, frame.unmetered_middle)), 1.0, frame.unmetered_radius <= 0.0);
}

/// Sums of squared light and of light over the texels of a level that a lane has.
fn sums_of(source: texture_2d<f32>, lane: u32) -> vec2<f32> {
    let size = textureDimensions(source);
    var sum = vec2<f32>(0.0);
    for (var k = lane; k < size.x * size.y; k += 64u) {
        let texel = vec2<u32>(k % size.x, k / size.x);
        let light = luminance(textureLoad(source, texel, 0).rgb);
        // Weighted by light itself: what shines is metered, not the black between.
        if light > 0.0 && light < 1e5 {
            sum += vec2<f32>(light * light, light) * metered_part(vec2<f32>(texel), vec2<f32>(size));
        }
    }
    return sum;
}

@compute @workgroup_size(64)
fn main(@builtin(local_invocation_index) lane: u32) {
    sums[lane] = vec4<f32>(sums_of(finer, lane), sums_of(coarser, lane));
    workgroupBarrier();
    if lane == 0u {
        var total = vec4<f32>(0.0);
        for (var k = 0u; k < 64u; k++) {
            total += sums[k];
        }
        let octaves = clamp(log2(f32(textureDimensions(finer).x) / METERED_WIDTH), 0.0, 1.0);
        let each = log(max(total.xz / max(total.yw, vec2<f32>(1e-9)), vec2<f32>(1e-9)));
        let metered = exp(mix(each.x, each.y, octaves));
        // Stars alone, brought to the light of a disk, would be a field of snow.
        let key = select(frame.exposure_key_without_disk, frame.exposure_key, any(frame.disk_indices != vec4<u32>(0u)));
        let wanted = clamp(key / metered, frame.least_exposure, frame.greatest_exposure);
        // In stops, like the eye; the first frame begins at the target.
        let nearer = exp(mix(log(max(adaptation.exposure, 1e-12)), log(wanted), select(frame.adaptation, 1.0, adaptation.known == 0.0)));
        let exposure = select(nearer, adaptation.exposure, (frame.flags & FLAG_HOLD_EXPOSURE) != 0u);
        adaptation = Adaptation(exposure, metered, 1.0, 1.0);
    }
}
