//! Splats at a cost that does not grow with their size: a wide one is added where pixels are as wide as it is, in a picture of half, a quarter, …
//! the size, and these pictures are enlarged and summed at the end. Two points of a streak that are nearer to each other than their own width are
//! added as one.
//!
//! Enlarging by two-tap interpolation (weights ¾ and ¼) adds a variance of ¾ fine pixels², or ¼(1 − 4⁻ᵏ) pixels² of layer k after k times; the
//! Gaussian that is added to the layer is narrower by that. Beside a sum of Gaussians the picture errs by what pairs and tabulated widths and places leave: the tests
//! hold it below 2 % (root mean square), and a single splat within 6.5 % of its peak.

use bytemuck::{Pod, Zeroable, cast};
use wide::{f32x4, f32x8, i32x8};

use super::points::{Eight, LANES, Points};
use super::sheet::Falls;
use super::splat::{LEAST_SIGMA, MOST_SIGMA, Picture, REACH};

/// Layers: in the coarsest, with pixels of 2⁵, the widest splat has a standard deviation of 1.25 pixels.
const LAYERS: usize = 6;
/// Pixels around a layer: room for a splat whose middle is outside. Even, as pixels lie in pairs.
const MARGIN: usize = 16;
/// Most pixels along a side of a splat: twice 3 standard deviations of 2 pixels.
const WIDTH: usize = 12;
/// Tabulated Gaussians: standard deviations from 0.5 to 2 pixels in steps of 1/40, and places within a pixel.
const WIDTHS: usize = 60;
const WIDTHS_PER_PIXEL: f32 = 40.0;
const PLACES: usize = 32;

/// Two points whose distance squared is less than this share of their variance are added as one, if their variances differ by less than the other
/// share: seen along a streak, its far and its near end fall on one pixel.
const NEAR: f32 = 0.6;
const ALIKE: f32 = 0.3;

/// Shares of a side in the table: those of the pixels from the one before a splat to those behind it, which have none, so that pairs may begin
/// at either.
const SIDE: usize = WIDTH + 4;

/// Each pixel's share of a splat along one side, by width and place; the shares' sum is 1, so that no light is lost.
#[derive(Clone, Debug)]
pub struct Shares(Vec<f32>);

impl Default for Shares {
    fn default() -> Self {
        let mut shares = Vec::with_capacity((WIDTHS + 1) * (PLACES + 1) * SIDE);
        for row in 0..=WIDTHS {
            let sigma = f32x8::splat(row as f32 / WIDTHS_PER_PIXEL + 0.5);
            let half = halves(sigma).as_array()[0];
            let sigma = sigma.as_array()[0];
            for place in 0..=PLACES {
                let side: [f32; SIDE] = std::array::from_fn(|k| {
                    let d = place as f32 / PLACES as f32 + k as f32 - 1.0 - half;
                    if (1..=2 * half as usize).contains(&k) { (-0.5 * (d / sigma).powi(2)).exp() } else { 0.0 }
                });
                let sum: f32 = side.iter().sum();
                shares.extend(side.map(|share| share / sum));
            }
        }
        Shares(shares)
    }
}

/// Half the pixels that splats of tabulated standard deviations cover. The widths come in steps of 3/40 pixel, so less than a step below 1 is
/// enough to round up.
#[inline(always)]
fn halves(sigma: f32x8) -> f32x8 {
    truncated(sigma * f32x8::splat(REACH) + f32x8::splat(0.99)).1
}

/// Cut to whole numbers, as such and as floats; the least number for what is none.
#[inline(always)]
fn truncated(numbers: f32x8) -> (i32x8, f32x8) {
    let whole = numbers.fast_trunc_int();
    (whole, f32x8::from_i32x8(whole))
}

/// Two pixels of four lines each: what a processor adds at once. Splats begin at whole pairs, since a pair that straddles two of the splat
/// before would wait for both to be stored.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C, align(32))]
struct Pair([f32; 2 * 4]);

/// The whole pairs among numbers.
fn pairs_of(numbers: &mut [f32]) -> &mut [Pair] {
    bytemuck::pod_align_to_mut(numbers).1
}

