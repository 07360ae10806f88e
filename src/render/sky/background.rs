//! The pass that fills every pixel that nothing solid covers.

use crate::render::Gpu;
use crate::render::layout::{HDR_FORMAT, Raster, Slot, bind, layout, module, raster};
use crate::render::shaders::Pass;

/// The Milky Way's texture and the pass that draws it.
#[derive(Debug)]
pub struct Background {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
}

/// An equirectangular picture of linear light with its mip chain: each level's width, height and RGB rows from the north pole.
pub type Panorama = Vec<(u32, u32, Vec<[f32; 3]>)>;

impl Background {
    /// Uploads the Milky Way.
    pub fn new(gpu: &Gpu, frame_layout: &wgpu::BindGroupLayout, milky_way: &Panorama) -> Self {
        let device = &gpu.device;
        let group_layout = layout(device, "background", wgpu::ShaderStages::FRAGMENT, &[Slot::Texture, Slot::Sampler]);
        let (width, height) = milky_way.first().map_or((1, 1), |level| (level.0, level.1));
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("milky way"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: milky_way.len().max(1) as u32,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba16Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        for (mip, (width, height, pixels)) in milky_way.iter().enumerate() {
            let halves: Vec<[u16; 4]> =
                pixels.iter().map(|rgb| [half_bits(rgb[0]), half_bits(rgb[1]), half_bits(rgb[2]), half_bits(1.0)]).collect();
            gpu.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    texture: &texture,
                    mip_level: mip as u32,
                    origin: wgpu::Origin3d::ZERO,
                    aspect: wgpu::TextureAspect::All,
                },
                bytemuck::cast_slice(&halves),
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(8 * width), rows_per_image: None },
                wgpu::Extent3d { width: *width, height: *height, depth_or_array_layers: 1 },
            );
        }
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("milky way"),
            address_mode_u: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        });
        let view = texture.create_view(&Default::default());
        let group = bind(
            device,
            "background",
            &group_layout,
            &[wgpu::BindingResource::TextureView(&view), wgpu::BindingResource::Sampler(&sampler)],
        );
        let shader = module(device, "background", Pass::Background);
        let stage = Raster { vertex: "vertex", fragment: "fragment", targets: &[(HDR_FORMAT, None)], depth: Some(false) };
        let pipeline = raster(device, "background", &shader, stage, &[Some(frame_layout), Some(&group_layout)]);
        Background { pipeline, group }
    }

    /// Draws into the picture, where depth is still that of infinity.
    pub fn draw(&self, pass: &mut wgpu::RenderPass) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn half_bits(value: f32) -> u16 {
    half::f16::from_f32(value).to_bits()
}
