//! Models of one rigid body, in the body or spatial representation: closed form and published integrators for the free body,
//! hand-written steppers, and Runge-Kutta methods for all models.

use super::{Method, Offer, Problem, Role, rows};
use crate::body::exact::Exact;
use crate::body::implicit::{FixedPoint, Newton};
use crate::body::splitting::{FourthOrderSplitting, MergedSplitting, Splitting};
use crate::body::{BodyMotion, Start};
use crate::continuous::rigid::{Field, RigidBody};
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{Matrix, Quaternion, Vector, apply, apply_transposed, dot};
use crate::handwritten::body_in_field::{BodyInField, QuadraticField, TwoFields};
use crate::handwritten::free_body::FreeBody as WrittenBody;
use crate::handwritten::heavy_top::{HeavyTop as WrittenTop, Top};
use crate::runge_kutta::{Accuracy, Method54, Method85, Method98, RungeKutta, Scheme};
use std::marker::PhantomData;

/// A case of any of these models: the body, its field, and the output format of the model.
pub(super) struct Body {
    start: Start,
    field: Field,
    shown: Shown,
}

/// The initial values after the attitude.
struct Shown {
    spatial_momentum: bool,
    carried: Vec<Carried>,
}

/// An advected quantity without a definition.
enum Carried {
    /// Constant in the body, reported in spatial axes.
    Matrix(Matrix),
    /// Constant in the body, reported in spatial axes.
    Vector(Vector),
    /// Constant in space, reported in body axes.
    Direction(Vector),
}

impl Shown {
    fn body() -> Self {
        Self {
            spatial_momentum: false,
            carried: Vec::new(),
        }
    }
}

/// Reads the values of a model.
pub(super) trait Read {
    /// `None` if the values do not fit the model.
    fn read(problem: &Problem<'_>) -> Option<Body>;
}

pub(super) struct FreeBody;
pub(super) struct FreeBodySpatial;
pub(super) struct HeavyTop;
pub(super) struct HeavyTopSpatial;
pub(super) struct BodyInTwoFields;
pub(super) struct BodyInQuadraticField;

fn body_start(problem: &Problem<'_>) -> Option<Start> {
    Some(Start {
        poinsot: problem.parameter(0)?,
        attitude: problem.initial(0)?,
        body_momentum: problem.initial(1)?,
        h: problem.h,
    })
}

/// Attitude, spatial momentum and spatial Poinsot matrix, the initial data of the spatial models.
fn spatial_start(problem: &Problem<'_>) -> Option<Start> {
    let attitude: Quaternion = problem.initial(0)?;
    let r = attitude.matrix();
    let momentum: Vector = problem.initial(1)?;
    let poinsot: Matrix = problem.initial(2)?;
    let column = |k: usize| [r[0][k], r[1][k], r[2][k]];
    Some(Start {
        poinsot: std::array::from_fn(|i| {
            std::array::from_fn(|j| dot(&column(i), &apply(&poinsot, &column(j))))
        }),
        attitude,
        body_momentum: apply_transposed(&r, &momentum),
        h: problem.h,
    })
}

impl Read for FreeBody {
    fn read(problem: &Problem<'_>) -> Option<Body> {
        Some(Body {
            start: body_start(problem)?,
            field: Field::None,
            shown: Shown::body(),
        })
    }
}

impl Read for FreeBodySpatial {
    fn read(problem: &Problem<'_>) -> Option<Body> {
        let start = spatial_start(problem)?;
        Some(Body {
            field: Field::None,
            shown: Shown {
                spatial_momentum: true,
                carried: vec![Carried::Matrix(start.poinsot)],
            },
            start,
        })
    }
}

impl Read for HeavyTop {
    fn read(problem: &Problem<'_>) -> Option<Body> {
        Some(Body {
            start: body_start(problem)?,
            field: Field::Uniform(vec![(problem.parameter(1)?, problem.parameter(2)?)]),
            shown: Shown::body(),
        })
    }
}

impl Read for HeavyTopSpatial {
    fn read(problem: &Problem<'_>) -> Option<Body> {
        let start = spatial_start(problem)?;
        let (weight, up): (f64, Vector) = (problem.parameter(0)?, problem.parameter(1)?);
        let arm = apply_transposed(&start.attitude.matrix(), &problem.initial(3)?);
        Some(Body {
            field: Field::Uniform(vec![(arm.map(|c| weight * c), up)]),
            shown: Shown {
                spatial_momentum: true,
                carried: vec![Carried::Matrix(start.poinsot), Carried::Vector(arm)],
            },
            start,
        })
    }
}

impl Read for BodyInTwoFields {
    fn read(problem: &Problem<'_>) -> Option<Body> {
        let dipole: Vector = problem.parameter(2)?;
        Some(Body {
            start: body_start(problem)?,
            field: Field::Uniform(vec![
                (problem.parameter(1)?, problem.parameter(3)?),
                (dipole.map(|c| -c), problem.parameter(4)?),
            ]),
            shown: Shown::body(),
        })
    }
}

impl Read for BodyInQuadraticField {
    fn read(problem: &Problem<'_>) -> Option<Body> {
        let start = body_start(problem)?;
        let axis = apply(&start.attitude.matrix(), &problem.initial(2)?);
        Some(Body {
            field: Field::Quadratic {
                matrix: problem.parameter(1)?,
                axis,
            },
            shown: Shown {
                spatial_momentum: false,
                carried: vec![Carried::Direction(axis)],
            },
            start,
        })
    }
}

/// A motion of the body, reported in the format of its model.
struct Moving<M> {
    motion: M,
    shown: Shown,
}

impl<M: BodyMotion> Method for Moving<M> {
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.motion.step()
    }

