//! Files that a person names: read within a limit, written whole or not at all. It imports no floor, and every floor may import it.

#[cfg(target_family = "wasm")]
mod page;

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

/// The most bytes of a text that a person writes: a scene, a mission, `game.toml`.
pub const MOST_TEXT: u64 = 4 << 20;

/// Characters of a text that are said of it.
const SAID: usize = 80;

/// Why a file is not read. It is said after the file's name.
#[derive(Debug, thiserror::Error)]
pub enum FileFault {
    /// The operating system refuses.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// A folder, a pipe, a device: what may have no end.
    #[error("it is {0}, allowed is a regular file")]
    Irregular(&'static str),
    /// Longer than is read.
    #[error("it has {bytes} bytes, allowed are at most {most}")]
    TooLong {
        /// Its length; of a file that does not say it, at least this.
        bytes: u64,
        /// The most that is read.
        most: u64,
    },
    /// A file of the game's own that is in none of its folders.
    #[error("it is in none of: {}inside the program", tried.iter().map(|path| format!("{}, ", visible(&path.to_string_lossy()))).collect::<String>())]
    Nowhere {
        /// The files that were looked for.
        tried: Vec<PathBuf>,
    },
    /// No text.
    #[error("line {line} is no text in UTF-8")]
    Text {
        /// The line, from 1.
        line: usize,
    },
}

impl From<FileFault> for io::Error {
    fn from(fault: FileFault) -> io::Error {
        match fault {
            FileFault::Io(error) => error,
            other @ FileFault::Nowhere { .. } => io::Error::new(io::ErrorKind::NotFound, other),
            other => io::Error::new(io::ErrorKind::InvalidData, other),
        }
    }
}

/// Opens a regular file of at most `most` bytes, and says how many it has.
pub fn open(path: &Path, most: u64) -> Result<(File, u64), FileFault> {
    // Asked before it is opened: a pipe would wait for somebody to write.
    let found = std::fs::metadata(path)?;
    if !found.is_file() {
        return Err(FileFault::Irregular(kind(found.file_type())));
    }
    let file = File::open(path)?;
    let bytes = file.metadata()?.len();
    if bytes > most { Err(FileFault::TooLong { bytes, most }) } else { Ok((file, bytes)) }
}

/// All bytes of a regular file, at most `most`.
pub fn read(path: &Path, most: u64) -> Result<Vec<u8>, FileFault> {
    #[cfg(target_family = "wasm")]
    return page::read(path, most);
    #[cfg(not(target_family = "wasm"))]
    read_disk(path, most)
}

#[cfg(not(target_family = "wasm"))]
fn read_disk(path: &Path, most: u64) -> Result<Vec<u8>, FileFault> {
    use std::io::Read as _;

    let (file, length) = open(path, most)?;
    let mut bytes = Vec::with_capacity(length as usize);
    // It may grow meanwhile.
    file.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(FileFault::TooLong { bytes: bytes.len() as u64, most }) } else { Ok(bytes) }
}

/// The text of a regular file, at most `most` bytes.
pub fn read_text(path: &Path, most: u64) -> Result<String, FileFault> {
    text_of(read(path, most)?)
}

/// The text that bytes are.
pub fn text_of(bytes: Vec<u8>) -> Result<String, FileFault> {
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        FileFault::Text { line: before.iter().filter(|byte| **byte == b'\n').count() + 1 }
    })
}

fn kind(found: std::fs::FileType) -> &'static str {
    if found.is_dir() {
        return "a folder";
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt as _;
        if found.is_fifo() {
            return "a pipe";
        }
        if found.is_socket() {
            return "a socket";
        }
    }
    "a device"
}

/// Writes a file so that it is either the old one or the new, whatever happens; its folder is made where there is none. To a device or a
/// pipe the bytes go at once.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    #[cfg(target_family = "wasm")]
    return page::write(path, bytes);
    #[cfg(not(target_family = "wasm"))]
    write_disk(path, bytes)
}

#[cfg(not(target_family = "wasm"))]
fn write_disk(path: &Path, bytes: &[u8]) -> io::Result<()> {
    std::fs::create_dir_all(path.parent().unwrap_or(Path::new("")))?;
    // Where a link leads the file is, not the link.
    let place = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    if std::fs::metadata(&place).is_ok_and(|found| !found.is_file()) {
        return std::fs::write(&place, bytes);
    }
    let beside = beside(&place);
    std::fs::write(&beside, bytes).and_then(|()| std::fs::rename(&beside, &place)).inspect_err(|_| {
        // What went wrong first is said.
        _ = std::fs::remove_file(&beside);
    })
}

/// Whether there is a file of this name.
pub fn exists(path: &Path) -> bool {
    #[cfg(target_family = "wasm")]
    return page::exists(path);
    #[cfg(not(target_family = "wasm"))]
    path.exists()
}

/// Gives a file another name.
pub fn rename(from: &Path, to: &Path) -> io::Result<()> {
    #[cfg(target_family = "wasm")]
    return page::rename(from, to);
    #[cfg(not(target_family = "wasm"))]
    std::fs::rename(from, to)
}

