//! The letters of all languages: egui's own, and after them a Japanese font that has what the texts use (`assets/fonts/`).

use std::sync::Arc;

use bevy_egui::egui::{Context, FontData, FontDefinitions, FontFamily};

/// Noto Sans CJK JP, cut down by `assets/fonts/make_japanese.py`.
const JAPANESE: &[u8] = include_bytes!("../../../assets/fonts/japanese.otf");

/// Gives a context the fonts.
pub fn install(context: &Context) {
    let mut fonts = FontDefinitions::default();
    fonts.font_data.insert("japanese".into(), Arc::new(FontData::from_static(JAPANESE)));
    for family in [FontFamily::Proportional, FontFamily::Monospace] {
        // After the letters, before the signs: those of egui have wide brackets and question marks of another kind.
        let names = fonts.families.entry(family).or_default();
        names.insert(names.len().min(1), "japanese".into());
    }
    context.set_fonts(fonts);
}

#[cfg(test)]
mod tests {
    use super::super::{ENGLISH, JAPANESE as TEXTS};
    use crate::play::hud::paint::tests::on_canvas;
    use bevy_egui::egui::FontId;

    /// No box is drawn for a letter.
    #[test]
    fn every_letter_has_a_glyph() {
        on_canvas([900.0, 620.0], |painter, _| {
            let texts = ENGLISH.concat() + &TEXTS.concat() + "★☆‹›±°τγ";
            let letters: std::collections::BTreeSet<char> = texts.chars().filter(|letter| !letter.is_control()).collect();
            let font = FontId::proportional(14.0);
            let missing: Vec<char> =
                letters.into_iter().filter(|letter| !painter.fonts_mut(|fonts| fonts.has_glyph(&font, *letter))).collect();
            assert!(missing.is_empty(), "{missing:?}");
        });
    }
}
