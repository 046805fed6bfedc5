//! A body in an ideal fluid: the hand-written stepper, and Runge-Kutta methods for Kirchhoff's equations. The parameters of a case
//! are (J, M, D, (moment, weight), (vertical, height 0)); the initial values are the homogeneous matrix and the body momentum.

use super::{LOOSE, Method, Offer, Problem, TIGHT, by_hand, check, eighth, fifth, reference};
use crate::continuous::submerged::SubmergedBody;
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{Matrix, Quaternion, Vector};
use crate::handwritten::kirchhoff_body::{KirchhoffBody, Momentum, Submerged};
use crate::runge_kutta::{Accuracy, Method54, Method85, Method98, RungeKutta, Scheme};

/// A body with its initial configuration and momentum.
struct Start {
    body: Submerged,
    attitude: Quaternion,
    place: Vector,
    momentum: Momentum,
}

fn read(problem: &Problem<'_>) -> Option<Start> {
    let [m1, m2, m3, weight]: [f64; 4] = problem.parameter(3)?;
    // The last component of Z shifts the height of zero energy.
    let [z1, z2, z3, _]: [f64; 4] = problem.parameter(4)?;
    let body = Submerged {
        poinsot: problem.parameter(0)?,
        masses: problem.parameter(1)?,
        coupling: problem.parameter(2)?,
        moment: [m1, m2, m3],
        weight,
        up: [z1, z2, z3],
    };
    let [[a, b, c, x], [d, e, f, y], [g, h, i, z], _]: [[f64; 4]; 4] = problem.initial(0)?;
    let [p1, p2, p3, p4, p5, p6]: [f64; 6] = problem.initial(1)?;
    Some(Start {
        body,
        attitude: Quaternion::from_matrix(&[[a, b, c], [d, e, f], [g, h, i]]),
        place: [x, y, z],
        momentum: Momentum {
            angular: [p1, p2, p3],
            linear: [p4, p5, p6],
        },
    })
}

/// Converts a state to initial values of the model.
fn shown(r: &Matrix, place: &Vector, angular: &Vector, linear: &Vector) -> Vec<Vec<f64>> {
    let rows = r.iter().zip(place);
    let rigid = rows.flat_map(|([a, b, c], x)| [*a, *b, *c, *x]);
    vec![
        rigid.chain([0.0, 0.0, 0.0, 1.0]).collect(),
        [*angular, *linear].concat(),
    ]
}

struct Moving<R>(RungeKutta<R, SubmergedBody, 13>);

impl<R: Scheme<13>> Method for Moving<R> {
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.0.step()
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        let [w, i, j, k, x, y, z, a, b, c, d, e, f] = *self.0.state();
        let rotation = Quaternion([w, i, j, k]).normalised().matrix();
        shown(&rotation, &[x, y, z], &[a, b, c], &[d, e, f])
    }
}

struct ByHand(KirchhoffBody);

impl Method for ByHand {
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.0.step()
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        let Momentum { angular, linear } = self.0.body_momentum();
        let rotation = self.0.attitude().matrix();
        shown(&rotation, &self.0.position(), &angular, &linear)
    }
}

fn written(problem: &Problem<'_>) -> Result<Box<dyn Method>, Unsolvable> {
    let start = read(problem).ok_or(Unsolvable)?;
    let motion = KirchhoffBody::start(
        &start.body,
        &start.attitude,
        &start.place,
        &start.momentum,
        problem.h,
    )?;
    Ok(Box::new(ByHand(motion)))
}

fn runge_kutta<R: Scheme<13> + 'static>(
    problem: &Problem<'_>,
    accuracy: Accuracy,
) -> Result<Box<dyn Method>, Unsolvable> {
    let start = read(problem).ok_or(Unsolvable)?;
    let Momentum { angular, linear } = &start.momentum;
    let parts = start.attitude.0.iter().chain(&start.place);
    let first: Vec<f64> = parts.chain(angular).chain(linear).copied().collect();
    let first: [f64; 13] = first.try_into().map_err(|_| Unsolvable)?;
    let body = SubmergedBody::new(&start.body);
    let motion = RungeKutta::<R, _, 13>::start(body, &first, problem.h, accuracy)?;
    Ok(Box::new(Moving(motion)))
}

/// The available methods.
pub(super) fn bodies() -> Vec<Offer> {
    vec![
        reference(|p| runge_kutta::<Method98<13>>(p, Accuracy::reference(2))),
        check(|p| runge_kutta::<Method98<13>>(p, Accuracy::reference(3))),
        by_hand(written),
        eighth(|p| runge_kutta::<Method85<13>>(p, Accuracy::of(TIGHT))),
        fifth(|p| runge_kutta::<Method54<13>>(p, Accuracy::of(LOOSE))),
    ]
}
