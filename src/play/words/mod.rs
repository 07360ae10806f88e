//! All words of the game, in English and Japanese, from the fluent files in `assets/words/`.
//!
//! A text has a key; [`Language::say`] gives the text, [`Language::fill`] puts values into it. Numbers come formatted.

pub mod buttons;
pub mod font;

use std::sync::LazyLock;

use fluent_bundle::concurrent::FluentBundle;
use fluent_bundle::{FluentArgs, FluentResource};

use crate::scene::Scene;

/// A language that the game speaks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Language {
    /// English.
    #[default]
    English,
    /// Japanese.
    Japanese,
}

/// The texts of each language, by file. The missions' English words stand in the missions themselves.
const ENGLISH: [&str; 2] = [include_str!("../../../assets/words/en.ftl"), include_str!("../../../assets/words/manual.en.ftl")];
const JAPANESE: [&str; 3] = [
    include_str!("../../../assets/words/ja.ftl"),
    include_str!("../../../assets/words/manual.ja.ftl"),
    include_str!("../../../assets/words/missions.ja.ftl"),
];

type Bundle = FluentBundle<FluentResource>;

fn bundle(tag: &str, texts: &[&str]) -> Bundle {
    let mut bundle = Bundle::new_concurrent(tag.parse().into_iter().collect());
    // The marks round values would be drawn as boxes.
    bundle.set_use_isolating(false);
    for text in texts {
        // What of a file is wrong is left out here; a test refuses it.
        let resource = FluentResource::try_new((*text).to_owned()).unwrap_or_else(|(resource, _)| resource);
        bundle.add_resource_overriding(resource);
    }
    bundle
}

static BUNDLES: LazyLock<[Bundle; 2]> = LazyLock::new(|| [bundle("en", &ENGLISH), bundle("ja", &JAPANESE)]);
static SYSTEM: LazyLock<Language> = LazyLock::new(|| {
    let speaks_japanese = sys_locale::get_locale().is_some_and(|locale| locale.starts_with("ja"));
    if speaks_japanese { Language::Japanese } else { Language::English }
});

impl Language {
    /// All of them.
    pub const ALL: [Language; 2] = [Language::English, Language::Japanese];

    /// The language of `interface.language`: `en`, `ja`, or `auto`, that of the system.
    pub fn of(choice: &str) -> Language {
        match choice {
            "en" => Language::English,
            "ja" => Language::Japanese,
            _ => *SYSTEM,
        }
    }

    /// The text of a key; the key itself where there is none.
    pub fn say(self, key: &str) -> String {
        self.fill(key, &[])
    }

    /// The text of a key with values put in.
    pub fn fill(self, key: &str, values: &[(&str, &str)]) -> String {
        self.find(key, values).unwrap_or_else(|| key.to_owned())
    }

    fn find(self, key: &str, values: &[(&str, &str)]) -> Option<String> {
        let bundle = &BUNDLES[self as usize];
        let pattern = bundle.get_message(key)?.value()?;
        let args: FluentArgs = values.iter().map(|(name, value)| (*name, *value)).collect();
        Some(bundle.format_pattern(pattern, Some(&args), &mut Vec::new()).into_owned())
    }

    /// A text of one of the game's own missions, by its part (`title`, `idea`, `brief`, `goal-1`, `goal-1-hint`); `own` is what its file
    /// says, and stands where there is no translation.
    pub fn mission(self, scene: &Scene, part: &str, own: &str) -> String {
        let translated = if scene.foreign { None } else { self.find(&format!("mission-{}-{part}", scene.name), &[]) };
        translated.unwrap_or_else(|| own.to_owned())
    }
}

/// A number and its unit, which stay on one line.
pub fn together(words: &str) -> String {
    words.replace(' ', "\u{a0}")
}

/// Checks of the files.
#[cfg(test)]
mod tests {
    use super::*;
    use crate::play::choices::is_players;
    use crate::play::input::action::Action;
    use crate::scene::config::{self, Allowed};
    use std::collections::BTreeSet;
    use std::path::Path;

    fn keys(texts: &[&str]) -> BTreeSet<String> {
        let mut found = BTreeSet::new();
        for text in texts {
            let resource = FluentResource::try_new((*text).to_owned());
            let resource = resource.unwrap_or_else(|(_, errors)| panic!("a file of words cannot be read: {errors:?}"));
            for entry in resource.entries() {
                let fluent_syntax::ast::Entry::Message(message) = entry else { continue };
                assert!(found.insert(message.id.name.to_owned()), "{} is there twice", message.id.name);
            }
        }
        found
    }

