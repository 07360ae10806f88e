//! The two pictures that the gas is drawn with.

use crate::render::Gpu;
use crate::scene::blackbody::blackbody_rgb;
use crate::scene::disk::DISK_UNIT;
use crate::scene::disk::noise::{HEIGHT, LATTICE, WIDTH};

/// Temperatures of the ends of the table of black bodies, in K, as in functions/colour.wgsl.
pub const TEMPERATURES: (f64, f64) = (200.0, 2.0e6);
/// Texels of the table: neighbours differ by 0.9 % in T.
const COLOURS: usize = 1024;

/// Pattern and colours with their samplers.
#[derive(Debug)]
pub struct Textures {
    /// The pattern with all its halvings.
    pub pattern: wgpu::TextureView,
    /// Repeats both ways.
    pub pattern_sampler: wgpu::Sampler,
    /// Linear light of a black body over ln T.
    pub colours: wgpu::TextureView,
    /// Held at the ends.
    pub colours_sampler: wgpu::Sampler,
}

impl Textures {
    /// Uploads them.
    pub fn new(gpu: &Gpu) -> Textures {
        let levels = halvings();
        let pattern = texture(gpu, "gas", wgpu::TextureFormat::R16Float, &levels, 1);
        let ratio = TEMPERATURES.1 / TEMPERATURES.0;
        let colours: Vec<f32> = (0..COLOURS)
            .flat_map(|k| {
                let [r, g, b] = blackbody_rgb(TEMPERATURES.0 * ratio.powf(k as f64 / (COLOURS - 1) as f64));
                [r, g, b, 1.0].map(|light| (light * DISK_UNIT).min(6e4) as f32)
            })
            .collect();
        let colours = texture(gpu, "black bodies", wgpu::TextureFormat::Rgba16Float, &[(COLOURS as u32, 1, colours)], 4);
        let sampler = |label, mode| {
            gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some(label),
                address_mode_u: mode,
                address_mode_v: mode,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                mipmap_filter: wgpu::MipmapFilterMode::Linear,
                ..Default::default()
            })
        };
        Textures {
            pattern,
            pattern_sampler: sampler("gas", wgpu::AddressMode::Repeat),
            colours,
            colours_sampler: sampler("black bodies", wgpu::AddressMode::ClampToEdge),
        }
    }
}

/// The lattice, halved again and again: each level's width, height and values.
fn halvings() -> Vec<(u32, u32, Vec<f32>)> {
    let mut levels = vec![(WIDTH as u32, HEIGHT as u32, LATTICE.clone())];
    while let Some((width, height, values)) = levels.last().filter(|level| level.0 > 1 && level.1 > 1) {
        let (w, h) = (*width as usize, *height as usize);
        let halved = (0..w * h / 4).map(|k| {
            let (x, y) = (2 * (k % (w / 2)), 2 * (k / (w / 2)));
            0.25 * (values[y * w + x] + values[y * w + x + 1] + values[(y + 1) * w + x] + values[(y + 1) * w + x + 1])
        });
        let next = (width / 2, height / 2, halved.collect());
        levels.push(next);
    }
    levels
}

fn texture(gpu: &Gpu, label: &str, format: wgpu::TextureFormat, levels: &[(u32, u32, Vec<f32>)], channels: u32) -> wgpu::TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: levels[0].0, height: levels[0].1, depth_or_array_layers: 1 },
        mip_level_count: levels.len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (mip, (width, height, values)) in levels.iter().enumerate() {
        let halves: Vec<u16> = values.iter().map(|&value| half::f16::from_f32(value).to_bits()).collect();
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture: &texture,
                mip_level: mip as u32,
                origin: wgpu::Origin3d::ZERO,
                aspect: wgpu::TextureAspect::All,
            },
            bytemuck::cast_slice(&halves),
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(2 * channels * width), rows_per_image: None },
            wgpu::Extent3d { width: *width, height: *height, depth_or_array_layers: 1 },
        );
    }
    texture.create_view(&Default::default())
}
