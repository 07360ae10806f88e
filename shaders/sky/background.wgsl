// The background: for each pixel the direction at infinity, and the Milky Way there, filtered by the size of the lensed pixel.

@group(1) @binding(0) var milky_way: texture_2d<f32>;
@group(1) @binding(1) var milky_way_sampler: sampler;

struct Screen {
    @builtin(position) position: vec4<f32>,
    @location(0) ndc: vec2<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> Screen {
    // One triangle over the screen, at the far end of the reversed depth.
    let corner = vec2<f32>(f32((i << 1u) & 2u), f32(i & 2u)) * 2.0 - 1.0;
    return Screen(vec4<f32>(corner, 0.0, 1.0), corner);
}

@fragment
fn fragment(in: Screen) -> @location(0) vec4<f32> {
    let pixel = normalize(vec3<f32>(in.ndc / frame.projection.xy, -1.0));
    // Light that arrives from `pixel` is the null vector (pixel, −1) seen into the past.
    let past = frame.rain_from_camera * vec4<f32>(pixel, -1.0);
    let look = past.xyz / length(past.xyz);
    let n = frame.radial.xyz;
    let cos_psi = clamp(dot(look, n), -1.0, 1.0);
    let across = look - n * cos_psi;
    let sin_psi = length(across);
    let psi = atan2(sin_psi, cos_psi);
    let edge = frame.exposure.w;
    if psi >= edge {
        return vec4<f32>(0.0, 0.0, 0.0, 1.0);
    }
    let s = -log(max(1.0 - psi / edge, 1e-7));
    let swept = sky_swept(s);
    let tangent = across / max(sin_psi, 1e-9);
    let direction = n * cos(swept.x) + tangent * sin(swept.x);

    // How much sky one pixel covers: along the radius dΦ/dψ, across it sinΦ/sinψ; aberration scales both by 1/D.
    let doppler = camera_doppler(look);
    let along = swept.y / max(edge - psi, 1e-7);
    let sideways = abs(sin(swept.x)) / max(sin_psi, 1e-5);
    let size = frame.size.z * max(along, max(sideways, 1e-3)) * doppler;

    let icrs = frame.sky_x.xyz * direction.x + frame.sky_y.xyz * direction.y + frame.sky_z.xyz * direction.z;
    let uv = vec2<f32>(fract(0.5 - atan2(icrs.y, icrs.x) / (2.0 * PI)), acos(clamp(icrs.z, -1.0, 1.0)) / PI);
    let texels = f32(textureDimensions(milky_way).y) / PI;
    let level = log2(max(size * texels, 1e-6));
    let light = textureSampleLevel(milky_way, milky_way_sampler, uv, level).rgb;
    let g = sky_ratio(cos_psi, doppler);
    let flags = frame.switches.x;
    let colour = shifted_colour(light, g, (flags & FLAG_DOPPLER) != 0u, (flags & FLAG_BEAMING) != 0u);
    return vec4<f32>(min(colour * frame.light.z, vec3<f32>(6e4)), 1.0);
}
