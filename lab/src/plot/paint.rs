//! Shapes, and how they become SVG text or pixels through plotters.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use plotters::backend::{BitMapBackend, SVGBackend};
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, PathElement, Rectangle};
use plotters::prelude::DrawingBackend;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontDesc, FontFamily, FontStyle, FontTransform, IntoTextStyle, RGBColor, ShapeStyle, register_font};

use super::style::{Color, FAILED, WHITE};

/// PNGs are drawn this many times larger and averaged down: thin lines and letters come out smooth.
const OVERSAMPLING: u32 = 2;
/// The letters' name; a viewer of the SVG uses its own sans-serif.
const FAMILY: &str = "sans-serif";

/// Why a chart could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// A file or folder cannot be written.
    #[error("{}: cannot be written: {}", .0.display(), .1)]
    Io(PathBuf, std::io::Error),
    /// The PNG cannot be written.
    #[error("{}: cannot be written: {}", .0.display(), .1)]
    Png(PathBuf, image::ImageError),
    /// The drawing library gave up.
    #[error("the chart could not be drawn: {0}")]
    Draw(String),
}

/// Where a text sits relative to its point, across.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// It begins at the point.
    Start,
    /// It is centred on the point.
    Middle,
    /// It ends at the point.
    End,
}

/// Something drawn. Places in pixels from the upper left corner, y downward.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A line through points; `dash` in pixels on and off, 0 for none.
    Path { points: Vec<[f64; 2]>, color: Color, width: f64, dash: f64 },
    /// A filled rectangle.
    Rect { from: [f64; 2], to: [f64; 2], color: Color },
    /// A disc, or a ring of a pixel and a half.
    Disc { at: [f64; 2], radius: f64, color: Color, filled: bool },
    /// A line of text, vertically centred on its point; `upward` turns it by a quarter.
    Text { at: [f64; 2], text: String, size: f64, color: Color, anchor: Anchor, upward: bool },
}

impl Shape {
    /// A straight line.
    pub fn line(from: [f64; 2], to: [f64; 2], color: Color, width: f64) -> Shape {
        Shape::Path { points: vec![from, to], color, width, dash: 0.0 }
    }

    /// Text that is not turned.
    pub fn text(at: [f64; 2], text: impl Into<String>, size: f64, color: Color, anchor: Anchor) -> Shape {
        Shape::Text { at, text: text.into(), size, color, anchor, upward: false }
    }

    /// The words of a text and where they are: left, top, right, bottom.
    pub fn bounds(&self) -> Option<(&str, [f64; 4])> {
        let Shape::Text { at: [x, y], text, size, anchor, upward, .. } = self else { return None };
        let (wide, half) = (width(text, *size), 0.45 * size);
        let before = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5 * wide,
            Anchor::End => wide,
        };
        let bounds =
            if *upward { [x - half, y - wide + before, x + half, y + before] } else { [x - before, y - half, x - before + wide, y + half] };
        Some((text, bounds))
    }
}

/// A red cross: what failed.
pub fn cross(at: [f64; 2], radius: f64, shapes: &mut Vec<Shape>) {
    for turn in [1.0, -1.0] {
        let (from, to) = ([at[0] - radius, at[1] - turn * radius], [at[0] + radius, at[1] + turn * radius]);
        shapes.push(Shape::line(from, to, FAILED, 2.0));
    }
}

/// The letters, registered once.
fn font(size: f64) -> FontDesc<'static> {
    static REGISTERED: OnceLock<()> = OnceLock::new();
    REGISTERED.get_or_init(|| {
        // The bytes are part of the program: they are a font.
        let _ = register_font(FAMILY, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
    });
    FontDesc::new(FontFamily::SansSerif, size, FontStyle::Normal)
}

/// The width of `text` in pixels.
pub fn width(text: &str, size: f64) -> f64 {
    font(size).box_size(text).map_or(0.5 * size * text.chars().count() as f64, |(w, _)| f64::from(w))
}

/// The SVG of the shapes.
pub fn svg(shapes: &[Shape], size: [u32; 2]) -> Result<String, PlotError> {
    let mut text = String::new();
    draw(SVGBackend::with_string(&mut text, (size[0], size[1])), shapes, 1.0)?;
    Ok(text)
}

