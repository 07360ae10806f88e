//! What a picture must keep to be taken as right, and what it breaks.

use std::fmt;

/// What a picture must keep to be taken as right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Of 99 in 100 displacements, in pixels.
    pub most: f64,
    /// Of every displacement, in pixels.
    pub max: f64,
    /// Of mismatched pixels, as a part of the object's pixels and its rim.
    pub coverage: f64,
    /// How far the outline of an image may be off in the mean, in pixels, where pictures are so small that mismatched pixels are a count
    /// that chance moves: so many pixels differ for each pixel of the rim, give or take three standard deviations of that count. 0 leaves
    /// `coverage` alone.
    pub outline: f64,
    /// Of the difference in area of all thin images, in standard deviations of a count: of each pixel that an image touches, samples and
    /// drawn triangles may make all or nothing, of a variance of 1/4 at most.
    pub thin: f64,
    /// Of the light of an image, as a part of it.
    pub light: f64,
    /// Of the mean ꟻLIP of the picture; None where the judge has too few rays a pixel to know its colours, or where surfaces are.
    pub flip: Option<f64>,
    /// Image orders that are drawn at all; higher ones are listed and not judged.
    pub orders: u32,
}

impl Default for Limits {
    fn default() -> Limits {
        Limits { most: 0.5, max: 1.5, coverage: 0.002, outline: 0.0, thin: 3.0, light: 0.05, flip: None, orders: 3 }
    }
}

/// How far outlines may be off in small pictures, in pixels: a fiftieth of the half pixel that points inside of an image may be off.
const SMALL_OUTLINE: f64 = 0.01;

impl Limits {
    /// For pictures of a few hundred pixels across with one ray a pixel, of which `orders` image orders are drawn.
    pub fn small(orders: u32) -> Limits {
        Limits { outline: SMALL_OUTLINE, orders, ..Limits::default() }
    }

    /// The pixels of an image that are expected to differ at most.
    fn expected(&self, pixels: usize, rim: usize) -> f64 {
        (self.coverage * (pixels + rim) as f64).max(self.outline * rim as f64)
    }

    /// How many pixels may differ, of an image of `pixels` with so many around it. One may always fall either way.
    pub fn differing(&self, pixels: usize, rim: usize) -> f64 {
        let expected = self.expected(pixels, rim);
        if self.outline > 0.0 { self.counted(expected) } else { expected.max(1.0) }
    }

    /// The most that a count will be of which so much is expected: the quantile of Poisson's distribution that lies as far out as
    /// [`Limits::thin`] standard deviations z of a normal one. The last term of λ + z √λ + (z² − 1)/6 is for its skewness (Cornish and
    /// Fisher 1938): where hardly one is expected, three are not rare.
    pub fn counted(&self, expected: f64) -> f64 {
        expected + self.thin * expected.sqrt() + (self.thin * self.thin - 1.0) / 6.0
    }

    /// By how much the area of an image may differ, in pixels: by pixels that may differ, and by chance where it covers pixels in part;
    /// `variance` is that of those pixels together.
    pub fn area(&self, pixels: usize, rim: usize, variance: f64) -> f64 {
        self.counted(self.expected(pixels, rim)) + self.thin * variance.sqrt()
    }
}

/// A kind of fault, the worst first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The renderer gave no picture.
    NoPicture,
    /// An image is larger or smaller than the judge sees it.
    Area,
    /// An image is brighter or darker than the judge sees it.
    Light,
    /// There is light where the judge sees the shadow.
    Lit,
    /// There is nothing where the judge sees a thing all around.
    Hole,
    /// The right thing in an image order that is nowhere near.
    Order,
    /// Thin images cover too much or too little.
    Thin,
    /// Too many pixels show something else.
    Differ,
    /// Points of surfaces are not where the judge sees them.
    Displaced,
    /// Colours differ.
    Colour,
    /// From one frame to the next the area of an image jumps.
    Jump,
}

impl Kind {
    /// All of them, the worst first.
    pub const ALL: [Kind; 11] = [
        Kind::NoPicture,
        Kind::Area,
        Kind::Light,
        Kind::Lit,
        Kind::Hole,
        Kind::Order,
        Kind::Thin,
        Kind::Differ,
        Kind::Displaced,
        Kind::Colour,
        Kind::Jump,
    ];

    /// A word for tables and file names.
    pub fn word(self) -> &'static str {
        match self {
            Kind::NoPicture => "no-picture",
            Kind::Area => "area",
            Kind::Light => "light",
            Kind::Lit => "lit",
            Kind::Hole => "hole",
            Kind::Order => "order",
            Kind::Thin => "thin",
            Kind::Differ => "differ",
            Kind::Displaced => "displaced",
            Kind::Colour => "colour",
            Kind::Jump => "jump",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

/// Something beyond a limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// What kind of thing is wrong.
    pub kind: Kind,
    /// How many times as much as is allowed.
    pub excess: f64,
    /// In words, with the number and what is allowed.
    pub text: String,
}

impl Fault {
    /// A fault of something of which there is `found` and `allowed` at most.
    pub fn new(kind: Kind, found: f64, allowed: f64, text: String) -> Fault {
        Fault { kind, excess: found / allowed.max(1e-9), text }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// The worst of them: of the worst kind the one that is farthest beyond its limit.
pub fn main_fault(faults: &[Fault]) -> Option<&Fault> {
    let kind = faults.iter().map(|fault| fault.kind).min()?;
    faults.iter().filter(|fault| fault.kind == kind).max_by(|a, b| a.excess.total_cmp(&b.excess))
}
