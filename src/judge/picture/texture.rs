//! Images as a renderer samples them: a square pyramid, bilinear in a level and linear between levels, in linear light.

use glam::{Vec2, Vec3};

use crate::scene::model::Image;

/// Side of the finest level, in pixels: images of other sizes are resampled, as the game's renderer does.
pub const SIZE: u32 = 1024;

/// One level: a row-by-row picture of linear light.
#[derive(Clone, Debug)]
pub struct Level {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Linear RGB.
    pub pixels: Vec<Vec3>,
}

impl Level {
    /// Each pixel the mean of four.
    fn halved(&self) -> Level {
        let (width, height) = (self.width / 2, self.height / 2);
        let at = |x: usize, y: usize| self.pixels[y * self.width + x];
        let mean = |x: usize, y: usize| 0.25 * (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1));
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (2 * x, 2 * y))).map(|(x, y)| mean(x, y)).collect();
        Level { width, height, pixels }
    }

    /// Bilinear at (u, v) in [0, 1]²; u wraps, v wraps or is held at the edge.
    fn sample(&self, uv: Vec2, wrap_v: bool) -> Vec3 {
        let (x, y) = (uv.x * self.width as f32 - 0.5, uv.y * self.height as f32 - 0.5);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let at = |dx: i64, dy: i64| {
            let column = (x.floor() as i64 + dx).rem_euclid(self.width as i64) as usize;
            let row = y.floor() as i64 + dy;
            let last = self.height as i64;
            let row = if wrap_v { row.rem_euclid(last) } else { row.clamp(0, last - 1) };
            self.pixels[row as usize * self.width + column]
        };
        at(0, 0).lerp(at(1, 0), fx).lerp(at(0, 1).lerp(at(1, 1), fx), fy)
    }
}

/// A picture with its smaller copies.
#[derive(Clone, Debug)]
pub struct Pyramid {
    /// From full size down.
    pub levels: Vec<Level>,
    /// Whether v wraps, too.
    pub wrap_v: bool,
}

impl Pyramid {
    /// The pyramid of a surface's image, each level half the one before: means of light.
    pub fn of(image: &Image) -> Pyramid {
        let mut whole = image::RgbaImage::from_raw(image.width, image.height, image.rgba.clone())
            .unwrap_or_else(|| image::RgbaImage::from_pixel(1, 1, image::Rgba([255; 4])));
        if whole.dimensions() != (SIZE, SIZE) {
            whole = image::imageops::resize(&whole, SIZE, SIZE, image::imageops::FilterType::Triangle);
        }
        let light: [f32; 256] = std::array::from_fn(|byte| decode(byte as u8));
        let pixels = whole.pixels().map(|p| Vec3::from([p[0], p[1], p[2]].map(|byte| light[usize::from(byte)]))).collect();
        let whole = Level { width: SIZE as usize, height: SIZE as usize, pixels };
        let levels = std::iter::successors(Some(whole), |level| (level.width > 1).then(|| level.halved()));
        Pyramid { levels: levels.collect(), wrap_v: true }
    }

    /// At (u, v) and a level of detail: 0 the full size, 1 half of it; between levels linear.
    pub fn sample(&self, uv: Vec2, detail: f32) -> Vec3 {
        let last = self.levels.len() - 1;
        let detail = if detail.is_finite() { detail.clamp(0.0, last as f32) } else { 0.0 };
        let fine = detail.floor() as usize;
        let upper = self.levels[fine].sample(uv, self.wrap_v);
        if fine == last { upper } else { upper.lerp(self.levels[fine + 1].sample(uv, self.wrap_v), detail - fine as f32) }
    }
}

/// sRGB, 8 bits, to linear (IEC 61966-2-1).
fn decode(byte: u8) -> f32 {
    let x = f32::from(byte) / 255.0;
    if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}