/// Writes the PNG of the shapes.
pub fn png(shapes: &[Shape], size: [u32; 2], path: &Path) -> Result<(), PlotError> {
    let [width, height] = size.map(|n| n * OVERSAMPLING);
    let mut pixels = vec![255u8; (width * height * 3) as usize];
    draw(BitMapBackend::with_buffer(&mut pixels, (width, height)), shapes, f64::from(OVERSAMPLING))?;
    let large = image::RgbImage::from_raw(width, height, pixels).ok_or_else(|| PlotError::Draw("the buffer has a wrong size".into()))?;
    let small = image::imageops::thumbnail(&large, size[0], size[1]);
    small.save(path).map_err(|error| PlotError::Png(path.to_path_buf(), error))
}

fn draw<B: DrawingBackend>(backend: B, shapes: &[Shape], zoom: f64) -> Result<(), PlotError> {
    let area = backend.into_drawing_area();
    area.fill(&rgb(WHITE)).map_err(wrong)?;
    for shape in shapes {
        put(&area, shape, zoom)?;
    }
    area.present().map_err(wrong)
}

fn put<B: DrawingBackend>(area: &DrawingArea<B, Shift>, shape: &Shape, zoom: f64) -> Result<(), PlotError> {
    // A place far outside the picture would overflow the pixel arithmetic of the backend.
    let place = |p: [f64; 2]| {
        let v = p.map(|x| if x.is_finite() { (x * zoom).clamp(-1e5, 1e5).round() as i32 } else { -100_000 });
        (v[0], v[1])
    };
    let stroke = |color: Color, width: f64| ShapeStyle {
        color: rgb(color).to_rgba(),
        filled: false,
        stroke_width: ((width * zoom).round() as u32).max(1),
    };
    match shape {
        Shape::Path { points, color, width, dash } => {
            let pieces = if *dash > 0.0 { dashes(points, *dash) } else { vec![points.clone()] };
            for piece in pieces {
                let piece: Vec<_> = piece.into_iter().map(place).collect();
                area.draw(&PathElement::new(piece, stroke(*color, *width))).map_err(wrong)?;
            }
            Ok(())
        }
        Shape::Rect { from, to, color } => area.draw(&Rectangle::new([place(*from), place(*to)], rgb(*color).filled())).map_err(wrong),
        Shape::Disc { at, radius, color, filled } => {
            let style = if *filled { rgb(*color).filled() } else { stroke(*color, 1.5) };
            area.draw(&Circle::new(place(*at), (radius * zoom).round() as i32, style)).map_err(wrong)
        }
        Shape::Text { at, text, size, color, anchor, upward } => {
            let across = match anchor {
                Anchor::Start => HPos::Left,
                Anchor::Middle => HPos::Center,
                Anchor::End => HPos::Right,
            };
            let turned = if *upward { FontTransform::Rotate270 } else { FontTransform::None };
            let ink = rgb(*color);
            let letters = font(*size * zoom).transform(turned);
            let style = letters.into_text_style(area).color(&ink).pos(Pos::new(across, VPos::Center));
            area.draw_text(text, &style, place(*at)).map_err(wrong)
        }
    }
}

/// The path cut into dashes of `length` pixels with gaps as long.
fn dashes(points: &[[f64; 2]], length: f64) -> Vec<Vec<[f64; 2]>> {
    let mut pieces = Vec::new();
    let mut walked = 0.0;
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let whole = (b[0] - a[0]).hypot(b[1] - a[1]);
        if !(whole > 0.0 && whole < 1e5) {
            continue;
        }
        let at = |s: f64| [a[0] + (b[0] - a[0]) * s / whole, a[1] + (b[1] - a[1]) * s / whole];
        let mut s = 0.0;
        while s < whole {
            let phase = (walked + s) % (2.0 * length);
            let step = if phase < length { length - phase } else { 2.0 * length - phase }.clamp(0.01, whole - s + 0.01);
            let end = (s + step).min(whole);
            if phase < length {
                pieces.push(vec![at(s), at(end)]);
            }
            s += step;
        }
        walked += whole;
    }
    pieces
}

fn rgb([r, g, b]: Color) -> RGBColor {
    RGBColor(r, g, b)
}

fn wrong(error: impl std::fmt::Display) -> PlotError {
    PlotError::Draw(error.to_string())
}
