//! Points in space, a planet about a fixed sun and a charge in uniform fields: hand-written steppers, and Runge-Kutta methods for
//! Hamilton's equations. The initial values are position and momentum.

use super::{LOOSE, Method, Offer, Problem, TIGHT, by_hand, check, eighth, fifth, reference};
use crate::continuous::Motion;
use crate::continuous::point::Planet as Orbiting;
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::Vector;
use crate::handwritten::charged_particle::{Charge as Particle, ChargedParticle};
use crate::handwritten::kepler::Kepler;
use crate::runge_kutta::{Accuracy, Method54, Method85, Method98, RungeKutta, Scheme};
use std::marker::PhantomData;

type Started = Result<Box<dyn Method>, Unsolvable>;

/// A kind of point: its equations, and its hand-written stepper.
pub(super) trait Point {
    type Equations: Motion<6> + 'static;

    /// `None` if the values do not fit the model.
    fn read(problem: &Problem<'_>) -> Option<Self::Equations>;

    fn written(equations: &Self::Equations, place: &Vector, momentum: &Vector, h: f64) -> Started;
}

pub(super) struct Planet;
pub(super) struct Charge;

impl Point for Planet {
    type Equations = Orbiting;

    fn read(problem: &Problem<'_>) -> Option<Orbiting> {
        Some(Orbiting {
            mass: problem.parameter(0)?,
            sun: problem.parameter(1)?,
        })
    }

    fn written(planet: &Orbiting, place: &Vector, momentum: &Vector, h: f64) -> Started {
        let motion = Kepler::start(planet.mass, planet.sun, place, momentum, h)?;
        Ok(Box::new(motion))
    }
}

impl Point for Charge {
    type Equations = Particle;

    fn read(problem: &Problem<'_>) -> Option<Particle> {
        Some(Particle {
            mass: problem.parameter(0)?,
            charge: problem.parameter(1)?,
            magnetic: problem.parameter(2)?,
            electric: problem.parameter(3)?,
        })
    }

    fn written(charge: &Particle, place: &Vector, momentum: &Vector, h: f64) -> Started {
        Ok(Box::new(ChargedParticle::start(
            charge, place, momentum, h,
        )?))
    }
}

impl Method for Kepler {
    fn step(&mut self) -> Result<(), Unsolvable> {
        Kepler::step(self)
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        vec![self.place().to_vec(), self.momentum().to_vec()]
    }
}

impl Method for ChargedParticle {
    fn step(&mut self) -> Result<(), Unsolvable> {
        ChargedParticle::step(self)
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        vec![self.place().to_vec(), self.momentum().to_vec()]
    }
}

struct Moving<R, M>(RungeKutta<R, M, 6>);

impl<R: Scheme<6>, M: Motion<6>> Method for Moving<R, M> {
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.0.step()
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        self.0.state().chunks(3).map(<[f64]>::to_vec).collect()
    }
}

fn read<P: Point>(problem: &Problem<'_>) -> Option<(P::Equations, Vector, Vector)> {
    Some((P::read(problem)?, problem.initial(0)?, problem.initial(1)?))
}

/// Start functions for one kind of point.
struct Starts<P>(PhantomData<P>);

impl<P: Point> Starts<P> {
    fn written(problem: &Problem<'_>) -> Started {
        let (equations, place, momentum) = read::<P>(problem).ok_or(Unsolvable)?;
        P::written(&equations, &place, &momentum, problem.h)
    }

    fn runge_kutta<R: Scheme<6> + 'static>(problem: &Problem<'_>, accuracy: Accuracy) -> Started {
        let (equations, [x, y, z], [a, b, c]) = read::<P>(problem).ok_or(Unsolvable)?;
        let first = [x, y, z, a, b, c];
        let motion = RungeKutta::<R, _, 6>::start(equations, &first, problem.h, accuracy)?;
        Ok(Box::new(Moving(motion)))
    }
}

/// The methods for one kind of point.
pub(super) fn offers<P: Point>() -> Vec<Offer> {
    vec![
        reference(|p| Starts::<P>::runge_kutta::<Method98<6>>(p, Accuracy::reference(2))),
        check(|p| Starts::<P>::runge_kutta::<Method98<6>>(p, Accuracy::reference(3))),
        by_hand(Starts::<P>::written),
        eighth(|p| Starts::<P>::runge_kutta::<Method85<6>>(p, Accuracy::of(TIGHT))),
        fifth(|p| Starts::<P>::runge_kutta::<Method54<6>>(p, Accuracy::of(LOOSE))),
    ]
}
