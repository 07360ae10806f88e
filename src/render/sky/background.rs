//! The pass that fills every pixel that nothing solid covers, in cells: interpolated where that is right, pixel by pixel elsewhere.

use std::mem::offset_of;

use crate::render::Gpu;
use crate::render::gpu::layout::{Growing, HDR_FORMAT, Raster, Slot, bind, buffer, compute, layout, module, new_texture, raster};
use crate::render::gpu::shaders::Pass;
use crate::render::gpu::types::{CellDraws, SKY_CORNER_BYTES};

/// Side of a cell in pixels: at 16, few cells near the hole are drawn exactly, and corners are a thousandth of the pixels.
const CELL: u32 = 16;

/// The Milky Way's texture, the grid of cells, and the passes that draw it.
#[derive(Debug)]
pub struct Background {
    corner: wgpu::ComputePipeline,
    cell: wgpu::ComputePipeline,
    smooth: wgpu::RenderPipeline,
    exact: wgpu::RenderPipeline,
    cells_layout: wgpu::BindGroupLayout,
    draw_layout: wgpu::BindGroupLayout,
    milky_way: wgpu::TextureView,
    sampler: wgpu::Sampler,
    corners: Growing,
    indices: Growing,
    draws: wgpu::Buffer,
    /// Bind groups of the computation and of the draws, for this many cells.
    groups: Option<(wgpu::BindGroup, wgpu::BindGroup)>,
    grid: [u32; 2],
}

/// An equirectangular picture of the Milky Way's brightness, 1 being its peak, with its mip chain: each level's width, height and rows from
/// the north pole.
pub type Panorama = Vec<(u32, u32, Vec<f32>)>;

impl Background {
    /// Uploads the Milky Way.
    pub fn new(gpu: &Gpu, frame_layout: &wgpu::BindGroupLayout, milky_way: &Panorama) -> Self {
        let device = &gpu.device;
        let (width, height) = milky_way.first().map_or((1, 1), |level| (level.0, level.1));
        let texture = new_texture(
            device,
            "milky way",
            [width, height],
            [1, milky_way.len().max(1) as u32],
            wgpu::TextureFormat::R8Unorm,
            wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        );
        for (mip, (width, height, pixels)) in milky_way.iter().enumerate() {
            // The square root, so that eight bits are enough for the faint parts.
            let roots: Vec<u8> = pixels.iter().map(|brightness| (255.0 * brightness.clamp(0.0, 1.0).sqrt()).round() as u8).collect();
            gpu.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    texture: &texture,
                    mip_level: mip as u32,
                    origin: wgpu::Origin3d::ZERO,
                    aspect: wgpu::TextureAspect::All,
                },
                &roots,
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(*width), rows_per_image: None },
                wgpu::Extent3d { width: *width, height: *height, depth_or_array_layers: 1 },
            );
        }
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("milky way"),
            address_mode_u: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Nearest,
            ..Default::default()
        });
        let view = texture.create_view(&Default::default());
        let cells_layout = layout(device, "sky cells", wgpu::ShaderStages::COMPUTE, &[Slot::Write, Slot::Write, Slot::Write]);
        let draw_layout = layout(device, "background", wgpu::ShaderStages::VERTEX_FRAGMENT, &[Slot::Read, Slot::Texture, Slot::Sampler]);
        let shader = module(device, "background", Pass::Background);
        let draw = |label, vertex, fragment| {
            let stage = Raster { vertex, fragment, targets: &[(HDR_FORMAT, None)], depth: Some(false) };
            raster(device, label, &shader, stage, &[Some(frame_layout), Some(&draw_layout)])
        };
        let cells = [Some(frame_layout), Some(&cells_layout)];
        Background {
            corner: compute(device, "sky corners", Pass::SkyCells, "corner", &cells),
            cell: compute(device, "sky cells", Pass::SkyCells, "cell", &cells),
            smooth: draw("smooth sky", "smooth_vertex", "smooth_fragment"),
            exact: draw("exact sky", "exact_vertex", "exact_fragment"),
            cells_layout,
            draw_layout,
            milky_way: view,
            sampler,
            corners: Growing::new(device, "sky corners", wgpu::BufferUsages::STORAGE),
            indices: Growing::new(device, "sky indices", wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDEX),
            draws: buffer(device, "sky draws", size_of::<CellDraws>() as u64, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT),
            groups: None,
            grid: [0; 2],
        }
    }

    /// Lays the grid over a picture of `size` pixels, before [`Background::cells`].
    pub fn prepare(&mut self, gpu: &Gpu, size: [u32; 2]) {
        let device = &gpu.device;
        let [columns, rows] = size.map(|side| side.div_ceil(CELL));
        self.grid = [columns, rows];
        let indices = 6 * columns * rows;
        let mut replaced = self.corners.reserve(device, u64::from((columns + 1) * (rows + 1)) * SKY_CORNER_BYTES);
        replaced |= self.indices.reserve(device, 2 * 4 * u64::from(indices));
        if replaced {
            self.groups = None;
        }
        let draws = CellDraws { smooth: [0, 1, 0, 0, 0], exact: [0, 1, indices, 0, 0], columns, rows, side: CELL, unused: 0 };
        gpu.queue.write_buffer(&self.draws, 0, bytemuck::bytes_of(&draws));
    }

    /// Makes the bind groups of a prepared frame, where buffers are others than before.
    pub fn bind(&mut self, device: &wgpu::Device) {
        use wgpu::BindingResource::{Sampler, TextureView};
        if self.groups.is_none() {
            let corners = || self.corners.buffer.as_entire_binding();
            let cells = [corners(), self.indices.buffer.as_entire_binding(), self.draws.as_entire_binding()];
            let draw = [corners(), TextureView(&self.milky_way), Sampler(&self.sampler)];
            self.groups =
                Some((bind(device, "sky cells", &self.cells_layout, &cells), bind(device, "background", &self.draw_layout, &draw)));
        }
    }

    /// Works out what the corners see, and which cells may be interpolated.
    pub fn cells(&self, pass: &mut wgpu::ComputePass) {
        let Some((group, _)) = &self.groups else { return };
        let [columns, rows] = self.grid;
        pass.set_bind_group(1, group, &[]);
        pass.set_pipeline(&self.corner);
        pass.dispatch_workgroups(((columns + 1) * (rows + 1)).div_ceil(64), 1, 1);
        pass.set_pipeline(&self.cell);
        pass.dispatch_workgroups((columns * rows).div_ceil(64), 1, 1);
    }

    /// Draws into the picture, where depth is still that of infinity.
    pub fn draw(&self, pass: &mut wgpu::RenderPass) {
        let Some((_, group)) = &self.groups else { return };
        pass.set_bind_group(1, group, &[]);
        pass.set_index_buffer(self.indices.buffer.slice(..), wgpu::IndexFormat::Uint32);
        pass.set_pipeline(&self.smooth);
        pass.draw_indexed_indirect(&self.draws, offset_of!(CellDraws, smooth) as u64);
        pass.set_pipeline(&self.exact);
        pass.draw_indexed_indirect(&self.draws, offset_of!(CellDraws, exact) as u64);
    }
}
