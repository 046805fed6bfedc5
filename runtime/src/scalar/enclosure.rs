//! Numbers that are known to lie within bounds: how far a function strays while its arguments move
//! over a whole region, and what rounding may have done to it. Takes centres and how far arguments
//! move; gives bounds that hold for every value in between.

use super::Real;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use num_traits::{One, Zero};

/// How a number in bounds moves with the variables: one number for each of them.
///
/// An array where their number is known to the compiler; elsewhere whatever stands for one.
pub trait Affine: Copy + PartialEq + core::fmt::Debug + Send + Sync + 'static {
    /// Not at all.
    fn none() -> Self;

    /// By as much as `radius` with the variable of this index; nothing where there is no such variable.
    fn variable(radius: f64, index: usize) -> Option<Self>;

    /// How far with one variable.
    fn along(&self, index: usize) -> f64;

    /// Both.
    fn plus(self, other: Self) -> Self;

    /// The opposite.
    fn opposite(self) -> Self;

    /// So many times as far.
    fn times(self, factor: f64) -> Self;

    /// Each a number of times, and both.
    fn weighted(self, factor: f64, other: Self, other_factor: f64) -> Self;

    /// How far in all: the variables come by threes, each a vector no longer than 1.
    fn swing(&self) -> f64;
}

/// The sum of the lengths of the vectors of three.
#[inline(always)]
#[must_use]
pub fn swing_of(along: &[f64]) -> f64 {
    let lengths = along.chunks(3).map(|three| {
        let square = three.iter().fold(0.0, |sum, x| sum + x * x);
        square.sqrt()
    });
    lengths.sum()
}

impl<const K: usize> Affine for [f64; K] {
    #[inline(always)]
    fn none() -> Self {
        [0.0; K]
    }

    #[inline(always)]
    fn variable(radius: f64, index: usize) -> Option<Self> {
        let mut along = [0.0; K];
        *along.get_mut(index)? = radius;
        Some(along)
    }

    #[inline(always)]
    fn along(&self, index: usize) -> f64 {
        self.get(index).copied().unwrap_or(0.0)
    }

    #[inline(always)]
    fn plus(mut self, other: Self) -> Self {
        for (x, y) in self.iter_mut().zip(other) {
            *x += y;
        }
        self
    }

    #[inline(always)]
    fn opposite(self) -> Self {
        self.map(|x| -x)
    }

    #[inline(always)]
    fn times(mut self, factor: f64) -> Self {
        for x in &mut self {
            *x *= factor;
        }
        self
    }

    #[inline(always)]
    fn weighted(mut self, factor: f64, other: Self, other_factor: f64) -> Self {
        for (x, y) in self.iter_mut().zip(&other) {
            *x = *x * factor + y * other_factor;
        }
        self
    }

    #[inline(always)]
    fn swing(&self) -> f64 {
        swing_of(self)
    }
}

/// All numbers `middle + s + sum_k linear_k e_k + r` with `|s| <= still`, `|r| <= rest`: affine in
/// `K` variables that several numbers share, the remainder bounded (affine arithmetic; Comba and
/// Stolfi 1993). The variables come by threes, 0 to 2, 3 to 5, ..., each a vector no longer than 1,
/// as the axes of space do. What is not known but does not move with the variables is `s`: the
/// value where all of them vanish is `middle + s`, so that `still` bounds what is not known there,
/// and the others what the variables change. Bounds that cannot be given, as of a quotient by what
/// may vanish, are NaN.
///
/// Every operation adds its own rounding to the remainder, so that with arguments that do not move
/// the remainder is a running error bound (Wilkinson).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounded<L> {
    middle: f64,
    linear: L,
    still: f64,
    rest: f64,
}

impl<const K: usize> Bounded<[f64; K]> {
    /// Adds a number times an exact one.
    #[inline(always)]
    pub(crate) fn add_times(&mut self, x: &Self, factor: f64) {
        let term = x.middle * factor;
        self.middle += term;
        for (sum, x) in self.linear.iter_mut().zip(&x.linear) {
            *sum += x * factor;
        }
        let size = factor.abs();
        self.still += x.still * size;
        self.rest += x.rest * size + UNIT * (term.abs() + self.middle.abs());
    }

