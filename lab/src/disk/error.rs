//! How far a picture is from the truth, in linear light.

use crate::flip::mean_flip;

/// The error of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiskPictureError {
    /// Peak signal to noise in dB, at most [`BEST_PSNR`]; brighter light than the peak counts as that.
    pub psnr: f64,
    /// Mean of |difference| over mean of the truth.
    pub relative: f64,
    /// Mean ꟻLIP, 0 to 1, of both pictures exposed so that the peak is white.
    pub flip: f64,
}

/// What cannot be seen any more, in dB: a difference of a thousandth of the peak.
pub const BEST_PSNR: f64 = 60.0;

/// The light that a picture is exposed for: its 99.9th percentile of luminance.
pub fn peak(picture: &[[f32; 3]]) -> f32 {
    let mut brightness: Vec<f32> = picture.iter().map(|p| 0.2127 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]).collect();
    brightness.sort_by(f32::total_cmp);
    brightness.get((brightness.len() as f64 * 0.999) as usize).copied().unwrap_or(1.0).max(1e-20)
}

/// Compares linear pictures of `size` pixels, both exposed for `peak`.
pub fn compare(got: &[[f32; 3]], truth: &[[f32; 3]], size: [u32; 2], peak: f32) -> DiskPictureError {
    let (mut square, mut off, mut whole) = (0.0f64, 0.0f64, 0.0f64);
    for (a, b) in got.iter().flatten().zip(truth.iter().flatten()) {
        let difference = f64::from(a.min(peak)) - f64::from(b.min(peak));
        square += difference * difference;
        off += difference.abs();
        whole += f64::from(b.min(peak));
    }
    let mean = square / (3 * truth.len().max(1)) as f64;
    let exposed = |picture: &[[f32; 3]]| -> Vec<[f32; 3]> { picture.iter().map(|p| p.map(|light| light / peak)).collect() };
    DiskPictureError {
        flip: mean_flip(&exposed(truth), &exposed(got), size),
        psnr: (10.0 * (f64::from(peak).powi(2) / mean.max(1e-300)).log10()).min(BEST_PSNR),
        relative: off / whole.max(1e-30),
    }
}
