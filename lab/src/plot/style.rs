//! Colours and letter sizes.

/// Red, green, blue.
pub type Color = [u8; 3];

/// Letters of the figure's title, in pixels.
pub const TITLE: f64 = 24.0;
/// Letters of the subtitle and of panel titles.
pub const HEADING: f64 = 16.0;
/// Letters of axes and legends.
pub const TEXT: f64 = 14.0;
/// Letters of ticks, point labels and the footer.
pub const SMALL: f64 = 12.0;

/// Paper.
pub const WHITE: Color = [255, 255, 255];
/// Letters and frames.
pub const INK: Color = [30, 30, 30];
/// Footer, leader lines.
pub const GREY: Color = [110, 110, 110];
/// Grid lines.
pub const FAINT: Color = [225, 225, 225];
/// Behind what is good enough.
pub const GOOD: Color = [233, 246, 233];
/// What failed.
pub const FAILED: Color = [200, 0, 0];

/// Colours told apart by readers with any colour vision (Okabe and Ito, "Color universal design", 2008), without yellow, which
/// is lost on white.
const SERIES: [Color; 7] = [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [86, 180, 233], [230, 159, 0], [90, 90, 90]];

/// The colour of series `index`; they repeat after seven.
pub fn color(index: usize) -> Color {
    SERIES[index % SERIES.len()]
}

/// `color` mixed with white; `share` 0 leaves it, 1 is white.
pub fn fade(color: Color, share: f64) -> Color {
    color.map(|v| (f64::from(v) + (255.0 - f64::from(v)) * share.clamp(0.0, 1.0)).round() as u8)
}

/// A dark-to-light scale over 0..=1, even in lightness (the five corners of "viridis", van der Walt and Smith 2015).
pub fn scale(share: f64) -> Color {
    const CORNERS: [Color; 5] = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
    let x = share.clamp(0.0, 1.0) * 4.0;
    let i = (x as usize).min(3);
    let t = x - i as f64;
    [0, 1, 2].map(|k| (f64::from(CORNERS[i][k]) * (1.0 - t) + f64::from(CORNERS[i + 1][k]) * t).round() as u8)
}