    fn shown(&self) -> Vec<Vec<f64>> {
        let r = self.motion.attitude().matrix();
        let mu = self.motion.body_momentum();
        let momentum = if self.shown.spatial_momentum {
            apply(&r, &mu)
        } else {
            mu
        };
        let mut values = vec![rows(&r), momentum.to_vec()];
        values.extend(self.shown.carried.iter().map(|carried| match carried {
            Carried::Matrix(m) => {
                let half = [apply(m, &r[0]), apply(m, &r[1]), apply(m, &r[2])];
                rows(&std::array::from_fn(|i| {
                    std::array::from_fn(|j| {
                        // Exactly symmetric, as the model requires.
                        let (a, b) = if i <= j { (i, j) } else { (j, i) };
                        dot(&r[a], &half[b])
                    })
                }))
            }
            Carried::Vector(v) => apply(&r, v).to_vec(),
            Carried::Direction(v) => apply_transposed(&r, v).to_vec(),
        }));
        values
    }
}

type Started = Result<Box<dyn Method>, Unsolvable>;

fn shown<M: BodyMotion + 'static>(motion: Result<M, Unsolvable>, shown: Shown) -> Started {
    motion.map(|motion| Box::new(Moving { motion, shown }) as Box<dyn Method>)
}

fn body<B: Read>(problem: &Problem<'_>) -> Result<Body, Unsolvable> {
    B::read(problem).ok_or(Unsolvable)
}

fn exact<B: Read>(problem: &Problem<'_>) -> Started {
    let body = body::<B>(problem)?;
    shown(Exact::start(&body.start), body.shown)
}

fn splitting<B: Read>(problem: &Problem<'_>) -> Started {
    let body = body::<B>(problem)?;
    shown(Splitting::start(&body.start), body.shown)
}

fn merged<B: Read>(problem: &Problem<'_>) -> Started {
    let body = body::<B>(problem)?;
    shown(MergedSplitting::start(&body.start), body.shown)
}

fn fourth<B: Read>(problem: &Problem<'_>) -> Started {
    let body = body::<B>(problem)?;
    shown(FourthOrderSplitting::start(&body.start), body.shown)
}

fn fixed_point<B: Read>(problem: &Problem<'_>) -> Started {
    let body = body::<B>(problem)?;
    shown(FixedPoint::start(&body.start), body.shown)
}

fn newton<B: Read>(problem: &Problem<'_>) -> Started {
    let body = body::<B>(problem)?;
    shown(Newton::start(&body.start), body.shown)
}

fn written_body<B: Read>(problem: &Problem<'_>) -> Started {
    let Body {
        start, shown: by, ..
    } = body::<B>(problem)?;
    let Start {
        poinsot,
        attitude,
        body_momentum,
        h,
    } = start;
    shown(
        WrittenBody::start(&poinsot, &attitude, &body_momentum, h),
        by,
    )
}

