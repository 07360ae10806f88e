//! What part of a splat's light falls on each pixel along one of its sides: Gaussians of standard deviations from half a pixel to 2.4, tabulated.

use super::points::lesser;

/// Most pixels along a side of a splat, where its standard deviation is 2.4 pixels.
const WIDTH: usize = 13;
/// How far splats reach beyond half a pixel: a narrow one to so many of its standard deviations, a wide one to so many and a part of a pixel, which makes 2.5
/// of them. Beyond lies 1 % of a side's light at most, which is dealt out over the pixels within.
const REACH: f32 = 2.75;
const WIDE_REACH: (f32, f32) = (2.35, 0.36);
/// Tabulated Gaussians: standard deviations from 0.5 to 2.4 pixels in steps of 1/40, and places within a pixel.
pub(super) const WIDTHS: usize = 76;
pub(super) const WIDTHS_PER_PIXEL: f32 = 40.0;
pub(super) const PLACES: usize = 32;

/// Shares of a side in the table: that of the pixel in the middle of the splat is the one numbered `MIDDLE`, those beyond the splat's reach are
/// nothing, as are those at the ends of the rows before and after. So pairs may begin before the splat does, and both sides take as many
/// pixels as the longer one. A power of two, so that no row lies across two of a cache's lines.
pub(super) const SIDE: usize = 16;
pub(super) const MIDDLE: usize = WIDTH / 2 + 1;

/// All of them, and what is read behind the last row.
pub(super) const SHARES: usize = (WIDTHS + 1) * (PLACES + 1) * SIDE + SIDE;

/// Each pixel's share of a splat along one side, by width and place; the shares' sum is 1, so that no light is lost.
#[derive(Clone, Debug)]
pub struct Shares(pub(super) Vec<f32>);

impl Default for Shares {
    fn default() -> Self {
        let mut shares = Vec::with_capacity(SHARES);
        for row in 0..=WIDTHS {
            let sigma = row as f32 / WIDTHS_PER_PIXEL + 0.5;
            let half = half_of(sigma);
            for place in 0..=PLACES {
                // From the middle of the splat to that of the pixel.
                let middle = place as f32 / PLACES as f32 - 0.5;
                let side: [f32; SIDE] = std::array::from_fn(|k| {
                    let pixel = k as f32 - MIDDLE as f32;
                    if pixel.abs() <= half { (-0.5 * ((pixel - middle) / sigma).powi(2)).exp() } else { 0.0 }
                });
                let sum: f32 = side.iter().sum();
                shares.extend(side.map(|share| share / sum));
            }
        }
        shares.extend([0.0; SIDE]);
        Shares(shares)
    }
}

/// Pixels that a splat of a standard deviation covers on each side of the one that its middle is in. An odd number altogether fits the pairs
/// that pixels lie in, wherever it starts.
#[inline(always)]
pub(super) fn half_of(sigma: f32) -> f32 {
    lesser(nearest(lesser(sigma * REACH, sigma * WIDE_REACH.0 + WIDE_REACH.1)), (WIDTH / 2) as f32)
}

/// 1.5 × 2²³: the bits of a float that is this much greater end with the number, rounded.
const WHOLE: f32 = 12_582_912.0;

/// The nearest whole number, for numbers up to 2²². In two sums, as processors without wider instructions have nothing else for it.
#[inline(always)]
pub(super) fn nearest(number: f32) -> f32 {
    (number + WHOLE) - WHOLE
}

/// A whole number as an integer; nothing in particular for what is not a number.
#[inline(always)]
pub(super) fn integer(whole: f32) -> i32 {
    (whole + WHOLE).to_bits() as i32 - WHOLE.to_bits() as i32
}
