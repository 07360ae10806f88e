//! Linear light to a picture for the eye: bloom, exposure, tone curve, as the passes in `shaders/post_process/` do it.

use glam::{Vec2, Vec3};

use crate::scene::model::texture::encode_srgb;

/// How a picture is finished.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PostProcessSettings {
    /// Share of the light that the lens spreads.
    pub bloom: f32,
    /// The light that the metered part of the picture is brought to, of 1 for white.
    pub key: f32,
    /// Least and greatest exposure.
    pub exposure_range: [f32; 2],
}

/// A picture of linear light.
#[derive(Clone, Debug)]
struct Canvas {
    size: [usize; 2],
    light: Vec<Vec3>,
}

/// Levels of the picture for bloom and metering: a quarter, and from there halvings.
const LEVELS: usize = 5;
/// Cells across the picture that is metered.
const METERED_WIDTH: f32 = 80.0;
/// Times that all levels together are softened.
const SOFTENED: usize = 2;
/// What a level and all coarser ones have of the glow, beside the next finer one.
const WIDER: f32 = 0.5;

impl Canvas {
    /// Bilinear at (u, v) in [0, 1]², held at the edges.
    fn sample(&self, uv: Vec2) -> Vec3 {
        let [width, height] = self.size;
        let (x, y) = (uv.x * width as f32 - 0.5, uv.y * height as f32 - 0.5);
        let at = |dx: i64, dy: i64| {
            let column = (x.floor() as i64 + dx).clamp(0, width as i64 - 1) as usize;
            let row = (y.floor() as i64 + dy).clamp(0, height as i64 - 1) as usize;
            self.light[row * width + column]
        };
        let (fx, fy) = (x - x.floor(), y - y.floor());
        at(0, 0).lerp(at(1, 0), fx).lerp(at(0, 1).lerp(at(1, 1), fx), fy)
    }

    /// Four bilinear taps, `part` of a pixel of this canvas away, at each pixel of a canvas of `size`.
    fn four_taps(&self, size: [usize; 2], part: f32) -> Canvas {
        let d = Vec2::splat(part) / Vec2::new(self.size[0] as f32, self.size[1] as f32);
        let mut light = Vec::with_capacity(size[0] * size[1]);
        for row in 0..size[1] {
            for column in 0..size[0] {
                let uv = Vec2::new((column as f32 + 0.5) / size[0] as f32, (row as f32 + 0.5) / size[1] as f32);
                let sum = [Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0), Vec2::new(-1.0, 1.0), Vec2::new(1.0, 1.0)]
                    .into_iter()
                    .map(|corner| self.sample(uv + d * corner))
                    .sum::<Vec3>();
                light.push(0.25 * sum);
            }
        }
        Canvas { size, light }
    }
}

/// Turns linear light of `size` pixels into sRGB, 3 bytes a pixel.
pub fn post_process(light: &[[f32; 3]], size: [u32; 2], how: &PostProcessSettings) -> Vec<u8> {
    let size = size.map(|side| side as usize);
    let picture = Canvas { size, light: light.iter().map(|&rgb| Vec3::from(rgb)).collect() };
    let mut levels: Vec<Canvas> = Vec::new();
    while levels.len() < LEVELS {
        let (finer, step) = levels.last().map_or((&picture, 4), |level| (level, 2));
        levels.push(finer.four_taps(finer.size.map(|side| side.div_ceil(step)), 1.0));
        if levels.last().is_some_and(|level| level.size[0].min(level.size[1]) <= 4) {
            break;
        }
    }
    let exposure = exposure(&levels, how);
    for level in (1..levels.len()).rev() {
        let wide = levels[level].four_taps(levels[level - 1].size, 0.5);
        for (pixel, glow) in levels[level - 1].light.iter_mut().zip(wide.light) {
            *pixel = pixel.lerp(glow, WIDER);
        }
    }
    let glow = (0..SOFTENED).fold(levels.swap_remove(0), |glow, _| glow.four_taps(glow.size, 0.5));
    let mut bytes = Vec::with_capacity(3 * size[0] * size[1]);
    for row in 0..size[1] {
        for column in 0..size[0] {
            let place = Vec2::new(column as f32 + 0.5, row as f32 + 0.5);
            let glow = glow.sample(place / Vec2::new(size[0] as f32, size[1] as f32));
            let exposed = picture.light[row * size[0] + column].lerp(glow, how.bloom) * exposure;
            // Half a step of 8-bit noise against banding in the dark.
            let noise = (52.982_918 * (place.dot(Vec2::new(0.067_110_56, 0.005_837_15))).fract()).fract() - 0.5;
            let rgb = (tone_curve(exposed) + noise / 1024.0).max(Vec3::ZERO);
            bytes.extend(rgb.to_array().map(encode_srgb));
        }
    }
    bytes
}

/// What brings the mean light, weighted by itself (what shines is metered, not the black between), to the key. It is read off the two
/// levels between whose widths `METERED_WIDTH` lies, as a level of just that width would have it.
fn exposure(levels: &[Canvas], how: &PostProcessSettings) -> f32 {
    let width = |level: usize| levels[level].size[0] as f32;
    let finer = (0..levels.len()).rev().find(|level| width(*level) >= METERED_WIDTH).unwrap_or(0);
    let octaves = (width(finer) / METERED_WIDTH).log2().clamp(0.0, 1.0);
    let [fine, coarse] = [finer, (finer + 1).min(levels.len() - 1)].map(|level| metered(&levels[level]).ln());
    (how.key / (fine + octaves * (coarse - fine)).exp()).clamp(how.exposure_range[0], how.exposure_range[1])
}

/// The mean light of a level, weighted by itself.
fn metered(level: &Canvas) -> f32 {
    let mut sum = Vec2::ZERO;
    for rgb in &level.light {
        let light = rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722));
        if light > 0.0 && light < 1e5 {
            sum += Vec2::new(light * light, light);
        }
    }
    (sum.x / sum.y.max(1e-9)).max(1e-9)
}

/// A filmic curve: straight in the dark, a soft shoulder; colours lose their hue only as they come near to white.
fn tone_curve(x: Vec3) -> Vec3 {
    let peak = x.max_element();
    if peak <= 0.0 {
        return Vec3::ZERO;
    }
    let mapped = 1.0 - (-peak).exp();
    let coloured = x / peak * mapped;
    let t = ((mapped - 0.6) / 0.4).clamp(0.0, 1.0);
    let bleach = t * t * (3.0 - 2.0 * t);
    coloured.lerp(Vec3::ONE - (Vec3::ONE - coloured) * (1.0 - bleach), bleach)
}
