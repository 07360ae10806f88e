//! The pattern of the gas as textures.

use crate::render::Gpu;
use crate::scene::disk::noise::{HEIGHT, LATTICE, WIDTH};

/// The greatest value of the pattern, either way.
const GREATEST: f32 = 3.0;

/// The pattern with all its halvings, twice.
#[derive(Debug)]
pub struct Textures {
    /// In 8 bits, (value + 3)/6 in all channels: the format that software rasterisers are fastest with.
    pub far: wgpu::TextureView,
    /// One halving at a time: two are twice the work.
    pub far_sampler: wgpu::Sampler,
    /// In 16-bit floats, for close looks.
    pub near: wgpu::TextureView,
    /// One halving at a time, too.
    pub near_sampler: wgpu::Sampler,
}

impl Textures {
    /// Uploads them.
    pub fn new(gpu: &Gpu) -> Textures {
        let levels = halvings();
        let bytes = |value: f32| [((value + GREATEST) / (2.0 * GREATEST) * 255.0).round() as u8; 4].to_vec();
        let halves = |value: f32| half::f16::from_f32(value).to_le_bytes().to_vec();
        let sampler = |label, mipmap_filter| {
            gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some(label),
                address_mode_u: wgpu::AddressMode::Repeat,
                address_mode_v: wgpu::AddressMode::Repeat,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                mipmap_filter,
                ..Default::default()
            })
        };
        Textures {
            far: texture(gpu, "gas from far", wgpu::TextureFormat::Rgba8Unorm, &levels, &bytes),
            far_sampler: sampler("gas from far", wgpu::MipmapFilterMode::Nearest),
            near: texture(gpu, "gas from near", wgpu::TextureFormat::R16Float, &levels, &halves),
            near_sampler: sampler("gas from near", wgpu::MipmapFilterMode::Nearest),
        }
    }
}

/// One level: width, height, values.
type Level = (u32, u32, Vec<f32>);

/// The lattice, halved again and again.
fn halvings() -> Vec<Level> {
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

fn texture(gpu: &Gpu, label: &str, format: wgpu::TextureFormat, levels: &[Level], encode: &dyn Fn(f32) -> Vec<u8>) -> wgpu::TextureView {
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
        let bytes: Vec<u8> = values.iter().flat_map(|&value| encode(value)).collect();
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture: &texture,
                mip_level: mip as u32,
                origin: wgpu::Origin3d::ZERO,
                aspect: wgpu::TextureAspect::All,
            },
            &bytes,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(bytes.len() as u32 / height), rows_per_image: None },
            wgpu::Extent3d { width: *width, height: *height, depth_or_array_layers: 1 },
        );
    }
    texture.create_view(&Default::default())
}
