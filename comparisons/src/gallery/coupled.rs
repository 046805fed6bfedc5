//! Two bodies with a spherical joint: the hand-written stepper, and Runge-Kutta methods for hand-written equations. The parameters
//! of a case are (J1, J2, d1, d2, eps).

use super::{LOOSE, Method, Offer, Problem, TIGHT, by_hand, check, eighth, fifth, reference, rows};
use crate::continuous::coupled::CoupledBodies;
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{Matrix, Quaternion, Vector};
use crate::handwritten::coupled_bodies::{CoupledBodies as Written, Pair};
use crate::runge_kutta::{Accuracy, Method54, Method85, Method98, RungeKutta, Scheme};

struct Moving<R>(RungeKutta<R, CoupledBodies, 14>);

impl<R: Scheme<14>> Method for Moving<R> {
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.0.step()
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        let halves = self.0.state().chunks(7);
        let shown = halves.flat_map(|half| match *half {
            [w, x, y, z, a, b, c] => {
                let attitude = Quaternion([w, x, y, z]).normalised().matrix();
                vec![rows(&attitude), vec![a, b, c]]
            }
            _ => Vec::new(),
        });
        shown.collect()
    }
}

struct ByHand(Written);

impl Method for ByHand {
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.0.step()
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        let both = self.0.attitudes().into_iter().zip(self.0.body_momenta());
        both.flat_map(|(q, mu)| [rows(&q.matrix()), mu.to_vec()])
            .collect()
    }
}

/// A case: the two bodies, their attitudes, and their body momenta.
fn read(problem: &Problem<'_>) -> Option<(Pair, [Quaternion; 2], [Vector; 2])> {
    let poinsots: [Matrix; 2] = [problem.parameter(0)?, problem.parameter(1)?];
    let arms = [problem.parameter(2)?, problem.parameter(3)?];
    let eps = problem.parameter(4)?;
    let pair = Pair {
        poinsots,
        arms,
        eps,
    };
    let attitudes = [problem.initial(0)?, problem.initial(2)?];
    Some((pair, attitudes, [problem.initial(1)?, problem.initial(3)?]))
}

fn written(problem: &Problem<'_>) -> Result<Box<dyn Method>, Unsolvable> {
    let (pair, attitudes, momenta) = read(problem).ok_or(Unsolvable)?;
    let motion = Written::start(&pair, &attitudes, &momenta, problem.h)?;
    Ok(Box::new(ByHand(motion)))
}

fn runge_kutta<R: Scheme<14> + 'static>(
    problem: &Problem<'_>,
    accuracy: Accuracy,
) -> Result<Box<dyn Method>, Unsolvable> {
    let (pair, [p, q], [m, n]) = read(problem).ok_or(Unsolvable)?;
    let parts = p.0.iter().chain(&m).chain(&q.0).chain(&n);
    let start: Vec<f64> = parts.copied().collect();
    let start: [f64; 14] = start.try_into().map_err(|_| Unsolvable)?;
    let bodies = CoupledBodies::new(pair.poinsots, pair.arms, pair.eps);
    let motion = RungeKutta::<R, _, 14>::start(bodies, &start, problem.h, accuracy)?;
    Ok(Box::new(Moving(motion)))
}

/// Dormand and Prince 5(4) with its smallest tolerance.
pub(super) fn ode45(problem: &Problem<'_>) -> Result<Box<dyn Method>, Unsolvable> {
    runge_kutta::<Method54<14>>(problem, Accuracy::of(super::SMALLEST))
}

/// The available methods.
pub(super) fn bodies() -> Vec<Offer> {
    vec![
        reference(|p| runge_kutta::<Method98<14>>(p, Accuracy::reference(2))),
        check(|p| runge_kutta::<Method98<14>>(p, Accuracy::reference(3))),
        by_hand(written),
        eighth(|p| runge_kutta::<Method85<14>>(p, Accuracy::of(TIGHT))),
        fifth(|p| runge_kutta::<Method54<14>>(p, Accuracy::of(LOOSE))),
    ]
}
