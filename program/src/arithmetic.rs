//! The arithmetic of an evaluation.

use crate::array::Array;
use crate::operation::{Call, Number, Single};

/// The numbers of an evaluation and their operations.
///
/// Every operation rounds once, like binary64; none is contracted or reordered. An arithmetic may record operations (a
/// [`Recorder`](crate::Recorder)), so its numbers need not be floating-point numbers.
pub trait Arithmetic {
    /// A number.
    type Number: Copy;

    /// A constant.
    fn constant(&self, number: Number) -> Self::Number;

    /// The sum.
    fn add(&self, a: Self::Number, b: Self::Number) -> Self::Number;

    /// The difference.
    fn sub(&self, a: Self::Number, b: Self::Number) -> Self::Number;

    /// The product.
    fn mul(&self, a: Self::Number, b: Self::Number) -> Self::Number;

    /// The quotient.
    fn div(&self, a: Self::Number, b: Self::Number) -> Self::Number;

    /// The negative.
    fn neg(&self, a: Self::Number) -> Self::Number;

    /// A function of one number: the square root, the exponential and so on.
    fn function(&self, which: Single, a: Self::Number) -> Self::Number;

    /// An integer power.
    fn power(&self, a: Self::Number, exponent: i32) -> Self::Number;

    /// A rational power `num/den`.
    fn root(&self, a: Self::Number, num: i64, den: i64) -> Self::Number;

    /// The inverse of a square matrix, NaN if the matrix is singular; `None` if this arithmetic lacks inverses.
    fn inverse(&self, a: &Array<Self::Number>) -> Option<Array<Self::Number>>;

    /// The determinant of a matrix with four or more rows; `None` if this arithmetic lacks it.
    fn determinant(&self, a: &Array<Self::Number>) -> Option<Self::Number>;

    /// A functional of the model, or a derivative of one; `None` if this arithmetic does not know it.
    fn functional(
        &self,
        call: &Call,
        values: &[&Array<Self::Number>],
    ) -> Option<Array<Self::Number>> {
        let _ = (call, values);
        None
    }
}

/// Evaluates calls of functionals with plain numbers.
pub type Functionals<'a> = &'a dyn Fn(&Call, &[&Array<f64>]) -> Option<Array<f64>>;

/// Plain binary64 numbers.
#[derive(Clone, Copy, Default)]
pub struct Doubles<'a> {
    functionals: Option<Functionals<'a>>,
}

impl<'a> Doubles<'a> {
    /// With functionals.
    #[must_use]
    pub fn with(functionals: Functionals<'a>) -> Self {
        Doubles {
            functionals: Some(functionals),
        }
    }
}

impl Arithmetic for Doubles<'_> {
    type Number = f64;

    fn constant(&self, number: Number) -> f64 {
        match number {
            Number::Double(x) => x,
            Number::Ratio(num, den) => num as f64 / den as f64,
            Number::Pi => core::f64::consts::PI,
        }
    }

    fn add(&self, a: f64, b: f64) -> f64 {
        a + b
    }

    fn sub(&self, a: f64, b: f64) -> f64 {
        a - b
    }

    fn mul(&self, a: f64, b: f64) -> f64 {
        a * b
    }

    fn div(&self, a: f64, b: f64) -> f64 {
        a / b
    }

    fn neg(&self, a: f64) -> f64 {
        -a
    }

    fn function(&self, which: Single, a: f64) -> f64 {
        match which {
            Single::Sqrt => a.sqrt(),
            Single::Exp => a.exp(),
            Single::Log => a.ln(),
            Single::Sin => a.sin(),
            Single::Cos => a.cos(),
            Single::Sinh => a.sinh(),
            Single::Cosh => a.cosh(),
            Single::Tanh => a.tanh(),
            Single::Abs => a.abs(),
            Single::Sign if a == 0.0 => 0.0,
            Single::Sign => a.signum(),
            // Not functions of a number; the evaluation never requests them.
            _ => f64::NAN,
        }
    }

    fn power(&self, a: f64, exponent: i32) -> f64 {
        a.powi(exponent)
    }

    fn root(&self, a: f64, num: i64, den: i64) -> f64 {
        a.powf(num as f64 / den as f64)
    }

    fn inverse(&self, a: &Array<f64>) -> Option<Array<f64>> {
        Some(eliminated(a).0)
    }

    fn determinant(&self, a: &Array<f64>) -> Option<f64> {
        Some(eliminated(a).1)
    }

    fn functional(&self, call: &Call, values: &[&Array<f64>]) -> Option<Array<f64>> {
        self.functionals?(call, values)
    }
}

/// The inverse and the determinant, by elimination with pivoting.
fn eliminated(of: &Array<f64>) -> (Array<f64>, f64) {
    let n = of.rows();
    let mut a = of.clone();
    let mut b = Array::from_fn(n, n, |i, j| f64::from(u8::from(i == j)));
    let mut det = 1.0;
    for c in 0..n {
        let size = |i: &usize| a.at(*i, c).abs();
        let pivot = (c..n).max_by(|x, y| size(x).total_cmp(&size(y)));
        let p = pivot.unwrap_or(c);
        if p != c {
            det = -det;
            a.swap_rows(c, p);
            b.swap_rows(c, p);
        }
        let d = a.at(c, c);
        det *= d;
        let own = |m: &Array<f64>| (0..n).map(|k| m.at(c, k) / d).collect::<Vec<f64>>();
        let rows = [own(&a), own(&b)];
        for (m, row) in [&mut a, &mut b].into_iter().zip(&rows) {
            for (k, x) in row.iter().enumerate() {
                m.set(c, k, *x);
            }
        }
        for r in (0..n).filter(|r| *r != c) {
            let factor = a.at(r, c);
            for k in 0..n {
                a.set(r, k, a.at(r, k) - factor * a.at(c, k));
                b.set(r, k, b.at(r, k) - factor * b.at(c, k));
            }
        }
    }
    (b, det)
}
