//! What a surface sends to the camera: the game's rules of colour, each a twin of the function of the same name in `shaders/`.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};

use super::texture::Pyramid;
use super::world::worldline::BodyMotion;
use super::world::{Thing, World};
use crate::judge::trace::Hit;
use crate::scene::blackbody::blackbody_rgb;
use crate::scene::disk::DISK_UNIT;
use crate::scene::lighting::Illumination;
use crate::scene::model::Material;
use crate::spacetime::matter::gamma;
use crate::spacetime::metric::river_speed;

/// A point of a surface as the light leaves it.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Texture coordinates.
    pub uv: Vec2,
    /// Unit normal in rain axes (rest frame of the object, pure boost).
    pub normal: Vec3,
    /// Unit direction in which the light left, in the same frame.
    pub leaving: Vec3,
    /// ν_observed/ν_emitted.
    pub g: f64,
    /// Index of the material in the model.
    pub material: u32,
}

/// What changes light on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightShift {
    /// Light changes its colour with g.
    pub doppler: bool,
    /// Light changes its strength with g.
    pub beaming: bool,
}

/// The largest light a channel can hold: half floats end at 65,504.
const BRIGHTEST: f32 = 6e4;

impl World<'_> {
    /// The surface at a hit. `blue` is ν_camera over the frequency that a rain observer at the camera sees.
    pub fn surface(&self, hit: &Hit, blue: f64) -> Surface {
        let thing = &self.things[hit.object];
        let model = &self.models[thing.model];
        let corners = model.triangles[hit.triangle].map(|i| &model.vertices[i as usize]);
        let weights = hit.barycentrics.map(|w| w as f32);
        let mut uv = Vec2::ZERO;
        let mut normal = DVec3::ZERO;
        for (corner, (&w, &exact)) in corners.iter().zip(weights.iter().zip(&hit.barycentrics)) {
            uv += Vec2::from(corner.uv) * w;
            normal += DVec3::from(corner.normal.map(f64::from)) * exact;
        }
        let (momentum, attitude) = match thing.motion {
            BodyMotion::Static { attitude, .. } => (if self.hole { static_body_momentum(hit.position) } else { DVec3::ZERO }, attitude),
            BodyMotion::Flying(line) => {
                let pose = line.at(self.time - hit.delay);
                (pose.momentum, pose.attitude)
            }
        };
        let (k, frequency) = (hit.momentum, hit.momentum.length());
        let emitted = gamma(momentum) * frequency - momentum.dot(k);
        let leaving = k + momentum * (momentum.dot(k) / (1.0 + gamma(momentum)) - frequency);
        Surface {
            uv,
            normal: (attitude * normal).normalize_or(DVec3::Z).as_vec3(),
            leaving: leaving.normalize_or(DVec3::Z).as_vec3(),
            g: blue / emitted,
            material: model.triangle_materials[hit.triangle],
        }
    }
}

/// γβ outward: the rain-frame momentum of an observer at rest at `position`, who must be outside r = 1.
fn static_body_momentum(position: DVec3) -> DVec3 {
    // Rounding must not take it to r = 1 or below, where nothing is static.
    let r = position.length().max(1.0 + 1e-12);
    position * (river_speed(r) / (r * (1.0 - 1.0 / r).sqrt()))
}

/// The images of a world's materials, ready to be sampled.
pub struct Textures(
    /// One pyramid for each distinct image, by its address.
    HashMap<usize, Pyramid>,
);

impl Textures {
    /// Those of the models of a world.
    pub fn of(world: &World) -> Textures {
        let mut found: HashMap<usize, Pyramid> = HashMap::new();
        for image in world.models.iter().flat_map(|model| &model.materials).filter_map(|material| material.texture.as_ref()) {
            found.entry(Arc::as_ptr(image) as usize).or_insert_with(|| Pyramid::of(image));
        }
        Textures(found)
    }

    /// The light of a surface of a thing of this world, linear RGB; `detail` is the level at which its texture is read.
    pub fn light(&self, world: &World, thing: usize, surface: &Surface, detail: f32, shift: LightShift) -> Vec3 {
        let thing = &world.things[thing];
        let material = &world.models[thing.model].materials[surface.material as usize];
        let pyramid = material.texture.as_ref().and_then(|image| self.0.get(&(Arc::as_ptr(image) as usize)));
        shaded(surface, thing, material, texel(pyramid, surface.uv, detail), shift)
    }
}

