//! The colours of markers and words for the kinds of colour blindness, and with high contrast.
//!
//! What is painted is named by its standard colour ([`super::colours`]); the palette says which colour it has for this player.

use bevy_egui::egui::{Color32, Context, Id};

use crate::play::hud::colours::{ALARM, FAINT, OWN, SEEN, SHADE, TEXT, TRUE};
use crate::scene::config::Accessibility;

/// For whom the colours are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// Who tells all colours apart.
    #[default]
    Standard,
    /// Who confuses red and green (protanopia, deuteranopia).
    RedGreen,
    /// Who confuses blue and green, and yellow and pink (tritanopia).
    BlueYellow,
}

/// The colours of a player.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Palette {
    /// For whom they are.
    pub kind: Kind,
    /// White and saturated colours on black, thicker lines.
    pub high_contrast: bool,
}

/// Where egui keeps it.
fn place() -> Id {
    Id::new("palette")
}

impl Palette {
    /// As the settings say.
    pub fn of(settings: &Accessibility) -> Palette {
        let kind = match settings.palette.as_str() {
            "red-green" => Kind::RedGreen,
            "blue-yellow" => Kind::BlueYellow,
            _ => Kind::Standard,
        };
        Palette { kind, high_contrast: settings.high_contrast }
    }

    /// The one that a context paints with.
    pub fn in_use(context: &Context) -> Palette {
        context.data(|data| data.get_temp(place())).unwrap_or_default()
    }

    /// Has a context paint with it.
    pub fn put(self, context: &Context) {
        context.data_mut(|data| data.insert_temp(place(), self));
    }

    /// What a standard colour is in it; other colours stay as they are.
    pub fn shown(self, standard: Color32) -> Color32 {
        if self.high_contrast && (standard == TEXT || standard == FAINT) {
            return Color32::WHITE;
        }
        if self.high_contrast && standard == SHADE {
            return Color32::BLACK;
        }
        let place = [SEEN, TRUE, OWN, ALARM].iter().position(|colour| *colour == standard);
        place.map_or(standard, |place| self.markers()[place])
    }

    /// Image, target itself, own motion, danger.
    pub fn markers(self) -> [Color32; 4] {
        match (self.kind, self.high_contrast) {
            (Kind::Standard, false) => [SEEN, TRUE, OWN, ALARM],
            (Kind::Standard, true) => {
                [[0, 255, 255], [255, 255, 0], [90, 255, 90], [255, 110, 110]].map(|[r, g, b]| Color32::from_rgb(r, g, b))
            }
            (Kind::RedGreen, _) => {
                [[90, 180, 255], [250, 220, 60], [245, 245, 250], [255, 105, 40]].map(|[r, g, b]| Color32::from_rgb(r, g, b))
            }
            (Kind::BlueYellow, _) => {
                [[40, 220, 200], [255, 165, 165], [245, 245, 245], [255, 70, 70]].map(|[r, g, b]| Color32::from_rgb(r, g, b))
            }
        }
    }

    /// How much wider lines are, in points.
    pub fn wider(self) -> f32 {
        if self.high_contrast { 1.0 } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Matrix = [[f64; 3]; 3];
    /// How linear sRGB looks without one kind of cones: Machado, Oliveira, Fernandes 2009 (IEEE TVCG 15, 1291), severity 1.
    const PROTANOPIA: Matrix = [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]];
    const DEUTERANOPIA: Matrix = [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]];
    const TRITANOPIA: Matrix = [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]];
    const ALL_CONES: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    fn linear(colour: Color32) -> [f64; 3] {
        [colour.r(), colour.g(), colour.b()].map(|encoded| {
            let value = f64::from(encoded) / 255.0;
            if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
        })
    }

    /// CIE L*a*b* (D65) of linear sRGB.
    fn lab([r, g, b]: [f64; 3]) -> [f64; 3] {
        let f = |t: f64| if t > 0.008856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 };
        let x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
        let y = f(0.2126 * r + 0.7152 * g + 0.0722 * b);
        let z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    fn seen(colour: Color32, eye: &Matrix) -> [f64; 3] {
        let light = linear(colour);
        lab(eye.map(|row| row.iter().zip(light).map(|(a, b)| a * b).sum::<f64>().clamp(0.0, 1.0)))
    }

    /// The least difference of two of a palette's marker colours to an eye, ΔE*ab.
    fn least(palette: Palette, eye: &Matrix) -> f64 {
        let markers = palette.markers().map(|colour| seen(colour, eye));
        let apart = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        let pairs = (0..4).flat_map(|k| (0..k).map(move |j| (j, k)));
        pairs.map(|(j, k)| apart(markers[j], markers[k])).fold(f64::INFINITY, f64::min)
    }

    /// Two colours 20 apart are told apart at a glance; 2 is the least difference that is seen side by side.
    #[test]
    fn each_palette_is_told_apart_by_those_it_is_for() {
        let palette = |kind| Palette { kind, high_contrast: false };
        for (kind, eyes) in [
            (Kind::Standard, &[ALL_CONES][..]),
            (Kind::RedGreen, &[ALL_CONES, PROTANOPIA, DEUTERANOPIA][..]),
            (Kind::BlueYellow, &[ALL_CONES, TRITANOPIA][..]),
        ] {
            for eye in eyes {
                assert!(least(palette(kind), eye) > 20.0, "{kind:?}: {}", least(palette(kind), eye));
            }
        }
        assert!(least(Palette { kind: Kind::Standard, high_contrast: true }, &ALL_CONES) > 20.0);
        // Why there are others than the standard.
        for (kind, eye) in [(Kind::RedGreen, DEUTERANOPIA), (Kind::RedGreen, PROTANOPIA), (Kind::BlueYellow, TRITANOPIA)] {
            let [own, standard] = [kind, Kind::Standard].map(|kind| least(palette(kind), &eye));
            assert!(own > standard, "{kind:?}: {own} {standard}");
        }
    }

    #[test]
    fn every_palette_is_read_on_its_ground() {
        let luminance = |colour: Color32| {
            let [r, g, b] = linear(colour);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        for kind in [Kind::Standard, Kind::RedGreen, Kind::BlueYellow] {
            for (high_contrast, asked) in [(false, 4.5), (true, 7.0)] {
                let palette = Palette { kind, high_contrast };
                let ground = palette.shown(SHADE);
                let behind = luminance(ground) + 1.0 - f64::from(ground.a()) / 255.0;
                for colour in [TEXT, FAINT, SEEN, TRUE, OWN].map(|colour| palette.shown(colour)) {
                    let contrast = (luminance(colour) + 0.05) / (behind + 0.05);
                    assert!(contrast > asked, "{palette:?} {colour:?}: {contrast}");
                }
            }
        }
    }
}
