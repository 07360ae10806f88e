//! A replay as the end of an address, `#flight=…`: its values without their keys and what goes without saying, DEFLATE,
//! Base64 for addresses.

use std::io::Read as _;
use std::path::Path;

use data_encoding::BASE64URL_NOPAD;
use flate2::{Compression, read::ZlibDecoder, read::ZlibEncoder};

use super::{Replay, ReplayError};
use crate::scene::GameConfig;
use crate::scene::config;

/// What a link begins with, behind the page's address.
pub const MARK: &str = "#flight=";
/// The most characters of a link: programs that hand addresses on cut those longer than 2,048, with the page's own before it.
pub const MOST_LINK: usize = 1900;
/// The most bytes of a replay's text in a link.
const MOST_TEXT: u64 = 64 << 10;
/// The lines of that text, in their order.
const KEYS: [&str; 13] =
    ["replay", "version", "scene", "fingerprint", "difficulty", "pilot", "seed", "ticks", "outcome", "hash", "settings", "log", "check"];

impl Replay {
    /// The link, or how many characters it would have where that is too many.
    pub fn to_link(&self) -> Result<String, usize> {
        let usual = GameConfig::default();
        let is_usual = |path: &str, value| config::setting(path).is_some_and(|setting| setting.get(&usual) == value);
        let settings = self.settings.iter().filter(|(path, value)| !is_usual(path, value.clone())).cloned().collect();
        let text = Replay { settings, ..self.clone() }.to_text();
        let values: Vec<&str> = text.lines().filter_map(|line| Some(line.split_once(" = ")?.1)).collect();
        let mut packed = Vec::new();
        // Reading from memory does not fail.
        _ = ZlibEncoder::new(values.join("\n").as_bytes(), Compression::best()).read_to_end(&mut packed);
        let link = format!("{MARK}{}", BASE64URL_NOPAD.encode(&packed));
        if link.len() > MOST_LINK { Err(link.len()) } else { Ok(link) }
    }

    /// The replay of a link, or of an address that ends in one. Complaints call it "the link".
    pub fn from_link(address: &str) -> Result<Replay, ReplayError> {
        let path = Path::new("the link");
        let damaged = |problem: &str| ReplayError::Damaged { path: path.to_path_buf(), problem: problem.into() };
        let code = address.split_once(MARK).ok_or_else(|| damaged("it has no flight: \"#flight=\" is missing"))?.1.trim();
        if code.len() > MOST_LINK {
            return Err(damaged(&format!("it has {} characters, allowed are at most {MOST_LINK}", code.len())));
        }
        let cut = || damaged("it is cut or changed: its letters are no flight");
        let packed = BASE64URL_NOPAD.decode(code.as_bytes()).map_err(|_| cut())?;
        let mut values = String::new();
        ZlibDecoder::new(&packed[..]).take(MOST_TEXT).read_to_string(&mut values).map_err(|_| cut())?;
        let text: Vec<String> = KEYS.iter().zip(values.lines()).map(|(key, value)| format!("{key} = {value}\n")).collect();
        let replay = Replay::from_text(path, &text.concat())?;
        // What was left out is as usual, in the order in which flights have it.
        let usual = GameConfig::default();
        let all = config::settings().iter().filter(|setting| super::SECTIONS.contains(&setting.section));
        let settings = all.map(|setting| {
            let said = replay.settings.iter().find(|(path, _)| *path == setting.path());
            said.cloned().unwrap_or_else(|| (setting.path(), setting.get(&usual)))
        });
        Ok(Replay { settings: settings.collect(), ..replay })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::game_files::GameFile;
    use crate::scene::Difficulty;
    use crate::scene::pilot_kind::PilotKind;
    use crate::sim::player_commands::PlayerCommands;
    use crate::sim::replay::Record;

    fn flight(records: u64) -> Replay {
        let scene = crate::scene::load("01-training").expect("the game's own");
        let mut replay = Replay::begin(&scene, &GameConfig::default(), Difficulty::Normal, PilotKind::Expert, 5);
        // As irregular as a hand.
        let chance = |k: u64| crc32fast::hash(&k.to_le_bytes()).to_le_bytes();
        let commands = |k: u64| PlayerCommands { thrust: [chance(k)[0] as i8, 0, chance(k)[1] as i8], ..PlayerCommands::default() };
        replay.records = (0..records).map(|k| Record { tick: 7 * k + u64::from(chance(k)[2] % 7), commands: commands(k) }).collect();
        (replay.ticks, replay.hash) = (7 * records + 1, "0123456789abcdef".into());
        replay
    }

    #[test]
    fn a_link_is_the_same_flight() {
        for records in [0, 20, 60] {
            let replay = flight(records);
            let link = replay.to_link().expect("short enough");
            assert!(link.len() <= MOST_LINK);
            assert_eq!(Replay::from_link(&format!("https://example.org/game/{link}")).expect("a flight"), replay, "{records}");
        }
        let mut other = flight(3);
        let (path, value) = &mut other.settings[2];
        *value = config::setting(path).expect("a setting").read("false").expect("a switch");
        assert_eq!(Replay::from_link(&other.to_link().expect("short")).expect("a flight"), other);
        assert!(flight(2_000).to_link().expect_err("too long") > MOST_LINK);
        // As the game comes with them.
        for name in crate::game_files::names("assets/replays") {
            let replay = Replay::load(&GameFile::at(Path::new(&name)).path).expect("a replay");
            let link = replay.to_link().expect("short enough");
            assert!(link.len() < 800 && Replay::from_link(&link).expect("a flight") == replay, "{name}: {}", link.len());
        }
    }

    #[test]
    fn what_is_no_link_is_refused_in_a_sentence() {
        let link = flight(40).to_link().expect("short enough");
        let cut = &link[..link.len() - 9];
        let mut changed = link.clone().into_bytes();
        changed[60] = if changed[60] == b'A' { b'B' } else { b'A' };
        let changed = String::from_utf8(changed).expect("letters");
        let long = format!("{MARK}{}", "A".repeat(MOST_LINK + 1));
        for (wrong, said) in
            [("https://example.org/", "missing"), (cut, "cut"), (&changed, ""), (&long, "at most 1900"), ("#flight=日本", "cut")]
        {
            let error = Replay::from_link(wrong).expect_err("no link").to_string();
            assert!(error.starts_with("the link: ") && error.contains(said) && error.len() < 300, "{error}");
        }
    }
}
