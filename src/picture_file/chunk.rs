//! A text inside a PNG: an iTXt chunk with the keyword `lensrunner`, compressed, before the picture's data (PNG specification, third
//! edition, 11.3.3).

use std::io::{BufReader, ErrorKind, Read};
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::read::{ZlibDecoder, ZlibEncoder};

use crate::user_file;

/// The keyword of our text.
const KEYWORD: &[u8] = b"lensrunner";
/// The most bytes of a chunk of ours, and of its text: hours of flight are less than a tenth of it.
pub const MOST_BYTES: u64 = 32 << 20;
/// The most bytes of a picture's file.
pub const MOST_PICTURE: u64 = 1 << 30;
/// What a PNG begins with.
const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";
/// Signature and header chunk: what follows it may be any chunk.
const HEAD: usize = 8 + 12 + 13;

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
    /// It is something else.
    #[error("{}: it is no PNG", .0.display())]
    NoPng(PathBuf),
    /// A PNG without our text.
    #[error("{}: it carries no moment of a flight: it is no picture of this game, or another program has written it anew", .0.display())]
    NoText(PathBuf),
    /// It ends before our text does, or before its own end.
    #[error("{}: it is cut off", .0.display())]
    CutOff(PathBuf),
    /// The text is there and damaged.
    #[error("{}: the moment that it carries is damaged: {problem}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: &'static str,
    },
}

/// The PNG file `png` with a text in it; unchanged if it is none.
pub fn with_text(mut png: Vec<u8>, text: &str) -> Vec<u8> {
    if png.len() < HEAD {
        return png;
    }
    // Keyword, its end, compressed by the one method there is (zlib), no language, no translation of the keyword.
    let mut body = [b"iTXt", KEYWORD, &[0, 1, 0, 0, 0]].concat();
    // Reading from memory does not fail.
    _ = ZlibEncoder::new(text.as_bytes(), Compression::best()).read_to_end(&mut body);
    let length = (body.len() - 4) as u32;
    let sum = crc32fast::hash(&body);
    let chunk = [&length.to_be_bytes()[..], &body, &sum.to_be_bytes()].concat();
    png.splice(HEAD..HEAD, chunk);
    png
}

/// The text in the PNG file `path`. Other chunks are passed over and never read.
pub fn read_text(path: &Path) -> Result<String, TextError> {
    let failed = |source: std::io::Error| match source.kind() {
        ErrorKind::UnexpectedEof => TextError::CutOff(path.to_path_buf()),
        _ => TextError::Read { path: path.to_path_buf(), source },
    };
    let damaged = |problem| TextError::Damaged { path: path.to_path_buf(), problem };
    let (file, end) = user_file::open(path, MOST_PICTURE).map_err(|fault| failed(fault.into()))?;
    let mut file = BufReader::new(file);
    let mut signature = [0; 8];
    match file.read_exact(&mut signature) {
        Ok(()) if signature == SIGNATURE => (),
        Err(error) if error.kind() != ErrorKind::UnexpectedEof => return Err(failed(error)),
        _ => return Err(TextError::NoPng(path.to_path_buf())),
    }
    let mut at = signature.len() as u64;
    loop {
        let mut head = [0; 8];
        file.read_exact(&mut head).map_err(failed)?;
        let [length, kind] = [0, 4].map(|from| [head[from], head[from + 1], head[from + 2], head[from + 3]]);
        let length = u64::from(u32::from_be_bytes(length));
        at += head.len() as u64;
        let after = at + length + 4;
        if !kind.iter().all(u8::is_ascii_alphabetic) {
            return Err(damaged("a chunk of the picture has no name"));
        }
        if after > end {
            return Err(TextError::CutOff(path.to_path_buf()));
        }
        if &kind == b"IEND" {
            return Err(TextError::NoText(path.to_path_buf()));
        }
        if matches!(&kind, b"iTXt" | b"zTXt") && length > KEYWORD.len() as u64 {
            let mut keyword = [0; KEYWORD.len() + 1];
            file.read_exact(&mut keyword).map_err(failed)?;
            at += keyword.len() as u64;
            if &keyword[..KEYWORD.len()] == KEYWORD && keyword[KEYWORD.len()] == 0 {
                if length > MOST_BYTES {
                    return Err(damaged("it is too long"));
                }
                let mut rest = vec![0; length as usize - keyword.len()];
                file.read_exact(&mut rest).map_err(failed)?;
                let mut sum = [0; 4];
                file.read_exact(&mut sum).map_err(failed)?;
                let found = crc32fast::hash(&[&kind[..], &keyword, &rest].concat());
                if u32::from_be_bytes(sum) != found {
                    return Err(damaged("its checksum is another one"));
                }
                return text_of(kind == *b"iTXt", &rest).map_err(damaged);
            }
        }
        // What has been read ahead is kept: there may be many small chunks.
        file.seek_relative((after - at) as i64).map_err(failed)?;
        at = after;
    }
}