    /// Adds the product of two numbers of which it is known how far the variables move them, see
    /// [`moved`](Self::moved).
    #[inline(always)]
    pub(crate) fn add_product(&mut self, [x, y]: [&Self; 2], [x_moved, y_moved]: [f64; 2]) {
        let (a, b) = (x.middle, y.middle);
        self.middle += a * b;
        for (sum, (x, y)) in self.linear.iter_mut().zip(x.linear.iter().zip(&y.linear)) {
            *sum += x * b + y * a;
        }
        let [still, rest] =
            spread_of_product([a, x.still, x.rest, x_moved], [b, y.still, y.rest, y_moved]);
        self.still += still;
        self.rest += rest + UNIT * self.middle.abs();
    }
}

/// Numbers in bounds that share `K` variables.
pub type Enclosure<const K: usize> = Bounded<[f64; K]>;

/// The relative error of one rounded operation.
pub(crate) const UNIT: f64 = f64::EPSILON / 2.0;

impl<L: Affine> Bounded<L> {
    /// One number.
    #[inline]
    #[must_use]
    pub fn exactly(middle: f64) -> Self {
        Self {
            middle,
            linear: L::none(),
            still: 0.0,
            rest: 0.0,
        }
    }

    /// A number that was rounded once.
    #[inline]
    #[must_use]
    pub fn rounded(middle: f64) -> Self {
        Self {
            rest: UNIT * middle.abs(),
            ..Self::exactly(middle)
        }
    }

    /// All numbers not farther than `radius` from `middle`; which of them does not depend on the
    /// variables.
    #[inline]
    #[must_use]
    pub fn around(middle: f64, radius: f64) -> Self {
        Self {
            still: radius.abs(),
            ..Self::exactly(middle)
        }
    }

    /// `radius` times the variable of this index; all that is not farther from 0 where there is no
    /// such variable.
    #[inline]
    #[must_use]
    pub fn variable(radius: f64, index: usize) -> Self {
        let mut x = Self::exactly(0.0);
        match L::variable(radius, index) {
            Some(own) => x.linear = own,
            None => x.rest = radius.abs(),
        }
        x
    }

    /// The same number, its variables kept in another way.
    #[inline]
    #[must_use]
    pub fn over<M: Affine>(&self, linear: M) -> Bounded<M> {
        Bounded {
            middle: self.middle,
            linear,
            still: self.still,
            rest: self.rest,
        }
    }

    /// The centre.
    #[inline]
    #[must_use]
    pub const fn middle(&self) -> f64 {
        self.middle
    }

    /// How the number moves with the variables.
    #[inline]
    #[must_use]
    pub fn linear(&self) -> &L {
        &self.linear
    }

    /// How far the number moves with a variable.
    #[inline]
    #[must_use]
    pub fn along(&self, index: usize) -> f64 {
        self.linear.along(index)
    }

    /// The bound of what is not known where the variables vanish.
    #[inline]
    #[must_use]
    pub const fn still(&self) -> f64 {
        self.still
    }

    /// The bound of what the variables change besides what is affine in them, and of rounding.
    #[inline]
    #[must_use]
    pub const fn rest(&self) -> f64 {
        self.rest
    }

    /// The same, moved by as much as that besides.
    #[inline]
    #[must_use]
    pub fn and_moved(self, radius: f64) -> Self {
        Self {
            rest: self.rest + radius.abs(),
            ..self
        }
    }

    /// The number times an exact one.
    #[inline]
    #[must_use]
    pub fn times(mut self, factor: f64) -> Self {
        self.middle *= factor;
        self.linear = self.linear.times(factor);
        self.still *= factor.abs();
        self.rest = self.rest * factor.abs() + UNIT * self.middle.abs();
        self
    }

