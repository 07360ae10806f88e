//! Changes that keep enough of a file's form to get behind its first check: lines and values of texts, checksums of tables and replays,
//! lengths in a binary glTF.

use std::io::Read as _;

use data_encoding::BASE64;
use flate2::Compression;
use flate2::read::{ZlibDecoder, ZlibEncoder};
use libfuzzer_sys::fuzzer_mutate;

/// Chance, as libFuzzer's seed has it.
struct Chance(u64);

impl Chance {
    fn new(seed: u32) -> Chance {
        Chance(u64::from(seed).wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// A number below `end`, which is above 0.
    fn below(&mut self, end: usize) -> usize {
        // Xorshift (Marsaglia 2003).
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % end.max(1)
    }

    fn of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }
}

/// Values that are often at an edge.
const VALUES: &str = "0|-0.0|1|-1|2|0.5|nan|inf|-inf|1e308|-1e308|1e-308|5e-324|1e9|1e6|1000000|0.001|9223372036854775807|\
    -9223372036854775808|18446744073709551616|4294967295|4294967296|65536|255|0x7fff|true|false|\"\"|\"x\"|\"\\u0000\"|\"hunter\"|\
    \"quarry\"|\"hunter.glb\"|\"/dev/zero\"|\"..\"|[]|{}|[[]]|[0.0, 0.0, 0.0]|[nan, nan, nan]|[1e308, 1e308, 1e308]|[1.0, 0.0, 0.0]|\
    [1, 1, 1]|[200, 200, 5]|[1.0, 2.0]|[1.0, 0.0, 0.0, 0.0]|1979-05-27T07:32:00Z|'''x'''|none|null|-|,|=|.|\u{feff}|β";

fn value(chance: &mut Chance) -> &'static str {
    let count = VALUES.split('|').count();
    VALUES.split('|').nth(chance.below(count)).unwrap_or_default()
}

/// What texts are made of: files of the game, and the examples of its documents.
const SOURCES: &[&str] = &[
    include_str!("../../game.toml"),
    include_str!("../../docs/scenes.md"),
    include_str!("../../docs/missions.md"),
    include_str!("../../assets/scenes/chase.toml"),
    include_str!("../../assets/scenes/aurora-lensed.toml"),
    include_str!("../../assets/missions/01-training.toml"),
    include_str!("../../assets/missions/09-two-of-them.toml"),
    include_str!("../../assets/replays/01-training-naive.toml"),
];

/// Puts `new` in the place of the data, if it fits; the new size.
fn put(data: &mut [u8], size: usize, most: usize, new: &[u8]) -> usize {
    if new.len() > most || new.len() > data.len() {
        return size;
    }
    data[..new.len()].copy_from_slice(new);
    new.len()
}

/// Bytes as libFuzzer itself changes them.
fn plain(bytes: &[u8], most: usize) -> Vec<u8> {
    let mut room = bytes.to_vec();
    room.resize(most.max(bytes.len()), 0);
    let size = fuzzer_mutate(&mut room, bytes.len(), most);
    room.truncate(size);
    room
}

/// Lines and values of a text; half of the time its bytes.
pub fn text(data: &mut [u8], size: usize, most: usize, seed: u32) -> usize {
    let mut chance = Chance::new(seed);
    if chance.below(2) == 0 {
        return fuzzer_mutate(data, size, most);
    }
    let new = lines(&data[..size], &mut chance);
    put(data, size, most, &new)
}

