// From a point of an object to the place where the camera sees it.

/// What one ray tells: where it is seen, how long it took, and the photon's momentum at both ends over |E b|.
struct Sight {
    /// Apparent position, camera axes: direction times light path.
    apparent: vec3<f32>,
    delay: f32,
    /// Rain-frame momentum of the photon at the point and at the camera, over E b; w: its frequency there.
    leaving: vec4<f32>,
    arriving: vec4<f32>,
    valid: bool,
}

/// The ray of `order` from the point `offset` away from the camera (rain axes). `side` is the unit vector across the axis towards the
/// point; given apart, because on the axis the offset does not say it. `across` is the distance from the axis.
fn sight(offset: vec3<f32>, along: f32, across: f32, side: vec3<f32>, order: u32) -> Sight {
    let ray = lens_lookup(along, across, order);
    let turn = select(1.0, -1.0, order == 2u);
    let n = frame.radial.xyz;
    // The direction, at the camera, in which the ray sweeps backwards round the hole; even orders go the other way.
    let sweep = side * turn;
    let look = n * ray.cos_psi + sweep * ray.sin_psi;

    var result: Sight;
    result.valid = ray.valid;
    result.delay = ray.delay;
    let null_vector = vec4<f32>(look * ray.delay, -ray.delay);
    result.apparent = (frame.camera_from_rain * null_vector).xyz;
    result.arriving = vec4<f32>(-look * ray.frequency, ray.frequency);

    // At the point: radial m, and the direction of the sweep there.
    let position = n * frame.radial.w + offset;
    let r = max(length(position), 1e-6);
    let m = position / r;
    let sin_phi = across / r;
    let cos_phi = dot(m, n);
    // d(side)/dΦ-wise: the sweep's tangent at the point is side·cosφ − n·sinφ, times the sense.
    let tangent = (side * cos_phi - n * sin_phi) * turn;
    result.leaving = vec4<f32>(m * ray.emission_radial - tangent * ray.emission_tangential, ray.emission_frequency);
    return result;
}

/// Splits an offset from the camera into its part along the axis, its distance from the axis and the unit vector across.
struct Split {
    along: f32,
    across: f32,
    side: vec3<f32>,
}

fn split_offset(offset: vec3<f32>) -> Split {
    let n = frame.radial.xyz;
    var result: Split;
    result.along = dot(offset, n);
    let q = vec2<f32>(dot(offset, frame.side_a.xyz), dot(offset, frame.side_b.xyz));
    result.across = length(q);
    if result.across > 0.0 {
        result.side = (frame.side_a.xyz * q.x + frame.side_b.xyz * q.y) / result.across;
    } else {
        result.side = frame.side_a.xyz;
    }
    return result;
}

fn sight_at(offset: vec3<f32>, order: u32) -> Sight {
    let parts = split_offset(offset);
    return sight(offset, parts.along, parts.across, parts.side, order);
}

/// ν_observed/ν_emitted for an emitter of rain-frame momentum `momentum` (xyz, γ).
fn frequency_ratio(arriving: vec4<f32>, leaving: vec4<f32>, momentum: vec4<f32>) -> f32 {
    // Time row of the Lorentz matrix: the photon (k, ω) has frequency Λ_t·(k, ω) in the camera's frame.
    let m = frame.camera_from_rain;
    let observed = m[0].w * arriving.x + m[1].w * arriving.y + m[2].w * arriving.z + m[3].w * arriving.w;
    let emitted = momentum.w * leaving.w - dot(momentum.xyz, leaving.xyz);
    return clamp(observed / emitted, 1e-3, 1e3);
}

/// The direction in which light left, in the emitter's rest frame.
fn leaving_direction(leaving: vec4<f32>, momentum: vec4<f32>) -> vec3<f32> {
    let k = leaving.xyz + momentum.xyz * (dot(momentum.xyz, leaving.xyz) / (1.0 + momentum.w) - leaving.w);
    return k / max(length(k), 1e-20);
}

/// Where the body point is, away from the camera, `s` after the emission time T₀ of the object's centre.
fn offset_at(placement: Placement, body: vec3<f32>, s: f32) -> vec3<f32> {
    let still = placement.shape_x.xyz * body.x + placement.shape_y.xyz * body.y + placement.shape_z.xyz * body.z;
    let turning = placement.shape_rate_x.xyz * body.x + placement.shape_rate_y.xyz * body.y + placement.shape_rate_z.xyz * body.z;
    return placement.offset.xyz + still + (placement.velocity.xyz + turning) * s;
}

/// The emission time of a body point, after T₀: solves s + Δ(x(s)) = T − T₀. The left side increases strictly with s, since no
/// emitter outruns light, so Newton with its slope held above a floor converges from any start.
fn emission_shift(placement: Placement, body: vec3<f32>, order: u32) -> f32 {
    if placement.velocity.w == 0.0 {
        return 0.0;
    }
    var s = 0.0;
    for (var i = 0; i < 3; i++) {
        let ray = sight_at(offset_at(placement, body, s), order);
        let missing = placement.offset.w - (s + ray.delay);
        // dΔ/dT along the worldline: the gradient of the light path at the point is minus the photon's momentum over its energy.
        let energy = ray.leaving.w - river_at(placement, body, s, ray.leaving.xyz);
        let slope = 1.0 - dot(placement.velocity.xyz, ray.leaving.xyz) / energy;
        s += missing / max(slope, 0.05);
    }
    return s;
}

/// β n·k at the point: what turns the rain frame's frequency into the conserved energy E = ω − β n·k.
fn river_at(placement: Placement, body: vec3<f32>, s: f32, k: vec3<f32>) -> f32 {
    let position = frame.radial.xyz * frame.radial.w + offset_at(placement, body, s);
    let r = max(length(position), 1e-6);
    return dot(position, k) / (r * sqrt(r));
}
