//! Smaller copies of a surface's image. They are means of light, not of the bytes that stand for it: a body far away would be too dark
//! where bright and dark lie side by side.

use std::sync::{Arc, LazyLock};

use image::RgbaImage;

use crate::scene::model::Image;

/// Side of a layer of the texture array, in pixels; images of other sizes are resampled.
pub const TEXTURE_SIZE: u32 = 1024;

/// The image at the size of the texture array, and each half of it down to one texel.
pub fn mips(image: &Image) -> Arc<[RgbaImage]> {
    let whole = RgbaImage::from_raw(image.width, image.height, image.rgba.clone())
        .unwrap_or_else(|| RgbaImage::from_pixel(1, 1, image::Rgba([255; 4])));
    let size = TEXTURE_SIZE;
    let whole = match whole.dimensions() == (size, size) {
        true => whole,
        false => image::imageops::resize(&whole, size, size, image::imageops::FilterType::Triangle),
    };
    std::iter::successors(Some(whole), |level| (level.width() > 1).then(|| halved(level))).collect()
}

/// Each texel the mean of four.
fn halved(level: &RgbaImage) -> RgbaImage {
    let row = 4 * level.width() as usize;
    let rows = level.as_raw().chunks_exact(2 * row);
    let texels = rows.flat_map(|rows| {
        let (upper, lower) = rows.split_at(row);
        upper.chunks_exact(8).zip(lower.chunks_exact(8)).flat_map(|(a, b)| {
            std::array::from_fn::<u8, 4, _>(|k| match k {
                3 => ((u16::from(a[3]) + u16::from(a[7]) + u16::from(b[3]) + u16::from(b[7])) / 4) as u8,
                _ => CODES.byte([a[k], a[k + 4], b[k], b[k + 4]]),
            })
        })
    });
    let half = level.width() / 2;
    RgbaImage::from_raw(half, half, texels.collect()).unwrap_or_else(|| RgbaImage::new(half, half))
}

/// sRGB of 8 bits and light (IEC 61966-2-1).
struct Codes {
    /// The light of a byte, of [`FULL`].
    light: [u16; 256],
    /// The byte of each light: the nearest.
    byte: Vec<u8>,
}

/// Light of the byte 255. The darkest byte's is 5 of it.
const FULL: f32 = 16384.0;

static CODES: LazyLock<Codes> = LazyLock::new(|| {
    let light_of = |byte: f32| {
        let x = byte / 255.0;
        FULL * if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
    };
    let light = std::array::from_fn(|byte| light_of(byte as f32).round() as u16);
    let mut byte = 0u8;
    let bytes = (0..=FULL as u32).map(|light| {
        while byte < 255 && light as f32 > light_of(f32::from(byte) + 0.5) {
            byte += 1;
        }
        byte
    });
    Codes { light, byte: bytes.collect() }
});

impl Codes {
    /// The byte of the mean light of four.
    fn byte(&self, of: [u8; 4]) -> u8 {
        let sum: u32 = of.iter().map(|byte| u32::from(self.light[usize::from(*byte)])).sum();
        self.byte[((sum + 2) / 4) as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smaller_copies_have_the_same_light() {
        let size = TEXTURE_SIZE;
        let is_even = |k: u32| (k / size + k).is_multiple_of(2);
        let rgba = (0..size * size).flat_map(|k| if is_even(k) { [255, 188, 40, 255] } else { [0, 188, 41, 255] }).collect();
        let levels = mips(&Image { width: size, height: size, rgba });
        assert_eq!(levels.len(), TEXTURE_SIZE.ilog2() as usize + 1);
        let last = levels.last().unwrap().get_pixel(0, 0).0;
        // Half of the light of white is 188; by the mean of bytes it was 128.
        assert!(last[0].abs_diff(188) <= 1 && last[1] == 188 && last[2].abs_diff(40) <= 1, "{last:?}");
        for byte in 0..=255u8 {
            assert_eq!(CODES.byte([byte; 4]), byte);
        }
    }
}
