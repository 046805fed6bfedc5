//! Two bodies with a spherical joint: Runge-Kutta on the hand-written equations. Takes the values of
//! a case, parameters (J1, J2, d1, d2, eps); gives the methods.

use super::{LOOSE, Method, Offer, Problem, TIGHT, check, eighth, fifth, reference, rows};
use crate::continuous::coupled::CoupledBodies;
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{Quaternion, Vector};
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

fn read(problem: &Problem<'_>) -> Option<(CoupledBodies, [f64; 14])> {
    let bodies = CoupledBodies::new(
        [problem.parameter(0)?, problem.parameter(1)?],
        [problem.parameter(2)?, problem.parameter(3)?],
        problem.parameter(4)?,
    );
    let (q1, m1): (Quaternion, Vector) = (problem.initial(0)?, problem.initial(1)?);
    let (q2, m2): (Quaternion, Vector) = (problem.initial(2)?, problem.initial(3)?);
    let parts = q1.0.iter().chain(&m1).chain(&q2.0).chain(&m2);
    let numbers: Vec<f64> = parts.copied().collect();
    Some((bodies, numbers.try_into().ok()?))
}

fn runge_kutta<R: Scheme<14> + 'static>(
    problem: &Problem<'_>,
    accuracy: Accuracy,
) -> Result<Box<dyn Method>, Unsolvable> {
    let (bodies, start) = read(problem).ok_or(Unsolvable)?;
    let motion = RungeKutta::<R, _, 14>::start(bodies, &start, problem.h, accuracy)?;
    Ok(Box::new(Moving(motion)))
}

/// The methods.
pub(super) fn bodies() -> Vec<Offer> {
    vec![
        reference(|p| runge_kutta::<Method98<14>>(p, Accuracy::reference(2))),
        check(|p| runge_kutta::<Method98<14>>(p, Accuracy::reference(3))),
        eighth(|p| runge_kutta::<Method85<14>>(p, Accuracy::of(TIGHT))),
        fifth(|p| runge_kutta::<Method54<14>>(p, Accuracy::of(LOOSE))),
    ]
}
