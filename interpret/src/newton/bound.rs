//! Numbers in bounds as the scalar of equations that were read: those of the runtime, whose operations are
//! called rather than written out wherever they occur, for they follow 36 variables each.

use clebsch::Real;
use clebsch::solvers::newton::Enclosure;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use num_traits::{One, Zero};

/// As many variables as any velocities take that are searched for: three for each coordinate.
pub const VARIABLES: usize = 36;

/// A number in bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound(pub Enclosure<VARIABLES>);

impl Bound {
    /// One number.
    pub fn exactly(x: f64) -> Self {
        Bound(Enclosure::exactly(x))
    }

    /// A number that was rounded once.
    pub fn rounded(x: f64) -> Self {
        Bound(Enclosure::rounded(x))
    }
}

macro_rules! operations {
    ($($Trait:ident $function:ident $Assigned:ident $assigned:ident $operator:tt),+) => {$(
        impl $Trait for Bound {
            type Output = Self;

            #[inline(never)]
            fn $function(self, other: Self) -> Self {
                Bound(self.0 $operator other.0)
            }
        }

        impl $Assigned for Bound {
            fn $assigned(&mut self, other: Self) {
                *self = *self $operator other;
            }
        }
    )+};
}
operations!(
    Add add AddAssign add_assign +,
    Sub sub SubAssign sub_assign -,
    Mul mul MulAssign mul_assign *,
    Div div DivAssign div_assign /
);

impl Neg for Bound {
    type Output = Self;

    #[inline(never)]
    fn neg(self) -> Self {
        Bound(-self.0)
    }
}

impl Zero for Bound {
    fn zero() -> Self {
        Bound(Enclosure::zero())
    }

    fn is_zero(&self) -> bool {
        self.0.is_zero()
    }
}

impl One for Bound {
    fn one() -> Self {
        Bound(Enclosure::one())
    }
}

macro_rules! functions {
    ($($name:ident)+) => {$(
        #[inline(never)]
        fn $name(self) -> Self {
            Bound(self.0.$name())
        }
    )+};
}

macro_rules! sizes {
    ($($name:ident)+) => {$(
        #[inline(never)]
        fn $name(self) -> f64 {
            self.0.$name()
        }
    )+};
}

impl Real for Bound {
    type One = Self;
    const EPSILON: f64 = <Enclosure<VARIABLES> as Real>::EPSILON;
    const ORDER: u32 = <Enclosure<VARIABLES> as Real>::ORDER;

    functions!(sqrt exp ln sin cos sinh cosh tanh sign abs);
    sizes!(value magnitude least greatest);

    fn one_of(&self, _: usize) -> Self {
        *self
    }

    fn set_lane(&mut self, _: usize, one: Self) {
        *self = one;
    }

    fn from_f64(x: f64) -> Self {
        Self::exactly(x)
    }

    fn from_ratio(num: i64, den: i64) -> Self {
        Bound(Enclosure::from_ratio(num, den))
    }

    #[inline(never)]
    fn where_positive(self, then: Self) -> Self {
        Bound(self.0.where_positive(then.0))
    }

    #[inline(never)]
    fn powi(self, exponent: i32) -> Self {
        Bound(self.0.powi(exponent))
    }

    #[inline(never)]
    fn powr(self, num: i64, den: i64) -> Self {
        Bound(self.0.powr(num, den))
    }

    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
}
