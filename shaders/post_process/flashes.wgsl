// Reduced flashes: the mean brightness of the picture as it would be shown, and the factor that keeps its rise within bounds. All pixels
// count, each as tone mapping shows it: a coarser picture would tell another mean, since the tone curve is not straight.

#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::colour::luminance
#import lensrunner::gpu::types::Adaptation
#import lensrunner::post_process::tone_curve::display_light

@group(2) @binding(0) var picture: texture_2d<f32>;
@group(2) @binding(1) var linear_sampler: sampler;
@group(2) @binding(2) var bloom: texture_2d<f32>;
/// As in tone_map.wgsl.
@group(2) @binding(3) var<uniform> adapted: Adaptation;
/// A sum for each workgroup of `sum`.
@group(2) @binding(4) var<storage, read_write> sums: array<f32, GROUPS>;
@group(2) @binding(5) var<storage, read_write> shown: Shown;

struct Shown {
    /// Factor on the picture, (0, 1].
    factor: f32,
    /// Mean luminance that is shown, of 1 for white, kept for the next frame.
    mean: f32,
}

/// Workgroups that share the pixels; as in src/render/post_process/flashes.rs.
const GROUPS: u32 = 256u;

var<workgroup> parts: array<f32, 64>;

/// The sum of a number of each lane, in every lane.
fn workgroup_sum(lane: u32, part: f32) -> f32 {
    parts[lane] = part;
    workgroupBarrier();
    var total = 0.0;
    for (var k = 0u; k < 64u; k++) {
        total += parts[k];
    }
    return total;
}

@compute @workgroup_size(64)
fn sum(@builtin(local_invocation_index) lane: u32, @builtin(workgroup_id) group: vec3<u32>) {
    let size = textureDimensions(picture);
    var part = 0.0;
    for (var k = group.x * 64u + lane; k < size.x * size.y; k += GROUPS * 64u) {
        let place = vec2<u32>(k % size.x, k / size.x);
        let uv = (vec2<f32>(place) + 0.5) / vec2<f32>(size);
        let glow = textureSampleLevel(bloom, linear_sampler, uv, 0.0).rgb;
        let light = luminance(display_light(textureLoad(picture, place, 0).rgb, glow, adapted.exposure));
        // What is no number would stay in the mean of all frames to come.
        if light > 0.0 && light < 2.0 {
            part += light;
        }
    }
    let total = workgroup_sum(lane, part);
    if lane == 0u {
        sums[group.x] = total;
    }
}

@compute @workgroup_size(64)
fn settle(@builtin(local_invocation_index) lane: u32) {
    var part = 0.0;
    for (var k = lane; k < GROUPS; k += 64u) {
        part += sums[k];
    }
    let total = workgroup_sum(lane, part);
    if lane == 0u {
        let size = vec2<f32>(textureDimensions(picture));
        let mean = total / (size.x * size.y);
        let most = frame.rise_per_luminance * shown.mean + frame.most_rise;
        shown = Shown(select(most / max(mean, 1e-12), 1.0, mean <= most), min(mean, most));
    }
}
