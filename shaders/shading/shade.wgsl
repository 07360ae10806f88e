#define_import_path lensrunner::shading::shade

#import lensrunner::chosen::worldlines::before_turning
#import lensrunner::gpu::bindings::frame
#import lensrunner::gpu::colour::{black_body_seen, luminance, shifted_colour}
#import lensrunner::gpu::types::{FLAG_BEAMING, FLAG_DOPPLER, Instance, INSTANCE_OWN, SeenVertex}
#import lensrunner::instances::instance::instance_at
#import lensrunner::shading::aurora_light::{aurora_light, ground_place}
#import lensrunner::shading::bindings::{materials, surface_sampler, surface_textures}

/// What goes to the pixels, packed: at most 16 variables go between stages.
struct Surface {
    @builtin(position) position: vec4<f32>,
    /// `SeenVertex.normal`; w: its shift.
    @location(0) normal: vec4<f32>,
    /// `SeenVertex.leaving`; w: its radius.
    @location(1) leaving: vec4<f32>,
    /// Texture coordinates; z: light path.
    @location(2) uv: vec3<f32>,
    /// x: what it covers; y: what the nearer part of the same image covers, which is laid over it later.
    @location(3) coverage: vec2<f32>,
    /// Texture coordinates at the axis; z: how far from there.
    @location(4) fan: vec3<f32>,
    /// Object id and image order; z: texture layer + 1.
    @location(5) @interpolate(flat) which: vec3<u32>,
    // Data of the instance and the material, read once per vertex: software drivers pay for each word that each pixel reads from a buffer.
    @location(6) @interpolate(flat) light_red: vec4<f32>,
    @location(7) @interpolate(flat) light_green: vec4<f32>,
    @location(8) @interpolate(flat) light_blue: vec4<f32>,
    /// Linear base colour; w: metallic.
    @location(9) @interpolate(flat) base: vec4<f32>,
    /// Emitted light; w: roughness.
    @location(10) @interpolate(flat) emissive: vec4<f32>,
    /// `ground_place`.
    @location(11) ground: vec3<f32>,
    /// In K; 0 does not glow.
    @location(12) @interpolate(flat) temperature: f32,
}

fn surface_of(vertex: SeenVertex, position: vec4<f32>, coverage: vec2<f32>) -> Surface {
    let instance = instance_at(vertex.instance);
    let material = materials[vertex.material];
    let filled = fill(instance);
    // Only nozzles shine with the engines.
    let emissive = material.emissive * (1.0 - material.nozzle * instance.engines_off);
    return Surface(position, vec4<f32>(vertex.normal, vertex.shift), vec4<f32>(vertex.leaving, vertex.radius),
        vec3<f32>(vertex.uv, vertex.path), coverage, vec3<f32>(vertex.axis_uv, vertex.from_axis),
        vec3<u32>(instance.object, instance.order, u32(material.layer + 1.0)), instance.light_red * filled, instance.light_green * filled,
        instance.light_blue * filled, vec4<f32>(material.base, material.metallic), vec4<f32>(emissive, material.roughness),
        ground_place(instance, before_turning(instance, vertex.normal, vertex.path)), material.temperature);
}

/// Factor on the light that falls on the player's own ship, so that middle grey, at the exposure of the frame before, is neither too dark
/// nor too light; 1 for all else. It changes as smoothly as the exposure.
fn fill(instance: Instance) -> f32 {
    if (instance.flags & INSTANCE_OWN) == 0u || frame.exposure_known == 0.0 {
        return 1.0;
    }
    let light = luminance(vec3<f32>(instance.light_red.w, instance.light_green.w, instance.light_blue.w));
    let grey = max(MIDDLE_GREY * light * frame.last_exposure * frame.exposure_bias, 1e-9);
    return clamp(grey, frame.least_fill, frame.greatest_fill) / grey;
}

/// Share of light that middle grey reflects.
const MIDDLE_GREY: f32 = 0.18;
/// Light of a black body at 5,772 K in the scene's unit of radiance, whether it is gas of the disk or a surface.
const DISK_UNIT: f32 = 24.0;

/// `texture_point` at a pixel.
fn texture_place(in: Surface) -> vec2<f32> {
    return mix(in.fan.xy, in.uv.xy, vec2<f32>(in.fan.z));
}

fn shaded(in: Surface) -> vec3<f32> {
    var base = in.base.rgb;
    var emitted = in.emissive.rgb;
    // Sampled by all pixels, because the mip level comes from differences between them.
    let texel = textureSample(surface_textures, surface_sampler, texture_place(in), i32(max(in.which.z, 1u) - 1u)).rgb;
    if in.which.z > 0u {
        base *= texel;
        emitted *= texel;
    }
    let leaving = normalize(in.leaving.xyz);
    var n = normalize(in.normal.xyz);
    if dot(n, leaving) < 0.0 {
        n = -n;
    }
    let light = irradiance(in, n);
    let metallic = in.base.w;
    let roughness = max(in.emissive.w, 0.08);
    var colour = emitted + base * (light + aurora_light(in.ground)) * (1.0 - metallic);
    // The reflection on a glossy surface: the surroundings in the mirrored direction, sharpened towards the side of the light.
    let mirrored = reflect(-leaving, n);
    let fresnel = mix(vec3<f32>(0.04), base, vec3<f32>(metallic));
    let grazing = 1.0 - max(dot(n, leaving), 0.0);
    let rim = grazing * grazing * grazing * grazing * grazing;
    let reflected = irradiance(in, normalize(mix(mirrored, n, vec3<f32>(roughness * roughness))));
    colour += (fresnel + (1.0 - fresnel) * rim * (1.0 - roughness)) * reflected * gloss(in, mirrored, roughness);
    let flags = frame.flags;
    let g = in.normal.w;
    let doppler = (flags & FLAG_DOPPLER) != 0u;
    let beaming = (flags & FLAG_BEAMING) != 0u;
    var shifted = shifted_colour(colour, g, doppler, beaming);
    if in.temperature > 0.0 {
        shifted += DISK_UNIT * black_body_seen(in.temperature, g, doppler, beaming);
    }
    return min(shifted, vec3<f32>(6e4));
}

/// Light that falls on a surface of normal n: ambient and first harmonic of what shines around the object.
fn irradiance(in: Surface, n: vec3<f32>) -> vec3<f32> {
    return max(vec3<f32>(in.light_red.w + dot(in.light_red.xyz, n), in.light_green.w + dot(in.light_green.xyz, n),
        in.light_blue.w + dot(in.light_blue.xyz, n)), vec3<f32>(0.0));
}

/// A highlight towards the main light, narrower on smooth surfaces.
fn gloss(in: Surface, direction: vec3<f32>, roughness: f32) -> f32 {
    let main = in.light_red.xyz + in.light_green.xyz + in.light_blue.xyz;
    let strength = length(main);
    if strength < 1e-9 {
        return 1.0;
    }
    let aligned = max(dot(direction, main / strength), 0.0);
    let power = 2.0 / (roughness * roughness);
    return 0.6 + 0.25 * power * pow(aligned, power) * 0.25;
}
