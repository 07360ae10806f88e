//! The trailer's file, read back.

use std::collections::HashMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use lensrunner::play::camera::director::Shot;
use lensrunner::play::sound::mixer::RATE;
use lensrunner::play::trailer::avi::{AviFormat, AviWriter};
use lensrunner::play::trailer::plan::{Camera, PARTS, Part, Place};
use lensrunner::play::trailer::title::{Letters, Style};
use lensrunner::play::trailer::{TrailerArgs, make};

use crate::gpu::GPU;
use crate::support::Folder;

fn number(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
}

/// What an AVI file holds, by a reader that knows nothing of the writer.
struct Film {
    /// Data of the chunks that occur once, by name; of the two `strh` and `strf`: with the stream's number.
    heads: HashMap<String, Vec<u8>>,
    pictures: Vec<Vec<u8>>,
    sound: Vec<u8>,
}

/// Visits the chunks in `bytes`: name, place of the data, data.
fn chunks(bytes: &[u8], mut visit: impl FnMut(&str, usize, &[u8])) {
    let mut at = 0;
    while at < bytes.len() {
        let length = number(bytes, at + 4) as usize;
        visit(std::str::from_utf8(&bytes[at..at + 4]).expect("a name"), at + 8, &bytes[at + 8..at + 8 + length]);
        at += 8 + length + length % 2;
    }
    assert_eq!(at, bytes.len(), "chunks fill their list");
}

impl Film {
    fn read(bytes: &[u8]) -> Film {
        assert_eq!((&bytes[..4], &bytes[8..12]), (&b"RIFF"[..], &b"AVI "[..]));
        assert_eq!(number(bytes, 4) as usize, bytes.len() - 8, "the length of the file");
        let mut film = Film { heads: HashMap::new(), pictures: Vec::new(), sound: Vec::new() };
        let (mut movi, mut order) = (0, Vec::new());
        chunks(&bytes[12..], |name, at, data| match (name, &data[..4]) {
            ("LIST", b"hdrl") => film.read_head(data),
            ("LIST", b"movi") => {
                movi = 12 + at;
                chunks(&data[4..], |name, at, data| {
                    order.push((name.to_owned(), at - 8 + 4, data.len()));
                    match name {
                        "00dc" => film.pictures.push(data.to_vec()),
                        "01wb" => film.sound.extend(data),
                        other => panic!("{other} among pictures and sound"),
                    }
                });
            }
            _ => _ = film.heads.insert(name.to_owned(), data.to_vec()),
        });
        // The index says where each chunk is, counted from the word `movi`.
        let index: Vec<(String, usize, usize)> = film.heads["idx1"]
            .chunks(16)
            .map(|entry| (String::from_utf8(entry[..4].to_vec()).expect("a name"), number(entry, 8) as usize, number(entry, 12) as usize))
            .collect();
        assert_eq!(index, order);
        for (name, offset, _) in &index {
            assert_eq!(&bytes[movi + offset..movi + offset + 4], name.as_bytes());
        }
        film
    }

    fn read_head(&mut self, list: &[u8]) {
        let mut stream = 0;
        chunks(&list[4..], |name, _, data| {
            if name == "LIST" {
                chunks(&data[4..], |name, _, data| _ = self.heads.insert(format!("{name}{stream}"), data.to_vec()));
                stream += 1;
            } else {
                self.heads.insert(name.to_owned(), data.to_vec());
            }
        });
    }

    /// All that the file says of itself is so; the picture's and the sound's length in seconds.
    fn check(&self, [width, height]: [u32; 2], fps: u32) -> [f64; 2] {
        let (main, video, look) = (&self.heads["avih"], &self.heads["strh0"], &self.heads["strf0"]);
        assert_eq!([main.len(), video.len(), look.len()], [56, 56, 40]);
        assert_eq!([number(main, 0), number(main, 16), number(main, 24)], [1_000_000 / fps, self.pictures.len() as u32, 2]);
        assert_eq!([number(main, 32), number(main, 36), number(look, 4), number(look, 8)], [width, height, width, height]);
        assert_eq!((&video[..8], &look[16..20]), (&b"vidsMJPG"[..], &b"MJPG"[..]));
        // Scale, rate, start, length.
        assert_eq!([20, 24, 28, 32].map(|at| number(video, at)), [1, fps, 0, self.pictures.len() as u32]);
        let (audio, wave) = (&self.heads["strh1"], &self.heads["strf1"]);
        assert_eq!([audio.len(), wave.len()], [56, 16]);
        let samples = self.sound.len() as u32 / 4;
        assert_eq!((&audio[..4], [20, 24, 28, 32, 44].map(|at| number(audio, at))), (&b"auds"[..], [1, RATE, 0, samples, 4]));
        // PCM in two channels; rate; bytes a second; 4 bytes and 16 bits a sample.
        assert_eq!([0, 4, 8, 12].map(|at| number(wave, at)), [0x0002_0001, RATE, 4 * RATE, 0x0010_0004]);
        for jpeg in &self.pictures {
            let picture = image::load_from_memory_with_format(jpeg, image::ImageFormat::Jpeg).expect("a JPEG");
            assert_eq!([picture.width(), picture.height()], [width, height]);
        }
        [self.pictures.len() as f64 / f64::from(fps), f64::from(samples) / f64::from(RATE)]
    }

