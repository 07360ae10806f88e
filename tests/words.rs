//! The words of the game under `assets/words/`: letters that are there to write them, and nothing left out.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use bevy_egui::egui::{Context, FontData, FontDefinitions, FontFamily, FontId, RawInput};
use fluent_bundle::FluentResource;

use crate::support::root;

/// The files of a folder with this extension, by name.
fn files(folder: &str, extension: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().path());
    let mut found: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|found| found == extension)).collect();
    found.sort();
    assert!(!found.is_empty(), "no .{extension} in {folder}");
    found
}

/// If this fails, run `assets/fonts/make_japanese.py` again; its head says how.
#[test]
fn every_letter_of_the_words_is_in_the_font() {
    let font = std::fs::read(root().join("assets/fonts/japanese.otf")).unwrap();
    assert!(font.len() < 300 * 1024, "{} bytes", font.len());
    // What egui says it has is what comes from another font than its sign for missing letters: that is Hack's.
    let mut fonts = FontDefinitions::default();
    fonts.font_data.insert("japanese".into(), Arc::new(FontData::from_owned(font)));
    fonts.families.insert(FontFamily::Proportional, vec!["japanese".into(), "Hack".into()]);
    let context = Context::default();
    context.set_fonts(fonts);
    // Fonts are loaded with the first picture.
    let _ = context.run_ui(RawInput::default(), |_| ());
    let has = |letter: char| context.fonts_mut(|fonts| fonts.has_glyph(&FontId::proportional(14.0), letter));
    assert!(has('光') && has('ア') && has('A'), "the font is not read");
    // Of the second neither Hack has a picture.
    assert!(!has('Ж') && !has('龘'), "letters that are not there");
    for file in files("assets/words", "ftl") {
        let text = std::fs::read_to_string(&file).unwrap();
        let missing: BTreeSet<char> = text.chars().filter(|letter| !letter.is_whitespace() && !has(*letter)).collect();
        assert!(missing.is_empty(), "{}: {missing:?} not in assets/fonts/japanese.otf", file.display());
    }
}

/// Every text of every mission has its key in `missions.ja.ftl`, and there is no other.
#[test]
fn every_mission_speaks_japanese() {
    let mut wanted = BTreeSet::new();
    for file in files("assets/missions", "toml") {
        let stem = file.file_stem().unwrap().to_string_lossy().into_owned();
        let scene: toml::Table = std::fs::read_to_string(&file).unwrap().parse().unwrap();
        wanted.extend(["title", "idea", "brief"].map(|part| format!("mission-{stem}-{part}")));
        for (index, goal) in scene["goal"].as_array().unwrap().iter().enumerate() {
            wanted.insert(format!("mission-{stem}-goal-{}", index + 1));
            if goal.get("hint").is_some() {
                wanted.insert(format!("mission-{stem}-goal-{}-hint", index + 1));
            }
        }
    }
    let text = std::fs::read_to_string(root().join("assets/words/missions.ja.ftl")).unwrap();
    let keys = text.lines().filter(|line| line.starts_with("mission-")).filter_map(|line| line.split_once(" ="));
    let found: BTreeSet<String> = keys.map(|(key, _)| key.to_owned()).collect();
    assert_eq!(found, wanted);
    assert!(FluentResource::try_new(text).is_ok(), "missions.ja.ftl is not sound");
}

/// The `[action]`s of a text.
fn actions(text: &str) -> BTreeSet<&str> {
    text.split('[').skip(1).filter_map(|part| part.split_once(']')).map(|(action, _)| action).collect()
}

/// A hint names the same buttons in both languages.
#[test]
fn hints_name_the_same_buttons_in_both_languages() {
    let japanese = std::fs::read_to_string(root().join("assets/words/missions.ja.ftl")).unwrap();
    let mut named = 0;
    for file in files("assets/missions", "toml") {
        let stem = file.file_stem().unwrap().to_string_lossy().into_owned();
        let scene: toml::Table = std::fs::read_to_string(&file).unwrap().parse().unwrap();
        for (index, goal) in scene["goal"].as_array().unwrap().iter().enumerate() {
            let Some(hint) = goal.get("hint").and_then(|hint| hint.as_str()) else { continue };
            let key = format!("mission-{stem}-goal-{}-hint = ", index + 1);
            let translated = japanese.lines().find_map(|line| line.strip_prefix(&key)).unwrap();
            assert_eq!(actions(translated), actions(hint), "{key}");
            named += actions(hint).len();
        }
    }
    assert!(named > 5, "{named} buttons in hints");
}
