//! An AVI file: pictures as JPEG (Motion JPEG), sound as PCM samples, and an index, so that players can seek.
//!
//! The format is Microsoft's "AVI RIFF File Reference": a RIFF file whose list `hdrl` says what there is, whose list `movi` holds a chunk
//! for each picture (`00dc`) and for the sound that goes with it (`01wb`), and whose `idx1` says where each chunk is.

use std::io::{self, Seek, SeekFrom, Write};

/// `AVIF_HASINDEX | AVIF_ISINTERLEAVED`.
const FLAGS: u32 = 0x10 | 0x100;
/// `AVIIF_KEYFRAME`: every picture stands by itself.
const KEY_FRAME: u32 = 0x10;
/// Most bytes of a file: sizes and offsets have 32 bits, and many players read them with a sign.
const MOST_BYTES: u64 = i32::MAX as u64;
/// Bytes of a 16-bit sample for both ears.
const SAMPLE_BYTES: u32 = 4;

/// What is in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AviFormat {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Pictures a second.
    pub fps: u32,
    /// Samples a second, for each ear.
    pub rate: u32,
}

/// One chunk, as the index has it.
#[derive(Clone, Copy, Debug)]
struct Entry {
    name: [u8; 4],
    /// From the word `movi` on, in bytes.
    offset: u32,
    bytes: u32,
}

/// A file that is being written.
#[derive(Debug)]
pub struct AviWriter<W: Write + Seek> {
    out: W,
    format: AviFormat,
    entries: Vec<Entry>,
    /// Bytes of the list `movi`, its name included.
    movi: u32,
    frames: u32,
    samples: u32,
    /// The largest chunk, in bytes.
    largest: u32,
}

impl<W: Write + Seek> AviWriter<W> {
    /// Begins a file.
    pub fn new(out: W, format: AviFormat) -> io::Result<AviWriter<W>> {
        let mut avi = AviWriter { out, format, entries: Vec::new(), movi: 4, frames: 0, samples: 0, largest: 0 };
        let head = avi.head();
        avi.out.write_all(&head)?;
        Ok(avi)
    }

    /// The next picture, a whole JPEG file.
    pub fn picture(&mut self, jpeg: &[u8]) -> io::Result<()> {
        self.chunk(*b"00dc", jpeg)?;
        self.frames += 1;
        Ok(())
    }

    /// The next samples, left and right, each within ±1.
    pub fn sound(&mut self, samples: &[[f32; 2]]) -> io::Result<()> {
        let whole = |sample: f32| (sample.clamp(-1.0, 1.0) * f32::from(i16::MAX)).round() as i16;
        let bytes: Vec<u8> = samples.iter().flatten().flat_map(|&sample| whole(sample).to_le_bytes()).collect();
        self.chunk(*b"01wb", &bytes)?;
        self.samples += samples.len() as u32;
        Ok(())
    }

    /// Writes the index, and what the head must say of the whole.
    pub fn finish(mut self) -> io::Result<W> {
        let mut index = Vec::new();
        for entry in &self.entries {
            index.extend(entry.name);
            [KEY_FRAME, entry.offset, entry.bytes].iter().for_each(|number| index.extend(number.to_le_bytes()));
        }
        self.out.write_all(&chunk(*b"idx1", &index))?;
        self.out.seek(SeekFrom::Start(0))?;
        let head = self.head();
        self.out.write_all(&head)?;
        self.out.flush()?;
        Ok(self.out)
    }

