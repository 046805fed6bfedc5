//! The free body in three to eight dimensions: the hand-written stepper, and Runge-Kutta methods for the equations of Arnold and
//! Manakov. The size of the case's values determines the dimension. Only symmetric factors are accepted, because other factors have
//! no continuous-time motion.

use super::{Method, Offer, Problem, TIGHT, by_hand, check, eighth, reference};
use crate::continuous::any_dimension::{BodyN, matrices, principal, seen_from, state};
use crate::handwritten::Unsolvable;
use crate::handwritten::body_n::{BodyN as Written, Square, product, transposed};
use crate::runge_kutta::{Accuracy, Method85, Method98, RungeKutta, Scheme};

type Started = Result<Box<dyn Method>, Unsolvable>;

/// A body in principal axes.
struct Body<const N: usize> {
    moments: [f64; N],
    /// Rotation from principal axes to given axes.
    axes: Square<N>,
    /// Attitude of the principal axes.
    attitude: Square<N>,
    /// Momentum in principal axes.
    momentum: Square<N>,
    h: f64,
}

fn read<const N: usize>(problem: &Problem<'_>) -> Option<Body<N>> {
    let (moments, axes) = principal(&problem.parameter::<Square<N>>(0)?)?;
    let attitude: Square<N> = problem.initial(0)?;
    Some(Body {
        moments,
        attitude: product(&attitude, &axes),
        momentum: seen_from(&problem.initial(1)?, &axes),
        axes,
        h: problem.h,
    })
}

/// Attitude and body momentum in the axes of the model, with an exactly skew momentum.
fn shown<const N: usize>(axes: &Square<N>, attitude: &Square<N>, m: &Square<N>) -> Vec<Vec<f64>> {
    let back = transposed(axes);
    let (attitude, m) = (product(attitude, &back), seen_from(m, &back));
    let mirrored = transposed(&m);
    let pairs = m.as_flattened().iter().zip(mirrored.as_flattened());
    vec![
        attitude.as_flattened().to_vec(),
        pairs.map(|(x, y)| 0.5 * (x - y)).collect(),
    ]
}

struct ByHand<const N: usize> {
    motion: Written<N>,
    axes: Square<N>,
}

impl<const N: usize> Method for ByHand<N> {
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.motion.step()
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        let (attitude, m) = (self.motion.attitude(), self.motion.body_momentum());
        shown(&self.axes, &attitude, &m)
    }
}

struct Integrated<R, const N: usize, const SIZE: usize> {
    motion: RungeKutta<R, BodyN<N>, SIZE>,
    axes: Square<N>,
}

impl<R: Scheme<SIZE>, const N: usize, const SIZE: usize> Method for Integrated<R, N, SIZE> {
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.motion.step()
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        let [attitude, m] = matrices::<N, SIZE>(self.motion.state());
        shown(&self.axes, &attitude, &m)
    }
}

fn written<const N: usize, const SIZE: usize>(problem: &Problem<'_>) -> Started {
    let body = read::<N>(problem).ok_or(Unsolvable)?;
    let motion = Written::start(&body.moments, &body.attitude, &body.momentum, body.h)?;
    let axes = body.axes;
    Ok(Box::new(ByHand { motion, axes }))
}

fn integrated<R: Scheme<SIZE> + 'static, const N: usize, const SIZE: usize>(
    problem: &Problem<'_>,
    accuracy: Accuracy,
) -> Started {
    let body = read::<N>(problem).ok_or(Unsolvable)?;
    let first = state::<N, SIZE>(&[body.attitude, body.momentum]);
    let motion =
        RungeKutta::<R, _, SIZE>::start(BodyN::new(&body.moments), &first, body.h, accuracy)?;
    let axes = body.axes;
    Ok(Box::new(Integrated { motion, axes }))
}

/// Calls a generic function with the dimension of the attitude.
macro_rules! of_size {
    ($start:ident, $problem:expr) => {
        match $problem.initial.first().map(Vec::len) {
            Some(9) => $start::<3, 18>($problem),
            Some(16) => $start::<4, 32>($problem),
            Some(25) => $start::<5, 50>($problem),
            Some(36) => $start::<6, 72>($problem),
            Some(49) => $start::<7, 98>($problem),
            Some(64) => $start::<8, 128>($problem),
            _ => Err(Unsolvable),
        }
    };
}

fn truth_of<const N: usize, const SIZE: usize>(problem: &Problem<'_>) -> Started {
    integrated::<Method98<SIZE>, N, SIZE>(problem, Accuracy::reference(2))
}

fn finer_of<const N: usize, const SIZE: usize>(problem: &Problem<'_>) -> Started {
    integrated::<Method98<SIZE>, N, SIZE>(problem, Accuracy::reference(3))
}

fn eighth_of<const N: usize, const SIZE: usize>(problem: &Problem<'_>) -> Started {
    integrated::<Method85<SIZE>, N, SIZE>(problem, Accuracy::of(TIGHT))
}

fn truth(problem: &Problem<'_>) -> Started {
    of_size!(truth_of, problem)
}

fn finer(problem: &Problem<'_>) -> Started {
    of_size!(finer_of, problem)
}

fn dormand_prince(problem: &Problem<'_>) -> Started {
    of_size!(eighth_of, problem)
}

fn hand(problem: &Problem<'_>) -> Started {
    of_size!(written, problem)
}

/// The free body in N dimensions.
pub(super) fn bodies() -> Vec<Offer> {
    vec![
        reference(truth),
        check(finer),
        by_hand(hand),
        eighth(dormand_prince),
    ]
}
