//! The textures that a frame is drawn into, all of one size.

use crate::render::gpu::layout::{DEPTH_FORMAT, HDR_FORMAT, new_texture, thin_formats};

/// Format of the layers of a picture.
pub const LAYERS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// Cells across the picture that is metered; as in shaders/post_process/exposure.wgsl. The finer the picture, the brighter is a star's spot
/// and the smaller: in cells of the same angle it counts the same at every resolution.
const METERED_WIDTH: u32 = 80;

/// Levels of the picture for bloom and metering: a quarter, and from there halvings. A half is not among them: it would cost more than all
/// the others, for a glow of two pixels. In a picture that is enlarged twice or more it is the first: the glow of stars is narrow.
const BLOOM_LEVELS: usize = 5;

/// Pixels along the side of a tile of the picture; as in shaders/post_process/tiles.wgsl.
pub const TILE: u32 = 16;

/// Number of tiles in a picture of `size` pixels.
pub fn tiles(size: [u32; 2]) -> u32 {
    size.map(|side| side.div_ceil(TILE)).iter().product()
}

/// The targets of the layers of a picture.
#[derive(Debug)]
pub struct LayerTargets {
    /// Object id, order, travel time, g.
    pub what: (wgpu::Texture, wgpu::TextureView),
    /// Texture coordinates, coverage.
    pub surface: (wgpu::Texture, wgpu::TextureView),
    /// A depth of their own.
    pub depth: wgpu::TextureView,
}

/// Targets of one size.
#[derive(Debug)]
pub struct Targets {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Those of the output, to which the picture is enlarged.
    pub output: [u32; 2],
    /// The picture in linear light, as a texture to copy from.
    pub picture_texture: wgpu::Texture,
    /// The picture in linear light.
    pub picture: wgpu::TextureView,
    /// The same without stars, in a picture that is to be enlarged: these are laid over it afterwards.
    pub starless: Option<(wgpu::Texture, wgpu::TextureView)>,
    /// Depth, reversed.
    pub depth: wgpu::TextureView,
    /// Sum of thin triangles, as a texture to copy from.
    pub thin_texture: wgpu::Texture,
    /// Sum of thin triangles.
    pub thin: wgpu::TextureView,
    /// Sums of their coverage with signs and of what is laid over them later of the same images, as a texture to copy from.
    pub thin_signed_texture: wgpu::Texture,
    /// Sums of their coverage with signs and of what is laid over them later of the same images.
    pub thin_signed: wgpu::TextureView,
    /// The picture at a quarter or a half of its size, halved, halved again, and so on.
    pub bloom: Vec<wgpu::TextureView>,
    /// As large as the finest of them: room to soften it.
    pub glow: wgpu::TextureView,
    /// What the pixels show; made when first asked for.
    pub layers: Option<LayerTargets>,
}

impl Targets {
    /// Makes them, for a picture of `size` pixels that is enlarged to `output`; no side is smaller than a pixel.
    pub fn new(device: &wgpu::Device, size: [u32; 2], output: [u32; 2]) -> Self {
        let size = size.map(|side| side.max(1));
        let (picture_texture, picture) = target(device, "picture", size, HDR_FORMAT);
        let [sums, signed] = thin_formats(device);
        let (thin_texture, thin) = target(device, "thin", size, sums);
        let (thin_signed_texture, thin_signed) = target(device, "thin signed", size, signed);
        let finest = if 2 * size[0] > output[0] { 4 } else { 2 };
        let glow = target(device, "glow", size.map(|side| side.div_ceil(finest)), HDR_FORMAT).1;
        let mut bloom = Vec::new();
        let mut level = size;
        while bloom.len() < BLOOM_LEVELS {
            let step = if bloom.is_empty() { finest } else { 2 };
            level = level.map(|side: u32| side.div_ceil(step));
            bloom.push(target(device, "bloom", level, HDR_FORMAT).1);
            if level[0].min(level[1]) <= 4 {
                break;
            }
        }
        Targets {
            size,
            output,
            picture_texture,
            picture,
            starless: (size != output).then(|| {
                let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
                let texture = new_texture(device, "starless", size, [1, 1], HDR_FORMAT, usage);
                let view = texture.create_view(&Default::default());
                (texture, view)
            }),
            depth: target(device, "depth", size, DEPTH_FORMAT).1,
            thin_texture,
            thin,
            thin_signed_texture,
            thin_signed,
            bloom,
            glow,
            layers: None,
        }
    }

    /// The two levels of the bloom that are metered: the coarsest that is at least `METERED_WIDTH` texels wide, and the next.
    pub fn metered_levels(&self) -> [usize; 2] {
        let last = self.bloom.len() - 1;
        let wide = |level: &usize| self.bloom[*level].texture().width() >= METERED_WIDTH;
        let finer = (0..=last).rev().find(wide).unwrap_or(0);
        [finer, (finer + 1).min(last)]
    }

    /// The targets of the layers.
    pub fn layers(&mut self, device: &wgpu::Device) -> &LayerTargets {
        let size = self.size;
        self.layers.get_or_insert_with(|| LayerTargets {
            what: target(device, "layers", size, LAYERS_FORMAT),
            surface: target(device, "layers surface", size, LAYERS_FORMAT),
            depth: target(device, "layers depth", size, DEPTH_FORMAT).1,
        })
    }
}

/// A texture that is drawn into, sampled and copied from.
pub fn target(device: &wgpu::Device, label: &str, size: [u32; 2], format: wgpu::TextureFormat) -> (wgpu::Texture, wgpu::TextureView) {
    let texture = new_texture(
        device,
        label,
        size,
        [1, 1],
        format,
        wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC,
    );
    let view = texture.create_view(&Default::default());
    (texture, view)
}