/// The pixels among numbers, row by row.
fn pixels_of(numbers: &mut [f32]) -> &mut [f32x4] {
    bytemuck::cast_slice_mut(pairs_of(numbers))
}

/// The layers of a picture, each with a margin.
#[derive(Debug)]
pub struct Pyramid {
    size: [usize; 2],
    /// Pixels from one row to the next, in all layers; even.
    stride: usize,
    /// Pairs, once aligned; a layer is empty before light falls on it.
    layers: [Vec<f32>; LAYERS],
}

/// Adds light in rows with the shares `lines`, from pair `start` on, and in each to `PAIRS` pairs with the shares `columns`; from one row to the
/// next there are `stride` pairs.
#[inline(always)]
fn add_plain<const PAIRS: usize>(pixels: &mut [Pair], [start, stride]: [usize; 2], columns: &[f32], lines: &[f32], light: f32x4) {
    let mut row = [[f32x4::ZERO; 2]; PAIRS];
    for (pair, columns) in row.iter_mut().zip(columns.chunks_exact(2)) {
        *pair = [light * f32x4::splat(columns[0]), light * f32x4::splat(columns[1])];
    }
    let pixels: &mut [[f32x4; 2]] = bytemuck::cast_slice_mut(pixels);
    for (k, share) in lines.iter().enumerate() {
        let share = f32x4::splat(*share);
        for (pixel, light) in pixels[start + k * stride..][..PAIRS].iter_mut().zip(&row) {
            pixel[0] += light[0] * share;
            pixel[1] += light[1] * share;
        }
    }
}

/// The same, two pixels at once.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
#[inline]
fn add_wide<const PAIRS: usize>(pixels: &mut [Pair], [start, stride]: [usize; 2], columns: &[f32], lines: &[f32], light: f32x4) {
    use std::arch::x86_64::{__m256, _mm_set1_ps, _mm256_add_ps, _mm256_mul_ps, _mm256_set_m128, _mm256_set1_ps, _mm256_setzero_ps};
    let light = _mm256_set_m128(cast(light), cast(light));
    let mut row = [_mm256_setzero_ps(); PAIRS];
    for (k, pair) in row.iter_mut().enumerate() {
        *pair = _mm256_mul_ps(light, _mm256_set_m128(_mm_set1_ps(columns[2 * k + 1]), _mm_set1_ps(columns[2 * k])));
    }
    let pixels: &mut [__m256] = bytemuck::cast_slice_mut(pixels);
    for (k, share) in lines.iter().enumerate() {
        let share = _mm256_set1_ps(*share);
        let pixels = &mut pixels[start + k * stride..][..PAIRS];
        for (pixel, light) in pixels.iter_mut().zip(&row) {
            *pixel = _mm256_add_ps(*pixel, _mm256_mul_ps(*light, share));
        }
    }
}

/// The light of each line of `collisions` at a level.
#[inline(always)]
fn light(falls: &Falls, level: u32, collisions: f32) -> f32x4 {
    f32x4::new(falls.light[level as usize]) * f32x4::splat(collisions)
}

/// Where splats are added. No closure: one is not always compiled into [`add_avx`], and then it lacks its instructions.
struct Target<'a> {
    layers: &'a mut [Vec<f32>; LAYERS],
    /// Pairs from one row to the next.
    stride: usize,
    /// Rows of the picture.
    height: usize,
    shares: &'a [f32],
}

impl Target<'_> {
    /// Adds the `k`-th of eight splats. `AVX` may be said only where the processor has AVX2.
    #[inline(always)]
    fn add<const AVX: bool>(&mut self, splats: &Splats, k: usize, light: f32x4) {
        let number = splats.layer[k] as usize;
        let layer = &mut self.layers[number];
        if layer.is_empty() {
            *layer = black(self.stride, rows(self.height, number));
        }
        let pixels = pairs_of(layer);
        let start = [splats.pair[k] as usize, self.stride];
        let (columns, lines) = (&self.shares[splats.columns[k] as usize..], &self.shares[splats.lines[k] as usize..]);
        // A known width lets the compiler write the loop out.
        macro_rules! add {
            ($half:literal) => {{
                let (columns, lines) = (&columns[..2 * $half + 2], &lines[..2 * $half]);
                #[cfg(target_arch = "x86_64")]
                if AVX {
                    #[allow(unsafe_code)]
                    // SAFETY: the caller says that the processor has AVX2.
                    return unsafe { add_wide::<{ $half + 1 }>(pixels, start, columns, lines, light) };
                }
                add_plain::<{ $half + 1 }>(pixels, start, columns, lines, light)
            }};
        }
        match splats.half[k] {
            0..=2 => add!(2),
            3 => add!(3),
            4 => add!(4),
            5 => add!(5),
            _ => add!(6),
        }
    }
}

