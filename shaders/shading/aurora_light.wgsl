#define_import_path lensrunner::shading::aurora_light

// The aurora's light on the ground of its planet: a map in the plane across the field (src/scene/aurora/ground.rs).

#import lensrunner::gpu::types::Instance
#import lensrunner::shading::bindings::surface_sampler

struct GroundLight {
    /// Columns of the rotation from the axes of the planet's model to those of its magnetic dipole.
    dipole_x: vec3<f32>,
    /// Id of the planet, 0 for none.
    planet: u32,
    dipole_y: vec3<f32>,
    /// 1 if the south has an aurora as well, else 0.
    both_poles: u32,
    dipole_z: vec3<f32>,
    /// A radian of colatitude on the map, over the map's side; so are the next two.
    per_radian: f32,
    /// Linear colour of a curtain.
    colour: vec3<f32>,
    /// Share of the older map in the mix of both.
    older: f32,
    /// Position of the pole on the map.
    pole: vec2<f32>,
    half_texel: f32,
    unused: f32,
}

@group(2) @binding(5) var<uniform> ground: GroundLight;
/// Brightness of white ground over that of a curtain, by the newest row of the history (x) and by the one before (y).
@group(2) @binding(6) var ground_map: texture_2d<f32>;

/// Position on the map of the ground with the normal n (rain axes). z: above 0 on a side that has an aurora, below 0 for everything but the
/// planet. Round the pole opposite to the map's middle positions lie in all directions and cannot be interpolated: there z is below 0.
fn ground_place(instance: Instance, n: vec3<f32>) -> vec3<f32> {
    let body = vec3<f32>(dot(instance.turn_x, n), dot(instance.turn_y, n), dot(instance.turn_z, n));
    let from_dipole = ground.dipole_x * body.x + ground.dipole_y * body.y + ground.dipole_z * body.z;
    let up = select(from_dipole.z, abs(from_dipole.z), ground.both_poles != 0u);
    let out = length(from_dipole.xy);
    let place = ground.pole + from_dipole.xy * (atan2(out, up) / max(out, 1e-6) * ground.per_radian);
    return select(vec3<f32>(-1.0), vec3<f32>(place, up), instance.object == ground.planet);
}

/// The light of the aurora on the ground at a position of the map, as `irradiance` has it.
fn aurora_light(place: vec3<f32>) -> vec3<f32> {
    // Most of what is drawn is off the map, and reads nothing. The sampler, which is made for surfaces, wraps beyond the middle of the last
    // texel.
    let half = ground.half_texel;
    if place.z <= 0.0 || any(place.xy <= vec2<f32>(half)) || any(place.xy >= vec2<f32>(1.0 - half)) {
        return vec3<f32>(0.0);
    }
    let rows = textureSampleLevel(ground_map, surface_sampler, place.xy, 0.0).xy;
    return ground.colour * mix(rows.x, rows.y, ground.older);
}