/// The light of a surface, linear RGB; `texel` is its texture there.
pub fn shaded(surface: &Surface, thing: &Thing, material: &Material, texel: Option<Vec3>, shift: LightShift) -> Vec3 {
    let [r, g, b, _] = material.base_colour;
    let texel = texel.unwrap_or(Vec3::ONE);
    let base = Vec3::new(r, g, b) * texel;
    let emitted = Vec3::from(material.emissive) * texel;
    let leaving = surface.leaving;
    let n = if surface.normal.dot(leaving) < 0.0 { -surface.normal } else { surface.normal };
    let metallic = material.metallic;
    let roughness = material.roughness.max(0.08);
    let mut colour = emitted + base * irradiance(&thing.light, n) * (1.0 - metallic);
    let mirrored = n * (2.0 * n.dot(leaving)) - leaving;
    let fresnel = Vec3::splat(0.04).lerp(base, metallic);
    let rim = (1.0 - n.dot(leaving).max(0.0)).powi(5);
    let reflected = irradiance(&thing.light, mirrored.lerp(n, roughness * roughness).normalize_or(n));
    colour += (fresnel + (Vec3::ONE - fresnel) * rim * (1.0 - roughness)) * reflected * gloss(&thing.light, mirrored, roughness);
    // As the game's renderer, which draws no redder and no bluer light.
    let g = surface.g.clamp(1e-3, 1e3);
    let mut shifted = shifted_colour(colour, g as f32, shift);
    if material.temperature > 0.0 {
        let black_body = |t: f64| Vec3::from(blackbody_rgb(t).map(|channel| channel as f32));
        shifted += black_body_seen(black_body, f64::from(material.temperature), g, shift) * DISK_UNIT as f32;
    }
    shifted.min(Vec3::splat(BRIGHTEST))
}

/// Light of a black body of `temperature` (K) seen at frequency ratio g: by Planck's law and Liouville's theorem that of one at gT, each of
/// which `black_body` knows. Where light does not change its colour, or its strength, that is as at rest.
pub fn black_body_seen(black_body: impl Fn(f64) -> Vec3, temperature: f64, g: f64, shift: LightShift) -> Vec3 {
    let luminance = |rgb: Vec3| rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722)).max(1e-30);
    let (rest, shifted) = (black_body(temperature), black_body(temperature * g));
    match (shift.doppler, shift.beaming) {
        (true, true) => shifted,
        (false, false) => rest,
        (true, false) => shifted * (luminance(rest) / luminance(shifted)),
        (false, true) => rest * (luminance(shifted) / luminance(rest)),
    }
}

/// The level of detail at which a texture is read, from the change of (u, v) from one sample to the next, across and down.
pub fn detail(across: Vec2, down: Vec2) -> f32 {
    let size = super::texture::SIZE as f32;
    (size * across.length().max(down.length())).log2()
}

/// Reads the texture of a surface, if it has one.
pub fn texel(pyramid: Option<&Pyramid>, uv: Vec2, detail: f32) -> Option<Vec3> {
    pyramid.map(|pyramid| pyramid.sample(uv, detail))
}

/// Light that falls on a surface of normal n: ambient and first harmonic of what shines around the object.
fn irradiance(light: &Illumination, n: Vec3) -> Vec3 {
    let channel = |c: usize| light.ambient[c] + Vec3::from(light.directed[c]).dot(n);
    Vec3::new(channel(0), channel(1), channel(2)).max(Vec3::ZERO)
}

/// A highlight towards the main light, narrower on smooth surfaces.
fn gloss(light: &Illumination, direction: Vec3, roughness: f32) -> f32 {
    let main: Vec3 = light.directed.iter().map(|&d| Vec3::from(d)).sum();
    let strength = main.length();
    if strength < 1e-9 {
        return 1.0;
    }
    let aligned = direction.dot(main / strength).max(0.0);
    let power = 2.0 / (roughness * roughness);
    0.6 + 0.25 * power * aligned.powf(power) * 0.25
}

// ln of the channels' dominant wavelengths in nm: 611, 549, 464 (sRGB primaries).
const LN_RED: f32 = 6.41510;
const LN_GREEN: f32 = 6.30810;
const LN_BLUE: f32 = 6.13988;
/// Width, in ln λ, of the fall of the spectrum outside the three channels: reflected sunlight falls by half from 0.6 to 0.95 µm.
const SPECTRUM_FALL: f32 = 0.5;

/// Light of a surface that is not a black body, seen at frequency ratio g: `shifted_colour` of gpu/colour.wgsl.
pub fn shifted_colour(rgb: Vec3, g: f32, shift: LightShift) -> Vec3 {
    let mut colour = rgb;
    if shift.doppler {
        let shift = g.ln();
        colour = Vec3::new(spectrum_at(rgb, LN_RED + shift), spectrum_at(rgb, LN_GREEN + shift), spectrum_at(rgb, LN_BLUE + shift));
    }
    if shift.beaming { colour * (g * g * g) } else { colour }
}

fn spectrum_at(rgb: Vec3, ln_wavelength: f32) -> f32 {
    let fall = |x: f32| (-x * x).exp();
    if ln_wavelength >= LN_RED {
        return rgb.x * fall((ln_wavelength - LN_RED) / SPECTRUM_FALL);
    }
    if ln_wavelength <= LN_BLUE {
        return rgb.z * fall((LN_BLUE - ln_wavelength) / SPECTRUM_FALL);
    }
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    if ln_wavelength >= LN_GREEN {
        mix(rgb.y, rgb.x, (ln_wavelength - LN_GREEN) / (LN_RED - LN_GREEN))
    } else {
        mix(rgb.z, rgb.y, (ln_wavelength - LN_BLUE) / (LN_GREEN - LN_BLUE))
    }
}
