//! A recorded evaluation: scalar operations in single assignment, equal ones computed once.

use crate::arithmetic::Arithmetic;
use crate::array::Array;
use crate::evaluate::{Unvalued, evaluate};
use crate::kernel::Kernel;
use crate::operation::{Number, Single};
use std::cell::RefCell;
use std::collections::HashMap;

/// A number of a tape: the step that computes it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Scalar(u32);

impl Scalar {
    /// The number of its step.
    #[must_use]
    pub fn step(self) -> usize {
        self.0 as usize
    }
}

/// A step of a tape. Constants are kept by their bits: equal steps are one.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Step {
    /// An input by its place among all numbers of all inputs.
    Input(u32),
    /// A constant of binary64, by its bits.
    Double(u64),
    /// A quotient of whole numbers.
    Ratio(i64, i64),
    /// π.
    Pi,
    /// The sum.
    Add(Scalar, Scalar),
    /// The difference.
    Sub(Scalar, Scalar),
    /// The product.
    Mul(Scalar, Scalar),
    /// The quotient.
    Div(Scalar, Scalar),
    /// The negative.
    Neg(Scalar),
    /// A function of one number.
    Function(Single, Scalar),
    /// A whole power.
    Power(Scalar, i32),
    /// A rational power.
    Root(Scalar, i64, i64),
}

/// Scalar operations in single assignment.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Tape {
    /// The steps, each after those that it uses.
    pub steps: Vec<Step>,
    /// The results, each array column after column.
    pub outputs: Vec<Scalar>,
}

impl Tape {
    /// Records a kernel. `sizes` belong to declared names.
    ///
    /// # Errors
    /// [`Unvalued`] if the kernel has an operation whose steps depend on values, such as an inverse with pivots.
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
        Ok(Tape {
            steps: recorder.steps.into_inner().list,
            outputs,
        })
    }

    /// The results over any arithmetic; `inputs` are the numbers of all inputs, each array column after column.
    ///
    /// # Errors
    /// [`Unvalued`] if an input is missing.
    pub fn run<A: Arithmetic>(
        &self,
        on: &A,
        inputs: &[A::Number],
    ) -> Result<Vec<A::Number>, Unvalued> {
        let mut all: Vec<A::Number> = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            let of = |x: &Scalar| all[x.step()];
            let value = match step {
                Step::Input(at) => *inputs
                    .get(*at as usize)
                    .ok_or_else(|| Unvalued::Input(format!("number {at}")))?,
                Step::Double(bits) => on.constant(Number::Double(f64::from_bits(*bits))),
                Step::Ratio(num, den) => on.constant(Number::Ratio(*num, *den)),
                Step::Pi => on.constant(Number::Pi),
                Step::Add(a, b) => on.add(of(a), of(b)),
                Step::Sub(a, b) => on.sub(of(a), of(b)),
                Step::Mul(a, b) => on.mul(of(a), of(b)),
                Step::Div(a, b) => on.div(of(a), of(b)),
                Step::Neg(a) => on.neg(of(a)),
                Step::Function(which, a) => on.function(*which, of(a)),
                Step::Power(a, n) => on.power(of(a), *n),
                Step::Root(a, num, den) => on.root(of(a), *num, *den),
            };
            all.push(value);
        }
        Ok(self.outputs.iter().map(|x| all[x.step()]).collect())
    }
}

/// An arithmetic that notes what is done.
#[derive(Debug, Default)]
pub struct Recorder {
    steps: RefCell<Steps>,
}

#[derive(Debug, Default)]
struct Steps {
    list: Vec<Step>,
    known: HashMap<Step, Scalar>,
}

impl Recorder {
    fn step(&self, step: Step) -> Scalar {
        let mut steps = self.steps.borrow_mut();
        if let Some(known) = steps.known.get(&step) {
            return *known;
        }
        // A tape of four billion steps would need 64 GiB: the work limit of a derivation ends long before.
        let scalar = Scalar(u32::try_from(steps.list.len()).unwrap_or(u32::MAX));
        steps.list.push(step);
        steps.known.insert(step, scalar);
        scalar
    }
}

impl Arithmetic for Recorder {
    type Number = Scalar;

    fn constant(&self, number: Number) -> Scalar {
        self.step(match number {
            Number::Double(x) => Step::Double(x.to_bits()),
            Number::Ratio(num, den) => Step::Ratio(num, den),
            Number::Pi => Step::Pi,
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
        self.step(Step::Function(which, a))
    }

    fn power(&self, a: Scalar, exponent: i32) -> Scalar {
        self.step(Step::Power(a, exponent))
    }

    fn root(&self, a: Scalar, num: i64, den: i64) -> Scalar {
        self.step(Step::Root(a, num, den))
    }

    /// An inverse looks for pivots, which a tape cannot.
    fn inverse(&self, _: &Array<Scalar>) -> Option<Array<Scalar>> {
        None
    }

    fn determinant(&self, _: &Array<Scalar>) -> Option<Scalar> {
        None
    }
}
