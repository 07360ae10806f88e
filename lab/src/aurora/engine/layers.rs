//! Pictures of half, a quarter, … the size: their memory, and how they become one picture.
//!
//! Memory is kept from picture to picture and cleared tile by tile, where light first falls: most of a large layer is never touched. At the
//! end the layers are not enlarged one after the other, but row by row all at once: a row of the picture asks for three rows of the next
//! coarser layer, and these for three of the one after. So all that is between is in a processor's first cache, several pyramids are summed
//! on the way, and bands of the picture can be made by different threads.

use bytemuck::{Pod, Zeroable};
use std::ops::Range;
use wide::f32x4;

/// Layers: in the coarsest, with pixels of 2⁵, the widest splat has a standard deviation of 1.25 pixels.
pub(super) const LAYERS: usize = 6;
/// Pixels around a layer: room for a splat whose middle is outside. Even, as pixels lie in pairs.
pub(super) const MARGIN: usize = 16;
/// Pixels along a side of a tile, as a power of two. No splat is wider than one, so that it lies in the tile where it begins and three
/// more.
pub(super) const TILE: u32 = 4;
/// The first pixel of the margin that the next finer layer asks for.
const FIRST: usize = MARGIN - 2;

/// Two pixels of four lines each: what a processor with AVX2 adds at once. Splats begin at whole pairs, since a pair that straddles two of
/// the splat before would wait for both to be stored.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C, align(32))]
pub(super) struct Pair([f32; 2 * 4]);

/// Tiles in a row of a layer of a picture of `width` pixels.
#[inline(always)]
pub(super) fn across(width: i32, layer: i32) -> i32 {
    ((width >> layer) + (2 * MARGIN as i32 + (1 << TILE))) >> TILE
}

/// A layer of a pyramid.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    /// Rows of tiles, and tiles in a row.
    rows: usize,
    across: usize,
    /// Nothing before light falls on the layer for the first time. Where no tile has been cleared, what is here has no meaning.
    pub(super) pairs: Vec<Pair>,
    /// Of each tile, row by row, whether splats that begin there have all the room that they need…
    pub(super) ready: Vec<bool>,
    /// … and whether it has been cleared.
    clear: Vec<bool>,
}

impl Layer {
    /// Layer `number` of a picture of this size.
    pub(super) fn new([width, height]: [usize; 2], number: usize) -> Layer {
        let across = across(width as i32, number as i32) as usize;
        let rows = (height.div_ceil(1 << number) + 2 * MARGIN).div_ceil(1 << TILE);
        let tiles = vec![false; rows * across];
        Layer { rows, across, pairs: Vec::new(), ready: tiles.clone(), clear: tiles }
    }

    /// All is black, at no cost.
    pub(super) fn wipe(&mut self) {
        self.ready.fill(false);
        self.clear.fill(false);
    }

    /// Whether no light fell on it.
    fn is_black(&self) -> bool {
        !self.clear.contains(&true)
    }

    /// Pairs from one row to the next.
    #[inline(always)]
    pub(super) fn stride(&self) -> usize {
        self.across << (TILE - 1)
    }

    /// Clears what splats need that begin in a tile.
    #[cold]
    pub(super) fn make_ready(&mut self, tile: usize) {
        let stride = self.stride();
        if self.pairs.is_empty() {
            self.pairs = vec![Pair::default(); stride * (self.rows << TILE)];
        }
        self.ready[tile] = true;
        let (row, column) = (tile / self.across, tile % self.across);
        for row in row..(row + 2).min(self.rows) {
            for column in column..(column + 2).min(self.across) {
                let tile = row * self.across + column;
                if !std::mem::replace(&mut self.clear[tile], true) {
                    let first = (row << TILE) * stride + (column << (TILE - 1));
                    for line in 0..1 << TILE {
                        let row: Option<&mut [Pair; 1 << (TILE - 1)]> = self.pairs[first + line * stride..].first_chunk_mut();
                        if let Some(row) = row {
                            *row = [Pair::default(); 1 << (TILE - 1)];
                        }
                    }
                }
            }
        }
    }

    /// Adds the light of row `y` to `row`, whose first pixel is the layer's pixel `first`.
    #[inline(always)]
    fn add_row(&self, y: usize, first: usize, row: &mut [[f32; 4]]) {
        let start = (y >> TILE) * self.across;
        let pixels: &[[f32; 4]] = bytemuck::cast_slice(&self.pairs);
        let end = first + row.len();
        for column in 0..self.across {
            if !self.clear[start + column] {
                continue;
            }
            let [low, high] = [column, column + 1].map(|column| (column << TILE).clamp(first, end));
            let light = &pixels[y * 2 * self.stride() + low..][..high - low];
            // Number by number, of which the compiler takes as many together as the processor can.
            let (row, light) = (row[low - first..high - first].as_flattened_mut(), light.as_flattened());
            for (number, more) in row.iter_mut().zip(light) {
                *number += *more;
            }
        }
    }
}

