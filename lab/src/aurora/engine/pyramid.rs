//! Splats at a cost that does not grow with their size: a wide one is added where pixels are as wide as it is, in a picture of half, a
//! quarter, … the size, and these pictures are enlarged and summed at the end. Two points of a streak that are nearer to each other than
//! their own width are added as one.
//!
//! A pixel is enlarged by the shares 1, 5, 10, 10, 5, 1 of sixteen along each side (those of a spline of the fourth degree, beside which
//! pixels of a layer are hardly seen), which adds a variance of 5/4 fine pixels², or 5/12 (1 − 4⁻ᵏ) pixels² of layer k after k times; the
//! Gaussian that is added to the layer is narrower by that, and its pixels are those that come nearest to it when they are enlarged
//! ([`super::shares`]). Beside a sum of Gaussians the picture errs by what pairs and tabulated widths and places leave: the tests hold it
//! below 2 % (root mean square), and a single splat within 6.8 % of its peak at 2,400 widths and places (10 % was found between two
//! tabulated widths about half a pixel, 7.6 % elsewhere).

use super::shares::ADDED;
use bytemuck::cast;
use std::ops::Range;
use wide::f32x4;

#[cfg(target_arch = "x86_64")]
use super::collisions::ORDERS;
use super::layers::{LAYERS, Layer, MARGIN, Pair, TILE, across, sum};
use super::points::{Eight, LANES, Points, greater, lesser};
use super::shares::{FINEST, MIDDLE, PLACES, SHARES, SIDE, Shares, WIDTHS, WIDTHS_PER_PIXEL, half_of, integer, nearest};
use super::splat::{LEAST_SIGMA, MOST_SIGMA, Picture};
use crate::aurora::sheet::Falls;

/// One over the least variance of the splats of a layer, pixels of it squared: narrower ones cannot be told by the humps that its pixels
/// become to some 6 % of their peak.
const FINENESS: f32 = 1.0 / (0.85 * 0.85);
/// From this variance on a splat goes to the first coarser layer, whose pixels are enlarged but once and tell narrower ones: its standard
/// deviation is 0.8 of them.
const FIRST_COARSE: f32 = 4.0 * 0.8 * 0.8;
/// Two points become one splat if their distance squared is less than the first share of their variance, the product of its two sides (what
/// the splat lacks, as it is drawn out along rows and columns alone) less than the second, and their variances differ by less than the
/// third: seen along a streak, its far and its near end fall on one pixel.
const NEAR: f32 = 2.1;
const ASLANT: f32 = 0.4;
const ALIKE: f32 = 0.6;
/// Times eight splats whose places are found before the first of them is added: taken in turns, eight would wait for their roots while a
/// processor's room for instructions to come is full of the additions of the eight before.
const BATCH: usize = 8;

/// The layers of a picture, each with a margin.
#[derive(Debug)]
pub struct Pyramid {
    size: [usize; 2],
    layers: [Layer; LAYERS],
}