    /// The keys that the program makes from names.
    fn made() -> BTreeSet<String> {
        let mut made: BTreeSet<String> = Action::ALL.iter().map(|action| format!("action-{}", action.key().replace('_', "-"))).collect();
        for setting in config::settings().iter().filter(|setting| is_players(setting) && setting.allowed != Allowed::Buttons) {
            made.insert(format!("setting-{}-{}", setting.section, setting.key).replace('_', "-"));
            if let Allowed::Choice(words) = setting.allowed {
                made.extend(words.iter().map(|word| format!("choice-{}-{word}", setting.key.replace('_', "-"))));
            }
        }
        made
    }

    /// The keys that the sources name.
    fn named(folder: &Path, found: &mut BTreeSet<String>) {
        for entry in std::fs::read_dir(folder).expect("the sources") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                named(&path, found);
                continue;
            }
            let text = std::fs::read_to_string(&path).expect("a source");
            let text = text.split("mod tests {").next().unwrap_or_default();
            for quoted in text.split('"').skip(1).step_by(2) {
                found.insert(quoted.to_owned());
            }
        }
    }

    #[test]
    fn both_languages_say_the_same_and_all_that_is_said() {
        let english = keys(&ENGLISH);
        let japanese: BTreeSet<String> = keys(&JAPANESE).into_iter().filter(|key| !key.starts_with("mission-")).collect();
        assert_eq!(english.difference(&japanese).collect::<Vec<_>>(), Vec::<&String>::new(), "missing in Japanese");
        assert_eq!(japanese.difference(&english).collect::<Vec<_>>(), Vec::<&String>::new(), "missing in English");
        let mut used = made();
        let missing: Vec<&String> = used.difference(&english).collect();
        assert!(missing.is_empty(), "no words for {missing:?}");
        named(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src/play")), &mut used);
        let families = ["outcome-", "button-", "card-", "seeing-", "difficulty-"];
        let unused: Vec<&String> =
            english.iter().filter(|key| !used.contains(*key) && !families.iter().any(|family| key.starts_with(family))).collect();
        assert!(unused.is_empty(), "nobody says {unused:?}");
    }

    /// Every key in `say("…")` and `fill("…"` is there.
    #[test]
    fn nothing_is_said_that_has_no_words() {
        fn look(folder: &Path, english: &BTreeSet<String>) {
            for entry in std::fs::read_dir(folder).expect("the sources") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    look(&path, english);
                    continue;
                }
                let text = std::fs::read_to_string(&path).expect("a source");
                let text = text.split("mod tests {").next().unwrap_or_default();
                for call in [".say(\"", ".fill(\""] {
                    for part in text.split(call).skip(1) {
                        let key = part.split('"').next().unwrap_or_default();
                        assert!(english.contains(key), "{}: {key}", path.display());
                    }
                }
            }
        }
        look(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src/play")), &keys(&ENGLISH));
    }

    /// Both languages put in the same values.
    #[test]
    fn values_are_the_same_in_both_languages() {
        let holes = |text: &str| -> std::collections::BTreeMap<String, BTreeSet<String>> {
            let mut key = String::new();
            let mut found = std::collections::BTreeMap::<String, BTreeSet<String>>::new();
            for line in text.lines().filter(|line| !line.starts_with('#')) {
                if let Some((name, _)) = line.split_once(" =").filter(|_| !line.starts_with(' ')) {
                    key = name.to_owned();
                }
                let values = line.split("{ $").skip(1).filter_map(|part| part.split(' ').next()).map(str::to_owned);
                found.entry(key.clone()).or_default().extend(values);
            }
            found
        };
        let [english, japanese] = [ENGLISH.concat(), JAPANESE.concat()].map(|text| holes(&text));
        for (key, values) in &english {
            assert_eq!(japanese.get(key), Some(values), "{key}");
        }
    }

    #[test]
    fn a_text_is_filled() {
        assert_eq!(Language::English.fill("hud-gate", &[("number", "3")]), "gate 3");
        assert!(Language::Japanese.fill("hud-gate", &[("number", "3")]).contains('3'));
        assert_eq!(Language::English.say("there is no such key"), "there is no such key");
    }
}