/// Rows of a layer of a picture of `height` pixels.
fn rows(height: usize, layer: usize) -> usize {
    height.div_ceil(1 << layer) + 2 * MARGIN
}

/// Numbers for `rows` rows of `stride` pairs, and room to align them.
#[cold]
fn black(stride: usize, rows: usize) -> Vec<f32> {
    vec![0.0; size_of::<Pair>() / size_of::<f32>() * (stride * rows + 1)]
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn add_avx(pyramid: &mut Pyramid, points: &Points, falls: &Falls, radius: f32, shares: &Shares) {
    pyramid.add_all::<true>(points, falls, radius, shares);
}

impl Pyramid {
    /// For pictures of a size; black.
    pub fn new(size: [usize; 2]) -> Self {
        let stride = (size[0] + 2 * MARGIN).next_multiple_of(2);
        Pyramid { size, stride, layers: Default::default() }
    }

    /// Adds points with blobs of standard deviation `radius` km.
    pub fn add(&mut self, points: &Points, falls: &Falls, radius: f32, shares: &Shares) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            #[allow(unsafe_code)]
            // SAFETY: the instructions were detected.
            return unsafe { add_avx(self, points, falls, radius, shares) };
        }
        self.add_plainly(points, falls, radius, shares);
    }

    /// The same without instructions that only some processors have: the same bits.
    pub fn add_plainly(&mut self, points: &Points, falls: &Falls, radius: f32, shares: &Shares) {
        self.add_all::<false>(points, falls, radius, shares);
    }

    /// `AVX` may be said only where the processor has AVX2.
    #[inline(always)]
    fn add_all<const AVX: bool>(&mut self, points: &Points, falls: &Falls, radius: f32, shares: &Shares) {
        let mut target = Target { layers: &mut self.layers, stride: self.stride / 2, height: self.size[1], shares: &shares.0 };
        for first in (0..points.len()).step_by(2 * LANES) {
            let pairs = points.pairs(first);
            let blobs = Blobs::of(&pairs, radius);
            // One loop for both, as what is called in one place alone is compiled into it.
            for (n, blobs) in blobs.iter().enumerate() {
                // Where all pairs are near, there are no second blobs.
                if blobs.weight == f32x8::ZERO {
                    continue;
                }
                let splats = Splats::of(blobs, self.size, self.stride);
                for k in 0..LANES {
                    if splats.inside[k] != 0 {
                        let other = light(falls, pairs[1].level[k], splats.other[k]);
                        target.add::<AVX>(&splats, k, light(falls, pairs[n].level[k], splats.weight[k]) + other);
                    }
                }
            }
        }
    }

    /// Adds another of the same size.
    pub fn merge(&mut self, other: Pyramid) {
        for (layer, mut more) in self.layers.iter_mut().zip(other.layers) {
            if layer.is_empty() {
                *layer = more;
            } else {
                pixels_of(layer).iter_mut().zip(pixels_of(&mut more)).for_each(|(pixel, more)| *pixel += *more);
            }
        }
    }

    /// The picture: each layer enlarged and added to the next finer one.
    pub fn picture(mut self) -> Picture {
        let mut column = Vec::new();
        let stride = self.stride;
        for k in (0..LAYERS).rev() {
            // The finest layer is there even if nothing was added.
            let (finer, coarser) = self.layers.split_at_mut(k);
            if coarser[0].is_empty() {
                if k == 0 {
                    coarser[0] = black(stride / 2, rows(self.size[1], 0));
                }
                continue;
            }
            let Some(fine) = finer.last_mut() else { continue };
            if fine.is_empty() {
                *fine = black(stride / 2, rows(self.size[1], k - 1));
            }
            let (fine, coarse) = (pixels_of(fine), pixels_of(&mut coarser[0]));
            let between = |a: f32x4, b: f32x4| a * f32x4::splat(0.75) + b * f32x4::splat(0.25);
            // Of the margin, one pixel is enough: no finer layer asks for more.
            let [width, height] = self.size.map(|side| side.div_ceil(1 << (k - 1)));
            for y in 0..height + 2 {
                // Fine pixel y − 1 without margin: its own coarse pixel, and the neighbour on its side.
                let (own, beside) = neighbours(y);
                let row = |y: usize| &coarse[y * stride..y * stride + width / 2 + 2 * MARGIN];
                column.clear();
                column.extend(row(own).iter().zip(row(beside)).map(|(a, b)| between(*a, *b)));
                let start = (y + MARGIN - 1) * stride + MARGIN - 1;
                for (x, pixel) in fine[start..start + width + 2].iter_mut().enumerate() {
                    let (own, beside) = neighbours(x);
                    *pixel += between(column[own], column[beside]);
                }
            }
        }
        let size = self.size;
        let mut pixels = Vec::with_capacity(size[0] * size[1]);
        for row in pixels_of(&mut self.layers[0]).chunks_exact(stride).skip(MARGIN).take(size[1]) {
            pixels.extend_from_slice(bytemuck::cast_slice(&row[MARGIN..MARGIN + size[0]]));
        }
        Picture { size, pixels }
    }
}