    /// The mean of each picture's channels, 0 to 255.
    fn brightness(&self) -> Vec<f64> {
        let mean = |jpeg: &Vec<u8>| {
            let rgb = image::load_from_memory(jpeg).expect("a JPEG").to_rgb8();
            rgb.as_raw().iter().map(|&channel| f64::from(channel)).sum::<f64>() / rgb.as_raw().len() as f64
        };
        self.pictures.iter().map(mean).collect()
    }
}

#[test]
fn an_avi_file_is_read_back_as_it_was_written() {
    let format = AviFormat { size: [6, 4], fps: 7, rate: RATE };
    let mut avi = AviWriter::new(Cursor::new(Vec::new()), format).expect("begun");
    let mut sound = Vec::new();
    for k in 0..5_u8 {
        // With lengths that are odd, too.
        let mut jpeg = Vec::new();
        let pixels: Vec<u8> = (0..72).map(|p| p * 3 * (k % 2) + k).collect();
        image::codecs::jpeg::JpegEncoder::new(&mut jpeg).encode(&pixels, 6, 4, image::ExtendedColorType::Rgb8).expect("encoded");
        jpeg.resize(jpeg.len() + usize::from(k), 0);
        avi.picture(&jpeg).expect("written");
        let samples: Vec<[f32; 2]> = (0..RATE / 7).map(|s| [(s as f32 * 0.01).sin(), -1.5]).collect();
        avi.sound(&samples).expect("written");
        sound.extend(samples);
    }
    let film = Film::read(&avi.finish().expect("finished").into_inner());
    let [pictures, heard] = film.check([6, 4], 7);
    assert!((pictures - heard).abs() < 1.0 / 7.0, "{pictures} {heard}");
    assert_eq!(film.pictures.len(), 5);
    let read: Vec<i16> = film.sound.chunks(2).map(|sample| i16::from_le_bytes([sample[0], sample[1]])).collect();
    assert_eq!(read.len(), 2 * sound.len());
    for (read, written) in read.chunks(2).zip(&sound) {
        assert!((f32::from(read[0]) / 32767.0 - written[0]).abs() < 1e-4);
        assert_eq!(read[1], -32767, "louder than can be is as loud as can be");
    }
}

fn film(parts: &[Part], args: &TrailerArgs) -> Film {
    let frames = make(&GPU, args, parts).expect("made");
    let film = Film::read(&std::fs::read(&args.output).expect("read"));
    assert_eq!(film.pictures.len() as u32, frames);
    film
}

/// All parts of the trailer, in few and small pictures.
#[test]
fn the_trailer_has_pictures_and_sound_of_one_length() {
    let folder = Folder::new();
    let args = TrailerArgs { output: folder.path().join("trailer.avi"), size: [160, 90], fps: 2, seconds: 8 };
    let film = film(&PARTS, &args);
    let [pictures, heard] = film.check(args.size, args.fps);
    assert_eq!(pictures, 8.0);
    assert!((pictures - heard).abs() < 1e-3, "{pictures} {heard}");
    let light = film.brightness();
    assert!(light[0] < 1.0, "it comes out of black: {light:?}");
    // What is between fades is neither dark nor glaring.
    assert!(light.iter().filter(|&&mean| mean > 10.0).count() >= PARTS.len() - 1, "{light:?}");
    assert!(light.iter().all(|&mean| mean < 120.0), "{light:?}");
    let samples: Vec<f64> = film.sound.chunks(2).map(|sample| f64::from(i16::from_le_bytes([sample[0], sample[1]])) / 32767.0).collect();
    let rms = |from: f64, to: f64| {
        let part = &samples[(from * 96_000.0) as usize..(to * 96_000.0) as usize];
        (part.iter().map(|sample| sample * sample).sum::<f64>() / part.len() as f64).sqrt()
    };
    // It runs through, and comes and goes softly.
    assert!((1..7).all(|second| rms(f64::from(second), f64::from(second + 1)) > 0.005), "a silent second");
    assert!(rms(0.0, 0.02) < 1e-3 && rms(7.98, 8.0) < 1e-3);
    assert!(samples.iter().all(|sample| sample.abs() < 0.81));
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
    let bytes = ["a.avi", "b.avi"].map(|name| {
        let args = TrailerArgs { output: folder.path().join(name), size: [80, 45], fps: 2, seconds: 2 };
        make(&GPU, &args, &[SHORT]).expect("made");
        std::fs::read(&args.output).expect("read")
    });
    assert!(bytes[0] == bytes[1]);
}

/// What making a trailer of one part into this file comes to.
fn trouble(path: &Path) -> String {
    let args = TrailerArgs { output: PathBuf::from(path), size: [80, 45], fps: 2, seconds: 1 };
    make(&GPU, &args, &[SHORT]).expect_err("it cannot be written").to_string()
}

#[test]
fn what_cannot_be_written_is_named() {
    let path = Path::new("/no/such/folder/trailer.avi");
    assert!(trouble(path).contains("/no/such/folder/trailer.avi"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_said() {
    let error = trouble(Path::new("/dev/full"));
    assert!(error.contains("/dev/full") && error.contains("space"), "{error}");
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
