//! Records kernels as tapes: an arithmetic whose numbers are the steps that compute them.

use crate::arithmetic::Arithmetic;
use crate::array::Array;
use crate::evaluate::{Unvalued, evaluate};
use crate::kernel::Kernel;
use crate::operation::{Number, Single};
use crate::tape::{Function, Recording, Scalar, Step, Tape};
use std::cell::RefCell;

impl Tape {
    /// Records a kernel. `sizes` gives the sizes of declared names.
    ///
    /// # Errors
    /// [`Unvalued`] if the kernel has an operation whose steps depend on values, such as an inverse with pivoting.
    pub fn of(kernel: &Kernel, sizes: &[usize]) -> Result<Tape, Unvalued> {
        let recorder = Recorder::default();
        let mut count = 0;
        let mut inputs = Vec::new();
        for input in kernel.inputs() {
            let shape = input.kind.shape();
            let size = |dim: crate::Dim| dim.size(sizes).ok_or(Unvalued::Size(dim));
            inputs.push(Array::from_fn(
                size(shape.rows)?,
                size(shape.cols)?,
                |_, _| {
                    count += 1;
                    recorder.step(Step::Input(count - 1))
                },
            ));
        }
        let outputs = evaluate(&recorder, kernel, &inputs, sizes)?;
        let outputs = outputs.iter().flat_map(|a| a.columns().to_vec()).collect();
        Ok(recorder.recording.into_inner().tape(outputs))
    }
}

/// An arithmetic that records operations. Powers and roots become the operations of the runtime's numbers.
#[derive(Debug, Default)]
pub struct Recorder {
    recording: RefCell<Recording>,
}

impl Recorder {
    fn step(&self, step: Step) -> Scalar {
        self.recording.borrow_mut().step(step)
    }

    fn double(&self, x: f64) -> Scalar {
        self.recording.borrow_mut().double(x)
    }

    /// -1, 0 or 1 by the sign; NaN for a non-finite number.
    fn sign(&self, a: Scalar) -> Scalar {
        let (zero, one) = (self.double(0.0), self.double(1.0));
        let up = self.step(Step::WherePositive(a, one));
        let down = self.step(Step::WherePositive(self.neg(a), one));
        self.add(self.sub(up, down), self.mul(zero, a))
    }
}

impl Arithmetic for Recorder {
    type Number = Scalar;

    fn constant(&self, number: Number) -> Scalar {
        self.double(match number {
            Number::Double(x) => x,
            Number::Ratio(num, den) => num as f64 / den as f64,
            Number::Pi => core::f64::consts::PI,
        })
    }

    fn add(&self, a: Scalar, b: Scalar) -> Scalar {
        self.step(Step::Add(a, b))
    }

    fn sub(&self, a: Scalar, b: Scalar) -> Scalar {
        self.step(Step::Sub(a, b))
    }

    fn mul(&self, a: Scalar, b: Scalar) -> Scalar {
        self.step(Step::Mul(a, b))
    }

    fn div(&self, a: Scalar, b: Scalar) -> Scalar {
        self.step(Step::Div(a, b))
    }

    fn neg(&self, a: Scalar) -> Scalar {
        self.step(Step::Neg(a))
    }

    fn function(&self, which: Single, a: Scalar) -> Scalar {
        let function = match which {
            Single::Sqrt => Function::Sqrt,
            Single::Exp => Function::Exp,
            Single::Log => Function::Log,
            Single::Sin => Function::Sin,
            Single::Cos => Function::Cos,
            Single::Sinh => Function::Sinh,
            Single::Cosh => Function::Cosh,
            Single::Tanh => Function::Tanh,
            Single::Sign => return self.sign(a),
            Single::Abs => return self.mul(a, self.sign(a)),
            // Not functions of a number; the evaluation never requests them.
            _ => return self.double(f64::NAN),
        };
        self.step(Step::Function(function, a))
    }

    /// By repeated squaring.
    fn power(&self, a: Scalar, exponent: i32) -> Scalar {
        let (mut square, mut rest) = (a, exponent.unsigned_abs());
        let mut power = self.double(1.0);
        while rest > 0 {
            if rest & 1 == 1 {
                power = self.mul(power, square);
            }
            rest >>= 1;
            if rest > 0 {
                square = self.mul(square, square);
            }
        }
        match exponent < 0 {
            true => self.div(self.double(1.0), power),
            false => power,
        }
    }

    /// Integer and half-integer exponents use products and at most one square root; others use logarithm and exponential.
    fn root(&self, a: Scalar, num: i64, den: i64) -> Scalar {
        let (num, den) = lowest_terms(num, den);
        match (i32::try_from(num), den) {
            (Ok(n), 1) => self.power(a, n),
            (Ok(n), 2) => self.power(self.function(Single::Sqrt, a), n),
            (_, 0) => self.double(f64::NAN),
            _ => {
                let exponent = self.constant(Number::Ratio(num, den));
                let log = self.function(Single::Log, a);
                self.function(Single::Exp, self.mul(log, exponent))
            }
        }
    }

    /// An inverse needs pivoting, which a kernel's tape cannot contain.
    fn inverse(&self, _: &Array<Scalar>) -> Option<Array<Scalar>> {
        None
    }

    fn determinant(&self, _: &Array<Scalar>) -> Option<Scalar> {
        None
    }
}

/// `num/den` with a non-negative denominator and no common factor.
fn lowest_terms(num: i64, den: i64) -> (i64, i64) {
    let (mut a, mut b) = (num.unsigned_abs(), den.unsigned_abs());
    while b != 0 {
        (a, b) = (b, a % b);
    }
    match i64::try_from(a) {
        Ok(divisor) if divisor > 0 => {
            let sign = if den < 0 { -1 } else { 1 };
            let over = |x: i64| (x / divisor).saturating_mul(sign);
            (over(num), over(den))
        }
        _ => (num, den),
    }
}
