//! A scalar that records its operations, so that a single evaluation of generic code becomes a tape.
//!
//! If the code decides by methods of [`Real`] that return a truth value, the decisions become guards of the tape. If
//! a number leaves the tape in any other way, as with `value()`, the recording is invalid, since it cannot see later
//! decisions.

use super::solves::{RecordingPause, SolvedHere};
use clebsch::Real;
use clebsch_program::{Function, Guard, Recording, Scalar, Step, Tape, Test};
use num_traits::{One, Zero};
use std::cell::RefCell;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A number with the step that computes it; constants have none.
#[derive(Clone, Copy, Debug)]
pub struct Traced {
    value: f64,
    at: Option<Scalar>,
}

/// The recording of this thread.
#[derive(Default)]
struct Here {
    recording: Recording,
    /// The values of the inputs.
    inputs: Vec<f64>,
    spoiled: bool,
    cuts: Vec<RecordingPause>,
    /// Whether derivatives of the tape must be exact, too.
    has_derivatives: bool,
    /// The number of first inputs that are the same whenever the tape runs.
    steady: usize,
    /// For the first steps, whether they depend on other inputs.
    late: Vec<bool>,
}

impl Here {
    /// Whether a number depends on inputs that change.
    fn is_late(&mut self, at: Option<Scalar>) -> bool {
        let Some(at) = at else {
            return false;
        };
        for step in self.recording.steps().iter().skip(self.late.len()) {
            let by_use = step.uses().into_iter().flatten();
            let by_use = by_use.fold(false, |any, used| any | self.late[used.step()]);
            let is_late = match step {
                Step::Input(index) => *index as usize >= self.steady,
                Step::Output(..) => true,
                _ => by_use,
            };
            self.late.push(is_late);
        }
        self.late.get(at.step()).copied().unwrap_or(true)
    }
}

thread_local! {
    static HERE: RefCell<Option<Here>> = const { RefCell::new(None) };
}

/// Maximum number of steps of a tape; longer evaluations are not recorded.
const MOST: usize = 1 << 17;

/// Maximum number of steps of a tape whose derivatives are exact: about 2 GiB with its derivatives.
const MOST_WITH_DERIVATIVES: usize = 1 << 25;

/// Records `body`, which returns the numbers that the tape computes. Returns nothing if they depend on more than tests
/// of numbers, or if the tape is too long.
pub fn record(body: impl FnOnce() -> Option<Vec<Traced>>) -> Option<(Tape, usize)> {
    let (tape, inputs, cuts) = record_with_solves(body)?;
    cuts.is_empty().then_some((tape, inputs))
}

/// Like [`record`], for a function that solves equations.
pub fn record_with_solves(
    body: impl FnOnce() -> Option<Vec<Traced>>,
) -> Option<(Tape, usize, Vec<RecordingPause>)> {
    HERE.set(Some(Here::default()));
    let outputs = body();
    let mut here = HERE.take()?;
    let fits = !here.spoiled && here.recording.len() <= MOST;
    let outputs = outputs.filter(|_| fits)?;
    let steps = outputs.iter().map(|x| x.step_in(&mut here.recording));
    let steps: Vec<Scalar> = steps.collect();
    Some((here.recording.tape(steps), here.inputs.len(), here.cuts))
}

/// A recording with exact derivatives.
#[derive(Debug)]
pub struct WithDerivatives {
    /// The operations. Iterations take one correction more than for values alone, which makes first derivatives exact.
    pub tape: Tape,
    /// The inputs of the recorded evaluation. Solutions of equations are inputs, too; the tape corrects them once.
    pub inputs: Vec<f64>,
    /// Whether the tape also serves other inputs, as long as its decisions come out as recorded.
    pub serves_others: bool,
}

/// Records `body` with exact derivatives, for runs whose first `steady` inputs stay the same. Returns nothing if it gives
/// nothing, or if the tape is too long.
pub fn record_with_derivatives(
    steady: usize,
    body: impl FnOnce() -> Option<Vec<Traced>>,
) -> Option<WithDerivatives> {
    HERE.set(Some(Here {
        has_derivatives: true,
        steady,
        ..Here::default()
    }));
    let outputs = body();
    let mut here = HERE.take()?;
    let outputs = outputs.filter(|_| here.recording.len() <= MOST_WITH_DERIVATIVES)?;
    let steps = outputs.iter().map(|x| x.step_in(&mut here.recording));
    let steps: Vec<Scalar> = steps.collect();
    Some(WithDerivatives {
        tape: here.recording.tape(steps),
        inputs: here.inputs,
        serves_others: !here.spoiled,
    })
}

