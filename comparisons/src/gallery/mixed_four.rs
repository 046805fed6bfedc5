//! Four configurations coupled by springs: the hand-written stepper, and Runge-Kutta methods for the equations of motion. The
//! parameters of a case are (J, A, M, I, m, b, k, p, s, e, g).

use super::{LOOSE, Method, Offer, Problem, TIGHT, by_hand, check, eighth, fifth, reference, rows};
use crate::continuous::mixed_four::{Joined, read as separated, state};
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{Matrix, Quaternion, Vector, apply, apply_transposed};
use crate::handwritten::mixed_four::{Four, MixedFour, Momenta, Places};
use crate::runge_kutta::{Accuracy, Method54, Method85, Method98, RungeKutta, Scheme};

fn read(problem: &Problem<'_>) -> Option<(Four, Places, Momenta)> {
    let inertia: Matrix = problem.parameter(3)?;
    let half = 0.5 * (inertia[0][0] + inertia[1][1] + inertia[2][2]);
    let mut second = inertia.map(|row| row.map(|x| -x));
    for (i, row) in second.iter_mut().enumerate() {
        row[i] += half;
    }
    let four = Four {
        poinsots: [problem.parameter(0)?, problem.parameter(1)?, second],
        motion_mass: problem.parameter(2)?,
        point_mass: problem.parameter(4)?,
        quartic: problem.parameter(5)?,
        stiffness: problem.parameter(6)?,
        arms: [
            problem.parameter(7)?,
            problem.parameter(8)?,
            problem.parameter(9)?,
        ],
        gravity: problem.parameter(10)?,
    };
    let [[a, b, c, x], [d, e, f, y], [g, h, i, z], _]: [[f64; 4]; 4] = problem.initial(2)?;
    let [p1, p2, p3, p4, p5, p6]: [f64; 6] = problem.initial(3)?;
    let quaternion: [f64; 4] = problem.initial(4)?;
    let attitudes = [
        problem.initial(0)?,
        Quaternion::from_matrix(&[[a, b, c], [d, e, f], [g, h, i]]),
        Quaternion(quaternion),
    ];
    let own: [Vector; 3] = [problem.initial(1)?, [p1, p2, p3], problem.initial(5)?];
    let seen = |at: usize, v: &Vector| apply(&attitudes[at].matrix(), v);
    let places = Places {
        attitudes,
        motion: [x, y, z],
        point: problem.initial(6)?,
    };
    let momenta = Momenta {
        angular: [seen(0, &own[0]), seen(1, &own[1]), seen(2, &own[2])],
        motion: seen(1, &[p4, p5, p6]),
        point: problem.initial(7)?,
    };
    Some((four, places, momenta))
}

/// Converts a state to initial values of the model, with body momenta for the first three.
fn shown(places: &Places, momenta: &Momenta) -> Vec<Vec<f64>> {
    let attitudes = places.attitudes.map(|q| q.normalised());
    let own = |at: usize, v: &Vector| apply_transposed(&attitudes[at].matrix(), v);
    let rotation = attitudes[1].matrix();
    let rigid = rotation.iter().zip(&places.motion);
    let rigid = rigid.flat_map(|([a, b, c], x)| [*a, *b, *c, *x]);
    vec![
        rows(&attitudes[0].matrix()),
        own(0, &momenta.angular[0]).to_vec(),
        rigid.chain([0.0, 0.0, 0.0, 1.0]).collect(),
        [own(1, &momenta.angular[1]), own(1, &momenta.motion)].concat(),
        attitudes[2].0.to_vec(),
        own(2, &momenta.angular[2]).to_vec(),
        places.point.to_vec(),
        momenta.point.to_vec(),
    ]
}

impl Method for MixedFour {
    fn step(&mut self) -> Result<(), Unsolvable> {
        MixedFour::step(self)
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        shown(&self.places(), &self.momenta())
    }
}

struct Moving<R>(RungeKutta<R, Joined, 33>);

impl<R: Scheme<33>> Method for Moving<R> {
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.0.step()
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        let (places, momenta) = separated(self.0.state());
        shown(&places, &momenta)
    }
}

fn written(problem: &Problem<'_>) -> Result<Box<dyn Method>, Unsolvable> {
    let (four, places, momenta) = read(problem).ok_or(Unsolvable)?;
    Ok(Box::new(MixedFour::start(
        &four, &places, &momenta, problem.h,
    )?))
}

fn runge_kutta<R: Scheme<33> + 'static>(
    problem: &Problem<'_>,
    accuracy: Accuracy,
) -> Result<Box<dyn Method>, Unsolvable> {
    let (four, places, momenta) = read(problem).ok_or(Unsolvable)?;
    let first = state(&places, &momenta);
    let motion = RungeKutta::<R, _, 33>::start(Joined::new(&four), &first, problem.h, accuracy)?;
    Ok(Box::new(Moving(motion)))
}

/// The available methods.
pub(super) fn joined() -> Vec<Offer> {
    vec![
        reference(|p| runge_kutta::<Method98<33>>(p, Accuracy::reference(2))),
        check(|p| runge_kutta::<Method98<33>>(p, Accuracy::reference(3))),
        by_hand(written),
        eighth(|p| runge_kutta::<Method85<33>>(p, Accuracy::of(TIGHT))),
        fifth(|p| runge_kutta::<Method54<33>>(p, Accuracy::of(LOOSE))),
    ]
}
