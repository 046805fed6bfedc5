//! Random problems for models that use Newton's method, and the residual of the derived equations at three consecutive states. A
//! stream of draws gives model, state, and the step size for a rotation of about one radian.

use clebsch::integrate::Model;
use clebsch::nalgebra::{Matrix3, SMatrix, SVector, Vector3, Vector4};
use clebsch::{
    BodyImpulse, BodyMomentum, BodyMomentumMatrix, Orthogonal, RigidMotion, Rotation,
    UnitQuaternion,
};
use clebsch_models::cayley_klein::{
    CayleyKlein, CayleyKleinConfiguration, CayleyKleinInitial, CayleyKleinParameters,
    CayleyKleinState,
};
use clebsch_models::coupled_bodies::{
    CoupledBodies, CoupledBodiesConfiguration, CoupledBodiesInitial, CoupledBodiesParameters,
    CoupledBodiesState,
};
use clebsch_models::kirchhoff_body::{
    KirchhoffBody, KirchhoffBodyConfiguration, KirchhoffBodyInitial, KirchhoffBodyParameters,
    KirchhoffBodyState,
};
use clebsch_oracle::physics::random_states::Draws;

clebsch::model! {
    /// Not separable: the potential of an edge depends on the rotation of the body along it.
    pub model RoughBody {
        param J: Sym<3>;
        param c: Real;
        param a, z: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - c*tr(J*Ω)^2/h - h*dot(a, Γ)*tr(Ω);
    }
}

clebsch::model! {
    /// In unit quaternions, with a Lagrangian that is not quadratic in the velocity.
    pub model StiffQuaternion {
        param S: Sym<3>;
        param c: Real;
        group q: SU<2> velocity W;
        constraint next(q) = q*W;
        lagrangian = (2/h)*dot(im(W), S*im(W)) + (2*c/h)*dot(im(W), S*im(W))^2 - (4*c/h)*re(W);
    }
}

clebsch::model! {
    /// Bodies in different groups.
    pub model MixedPair {
        param J, S: Sym<3>;
        param a: Vec<3>;
        param eps: Real;
        group Λ: SO<3> velocity Ω;
        group q: SU<2> velocity W;
        constraint next(Λ) = Λ*Ω;
        constraint next(q) = q*W;
        lagrangian = -tr(J*Ω)/h + (2/h)*dot(im(W), S*im(W)) + eps*dot(im(W), Ω*a)*re(W)/h;
    }
}

clebsch::model! {
    /// A Lagrangian in four dimensions that is not linear in the velocity.
    pub model StiffBody {
        param J: Sym<4>;
        param c: Real;
        group Λ: SO<4> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h - c*tr(J*Ω)^2/h;
    }
}

/// A model with a distribution of random problems.
pub trait Drawn {
    /// The model.
    type M: Model<Scalar = f64>;

    /// The names of its configurations.
    const NAMES: &'static [&'static str];

    /// The decimal logarithm of the largest random step size, in units of one radian.
    const BEYOND: f64 = 0.2;

    /// The model, the state, and the step size of about one radian.
    fn draw(
        draws: &mut Draws,
    ) -> (
        Self::M,
        <Self::M as clebsch::integrate::Stepper>::State,
        f64,
    );

    /// The largest component of the derived equations at three consecutive states, relative to the size of their terms. The first
    /// attitude of the last state is rotated by an angle.
    fn residual(
        model: &Self::M,
        h: f64,
        states: &[<Self::M as clebsch::integrate::Stepper>::State; 3],
        angle: f64,
    ) -> f64;
}

fn vector(draws: &mut Draws, length: f64) -> Vector3<f64> {
    Vector3::from(draws.direction()) * length
}

fn length(draws: &mut Draws) -> f64 {
    draws.uniform(0.1, 2.0)
}

fn turn(draws: &mut Draws) -> Rotation {
    Rotation::from_quaternion(draws.attitude().0).expect("unit")
}

/// A random symmetric matrix with eigenvalues from 0.2 to 1.2.
fn positive(draws: &mut Draws) -> Matrix3<f64> {
    let frame = turn(draws).matrix();
    let values = Vector3::from_fn(|_, _| draws.uniform(0.2, 1.2));
    let j = frame * Matrix3::from_diagonal(&values) * frame.transpose();
    (j + j.transpose()) * 0.5
}

/// A rotation vector of this angle, about a generic axis.
fn small(angle: f64) -> Vector3<f64> {
    Vector3::new(0.6, -0.64, 0.48) * angle
}

