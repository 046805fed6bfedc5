//! The free body in unit quaternions, in the body or spatial representation: the hand-written stepper of the family, and
//! Runge-Kutta methods for Euler's equations. Quaternions are continuous in sign, so that the comparison covers the motion on SU(2)
//! and not only the rotation.

use super::{
    LOOSE, Method, Offer, Problem, Role, TIGHT, by_hand, check, eighth, fifth, reference, rows,
};
use crate::continuous::rigid::{Field, RigidBody};
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{
    Matrix, Quaternion, Vector, apply, apply_transposed, dot, product, transposed_product,
};
use crate::handwritten::cayley_klein::CayleyKlein;
use crate::handwritten::cayley_klein_symmetric::SymmetricCayleyKlein;
use crate::handwritten::principal_axes::PrincipalAxes;
use crate::runge_kutta::{Accuracy, Method54, Method85, Method98, RungeKutta, Scheme};
use std::marker::PhantomData;

/// A case of either model.
pub(super) struct Body {
    /// Inertia matrix in body axes.
    inertia: Matrix,
    /// The member of the family of discretisations.
    c: f64,
    attitude: Quaternion,
    body_momentum: Vector,
    shown: Shown,
}

/// The output format of the model.
#[derive(Clone, Copy)]
enum Shown {
    /// Quaternion and body momentum.
    Body,
    /// Quaternion, spatial momentum, and the spatial inertia matrix for this body inertia.
    Space(Matrix),
}

/// Reads the values of a model.
pub(super) trait Read {
    /// `None` if the values do not fit the model.
    fn read(problem: &Problem<'_>) -> Option<Body>;
}

pub(super) struct InBody;
pub(super) struct InSpace;

impl Read for InBody {
    fn read(problem: &Problem<'_>) -> Option<Body> {
        Some(Body {
            inertia: problem.parameter(0)?,
            c: problem.parameter(1)?,
            attitude: Quaternion(problem.initial(0)?),
            body_momentum: problem.initial(1)?,
            shown: Shown::Body,
        })
    }
}

impl Read for InSpace {
    fn read(problem: &Problem<'_>) -> Option<Body> {
        let attitude = Quaternion(problem.initial(0)?);
        let r = attitude.matrix();
        let (momentum, inertia): (Vector, Matrix) = (problem.initial(1)?, problem.initial(2)?);
        let inertia = transposed_product(&r, &product(&inertia, &r));
        Some(Body {
            inertia,
            c: problem.parameter(0)?,
            attitude,
            body_momentum: apply_transposed(&r, &momentum),
            shown: Shown::Space(inertia),
        })
    }
}

impl Shown {
    fn of(&self, q: &Quaternion, body_momentum: &Vector) -> Vec<Vec<f64>> {
        match self {
            Shown::Body => vec![q.0.to_vec(), body_momentum.to_vec()],
            Shown::Space(inertia) => {
                let r = q.matrix();
                let half = r.map(|row| apply(inertia, &row));
                // Exactly symmetric, as the model requires.
                let entry = |i: usize, j: usize| dot(&r[i.min(j)], &half[i.max(j)]);
                let inertia = [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)));
                vec![
                    q.0.to_vec(),
                    apply(&r, body_momentum).to_vec(),
                    rows(&inertia),
                ]
            }
        }
    }
}

/// The Poinsot matrix tr(I)/2 Id - I.
fn poinsot(inertia: &Matrix) -> Matrix {
    let half = 0.5 * (inertia[0][0] + inertia[1][1] + inertia[2][2]);
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { half } else { 0.0 } - inertia[i][j]))
}

struct Moving<R> {
    motion: RungeKutta<R, RigidBody, 7>,
    shown: Shown,
}

impl<R: Scheme<7>> Method for Moving<R> {
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.motion.step()
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        let [w, x, y, z, a, b, c] = *self.motion.state();
        self.shown
            .of(&Quaternion([w, x, y, z]).normalised(), &[a, b, c])
    }
}

