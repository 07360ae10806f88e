//! The mix in a WAV file: stereo, 48 kHz, 16 bit.

use std::path::{Path, PathBuf};

use hound::{SampleFormat, WavSpec, WavWriter};
use thiserror::Error;

use crate::play::sound::heard::Heard;
use crate::play::sound::mixer::{Mixer, RATE};
use crate::play::sound::volumes::Volumes;

/// A file could not be written.
#[derive(Debug, Error)]
#[error("cannot write {}: {reason}", path.display())]
pub struct SoundFileError {
    /// The file.
    pub path: PathBuf,
    /// Why.
    pub reason: String,
}

/// Renders `moments`, each of which lasts `seconds`, and hands the samples to `take` in blocks.
pub fn render<E>(moments: &[Heard], seconds: f64, volumes: &Volumes, mut take: impl FnMut(&[[f32; 2]]) -> Result<(), E>) -> Result<(), E> {
    let mut mixer = Mixer::new(RATE);
    let mut block = Vec::new();
    let mut written = 0;
    for (index, heard) in moments.iter().enumerate() {
        mixer.set(heard, volumes);
        // Counted from the beginning, so that no rounding adds up.
        let until = ((index + 1) as f64 * seconds * f64::from(RATE)).round() as u64;
        block.resize(until.saturating_sub(written) as usize, [0.0; 2]);
        mixer.fill(&mut block);
        take(&block)?;
        written = until.max(written);
    }
    Ok(())
}

/// Samples over which a file fades out: a hundredth of a second.
const FADE: f32 = 0.01 * RATE as f32;

/// Writes `moments`, each of which lasts `seconds`, to a WAV file. Its length in seconds.
pub fn write(path: &Path, moments: &[Heard], seconds: f64, volumes: &Volumes) -> Result<f64, SoundFileError> {
    let failed = |error: hound::Error| {
        let reason = match error {
            hound::Error::IoError(error) => error.to_string(),
            other => other.to_string(),
        };
        SoundFileError { path: path.to_path_buf(), reason }
    };
    let spec = WavSpec { channels: 2, sample_rate: RATE, bits_per_sample: 16, sample_format: SampleFormat::Int };
    let mut file = WavWriter::create(path, spec).map_err(failed)?;
    // It ends without a click, whatever sounds at the end.
    let all = (moments.len() as f64 * seconds * f64::from(RATE)).round() as u64;
    let mut index = 0;
    render(moments, seconds, volumes, |block| {
        block.iter().try_for_each(|frame| {
            let gain = (all.saturating_sub(index) as f32 / FADE).min(1.0);
            index += 1;
            frame.iter().try_for_each(|sample| file.write_sample((sample * gain * f32::from(i16::MAX)).round() as i16))
        })
    })
    .map_err(failed)?;
    let length = f64::from(file.duration()) / f64::from(RATE);
    file.finalize().map_err(failed)?;
    Ok(length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_as_long_as_its_moments() {
        let path = std::env::temp_dir().join(format!("lensrunner-sound-{}.wav", std::process::id()));
        // 1/47 s is no whole number of samples.
        let length = write(&path, &[Heard::MUSIC; 47], 1.0 / 47.0, &Volumes::default()).expect("written");
        let read = hound::WavReader::open(&path).expect("a WAV file");
        assert_eq!((length, read.duration(), read.spec().channels, read.spec().sample_rate), (1.0, 48_000, 2, 48_000));
        std::fs::remove_file(path).expect("removed");
    }

    #[test]
    fn what_cannot_be_written_is_named() {
        let error = write(Path::new("/no/such/folder/a.wav"), &[Heard::MUSIC], 0.1, &Volumes::default()).expect_err("no folder");
        assert!(error.to_string().contains("/no/such/folder/a.wav"), "{error}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_said() {
        let error = write(Path::new("/dev/full"), &[Heard::MUSIC; 100], 0.1, &Volumes::default()).expect_err("full");
        assert!(error.to_string().contains("/dev/full") && error.to_string().contains("space"), "{error}");
    }
}
