//! Words on a picture, by egui's letters.

use bevy_egui::egui::epaint::text::{Fonts, LayoutJob, TextFormat, TextOptions};
use bevy_egui::egui::{Color32, FontDefinitions, FontId};

/// How far the shadow of letters goes, as a share of a row's height.
const SHADOW: f32 = 0.04;
/// How dark each of its nine layers is, of 1.
const SHADE: f64 = 0.12;

/// The letters.
pub struct Letters(Fonts);

impl Default for Letters {
    fn default() -> Letters {
        // Room for letters as high as a picture of 8192 pixels would have them, and more.
        Letters(Fonts::new(TextOptions { max_texture_side: 8192, ..TextOptions::default() }, FontDefinitions::default()))
    }
}

/// How words are written.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// Height of a row, as a share of the picture's.
    pub height: f64,
    /// Where the middle of the row is, as a share of the picture's height.
    pub at: f64,
    /// Space between letters, as a share of the row's height.
    pub spread: f64,
    /// How much of the letters is seen, 0 to 1.
    pub strength: f64,
}

impl Letters {
    /// Writes a row of words into a picture (RGB), in the middle; smaller where it would not fit.
    pub fn write(&mut self, words: &str, style: &Style, size: [u32; 2], rgb: &mut [u8]) {
        if words.is_empty() || style.strength <= 0.0 {
            return;
        }
        let [width, height] = size.map(|side| side as f32);
        let mut points = (style.height as f32 * height).max(1.0);
        let job = |points: f32| {
            let format = TextFormat { font_id: FontId::proportional(points), color: Color32::WHITE, ..TextFormat::default() };
            LayoutJob::single_section(words.to_owned(), TextFormat { extra_letter_spacing: style.spread as f32 * points, ..format })
        };
        let mut fonts = self.0.with_pixels_per_point(1.0);
        let room = 0.94 * width;
        let long = fonts.layout_job(job(points)).rect.width();
        if long > room {
            points *= room / long;
        }
        let galley = fonts.layout_job(job(points));
        let atlas = fonts.image();
        let left = 0.5 * (width - galley.rect.width());
        let top = style.at as f32 * height - 0.5 * galley.rect.height();
        let glyphs =
            || galley.rows.iter().flat_map(|row| row.row.glyphs.iter().map(|glyph| (row.pos + glyph.pos.to_vec2(), glyph.uv_rect)));
        // A shadow all round, so that they are read before what is bright, too.
        let edge = (points * SHADOW).max(1.0).round() as i64;
        let around = [-1, 0, 1].into_iter().flat_map(|x| [-1, 0, 1].map(|y| ([x * edge, y * edge], 0.0, SHADE)));
        for ([across, down], light, share) in around.chain([([0, 0], 255.0, 1.0)]) {
            for (place, image) in glyphs() {
                let corner = place + image.offset;
                let [x, y] = [(left + corner.x).round() as i64 + across, (top + corner.y).round() as i64 + down];
                for (dy, v) in (image.min[1]..image.max[1]).enumerate() {
                    for (dx, u) in (image.min[0]..image.max[0]).enumerate() {
                        let (x, y) = (x + dx as i64, y + dy as i64);
                        if !(0..i64::from(size[0])).contains(&x) || !(0..i64::from(size[1])).contains(&y) {
                            continue;
                        }
                        let cover = atlas.pixels.get(usize::from(v) * atlas.size[0] + usize::from(u)).map_or(0, |texel| texel.a());
                        let share = f64::from(cover) / 255.0 * style.strength * share;
                        let pixel = 3 * (y as usize * size[0] as usize + x as usize);
                        for channel in rgb.iter_mut().skip(pixel).take(3) {
                            *channel = (f64::from(*channel) + (light - f64::from(*channel)) * share).round() as u8;
                        }
                    }
                }
            }
        }
    }
}