/// A row of a finer layer from three of a coarser one: two fine pixels of each coarse one and its neighbours, along both sides. They have
/// five, ten and one sixteenth, from the side that the fine one leans to. `column` is room for a row.
#[inline(always)]
fn enlarge([before, on, after]: [&[f32x4]; 3], upper: bool, column: &mut [f32x4], row: &mut [[f32; 4]]) {
    let width = on.len();
    let leaning = if upper { 0.125 } else { -0.125 };
    {
        // Number by number, of which the compiler takes as many together as the processor can.
        let [before, on, after]: [&[f32]; 3] = [before, on, after].map(bytemuck::cast_slice);
        let column: &mut [f32] = bytemuck::cast_slice_mut(&mut column[..width]);
        for (((pixel, before), on), after) in column.iter_mut().zip(before).zip(on).zip(after) {
            *pixel = on * 0.625 + (before + after) * 0.1875 + (before - after) * leaning;
        }
    }
    let (pairs, single) = row.as_chunks_mut::<2>();
    let mut windows = column[..width].array_windows::<3>();
    for (pair, window) in pairs.iter_mut().zip(windows.clone()) {
        *pair = fine(window);
    }
    // A picture of an odd width ends with half a pair.
    if let ([last], Some(window)) = (single, windows.nth(pairs.len())) {
        [*last, _] = fine(window);
    }
}

/// Two pixels of a finer row from the coarse one that they lie in and its neighbours.
#[inline(always)]
fn fine([before, on, after]: &[f32x4; 3]) -> [[f32; 4]; 2] {
    let even = *on * f32x4::splat(0.625) + (*before + *after) * f32x4::splat(0.1875);
    let odd = (*before - *after) * f32x4::splat(0.125);
    [(even + odd).to_array(), (even - odd).to_array()]
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn enlarge_avx(rows: [&[f32x4]; 3], upper: bool, column: &mut [f32x4], row: &mut [[f32; 4]]) {
    enlarge(rows, upper, column, row);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn add_row_avx(layer: &Layer, y: usize, first: usize, row: &mut [[f32; 4]]) {
    layer.add_row(y, first, row);
}

/// [`Layer::add_row`] with the widest instructions there are: the same bits.
fn add_row(layer: &Layer, y: usize, first: usize, row: &mut [[f32; 4]]) {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        #[allow(unsafe_code)]
        // SAFETY: the instructions were detected.
        return unsafe { add_row_avx(layer, y, first, row) };
    }
    layer.add_row(y, first, row);
}

/// [`enlarge`] with the widest instructions there are: the same bits.
fn enlarged(rows: [&[f32x4]; 3], upper: bool, column: &mut [f32x4], row: &mut [[f32; 4]]) {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        #[allow(unsafe_code)]
        // SAFETY: the instructions were detected.
        return unsafe { enlarge_avx(rows, upper, column, row) };
    }
    enlarge(rows, upper, column, row);
}

/// Rows of a layer that have been made: with all coarser layers, enlarged.
struct Made {
    /// The last four; the `y`-th is the `y % 4`-th. As many pixels as the next finer layer asks for.
    rows: [Vec<f32x4>; 4],
    /// The row that is made next; none before the first.
    next: Option<usize>,
    /// Room for a row.
    column: Vec<f32x4>,
}

/// Enlarges what the layers from `number` on, of which `made` are the rows, have for row `y` of the next finer one, from its pixel `first`
/// on. Rows must be asked for in order. Black for want of coarser layers.
fn enlarge_coarser(made: &mut [Made], pyramids: &[&[Layer; LAYERS]], number: usize, y: usize, first: usize, out: &mut [[f32; 4]]) {
    let Some((own, coarser)) = made.split_first_mut() else {
        out.fill([0.0; 4]);
        return;
    };
    let middle = (y + MARGIN) / 2;
    for y in own.next.unwrap_or(middle - 1)..middle + 2 {
        let row: &mut [[f32; 4]] = bytemuck::cast_slice_mut(&mut own.rows[y % 4]);
        enlarge_coarser(coarser, pyramids, number + 1, y, FIRST, row);
        for layers in pyramids {
            add_row(&layers[number], y, FIRST, row);
        }
        own.next = Some(y + 1);
    }
    // The first of three neighbours that the first pixel is made of.
    let left = (first + MARGIN) / 2 - 1 - FIRST;
    let rows = [middle - 1, middle, middle + 1].map(|y| &own.rows[y % 4][left..]);
    enlarged(rows, y.is_multiple_of(2), &mut own.column, out);
}

/// The light of several pyramids of a picture of this size, in some of its rows; `out` has their pixels.
pub(super) fn sum(pyramids: &[&[Layer; LAYERS]], size: [usize; 2], rows: Range<usize>, out: &mut [[f32; 4]]) {
    let coarser = (1..LAYERS).rfind(|&k| pyramids.iter().any(|layers| !layers[k].is_black())).unwrap_or(0);
    let mut made: Vec<Made> = (1..=coarser)
        .map(|k| {
            let row = || vec![f32x4::ZERO; size[0].div_ceil(1 << k) + 4];
            Made { rows: std::array::from_fn(|_| row()), next: None, column: row() }
        })
        .collect();
    for (y, out) in rows.zip(out.chunks_exact_mut(size[0].max(1))) {
        enlarge_coarser(&mut made, pyramids, 1, y + MARGIN, MARGIN, out);
        for layers in pyramids {
            add_row(&layers[0], y + MARGIN, MARGIN, out);
        }
    }
}
