//! Pictures in files: PNG for the eye, EXR for linear light and layers.

pub mod moment;
pub mod text;

use std::path::{Path, PathBuf};

use crate::user_file::{self, write_whole};

/// Why a picture could not be written.
#[derive(Debug, thiserror::Error)]
pub enum PictureFileError {
    /// The name says nothing known.
    #[error("cannot write {}: the name must end in .png or .exr", .0.display())]
    Format(PathBuf),
    /// The file could not be written.
    #[error("cannot write {}: {reason}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What went wrong.
        reason: String,
    },
}

/// One channel of an EXR.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Its name in the file.
    pub name: &'static str,
    /// Row by row from the top.
    pub data: Vec<f32>,
}

/// Writes sRGB, 3 bytes a pixel, row by row from the top, whole or not at all.
pub fn write_png(path: &Path, rgb: &[u8], [width, height]: [u32; 2]) -> Result<(), PictureFileError> {
    let fault = |reason: String| PictureFileError::Write { path: path.to_path_buf(), reason };
    let bytes = png(rgb, [width, height], false, None).map_err(fault)?;
    write_whole(path, &bytes).map_err(|error| fault(error.to_string()))
}

/// The bytes of a PNG of sRGB, 3 bytes a pixel, row by row from the top, with `text` in it ([`text`]); `quickly` rather than small.
pub fn png(rgb: &[u8], [width, height]: [u32; 2], quickly: bool, text: Option<&str>) -> Result<Vec<u8>, String> {
    let mut info = png::Info::with_size(width, height);
    info.utf8_text.extend(text.map(text::chunk));
    let mut bytes = Vec::new();
    let encode = || {
        let mut encoder = png::Encoder::with_info(&mut bytes, info)?;
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Fast);
        encoder.set_filter(if quickly { png::Filter::Sub } else { png::Filter::Adaptive });
        let mut writer = encoder.write_header()?;
        writer.write_image_data(rgb)?;
        writer.finish()
    };
    encode().map_err(|error| error.to_string())?;
    Ok(bytes)
}

/// Writes a PNG with a text in it, whole or not at all.
pub fn write_png_with_text(path: &Path, rgb: &[u8], size: [u32; 2], text: &str) -> Result<(), PictureFileError> {
    let fault = |reason: String| PictureFileError::Write { path: path.to_path_buf(), reason };
    let bytes = png(rgb, size, false, Some(text)).map_err(fault)?;
    write_whole(path, &bytes).map_err(|error| fault(error.to_string()))
}

/// As [`user_file::check_writable`].
pub fn check_writable(path: &Path) -> Result<(), PictureFileError> {
    user_file::check_writable(path).map_err(|error| PictureFileError::Write { path: path.to_path_buf(), reason: error.to_string() })
}

/// Writes channels as 32-bit floats, whole or not at all.
pub fn write_exr(path: &Path, [width, height]: [u32; 2], channels: &[Channel]) -> Result<(), PictureFileError> {
    use exr::prelude::*;
    let list: SmallVec<[AnyChannel<FlatSamples>; 4]> =
        channels.iter().map(|channel| AnyChannel::new(channel.name, FlatSamples::F32(channel.data.clone()))).collect();
    let size = (width as usize, height as usize);
    let layer = Layer::new(size, LayerAttributes::named("lensrunner"), Encoding::SMALL_LOSSLESS, AnyChannels::sort(list));
    let fault = |reason: String| PictureFileError::Write { path: path.to_path_buf(), reason };
    let mut bytes = std::io::Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut bytes).map_err(|error| fault(error.to_string()))?;
    write_whole(path, bytes.get_ref()).map_err(|error| fault(error.to_string()))
}
