// Looks rays up and nothing else: what the chart of methods times, and what the tests hold against the twins. A method's file goes behind.

struct RaceFrame {
    radial: vec4<f32>, // w: the camera's radius
}

/// As in bindings.wgsl.
const TABLE_ROW: u32 = 1024u;

@group(0) @binding(0) var<uniform> frame: RaceFrame;
@group(0) @binding(1) var lens_slice: texture_2d<f32>;
/// Along, across, height, and the order, 4 more for light of any age.
@group(0) @binding(2) var<storage, read> race_rows: array<vec4<f32>>;
/// Two for each thread: cos ψ, sin ψ, delay, presence; frequency, momentum and frequency at the point, e.
@group(0) @binding(3) var<storage, read_write> race_out: array<vec4<f32>>;

/// More threads than rows look the rows up again.
@compute @workgroup_size(64)
fn race(@builtin(global_invocation_id) id: vec3<u32>) {
    if 2u * id.x + 1u >= arrayLength(&race_out) {
        return;
    }
    let row = race_rows[id.x % arrayLength(&race_rows)];
    let code = u32(row.w);
    let ray = method_ray(row.x, row.y, row.z, code % 4u, select(YOUNG, OLD, code >= 4u));
    race_out[2u * id.x] = vec4<f32>(ray.cos_psi, ray.sin_psi, ray.delay, select(0.0, 1.0, ray.valid));
    race_out[2u * id.x + 1u] = vec4<f32>(ray.frequency, ray.emission_radial, ray.emission_frequency, ray.energy);
}

/// The same without the look-up: the cost of a dispatch and of its rows.
@compute @workgroup_size(64)
fn idle(@builtin(global_invocation_id) id: vec3<u32>) {
    if 2u * id.x + 1u >= arrayLength(&race_out) {
        return;
    }
    let row = race_rows[id.x % arrayLength(&race_rows)];
    race_out[2u * id.x] = row + vec4<f32>(frame.radial.w * 0.0) + lens_texel(0u);
    race_out[2u * id.x + 1u] = row.wzyx;
}
