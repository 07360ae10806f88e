//! Short forms for bind groups and pipelines: what each pass would otherwise repeat.

use std::borrow::Cow;
use std::cell::Cell;

use wgpu::{
    BindGroupLayoutEntry, BindingResource, BindingType, Buffer, BufferBindingType, BufferUsages, SamplerBindingType, ShaderStages,
    TextureSampleType, TextureViewDimension,
};

use crate::render::gpu::shaders::{Pass, Shader};

thread_local! {
    static MADE: Cell<u64> = const { Cell::new(0) };
}

/// How many buffers, textures, bind groups, shader modules and pipelines this thread has had made so far: a frame in which nothing new
/// appears makes none.
pub fn made() -> u64 {
    MADE.get()
}

/// Counts something that was made.
fn counted<T>(thing: T) -> T {
    MADE.set(MADE.get() + 1);
    thing
}

/// A 2-D texture of this width and height in pixels, of so many layers and levels of mip.
pub fn new_texture(
    device: &wgpu::Device,
    label: &str,
    [width, height]: [u32; 2],
    [layers, levels]: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    counted(device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
        mip_level_count: levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    }))
}

/// One entry of a layout: its kind, and who sees it.
#[derive(Clone, Copy, Debug)]
pub enum Slot {
    /// A uniform buffer.
    Uniform,
    /// A storage buffer that is only read.
    Read,
    /// A storage buffer that is written.
    Write,
    /// A 2-D texture of floats that can be filtered.
    Texture,
    /// A 2-D texture of numbers that are only fetched.
    Numbers,
    /// The same of words of 32 bits.
    Words,
    /// A 2-D texture of four words a texel that is written.
    WriteWords,
    /// The same of two.
    WritePairs,
    /// A 2-D texture of depths, fetched or gathered.
    Depth,
    /// An array of them.
    TextureArray,
    /// A filtering sampler.
    Sampler,
    /// One that does not filter.
    Nearest,
}

/// A layout with the slots at bindings 0, 1, 2, …, seen by `stages`.
pub fn layout(device: &wgpu::Device, label: &str, stages: ShaderStages, slots: &[Slot]) -> wgpu::BindGroupLayout {
    let entries: Vec<BindGroupLayoutEntry> = slots
        .iter()
        .enumerate()
        .map(|(binding, slot)| {
            let buffer = |ty| BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
            let texture = |view_dimension, filterable| BindingType::Texture {
                sample_type: TextureSampleType::Float { filterable },
                view_dimension,
                multisampled: false,
            };
            let written = |format| BindingType::StorageTexture {
                access: wgpu::StorageTextureAccess::WriteOnly,
                format,
                view_dimension: TextureViewDimension::D2,
            };
            // A vertex stage may not see what it could write.
            let visibility = if matches!(slot, Slot::Write) { stages & !ShaderStages::VERTEX } else { stages };
            BindGroupLayoutEntry {
                binding: binding as u32,
                visibility,
                ty: match slot {
                    Slot::Uniform => buffer(BufferBindingType::Uniform),
                    Slot::Read => buffer(BufferBindingType::Storage { read_only: true }),
                    Slot::Write => buffer(BufferBindingType::Storage { read_only: false }),
                    Slot::Texture => texture(TextureViewDimension::D2, true),
                    Slot::Numbers => texture(TextureViewDimension::D2, false),
                    Slot::Words => BindingType::Texture {
                        sample_type: TextureSampleType::Uint,
                        view_dimension: TextureViewDimension::D2,
                        multisampled: false,
                    },
                    Slot::WriteWords => written(wgpu::TextureFormat::Rgba32Uint),
                    Slot::WritePairs => written(wgpu::TextureFormat::Rg32Uint),
                    Slot::Depth => BindingType::Texture {
                        sample_type: TextureSampleType::Depth,
                        view_dimension: TextureViewDimension::D2,
                        multisampled: false,
                    },
                    Slot::TextureArray => texture(TextureViewDimension::D2Array, true),
                    Slot::Sampler => BindingType::Sampler(SamplerBindingType::Filtering),
                    Slot::Nearest => BindingType::Sampler(SamplerBindingType::NonFiltering),
                },
                count: None,
            }
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}

/// A bind group with the resources at bindings 0, 1, 2, …
pub fn bind(device: &wgpu::Device, label: &str, layout: &wgpu::BindGroupLayout, resources: &[BindingResource]) -> wgpu::BindGroup {
    let entries: Vec<wgpu::BindGroupEntry> = resources
        .iter()
        .enumerate()
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding: binding as u32, resource: resource.clone() })
        .collect();
    counted(device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries }))
}

