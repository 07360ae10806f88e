//! Eight and sixteen numbers at once.

/// Short functions of an impl, a line each, all inlined.
macro_rules! inlined {
    ($(fn $name:ident($($arguments:tt)*) -> $result:ty = $body:expr;)*) => {
        $(#[inline(always)] fn $name($($arguments)*) -> $result { $body })*
    };
}
pub(super) use inlined;

/// Several f32 side by side. Each operation rounds like the scalar one, so every implementation gives the same bits.
pub(super) trait Lanes: Copy {
    /// A truth a lane.
    type Mask: Mask;
    /// The numbers, lane 0 first.
    type Array: Copy + Default + AsRef<[f32]> + AsMut<[f32]>;
    fn splat(value: f32) -> Self;
    fn load(from: &Self::Array) -> Self;
    fn store(self) -> Self::Array;
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    /// The smaller; `other` where either is not a number.
    fn min(self, other: Self) -> Self;
    /// The larger; `other` where either is not a number.
    fn max(self, other: Self) -> Self;
    /// self · factor + addend, rounded once or twice: for bounds alone, as implementations differ.
    fn roughly(self, factor: Self, addend: Self) -> Self;
    /// self < other.
    fn less(self, other: Self) -> Self::Mask;
    /// self ≤ other.
    fn at_most(self, other: Self) -> Self::Mask;
    /// Lanes of `yes` where the mask is set, else of `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// The least lane. No lane may be other than a number.
    fn least(self) -> f32;
    /// The greatest lane. No lane may be other than a number.
    fn greatest(self) -> f32;
    /// With the other sign (0 stays 0).
    #[inline(always)]
    fn negative(self) -> Self {
        Self::splat(0.0).sub(self)
    }
    /// Without the sign.
    #[inline(always)]
    fn abs(self) -> Self {
        self.max(self.negative())
    }
}

/// What a comparison of lanes says.
pub(super) trait Mask: Copy {
    /// The lanes set in both masks.
    fn and(self, other: Self) -> Self;
    /// The lanes set in either mask.
    fn or(self, other: Self) -> Self;
    /// One bit a lane, lane 0 lowest.
    fn bits(self) -> u32;
}

/// As many lanes as a node has children.
pub(super) trait Eight: Lanes<Array = [f32; 8]> {
    /// The seven columns of eight rows.
    fn columns(rows: &[[f32; 7]; 8]) -> [Self; 7];
    /// The last four of them.
    fn last_columns(rows: &[[f32; 7]; 8]) -> [Self; 4];
    /// The least lane of each of eight. No lane may be other than a number.
    fn leasts(rows: [Self; 8]) -> Self;
    /// Asks for memory that will be needed soon.
    fn prefetch<T>(soon: &T);
}

/// As many lanes as a group has rays.
pub(super) trait Sixteen: Lanes<Array = [f32; 16]> {
    /// The least of x, of −x, of y, of −y. No lane may be other than a number.
    fn spans(x: Self, y: Self) -> [f32; 4];
    /// Lane by lane this number and the other.
    fn beside(self, other: Self) -> [[f32; 2]; 16];
    /// With another number in one lane.
    fn with(self, lane: usize, number: f32) -> Self;
    /// The seven columns of sixteen rows.
    fn columns(rows: &[[f32; 7]; 16]) -> [Self; 7];
    /// The last four of them.
    fn last_columns(rows: &[[f32; 7]; 16]) -> [Self; 4];
}

/// Sixteen lanes as two eights.
#[derive(Clone, Copy)]
pub(super) struct Pair<L>(L, L);

impl<L: Mask> Mask for Pair<L> {
    inlined! {
        fn and(self, other: Self) -> Self = Pair(self.0.and(other.0), self.1.and(other.1));
        fn or(self, other: Self) -> Self = Pair(self.0.or(other.0), self.1.or(other.1));
        fn bits(self) -> u32 = self.0.bits() | self.1.bits() << 8;
    }
}

impl<L: Eight> Lanes for Pair<L> {
    type Mask = Pair<L::Mask>;
    type Array = [f32; 16];
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Pair(L::splat(value), L::splat(value))
    }
    #[inline(always)]
    fn load(from: &[f32; 16]) -> Self {
        let [low, high]: &[[f32; 8]; 2] = bytemuck::cast_ref(from);
        Pair(L::load(low), L::load(high))
    }
    inlined! {
        fn store(self) -> [f32; 16] = bytemuck::cast([self.0.store(), self.1.store()]);
        fn add(self, other: Self) -> Self = Pair(self.0.add(other.0), self.1.add(other.1));
        fn sub(self, other: Self) -> Self = Pair(self.0.sub(other.0), self.1.sub(other.1));
        fn mul(self, other: Self) -> Self = Pair(self.0.mul(other.0), self.1.mul(other.1));
        fn div(self, other: Self) -> Self = Pair(self.0.div(other.0), self.1.div(other.1));
        fn min(self, other: Self) -> Self = Pair(self.0.min(other.0), self.1.min(other.1));
        fn max(self, other: Self) -> Self = Pair(self.0.max(other.0), self.1.max(other.1));
        fn roughly(self, factor: Self, addend: Self) -> Self = Pair(self.0.roughly(factor.0, addend.0), self.1.roughly(factor.1, addend.1));
        fn less(self, other: Self) -> Self::Mask = Pair(self.0.less(other.0), self.1.less(other.1));
        fn at_most(self, other: Self) -> Self::Mask = Pair(self.0.at_most(other.0), self.1.at_most(other.1));
        fn select(mask: Self::Mask, yes: Self, no: Self) -> Self = Pair(L::select(mask.0, yes.0, no.0), L::select(mask.1, yes.1, no.1));
        fn least(self) -> f32 = self.0.min(self.1).least();
        fn greatest(self) -> f32 = self.0.max(self.1).greatest();
    }
}