fn lines(bytes: &[u8], chance: &mut Chance) -> Vec<u8> {
    let mut lines: Vec<Vec<u8>> = bytes.split(|byte| *byte == b'\n').map(<[u8]>::to_vec).collect();
    for _ in 0..=chance.below(3) {
        let place = chance.below(lines.len());
        match chance.below(8) {
            0 if lines.len() > 1 => drop(lines.remove(place)),
            1 => {
                // A line or the lines of an entry, again.
                let end = (place + 1 + chance.below(6)).min(lines.len());
                let again: Vec<Vec<u8>> = (0..=chance.below(4)).flat_map(|_| lines[place..end].to_vec()).collect();
                lines.splice(place..place, again);
            }
            2 => {
                let other = chance.below(lines.len());
                lines.swap(place, other);
            }
            3 => {
                let source: Vec<&str> = chance.of(SOURCES).lines().collect();
                let first = chance.below(source.len());
                let end = (first + 1 + chance.below(5)).min(source.len());
                lines.splice(place..place, source[first..end].iter().map(|line| line.as_bytes().to_vec()));
            }
            4 => {
                // The key of one line with the value of another.
                let other = lines[chance.below(lines.len())].clone();
                if let (Some(here), Some(there)) = (equals(&lines[place]), equals(&other)) {
                    lines[place].splice(here.., other[there..].iter().copied());
                }
            }
            5 => {
                if let Some(at) = equals(&lines[place]) {
                    lines[place].splice(at + 1.., value(chance).bytes());
                }
            }
            _ => lines[place] = token(&lines[place], chance),
        }
    }
    lines.join(&b'\n')
}

fn equals(line: &[u8]) -> Option<usize> {
    line.iter().position(|byte| *byte == b'=')
}

/// A text with one of its words or numbers replaced.
fn token(text: &[u8], chance: &mut Chance) -> Vec<u8> {
    let is_word = |byte: u8| byte.is_ascii_alphanumeric() || b"_-+.\"".contains(&byte);
    let mut starts: Vec<usize> = (0..text.len()).filter(|&at| is_word(text[at]) && (at == 0 || !is_word(text[at - 1]))).collect();
    if starts.is_empty() {
        starts.push(text.len());
    }
    let start = chance.of(&starts);
    let end = start + text[start..].iter().take_while(|byte| is_word(**byte)).count();
    [&text[..start], value(chance).as_bytes(), &text[end..]].concat()
}

/// A table: its header, sizes and values, with the checksum made right.
pub fn table(data: &mut [u8], size: usize, most: usize, seed: u32) -> usize {
    let mut chance = Chance::new(seed);
    let mut new = data[..size].to_vec();
    if new.len() > 140 && chance.below(2) == 0 {
        // One of version, sizes, ranges, count; or some value.
        let at = match chance.below(4) {
            0 => 8 + 4 * chance.below(8),
            1 => 40 + 8 * chance.below(6),
            2 => 120,
            _ => 128 + 4 * chance.below((new.len() - 136) / 4),
        };
        let value = chance.of(&[0, 1, 5, 6, 7, 4096, 4097, u32::MAX, f32::NAN.to_bits(), f32::INFINITY.to_bits(), 1e6f32.to_bits()]);
        new[at..at + 4].copy_from_slice(&value.to_le_bytes());
    } else {
        new = plain(&new, most);
    }
    if let Some(end) = new.len().checked_sub(4)
        && chance.below(16) > 0
    {
        let sum = crc32fast::hash(&new[..end]);
        new[end..].copy_from_slice(&sum.to_le_bytes());
    }
    put(data, size, most, &new)
}

/// A model: its JSON or its binary part, with the lengths made right.
pub fn model(data: &mut [u8], size: usize, most: usize, seed: u32) -> usize {
    let mut chance = Chance::new(seed);
    let Some((mut json, mut binary)) = parts(&data[..size]) else { return text(data, size, most, seed) };
    match chance.below(6) {
        0 => return fuzzer_mutate(data, size, most),
        1 => json = plain(&json, most),
        2 => binary = plain(&binary, most),
        3 => {
            // An object or a list, again or not at all.
            let opens: Vec<usize> = (0..json.len()).filter(|&at| b"{[".contains(&json[at])).collect();
            let start = if opens.is_empty() { 0 } else { chance.of(&opens) };
            let end = closing(&json, start);
            let again = [b",", &json[start..end]].concat().repeat(chance.below(3));
            json.splice(if again.is_empty() { start..end } else { end..end }, again);
        }
        _ => json = token(&json, &mut chance),
    }
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let word = |number: usize| (number as u32).to_le_bytes();
    let length = 12 + 8 + json.len() + 8 + binary.len();
    let mut new = [b"glTF", &word(2)[..], &word(length), &word(json.len()), b"JSON", &json].concat();
    new.extend([&word(binary.len())[..], b"BIN\0", &binary].concat());
    put(data, size, most, &new)
}

