//! Thin triangles by where they are drawn: which tiles of the picture have some, and with which images of the disk each comes.

use wgpu::{BufferUsages, ShaderStages};

use crate::render::Gpu;
use crate::render::gpu::layout::{Growing, Raster, Slot, bind, buffer, compute, layout, module, raster, thin_formats};
use crate::render::gpu::shaders::Pass;
use crate::render::gpu::targets::tiles;
use crate::render::gpu::types;

/// Numbers of crossings of the disk's plane: none to three.
const CROSSINGS: u32 = 4;
/// Bytes of the arguments of an indexed draw.
const INDEXED_DRAW: u64 = 20;

/// The stage that lists them, its buffers, and what wipes their tiles.
#[derive(Debug)]
pub struct ThinLists {
    list: wgpu::ComputePipeline,
    list_layout: wgpu::BindGroupLayout,
    wipe: wgpu::RenderPipeline,
    tiles_layout: wgpu::BindGroupLayout,
    draws: wgpu::Buffer,
    lists: Growing,
    tiles: Growing,
    /// The triangles that the groups are made for.
    triangles: Option<wgpu::Buffer>,
    groups: Option<(wgpu::BindGroup, wgpu::BindGroup)>,
    /// Tiles of the prepared frame.
    count: u32,
}

/// How the list of tiles is bound to draws.
pub fn tiles_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    layout(device, "thin tiles", ShaderStages::VERTEX, &[Slot::Read])
}

impl ThinLists {
    /// Compiles the passes.
    pub fn new(device: &wgpu::Device, frame_layout: &wgpu::BindGroupLayout) -> ThinLists {
        use Slot::{Read, Write};
        let list_layout = layout(device, "thin lists", ShaderStages::COMPUTE, &[Read, Read, Write, Write, Write]);
        let tiles_layout = tiles_layout(device);
        let shader = module(device, "thin wipe", Pass::Compose);
        let targets = thin_formats(device).map(|format| (format, None));
        let stage = Raster { vertex: "vertex", fragment: "wipe", targets: &targets, depth: Some(false) };
        ThinLists {
            list: compute(device, "thin lists", Pass::ThinLists, "main", &[Some(frame_layout), Some(&list_layout)]),
            list_layout,
            wipe: raster(device, "thin wipe", &shader, stage, &[Some(frame_layout), Some(&tiles_layout)]),
            tiles_layout,
            draws: buffer(device, "thin draws", CROSSINGS_END + 16, BufferUsages::STORAGE | BufferUsages::INDIRECT),
            lists: Growing::new(device, "thin lists", BufferUsages::STORAGE | BufferUsages::INDEX),
            tiles: Growing::new(device, "thin tiles", BufferUsages::STORAGE),
            triangles: None,
            groups: None,
            count: 0,
        }
    }

    /// Makes room for `capacity` thin triangles in a picture of `size` pixels.
    pub fn prepare(&mut self, gpu: &Gpu, capacity: u32, size: [u32; 2]) {
        let device = &gpu.device;
        self.count = tiles(size);
        let mut replaced = self.lists.reserve(device, 4 * u64::from(CROSSINGS) * u64::from(capacity));
        replaced |= self.tiles.reserve(device, 8 * u64::from(self.count));
        if replaced {
            self.groups = None;
        }
        let triangles: [[u32; 5]; CROSSINGS as usize] = std::array::from_fn(|crossings| [0, 1, crossings as u32 * capacity, 0, 0]);
        gpu.queue.write_buffer(&self.draws, 0, bytemuck::cast_slice(&triangles));
        gpu.queue.write_buffer(&self.draws, CROSSINGS_END, bytemuck::cast_slice(&[6u32, 0, 0, 0]));
    }

    /// Makes the bind groups of a prepared frame, where buffers are others than before. `triangles` are those of the prepared geometry,
    /// `arguments` its indirect arguments.
    pub fn bind(&mut self, device: &wgpu::Device, [triangles, arguments]: [&wgpu::Buffer; 2]) {
        if self.groups.is_none() || self.triangles.as_ref() != Some(triangles) {
            self.triangles = Some(triangles.clone());
            let buffers = [triangles, arguments, &self.draws, &self.lists.buffer, &self.tiles.buffer];
            let list = bind(device, "thin lists", &self.list_layout, &buffers.map(|buffer| buffer.as_entire_binding()));
            let tiles = bind(device, "thin tiles", &self.tiles_layout, &[self.tiles.buffer.as_entire_binding()]);
            self.groups = Some((list, tiles));
        }
    }

    /// Forgets the tiles of the frame before; before [`list`](ThinLists::list).
    pub fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.tiles.buffer, 0, Some(4 * u64::from(self.count)));
    }

    /// Lists the thin triangles of the mesh stage, whose indirect arguments these are.
    pub fn list(&self, pass: &mut wgpu::ComputePass, arguments: &wgpu::Buffer) {
        let Some((group, _)) = &self.groups else { return };
        pass.set_pipeline(&self.list);
        pass.set_bind_group(1, group, &[]);
        pass.dispatch_workgroups_indirect(arguments, types::ARGUMENTS_THIN_LISTS);
    }

    /// Makes the sums black in the tiles that have thin triangles.
    pub fn wipe(&self, pass: &mut wgpu::RenderPass) {
        pass.set_pipeline(&self.wipe);
        self.draw_tiles(pass);
    }

    /// Draws those tiles with the pipeline that is set.
    pub fn draw_tiles(&self, pass: &mut wgpu::RenderPass) {
        let Some((_, tiles)) = &self.groups else { return };
        pass.set_bind_group(1, tiles, &[]);
        pass.draw_indirect(&self.draws, CROSSINGS_END);
    }

    /// Draws the corners of the triangles whose light crosses the disk's plane so often, with the pipeline and the vertices that are set.
    pub fn draw_across(&self, pass: &mut wgpu::RenderPass, crossings: u32) {
        pass.set_index_buffer(self.lists.buffer.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed_indirect(&self.draws, INDEXED_DRAW * u64::from(crossings));
    }
}

/// Where the arguments of the draw of tiles lie.
const CROSSINGS_END: u64 = INDEXED_DRAW * CROSSINGS as u64;
