//! The trailer's files, read back.

use std::path::Path;

use lensrunner::play::camera::director::Shot;
use lensrunner::play::trailer::plan::{Camera, PARTS, Part, Place};
use lensrunner::play::trailer::title::{Letters, Style};
use lensrunner::play::trailer::{TrailerArgs, make};

use crate::gpu::GPU;
use crate::support::Folder;

/// The pictures of a film, and its samples, left and right in turn, within ±1.
fn film(parts: &[Part], args: &TrailerArgs) -> (Vec<Vec<u8>>, Vec<f64>) {
    let frames = make(&GPU, args, parts).expect("made");
    let picture = |index: u32| {
        let picture = image::open(args.output.join(format!("frames/frame-{index:05}.png"))).expect("a picture").to_rgb8();
        assert_eq!(picture.dimensions(), args.size.into());
        picture.into_raw()
    };
    let sound = hound::WavReader::open(args.output.join("sound.wav")).expect("a sound");
    ((0..frames).map(picture).collect(), sound.into_samples::<i16>().map(|sample| f64::from(sample.expect("a sample")) / 32767.0).collect())
}

/// All parts of the trailer, in few and small pictures.
#[test]
fn the_trailer_has_pictures_and_sound_of_one_length() {
    let folder = Folder::new();
    let args = TrailerArgs { output: folder.path().to_path_buf(), size: [160, 90], fps: 2, seconds: 8 };
    let (pictures, samples) = film(&PARTS, &args);
    assert_eq!((pictures.len(), samples.len()), (16, 8 * 2 * 48_000));
    let mean = |rgb: &Vec<u8>| rgb.iter().map(|&channel| f64::from(channel)).sum::<f64>() / rgb.len() as f64;
    let light: Vec<f64> = pictures.iter().map(mean).collect();
    assert!(light[0] < 1.0, "it comes out of black: {light:?}");
    // What is between fades is neither dark nor glaring.
    assert!(light.iter().filter(|&&mean| mean > 10.0).count() >= PARTS.len() - 1, "{light:?}");
    assert!(light.iter().all(|&mean| mean < 120.0), "{light:?}");
    let rms = |part: &[f64]| (part.iter().map(|sample| sample * sample).sum::<f64>() / part.len() as f64).sqrt();
    let loud: Vec<f64> = samples.chunks(96_000).map(rms).collect();
    assert!(loud[1..7].iter().all(|&second| second > 1e-3), "a silent second: {loud:?}");
}

/// A short flight, to be drawn quickly.
const SHORT: Part = Part {
    place: Place::Flight("02-first-pursuit"),
    span: [17.5, 18.5],
    seconds: 2.0,
    camera: Camera::Director(Shot::Quarry),
    fov: 75.0,
    tension: 0.4,
    line: "Light is late.",
};

#[test]
fn the_same_trailer_is_made_twice() {
    let folder = Folder::new();
    let [one, other] = ["a", "b"].map(|name| {
        let args = TrailerArgs { output: folder.path().join(name), size: [80, 45], fps: 2, seconds: 2 };
        film(&[SHORT], &args)
    });
    assert!(one == other);
}

#[test]
fn what_cannot_be_written_is_named() {
    let folder = Folder::new();
    let file = folder.path().join("file");
    std::fs::write(&file, "no folder").expect("written");
    for output in [file.as_path(), Path::new("/dev/null/trailer")] {
        let args = TrailerArgs { output: output.to_path_buf(), size: [80, 45], fps: 2, seconds: 1 };
        let said = make(&GPU, &args, &[SHORT]).expect_err("it cannot be written").to_string();
        assert!(said.contains(&output.display().to_string()), "{said}");
    }
}

/// Words stand in the middle of their row, and within the picture however long they are.
#[test]
fn words_are_written_in_the_middle() {
    let size = [320, 180];
    for words in ["LENSRUNNER", "What you see is where it was, and much more than fits in a row of these letters."] {
        let mut rgb = vec![0; 320 * 180 * 3];
        let style = Style { height: 0.17, at: 0.26, spread: 0.2, strength: 1.0 };
        Letters::default().write(words, &style, size, &mut rgb);
        let lit: Vec<[usize; 2]> = (0..320 * 180).filter(|&p| rgb[3 * p] > 60).map(|p| [p % 320, p / 320]).collect();
        let ends = |k: usize| {
            let all = lit.iter().map(|place| place[k]);
            (all.clone().min().expect("written"), all.max().expect("written"))
        };
        let ((left, right), (top, bottom)) = (ends(0), ends(1));
        assert!(left > 5 && right < 315 && (left + right).abs_diff(319) < 8, "{left} {right}");
        assert!(top > 15 && bottom < 85, "{top} {bottom}");
        assert!(right - left > 200, "{left} {right}");
        let mut dark = vec![7; 320 * 180 * 3];
        Letters::default().write(words, &Style { strength: 0.0, ..style }, size, &mut dark);
        assert!(dark.iter().all(|&channel| channel == 7));
    }
}