fn largest<const N: usize>(residual: &SVector<f64, N>, size: f64) -> f64 {
    // `amax` ignores NaN.
    let sum: f64 = residual.iter().sum();
    (residual.amax() + 0.0 * sum) / size
}

/// Two bodies with a joint.
pub struct Coupled;

impl Drawn for Coupled {
    type M = CoupledBodies;
    const NAMES: &'static [&'static str] = &["Λ1", "Λ2"];

    fn draw(draws: &mut Draws) -> (CoupledBodies, CoupledBodiesState, f64) {
        let eps = draws.uniform(0.1, 1.0);
        let arms = [(); 2].map(|()| vector(draws, 0.7));
        let j = arms.map(|d| positive(draws) + d * d.transpose() * eps);
        let momenta = [(); 2].map(|()| {
            let length = length(draws);
            vector(draws, length)
        });
        let model = CoupledBodies::new(CoupledBodiesParameters {
            J1: j[0],
            J2: j[1],
            d1: arms[0],
            d2: arms[1],
            eps,
        });
        let model = model.expect("valid");
        let state = model.begin(CoupledBodiesInitial {
            Λ1: turn(draws),
            body_momentum_Λ1: BodyMomentum(momenta[0]),
            Λ2: turn(draws),
            body_momentum_Λ2: BodyMomentum(momenta[1]),
        });
        let unit = |i: usize| j[i].trace() / momenta[i].norm();
        (model, state.expect("valid"), unit(0).min(unit(1)))
    }

    fn residual(
        model: &CoupledBodies,
        h: f64,
        states: &[CoupledBodiesState; 3],
        angle: f64,
    ) -> f64 {
        let p = model.parameters();
        let at = |i: usize, angle: f64| CoupledBodiesConfiguration {
            Λ1: states[i].Λ1() * Rotation::exp(&small(angle)),
            Λ2: states[i].Λ2(),
        };
        let residual = model.balance(h, &at(0, 0.0), &at(1, 0.0), &at(2, angle));
        let momenta = [
            states[1].spatial_momentum_Λ1(),
            states[1].spatial_momentum_Λ2(),
        ];
        let momenta: f64 = momenta.iter().map(|m| m.0.norm()).sum();
        largest(&residual, (p.J1.norm() + p.J2.norm()) / h + momenta)
    }
}

/// A body in unit quaternions, which does not use Newton's method.
pub struct Quaternion;

impl Drawn for Quaternion {
    type M = CayleyKlein;
    const NAMES: &'static [&'static str] = &["q"];

    fn draw(draws: &mut Draws) -> (CayleyKlein, CayleyKleinState, f64) {
        let moments = Vector3::from_fn(|_, _| draws.uniform(0.5, 2.0));
        let model = CayleyKlein::new(CayleyKleinParameters {
            I: Matrix3::from_diagonal(&moments),
            c: draws.uniform(0.0, 1.0),
        });
        let model = model.expect("valid");
        let length = length(draws);
        let state = model.begin(CayleyKleinInitial {
            q: UnitQuaternion::from_components(draws.attitude().0).expect("unit"),
            body_momentum: BodyMomentum(vector(draws, length)),
        });
        (model, state.expect("valid"), moments.sum() / length)
    }

    fn residual(model: &CayleyKlein, h: f64, states: &[CayleyKleinState; 3], angle: f64) -> f64 {
        let p = model.parameters();
        let at = |i: usize, angle: f64| {
            let turn = Rotation::exp(&small(angle)).quaternion();
            CayleyKleinConfiguration {
                q: states[i].q() * UnitQuaternion::from_components(turn).expect("unit"),
            }
        };
        let residual = model.balance(h, &at(0, 0.0), &at(1, 0.0), &at(2, angle));
        let momentum = states[1].spatial_momentum().0.norm();
        largest(&residual, 4.0 * (p.I.norm() + p.c) / h + momentum)
    }
}

/// [`StiffQuaternion`].
pub struct Stiff;