/// The least size of a buffer, in bytes: an empty list still has room for one of the largest rows that a shader reads.
const LEAST: u64 = 512;

/// A buffer of `size` bytes, or of the least size.
pub fn buffer(device: &wgpu::Device, label: &str, size: u64, usage: BufferUsages) -> Buffer {
    counted(device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size.max(LEAST).next_multiple_of(16),
        usage: usage | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    }))
}

/// A sampler between texels, clamped at the edges.
pub fn linear_sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("linear"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    })
}

/// A storage buffer filled with `data`.
pub fn storage<T: bytemuck::Pod>(gpu: &crate::render::Gpu, label: &str, data: &[T]) -> Buffer {
    let bytes: &[u8] = bytemuck::cast_slice(data);
    let result = buffer(&gpu.device, label, bytes.len() as u64, BufferUsages::STORAGE);
    gpu.queue.write_buffer(&result, 0, bytes);
    result
}

/// A storage buffer that grows when more is written to it than it holds.
#[derive(Debug)]
pub struct Growing {
    label: &'static str,
    usage: BufferUsages,
    /// The buffer as it is now; replaced when it grows.
    pub buffer: Buffer,
}

impl Growing {
    /// An empty one.
    pub fn new(device: &wgpu::Device, label: &'static str, usage: BufferUsages) -> Self {
        Growing { label, usage, buffer: buffer(device, label, LEAST, usage) }
    }

    /// Holds at least `size` bytes afterwards. True if the buffer was replaced, so that bind groups must be made anew.
    pub fn reserve(&mut self, device: &wgpu::Device, size: u64) -> bool {
        if size <= self.buffer.size() {
            return false;
        }
        // A quarter more than asked, so that a slow growth does not make a new buffer each frame; but no more than may be bound.
        let most = device.limits().max_storage_buffer_binding_size;
        self.buffer = buffer(device, self.label, (size + size / 4).min(most.max(size)), self.usage);
        true
    }

    /// Writes the data, growing if it must. True if the buffer was replaced.
    pub fn write<T: bytemuck::Pod>(&mut self, gpu: &crate::render::Gpu, data: &[T]) -> bool {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        let replaced = self.reserve(&gpu.device, bytes.len() as u64);
        if !bytes.is_empty() {
            gpu.queue.write_buffer(&self.buffer, 0, bytes);
        }
        replaced
    }
}

/// Texels in a row of a table that is kept in a texture; `TABLE_ROW` of WGSL.
pub const TABLE_ROW: usize = 1024;

/// Rows of the highest texture that WebGPU guarantees.
pub const TABLE_ROWS: usize = 8192;

/// A table for shaders to fetch from, kept in a texture of rows of [`TABLE_ROW`] texels of four numbers or words: a texel is fetched at
/// once, where a software driver reads a storage buffer number by number and lane by lane. It grows when more is written to it than it
/// holds.
#[derive(Debug)]
pub struct TableTexture {
    label: &'static str,
    texture: wgpu::Texture,
    view: wgpu::TextureView,
}

/// How tables are used.
const TABLE_USAGE: wgpu::TextureUsages = wgpu::TextureUsages::TEXTURE_BINDING.union(wgpu::TextureUsages::COPY_DST);

impl TableTexture {
    /// An empty one, of f32 or, for a [`Slot::Words`], of u32.
    pub fn new(device: &wgpu::Device, label: &'static str, words: bool) -> Self {
        let format = if words { wgpu::TextureFormat::Rgba32Uint } else { wgpu::TextureFormat::Rgba32Float };
        let (texture, view) = table_texture(device, label, format, TABLE_USAGE, 1);
        TableTexture { label, texture, view }
    }