/// The text in what follows the keyword of an iTXt or a zTXt chunk.
fn text_of(international: bool, rest: &[u8]) -> Result<String, &'static str> {
    const MALFORMED: &str = "it is malformed";
    let (is_packed, packed) = if international {
        let (flags, named) = rest.split_at_checked(2).ok_or(MALFORMED)?;
        // Past language and translated keyword, each ended by a zero.
        let text = named.splitn(3, |byte| *byte == 0).nth(2).ok_or(MALFORMED)?;
        (flags[0] == 1, text)
    } else {
        (true, rest.get(1..).ok_or(MALFORMED)?)
    };
    let mut text = Vec::new();
    if is_packed {
        ZlibDecoder::new(packed).take(MOST_BYTES + 1).read_to_end(&mut text).map_err(|_| MALFORMED)?;
    } else {
        text.extend(packed);
    }
    if text.len() as u64 > MOST_BYTES {
        return Err("it is too long");
    }
    String::from_utf8(text).map_err(|_| MALFORMED)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU32, Ordering};

    const TEXT: &str = "a = 1\nb = \"β ≥ 0\"\n";

    fn plain() -> Vec<u8> {
        let mut png = Vec::new();
        let encoder = image::codecs::png::PngEncoder::new(&mut png);
        image::ImageEncoder::write_image(encoder, &[7; 12], 2, 2, image::ExtendedColorType::Rgb8).expect("a picture in memory");
        png
    }

    /// What is read from a file of these bytes.
    fn read(bytes: &[u8]) -> Result<String, TextError> {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let name = format!("lensrunner-chunk-{}-{}.png", std::process::id(), NEXT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        std::fs::write(&path, bytes).expect("a file");
        let text = read_text(&path);
        _ = std::fs::remove_file(&path);
        text
    }

    /// A chunk, made by hand.
    fn chunk(kind: &[u8], data: &[u8]) -> Vec<u8> {
        let body = [kind, data].concat();
        [&(data.len() as u32).to_be_bytes()[..], &body, &crc32fast::hash(&body).to_be_bytes()].concat()
    }

    fn packed(text: &[u8]) -> Vec<u8> {
        let mut packed = Vec::new();
        ZlibEncoder::new(text, Compression::best()).read_to_end(&mut packed).expect("memory");
        packed
    }

    #[test]
    fn a_text_comes_back_and_the_picture_stays() {
        let png = with_text(plain(), TEXT);
        assert_eq!(read(&png).expect("the text"), TEXT);
        let picture = image::load_from_memory(&png).expect("a PNG still").to_rgb8();
        assert_eq!(picture.as_raw(), &[7; 12]);
        // As others may write it: after the data, plain or as zTXt.
        let end = plain().len() - 12;
        let mut late = plain();
        late.splice(end..end, chunk(b"iTXt", &[b"lensrunner\0\0\0en\0Flug\0", TEXT.as_bytes()].concat()));
        assert_eq!(read(&late).expect("the text"), TEXT);
        let mut old = plain();
        old.splice(HEAD..HEAD, chunk(b"zTXt", &[b"lensrunner\0\0", &packed(b"abc")[..]].concat()));
        assert_eq!(read(&old).expect("the text"), "abc");
    }

    #[test]
    fn each_damage_has_its_error() {
        let good = with_text(plain(), TEXT);
        let of = |data: &[u8]| {
            let mut png = plain();
            png.splice(HEAD..HEAD, chunk(b"iTXt", data));
            png
        };
        let mut flipped = good.clone();
        flipped[HEAD + 30] ^= 4;
        let mut long = good.clone();
        long[HEAD] = 0x7f;
        let huge = packed(&vec![b'a'; 100 << 20]);
        let cases: [(&str, Vec<u8>, &str); 13] = [
            ("a plain PNG", plain(), "carries no moment"),
            ("nothing", Vec::new(), "no PNG"),
            ("a text file", b"snapshot = 1, and more of that".to_vec(), "no PNG"),
            ("the beginning", good[..HEAD + 40].to_vec(), "cut off"),
            ("only a header", good[..HEAD].to_vec(), "cut off"),
            ("a flipped bit", flipped, "checksum"),
            ("a length beyond the end", long, "cut off"),
            ("no end", plain()[..plain().len() - 12].to_vec(), "cut off"),
            ("100 MiB of text, packed", of(&[b"lensrunner\0\x01\0\0\0", &huge[..]].concat()), "too long"),
            ("100 MiB of text", of(&[b"lensrunner\0\0\0\0\0", &vec![b'a'; 100 << 20][..]].concat()), "too long"),
            ("zeros without end", [&plain()[..HEAD], &vec![0; 50 << 20]].concat(), "a chunk of the picture has no name"),
            ("no DEFLATE", of(b"lensrunner\0\x01\0\0\0not packed"), "malformed"),
            ("no UTF-8", of(b"lensrunner\0\0\0\0\0\xff\xfe"), "malformed"),
        ];
        for (what, bytes, told) in cases {
            let said = read(&bytes).expect_err(what).to_string();
            assert!(said.contains(".png: ") && said.contains(told), "{what}: {said}");
        }
        assert!(read_text(Path::new("nowhere.png")).expect_err("no file").to_string().starts_with("nowhere.png: "));
    }
}
