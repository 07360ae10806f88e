//! The text inside a PNG: an iTXt chunk with the keyword `lensrunner`, compressed (PNG specification, third edition, 11.3.3).

use std::io::{BufReader, ErrorKind};
use std::path::{Path, PathBuf};

use png::text_metadata::ITXtChunk;
use png::{DecodeOptions, Decoder, DecodingError};

use crate::user_file;

/// The keyword of our text.
const KEYWORD: &str = "lensrunner";
/// The most bytes of our text: hours of flight are less than a tenth of it.
pub const MOST_BYTES: u64 = 32 << 20;
/// The most bytes of a picture's file.
pub const MOST_PICTURE: u64 = 1 << 30;

/// Why a picture's text cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum TextError {
    /// The file cannot be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// It is something else, or damaged.
    #[error("{}: it cannot be read as a PNG: {problem}", path.display())]
    NoPng {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: DecodingError,
    },
    /// A PNG without our text.
    #[error("{}: it carries no moment of a flight: it is no picture of this game, or another program has written it anew", .0.display())]
    NoText(PathBuf),
    /// It ends before its own end.
    #[error("{}: it is cut off", .0.display())]
    CutOff(PathBuf),
    /// The text is there, and cannot be unpacked.
    #[error("{}: the moment that it carries is damaged: allowed is packed UTF-8 of at most {MOST_BYTES} bytes", .0.display())]
    Damaged(PathBuf),
}

/// The chunk of a text.
pub(super) fn chunk(text: &str) -> ITXtChunk {
    let mut chunk = ITXtChunk::new(KEYWORD, text);
    chunk.compressed = true;
    chunk
}

/// The text in the PNG file `path`. The picture itself is not decoded.
pub fn read_text(path: &Path) -> Result<String, TextError> {
    let failed = |problem| match problem {
        DecodingError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => TextError::CutOff(path.to_path_buf()),
        DecodingError::IoError(source) => TextError::Read { path: path.to_path_buf(), source },
        problem => TextError::NoPng { path: path.to_path_buf(), problem },
    };
    let (file, _) = user_file::open(path, MOST_PICTURE).map_err(|fault| failed(DecodingError::IoError(fault.into())))?;
    // A damaged text is an error, and not as if there were none. What a chunk may take is limited by the decoder, to 64 MiB.
    let mut options = DecodeOptions::default();
    options.set_skip_ancillary_crc_failures(false);
    let mut reader = Decoder::new_with_options(BufReader::new(file), options).read_info().map_err(failed)?;
    // The game writes it before the picture's data; another program may have moved it behind them.
    reader.finish().map_err(failed)?;
    let mut chunk =
        reader.info().utf8_text.iter().find(|text| text.keyword == KEYWORD).cloned().ok_or(TextError::NoText(path.to_path_buf()))?;
    let text = chunk.decompress_text_with_limit(MOST_BYTES as usize).and_then(|()| chunk.get_text());
    text.map_err(|_| TextError::Damaged(path.to_path_buf()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read as _;
    use std::sync::atomic::{AtomicU32, Ordering};

    use flate2::{Compression, read::ZlibEncoder};

    use crate::picture_file::png;

    const TEXT: &str = "a = 1\nb = \"β ≥ 0\"\n";
    /// Signature and header: what follows may be any chunk.
    const HEAD: usize = 8 + 12 + 13;

    fn picture(text: Option<&str>) -> Vec<u8> {
        png(&[7; 12], [2, 2], false, text).expect("a picture in memory")
    }

    /// What is read from a file of these bytes.
    fn read(bytes: &[u8]) -> Result<String, TextError> {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let name = format!("lensrunner-text-{}-{}.png", std::process::id(), NEXT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        std::fs::write(&path, bytes).expect("a file");
        let text = read_text(&path);
        _ = std::fs::remove_file(&path);
        text
    }

    /// A picture with a chunk iTXt of this data at a place.
    fn with_chunk(at: usize, data: &[u8]) -> Vec<u8> {
        let body = [b"iTXt", data].concat();
        let chunk = [&(data.len() as u32).to_be_bytes()[..], &body, &crc32fast::hash(&body).to_be_bytes()].concat();
        let mut png = picture(None);
        png.splice(at..at, chunk);
        png
    }

    #[test]
    fn a_text_comes_back_and_the_picture_stays() {
        let png = picture(Some(TEXT));
        assert_eq!(read(&png).expect("the text"), TEXT);
        let picture_again = image::load_from_memory(&png).expect("a PNG still").to_rgb8();
        assert_eq!(picture_again.as_raw(), &[7; 12]);
        // As others may write it: after the data, and plain.
        let late = with_chunk(picture(None).len() - 12, &[b"lensrunner\0\0\0en\0Flug\0", TEXT.as_bytes()].concat());
        assert_eq!(read(&late).expect("the text"), TEXT);
    }

    #[test]
    fn each_damage_has_its_error() {
        let (plain, good) = (picture(None), picture(Some(TEXT)));
        let mut flipped = good.clone();
        flipped[HEAD + 30] ^= 4;
        let mut long = good.clone();
        long[HEAD] = 0x7f;
        let mut huge = Vec::new();
        ZlibEncoder::new(&vec![b'a'; 100 << 20][..], Compression::best()).read_to_end(&mut huge).expect("memory");
        let of = |data: &[u8]| with_chunk(HEAD, data);
        let cases: [(&str, Vec<u8>, &str); 13] = [
            ("a plain PNG", plain.clone(), "carries no moment"),
            ("nothing", Vec::new(), "cut off"),
            ("a text file", b"snapshot = 1, and more of that".to_vec(), "cannot be read as a PNG"),
            ("the beginning", good[..HEAD + 40].to_vec(), "cut off"),
            ("only a header", good[..HEAD].to_vec(), "cut off"),
            ("a flipped bit", flipped, "CRC"),
            ("a length beyond the end", long, "cut off"),
            ("no end", plain[..plain.len() - 12].to_vec(), "cut off"),
            ("100 MiB of text, packed", of(&[b"lensrunner\0\x01\0\0\0", &huge[..]].concat()), "damaged"),
            ("100 MiB of text", of(&[b"lensrunner\0\0\0\0\0", &vec![b'a'; 100 << 20][..]].concat()), "limits are exceeded"),
            ("zeros without end", [&plain[..HEAD], &vec![0; 50 << 20]].concat(), "cannot be read as a PNG"),
            ("no DEFLATE", of(b"lensrunner\0\x01\0\0\0not packed"), "damaged"),
            ("no UTF-8", of(b"lensrunner\0\0\0\0\0\xff\xfe"), "carries no moment"),
        ];
        for (what, bytes, told) in cases {
            let said = read(&bytes).expect_err(what).to_string();
            assert!(said.contains(".png: ") && said.contains(told), "{what}: {said}");
        }
        assert!(read_text(Path::new("nowhere.png")).expect_err("no file").to_string().starts_with("nowhere.png: "));
    }
}
