//! Counts the work of a step with a number type that records every operation. Takes a model and a state over plain numbers; gives
//! the operations and bytes of one step, including solvers.

use clebsch::integrate::{Model, Stepper};
use clebsch::num_traits::{One, Zero};
use clebsch::{OfScalars, Real};
use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// Operations of one step, and bytes of its state and workspace.
#[derive(Clone, Copy, Debug, Default)]
pub struct Work {
    /// Additions, subtractions and multiplications.
    pub operations: f64,
    /// Divisions and square roots; each takes about as long as ten other operations.
    pub divisions: f64,
    /// Exponentials, logarithms, sines and other functions.
    pub functions: f64,
    /// Bytes of the state and the workspace.
    pub bytes: usize,
}

/// Steps for the average, because the number of iterations differs from step to step.
const STEPS: u32 = 200;

thread_local! {
    static OPERATIONS: Cell<u64> = const { Cell::new(0) };
    static DIVISIONS: Cell<u64> = const { Cell::new(0) };
    static FUNCTIONS: Cell<u64> = const { Cell::new(0) };
}

fn note(counter: &'static std::thread::LocalKey<Cell<u64>>) {
    counter.with(|count| count.set(count.get() + 1));
}

fn taken() -> [u64; 3] {
    [OPERATIONS.take(), DIVISIONS.take(), FUNCTIONS.take()]
}

/// The mean work of a step of size `h` over the steps from this state; `None` if a step fails.
pub fn work_of<M: Model<Scalar = f64>>(model: &M, state: &M::State, h: f64) -> Option<Work> {
    let counted = |x: f64| Counted(x);
    let model = <M::Over<Counted>>::of(model.given().over(&mut { counted })).ok()?;
    let mut state = state.over(&mut { counted });
    let mut work = model.prepare(&state, Counted(h), Default::default()).ok()?;
    taken();
    for _ in 0..STEPS {
        model.advance(&mut state, &mut work).ok()?;
    }
    let [operations, divisions, functions] = taken().map(|n| n as f64 / f64::from(STEPS));
    Some(Work {
        operations,
        divisions,
        functions,
        // `Counted` has the size of a double.
        bytes: size_of_val(&state) + size_of_val(&work),
    })
}

/// A double that records its operations. Signs and comparisons are not counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counted(f64);

macro_rules! operation {
    ($trait:ident, $method:ident, $assign:ident, $in_place:ident, $counter:ident, $sign:tt) => {
        impl $trait for Counted {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                note(&$counter);
                Self(self.0 $sign other.0)
            }
        }
        impl $assign for Counted {
            fn $in_place(&mut self, other: Self) {
                *self = *self $sign other;
            }
        }
    };
}

operation!(Add, add, AddAssign, add_assign, OPERATIONS, +);
operation!(Sub, sub, SubAssign, sub_assign, OPERATIONS, -);
operation!(Mul, mul, MulAssign, mul_assign, OPERATIONS, *);
operation!(Div, div, DivAssign, div_assign, DIVISIONS, /);

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Zero for Counted {
    fn zero() -> Self {
        Self(0.0)
    }
    fn is_zero(&self) -> bool {
        self.0 == 0.0
    }
}

impl One for Counted {
    fn one() -> Self {
        Self(1.0)
    }
}

macro_rules! functions {
    ($($name:ident)*) => {
        $(fn $name(self) -> Self {
            note(&FUNCTIONS);
            Self(f64::$name(self.0))
        })*
    };
}

impl Real for Counted {
    type One = Self;
    const EPSILON: f64 = <f64 as Real>::EPSILON;

    fn one_of(&self, _: usize) -> Self {
        *self
    }
    fn set_lane(&mut self, _: usize, one: Self) {
        *self = one;
    }
    fn from_f64(x: f64) -> Self {
        Self(x)
    }
    fn value(self) -> f64 {
        self.0
    }
    fn magnitude(self) -> f64 {
        self.0.abs()
    }
    fn least(self) -> f64 {
        self.0
    }
    fn greatest(self) -> f64 {
        self.0
    }
    fn where_positive(self, then: Self) -> Self {
        if self.0 > 0.0 { then } else { Self(0.0) }
    }
    fn sqrt(self) -> Self {
        note(&DIVISIONS);
        Self(self.0.sqrt())
    }
    functions!(exp ln sin cos sinh cosh tanh);
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
}

/// A block of steps that is ready to run, and the work of one step.
pub struct Block<F> {
    /// The work of one step.
    pub work: Work,
    /// The steps.
    pub run: F,
}
