//! Random problems of each of the stated models.

use super::oracle::Curve;
use super::stated::*;
use crate::common::Random;
use clebsch::groups::Group;
use clebsch::integrate::Model;
use clebsch::nalgebra::{DVector, Matrix3, SMatrix, SVector, Vector3, Vector4};
use clebsch::scalar::largest;
use clebsch::{
    BodyImpulse, BodyMomentum, BodyMomentumMatrix, Linear, Orthogonal, RigidMotion, Rotation,
    UnitQuaternion,
};

/// A problem of a model.
pub struct Problem<M: Model<Scalar = f64>> {
    /// The model.
    pub model: M,
    /// The state with this fraction of the momenta.
    pub state: Box<dyn Fn(f64) -> M::State>,
    /// The full momenta.
    pub momenta: DVector<f64>,
    /// The step size for a rotation of about one radian.
    pub unit: f64,
}

/// A model with random problems.
pub trait Judged {
    /// The model.
    type M: Model<Scalar = f64>;
    /// The velocities of all configurations.
    type E: Clone;
    /// A random problem.
    fn draw(random: &mut Random) -> Problem<Self::M>;
    /// Number of coordinates.
    const DIMENSION: usize;
    /// Zero velocity.
    fn rest() -> Self::E;
    /// The velocity from one state to the next.
    fn between(
        from: &<Self::M as clebsch::integrate::Stepper>::State,
        to: &<Self::M as clebsch::integrate::Stepper>::State,
    ) -> Self::E;
    /// The velocity after a retraction on the right.
    fn moved(velocity: &Self::E, xi: &[f64]) -> Self::E;
    /// The derived equations, with zero velocity on the previous edge.
    fn balance(
        model: &Self::M,
        h: f64,
        here: &<Self::M as clebsch::integrate::Stepper>::State,
        velocity: &Self::E,
    ) -> DVector<f64>;
    /// The distance of two velocities.
    fn distance(a: &Self::E, b: &Self::E) -> f64;
}

/// The curve of a problem.
pub struct At<'a, J: Judged> {
    pub model: &'a J::M,
    pub h: f64,
    pub here: <J::M as clebsch::integrate::Stepper>::State,
}

impl<J: Judged> Curve for At<'_, J> {
    type E = J::E;
    fn dimension(&self) -> usize {
        J::DIMENSION
    }
    fn rest(&self) -> J::E {
        J::rest()
    }
    fn moved(&self, velocity: &J::E, xi: &DVector<f64>) -> J::E {
        J::moved(velocity, xi.as_slice())
    }
    fn value(&self, velocity: &J::E) -> DVector<f64> {
        J::balance(self.model, self.h, &self.here, velocity)
    }
}

/// Entries of the matrix.
trait Entries {
    fn entries(&self) -> Vec<f64>;
}

macro_rules! entries {
    ($($group:ty),+) => {$(
        impl Entries for $group {
            fn entries(&self) -> Vec<f64> {
                self.matrix().iter().copied().collect()
            }
        }
    )+};
}

entries!(
    Rotation,
    UnitQuaternion,
    RigidMotion,
    Orthogonal<4>,
    Linear<3>
);

macro_rules! judged {
    ($judge:ident, $Model:ident, $Configuration:ident { $($element:ident: $G:ty),+ }, $draw:expr) => {
        pub struct $judge;
        impl Judged for $judge {
            type M = $Model;
            type E = ($($G,)+);
            const DIMENSION: usize = 0 $(+ <$G as Group<f64>>::DIMENSION)+;
            fn draw(random: &mut Random) -> Problem<$Model> {
                $draw(random)
            }
            fn rest() -> Self::E {
                ($(<$G>::identity(),)+)
            }
            fn between(
                from: &<$Model as clebsch::integrate::Stepper>::State,
                to: &<$Model as clebsch::integrate::Stepper>::State,
            ) -> Self::E {
                ($(from.$element().inverse() * to.$element(),)+)
            }
            fn moved(velocity: &Self::E, xi: &[f64]) -> Self::E {
                let ($($element,)+) = velocity;
                let mut rest = xi;
                ($({
                    let (own, others) = rest.split_at(<$G as Group<f64>>::DIMENSION);
                    rest = others;
                    let _ = rest;
                    $element.retract(own)
                },)+)
            }
            fn balance(
                model: &$Model,
                h: f64,
                here: &<$Model as clebsch::integrate::Stepper>::State,
                velocity: &Self::E,
            ) -> DVector<f64> {
                let ($($element,)+) = *velocity;
                let at = $Configuration { $($element: here.$element(),)+ };
                let after = $Configuration { $($element: here.$element() * $element,)+ };
                let all = model.balance(h, &at, &at, &after);
                DVector::from_column_slice(all.as_slice())
            }
            fn distance(a: &Self::E, b: &Self::E) -> f64 {
                let ($($element,)+) = a;
                let a: Vec<f64> = [$($element.entries()),+].concat();
                let ($($element,)+) = b;
                let b: Vec<f64> = [$($element.entries()),+].concat();
                largest(a.iter().zip(&b).map(|(x, y)| (x - y).abs()))
            }
        }
    };
}

