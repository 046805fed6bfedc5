//! Elastic ellipsoids in two to four dimensions, with a stored energy of the convective metric or of the spatial second moments:
//! the hand-written stepper and Runge-Kutta methods, both for the placement. The parameters of a case are (C0, I0, a, b, c, d);
//! their size determines the dimension.

use super::{Method, Offer, Problem, TIGHT, by_hand, check, eighth, reference};
use crate::continuous::any_dimension::{matrices, state};
use crate::handwritten::Unsolvable;
use crate::handwritten::body_n::Square;
use crate::handwritten::ellipsoid::{ElasticEllipsoid, Ellipsoid, Of, Prepared};
use crate::runge_kutta::{Accuracy, Method85, Method98, RungeKutta, Scheme};

type Started = Result<Box<dyn Method>, Unsolvable>;

/// The ellipsoid, its placement, its momentum.
type Start<const N: usize> = (Ellipsoid<N>, Square<N>, Square<N>);

fn read<const N: usize>(problem: &Problem<'_>, of: Of) -> Option<Start<N>> {
    let mut energy = [0.0; 4];
    for (k, value) in energy.iter_mut().enumerate() {
        *value = problem.parameter(2 + k)?;
    }
    let body = Ellipsoid {
        metric: problem.parameter(0)?,
        moments: problem.parameter(1)?,
        energy,
        of,
    };
    Some((body, problem.initial(0)?, problem.initial(1)?))
}

fn shown<const N: usize>(values: [Square<N>; 2]) -> Vec<Vec<f64>> {
    values.iter().map(|m| m.as_flattened().to_vec()).collect()
}

impl<const N: usize> Method for ElasticEllipsoid<N> {
    fn step(&mut self) -> Result<(), Unsolvable> {
        ElasticEllipsoid::step(self)
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        shown([self.placement(), self.momentum()])
    }
}

struct Moving<R, const N: usize, const SIZE: usize> {
    motion: RungeKutta<R, Prepared<N>, SIZE>,
    body: Prepared<N>,
}

impl<R: Scheme<SIZE>, const N: usize, const SIZE: usize> Method for Moving<R, N, SIZE> {
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.motion.step()
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        let [q, v] = matrices::<N, SIZE>(self.motion.state());
        shown([q, self.body.momentum(&q, &v)])
    }
}

fn written<const N: usize>(problem: &Problem<'_>, of: Of) -> Started {
    let (body, placement, momentum) = read::<N>(problem, of).ok_or(Unsolvable)?;
    Ok(Box::new(ElasticEllipsoid::start(
        &body, &placement, &momentum, problem.h,
    )?))
}

fn integrated<R: Scheme<SIZE> + 'static, const N: usize, const SIZE: usize>(
    problem: &Problem<'_>,
    of: Of,
    accuracy: Accuracy,
) -> Started {
    let (body, placement, momentum) = read::<N>(problem, of).ok_or(Unsolvable)?;
    let body = Prepared::new(&body)?;
    let first = state::<N, SIZE>(&[placement, body.velocity(&placement, &momentum)]);
    let motion = RungeKutta::<R, _, SIZE>::start(body, &first, problem.h, accuracy)?;
    Ok(Box::new(Moving { motion, body }))
}

/// The number of rows, from the number of entries of the placement.
fn size(problem: &Problem<'_>) -> Option<usize> {
    Some(problem.initial.first()?.len().isqrt())
}

fn hand(problem: &Problem<'_>, of: Of) -> Started {
    match size(problem) {
        Some(2) => written::<2>(problem, of),
        Some(3) => written::<3>(problem, of),
        Some(4) => written::<4>(problem, of),
        _ => Err(Unsolvable),
    }
}

fn verner(problem: &Problem<'_>, of: Of, pieces: u32) -> Started {
    let accuracy = Accuracy::reference(pieces);
    match size(problem) {
        Some(2) => integrated::<Method98<8>, 2, 8>(problem, of, accuracy),
        Some(3) => integrated::<Method98<18>, 3, 18>(problem, of, accuracy),
        Some(4) => integrated::<Method98<32>, 4, 32>(problem, of, accuracy),
        _ => Err(Unsolvable),
    }
}

fn dormand_prince(problem: &Problem<'_>, of: Of) -> Started {
    let accuracy = Accuracy::of(TIGHT);
    match size(problem) {
        Some(2) => integrated::<Method85<8>, 2, 8>(problem, of, accuracy),
        Some(3) => integrated::<Method85<18>, 3, 18>(problem, of, accuracy),
        Some(4) => integrated::<Method85<32>, 4, 32>(problem, of, accuracy),
        _ => Err(Unsolvable),
    }
}

/// The methods for a stored energy of the convective metric.
pub(super) fn convective() -> Vec<Offer> {
    vec![
        reference(|p| verner(p, Of::Metric, 2)),
        check(|p| verner(p, Of::Metric, 3)),
        by_hand(|p| hand(p, Of::Metric)),
        eighth(|p| dormand_prince(p, Of::Metric)),
    ]
}

/// The methods for a stored energy of the spatial second moments.
pub(super) fn spatial() -> Vec<Offer> {
    vec![
        reference(|p| verner(p, Of::Moments, 2)),
        check(|p| verner(p, Of::Moments, 3)),
        by_hand(|p| hand(p, Of::Moments)),
        eighth(|p| dormand_prince(p, Of::Moments)),
    ]
}
