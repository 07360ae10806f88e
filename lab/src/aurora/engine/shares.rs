//! What part of a splat's light falls on each pixel along one of its sides: Gaussians of standard deviations from half a pixel to 2.4,
//! tabulated. In the finest layer they are sampled as they are. Pixels of coarser layers are enlarged, each into a hump of its own
//! (`layers.rs`); there the shares are those whose humps together are nearest to the Gaussian that is wanted (least squares), which takes
//! fewer of them, and from narrower Gaussians on.

use super::points::lesser;

/// Variance that enlarging adds in the end, pixels of a layer squared: 5/4 of a fine pixel's each time.
pub(super) const ADDED: f32 = 5.0 / 12.0;

/// Most pixels along a side of a splat, where its standard deviation is 2.4 pixels.
const WIDTH: usize = 13;
/// How far splats of the finest layer reach beyond half a pixel: a narrow one to so many of its standard deviations, a wide one to so many
/// and a part of a pixel, which makes 2.5 of them. Beyond lies 1 % of a side's light at most, which is dealt out over the pixels within.
const REACH: f32 = 2.75;
const WIDE_REACH: (f32, f32) = (2.35, 0.36);
/// The same for coarser layers: what is beyond is less than 6 % of the peak, and humps have no edge there.
const ENLARGED_REACH: (f32, f32) = (1.78, 0.7);
/// Tabulated Gaussians: standard deviations from 0.5 to 2.4 pixels in steps of 1/40, and places within a pixel.
pub(super) const WIDTHS: usize = 76;
pub(super) const WIDTHS_PER_PIXEL: f32 = 40.0;
pub(super) const PLACES: usize = 32;

/// Shares of a side in the table: that of the pixel in the middle of the splat is the one numbered `MIDDLE`, those beyond the splat's reach
/// are nothing, as are those at the ends of the rows before and after. So pairs may begin before the splat does, and both sides take as
/// many pixels as the longer one. A power of two, so that no row lies across two of a cache's lines.
pub(super) const SIDE: usize = 16;
pub(super) const MIDDLE: usize = WIDTH / 2 + 1;
/// Shares of the finest layer; those of the coarser ones are behind them.
pub(super) const FINEST: usize = (WIDTHS + 1) * (PLACES + 1) * SIDE;

/// All of them, and what is read behind the last row.
pub(super) const SHARES: usize = 2 * FINEST + SIDE;

/// Each pixel's share of a splat along one side, by layer (the finest or a coarser one), width and place; the shares' sum is 1, so that no
/// light is lost.
#[derive(Clone, Debug)]
pub struct Shares(pub(super) Vec<f32>);

impl Default for Shares {
    fn default() -> Self {
        let mut shares = Vec::with_capacity(SHARES);
        let humps: Vec<Humps> = (0..=WIDTH / 2).map(Humps::new).collect();
        for enlarged in [false, true] {
            for row in 0..=WIDTHS {
                let sigma = row as f32 / WIDTHS_PER_PIXEL + 0.5;
                let half = half_of(sigma, enlarged) as usize;
                for place in 0..=PLACES {
                    // From the middle of the splat's middle pixel to the splat's.
                    let middle = place as f64 / PLACES as f64 - 0.5;
                    let own =
                        if enlarged { humps[half].nearest(f64::from(sigma), middle) } else { sampled(half, f64::from(sigma), middle) };
                    let mut side = [0.0; SIDE];
                    for (share, own) in side[MIDDLE - half..].iter_mut().zip(own) {
                        *share = own as f32;
                    }
                    shares.extend(side);
                }
            }
        }
        shares.extend([0.0; SIDE]);
        Shares(shares)
    }
}

/// Pixels that a splat of a standard deviation covers on each side of the one that its middle is in, in the finest layer or in one that is
/// enlarged. An odd number altogether fits the pairs that pixels lie in, wherever it starts.
#[inline(always)]
pub(super) fn half_of(sigma: f32, enlarged: bool) -> f32 {
    let finest = lesser(sigma * REACH, sigma * WIDE_REACH.0 + WIDE_REACH.1);
    let reach = if enlarged { sigma * ENLARGED_REACH.0 + ENLARGED_REACH.1 } else { finest };
    lesser(nearest(reach), (WIDTH / 2) as f32)
}

/// Shares of `half` pixels to either side of the one whose middle is 0, each by the Gaussian's value in its middle.
fn sampled(half: usize, sigma: f64, middle: f64) -> Vec<f64> {
    let mut shares: Vec<f64> = (0..=2 * half).map(|k| (-0.5 * ((k as f64 - half as f64 - middle) / sigma).powi(2)).exp()).collect();
    let sum: f64 = shares.iter().sum();
    shares.iter_mut().for_each(|share| *share /= sum);
    shares
}