/// Eight blobs of light on the screen.
#[derive(Clone, Copy)]
struct Blobs {
    x: f32x8,
    y: f32x8,
    variance: f32x8,
    /// Collisions times the square of the scale; 0 for no blob.
    weight: f32x8,
    /// The same of a second point that lies in the blob, whose light has a height of its own.
    other: f32x8,
}

impl Blobs {
    /// Of pairs of points with a standard deviation of `radius` km. Both points of a pair that are near to each other become one blob, the first;
    /// else the second blob is the second point.
    #[inline(always)]
    fn of(pairs: &[Eight; 2], radius: f32) -> [Blobs; 2] {
        let all = f32x8::splat;
        let [a, b] = [&pairs[0], &pairs[1]].map(|points| {
            let [x, y, scale, count] = [points.x, points.y, points.scale, points.count].map(f32x8::new);
            let sigma = (scale * all(radius)).fast_max(all(LEAST_SIGMA)).fast_min(all(MOST_SIGMA));
            Blobs { x, y, variance: sigma * sigma, weight: count * scale * scale, other: f32x8::ZERO }
        });
        let (dx, dy, sum) = (b.x - a.x, b.y - a.y, a.weight + b.weight);
        let apart = dx * dx + dy * dy;
        let unlike = (b.variance - a.variance).abs();
        // A pair without light has no middle.
        let near = apart.simd_lt(a.variance * all(NEAR)) & unlike.simd_lt(a.variance * all(ALIKE)) & sum.simd_gt(all(0.0));
        let share = b.weight / sum;
        // Two points are wider along their line than across it; what is missing is given to both sides in halves.
        let spread = all(0.5) * share * (all(1.0) - share) * apart;
        let middle = Blobs {
            x: a.x + share * dx,
            y: a.y + share * dy,
            variance: a.variance + share * (b.variance - a.variance) + spread,
            weight: a.weight,
            other: b.weight,
        };
        let choose = |one: f32x8, other: f32x8| near.select(one, other);
        let first = Blobs {
            x: choose(middle.x, a.x),
            y: choose(middle.y, a.y),
            variance: choose(middle.variance, a.variance),
            weight: a.weight,
            other: choose(middle.other, f32x8::ZERO),
        };
        [first, Blobs { weight: choose(f32x8::ZERO, b.weight), ..b }]
    }
}