    /// An empty one of words, of four or two a texel, that shaders may write as well ([`Slot::WriteWords`], [`Slot::WritePairs`]).
    pub fn written(device: &wgpu::Device, label: &'static str, format: wgpu::TextureFormat) -> Self {
        let usage = TABLE_USAGE | wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let (texture, view) = table_texture(device, label, format, usage, 1);
        TableTexture { label, texture, view }
    }

    /// One that holds these texels, for a [`Slot::Numbers`].
    pub fn of(gpu: &crate::render::Gpu, label: &'static str, texels: &[[f32; 4]]) -> Self {
        let mut table = TableTexture::new(&gpu.device, label, false);
        table.write(gpu, texels);
        table
    }

    /// Holds at least `count` texels afterwards. True if the texture was replaced, so that bind groups must be made anew.
    pub fn reserve(&mut self, device: &wgpu::Device, count: usize) -> bool {
        let replaced = count > (self.texture.width() * self.texture.height()) as usize;
        if replaced {
            (self.texture, self.view) = table_texture(device, self.label, self.texture.format(), self.texture.usage(), count);
        }
        replaced
    }

    /// Writes the data, whole texels, growing if it must. True if the texture was replaced, so that bind groups must be made anew.
    pub fn write<T: bytemuck::Pod>(&mut self, gpu: &crate::render::Gpu, data: &[T]) -> bool {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        let texel = self.texel();
        let replaced = self.reserve(&gpu.device, bytes.len() / texel);
        let row = texel * self.texture.width() as usize;
        // Whole rows, then what is left of one.
        let (rows, rest) = bytes.split_at(bytes.len() / row * row);
        for (part, y, height) in [(rows, 0, rows.len() / row), (rest, rows.len() / row, 1)] {
            if !part.is_empty() {
                let width = part.len() / texel / height;
                gpu.queue.write_texture(
                    wgpu::TexelCopyTextureInfo { origin: wgpu::Origin3d { x: 0, y: y as u32, z: 0 }, ..self.texture.as_image_copy() },
                    part,
                    wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some((texel * width) as u32), rows_per_image: None },
                    wgpu::Extent3d { width: width as u32, height: height as u32, depth_or_array_layers: 1 },
                );
            }
        }
        replaced
    }

    /// Bytes of a texel.
    fn texel(&self) -> usize {
        self.texture.format().block_copy_size(None).unwrap_or(16) as usize
    }

    /// For a [`Slot::Numbers`], a [`Slot::Words`] or one that is written.
    pub fn binding(&self) -> BindingResource<'_> {
        BindingResource::TextureView(&self.view)
    }

    /// The texture, for tests that read it.
    pub fn texture(&self) -> &wgpu::Texture {
        &self.texture
    }
}

/// A texture for a table of `count` texels: as wide as they are, or of so many rows.
fn table_texture(
    device: &wgpu::Device,
    label: &str,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
    count: usize,
) -> (wgpu::Texture, wgpu::TextureView) {
    let size = [count.clamp(1, TABLE_ROW) as u32, count.div_ceil(TABLE_ROW).max(1) as u32];
    let texture = new_texture(device, label, size, [1, 1], format, usage);
    let view = texture.create_view(&Default::default());
    (texture, view)
}

/// A compute pipeline of one entry point.
pub fn compute(
    device: &wgpu::Device,
    label: &str,
    pass: Pass,
    entry: &str,
    layouts: &[Option<&wgpu::BindGroupLayout>],
) -> wgpu::ComputePipeline {
    compute_of(device, label, pass.shader(), entry, layouts)
}

/// A compute pipeline of one entry point of `shader`.
pub fn compute_of(
    device: &wgpu::Device,
    label: &str,
    shader: impl Into<Shader>,
    entry: &str,
    layouts: &[Option<&wgpu::BindGroupLayout>],
) -> wgpu::ComputePipeline {
    compute_in(device, label, &module_of(device, label, shader), entry, layouts)
}

