//! Splats at a cost that does not grow with their size: a wide one is added where pixels are as wide as it is, in a picture of half, a quarter, …
//! the size, and these pictures are enlarged and summed at the end. Points of a streak that fall within a fraction of their own width are added
//! as one.
//!
//! Enlarging by two-tap interpolation (weights ¾ and ¼) adds a variance of ¾ fine pixels², or ¼(1 − 4⁻ᵏ) pixels² of layer k after k times; the
//! Gaussian that is added to the layer is narrower by that. Beside a sum of Gaussians the picture errs by what merging and tabulated widths and
//! places leave: the tests hold it below 2 % (root mean square), and a single splat within 6.5 % of its
//! peak.

use wide::f32x4;

use super::sheet::Falls;
use super::splat::{LEAST_SIGMA, MOST_SIGMA, Picture, REACH};
use super::walk::Point;

/// Layers: in the coarsest, with pixels of 2⁵, the widest splat has a standard deviation of 1.25 pixels.
const LAYERS: usize = 6;
/// Pixels around a layer: room for a splat whose middle is outside.
const MARGIN: usize = 16;
/// Most pixels along a side of a splat: twice 3 standard deviations of 2 pixels.
const WIDTH: usize = 12;
/// Tabulated Gaussians: standard deviations from 0.5 to 2 pixels in steps of 1/40, and places within a pixel.
const WIDTHS: usize = 60;
const WIDTHS_PER_PIXEL: f32 = 40.0;
const PLACES: usize = 32;
/// Points closer to the first of them than this share of its standard deviation are added as one. What that takes from the variance along the
/// streak is at most a twelfth of the share's square: 5 %.
const NEAR: f32 = 0.75;
/// And only if their standard deviations differ by less than this share: seen along a streak, its far and its near end fall on one pixel.
const ALIKE: f32 = 0.2;

type Side = [f32; WIDTH];

/// Each pixel's share of a splat along one side, by width and place; the shares' sum is 1, so that no light is lost.
#[derive(Clone, Debug)]
pub struct Shares {
    shares: Vec<Side>,
    /// Half the pixels that a splat covers.
    halves: [usize; WIDTHS + 1],
}

impl Default for Shares {
    fn default() -> Self {
        let sigma = |row: usize| 0.5 + row as f32 / WIDTHS_PER_PIXEL;
        let halves = std::array::from_fn(|row| (REACH * sigma(row)).ceil() as usize);
        let mut shares = Vec::with_capacity((WIDTHS + 1) * (PLACES + 1));
        for (row, half) in halves.iter().enumerate() {
            for place in 0..=PLACES {
                let mut side: [f32; WIDTH] = std::array::from_fn(|k| {
                    let d = place as f32 / PLACES as f32 + k as f32 - *half as f32;
                    if k < 2 * half { (-0.5 * (d / sigma(row)).powi(2)).exp() } else { 0.0 }
                });
                let sum: f32 = side.iter().sum();
                side.iter_mut().for_each(|share| *share /= sum);
                shares.push(side);
            }
        }
        Shares { shares, halves }
    }
}

/// A picture of one size, with a margin.
#[derive(Clone, Debug)]
struct Layer {
    stride: usize,
    rows: usize,
    pixels: Vec<f32x4>,
    used: bool,
}

