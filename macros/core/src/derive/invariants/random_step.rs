//! One step in exact arithmetic: random parameters, elements and velocities, the momentum at the start from the
//! outgoing edge and at the end from the incoming one. A quantity with equal values at both ends of a few such steps
//! is conserved. Any other quantity differs at one of them with probability above 1 - 1e-15.

use super::draws::Roots;
use super::{Inputs, here};
use crate::algebra::assumed;
use crate::algebra::exact::{ATTEMPTS, Matrix, Point};
use crate::expr::{Expr, Letter, Shift};

/// The number of steps that an invariant must pass.
const STEPS: usize = 4;

/// The number of steps with assumptions, whose branches alternate.
const STEPS_ASSUMED: usize = 8;

/// Both ends of one step.
#[derive(Clone)]
pub(crate) struct RandomStep<'a> {
    /// Letters at the node where the step starts, including the node momentum.
    pub(crate) before: Point<'a>,
    /// The letters at the node where the step ends.
    pub(crate) after: Point<'a>,
}

impl RandomStep<'_> {
    /// Whether the value is equal at both ends.
    pub(crate) fn keeps(&self, value: &Expr) -> bool {
        match (self.before.value(value), self.after.value(value)) {
            (Some(a), Some(b)) => a == b,
            _ => false,
        }
    }
}

/// A few steps, as far as there are points at which all expressions are defined.
pub(crate) fn random_steps<'a>(
    x: &Inputs<'a>,
    roots: &Roots,
    assumed: &[Expr],
) -> Vec<RandomStep<'a>> {
    let wanted = if assumed.is_empty() {
        STEPS
    } else {
        STEPS_ASSUMED
    };
    let found = (0..ATTEMPTS).filter_map(|attempt| passage(x, roots, assumed, attempt));
    found.take(wanted).collect()
}

fn passage<'a>(
    x: &Inputs<'a>,
    roots: &Roots,
    equations: &[Expr],
    attempt: u64,
) -> Option<RandomStep<'a>> {
    let mut before = start(x, roots, equations, attempt)?;
    roots.led(x, &mut before, attempt)?;
    completed(x, before)
}

/// The data at the start of a step: parameters, elements, velocities, advected quantities.
pub(super) fn start<'a>(
    x: &Inputs<'a>,
    roots: &Roots,
    equations: &[Expr],
    attempt: u64,
) -> Option<Point<'a>> {
    let mut before = assumed::point(&x.letters.symbols, attempt, equations)?;
    // Computed once, because elements of orthogonal groups cost an inversion.
    for c in &x.spec.configurations {
        for l in [here(c.element), here(c.velocity)] {
            let value = before.letter(l)?;
            before.set(l, value);
        }
    }
    roots.placed(x, &mut before, attempt)?;
    for a in &x.spec.advected {
        let value = match &a.definition {
            Some(d) => before.value(d)?,
            None => before.letter(here(a.quantity))?,
        };
        before.set(here(a.quantity), value);
    }
    Some(before)
}

/// The step from this start.
pub(super) fn completed<'a>(x: &Inputs<'a>, mut before: Point<'a>) -> Option<RandomStep<'a>> {
    let next = |l: Letter| Letter {
        symbol: l.symbol,
        shift: Shift::NEXT,
    };
    let mut moved: Vec<(Letter, Matrix)> = Vec::new();
    for c in &x.spec.configurations {
        moved.push((here(c.element), before.value(&c.update)?));
    }
    for a in &x.spec.advected {
        moved.push((here(a.quantity), before.value(&a.update)?));
    }
    for (l, value) in &moved {
        before.set(next(*l), value.clone());
    }
    let mut momenta: Vec<(Letter, Matrix)> = Vec::new();
    for (b, id) in x.balances.iter().zip(&x.letters.node_momentum) {
        momenta.push((here(*id), before.value(&b.outgoing)?));
        moved.push((here(*id), before.value(&b.incoming)?));
    }
    for (l, value) in momenta {
        before.set(l, value);
    }
    let mut after = before.clone();
    for (l, value) in moved {
        after.set(l, value);
    }
    Some(RandomStep { before, after })
}