/// JSON and binary part of a binary glTF.
fn parts(bytes: &[u8]) -> Option<(Vec<u8>, Vec<u8>)> {
    let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?) as usize);
    bytes.starts_with(b"glTF").then_some(())?;
    let end = word(12)?.checked_add(20)?;
    let json = bytes.get(20..end)?.to_vec();
    Some((json, bytes.get(end + 8..).unwrap_or_default().to_vec()))
}

/// Where what opens at `start` ends.
fn closing(json: &[u8], start: usize) -> usize {
    let mut depth = 0usize;
    for (at, byte) in json.iter().enumerate().skip(start) {
        match byte {
            b'{' | b'[' => depth += 1,
            b'}' | b']' => depth = depth.saturating_sub(1),
            _ => (),
        }
        if depth == 0 {
            return at + 1;
        }
    }
    json.len()
}

/// A replay: its lines or its packed log, with the checksum made right.
pub fn replay(data: &mut [u8], size: usize, most: usize, seed: u32) -> usize {
    let mut chance = Chance::new(seed);
    let new = changed_replay(&data[..size], most, &mut chance);
    put(data, size, most, &new)
}

fn changed_replay(bytes: &[u8], most: usize, chance: &mut Chance) -> Vec<u8> {
    let mut new = match chance.below(4) {
        0 => plain(bytes, most),
        1 | 2 => lines(bytes, chance),
        _ => with_log(bytes, most).unwrap_or_else(|| lines(bytes, chance)),
    };
    if chance.below(16) > 0 {
        let check = b"check = ";
        let end = new.windows(check.len()).position(|part| part == check).unwrap_or(new.len());
        new.truncate(end);
        let sum = crc32fast::hash(&new);
        new.extend(format!("check = \"{sum:08x}\"\n").bytes());
    }
    new
}

/// The replay with its log unpacked, changed and packed again; None if it has none.
fn with_log(bytes: &[u8], most: usize) -> Option<Vec<u8>> {
    let text = str::from_utf8(bytes).ok()?;
    let start = text.find("log = \"")? + 7;
    let end = start + text[start..].find('"')?;
    let mut raw = Vec::new();
    ZlibDecoder::new(&BASE64.decode(&bytes[start..end]).ok()?[..]).take(1 << 20).read_to_end(&mut raw).ok()?;
    let raw = plain(&raw, most);
    let mut packed = Vec::new();
    ZlibEncoder::new(&raw[..], Compression::fast()).read_to_end(&mut packed).ok()?;
    Some([&text[..start], &BASE64.encode(&packed), &text[end..]].concat().into_bytes())
}

/// A moment: its lines, or the replay in it, whose lines are written in one.
pub fn moment(data: &mut [u8], size: usize, most: usize, seed: u32) -> usize {
    let mut chance = Chance::new(seed);
    let whole = String::from_utf8_lossy(&data[..size]).into_owned();
    let flight = whole.find("flight = '''\n").map(|at| at + 13).and_then(|start| Some((start, start + whole[start..].find("'''")?)));
    let new = match flight {
        Some((start, end)) if chance.below(2) == 0 => {
            let replay = changed_replay(&whole.as_bytes()[start..end], most, &mut chance);
            [&whole.as_bytes()[..start], &replay, &whole.as_bytes()[end..]].concat()
        }
        Some((start, _)) if chance.below(3) > 0 => {
            [lines(&whole.as_bytes()[..start], &mut chance), whole.as_bytes()[start..].to_vec()].concat()
        }
        _ => return text(data, size, most, seed),
    };
    put(data, size, most, &new)
}