impl Drawn for Stiff {
    type M = StiffQuaternion;
    const NAMES: &'static [&'static str] = &["q"];

    fn draw(draws: &mut Draws) -> (StiffQuaternion, StiffQuaternionState, f64) {
        let s = positive(draws);
        let model = StiffQuaternion::new(StiffQuaternionParameters {
            S: s,
            c: draws.uniform(0.1, 0.5),
        });
        let model = model.expect("valid");
        let length = length(draws);
        let state = model.begin(StiffQuaternionInitial {
            q: UnitQuaternion::from_components(draws.attitude().0).expect("unit"),
            body_momentum: BodyMomentum(vector(draws, length)),
        });
        (model, state.expect("valid"), s.trace() / length)
    }

    fn residual(
        model: &StiffQuaternion,
        h: f64,
        states: &[StiffQuaternionState; 3],
        angle: f64,
    ) -> f64 {
        let p = model.parameters();
        let at = |i: usize, angle: f64| {
            let turn = Rotation::exp(&small(angle)).quaternion();
            StiffQuaternionConfiguration {
                q: states[i].q() * UnitQuaternion::from_components(turn).expect("unit"),
            }
        };
        let residual = model.balance(h, &at(0, 0.0), &at(1, 0.0), &at(2, angle));
        let momentum = states[1].spatial_momentum().0.norm();
        largest(
            &residual,
            4.0 * (p.S.norm() * (1.0 + p.S.norm()) + p.c) / h + momentum,
        )
    }
}

/// A body in an ideal fluid.
pub struct Fluid;

impl Drawn for Fluid {
    type M = KirchhoffBody;
    const NAMES: &'static [&'static str] = &["G"];

    fn draw(draws: &mut Draws) -> (KirchhoffBody, KirchhoffBodyState, f64) {
        let (j, m) = (positive(draws), positive(draws) * 3.0);
        let model = KirchhoffBody::new(KirchhoffBodyParameters {
            J: j,
            M: m,
            D: positive(draws) * draws.uniform(0.0, 0.2),
            b: Vector4::from_fn(|_, _| draws.uniform(-0.2, 0.2)),
            Z: Vector4::new(0.0, 0.0, 1.0, 0.0),
        });
        let model = model.expect("valid");
        let rotation = turn(draws);
        let (spin, push) = (length(draws), length(draws));
        let (angular, linear) = (vector(draws, spin), vector(draws, push));
        let state = model.begin(KirchhoffBodyInitial {
            G: RigidMotion {
                rotation,
                translation: vector(draws, 1.0),
            },
            body_momentum: BodyImpulse(SVector::from_fn(|i, _| match i {
                0..3 => angular[i],
                _ => linear[i - 3],
            })),
        });
        (model, state.expect("valid"), j.trace() / spin)
    }

    fn residual(
        model: &KirchhoffBody,
        h: f64,
        states: &[KirchhoffBodyState; 3],
        angle: f64,
    ) -> f64 {
        let p = model.parameters();
        let at = |i: usize, angle: f64| KirchhoffBodyConfiguration {
            G: states[i].G()
                * RigidMotion {
                    rotation: Rotation::exp(&small(angle)),
                    translation: Vector3::zeros(),
                },
        };
        let residual = model.balance(h, &at(0, 0.0), &at(1, 0.0), &at(2, angle));
        let momentum = states[1].spatial_momentum().0.norm();
        // The translation of a step is a difference of positions.
        let place = 1.0 + states[2].G().translation.norm();
        largest(
            &residual,
            (p.J.norm() + p.M.norm() + p.D.norm()) * place * place / h + momentum,
        )
    }
}

/// [`RoughBody`].
pub struct Rough;

impl Drawn for Rough {
    type M = RoughBody;
    const NAMES: &'static [&'static str] = &["Λ"];

    fn draw(draws: &mut Draws) -> (RoughBody, RoughBodyState, f64) {
        let j = positive(draws);
        let model = RoughBody::new(RoughBodyParameters {
            J: j,
            c: draws.uniform(0.1, 0.5),
            a: vector(draws, 0.3),
            z: Vector3::z(),
        });
        let model = model.expect("valid");
        let length = length(draws);
        let state = model.begin(RoughBodyInitial {
            Λ: turn(draws),
            body_momentum: BodyMomentum(vector(draws, length)),
        });
        (model, state.expect("valid"), j.trace() / length)
    }

    fn residual(model: &RoughBody, h: f64, states: &[RoughBodyState; 3], angle: f64) -> f64 {
        let p = model.parameters();
        let at = |i: usize, angle: f64| RoughBodyConfiguration {
            Λ: states[i].Λ() * Rotation::exp(&small(angle)),
        };
        let residual = model.balance(h, &at(0, 0.0), &at(1, 0.0), &at(2, angle));
        let momentum = states[1].spatial_momentum().0.norm();
        let size = p.J.norm() * (1.0 + 6.0 * p.c * p.J.norm());
        largest(&residual, size / h + momentum)
    }
}