impl Layer {
    /// Adds light in `SIDE` rows of `SIDE` pixels from pixel `start` on.
    #[inline(always)]
    fn add<const SIDE: usize>(&mut self, start: usize, columns: &Side, lines: &Side, light: f32x4) {
        self.used = true;
        // Pixel by pixel: wider vectors would load what two narrower ones of the splat before have just stored, and wait for both.
        let row: [f32x4; SIDE] = std::array::from_fn(|k| light * f32x4::splat(columns[k]));
        let pixels = &mut self.pixels[start..start + (SIDE - 1) * self.stride + SIDE];
        for (share, pixels) in lines[..SIDE].iter().zip(pixels.chunks_mut(self.stride)) {
            let share = f32x4::splat(*share);
            for (pixel, light) in pixels[..SIDE].iter_mut().zip(&row) {
                *pixel += *light * share;
            }
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1")]
fn add_avx(pyramid: &mut Pyramid, points: &[Point], falls: &Falls, radius: f32, shares: &Shares) {
    pyramid.add_all(points, falls, radius, shares);
}

/// The layers of a picture.
#[derive(Clone, Debug)]
pub struct Pyramid {
    size: [usize; 2],
    layers: Vec<Layer>,
}

/// Points that are added as one.
#[derive(Clone, Copy, Debug)]
struct Blob {
    /// The first of them, and how far around it others are taken in, squared.
    x: f32,
    y: f32,
    near: f32,
    /// Of the first, pixels.
    sigma: f32,
    /// Sums over them: weight, weight times place relative to the first, weight times variance, light.
    weight: f32,
    dx: f32,
    dy: f32,
    variance: f32,
    light: f32x4,
}

impl Pyramid {
    /// For pictures of a size; black.
    pub fn new(size: [usize; 2]) -> Self {
        let layers = (0..LAYERS).map(|k| {
            let [stride, rows] = size.map(|side| side.div_ceil(1 << k) + 2 * MARGIN);
            Layer { stride, rows, pixels: vec![f32x4::ZERO; stride * rows], used: false }
        });
        Pyramid { size, layers: layers.collect() }
    }

    /// Adds points with blobs of standard deviation `radius` km. Those of a streak should follow one another.
    pub fn add(&mut self, points: &[Point], falls: &Falls, radius: f32, shares: &Shares) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("bmi1") {
            #[allow(unsafe_code)]
            // SAFETY: the instructions were detected. They save copies and calls; the results are the same bits.
            return unsafe { add_avx(self, points, falls, radius, shares) };
        }
        self.add_all(points, falls, radius, shares);
    }

    #[inline(always)]
    fn add_all(&mut self, points: &[Point], falls: &Falls, radius: f32, shares: &Shares) {
        let mut blob: Option<Blob> = None;
        for point in points {
            let weight = point.count * point.scale * point.scale;
            if !(point.x.is_finite() && point.y.is_finite() && weight.is_finite()) {
                continue;
            }
            let light = f32x4::new(falls.light[point.level as usize]) * f32x4::splat(weight);
            let sigma = (radius * point.scale).clamp(LEAST_SIGMA, MOST_SIGMA);
            if let Some(blob) = &mut blob {
                let (dx, dy) = (point.x - blob.x, point.y - blob.y);
                if dx * dx + dy * dy < blob.near && (sigma - blob.sigma).abs() < ALIKE * blob.sigma {
                    blob.weight += weight;
                    blob.dx += weight * dx;
                    blob.dy += weight * dy;
                    blob.variance += weight * sigma * sigma;
                    blob.light += light;
                    continue;
                }
                self.splat(blob, shares);
            }
            let variance = weight * sigma * sigma;
            blob = Some(Blob { x: point.x, y: point.y, near: (NEAR * sigma).powi(2), sigma, weight, dx: 0.0, dy: 0.0, variance, light });
        }
        if let Some(blob) = &blob {
            self.splat(blob, shares);
        }
    }

    #[inline(always)]
    fn splat(&mut self, blob: &Blob, shares: &Shares) {
        let inverse = 1.0 / blob.weight;
        let (x, y) = (blob.x + blob.dx * inverse, blob.y + blob.dy * inverse);
        let variance = blob.variance * inverse;
        // Layer k has the variances from 4ᵏ to 4ᵏ⁺¹: half the number's exponent says which. A least standard deviation of 0.75 instead of 1 of its
        // pixels would show them (13 % of the peak instead of 6 % at the worst place); more would cost more.
        let exponent = (variance.to_bits() >> 23) as i32 - 127;
        let k = (exponent >> 1).clamp(0, LAYERS as i32 - 1);
        let scale = 1.0 / (1u32 << k) as f32;
        let part = scale * scale;
        // Pixels of layer k, narrower by what enlarging adds.
        let own = (variance * part - 0.25 * (1.0 - part)).max(0.0).sqrt();
        let row = (((own - 0.5) * WIDTHS_PER_PIXEL + 0.5) as usize).min(WIDTHS);
        let half = shares.halves[row];
        let layer = &mut self.layers[k as usize];
        // The pixels whose middles are within reach start after this, counted from the margin's edge. What is not a number is not inside.
        let edge = |centre: f32| centre * scale + (MARGIN - half) as f32 - 0.5;
        let inside = |edge: f32, side: usize| edge >= 0.0 && edge + ((2 * half + 1) as f32) < side as f32;
        let (left, top) = (edge(x), edge(y));
        if !(inside(left, layer.stride) && inside(top, layer.rows)) {
            return;
        }
        // The first pixel, and how far within reach. Through i32, for which processors have an instruction.
        let place = |edge: f32| {
            let first = edge as i32 + 1;
            (first as usize, ((first as f32 - edge) * PLACES as f32 + 0.5) as i32 as usize)
        };
        let ((left, column), (top, line)) = (place(left), place(top));
        let start = top * layer.stride + left;
        let side = |place: usize| &shares.shares[row * (PLACES + 1) + place.min(PLACES)];
        let (columns, lines, light) = (side(column), side(line), blob.light * f32x4::splat(part));
        // A known width lets the compiler write the loop out.
        match half {
            0..=2 => layer.add::<4>(start, columns, lines, light),
            3 => layer.add::<6>(start, columns, lines, light),
            4 => layer.add::<8>(start, columns, lines, light),
            5 => layer.add::<10>(start, columns, lines, light),
            _ => layer.add::<WIDTH>(start, columns, lines, light),
        }
    }

    /// Adds another of the same size.
    pub fn merge(&mut self, other: &Pyramid) {
        for (layer, more) in self.layers.iter_mut().zip(&other.layers).filter(|(_, more)| more.used) {
            layer.used = true;
            layer.pixels.iter_mut().zip(&more.pixels).for_each(|(pixel, more)| *pixel += *more);
        }
    }

    /// The picture: each layer enlarged and added to the next finer one.
    pub fn picture(mut self) -> Picture {
        let mut column = Vec::new();
        for k in (1..LAYERS).rev() {
            let (finer, coarser) = self.layers.split_at_mut(k);
            let (fine, coarse) = (&mut finer[k - 1], &coarser[0]);
            if !coarse.used {
                continue;
            }
            fine.used = true;
            let between = |a: f32x4, b: f32x4| a * f32x4::splat(0.75) + b * f32x4::splat(0.25);
            // Of the margin, one pixel is enough: no finer layer asks for more.
            let [width, height] = self.size.map(|side| side.div_ceil(1 << (k - 1)));
            for y in 0..height + 2 {
                // Fine pixel y − 1 without margin: its own coarse pixel, and the neighbour on its side.
                let (own, beside) = neighbours(y);
                let row = |y: usize| &coarse.pixels[y * coarse.stride..(y + 1) * coarse.stride];
                column.clear();
                column.extend(row(own).iter().zip(row(beside)).map(|(a, b)| between(*a, *b)));
                let start = (y + MARGIN - 1) * fine.stride + MARGIN - 1;
                for (x, pixel) in fine.pixels[start..start + width + 2].iter_mut().enumerate() {
                    let (own, beside) = neighbours(x);
                    *pixel += between(column[own], column[beside]);
                }
            }
        }
        let layer = &self.layers[0];
        let rows = (0..self.size[1]).flat_map(|y| {
            let start = (y + MARGIN) * layer.stride + MARGIN;
            layer.pixels[start..start + self.size[0]].iter().map(|pixel| pixel.to_array())
        });
        Picture { size: self.size, pixels: rows.collect() }
    }
}

/// The coarse pixel that fine pixel `k` − 1 lies in, and the next nearest one, both counted from the margin's edge.
fn neighbours(k: usize) -> (usize, usize) {
    let own = k.div_ceil(2) + MARGIN - 1;
    // An even k is an odd fine pixel, which leans to the right.
    (own, if k.is_multiple_of(2) { own + 1 } else { own - 1 })
}