impl<L: Eight> Sixteen for Pair<L> {
    #[inline(always)]
    fn spans(x: Self, y: Self) -> [f32; 4] {
        [x.least(), x.negative().least(), y.least(), y.negative().least()]
    }
    #[inline(always)]
    fn beside(self, other: Self) -> [[f32; 2]; 16] {
        let (these, others) = (self.store(), other.store());
        std::array::from_fn(|i| [these[i], others[i]])
    }
    #[inline(always)]
    fn with(self, lane: usize, number: f32) -> Self {
        let mut numbers = self.store();
        numbers[lane] = number;
        Self::load(&numbers)
    }
    #[inline(always)]
    fn columns(rows: &[[f32; 7]; 16]) -> [Self; 7] {
        let [low, high]: &[[[f32; 7]; 8]; 2] = bytemuck::cast_ref(rows);
        let [a, b, c, d, e, f, g] = L::columns(low);
        let [p, q, r, s, t, u, v] = L::columns(high);
        [Pair(a, p), Pair(b, q), Pair(c, r), Pair(d, s), Pair(e, t), Pair(f, u), Pair(g, v)]
    }
    #[inline(always)]
    fn last_columns(rows: &[[f32; 7]; 16]) -> [Self; 4] {
        let [low, high]: &[[[f32; 7]; 8]; 2] = bytemuck::cast_ref(rows);
        let [a, b, c, d] = L::last_columns(low);
        let [p, q, r, s] = L::last_columns(high);
        [Pair(a, p), Pair(b, q), Pair(c, r), Pair(d, s)]
    }
}

/// For processors without AVX2, and to test against.
#[derive(Clone, Copy)]
pub(super) struct Portable([f32; 8]);

#[inline(always)]
fn zip(a: Portable, b: Portable, f: impl Fn(f32, f32) -> f32) -> Portable {
    Portable(std::array::from_fn(|i| f(a.0[i], b.0[i])))
}

#[inline(always)]
fn compare(a: Portable, b: Portable, f: impl Fn(f32, f32) -> bool) -> Portable {
    zip(a, b, |a, b| f32::from_bits(if f(a, b) { u32::MAX } else { 0 }))
}

/// All bits of a lane set or none.
impl Mask for Portable {
    inlined! {
        fn and(self, other: Self) -> Self = zip(self, other, |a, b| f32::from_bits(a.to_bits() & b.to_bits()));
        fn or(self, other: Self) -> Self = zip(self, other, |a, b| f32::from_bits(a.to_bits() | b.to_bits()));
        fn bits(self) -> u32 = (0..8).fold(0, |bits, i| bits | self.0[i].to_bits() >> 31 << i);
    }
}

impl Eight for Portable {
    inlined! {
        fn columns(rows: &[[f32; 7]; 8]) -> [Self; 7] = std::array::from_fn(|column| Portable(rows.map(|row| row[column])));
        fn last_columns(rows: &[[f32; 7]; 8]) -> [Self; 4] = std::array::from_fn(|column| Portable(rows.map(|row| row[3 + column])));
        fn leasts(rows: [Self; 8]) -> Self = Portable(rows.map(Lanes::least));
    }
    #[inline(always)]
    fn prefetch<T>(_: &T) {}
}

impl Lanes for Portable {
    type Mask = Portable;
    type Array = [f32; 8];
    inlined! {
        fn splat(value: f32) -> Self = Portable([value; 8]);
        fn load(from: &[f32; 8]) -> Self = Portable(*from);
        fn store(self) -> [f32; 8] = self.0;
        fn add(self, other: Self) -> Self = zip(self, other, |a, b| a + b);
        fn sub(self, other: Self) -> Self = zip(self, other, |a, b| a - b);
        fn mul(self, other: Self) -> Self = zip(self, other, |a, b| a * b);
        fn div(self, other: Self) -> Self = zip(self, other, |a, b| a / b);
        fn min(self, other: Self) -> Self = zip(self, other, |a, b| if a < b { a } else { b });
        fn max(self, other: Self) -> Self = zip(self, other, |a, b| if a > b { a } else { b });
        fn roughly(self, factor: Self, addend: Self) -> Self = self.mul(factor).add(addend);
        fn less(self, other: Self) -> Self = compare(self, other, |a, b| a < b);
        fn at_most(self, other: Self) -> Self = compare(self, other, |a, b| a <= b);
        fn select(mask: Self, yes: Self, no: Self) -> Self =
            Portable(std::array::from_fn(|i| if mask.0[i].is_sign_negative() { yes.0[i] } else { no.0[i] }));
        fn least(self) -> f32 = self.0.into_iter().fold(f32::INFINITY, f32::min);
        fn greatest(self) -> f32 = self.0.into_iter().fold(f32::NEG_INFINITY, f32::max);
    }
}