/// Adds light in rows with the shares `lines`, from pair `start` on, and in each to `PAIRS` pairs with the shares `columns`; from one row
/// to the next there are `stride` pairs.
#[inline(always)]
fn add_plain<const PAIRS: usize>(pixels: &mut [Pair], [start, stride]: [u32; 2], columns: &[f32], lines: &[f32], light: f32x4) {
    let [start, stride] = [start as usize, stride as usize];
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
fn add_wide<const PAIRS: usize>(pixels: &mut [Pair], [start, stride]: [u32; 2], columns: &[f32], lines: &[f32], light: f32x4) {
    use std::arch::x86_64::*;
    let light = _mm256_set_m128(cast(light), cast(light));
    // The first of two numbers four times, and the second four times.
    let (one, other) = (0, 1);
    let order = _mm256_setr_epi32(one, one, one, one, other, other, other, other);
    let mut row = [_mm256_setzero_ps(); PAIRS];
    for (k, pair) in row.iter_mut().enumerate() {
        let two = _mm256_castpd_ps(_mm256_set1_pd(cast([columns[2 * k], columns[2 * k + 1]])));
        *pair = _mm256_mul_ps(light, _mm256_permutevar_ps(two, order));
    }
    // Asked once and not for every row. Both numbers are below 2³², so that this does not overflow.
    let rows = (lines.len() as u64 - 1) * stride as u64 + PAIRS as u64;
    assert!(start as u64 + rows <= pixels.len() as u64);
    let [start, stride] = [start as usize, stride as usize];
    for (k, share) in lines.iter().enumerate() {
        let share = _mm256_set1_ps(*share);
        for (n, light) in row.iter().enumerate() {
            #[allow(unsafe_code)]
            // SAFETY: the last pair of the last row is within, as was asserted, and pairs are aligned as the processor asks for.
            unsafe {
                let pixel = pixels.as_mut_ptr().add(start + k * stride + n).cast::<f32>();
                _mm256_store_ps(pixel, _mm256_add_ps(_mm256_load_ps(pixel), _mm256_mul_ps(*light, share)));
            }
        }
    }
}

/// The light of each line of `collisions` at a level.
#[inline(always)]
fn light(falls: &Falls, level: u32, collisions: f32) -> f32x4 {
    f32x4::new(falls.light[level as usize]) * f32x4::splat(collisions)
}

/// The shares of a side, from one of them on.
#[inline(always)]
fn side_of(shares: &[f32; SHARES], start: i32) -> &[f32] {
    let start = start as u32 as usize;
    &shares[start..start + SIDE]
}

/// Where splats are added. No closure: one is not always compiled into [`add_avx`], and then it lacks its instructions.
struct Target<'a> {
    layers: &'a mut [Layer; LAYERS],
    shares: &'a [f32; SHARES],
}