/// Where eight splats go.
struct Splats {
    /// All bits set, or none for a splat that is outside, has no light or is of something that is not a number; then what else is said of it
    /// has no meaning.
    inside: [i32; LANES],
    layer: [i32; LANES],
    /// Half the pixels that it covers.
    half: [i32; LANES],
    /// Its first pair in the layer.
    pair: [i32; LANES],
    /// Where its shares start in the table.
    columns: [i32; LANES],
    lines: [i32; LANES],
    /// What the light of a collision is multiplied by, for both points of the blob.
    weight: [f32; LANES],
    other: [f32; LANES],
}

impl Splats {
    /// Of blobs in a picture. Lane by lane without a branch: taken one after the other, each would wait for its root and its conversions, which
    /// took longer than to add it.
    #[inline(always)]
    fn of(blobs: &Blobs, size: [usize; 2], stride: usize) -> Splats {
        let all = f32x8::splat;
        let variance = blobs.variance;
        // Layer l has the variances from 4ˡ to 4ˡ⁺¹: half the number's exponent says which. A least standard deviation of 0.75 instead of 1 of
        // its pixels would show them (13 % of the peak instead of 6 % at the worst place); more would cost more.
        let exponent = (cast::<f32x8, i32x8>(variance) >> 23u32) - i32x8::splat(127);
        let layer = (exponent >> 1u32).max(i32x8::splat(0)).min(i32x8::splat(LAYERS as i32 - 1));
        // 2⁻ˡ: a float of which only the exponent is set.
        let shrink: f32x8 = cast((i32x8::splat(127) - layer) << 23u32);
        let part = shrink * shrink;
        // Pixels of the layer, narrower by what enlarging adds.
        let own = (variance * part - all(0.25) * (all(1.0) - part)).fast_max(all(0.0)).sqrt();
        let (row, width) = truncated((own - all(0.5)).fast_max(all(0.0)).fast_min(all(1.5)) * all(WIDTHS_PER_PIXEL) + all(0.5));
        let half = halves(width * all(1.0 / WIDTHS_PER_PIXEL) + all(0.5));
        // The pixels whose middles are within reach start after this.
        let edge = |centre: f32x8| centre * shrink + (all(MARGIN as f32 - 0.5) - half);
        let start = row * i32x8::splat(((PLACES + 1) * SIDE) as i32) + i32x8::splat(1);
        // The first pixel, where the table has its share, and whether the splat is within the margin. The first pixel of what is not a number
        // is the least number.
        let place = |edge: f32x8, side: usize| {
            let (first, float) = truncated(edge + all(1.0));
            let within = (float - edge).fast_max(all(0.0)).fast_min(all(1.0));
            let shares = start + truncated(within * all(PLACES as f32) + all(0.5)).0 * i32x8::splat(SIDE as i32);
            let end = float + half + half;
            let inside = float.simd_ge(all(1.0)) & end.simd_lt(all(side as f32) * shrink + all(2.0 * MARGIN as f32));
            (first, shares, inside)
        };
        let ((left, columns, within), (top, lines, below)) = (place(edge(blobs.x), size[0]), place(edge(blobs.y), size[1]));
        let light = blobs.weight + blobs.other;
        // Pairs begin at even pixels: from an odd one on, with the share of nothing that lies before the first.
        let odd = left & i32x8::splat(1);
        Splats {
            // Greater than nothing and less than infinite.
            inside: cast(within & below & light.simd_gt(all(0.0)) & light.simd_lt(all(f32::INFINITY))),
            layer: layer.to_array(),
            half: half.fast_trunc_int().to_array(),
            pair: (top * i32x8::splat(stride as i32 / 2) + (left >> 1u32)).to_array(),
            columns: (columns - odd).to_array(),
            lines: lines.to_array(),
            weight: (blobs.weight * part).to_array(),
            other: (blobs.other * part).to_array(),
        }
    }
}

/// The coarse pixel that fine pixel `k` − 1 lies in, and the next nearest one, both counted from the margin's edge.
fn neighbours(k: usize) -> (usize, usize) {
    let own = k.div_ceil(2) + MARGIN - 1;
    // An even k is an odd fine pixel, which leans to the right.
    (own, if k.is_multiple_of(2) { own + 1 } else { own - 1 })
}
