// The background: the Milky Way behind everything, filtered by the size of the lensed pixel. Cells come from cells.wgsl.

@group(1) @binding(0) var<storage, read> corners: array<SkyCorner>;
@group(1) @binding(1) var milky_way: texture_2d<f32>;
@group(1) @binding(2) var milky_way_sampler: sampler;

struct Smooth {
    @builtin(position) position: vec4<f32>,
    /// Place on the panorama, and its level.
    @location(0) @interpolate(linear) place: vec3<f32>,
    /// Columns of the matrix from the panorama's colour to the seen one.
    @location(1) @interpolate(linear) red: vec3<f32>,
    @location(2) @interpolate(linear) green: vec3<f32>,
    @location(3) @interpolate(linear) blue: vec3<f32>,
}

@vertex
fn smooth_vertex(@builtin(vertex_index) i: u32) -> Smooth {
    let corner = corners[i];
    let level = panorama_level(corner.place.z, textureDimensions(milky_way).y);
    // At the far end of the reversed depth.
    return Smooth(vec4<f32>(corner.red.w, corner.green.w, 0.0, 1.0), vec3<f32>(corner.place.xy, level), corner.red.xyz, corner.green.xyz,
        corner.blue.xyz);
}

@fragment
fn smooth_fragment(in: Smooth) -> @location(0) vec4<f32> {
    let light = textureSampleLevel(milky_way, milky_way_sampler, in.place.xy, in.place.z).rgb;
    return vec4<f32>(min(in.red * light.r + in.green * light.g + in.blue * light.b, vec3<f32>(6e4)), 1.0);
}

struct Exact {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(linear) ndc: vec2<f32>,
}

@vertex
fn exact_vertex(@builtin(vertex_index) i: u32) -> Exact {
    let ndc = vec2<f32>(corners[i].red.w, corners[i].green.w);
    return Exact(vec4<f32>(ndc, 0.0, 1.0), ndc);
}

@fragment
fn exact_fragment(in: Exact) -> @location(0) vec4<f32> {
    let view = sky_view(in.ndc);
    if !view.lit {
        return vec4<f32>(0.0, 0.0, 0.0, 1.0);
    }
    let level = panorama_level(view.size, textureDimensions(milky_way).y);
    let light = textureSampleLevel(milky_way, milky_way_sampler, view.uv, level).rgb;
    let flags = frame.switches.x;
    let colour = shifted_colour(light, view.g, (flags & FLAG_DOPPLER) != 0u, (flags & FLAG_BEAMING) != 0u);
    return vec4<f32>(min(colour * frame.light.z, vec3<f32>(6e4)), 1.0);
}
