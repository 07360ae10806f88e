//! Luminous points on the screen, in columns: eight numbers of one kind lie side by side, as vectors of a processor want them.

/// Lanes of a vector.
pub const LANES: usize = 8;

/// A luminous point on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Pixels from the upper left corner.
    pub x: f32,
    /// Downwards.
    pub y: f32,
    /// Pixels per km there.
    pub scale: f32,
    /// Collisions.
    pub count: f32,
    /// Level of height.
    pub level: u32,
}

/// Many of them. The columns are longer than `length`: what lies behind is room, and of no meaning.
#[derive(Clone, Debug, Default)]
pub struct Points {
    length: usize,
    x: Vec<f32>,
    y: Vec<f32>,
    scale: Vec<f32>,
    count: Vec<f32>,
    level: Vec<u32>,
}

/// Eight points.
#[derive(Clone, Copy, Debug, Default)]
pub struct Eight {
    /// See [`Point`].
    pub x: [f32; LANES],
    /// See [`Point`].
    pub y: [f32; LANES],
    /// See [`Point`].
    pub scale: [f32; LANES],
    /// See [`Point`].
    pub count: [f32; LANES],
    /// See [`Point`].
    pub level: [u32; LANES],
}

/// The lesser and the greater of two numbers; the second if one is not a number. (f32's own do more for those.)
#[inline(always)]
pub(super) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// See [`lesser`].
#[inline(always)]
pub(super) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Eight numbers of a column from `start` on.
#[inline(always)]
pub(super) fn eight<T: Copy + Default>(column: &[T], start: usize) -> [T; LANES] {
    let mut part = [T::default(); LANES];
    part.copy_from_slice(&column[start..start + LANES]);
    part
}

/// Sixteen numbers of a column from `start` on, taken apart by turns.
#[inline(always)]
fn pairs<T: Copy + Default>(column: &[T], start: usize) -> [[T; LANES]; 2] {
    let mut parts = [[T::default(); LANES]; 2];
    let column = &column[start..start + 2 * LANES];
    for k in 0..LANES {
        parts[0][k] = column[2 * k];
        parts[1][k] = column[2 * k + 1];
    }
    parts
}

impl Points {
    /// How many.
    pub fn len(&self) -> usize {
        self.length
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// Forgets all of them, but not their room.
    pub fn clear(&mut self) {
        self.length = 0;
    }

    /// The `k`-th.
    pub fn get(&self, k: usize) -> Point {
        Point { x: self.x[k], y: self.y[k], scale: self.scale[k], count: self.count[k], level: self.level[k] }
    }

    /// One after the other.
    pub fn iter(&self) -> impl Iterator<Item = Point> + '_ {
        (0..self.length).map(|k| self.get(k))
    }

    /// Makes room for `more` points, and two vectors beyond.
    #[inline(always)]
    pub(super) fn reserve(&mut self, more: usize) {
        if self.length + more + 2 * LANES > self.x.len() {
            self.grow(more);
        }
    }

    #[cold]
    fn grow(&mut self, more: usize) {
        let room = 2 * self.x.len() + more + 2 * LANES;
        for column in [&mut self.x, &mut self.y, &mut self.scale, &mut self.count] {
            column.resize(room, 0.0);
        }
        self.level.resize(room, 0);
    }

    /// Adds a point.
    #[inline(always)]
    pub fn push(&mut self, point: Point) {
        self.reserve(1);
        let k = self.length;
        (self.x[k], self.y[k], self.scale[k]) = (point.x, point.y, point.scale);
        (self.count[k], self.level[k]) = (point.count, point.level);
        self.length += 1;
    }

    /// Adds the first `count` of eight, for which there is room.
    #[inline(always)]
    pub(super) fn push_eight(&mut self, points: &Eight, count: usize) {
        let k = self.length;
        self.x[k..k + LANES].copy_from_slice(&points.x);
        self.y[k..k + LANES].copy_from_slice(&points.y);
        self.scale[k..k + LANES].copy_from_slice(&points.scale);
        self.count[k..k + LANES].copy_from_slice(&points.count);
        self.level[k..k + LANES].copy_from_slice(&points.level);
        self.length += count;
    }

    /// Sixteen from the `k`-th on: the first, third, … and the second, fourth, …. What is behind the last point has no light.
    #[inline(always)]
    pub(super) fn pairs(&self, k: usize) -> [Eight; 2] {
        // Said one by one: what a closure does is not always compiled with the wider instructions of the function around it.
        let (x, y, scale) = (pairs(&self.x, k), pairs(&self.y, k), pairs(&self.scale, k));
        let (mut count, level) = (pairs(&self.count, k), pairs(&self.level, k));
        if k + 2 * LANES > self.length {
            for n in self.length - k..2 * LANES {
                count[n % 2][n / 2] = 0.0;
            }
        }
        [
            Eight { x: x[0], y: y[0], scale: scale[0], count: count[0], level: level[0] },
            Eight { x: x[1], y: y[1], scale: scale[1], count: count[1], level: level[1] },
        ]
    }
}

impl Extend<Point> for Points {
    fn extend<I: IntoIterator<Item = Point>>(&mut self, points: I) {
        for point in points {
            self.push(point);
        }
    }
}

impl FromIterator<Point> for Points {
    fn from_iter<I: IntoIterator<Item = Point>>(points: I) -> Self {
        let mut all = Points::default();
        all.extend(points);
        all
    }
}