fn written_top<B: Read>(problem: &Problem<'_>) -> Started {
    let Body {
        start,
        shown: by,
        field,
    } = body::<B>(problem)?;
    let Start {
        poinsot,
        attitude,
        body_momentum,
        h,
    } = start;
    let Field::Uniform(pairs) = field else {
        return Err(Unsolvable);
    };
    let [(weight, up)] = *pairs else {
        return Err(Unsolvable);
    };
    let top = Top {
        poinsot,
        weight,
        up,
    };
    shown(WrittenTop::start(&top, &attitude, &body_momentum, h), by)
}

fn written_field<B: Read>(problem: &Problem<'_>) -> Started {
    let Body {
        start,
        shown: by,
        field,
    } = body::<B>(problem)?;
    let Start {
        poinsot,
        attitude,
        body_momentum,
        h,
    } = start;
    match field {
        Field::Quadratic { matrix, axis } => {
            let field = QuadraticField {
                stiffness: matrix,
                axis,
            };
            let motion = BodyInField::start(&poinsot, &field, &attitude, &body_momentum, h);
            shown(motion, by)
        }
        Field::Uniform(pairs) => {
            let [(weight, up), (against, direction)] = *pairs else {
                return Err(Unsolvable);
            };
            let field = TwoFields {
                weight,
                dipole: against.map(|c| -c),
                up,
                field: direction,
            };
            let motion = BodyInField::start(&poinsot, &field, &attitude, &body_momentum, h);
            shown(motion, by)
        }
        Field::None => Err(Unsolvable),
    }
}

fn runge_kutta<B: Read, R: Scheme<7> + 'static>(
    problem: &Problem<'_>,
    accuracy: Accuracy,
) -> Started {
    let Body {
        start,
        shown: by,
        field,
    } = body::<B>(problem)?;
    let [w, x, y, z] = start.attitude.0;
    let [a, b, c] = start.body_momentum;
    let first = [w, x, y, z, a, b, c];
    let body = RigidBody::new(&start.poinsot, field);
    shown(
        RungeKutta::<R, _, 7>::start(body, &first, start.h, accuracy),
        by,
    )
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
        runge_kutta::<B, Method85<7>>(problem, Accuracy::of(super::TIGHT))
    }

    fn fifth(problem: &Problem<'_>) -> Started {
        runge_kutta::<B, Method54<7>>(problem, Accuracy::of(super::LOOSE))
    }

    /// The methods for every model of one body.
    fn offers(written: super::Start) -> Vec<Offer> {
        vec![
            super::reference(Self::reference),
            super::check(Self::check),
            super::by_hand(written),
            super::eighth(Self::eighth),
            super::fifth(Self::fifth),
        ]
    }
}

/// Dormand and Prince 5(4) with its smallest tolerance.
pub(super) fn ode45<B: Read>(problem: &Problem<'_>) -> Started {
    runge_kutta::<B, Method54<7>>(problem, Accuracy::of(super::SMALLEST))
}

/// The free body.
pub(super) fn free<B: Read>() -> Vec<Offer> {
    let published = |name, doc, start| Offer {
        name,
        doc,
        role: Role::Published,
        start,
    };
    let mut offers = vec![Offer {
        name: "closed-form",
        doc: "elliptic functions and an integral of the third kind",
        role: Role::Reference,
        start: exact::<B>,
    }];
    offers.extend(Families::<B>::offers(written_body::<B>).into_iter().skip(1));
    let others: [(_, _, super::Start); 5] = [
        (
            "splitting",
            "McLachlan 1993: five rotations a step, order 2",
            splitting::<B>,
        ),
        (
            "splitting-merged",
            "the same with rational angles and four rotations a step",
            merged::<B>,
        ),
        (
            "splitting-4",
            "Suzuki's composition of five splitting steps, order 4",
            fourth::<B>,
        ),
        (
            "fixed-point",
            "Moser-Veselov by Hairer and Vilmart's iteration",
            fixed_point::<B>,
        ),
        ("newton", "Moser-Veselov by Newton's method", newton::<B>),
    ];
    offers.extend(others.map(|(name, doc, start)| published(name, doc, start)));
    offers
}

/// The heavy top.
pub(super) fn top<B: Read>() -> Vec<Offer> {
    Families::<B>::offers(written_top::<B>)
}

/// A body in another field.
pub(super) fn in_field<B: Read>() -> Vec<Offer> {
    Families::<B>::offers(written_field::<B>)
}
