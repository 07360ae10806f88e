// The disk of sprites, projected: one thread per bit of gas and order. It is seen at its own emission time, by fixed point: gas on orbits outside
// r = 3 moves at half the speed of light at most, so each step halves the error or better.

@group(1) @binding(0) var<uniform> disk: DiskFrame;
/// Radius and azimuth at T = 0.
@group(1) @binding(2) var<storage, read> sprites: array<vec2<f32>>;
@group(1) @binding(3) var<storage, read_write> seen_sprites: array<SeenSprite>;
@group(1) @binding(4) var<storage, read_write> sprite_draw: SpriteDraw;

struct SpriteDraw {
    vertices: u32,
    instances: atomic<u32>,
    first_vertex: u32,
    first_instance: u32,
}

const STEPS: u32 = 3u;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&sprites) {
        return;
    }
    let order = id.y + 1u;
    let sprite = sprites[id.x];
    let r = sprite.x;
    let gas = radial_gas(r);
    let rate = 0.70710678 * pow(max(r, 3.0), -1.5);
    let origin = atan2(disk.towards.y, disk.towards.x);
    let turn = select(1.0, -1.0, order == 2u);
    var path = frame.radial.w;
    var ray: LensRay;
    var side = vec3<f32>(0.0);
    for (var k = 0u; k < STEPS; k++) {
        let theta = sprite.y + rate * (frame.projection.w - path) - origin;
        let s = sin(theta);
        let c = cos(theta);
        let up = -disk.towards.w * c;
        let reach = sqrt(up * up + s * s);
        side = (disk.upwards.xyz * up + disk.sideways.xyz * s) / max(reach, 1e-12);
        ray = lens_lookup_at(r * c * disk.sideways.w - frame.radial.w, r * reach, r * c * disk.sideways.w, order);
        path = ray.delay;
    }
    if !ray.valid || path <= 0.0 || gas.a.y < 1e-3 {
        return;
    }
    let look = frame.radial.xyz * ray.cos_psi + side * (turn * ray.sin_psi);
    let apparent = (frame.camera_from_rain * vec4<f32>(look * path, -path)).xyz;
    if apparent.z >= -1e-3 || !finite_vector(apparent) {
        return;
    }
    let clip = clip_position(apparent);
    let ndc = clip.xyz / clip.w;
    if any(abs(ndc.xy) > vec2<f32>(1.1)) {
        return;
    }
    let ratio = gas_ratio(apparent, r, ray.emission_slope > 0.0, gas);
    let alpha = 1.0 - exp(-gas.a.y * disk_slant(ratio.y, path, gas.b.y));
    let light = gas_light(gas.a.x, log(ratio.x)).rgb;
    // Spots that together cover the disk about once, face on.
    let radius = clamp(disk.sprites.x / path / frame.size.z, 0.5, 32.0);
    let slot = atomicAdd(&sprite_draw.instances, 1u);
    seen_sprites[slot] = SeenSprite(vec4<f32>(ndc, radius), vec4<f32>(light * alpha, alpha));
}