/// Whether the file can be written, asked before the work that it is for: its folder is made where there is none, and a file that is there
/// keeps what it holds.
pub fn check_writable(path: &Path) -> io::Result<()> {
    std::fs::create_dir_all(path.parent().unwrap_or(Path::new("")))?;
    let is_new = !path.exists();
    std::fs::OpenOptions::new().append(true).create(true).open(path)?;
    if is_new {
        std::fs::remove_file(path)?;
    }
    // Where it is written first.
    let place = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    if std::fs::metadata(&place).is_ok_and(|found| !found.is_file()) {
        return Ok(());
    }
    let beside = beside(&place);
    File::create(&beside).and_then(|_| std::fs::remove_file(&beside))
}

/// The file that is written first, which then takes the place of `path`: another one for each process.
pub fn beside(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.new", std::process::id()));
    path.with_file_name(name)
}

/// A writer to a file whose errors name it.
#[derive(Debug)]
pub struct Named<W> {
    /// The file.
    pub path: PathBuf,
    /// What writes to it.
    pub writer: W,
}

impl<W: io::Write> Named<W> {
    fn named<T>(&self, result: io::Result<T>) -> io::Result<T> {
        result.map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", self.path.display())))
    }
}

impl<W: io::Write> io::Write for Named<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let result = self.writer.write(bytes);
        self.named(result)
    }

    fn flush(&mut self) -> io::Result<()> {
        let result = self.writer.flush();
        self.named(result)
    }
}

/// A sentence about what somebody wrote, without the middle of what is longer than any that the program has to say by itself.
pub fn brief(message: &str) -> String {
    const LONGEST: usize = 1500;
    const END: usize = 600;
    if message.len() <= LONGEST {
        return message.to_owned();
    }
    let head = message.char_indices().nth(SAID).map_or(message, |(end, _)| &message[..end]);
    let tail = message.char_indices().rev().nth(END - 1).map_or("", |(start, _)| &message[start..]);
    format!("{head}… ({} bytes) …{tail}", message.len())
}

/// A text as it is said in an error: its first characters if it is long, in one line, with pictures (␊) for characters that control.
pub fn short(text: &str) -> String {
    let said: String = text.chars().take(SAID).map(shown).collect();
    if text.chars().nth(SAID).is_some() { format!("{said}… ({} bytes)", text.len()) } else { said }
}

/// A text in one line, with pictures for characters that control.
fn visible(text: &str) -> String {
    text.chars().map(shown).collect()
}

/// A character that can be seen.
fn shown(letter: char) -> char {
    match u32::from(letter) {
        code @ 0..0x20 => char::from_u32(0x2400 + code).unwrap_or(char::REPLACEMENT_CHARACTER),
        0x7f => '␡',
        0x80..0xa0 => char::REPLACEMENT_CHARACTER,
        _ => letter,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("lensrunner-user-file-{name}-{}", std::process::id()));
        _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).expect("a folder");
        folder
    }

    #[test]
    fn only_regular_files_within_the_limit_are_read() {
        let folder = folder("read");
        let file = folder.join("a");
        std::fs::write(&file, "one\ntwo\n").expect("a file");
        assert_eq!(read_text(&file, 8).expect("a text"), "one\ntwo\n");
        assert_eq!(read_text(&file, 7).expect_err("too long").to_string(), "it has 8 bytes, allowed are at most 7");
        assert!(read(&folder, 8).expect_err("a folder").to_string().contains("a folder"));
        std::fs::write(&file, b"one\ntwo\n\xff\n").expect("a file");
        assert_eq!(read_text(&file, 80).expect_err("no text").to_string(), "line 3 is no text in UTF-8");
        #[cfg(unix)]
        assert!(read(Path::new("/dev/zero"), 8).expect_err("without end").to_string().contains("a device"));
        // Twelve gigabytes that take no room.
        File::create(&file).and_then(|file| file.set_len(12 << 30)).expect("a file");
        assert!(matches!(read(&file, 1 << 20), Err(FileFault::TooLong { bytes, .. }) if bytes == 12 << 30));
        _ = std::fs::remove_dir_all(&folder);
    }

    #[test]
    fn a_file_is_written_whole_or_stays() {
        let folder = folder("write");
        let file = folder.join("deeper/a.png");
        write_whole(&file, b"old").expect("written");
        write_whole(&file, b"new").expect("written");
        assert_eq!(std::fs::read(&file).expect("it is there"), b"new");
        assert_eq!(std::fs::read_dir(folder.join("deeper")).expect("a folder").count(), 1, "nothing is left beside");
        #[cfg(target_os = "linux")]
        assert!(write_whole(Path::new("/dev/full"), b"new").is_err());
        // In the way of the file beside it is a folder.
        std::fs::create_dir(beside(&file)).expect("a folder");
        assert!(write_whole(&file, b"newer").is_err());
        assert_eq!(std::fs::read(&file).expect("it is there"), b"new");
        _ = std::fs::remove_dir_all(&folder);
    }

    #[test]
    fn long_texts_are_cut() {
        assert_eq!(short("β"), "β");
        assert_eq!(short("a\nb\t\u{7f}\u{9b}c"), "a␊b␉␡\u{fffd}c");
        assert_eq!(short(&"β".repeat(1000)), format!("{}… (2000 bytes)", "β".repeat(80)));
        let said = brief(&format!("k = {:?} is not known, allowed 1 to 3", "β".repeat(1_000_000)));
        assert!(said.starts_with("k = \"ββ") && said.ends_with("β\" is not known, allowed 1 to 3") && said.len() < 2000, "{said}");
    }
}
