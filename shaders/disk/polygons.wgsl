// The disk of polygons, drawn: triangles that the stages of geometry have tessellated, opaque, nearest first by depth.

@group(1) @binding(0) var<storage, read> seen: array<SeenVertex>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Gas {
    let found = seen[index];
    let r = max(found.surface.y, 1.0);
    let gas = radial_gas(r);
    let ratio = gas_ratio(found.apparent.xyz, r, gas);
    let shown = select(gas.a.x, gas.a.x + log(ratio.x), (frame.switches.x & FLAG_DOPPLER) != 0u);
    let heat = (shown - log(BLACKBODY_COLDEST)) * disk.gas.y;
    let depth = gas.a.y * disk_slant(ratio.y, found.apparent.w, gas.b.y);
    return Gas(clip_position(found.apparent.xyz), vec4<f32>(found.surface.x - gas.b.x / 6.28318531, gas.b.z, heat, depth), vec4<f32>(1.0, 0.0, 1e6, ratio.y), found.apparent.w);
}

@fragment
fn fragment(in: Gas) -> @location(0) vec4<f32> {
    let at = streaks_of(in.gas, in.path);
    let turbulence = at.shares.x * textureSampleLevel(pattern, pattern_sampler, at.young, at.level).x
        + at.shares.y * textureSampleLevel(pattern, pattern_sampler, at.old, at.level).x;
    return vec4<f32>(gas_light(in.gas, in.look.x, in.gas.w, turbulence).rgb, 1.0);
}
