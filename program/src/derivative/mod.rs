//! Derivatives of tapes, as tapes: first derivatives along directions, and their transposes.
//!
//! Both keep the decisions of the tape, so they are valid where the tape is. They can be derived again, compiled and run side by side
//! like any other tape. A tape with calls of whole functions lacks derivatives: record the functions operation by operation instead.

mod adjoint;
mod tangent;

use crate::tape::{Function, Guard, Recording, Scalar, Step, Tape, Test};

/// A copy of a tape within a recording: the number there for each step.
struct Copied {
    recording: Recording,
    steps: Vec<Scalar>,
}

impl Copied {
    /// Copies all steps and decisions. Returns `None` for a tape with calls.
    fn of(tape: &Tape) -> Option<Self> {
        if !tape.calls.is_empty() {
            return None;
        }
        let mut recording = Recording::default();
        let mut steps: Vec<Scalar> = Vec::with_capacity(tape.steps.len());
        for step in &tape.steps {
            let at = |x: Scalar| steps[x.step()];
            let own = match *step {
                Step::Input(_) | Step::Double(_) | Step::Output(..) => *step,
                Step::Add(a, b) => Step::Add(at(a), at(b)),
                Step::Sub(a, b) => Step::Sub(at(a), at(b)),
                Step::Mul(a, b) => Step::Mul(at(a), at(b)),
                Step::Div(a, b) => Step::Div(at(a), at(b)),
                Step::Neg(a) => Step::Neg(at(a)),
                Step::Function(f, a) => Step::Function(f, at(a)),
                Step::WherePositive(a, b) => Step::WherePositive(at(a), at(b)),
            };
            steps.push(recording.step(own));
        }
        for Guard { test, holds } in &tape.guards {
            let at = |x: Scalar| steps[x.step()];
            let own = match *test {
                Test::AtMost(a, b) => Test::AtMost(at(a), at(b)),
                Test::Less(a, b) => Test::Less(at(a), at(b)),
                Test::Equal(a, b) => Test::Equal(at(a), at(b)),
                Test::Finite(a) => Test::Finite(at(a)),
            };
            recording.guard(own, *holds);
        }
        Some(Copied { recording, steps })
    }

    /// The input with this index.
    fn input(&mut self, index: usize) -> Scalar {
        // A tape has fewer inputs than steps, and these are counted by 32 bits.
        self.recording
            .step(Step::Input(u32::try_from(index).unwrap_or(u32::MAX)))
    }

    /// The product of `weight` and the derivative of a function at step `at`, whose argument is `of`. `None` where the derivative is
    /// zero everywhere. The derivative of the square root of zero counts as zero.
    fn times_slope(
        &mut self,
        weight: Scalar,
        function: Function,
        [of, at]: [usize; 2],
    ) -> Option<Scalar> {
        let (x, y) = (self.steps[of], self.steps[at]);
        let own = &mut self.recording;
        Some(match function {
            Function::Sqrt => {
                let twice = own.step(Step::Add(y, y));
                let slope = own.step(Step::Div(weight, twice));
                own.step(Step::WherePositive(y, slope))
            }
            Function::Exp => own.step(Step::Mul(weight, y)),
            Function::Log => own.step(Step::Div(weight, x)),
            Function::Sin => {
                let slope = own.step(Step::Function(Function::Cos, x));
                own.step(Step::Mul(weight, slope))
            }
            Function::Cos => {
                let slope = own.step(Step::Function(Function::Sin, x));
                let product = own.step(Step::Mul(weight, slope));
                own.step(Step::Neg(product))
            }
            Function::Sinh => {
                let slope = own.step(Step::Function(Function::Cosh, x));
                own.step(Step::Mul(weight, slope))
            }
            Function::Cosh => {
                let slope = own.step(Step::Function(Function::Sinh, x));
                own.step(Step::Mul(weight, slope))
            }
            Function::Tanh => {
                let square = own.step(Step::Mul(y, y));
                let one = own.double(1.0);
                let slope = own.step(Step::Sub(one, square));
                own.step(Step::Mul(weight, slope))
            }
            Function::Balance => return None,
        })
    }

    /// The sum; a missing term is zero.
    fn sum(&mut self, a: Option<Scalar>, b: Option<Scalar>) -> Option<Scalar> {
        match (a, b) {
            (Some(a), Some(b)) => Some(self.recording.step(Step::Add(a, b))),
            (one, other) => one.or(other),
        }
    }

    /// The number; zero if it is missing.
    fn or_zero(&mut self, x: Option<Scalar>) -> Scalar {
        x.unwrap_or_else(|| self.recording.double(0.0))
    }
}
