//! Numbers with derivatives, each with a bound on its rounding error (Higham, Accuracy and Stability, section 3.3). Takes
//! values with their uncertainty; gives sums, products and quotients of them.

use smallvec::SmallVec;

/// Half the distance from 1 to the next double: the relative error of one rounding.
pub const UNIT: f64 = f64::EPSILON / 2.0;

/// The larger of two numbers, NaN if either is.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// The derivative by one variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    /// The variable.
    pub of: u32,
    /// The derivative.
    pub value: f64,
    /// A bound on its error.
    pub error: f64,
}

/// Derivatives by several variables. The derivatives by one rotation fit without an allocation.
pub type Slopes = SmallVec<[Slope; 3]>;

/// A number, its derivatives by the variables that it depends on, and bounds on the errors of all of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Number {
    /// The value.
    pub value: f64,
    /// A bound on its error, including the error of the data.
    pub error: f64,
    /// Derivatives, in the order of the variables; missing derivatives are zero.
    pub slopes: Slopes,
}

/// The rounding of a sum: zero if a part is zero.
fn of_sum(a: f64, b: f64) -> f64 {
    match a == 0.0 || b == 0.0 {
        true => 0.0,
        false => UNIT * (a + b).abs(),
    }
}

/// The rounding of a product: zero if a factor is zero or one.
fn of_product(a: f64, b: f64) -> f64 {
    match a == 0.0 || b == 0.0 || a.abs() == 1.0 || b.abs() == 1.0 {
        true => 0.0,
        false => UNIT * (a * b).abs(),
    }
}

/// This factor covers the rounding of the bounds themselves.
const SLACK: f64 = 1.0 + 1e-13;

/// A product of two inexact numbers, and a bound on its error.
pub(crate) fn times((a, ea): (f64, f64), (b, eb): (f64, f64)) -> (f64, f64) {
    let error = a.abs() * eb + ea * b.abs() + ea * eb + of_product(a, b);
    (a * b, error * SLACK)
}

/// A sum of two inexact numbers, and a bound on its error.
fn plus((a, ea): (f64, f64), (b, eb): (f64, f64)) -> (f64, f64) {
    (a + b, (ea + eb + of_sum(a, b)) * SLACK)
}

/// A quotient of two inexact numbers, and a bound on its error; infinite if the divisor may be zero.
fn over((a, ea): (f64, f64), (b, eb): (f64, f64)) -> (f64, f64) {
    let quotient = a / b;
    let rounding = match b.abs() == 1.0 || a == 0.0 {
        true => 0.0,
        false => UNIT * quotient.abs(),
    };
    match eb < b.abs() {
        true => {
            let error = (ea + quotient.abs() * eb) / (b.abs() - eb) + rounding;
            (quotient, error * (1.0 + 1e-12))
        }
        false => (quotient, f64::INFINITY),
    }
}

impl Number {
    /// A constant that is exact.
    #[must_use]
    pub fn exact(value: f64) -> Self {
        Self::within(value, 0.0)
    }

    /// A constant that is known up to `error`.
    #[must_use]
    pub fn within(value: f64, error: f64) -> Self {
        Self {
            value,
            error,
            slopes: Slopes::new(),
        }
    }