pub fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * random.unit()
}

pub fn vector(random: &mut Random, length: f64) -> Vector3<f64> {
    random.vector().normalize() * length
}

/// A random symmetric matrix with eigenvalues from 0.2 to 1.2.
pub fn positive(random: &mut Random) -> Matrix3<f64> {
    let frame = random.rotation().matrix();
    let values = Vector3::from_fn(|_, _| between(random, 0.2, 1.2));
    let j = frame * Matrix3::from_diagonal(&values) * frame.transpose();
    (j + j.transpose()) * 0.5
}

pub fn momentum(random: &mut Random) -> Vector3<f64> {
    let length = between(random, 0.1, 2.0);
    vector(random, length)
}

fn stacked(list: &[Vector3<f64>]) -> DVector<f64> {
    DVector::from_iterator(3 * list.len(), list.iter().flat_map(|v| v.iter().copied()))
}

judged!(
    JudgedPair,
    Pair,
    PairConfiguration {
        Λ1: Rotation,
        Λ2: Rotation
    },
    |r: &mut Random| {
        let eps = between(r, 0.1, 1.0);
        let arms = [(); 2].map(|()| vector(r, 0.7));
        let j = arms.map(|d| positive(r) + d * d.transpose() * eps);
        let momenta = [(); 2].map(|()| momentum(r));
        let model = Pair::new(PairParameters {
            J1: j[0],
            J2: j[1],
            d1: arms[0],
            d2: arms[1],
            eps,
            k: between(r, -0.5, 0.5),
        })
        .expect("valid");
        let turns = [r.rotation(), r.rotation()];
        let state = move |part: f64| {
            model
                .begin(PairInitial {
                    Λ1: turns[0],
                    body_momentum_Λ1: BodyMomentum(momenta[0] * part),
                    Λ2: turns[1],
                    body_momentum_Λ2: BodyMomentum(momenta[1] * part),
                })
                .expect("valid")
        };
        let unit = (j[0].trace() / momenta[0].norm()).min(j[1].trace() / momenta[1].norm());
        Problem {
            model,
            state: Box::new(state),
            momenta: stacked(&momenta),
            unit,
        }
    }
);

judged!(
    JudgedFluid,
    FluidBody,
    FluidBodyConfiguration { G: RigidMotion },
    |r: &mut Random| {
        let (j, m) = (positive(r), positive(r) * 3.0);
        let model = FluidBody::new(FluidBodyParameters {
            J: j,
            M: m,
            D: positive(r) * between(r, 0.0, 0.2),
            b: Vector4::from_fn(|_, _| between(r, -0.3, 0.3)),
            Z: Vector4::new(0.0, 0.0, 1.0, 0.0),
        })
        .expect("valid");
        let (angular, linear) = (momentum(r), momentum(r));
        let place = RigidMotion {
            rotation: r.rotation(),
            translation: vector(r, 1.0),
        };
        let all = SVector::<f64, 6>::from_fn(|i, _| if i < 3 { angular[i] } else { linear[i - 3] });
        let state = move |part: f64| {
            model
                .begin(FluidBodyInitial {
                    G: place,
                    body_momentum: BodyImpulse(all * part),
                })
                .expect("valid")
        };
        let unit = j.trace() / angular.norm();
        Problem {
            model,
            state: Box::new(state),
            momenta: stacked(&[angular, linear]),
            unit,
        }
    }
);

judged!(
    JudgedCharged,
    ChargedTop,
    ChargedTopConfiguration { Λ: Rotation },
    |r: &mut Random| {
        let j = positive(r);
        let model = ChargedTop::new(ChargedTopParameters {
            J: j,
            a: vector(r, 0.5),
            z: Vector3::z(),
            B: vector(r, 1.0),
            q: between(r, -0.7, 0.7),
            c: between(r, 0.0, 0.3),
        })
        .expect("valid");
        let (turn, m) = (r.rotation(), momentum(r));
        let state = move |part: f64| {
            model
                .begin(ChargedTopInitial {
                    Λ: turn,
                    body_momentum: BodyMomentum(m * part),
                })
                .expect("valid")
        };
        Problem {
            model,
            state: Box::new(state),
            momenta: stacked(&[m]),
            unit: j.trace() / m.norm(),
        }
    }
);