/// Whether the recording of this thread has exact derivatives.
pub fn has_derivatives() -> bool {
    noted(|here| here.has_derivatives).unwrap_or(false)
}

/// Ends a part of the recording. The solution of the equations is the input of the next part.
pub fn cut(solved: SolvedHere) {
    noted(|here| {
        here.cuts.push(RecordingPause {
            guards: here.recording.guards(),
            inputs: here.inputs.len(),
            solved,
        });
    });
}

/// Records a computation aside from the step. Returns its value with its own decisions; the step does not depend on
/// them. `None` if a decision uses more than tests of numbers.
pub fn aside<R>(body: impl FnOnce() -> Option<R>) -> Option<(R, Vec<Guard>)> {
    let before = noted(|here| {
        let spoiled = std::mem::replace(&mut here.spoiled, false);
        (here.recording.begin_aside(), spoiled)
    });
    let value = body();
    let (decisions, spoiled) = before?;
    let (guards, spoilt) = noted(|here| {
        let spoilt = std::mem::replace(&mut here.spoiled, spoiled);
        (here.recording.end_aside(decisions), spoilt)
    })?;
    value.filter(|_| !spoilt).map(|value| (value, guards))
}

/// The steps that compute numbers.
pub fn steps(numbers: &[Traced]) -> Vec<Scalar> {
    let made = noted(|here| {
        let steps = numbers.iter().map(|x| x.step_in(&mut here.recording));
        steps.collect()
    });
    made.unwrap_or_default()
}

/// Changes the newest pause.
pub fn with_newest_cut<R>(what: impl FnOnce(&mut RecordingPause) -> R) -> Option<R> {
    noted(|here| here.cuts.last_mut().map(what)).flatten()
}

/// Changes the first pause for which `what` gives a value.
pub fn with_some_cut<R>(what: impl FnMut(&mut RecordingPause) -> Option<R>) -> Option<R> {
    noted(|here| here.cuts.iter_mut().find_map(what)).flatten()
}

/// Changes the recording, if there is one.
fn noted<R>(what: impl FnOnce(&mut Here) -> R) -> Option<R> {
    HERE.with_borrow_mut(|here| here.as_mut().map(what))
}

impl Traced {
    /// A constant.
    pub const fn constant(value: f64) -> Self {
        Traced { value, at: None }
    }

    /// The next input, with the value that it has while the tape is recorded.
    pub fn input(value: f64) -> Self {
        let at = noted(|here| {
            here.inputs.push(value);
            let last = u32::try_from(here.inputs.len() - 1).unwrap_or(u32::MAX);
            here.recording.step(Step::Input(last))
        });
        Traced { value, at }
    }

    /// Its value during the recording, which must not influence a decision.
    pub fn seen(self) -> f64 {
        self.value
    }

    /// The step that computes it.
    pub fn at(self) -> Option<Scalar> {
        self.at
    }

    fn step_in(self, recording: &mut Recording) -> Scalar {
        match self.at {
            Some(at) => at,
            None => recording.double(self.value),
        }
    }

    fn one(self, value: f64, step: impl FnOnce(Scalar) -> Step) -> Self {
        let made = |at| noted(|here| here.recording.step(step(at)));
        Traced {
            value,
            at: self.at.and_then(made),
        }
    }

    fn two(self, other: Self, value: f64, step: impl FnOnce(Scalar, Scalar) -> Step) -> Self {
        if self.at.is_none() && other.at.is_none() {
            return Traced::constant(value);
        }
        let at = noted(|here| {
            let a = self.step_in(&mut here.recording);
            let b = other.step_in(&mut here.recording);
            here.recording.step(step(a, b))
        });
        Traced { value, at }
    }

    fn function(self, function: Function) -> Self {
        self.one(function.of(self.value), |a| Step::Function(function, a))
    }

    /// Records the outcome of a comparison of two numbers.
    fn asked(self, other: Self, holds: bool, test: impl FnOnce(Scalar, Scalar) -> Test) -> bool {
        if self.at.is_some() || other.at.is_some() {
            noted(|here| {
                let a = self.step_in(&mut here.recording);
                let b = other.step_in(&mut here.recording);
                here.recording.guard(test(a, b), holds);
            });
        }
        holds
    }