    /// How far the affine part moves.
    #[inline(always)]
    fn swing(&self) -> f64 {
        self.linear.swing()
    }

    /// How far the variables move it.
    #[inline(always)]
    #[must_use]
    pub fn moved(&self) -> f64 {
        self.swing() + self.rest
    }

    /// How far the number may be from its centre.
    #[inline(always)]
    fn radius(&self) -> f64 {
        self.moved() + self.still
    }

    /// Whether it is zero and nothing else.
    #[inline(always)]
    fn is_nothing(&self) -> bool {
        self.middle == 0.0 && self.radius() == 0.0
    }

    /// Whether it has bounds.
    #[inline(always)]
    fn is_bounded(&self) -> bool {
        (self.middle.abs() + self.radius()).is_finite()
    }

    /// The bounds.
    #[inline(always)]
    fn ends(&self) -> [f64; 2] {
        let radius = self.radius();
        [self.middle - radius, self.middle + radius]
    }

    fn unknown() -> Self {
        Self::around(f64::NAN, f64::NAN)
    }

    /// A function of the number by its value and slope in the centre and a bound of its second
    /// derivative in between; `steps` roundings are made in it.
    #[inline]
    fn through(self, value: f64, slope: f64, bend: f64, steps: f64) -> Self {
        let moved = self.moved();
        Self {
            middle: value,
            linear: self.linear.times(slope),
            still: (slope.abs() + 0.5 * bend * self.still) * self.still,
            rest: self.rest * slope.abs()
                + bend * (self.still + 0.5 * moved) * moved
                + steps * UNIT * value.abs(),
        }
    }
}

/// What a product of two numbers adds to what is not known, and to the remainder: of each its middle, what
/// is not known of it, its remainder and how far the variables move it.
#[inline(always)]
pub(crate) fn spread_of_product(
    [a, still, rest, moved]: [f64; 4],
    [b, other_still, other_rest, other_moved]: [f64; 4],
) -> [f64; 2] {
    let (a, b) = (a.abs(), b.abs());
    let (size, other_size) = (a + still, b + other_still);
    [
        a * other_still + still * other_size,
        a * other_rest
            + b * rest
            + still * other_moved
            + other_still * moved
            + moved * other_moved
            + UNIT * size * other_size,
    ]
}

impl<L: Affine> Add for Bounded<L> {
    type Output = Self;
    #[inline]
    fn add(mut self, other: Self) -> Self {
        self.middle += other.middle;
        self.linear = self.linear.plus(other.linear);
        self.still += other.still;
        self.rest += other.rest + UNIT * self.middle.abs();
        self
    }
}

impl<L: Affine> Neg for Bounded<L> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self {
            middle: -self.middle,
            linear: self.linear.opposite(),
            still: self.still,
            rest: self.rest,
        }
    }
}

impl<L: Affine> Sub for Bounded<L> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<L: Affine> Mul for Bounded<L> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        // Entries of basis matrices and of identities.
        if self.is_nothing() && other.is_bounded() {
            return self;
        }
        if other.is_nothing() && self.is_bounded() {
            return other;
        }
        let (a, b) = (self.middle, other.middle);
        let linear = self.linear.weighted(b, other.linear, a);
        let [still, rest] = spread_of_product(
            [a, self.still, self.rest, self.moved()],
            [b, other.still, other.rest, other.moved()],
        );
        Self {
            middle: a * b,
            linear,
            still,
            rest,
        }
    }
}

impl<L: Affine> Div for Bounded<L> {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let [low, high] = other.ends();
        let nearest = if low > 0.0 { low } else { -high };
        // False for NaN.
        let positive = nearest > 0.0;
        if !positive {
            return Self::unknown();
        }
        let value = 1.0 / other.middle;
        let bend = 2.0 / (nearest * nearest * nearest);
        self * other.through(value, -value * value, bend, 1.0)
    }
}

