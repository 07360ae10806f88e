//! How two pictures of one size differ.

use image::{Rgb, RgbImage};

use crate::dial::moments::linear;
use crate::flip::mean_flip;

/// Steps of 255 within which two drivers round.
const ROUNDING: u8 = 2;

/// How they differ.
#[derive(Clone, Debug)]
pub struct Difference {
    /// All pixels.
    pub pixels: usize,
    /// Of those, so many whose light differs by more than rounding.
    pub differ: usize,
    /// And so many of those whose light is not between that of the pixel's neighbours in the other picture: an edge that lies elsewhere
    /// by part of a pixel does not count.
    pub elsewhere: usize,
    /// The greatest difference, in steps of 255.
    pub greatest: u8,
    /// Mean FLIP.
    pub flip: f64,
    /// Where: white for elsewhere, grey for a difference.
    pub map: RgbImage,
}

/// Compares two pictures of the same size.
pub fn difference(one: &RgbImage, other: &RgbImage) -> Difference {
    let (width, height) = one.dimensions();
    let mut found = Difference {
        pixels: (width * height) as usize,
        differ: 0,
        elsewhere: 0,
        greatest: 0,
        flip: 0.0,
        map: RgbImage::new(width, height),
    };
    for (x, y, pixel) in one.enumerate_pixels() {
        let most = pixel.0.iter().zip(other.get_pixel(x, y).0).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0);
        found.greatest = found.greatest.max(most);
        if most > ROUNDING {
            found.differ += 1;
            let elsewhere = !is_among(pixel, other, [x, y]) || !is_among(other.get_pixel(x, y), one, [x, y]);
            found.elsewhere += usize::from(elsewhere);
            found.map.put_pixel(x, y, Rgb([if elsewhere { 255 } else { 110 }; 3]));
        }
    }
    let light = |picture: &RgbImage| picture.pixels().map(|pixel| pixel.0.map(linear)).collect::<Vec<_>>();
    found.flip = mean_flip(&light(one), &light(other), [width, height]);
    found
}

/// Whether each channel is between the least and the greatest of the pixel's neighbours in a picture, but for rounding.
fn is_among(pixel: &Rgb<u8>, picture: &RgbImage, [x, y]: [u32; 2]) -> bool {
    let (mut least, mut most) = ([u8::MAX; 3], [0; 3]);
    for v in y.saturating_sub(1)..=(y + 1).min(picture.height() - 1) {
        for u in x.saturating_sub(1)..=(x + 1).min(picture.width() - 1) {
            for (channel, light) in picture.get_pixel(u, v).0.into_iter().enumerate() {
                least[channel] = light.min(least[channel]);
                most[channel] = light.max(most[channel]);
            }
        }
    }
    (0..3).all(|k| (least[k].saturating_sub(ROUNDING)..=most[k].saturating_add(ROUNDING)).contains(&pixel.0[k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_and_faults_are_told_apart() {
        // An edge between dark and light that lies a pixel further right in the second.
        let edge = |at: u32| RgbImage::from_fn(8, 8, |x, _| Rgb([if x < at { 10 } else { 200 }; 3]));
        let (one, other) = (edge(4), edge(5));
        let found = difference(&one, &other);
        assert_eq!((found.differ, found.elsewhere, found.greatest), (8, 0, 190));
        // A spot that only one of them has.
        let mut spotted = one.clone();
        spotted.put_pixel(1, 1, Rgb([90, 0, 0]));
        let found = difference(&one, &spotted);
        assert_eq!((found.differ, found.elsewhere), (1, 1));
        assert!(found.flip > 0.0 && found.map.get_pixel(1, 1).0 == [255; 3]);
        let same = difference(&one, &one);
        assert_eq!((same.differ, same.greatest, same.flip), (0, 0, 0.0));
    }
}
