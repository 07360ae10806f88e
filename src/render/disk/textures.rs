//! The pattern of the gas as textures.

use crate::breath::breath;
use crate::render::Gpu;
use crate::render::gpu::layout::new_texture;
use std::sync::LazyLock;

use crate::scene::disk::DETAIL;
use crate::scene::disk::noise::{HEIGHT, LATTICE, WIDTH, streaks};

/// The greatest value of the pattern with its finest octaves, in both directions; one texel in 10⁴ is beyond and is clamped.
const GREATEST: f32 = 4.0;

/// The pattern with all its halvings, twice.
#[derive(Debug)]
pub struct Textures {
    /// The far pattern: with the finest octaves, in 8 bits, as (value + 4)/8, all levels in one picture. Each texel also holds its next
    /// neighbours to the right, below and across, so that one fetch is enough for bilinear interpolation.
    pub far: wgpu::TextureView,
    /// The near pattern: without the finest octaves, in 16-bit floats, laid out in the same way.
    pub near: wgpu::TextureView,
}

/// Has the patterns worked out now, one after the other, which [`Textures::new`] else does.
pub async fn make_patterns() {
    LazyLock::force(&LATTICE);
    breath().await;
    LazyLock::force(&FAR);
    breath().await;
}

impl Textures {
    /// Uploads them.
    pub fn new(gpu: &Gpu) -> Textures {
        let levels = halvings((WIDTH as u32, HEIGHT as u32, LATTICE.clone()));
        let eighth = |value: f32| ((value + GREATEST) / (2.0 * GREATEST) * 255.0).round() as u8;
        let half = |value: f32| half::f16::from_f32(value).to_bits();
        let bytes =
            [bytemuck::cast_slice(&side_by_side(&FAR, eighth)).to_vec(), bytemuck::cast_slice(&side_by_side(&levels, half)).to_vec()];
        let formats = [wgpu::TextureFormat::Rgba8Unorm, wgpu::TextureFormat::Rgba16Float];
        Textures {
            far: texture(gpu, "gas from far", formats[0], [FAR_WIDTH, FAR[0].1], &bytes[0]),
            near: texture(gpu, "gas from near", formats[1], [FAR_WIDTH, levels[0].1], &bytes[1]),
        }
    }
}

/// One level: width, height, values.
type WidthLevel = (u32, u32, Vec<f32>);

/// The levels of the far pattern: [`finer`], then [`narrower`] with its halvings.
static FAR: LazyLock<Vec<WidthLevel>> = LazyLock::new(|| std::iter::once(finer()).chain(halvings(narrower())).collect());

/// The pattern with its finest octaves in texels half as large as those of [`narrower`], so that at ten r_s, where the near pattern takes
/// over, both show the same detail.
fn finer() -> WidthLevel {
    let (width, height) = (WIDTH, 2 * HEIGHT);
    let finer = DETAIL.0 as usize;
    // A texel is a mean over lattice points of the finest octaves: so many columns, half as many rows.
    let (columns, rows) = (finer, finer / 2);
    let (w, h) = (WIDTH / columns, HEIGHT / rows);
    let mean = |k: usize| -> f32 {
        let (x, y) = (k % w * columns, k / w * rows);
        let sum: f32 = (y..y + rows).map(|y| LATTICE[y * WIDTH + x..][..columns].iter().sum::<f32>()).sum();
        sum / (columns * rows) as f32
    };
    let detail: Vec<f32> = (0..w * h).map(mean).collect();
    let at = |x: usize, y: usize| {
        let [turns, up] = [(x, width), (y, height)].map(|(k, n)| (k as f64 + 0.5) / n as f64);
        streaks(turns, up) as f32 + DETAIL.1 as f32 * detail[y % h * w + x % w]
    };
    (width as u32, height as u32, (0..width * height).map(|k| at(k % width, k / width).clamp(-GREATEST, GREATEST)).collect())
}

/// The pattern with its finest octaves, halved round the hole: its cells are long that way, and a smaller texture stays in the processor's
/// cache.
fn narrower() -> WidthLevel {
    let narrow = |values: &[f32]| -> Vec<f32> { values.chunks_exact(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect() };
    let (width, height) = (WIDTH / 2, HEIGHT);
    // The finest octaves are the pattern again, so many times finer: a texel is a mean over as many of their texels, both ways.
    let finer = DETAIL.0 as usize;
    let (mut w, mut h, mut detail) = (width as u32, height as u32, narrow(&LATTICE));
    while w as usize > width / finer {
        (w, h, detail) = halved(&(w, h, detail));
    }
    let values = narrow(&LATTICE);
    let at = |x: usize, y: usize| values[y * width + x] + DETAIL.1 as f32 * detail[y % h as usize * w as usize + x % w as usize];
    (width as u32, height as u32, (0..width * height).map(|k| at(k % width, k / width).clamp(-GREATEST, GREATEST)).collect())
}

/// A level and all its halvings.
fn halvings(finest: WidthLevel) -> Vec<WidthLevel> {
    let mut levels = vec![finest];
    while let Some(level) = levels.last().filter(|level| level.0 > 1 && level.1 > 1) {
        levels.push(halved(level));
    }
    levels
}

/// A level of half the width and height.
fn halved((width, height, values): &WidthLevel) -> WidthLevel {
    let (w, h) = (*width as usize, *height as usize);
    let mean = (0..w * h / 4).map(|k| {
        let (x, y) = (2 * (k % (w / 2)), 2 * (k / (w / 2)));
        0.25 * (values[y * w + x] + values[y * w + x + 1] + values[(y + 1) * w + x] + values[(y + 1) * w + x + 1])
    });
    (width / 2, height / 2, mean.collect())
}

/// Width of the pictures that hold all levels, in texels: that of the first two levels, and 16 more. Then a row of the far pattern is an
/// odd number of lines of 64 bytes, of the near pattern nearly twice one. Rows a power of two apart would share cache lines of a processor
/// where streaks are looked up one above the other.
const FAR_WIDTH: u32 = 1552;

/// All levels in one picture, the first on the left, the others below one another beside it. Choosing a mip level of a texture anew in each
/// pixel costs a software driver more than computing a corner. Each texel also holds its next neighbours to the right, below and across;
/// values are written `as_bits`.
fn side_by_side<T: Copy + Default>(levels: &[WidthLevel], as_bits: impl Fn(f32) -> T) -> Vec<[T; 4]> {
    let mut texels = vec![[T::default(); 4]; (FAR_WIDTH * levels[0].1) as usize];
    let (mut left, mut top) = (0, 0);
    for &(width, height, ref values) in levels {
        let at = |x: u32, y: u32| as_bits(values[(y % height * width + x % width) as usize]);
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            texels[((top + y) * FAR_WIDTH + left + x) as usize] = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
        }
        (left, top) = (levels[0].0, if left == 0 { 0 } else { top + height });
    }
    texels
}

/// A texture of this width and height with these bytes.
fn texture(gpu: &Gpu, label: &str, format: wgpu::TextureFormat, [width, height]: [u32; 2], bytes: &[u8]) -> wgpu::TextureView {
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let texture = new_texture(
        &gpu.device,
        label,
        [width, height],
        [1, 1],
        format,
        wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
    );
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(bytes.len() as u32 / height), rows_per_image: None };
    gpu.queue.write_texture(texture.as_image_copy(), bytes, layout, size);
    texture.create_view(&Default::default())
}