    /// Whether it is exactly the constant zero.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.value == 0.0 && self.error == 0.0 && self.slopes.is_empty()
    }

    /// Adds a derivative with respect to the last variable so far, or to a later one.
    pub fn add_slope(&mut self, of: u32, value: f64, error: f64) {
        match self.slopes.last_mut() {
            Some(last) if last.of == of => {
                (last.value, last.error) = plus((last.value, last.error), (value, error));
            }
            _ if value == 0.0 && error == 0.0 => {}
            _ => self.slopes.push(Slope { of, value, error }),
        }
    }

    /// This number with a derivative with respect to a later variable.
    #[must_use]
    pub fn with_slope(mut self, of: u32, value: f64, error: f64) -> Self {
        self.add_slope(of, value, error);
        self
    }

    /// The value and its error.
    pub(crate) fn pair(&self) -> (f64, f64) {
        (self.value, self.error)
    }

    /// This number without derivatives.
    #[must_use]
    pub fn constant(&self) -> Self {
        Self::within(self.value, self.error)
    }

    /// The sum.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let (value, error) = plus(self.pair(), other.pair());
        let slopes = merged(&self.slopes, &other.slopes, plus);
        Self {
            value,
            error,
            slopes,
        }
    }

    /// The opposite.
    #[must_use]
    pub fn negated(mut self) -> Self {
        self.value = -self.value;
        for slope in &mut self.slopes {
            slope.value = -slope.value;
        }
        self
    }

    /// The difference.
    #[must_use]
    pub fn minus(&self, other: &Self) -> Self {
        self.plus(&other.clone().negated())
    }

    /// The product.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        let (a, b) = (self.pair(), other.pair());
        let (value, error) = times(a, b);
        let slopes = merged(&self.slopes, &other.slopes, |da, db| {
            plus(times(da, b), times(a, db))
        });
        Self {
            value,
            error,
            slopes,
        }
    }

    /// Adds a product.
    pub fn add_product(&mut self, x: &Self, y: &Self) {
        let (a, b) = (x.pair(), y.pair());
        (self.value, self.error) = plus(self.pair(), times(a, b));
        let mut at = 0;
        each(&x.slopes, &y.slopes, |of, da, db| {
            let (value, error) = plus(times(da, b), times(a, db));
            while self.slopes.get(at).is_some_and(|own| own.of < of) {
                at += 1;
            }
            match self.slopes.get_mut(at) {
                Some(own) if own.of == of => {
                    (own.value, own.error) = plus((own.value, own.error), (value, error));
                    if own.value == 0.0 && own.error == 0.0 {
                        self.slopes.remove(at);
                    }
                }
                _ if value == 0.0 && error == 0.0 => {}
                _ => self.slopes.insert(at, Slope { of, value, error }),
            }
        });
    }

    /// The quotient.
    #[must_use]
    pub fn over(&self, other: &Self) -> Self {
        let (a, b) = (self.pair(), other.pair());
        let (value, error) = over(a, b);
        let slopes = merged(&self.slopes, &other.slopes, |da, db| {
            let (moved, wrong) = times((value, error), db);
            over(plus(da, (-moved, wrong)), b)
        });
        Self {
            value,
            error,
            slopes,
        }
    }

    /// A function of this number, from its value and its first two derivatives. The value has this number of roundings.
    #[must_use]
    pub fn through(&self, [value, first, second]: [f64; 3], roundings: f64) -> Self {
        // Twice the second derivative: it may be larger within the error.
        let bend = 2.0 * second.abs() * self.error;
        let error = first.abs() * self.error + bend * self.error + roundings * UNIT * value.abs();
        let derivative = (first, bend + 8.0 * UNIT * first.abs());
        let slopes = self.slopes.iter().map(|s| {
            let (value, error) = times(derivative, (s.value, s.error));
            Slope { value, error, ..*s }
        });
        Self {
            value,
            error: error * SLACK,
            slopes: slopes.collect(),
        }
    }

    /// The derivative by a variable, with the bound on its error.
    #[must_use]
    pub fn slope(&self, of: u32) -> (f64, f64) {
        match self.slopes.binary_search_by_key(&of, |s| s.of) {
            Ok(i) => (self.slopes[i].value, self.slopes[i].error),
            Err(_) => (0.0, 0.0),
        }
    }
}

type Pair = (f64, f64);

/// Calls `with` with each variable of two numbers, in order, and with both derivatives by it. A missing derivative is
/// exactly zero.
fn each(a: &[Slope], b: &[Slope], mut with: impl FnMut(u32, Pair, Pair)) {
    let (mut i, mut j) = (0, 0);
    loop {
        let of = match (a.get(i), b.get(j)) {
            (Some(x), Some(y)) => x.of.min(y.of),
            (Some(x), None) => x.of,
            (None, Some(y)) => y.of,
            (None, None) => return,
        };
        let take = |list: &[Slope], at: &mut usize| match list.get(*at) {
            Some(s) if s.of == of => {
                *at += 1;
                (s.value, s.error)
            }
            _ => (0.0, 0.0),
        };
        let (da, db) = (take(a, &mut i), take(b, &mut j));
        with(of, da, db);
    }
}

/// Derivatives of a function of two numbers.
fn merged(a: &[Slope], b: &[Slope], with: impl Fn(Pair, Pair) -> Pair) -> Slopes {
    let mut out = Slopes::with_capacity(a.len().max(b.len()));
    each(a, b, |of, da, db| {
        let (value, error) = with(da, db);
        if value != 0.0 || error != 0.0 {
            out.push(Slope { of, value, error });
        }
    });
    out
}