    fn chunk(&mut self, name: [u8; 4], data: &[u8]) -> io::Result<()> {
        // With the index entry, and a byte that makes the length even.
        let whole = u64::from(self.movi) + data.len() as u64 + 16 * (self.entries.len() as u64 + 1) + 1024;
        if whole > MOST_BYTES {
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, "an AVI file has at most 2 GiB"));
        }
        let bytes = chunk(name, data);
        self.out.write_all(&bytes)?;
        self.entries.push(Entry { name, offset: self.movi, bytes: data.len() as u32 });
        self.movi += bytes.len() as u32;
        self.largest = self.largest.max(data.len() as u32);
        Ok(())
    }

    /// All before the first chunk, of the same length at the beginning and at the end.
    fn head(&self) -> Vec<u8> {
        let lists = list(*b"hdrl", &[self.main(), self.video(), self.audio()].concat());
        // "RIFF", length, "AVI "; then the lists, `movi` with "LIST" and its length, and the index with its.
        let index = 8 + 16 * self.entries.len() as u32;
        let mut head = b"RIFF".to_vec();
        head.extend((4 + lists.len() as u32 + 8 + self.movi + index).to_le_bytes());
        head.extend(b"AVI ");
        head.extend(lists);
        head.extend(b"LIST");
        head.extend(self.movi.to_le_bytes());
        head.extend(b"movi");
        head
    }

    /// `AVIMAINHEADER`.
    fn main(&self) -> Vec<u8> {
        let AviFormat { size: [width, height], fps, rate } = self.format;
        let a_second = self.largest.saturating_mul(fps).saturating_add(rate * SAMPLE_BYTES);
        let fields = [1_000_000 / fps, a_second, 0, FLAGS, self.frames, 0, 2, self.largest, width, height, 0, 0, 0, 0];
        chunk(*b"avih", &words(&fields))
    }

    /// `AVISTREAMHEADER` and `BITMAPINFOHEADER` of the pictures.
    fn video(&self) -> Vec<u8> {
        let AviFormat { size: [width, height], fps, .. } = self.format;
        let mut stream = b"vidsMJPG".to_vec();
        // Flags; priority and language; first frame; scale and rate; start; length; buffer; quality (−1: as it is); sample size.
        stream.extend(words(&[0, 0, 0, 1, fps, 0, self.frames, self.largest, u32::MAX, 0]));
        stream.extend(frame([width, height]));
        // Its own length; width; height; planes and bits a pixel.
        let mut look = words(&[40, width, height, 1 | (24 << 16)]);
        look.extend(b"MJPG");
        look.extend(words(&[width * height * 3, 0, 0, 0, 0]));
        list(*b"strl", &[chunk(*b"strh", &stream), chunk(*b"strf", &look)].concat())
    }

    /// `AVISTREAMHEADER` and `PCMWAVEFORMAT` of the sound.
    fn audio(&self) -> Vec<u8> {
        let rate = self.format.rate;
        let a_second = rate * SAMPLE_BYTES;
        let mut stream = b"auds".to_vec();
        // No handler; then as above, counted in samples.
        stream.extend(words(&[0, 0, 0, 0, 1, rate, 0, self.samples, a_second, u32::MAX, SAMPLE_BYTES]));
        stream.extend(frame([0, 0]));
        // PCM (1), two channels; rate; bytes a second; bytes and bits a sample.
        let look = words(&[1 | (2 << 16), rate, a_second, SAMPLE_BYTES | (16 << 16)]);
        list(*b"strl", &[chunk(*b"strh", &stream), chunk(*b"strf", &look)].concat())
    }
}

/// `rcFrame`: where on the screen the stream is.
fn frame([width, height]: [u32; 2]) -> Vec<u8> {
    [0, 0, width as u16, height as u16].iter().flat_map(|side| side.to_le_bytes()).collect()
}

fn words(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// A chunk: name, length, data, and a byte that makes the length even.
fn chunk(name: [u8; 4], data: &[u8]) -> Vec<u8> {
    let mut bytes = name.to_vec();
    bytes.extend((data.len() as u32).to_le_bytes());
    bytes.extend(data);
    bytes.resize(bytes.len() + data.len() % 2, 0);
    bytes
}

fn list(name: [u8; 4], data: &[u8]) -> Vec<u8> {
    chunk(*b"LIST", &[&name, data].concat())
}