judged!(
    JudgedSprings,
    ThreeSprings,
    ThreeSpringsConfiguration {
        G1: RigidMotion,
        G2: RigidMotion,
        G3: RigidMotion
    },
    |r: &mut Random| {
        let j = [(); 3].map(|()| positive(r));
        let model = ThreeSprings::new(ThreeSpringsParameters {
            J1: j[0],
            J2: j[1],
            J3: j[2],
            m: between(r, 0.5, 2.0),
            k: between(r, 0.1, 1.0),
            a: vector(r, 0.5),
            b: vector(r, 0.5),
        })
        .expect("valid");
        let places = [(); 3].map(|()| RigidMotion {
            rotation: r.rotation(),
            translation: vector(r, 1.0),
        });
        let parts = [(); 6].map(|()| momentum(r));
        let six = move |i: usize, part: f64| {
            BodyImpulse(SVector::<f64, 6>::from_fn(|k, _| {
                part * if k < 3 {
                    parts[2 * i][k]
                } else {
                    parts[2 * i + 1][k - 3]
                }
            }))
        };
        let unit = (0..3)
            .map(|i| j[i].trace() / parts[2 * i].norm())
            .fold(f64::INFINITY, f64::min);
        let state = move |part: f64| {
            model
                .begin(ThreeSpringsInitial {
                    G1: places[0],
                    body_momentum_G1: six(0, part),
                    G2: places[1],
                    body_momentum_G2: six(1, part),
                    G3: places[2],
                    body_momentum_G3: six(2, part),
                })
                .expect("valid")
        };
        Problem {
            model,
            state: Box::new(state),
            momenta: stacked(&parts),
            unit,
        }
    }
);

judged!(
    JudgedFrames,
    Frames,
    FramesConfiguration {
        Λ1: Rotation,
        Λ2: Rotation,
        Λ3: Rotation
    },
    |r: &mut Random| {
        let j = [(); 3].map(|()| positive(r));
        let model = Frames::new(FramesParameters {
            J1: j[0],
            J2: j[1],
            J3: j[2],
            k: between(r, 0.1, 1.0),
            c: between(r, -0.2, 0.2),
        })
        .expect("valid");
        let turns = [(); 3].map(|()| r.rotation());
        let m = [(); 3].map(|()| momentum(r));
        let state = move |part: f64| {
            model
                .begin(FramesInitial {
                    Λ1: turns[0],
                    body_momentum_Λ1: BodyMomentum(m[0] * part),
                    Λ2: turns[1],
                    body_momentum_Λ2: BodyMomentum(m[1] * part),
                    Λ3: turns[2],
                    body_momentum_Λ3: BodyMomentum(m[2] * part),
                })
                .expect("valid")
        };
        let unit = (0..3)
            .map(|i| j[i].trace() / m[i].norm())
            .fold(f64::INFINITY, f64::min);
        Problem {
            model,
            state: Box::new(state),
            momenta: stacked(&m),
            unit,
        }
    }
);

judged!(
    JudgedVarying,
    Varying,
    VaryingConfiguration { Λ: Rotation },
    |r: &mut Random| {
        let j = positive(r);
        let model = Varying::new(VaryingParameters {
            J: j,
            a: vector(r, 0.7),
            z: Vector3::z(),
            c: between(r, 0.0, 2.0),
            d: between(r, 0.0, 0.3),
        })
        .expect("valid");
        let (turn, m) = (r.rotation(), momentum(r));
        let state = move |part: f64| {
            model
                .begin(VaryingInitial {
                    Λ: turn,
                    body_momentum: BodyMomentum(m * part),
                })
                .expect("valid")
        };
        Problem {
            model,
            state: Box::new(state),
            momenta: stacked(&[m]),
            unit: j.trace() / m.norm(),
        }
    }
);

judged!(
    JudgedQuaternion,
    StiffQuaternion,
    StiffQuaternionConfiguration { q: UnitQuaternion },
    |r: &mut Random| {
        let s = positive(r);
        let model = StiffQuaternion::new(StiffQuaternionParameters {
            S: s,
            c: between(r, 0.1, 0.5),
        })
        .expect("valid");
        let (turn, m) = (
            UnitQuaternion::from_components(r.rotation().quaternion()).expect("unit"),
            momentum(r),
        );
        let state = move |part: f64| {
            model
                .begin(StiffQuaternionInitial {
                    q: turn,
                    body_momentum: BodyMomentum(m * part),
                })
                .expect("valid")
        };
        Problem {
            model,
            state: Box::new(state),
            momenta: stacked(&[m]),
            unit: s.trace() / m.norm(),
        }
    }
);