impl Target<'_> {
    /// Adds the `k`-th of eight splats. `AVX` as for [`Pyramid::add_all`].
    #[inline(always)]
    fn add<const AVX: bool>(&mut self, splats: &Splats, k: usize, light: f32x4) {
        let layer = &mut self.layers[splats.layer[k] as usize];
        let tile = splats.tile[k] as usize;
        if !layer.ready[tile] {
            layer.make_ready(tile);
        }
        let start = [splats.pair[k] as u32, layer.stride() as u32];
        let pixels = &mut layer.pairs[..];
        let (columns, lines) = (side_of(self.shares, splats.columns[k]), side_of(self.shares, splats.lines[k]));
        // A known width lets the compiler write the loop out.
        macro_rules! add {
            ($half:literal) => {{
                let (columns, lines) = (&columns[..2 * $half + 2], &lines[..2 * $half + 1]);
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
            0..=1 => add!(1),
            2 => add!(2),
            3 => add!(3),
            4 => add!(4),
            5 => add!(5),
            _ => add!(6),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,popcnt")]
fn add_avx(pyramid: &mut Pyramid, points: &Points, falls: &Falls, radius: f32, shares: &Shares) {
    pyramid.add_all::<true>(points, falls, radius, shares);
}

impl Pyramid {
    /// For pictures of a size; black.
    pub fn new(size: [usize; 2]) -> Self {
        Pyramid { size, layers: std::array::from_fn(|number| Layer::new(size, number)) }
    }

    /// Width and height of the picture, pixels.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Black again, with the memory that it has.
    pub fn wipe(&mut self) {
        self.layers.iter_mut().for_each(Layer::wipe);
    }

    /// Adds points with blobs of standard deviation `radius` km.
    pub fn add(&mut self, points: &Points, falls: &Falls, radius: f32, shares: &Shares) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("popcnt") {
            #[allow(unsafe_code)]
            // SAFETY: the instructions were detected.
            return unsafe { add_avx(self, points, falls, radius, shares) };
        }
        self.add_plainly(points, falls, radius, shares);
    }

    /// The same without instructions that only some processors have: the same picture, bit for bit.
    pub fn add_plainly(&mut self, points: &Points, falls: &Falls, radius: f32, shares: &Shares) {
        self.add_all::<false>(points, falls, radius, shares);
    }

    /// `AVX` may be said only where the processor has AVX2 and counts bits.
    #[inline(always)]
    fn add_all<const AVX: bool>(&mut self, points: &Points, falls: &Falls, radius: f32, shares: &Shares) {
        // There are always that many; said here, a side is looked for once and not at both of its ends.
        let Some(shares) = shares.0.first_chunk() else { return };
        let mut target = Target { layers: &mut self.layers, shares };
        let mut lone = Lone::default();
        let mut first = 0;
        let mut batch: [Splats; BATCH] = Default::default();
        loop {
            let mut length = 0;
            // One loop for pairs and for lone points, as what is called in one place alone is compiled into it.
            while length < BATCH {
                let blobs = if lone.length >= LANES || (first >= points.len() && lone.length > 0) {
                    lone.take()
                } else if first < points.len() {
                    first += 2 * LANES;
                    Blobs::of::<AVX>(&points.pairs(first - 2 * LANES), radius, &mut lone)
                } else {
                    break;
                };
                Splats::of(&blobs, self.size, &mut batch[length]);
                length += 1;
            }
            if length == 0 {
                break;
            }
            for splats in &batch[..length] {
                let mut left = splats.inside;
                while left != 0 {
                    let k = left.trailing_zeros() as usize % LANES;
                    left &= left - 1;
                    let other = light(falls, splats.other_level[k], splats.other[k]);
                    target.add::<AVX>(splats, k, light(falls, splats.level[k], splats.weight[k]) + other);
                }
            }
        }
    }

    /// The picture.
    pub fn picture(&self) -> Picture {
        let mut picture = Picture::new(self.size);
        Pyramid::sum(&[self], 0..self.size[1], &mut picture.pixels);
        picture
    }

    /// Some rows of the picture that pyramids of one size make together: each layer enlarged and added to the next finer one. `out` has the
    /// rows' pixels.
    pub fn sum(pyramids: &[&Pyramid], rows: Range<usize>, out: &mut [[f32; 4]]) {
        let layers: Vec<&[Layer; LAYERS]> = pyramids.iter().map(|pyramid| &pyramid.layers).collect();
        if let Some(first) = pyramids.first() {
            sum(&layers, first.size, rows, out);
        }
    }
}

/// Eight blobs of light on the screen.
#[derive(Clone, Copy, Default)]
struct Blobs {
    x: [f32; LANES],
    y: [f32; LANES],
    /// Variance along rows and along columns.
    wide: [f32; LANES],
    tall: [f32; LANES],
    /// Collisions times the square of the scale, and their level of height; 0 for no blob.
    weight: [f32; LANES],
    level: [u32; LANES],
    /// The same of a second point that lies in the blob.
    other: [f32; LANES],
    other_level: [u32; LANES],
}

impl Blobs {
    /// Of pairs of points with a standard deviation of `radius` km. Both points of a pair that are near to each other become one blob; else
    /// the second is put to the `lone` ones.
    // One loop without branches or closures, so that the compiler takes eight lanes together, with whatever instructions there are. `AVX`
    // as for `Pyramid::add_all`.
    #[inline(always)]
    fn of<const AVX: bool>([a, b]: &[Eight; 2], radius: f32, lone: &mut Lone) -> Blobs {
        let mut blobs = Blobs { level: a.level, other_level: b.level, ..Blobs::default() };
        let (mut variances, mut weights) = ([0.0; LANES], [0.0; LANES]);
        for k in 0..LANES {
            let sigma = lesser(greater(a.scale[k] * radius, LEAST_SIGMA), MOST_SIGMA);
            let variance = sigma * sigma;
            let sigma = lesser(greater(b.scale[k] * radius, LEAST_SIGMA), MOST_SIGMA);
            let second_variance = sigma * sigma;
            let (weight, second_weight) = (a.count[k] * a.scale[k] * a.scale[k], b.count[k] * b.scale[k] * b.scale[k]);
            let (dx, dy, sum) = (b.x[k] - a.x[k], b.y[k] - a.y[k], weight + second_weight);
            let (xx, yy) = (dx * dx, dy * dy);
            // A pair without light has no middle.
            let near = (xx + yy < variance * NEAR)
                & ((dx * dy).abs() < variance * ASLANT)
                & ((second_variance - variance).abs() < variance * ALIKE)
                & (sum > 0.0);
            let share = if near { second_weight / sum } else { 0.0 };
            // Two points are wider along their line than either.
            let spread = share * (1.0 - share);
            let mean = variance + share * (second_variance - variance);
            blobs.x[k] = if near { a.x[k] + share * dx } else { a.x[k] };
            blobs.y[k] = if near { a.y[k] + share * dy } else { a.y[k] };
            blobs.wide[k] = if near { mean + spread * xx } else { variance };
            blobs.tall[k] = if near { mean + spread * yy } else { variance };
            blobs.weight[k] = weight;
            blobs.other[k] = if near { second_weight } else { 0.0 };
            variances[k] = second_variance;
            weights[k] = if near { 0.0 } else { second_weight };
        }
        #[cfg(target_arch = "x86_64")]
        if AVX {
            #[allow(unsafe_code)]
            // SAFETY: the caller says that the processor has AVX2 and counts bits.
            unsafe {
                lone.put_avx(b, &variances, &weights)
            };
            return blobs;
        }
        for k in 0..LANES {
            lone.put(b.x[k], b.y[k], variances[k], weights[k], b.level[k]);
        }
        blobs
    }
}

/// Points that are a blob each, until there are eight.
#[derive(Default)]
struct Lone {
    length: usize,
    x: [f32; 2 * LANES],
    y: [f32; 2 * LANES],
    variance: [f32; 2 * LANES],
    weight: [f32; 2 * LANES],
    level: [u32; 2 * LANES],
}

impl Lone {
    /// Puts a point behind the last, unless it has no light. There must be less than sixteen.
    #[inline(always)]
    fn put(&mut self, x: f32, y: f32, variance: f32, weight: f32, level: u32) {
        // Written in any case, and written over by the next if there was none: which have light cannot be foretold.
        let k = self.length % (2 * LANES);
        (self.x[k], self.y[k], self.variance[k], self.weight[k], self.level[k]) = (x, y, variance, weight, level);
        self.length += usize::from(weight != 0.0);
    }

    /// The same for eight at once: forty numbers written one by one kept the next eight waiting.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,popcnt")]
    #[inline]
    fn put_avx(&mut self, points: &Eight, variances: &[f32; LANES], weights: &[f32; LANES]) {
        use std::arch::x86_64::*;
        let found = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_NEQ_UQ>(cast(*weights), _mm256_setzero_ps()));
        let order: __m256i = cast(ORDERS[found as usize & 255]);
        // There are less than eight: those were taken.
        let at = self.length.min(LANES);
        let columns = [(&mut self.x, &points.x), (&mut self.y, &points.y), (&mut self.variance, variances), (&mut self.weight, weights)];
        for (column, numbers) in columns {
            let ordered = _mm256_permutevar8x32_ps(cast(*numbers), order);
            column[at..at + LANES].copy_from_slice(&cast::<__m256, [f32; LANES]>(ordered));
        }
        let ordered = _mm256_permutevar8x32_epi32(cast(points.level), order);
        self.level[at..at + LANES].copy_from_slice(&cast::<__m256i, [u32; LANES]>(ordered));
        self.length += found.count_ones() as usize;
    }

    /// Takes the first eight, or those that there are.
    #[inline(always)]
    fn take(&mut self) -> Blobs {
        let mut blobs = Blobs::default();
        for k in 0..LANES {
            let weight = if k < self.length { self.weight[k] } else { 0.0 };
            (blobs.x[k], blobs.y[k], blobs.weight[k], blobs.level[k]) = (self.x[k], self.y[k], weight, self.level[k]);
            (blobs.wide[k], blobs.tall[k]) = (self.variance[k], self.variance[k]);
            let next = k + LANES;
            (self.x[k], self.y[k], self.variance[k]) = (self.x[next], self.y[next], self.variance[next]);
            (self.weight[k], self.level[k]) = (self.weight[next], self.level[next]);
        }
        self.length = self.length.saturating_sub(LANES);
        blobs
    }
}

/// Where eight splats go.
#[derive(Default)]
struct Splats {
    /// 1 for each, 0 for a splat that is outside, has no light or is of something that is not a number; then what else is said of it has
    /// no meaning.
    seen: [u32; LANES],
    /// The same as bits.
    inside: u32,
    layer: [i32; LANES],
    /// Pixels that it covers on each side of the one in its middle.
    half: [i32; LANES],
    /// The pair in the layer in which it begins, and the tile in which that is.
    pair: [i32; LANES],
    tile: [i32; LANES],
    /// Where its shares start in the table.
    columns: [i32; LANES],
    lines: [i32; LANES],
    /// What the light of a collision is multiplied by, for both points of the blob.
    weight: [f32; LANES],
    other: [f32; LANES],
    /// The levels of height of both.
    level: [u32; LANES],
    other_level: [u32; LANES],
}

/// One side of a splat: pixels on each side of its middle one, the middle one's number, and the middle of its shares in the table.
#[inline(always)]
fn side(variance: f32, shrink: f32, centre: f32) -> (f32, f32, f32) {
    // Pixels of the layer, narrower by what enlarging adds.
    let part = shrink * shrink;
    let own = greater(variance * part - ADDED * (1.0 - part), 0.0).sqrt();
    let row = nearest(lesser(greater((own - 0.5) * WIDTHS_PER_PIXEL, 0.0), WIDTHS as f32));
    // The pixel that the middle is in, and where in it.
    let at = centre * shrink + (MARGIN as f32 - 0.5);
    let pixel = nearest(at);
    let place = nearest((lesser(greater(at - pixel, -0.5), 0.5) + 0.5) * PLACES as f32);
    let enlarged = shrink < 1.0;
    let first = if enlarged { (FINEST + MIDDLE) as f32 } else { MIDDLE as f32 };
    let shares = row * ((PLACES + 1) * SIDE) as f32 + place * SIDE as f32 + first;
    (half_of(row * (1.0 / WIDTHS_PER_PIXEL) + 0.5, enlarged), pixel, shares)
}

impl Splats {
    /// Of blobs in a picture. Lane by lane without a branch: taken one after the other, each would wait for its root and its conversions,
    /// which took longer than to add it.
    #[inline(always)]
    fn of(blobs: &Blobs, size: [usize; 2], splats: &mut Splats) {
        splats.inside = 0;
        splats.level = blobs.level;
        splats.other_level = blobs.other_level;
        for k in 0..LANES {
            // Layer l has the variances from 4ˡ to 4ˡ⁺¹ times the least: half the number's exponent says which.
            let least = lesser(blobs.wide[k], blobs.tall[k]);
            let exponent = ((least * FINENESS).to_bits() >> 23) as i32 - 127;
            let layer = (exponent >> 1).max(i32::from(least >= FIRST_COARSE)).min(LAYERS as i32 - 1);
            // 2⁻ˡ: a float of which only the exponent is set.
            let shrink = f32::from_bits(((127 - layer) as u32) << 23);
            let (half, column, columns) = side(blobs.wide[k], shrink, blobs.x[k]);
            let (rows, row, lines) = side(blobs.tall[k], shrink, blobs.y[k]);
            let half = greater(half, rows);
            // Within the margin.
            let end = |length: usize| length as f32 * shrink + 2.0 * MARGIN as f32;
            let within =
                (column - half >= 1.0) & (column + half + 1.0 < end(size[0])) & (row - half >= 1.0) & (row + half + 1.0 < end(size[1]));
            let light = blobs.weight[k] + blobs.other[k];
            // Greater than nothing and less than infinite.
            splats.seen[k] = u32::from(within & (light > 0.0) & (light < f32::INFINITY));
            // Pairs begin at even pixels: from an odd one on, with the share of the pixel before it.
            let (left, top) = (integer(column - half), integer(row - half));
            splats.columns[k] = integer(columns - half).wrapping_sub(left & 1);
            splats.lines[k] = integer(lines - half);
            let across = across(size[0] as i32, layer);
            splats.pair[k] = top.wrapping_mul(across << (TILE - 1)).wrapping_add(left >> 1);
            splats.tile[k] = (top >> TILE).wrapping_mul(across).wrapping_add(left >> TILE);
            splats.layer[k] = layer;
            splats.half[k] = integer(half);
            splats.weight[k] = blobs.weight[k] * (shrink * shrink);
            splats.other[k] = blobs.other[k] * (shrink * shrink);
        }
        for k in 0..LANES {
            splats.inside |= splats.seen[k] << k;
        }
    }
}
