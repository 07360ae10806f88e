//! The manual: eight illustrated cards. Their texts are in `assets/words/manual.*.ftl`; here are the drawings.
//!
//! Every line that can be computed is: rays by the closed form of light, orbits as geodesics, colours from the frequency ratio g. Lengths
//! in r_s, times in r_s/c. Nothing is kept from one frame to the next.

mod clocks;
mod colours;
mod disk;
mod horizon;
mod images;
mod orbits;
mod past;
mod rays;
mod shadow;
pub(super) mod sketch;

use bevy_egui::egui::{Painter, Rect, RichText, Sense, Ui, vec2};

use sketch::Sketch;

use crate::play::hud::paint::TEXT;
use crate::play::hud::palette::Palette;
use crate::play::words::Language;

/// How many cards there are.
pub const CARDS: usize = 8;
/// Width of a card, in points.
pub const WIDTH: f32 = 520.0;

/// Shows the card at `place`, from 0: title, drawing, text.
pub fn show(ui: &mut Ui, place: usize, language: Language) {
    let card = place % CARDS + 1;
    let colour = Palette::in_use(ui.ctx()).shown(TEXT);
    let title = language.say(&format!("card-{card}-title"));
    ui.label(RichText::new(format!("{card} / {CARDS}   {title}")).size(20.0).color(colour).strong());
    let (frame, _) = ui.allocate_exact_size(vec2(ui.available_width(), 230.0), Sense::hover());
    draw(card, &ui.painter_at(frame), frame, &|key| language.say(key));
    ui.label(RichText::new(language.say(&format!("card-{card}-text"))).size(14.0).color(colour));
    ui.add_space(4.0);
}

/// Paints the drawing of a card, 1 to [`CARDS`], as large as fits in the middle of `rect` (points); it is laid out for 420 × 200 points.
/// `label` gives the words of a key such as `card-1-label-hole`. Paints nothing for any other card.
pub fn draw(card: usize, painter: &Painter, rect: Rect, label: &impl Fn(&str) -> String) {
    let words = |key: &str| label(&format!("card-{card}-label-{key}"));
    let sketch = Sketch::new(painter, rect, &words);
    match card {
        1 => shadow::draw(&sketch),
        2 => disk::draw(&sketch),
        3 => colours::draw(&sketch),
        4 => images::draw(&sketch),
        5 => past::draw(&sketch),
        6 => clocks::draw(&sketch),
        7 => orbits::draw(&sketch),
        8 => horizon::draw(&sketch),
        _ => (),
    }
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::collections::BTreeSet;
    use std::sync::Arc;

    use bevy_egui::egui::epaint::{ClippedShape, TextShape};
    use bevy_egui::egui::{Context, FontData, FontDefinitions, FontFamily, LayerId, Pos2, RawInput, Shape, pos2, vec2};
    use fluent_bundle::{FluentBundle, FluentResource};

    use super::*;

    /// What stands under `assets/`.
    fn asset(name: &str) -> Vec<u8> {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("assets").join(name);
        std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// The manual's words in a language.
    fn words(language: &str) -> FluentBundle<FluentResource> {
        let text = String::from_utf8(asset(&format!("words/manual.{language}.ftl"))).expect("UTF-8");
        let mut bundle = FluentBundle::default();
        bundle.add_resource(FluentResource::try_new(text).expect("a sound file")).expect("each key once");
        bundle
    }

    fn word(bundle: &FluentBundle<FluentResource>, key: &str) -> Option<String> {
        let pattern = bundle.get_message(key)?.value()?;
        Some(bundle.format_pattern(pattern, None, &mut Vec::new()).into_owned())
    }

    /// The shapes of a card in `rect` with the labels of a language, and the keys that it asked for.
    fn drawn(card: usize, rect: Rect, language: &str) -> (Vec<Shape>, BTreeSet<String>) {
        let bundle = words(language);
        let asked = RefCell::new(BTreeSet::new());
        let label = |key: &str| {
            asked.borrow_mut().insert(key.to_owned());
            word(&bundle, key).unwrap_or_else(|| panic!("{key} is not in manual.{language}.ftl"))
        };
        let context = Context::default();
        let mut fonts = FontDefinitions::default();
        fonts.font_data.insert("japanese".into(), Arc::new(FontData::from_owned(asset("fonts/japanese.otf"))));
        fonts.families.entry(FontFamily::Proportional).or_default().push("japanese".into());
        context.set_fonts(fonts);
        let screen = Rect::from_min_size(Pos2::ZERO, vec2(1000.0, 800.0));
        let input = RawInput { screen_rect: Some(screen), ..RawInput::default() };
        let output = context.run_ui(input, |ui| draw(card, &ui.ctx().layer_painter(LayerId::background()), rect, &label));
        (output.shapes.into_iter().map(|ClippedShape { shape, .. }| shape).collect(), asked.into_inner())
    }

    fn texts(shapes: &[Shape]) -> Vec<&TextShape> {
        shapes.iter().filter_map(|shape| if let Shape::Text(text) = shape { Some(text) } else { None }).collect()
    }

    #[test]
    fn every_card_stays_in_its_rectangle_and_no_label_covers_another() {
        for language in ["en", "ja"] {
            for rect in [vec2(420.0, 200.0), vec2(700.0, 300.0)].map(|size| Rect::from_min_size(pos2(90.0, 50.0), size)) {
                for card in 1..=CARDS {
                    let (shapes, _) = drawn(card, rect, language);
                    assert!(shapes.len() > 10, "card {card}: {} shapes", shapes.len());
                    for shape in &shapes {
                        let covers = shape.visual_bounding_rect();
                        let inside = !covers.is_positive() || rect.expand(1.0).contains_rect(covers);
                        assert!(inside, "{language} card {card}: {covers} is not in {rect}: {shape:?}");
                    }
                    let texts = texts(&shapes);
                    for (index, one) in texts.iter().enumerate() {
                        for other in &texts[..index] {
                            let [a, b] = [one, other].map(|text| text.visual_bounding_rect());
                            let said = [one, other].map(|text| text.galley.text());
                            assert!(!a.intersects(b), "{language} card {card}: {said:?} at {a} and {b}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn every_label_is_drawn_and_every_text_is_short() {
        for language in ["en", "ja"] {
            let bundle = words(language);
            let text = String::from_utf8(asset(&format!("words/manual.{language}.ftl"))).expect("UTF-8");
            let keys: BTreeSet<String> = text.lines().filter_map(|line| line.split_once(" = ")).map(|(key, _)| key.to_owned()).collect();
            let mut used = BTreeSet::new();
            for card in 1..=CARDS {
                let (_, asked) = drawn(card, Rect::from_min_size(Pos2::ZERO, vec2(420.0, 200.0)), language);
                used.extend(asked);
                for part in ["title", "text"] {
                    let key = format!("card-{card}-{part}");
                    let said = word(&bundle, &key).unwrap_or_else(|| panic!("{key}"));
                    let length = if language == "ja" { said.chars().count() as f64 / 140.0 } else { said.split(' ').count() as f64 / 62.0 };
                    assert!(length <= 1.0, "{language} {key}: {length} of what may be");
                    used.insert(key);
                }
            }
            assert_eq!(keys, used, "{language}");
        }
    }

    #[test]
    fn there_is_no_other_card() {
        for card in [0, CARDS + 1] {
            assert!(drawn(card, Rect::from_min_size(Pos2::ZERO, vec2(420.0, 200.0)), "en").0.is_empty());
        }
    }
}