judged!(
    JudgedMixed,
    MixedPair,
    MixedPairConfiguration {
        Λ: Rotation,
        q: UnitQuaternion
    },
    |r: &mut Random| {
        let (j, s) = (positive(r), positive(r));
        let model = MixedPair::new(MixedPairParameters {
            J: j,
            S: s,
            a: vector(r, 0.4),
            eps: between(r, 0.0, 0.3),
        })
        .expect("valid");
        let turn = UnitQuaternion::from_components(r.rotation().quaternion()).expect("unit");
        let (other, m) = (r.rotation(), [momentum(r), momentum(r)]);
        let state = move |part: f64| {
            model
                .begin(MixedPairInitial {
                    Λ: other,
                    body_momentum_Λ: BodyMomentum(m[0] * part),
                    q: turn,
                    body_momentum_q: BodyMomentum(m[1] * part),
                })
                .expect("valid")
        };
        let unit = (j.trace() / m[0].norm()).min(s.trace() / m[1].norm());
        Problem {
            model,
            state: Box::new(state),
            momenta: stacked(&m),
            unit,
        }
    }
);

judged!(JudgedFour, StiffBody, StiffBodyConfiguration { Λ: Orthogonal<4> }, |r: &mut Random| {
    let skew = |r: &mut Random| {
        let a = SMatrix::<f64, 4, 4>::from_fn(|_, _| r.symmetric());
        a - a.transpose()
    };
    let a = SMatrix::<f64, 4, 4>::from_fn(|_, _| 0.3 * r.symmetric());
    let j = a * a.transpose() + SMatrix::identity() * 0.4;
    let model = StiffBody::new(StiffBodyParameters {
        J: (j + j.transpose()) * 0.5,
        c: between(r, 0.05, 0.2),
    }).expect("valid");
    let (turned, m) = (skew(r), skew(r) * 0.5);
    let one = SMatrix::<f64, 4, 4>::identity();
    let cayley = (one - turned).try_inverse().expect("skew") * (one + turned);
    let place = Orthogonal::from_matrix(&cayley).expect("a rotation");
    let state = move |part: f64| model.begin(StiffBodyInitial {
        Λ: place,
        body_momentum: BodyMomentumMatrix(m * part),
    }).expect("valid");
    let mut momenta = Vec::new();
    for i in 0..4 {
        for k in i + 1..4 {
            momenta.push(m[(k, i)]);
        }
    }
    Problem { model, state: Box::new(state), momenta: DVector::from_vec(momenta), unit: j.trace() / m.norm() }
});

judged!(JudgedEllipsoid, Ellipsoid, EllipsoidConfiguration { Q: Linear<3> }, |r: &mut Random| {
    let i0 = positive(r);
    let model = Ellipsoid::new(EllipsoidParameters { I0: i0, k: between(r, 0.1, 2.0) }).expect("valid");
    let q = Matrix3::identity() + Matrix3::from_fn(|_, _| 0.3 * r.symmetric());
    let m = Matrix3::from_fn(|_, _| 0.5 * r.symmetric());
    let place = Linear::from_matrix(&q).expect("invertible");
    let state = move |part: f64| model.begin(EllipsoidInitial {
        Q: place,
        body_momentum: BodyMomentumMatrix(m * part),
    }).expect("valid");
    let momenta = DVector::from_iterator(9, m.transpose().iter().copied());
    Problem { model, state: Box::new(state), momenta, unit: 0.6 * i0.trace() / m.norm() }
});

macro_rules! judged_random {
    ($($judge:ident $Model:ident $Parameters:ident $Initial:ident $Configuration:ident,)+) => {$(
        judged!($judge, $Model, $Configuration { Λ: Rotation }, |r: &mut Random| {
            let j = positive(r);
            let model = $Model::new($Parameters {
                J: j,
                S: positive(r) * 0.5,
                a: vector(r, 0.6),
                b: vector(r, 0.6),
                z: Vector3::z(),
                c: between(r, 0.0, 0.3),
                d: between(r, -0.3, 0.3),
            }).expect("valid");
            let (turn, m) = (r.rotation(), momentum(r));
            let state = move |part: f64| model.begin($Initial {
                Λ: turn,
                body_momentum: BodyMomentum(m * part),
            }).expect("valid");
            Problem { model, state: Box::new(state), momenta: stacked(&[m]), unit: j.trace() / m.norm() }
        });
    )+};
}

judged_random! {
    Judged0 Random0 Random0Parameters Random0Initial Random0Configuration,
    Judged1 Random1 Random1Parameters Random1Initial Random1Configuration,
    Judged2 Random2 Random2Parameters Random2Initial Random2Configuration,
    Judged3 Random3 Random3Parameters Random3Initial Random3Configuration,
    Judged4 Random4 Random4Parameters Random4Initial Random4Configuration,
    Judged5 Random5 Random5Parameters Random5Initial Random5Configuration,
    Judged6 Random6 Random6Parameters Random6Initial Random6Configuration,
    Judged7 Random7 Random7Parameters Random7Initial Random7Configuration,
    Judged8 Random8 Random8Parameters Random8Initial Random8Configuration,
    Judged9 Random9 Random9Parameters Random9Initial Random9Configuration,
}