/// The stepper works in principal axes.
struct ByHand {
    motion: CayleyKlein,
    axes: PrincipalAxes,
    shown: Shown,
}

impl Method for ByHand {
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.motion.step()
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        // The model requires a unit quaternion; the stepper's norm drifts by rounding between two resets.
        let q = self.axes.leave_attitude(&self.motion.quaternion());
        let momentum = self.axes.leave(&self.motion.body_momentum());
        self.shown.of(&q.normalised(), &momentum)
    }
}

/// Like `ByHand`, for a body of revolution.
struct Explicit {
    motion: SymmetricCayleyKlein,
    axes: PrincipalAxes,
    shown: Shown,
}

impl Method for Explicit {
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.motion.step();
        Ok(())
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        let q = self.axes.leave_attitude(&self.motion.quaternion());
        let momentum = self.axes.leave(&self.motion.body_momentum());
        self.shown.of(&q.normalised(), &momentum)
    }
}

type Started = Result<Box<dyn Method>, Unsolvable>;

fn written<B: Read>(problem: &Problem<'_>) -> Started {
    let body = B::read(problem).ok_or(Unsolvable)?;
    let axes = PrincipalAxes::new(&poinsot(&body.inertia))?;
    let motion = CayleyKlein::start(
        &axes.moments,
        body.c,
        &axes.enter_attitude(&body.attitude),
        &axes.enter(&body.body_momentum),
        problem.h,
    )?;
    Ok(Box::new(ByHand {
        motion,
        axes,
        shown: body.shown,
    }))
}

fn explicit<B: Read>(problem: &Problem<'_>) -> Started {
    let body = B::read(problem).ok_or(Unsolvable)?;
    let axes = PrincipalAxes::new(&poinsot(&body.inertia))?;
    let motion = SymmetricCayleyKlein::start(
        &axes.moments,
        body.c,
        &axes.enter_attitude(&body.attitude),
        &axes.enter(&body.body_momentum),
        problem.h,
    )?;
    Ok(Box::new(Explicit {
        motion,
        axes,
        shown: body.shown,
    }))
}

fn runge_kutta<B: Read, R: Scheme<7> + 'static>(
    problem: &Problem<'_>,
    accuracy: Accuracy,
) -> Started {
    let body = B::read(problem).ok_or(Unsolvable)?;
    let ([w, x, y, z], [a, b, c]) = (body.attitude.0, body.body_momentum);
    let equations = RigidBody::new(&poinsot(&body.inertia), Field::None);
    let first = [w, x, y, z, a, b, c];
    let motion = RungeKutta::<R, _, 7>::start(equations, &first, problem.h, accuracy)?;
    Ok(Box::new(Moving {
        motion,
        shown: body.shown,
    }))
}

/// The Runge-Kutta methods for the models of one reader.
struct Families<B>(PhantomData<B>);

impl<B: Read> Families<B> {
    fn reference(problem: &Problem<'_>) -> Started {
        runge_kutta::<B, Method98<7>>(problem, Accuracy::reference(2))
    }

    fn check(problem: &Problem<'_>) -> Started {
        runge_kutta::<B, Method98<7>>(problem, Accuracy::reference(3))
    }

    fn eighth(problem: &Problem<'_>) -> Started {
        runge_kutta::<B, Method85<7>>(problem, Accuracy::of(TIGHT))
    }

    fn fifth(problem: &Problem<'_>) -> Started {
        runge_kutta::<B, Method54<7>>(problem, Accuracy::of(LOOSE))
    }
}

/// The available methods.
pub(super) fn body<B: Read>() -> Vec<Offer> {
    vec![
        reference(Families::<B>::reference),
        check(Families::<B>::check),
        by_hand(written::<B>),
        Offer {
            name: "by-hand-explicit",
            doc: "the same for two equal moments: solved once, every step explicit",
            role: Role::ByHand,
            start: explicit::<B>,
        },
        eighth(Families::<B>::eighth),
        fifth(Families::<B>::fifth),
    ]
}
