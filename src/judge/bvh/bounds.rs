//! Axis-aligned boxes, in f32 for straight rays and in f64 for curved ones.

/// A number that a box is made of.
pub trait Scalar: Copy + PartialOrd + std::fmt::Debug + Send + Sync + 'static {
    /// The value, exactly.
    fn wide(self) -> f64;
    /// +∞.
    const INFINITY: Self;
    /// −∞.
    const NEG_INFINITY: Self;
}

impl Scalar for f32 {
    fn wide(self) -> f64 {
        f64::from(self)
    }
    const INFINITY: f32 = f32::INFINITY;
    const NEG_INFINITY: f32 = f32::NEG_INFINITY;
}

impl Scalar for f64 {
    fn wide(self) -> f64 {
        self
    }
    const INFINITY: f64 = f64::INFINITY;
    const NEG_INFINITY: f64 = f64::NEG_INFINITY;
}

/// An axis-aligned box, faces included, in any unit of length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<T> {
    /// The lowest corner.
    pub min: [T; 3],
    /// The highest corner.
    pub max: [T; 3],
}

impl<T: Scalar> Bounds<T> {
    /// The box that holds nothing: the neutral element of [`Bounds::union`].
    pub const EMPTY: Bounds<T> = Bounds { min: [T::INFINITY; 3], max: [T::NEG_INFINITY; 3] };

    /// The smallest box around some points.
    pub fn around(points: impl IntoIterator<Item = [T; 3]>) -> Bounds<T> {
        points.into_iter().fold(Bounds::EMPTY, |all, p| all.union(&Bounds { min: p, max: p }))
    }

    /// The smallest box around both.
    #[inline]
    pub fn union(&self, other: &Bounds<T>) -> Bounds<T> {
        let (mut min, mut max) = (self.min, self.max);
        for axis in 0..3 {
            if other.min[axis] < min[axis] {
                min[axis] = other.min[axis];
            }
            if other.max[axis] > max[axis] {
                max[axis] = other.max[axis];
            }
        }
        Bounds { min, max }
    }

    /// Whether the other box lies inside, faces included.
    pub fn contains(&self, other: &Bounds<T>) -> bool {
        (0..3).all(|axis| self.min[axis] <= other.min[axis] && other.max[axis] <= self.max[axis])
    }

    /// Half of the surface, which the chance that a random ray meets the box is proportional to; 0 for [`Bounds::EMPTY`].
    #[inline]
    pub fn half_area(&self) -> f64 {
        let [x, y, z] = std::array::from_fn(|axis| (self.max[axis].wide() - self.min[axis].wide()).max(0.0));
        x * y + y * z + z * x
    }

    /// Whether the six numbers are finite and in order.
    pub fn is_proper(&self) -> bool {
        (0..3).all(|axis| self.min[axis].wide().is_finite() && self.max[axis].wide().is_finite() && self.min[axis] <= self.max[axis])
    }

    /// Twice the middle along one axis.
    #[inline]
    fn twice_centre(&self, axis: usize) -> f64 {
        self.min[axis].wide() + self.max[axis].wide()
    }

    /// Where the builder sorts the box: twice the middle of each axis.
    #[inline]
    pub(super) fn key(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.twice_centre(axis))
    }
}