    /// Takes the value off the tape, which invalidates the recording.
    fn read(self) -> f64 {
        if self.at.is_some() {
            noted(|here| here.spoiled |= here.is_late(self.at));
        }
        self.value
    }
}

impl PartialEq for Traced {
    fn eq(&self, other: &Self) -> bool {
        self.asked(*other, self.value == other.value, Test::Equal)
    }
}

macro_rules! operators {
    ($($Trait:ident $method:ident $Assign:ident $assign:ident $op:tt),*) => {$(
        impl $Trait for Traced {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.two(other, self.value $op other.value, Step::$Trait)
            }
        }
        impl $Assign for Traced {
            fn $assign(&mut self, other: Self) {
                *self = *self $op other;
            }
        }
    )*};
}

operators!(
    Add add AddAssign add_assign +,
    Sub sub SubAssign sub_assign -,
    Mul mul MulAssign mul_assign *,
    Div div DivAssign div_assign /
);

impl Neg for Traced {
    type Output = Self;
    fn neg(self) -> Self {
        self.one(-self.value, Step::Neg)
    }
}

impl Zero for Traced {
    fn zero() -> Self {
        Traced::constant(0.0)
    }

    fn is_zero(&self) -> bool {
        *self == Self::zero()
    }
}

impl One for Traced {
    fn one() -> Self {
        Traced::constant(1.0)
    }
}

impl Real for Traced {
    type One = Self;
    const EPSILON: f64 = <f64 as Real>::EPSILON;

    fn order() -> u32 {
        u32::from(has_derivatives())
    }

    fn from_f64(x: f64) -> Self {
        Traced::constant(x)
    }

    fn value(self) -> f64 {
        self.read()
    }

    fn one_of(&self, _: usize) -> Self {
        *self
    }

    fn set_lane(&mut self, _: usize, one: Self) {
        *self = one;
    }

    fn magnitude(self) -> f64 {
        self.read().abs()
    }

    fn least(self) -> f64 {
        self.read()
    }

    fn greatest(self) -> f64 {
        self.read()
    }

    fn nowhere_positive(self) -> bool {
        self.asked(Self::zero(), self.value <= 0.0, Test::AtMost)
    }

    fn exceeds(self, other: Self) -> bool {
        other.asked(self, self.value > other.value, Test::Less)
    }

    fn is_below(self, bound: f64) -> bool {
        self.asked(Self::from_f64(bound), self.value < bound, Test::Less)
    }

    fn where_positive(self, then: Self) -> Self {
        let value = if self.value > 0.0 { then.value } else { 0.0 };
        match self.at {
            // A decision on a constant never changes.
            None if self.value > 0.0 => then,
            None => Self::zero(),
            Some(_) => self.two(then, value, Step::WherePositive),
        }
    }

    fn sqrt(self) -> Self {
        self.function(Function::Sqrt)
    }

    fn exp(self) -> Self {
        self.function(Function::Exp)
    }

    fn ln(self) -> Self {
        self.function(Function::Log)
    }

    fn sin(self) -> Self {
        self.function(Function::Sin)
    }

    fn cos(self) -> Self {
        self.function(Function::Cos)
    }

    fn sinh(self) -> Self {
        self.function(Function::Sinh)
    }

    fn cosh(self) -> Self {
        self.function(Function::Cosh)
    }

    fn tanh(self) -> Self {
        self.function(Function::Tanh)
    }

    fn balance(self) -> Self {
        self.function(Function::Balance)
    }

    fn whole(
        function: fn(&[usize], &[f64], &mut [f64]),
        sizes: &[usize],
        inputs: &dyn Fn() -> Vec<Self>,
        outputs: usize,
    ) -> Option<Vec<Self>> {
        if has_derivatives() {
            return None;
        }
        let inputs = inputs();
        // A call on constants is computed now.
        if inputs.iter().all(|x| x.at.is_none()) {
            return None;
        }
        let numbers: Vec<f64> = inputs.iter().map(|x| x.value).collect();
        let mut values = vec![f64::NAN; outputs];
        function(sizes, &numbers, &mut values);
        noted(|here| {
            let own = inputs.iter().map(|x| x.step_in(&mut here.recording));
            let own: Vec<Scalar> = own.collect();
            let steps = here.recording.call(function, sizes, own, outputs);
            let made = steps.into_iter().zip(values);
            made.map(|(at, value)| Traced {
                value,
                at: Some(at),
            })
            .collect()
        })
    }

    fn is_finite(self) -> bool {
        self.asked(self, self.value.is_finite(), |a, _| Test::Finite(a))
    }
}