/// A compute pipeline of one entry point of a module that has several.
pub fn compute_in(
    device: &wgpu::Device,
    label: &str,
    module: &wgpu::ShaderModule,
    entry: &str,
    layouts: &[Option<&wgpu::BindGroupLayout>],
) -> wgpu::ComputePipeline {
    let layout = pipeline_layout(device, label, layouts);
    counted(device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(label),
        layout: Some(&layout),
        module,
        entry_point: Some(entry),
        compilation_options: Default::default(),
        cache: None,
    }))
}

/// The shader module of a pass.
pub fn module(device: &wgpu::Device, label: &str, pass: Pass) -> wgpu::ShaderModule {
    module_of(device, label, pass.shader())
}

/// The shader module of a shader.
pub fn module_of(device: &wgpu::Device, label: &str, shader: impl Into<Shader>) -> wgpu::ShaderModule {
    let source = match shader.into() {
        Shader::Composed(module) => wgpu::ShaderSource::Naga(Cow::Owned(*module)),
        Shader::Written(text) => wgpu::ShaderSource::Wgsl(text.into()),
    };
    counted(device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(label), source }))
}

/// A pipeline layout of these groups.
fn pipeline_layout(device: &wgpu::Device, label: &str, layouts: &[Option<&wgpu::BindGroupLayout>]) -> wgpu::PipelineLayout {
    device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor { label: Some(label), bind_group_layouts: layouts, immediate_size: 0 })
}

/// How a render pipeline meets depth and colour.
#[derive(Clone, Copy, Debug)]
pub struct Raster<'a> {
    /// Entry points.
    pub vertex: &'a str,
    /// Of the fragment stage.
    pub fragment: &'a str,
    /// Colour targets with their blending.
    pub targets: &'a [(wgpu::TextureFormat, Option<wgpu::BlendState>)],
    /// Whether depth is tested, and whether it is written too. None: no depth attachment.
    pub depth: Option<bool>,
}

/// The format of the picture before it is display: linear light.
pub const HDR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// The formats of the sums over thin triangles: colour and coverage; and coverage with signs, with that of the nearer parts of the same
/// images. Both are as exact as the other, so that one image alone gives the same as its sum without signs. A pixel may be the sum of
/// hundreds of triangles: in halves each of them is rounded, by a software driver always down, which takes 6 % of a ring's light.
pub fn thin_formats(device: &wgpu::Device) -> [wgpu::TextureFormat; 2] {
    if device.features().contains(wgpu::Features::FLOAT32_BLENDABLE) {
        [wgpu::TextureFormat::Rgba32Float, wgpu::TextureFormat::Rg32Float]
    } else {
        [wgpu::TextureFormat::Rgba16Float, wgpu::TextureFormat::Rg16Float]
    }
}

/// The format of depth, reversed: 1 at the near distance, 0 at infinity.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The format of masks: 1 inside.
pub const MASK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// A render pipeline of triangles without vertex buffers.
pub fn raster(
    device: &wgpu::Device,
    label: &str,
    module: &wgpu::ShaderModule,
    raster: Raster,
    layouts: &[Option<&wgpu::BindGroupLayout>],
) -> wgpu::RenderPipeline {
    raster_of(device, label, module, raster, layouts, &[])
}

/// The same with vertex buffers: a driver fetches a whole vertex from one better than a shader does from a storage buffer.
pub fn raster_of(
    device: &wgpu::Device,
    label: &str,
    module: &wgpu::ShaderModule,
    raster: Raster,
    layouts: &[Option<&wgpu::BindGroupLayout>],
    buffers: &[wgpu::VertexBufferLayout],
) -> wgpu::RenderPipeline {
    let layout = pipeline_layout(device, label, layouts);
    let targets: Vec<Option<wgpu::ColorTargetState>> = raster
        .targets
        .iter()
        .map(|&(format, blend)| Some(wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL }))
        .collect();
    counted(device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: Some(&layout),
        vertex: wgpu::VertexState { module, entry_point: Some(raster.vertex), compilation_options: Default::default(), buffers },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: raster.depth.map(|write| wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(write),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(raster.fragment),
            compilation_options: Default::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    }))
}
