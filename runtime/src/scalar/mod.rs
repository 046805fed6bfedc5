//! The scalar a stepper runs on: plain `f64`, SIMD lanes, dual numbers or double-double. The trait [`Real`] and its
//! implementations, one file each.

mod double;
mod double_double;
mod dual;
pub(crate) mod lane_view;
mod lanes;
mod largest;
mod map_scalar;
mod rounded;

pub use double_double::DoubleDouble;
pub use dual::Dual;
pub use lane_view::InLanes;
pub use lanes::Lanes;
pub use largest::{greater, larger, largest};
pub(crate) use map_scalar::of_scalars;
pub use map_scalar::{OfScalars, gather, lane};
pub use rounded::Rounded;

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use num_traits::{One, Zero};

/// A real number as the solvers and the emitted steppers see it.
///
/// One value may represent several numbers: the lanes of an ensemble, or a value with its
/// derivatives. Hence `Real` is not ordered. To test a sign, name the reduction you need
/// ([`least`](Real::least), [`greatest`](Real::greatest)). To test convergence, use
/// [`magnitude`](Real::magnitude), which includes every lane and every derivative part.
///
/// Operators act lane by lane; on dual numbers they follow the rules of differentiation.
/// No function panics; outside their domain they give NaN, as `f64` does.
pub trait Real:
    Copy
    + PartialEq
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + Zero
    + One
{
    /// The type of one lane: `f64` for types with several lanes, the type itself otherwise.
    type One: Real<One = Self::One>;

    /// Unit roundoff: the largest relative error of one rounded operation is about this.
    const EPSILON: f64;

    /// The number of orders of derivatives that a value has besides its real part (0 for plain numbers).
    ///
    /// An iteration that stops on the real part must be followed by this many more Newton steps,
    /// each of which makes one more order of derivatives exact.
    #[inline(always)]
    fn order() -> u32 {
        0
    }

    /// The number of lanes (1 unless the type has lanes).
    const LANES: usize = 1;

    /// The constant `x`, in every lane, without derivatives.
    fn from_f64(x: f64) -> Self;

    /// The constant `num / den`, rounded once in this type's precision.
    #[inline]
    fn from_ratio(num: i64, den: i64) -> Self {
        Self::from_f64(num as f64) / Self::from_f64(den as f64)
    }

    /// The leading real part (lane 0 of several lanes), rounded to `f64`.
    fn value(self) -> f64;

    /// The real part of one lane, rounded to `f64`; NaN if `index` is not a lane.
    #[inline]
    fn lane(self, index: usize) -> f64 {
        if index == 0 { self.value() } else { f64::NAN }
    }

    /// The value of a lane; the first lane if `lane` is out of range.
    fn one_of(&self, lane: usize) -> Self::One;

    /// Sets the value of a lane; ignored if `lane` is out of range.
    fn set_lane(&mut self, lane: usize, one: Self::One);

    /// The largest absolute value over all lanes and all derivative parts; NaN if any is NaN.
    fn magnitude(self) -> f64;

    /// The smallest real part over the lanes; NaN if any lane is NaN.
    fn least(self) -> f64;

    /// The largest real part over the lanes; NaN if any lane is NaN.
    fn greatest(self) -> f64;

    /// Whether the real part is zero or negative in every lane; false if any is NaN. The same as
    /// `greatest() <= 0.0`, which has to find the greatest first.
    #[inline(always)]
    fn nowhere_positive(self) -> bool {
        self.greatest() <= 0.0
    }

    /// Whether `least() > other.least()`; false if either is NaN.
    #[inline(always)]
    fn exceeds(self, other: Self) -> bool {
        self.least() > other.least()
    }

    /// Whether the real part is less than `bound` in every lane; false if any is NaN. The same as `greatest() < bound`.
    #[inline(always)]
    fn is_below(self, bound: f64) -> bool {
        self.greatest() < bound
    }

    /// `then` in the lanes where the real part of `self` is positive, zero in the others.
    ///
    /// This is how an iteration freezes the lanes that are done. NaN counts as not positive.
    fn where_positive(self, then: Self) -> Self;

    /// Square root.
    fn sqrt(self) -> Self;

    /// Exponential.
    fn exp(self) -> Self;

    /// Natural logarithm.
    fn ln(self) -> Self;

    /// Sine of an angle in radians.
    fn sin(self) -> Self;

    /// Cosine of an angle in radians.
    fn cos(self) -> Self;

    /// Hyperbolic sine.
    fn sinh(self) -> Self;

    /// Hyperbolic cosine.
    fn cosh(self) -> Self;

    /// Hyperbolic tangent.
    fn tanh(self) -> Self;

    /// -1, 0 or 1 by the sign of the real part in each lane, without derivatives; NaN if it is not finite.
    #[inline]
    fn sign(self) -> Self {
        let one = Self::one();
        let sign = self.where_positive(one) - (-self).where_positive(one);
        // Adds zero to a finite number, and NaN otherwise.
        sign + Self::from_f64(0.0) * self
    }

    /// Absolute value; its derivative is the sign.
    #[inline]
    fn abs(self) -> Self {
        self * self.sign()
    }

    /// Integer power, by repeated squaring; `x.powi(0)` is 1.
    #[inline]
    fn powi(self, exponent: i32) -> Self {
        let mut square = self;
        let mut rest = exponent.unsigned_abs();
        let mut power = Self::one();
        while rest > 0 {
            if rest & 1 == 1 {
                power *= square;
            }
            rest >>= 1;
            if rest > 0 {
                square *= square;
            }
        }
        if exponent < 0 {
            Self::one() / power
        } else {
            power
        }
    }

    /// Rational power `self^(num/den)` of a positive number (any number when `den` is 1).
    ///
    /// Integer and half-integer exponents use only multiplications and one square root, so that they are exact to a
    /// few roundings. `den = 0` gives NaN.
    #[inline]
    fn powr(self, num: i64, den: i64) -> Self {
        let (num, den) = lowest_terms(num, den);
        match (i32::try_from(num), den) {
            (Ok(n), 1) => self.powi(n),
            (Ok(n), 2) => self.sqrt().powi(n),
            (_, 0) => Self::from_f64(f64::NAN),
            _ => (self.ln() * Self::from_ratio(num, den)).exp(),
        }
    }

    /// A power of two near `1 / sqrt(|x|)`, lane by lane, without derivatives; 1 if `x` is zero, subnormal or not
    /// finite. Multiplied by the powers of its diagonal, the rows and columns of a matrix have equal size in any
    /// units.
    fn balance(self) -> Self {
        let mut scale = Self::one();
        for lane in 0..Self::LANES {
            let x = self.lane(lane).abs();
            let exponent = (x.to_bits() >> 52) as i32 - 1023;
            if x.is_normal() {
                let root = f64::from((-exponent).div_euclid(2)).exp2();
                scale.set_lane(lane, Self::One::from_f64(root));
            }
        }
        scale
    }

    /// The outputs of a function that this scalar records as a single operation. Its arguments are whole numbers that
    /// give its size, and the inputs. `None` for scalars that compute it step by step.
    #[doc(hidden)]
    fn whole(
        _function: fn(&[usize], &[f64], &mut [f64]),
        _sizes: &[usize],
        _inputs: &dyn Fn() -> Vec<Self>,
        _outputs: usize,
    ) -> Option<Vec<Self>> {
        None
    }

    /// Whether every lane and every derivative part is finite.
    fn is_finite(self) -> bool;
}

/// `num/den` with a non-negative denominator and no common factor.
fn lowest_terms(num: i64, den: i64) -> (i64, i64) {
    let (mut a, mut b) = (num.unsigned_abs(), den.unsigned_abs());
    while b != 0 {
        (a, b) = (b, a % b);
    }
    let Ok(divisor) = i64::try_from(a) else {
        return (num, den);
    };
    if divisor == 0 {
        return (num, den);
    }
    let sign = if den < 0 { -1 } else { 1 };
    (
        (num / divisor).saturating_mul(sign),
        (den / divisor).saturating_mul(sign),
    )
}