macro_rules! assigned {
    ($($Trait:ident $function:ident $operator:tt),+) => {$(
        impl<L: Affine> $Trait for Bounded<L> {
            #[inline]
            fn $function(&mut self, other: Self) {
                *self = *self $operator other;
            }
        }
    )+};
}

assigned!(AddAssign add_assign +, SubAssign sub_assign -, MulAssign mul_assign *, DivAssign div_assign /);

impl<L: Affine> Zero for Bounded<L> {
    #[inline]
    fn zero() -> Self {
        Self::exactly(0.0)
    }

    #[inline]
    fn is_zero(&self) -> bool {
        *self == Self::exactly(0.0)
    }
}

impl<L: Affine> One for Bounded<L> {
    #[inline]
    fn one() -> Self {
        Self::exactly(1.0)
    }
}

impl<L: Affine> Real for Bounded<L> {
    type One = Self;
    const EPSILON: f64 = UNIT;
    /// Shortcuts of plain numbers are not taken.
    const ORDER: u32 = 1;

    #[inline]
    fn one_of(&self, _: usize) -> Self {
        *self
    }

    #[inline]
    fn set_lane(&mut self, _: usize, one: Self) {
        *self = one;
    }

    #[inline]
    fn from_f64(x: f64) -> Self {
        Self::exactly(x)
    }

    #[inline]
    fn value(self) -> f64 {
        self.middle
    }

    fn magnitude(self) -> f64 {
        self.middle.abs() + self.radius()
    }

    #[inline]
    fn least(self) -> f64 {
        let [low, _] = self.ends();
        low
    }

    #[inline]
    fn greatest(self) -> f64 {
        let [_, high] = self.ends();
        high
    }

    /// Where the sign is not known, both: what lies between 0 and `then`.
    fn where_positive(self, then: Self) -> Self {
        let [low, high] = self.ends();
        if low > 0.0 {
            return then;
        }
        if high <= 0.0 {
            return Self::zero();
        }
        let half = then.times(0.5);
        half.and_moved(0.5 * then.magnitude())
    }

    fn sqrt(self) -> Self {
        if self.is_zero() {
            return self;
        }
        let [low, _] = self.ends();
        let positive = low > 0.0;
        if !positive {
            return Self::unknown();
        }
        let root = self.middle.sqrt();
        self.through(root, 0.5 / root, 0.25 / (low * low.sqrt()), 1.0)
    }

    fn exp(self) -> Self {
        let value = self.middle.exp();
        let [_, high] = self.ends();
        self.through(value, value, high.exp(), 2.0)
    }

    fn ln(self) -> Self {
        let [low, _] = self.ends();
        let positive = low > 0.0;
        if !positive {
            return Self::unknown();
        }
        let bend = 1.0 / (low * low);
        self.through(self.middle.ln(), 1.0 / self.middle, bend, 2.0)
    }

    fn sin(self) -> Self {
        let (sin, cos) = self.middle.sin_cos();
        // The argument's own rounding is in its remainder; near a zero of the sine the value is
        // small, not its error.
        self.through(sin, cos, 1.0, 2.0)
    }

    fn cos(self) -> Self {
        let (sin, cos) = self.middle.sin_cos();
        self.through(cos, -sin, 1.0, 2.0)
    }

    fn sinh(self) -> Self {
        let (value, slope) = (self.middle.sinh(), self.middle.cosh());
        self.through(value, slope, self.magnitude().sinh(), 2.0)
    }

    fn cosh(self) -> Self {
        let (value, slope) = (self.middle.cosh(), self.middle.sinh());
        self.through(value, slope, self.magnitude().cosh(), 2.0)
    }

    fn tanh(self) -> Self {
        let value = self.middle.tanh();
        // The second derivative, -2 t (1 - t^2), is at most 4/sqrt(27).
        self.through(value, 1.0 - value * value, 0.77, 2.0)
    }

    /// Whether bounds could be given.
    fn is_finite(self) -> bool {
        self.magnitude().is_finite()
    }
}

#[cfg(test)]
mod tests;