/// Times that a pixel is enlarged before humps are compared with a Gaussian: their form hardly changes any more, and variances are matched
/// for each layer in any case (`ADDED` in [`super::pyramid`]).
const TIMES: usize = 3;
/// Parts of a pixel then.
const FINE: usize = 1 << TIMES;

/// Humps into which some neighbouring pixels are enlarged, and how they overlap.
struct Humps {
    half: usize,
    /// The light of each pixel, a sum of 1, over parts of pixels; the first begins 3 pixels before the first pixel does.
    humps: Vec<Vec<f64>>,
    /// The inverse of the matrix of their products.
    inverse: Vec<Vec<f64>>,
    /// The sum of each of its rows.
    even: Vec<f64>,
}

impl Humps {
    /// Of `half` pixels to either side of one.
    fn new(half: usize) -> Humps {
        let pixels = 2 * half + 1;
        // One pixel, in the middle of seven.
        let mut hump = vec![0.0; 7];
        hump[3] = 1.0;
        for _ in 0..TIMES {
            let mut finer = vec![0.0; 2 * hump.len()];
            for (k, light) in hump.iter().enumerate() {
                for (n, share) in [1.0, 5.0, 10.0, 10.0, 5.0, 1.0].into_iter().enumerate() {
                    // None beyond the seven, where there is no light.
                    if let Some(fine) = (2 * k + n).checked_sub(2).and_then(|at| finer.get_mut(at)) {
                        *fine += light * share / 32.0;
                    }
                }
            }
            hump = finer;
        }
        let humps: Vec<Vec<f64>> = (0..pixels)
            .map(|k| {
                let mut row = vec![0.0; (pixels + 6) * FINE];
                row[k * FINE..][..hump.len()].copy_from_slice(&hump);
                row
            })
            .collect();
        let products = humps.iter().map(|a| humps.iter().map(|b| product(a, b)).collect()).collect();
        let inverse = inverse(products);
        let even = inverse.iter().map(|row| row.iter().sum()).collect();
        Humps { half, humps, inverse, even }
    }

    /// The shares, 1 in sum, whose humps are nearest to a Gaussian, wider than the one asked for by what enlarging adds.
    fn nearest(&self, sigma: f64, middle: f64) -> Vec<f64> {
        let variance = sigma * sigma + f64::from(ADDED) * (1.0 - 0.25f64.powi(TIMES as i32));
        let first = -(self.half as f64 + 3.5) + 0.5 / FINE as f64;
        let wanted: Vec<f64> = (0..(2 * self.half + 7) * FINE)
            .map(|k| (-0.5 * (first + k as f64 / FINE as f64 - middle).powi(2) / variance).exp())
            .map(|light| light / (std::f64::consts::TAU * variance).sqrt() / FINE as f64)
            .collect();
        let overlap: Vec<f64> = self.humps.iter().map(|hump| product(hump, &wanted)).collect();
        // The least squares, and what must be added to each that they add up to 1 (Lagrange's multiplier).
        let shares: Vec<f64> = self.inverse.iter().map(|row| product(row, &overlap)).collect();
        let missing = (1.0 - shares.iter().sum::<f64>()) / self.even.iter().sum::<f64>();
        // Narrow ones ask for a little less than nothing beside their middle: there is no light below nothing.
        let mut shares: Vec<f64> = shares.iter().zip(&self.even).map(|(share, even)| (share + missing * even).max(0.0)).collect();
        let sum: f64 = shares.iter().sum();
        shares.iter_mut().for_each(|share| *share /= sum);
        shares
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Of a matrix of products, which is symmetric and positive definite: no rows need be exchanged (Gauss and Jordan).
fn inverse(mut matrix: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let n = matrix.len();
    for (k, row) in matrix.iter_mut().enumerate() {
        row.extend((0..n).map(|column| f64::from(u8::from(column == k))));
    }
    for k in 0..n {
        let pivot: Vec<f64> = matrix[k].iter().map(|number| number / matrix[k][k]).collect();
        for (other, row) in matrix.iter_mut().enumerate() {
            if other != k {
                let share = row[k];
                row.iter_mut().zip(&pivot).for_each(|(number, pivot)| *number -= share * pivot);
            }
        }
        matrix[k] = pivot;
    }
    matrix.into_iter().map(|row| row[n..].to_vec()).collect()
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