/// [`MixedPair`].
pub struct Mixed;

impl Drawn for Mixed {
    type M = MixedPair;
    const NAMES: &'static [&'static str] = &["Λ", "q"];

    fn draw(draws: &mut Draws) -> (MixedPair, MixedPairState, f64) {
        let (j, s) = (positive(draws), positive(draws));
        let model = MixedPair::new(MixedPairParameters {
            J: j,
            S: s,
            a: vector(draws, 0.4),
            eps: draws.uniform(0.0, 0.3),
        });
        let model = model.expect("valid");
        let lengths = [(); 2].map(|()| length(draws));
        let state = model.begin(MixedPairInitial {
            Λ: turn(draws),
            body_momentum_Λ: BodyMomentum(vector(draws, lengths[0])),
            q: UnitQuaternion::from_components(draws.attitude().0).expect("unit"),
            body_momentum_q: BodyMomentum(vector(draws, lengths[1])),
        });
        let unit = (j.trace() / lengths[0]).min(s.trace() / lengths[1]);
        (model, state.expect("valid"), unit)
    }

    fn residual(model: &MixedPair, h: f64, states: &[MixedPairState; 3], angle: f64) -> f64 {
        let p = model.parameters();
        let at = |i: usize, angle: f64| MixedPairConfiguration {
            Λ: states[i].Λ() * Rotation::exp(&small(angle)),
            q: states[i].q(),
        };
        let residual = model.balance(h, &at(0, 0.0), &at(1, 0.0), &at(2, angle));
        let momenta = [
            states[1].spatial_momentum_Λ(),
            states[1].spatial_momentum_q(),
        ];
        let momenta: f64 = momenta.iter().map(|m| m.0.norm()).sum();
        largest(&residual, (p.J.norm() + 4.0 * p.S.norm()) / h + momenta)
    }
}

/// [`StiffBody`].
pub struct InFourDimensions;

impl Drawn for InFourDimensions {
    type M = StiffBody;
    const NAMES: &'static [&'static str] = &["Λ"];

    fn draw(draws: &mut Draws) -> (StiffBody, StiffBodyState, f64) {
        let skew = |draws: &mut Draws| {
            let a = SMatrix::<f64, 4, 4>::from_fn(|_, _| draws.uniform(-1.0, 1.0));
            a - a.transpose()
        };
        let a = SMatrix::<f64, 4, 4>::from_fn(|_, _| draws.uniform(-0.3, 0.3));
        let j = a * a.transpose() + SMatrix::identity() * 0.4;
        let model = StiffBody::new(StiffBodyParameters {
            J: (j + j.transpose()) * 0.5,
            c: draws.uniform(0.05, 0.2),
        });
        let model = model.expect("valid");
        let (turned, momentum) = (skew(draws), skew(draws) * 0.5);
        // The Cayley map of a skew matrix is a rotation.
        let one = SMatrix::<f64, 4, 4>::identity();
        let cayley = (one - turned).try_inverse().expect("skew") * (one + turned);
        let state = model.begin(StiffBodyInitial {
            Λ: Orthogonal::from_matrix(&cayley).expect("a rotation"),
            body_momentum: BodyMomentumMatrix(momentum),
        });
        (model, state.expect("valid"), j.trace() / momentum.norm())
    }

    fn residual(model: &StiffBody, h: f64, states: &[StiffBodyState; 3], angle: f64) -> f64 {
        let p = model.parameters();
        let mut turned = SMatrix::<f64, 4, 4>::identity();
        let (sin, cos) = angle.sin_cos();
        (turned[(0, 0)], turned[(1, 1)]) = (cos, cos);
        (turned[(1, 0)], turned[(0, 1)]) = (sin, -sin);
        let turned = Orthogonal::from_matrix(&turned).expect("a rotation");
        let at = |i: usize| StiffBodyConfiguration { Λ: states[i].Λ() };
        let last = StiffBodyConfiguration {
            Λ: states[2].Λ() * turned,
        };
        let residual = model.balance(h, &at(0), &at(1), &last);
        let momentum = states[1].spatial_momentum().0.norm();
        let size = p.J.norm() * (1.0 + 8.0 * p.c * p.J.norm());
        largest(&residual, size / h + momentum)
    }
}
