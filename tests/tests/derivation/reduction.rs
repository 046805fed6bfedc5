//! Models stated by their configurations at both ends of a step. The residual of each unreduced statement equals the variation of
//! the hand-written action on either side, and its steps equal those of the reduced statement. A wrong sign, factor or frame fails.

use super::common::oracle_bridge::{AGREEMENT, assignment};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Rotation, SpatialMomentum};
use clebsch_core::{Derivation, derive_source};
use clebsch_oracle::oracle::action::bodies::{FreeBody, HeavyTop, Stated};
use clebsch_oracle::oracle::action::coupled::CoupledBodies;
use clebsch_oracle::oracle::action::elastic::{EllipsoidConvective, EllipsoidSpatial, entries};
use clebsch_oracle::oracle::action::{DiscreteAction, Side, rotations, stationarity};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

const POINTS: usize = 200;

/// A system with a choice of the side of variation.
struct From<S>(S, Side);

impl<const N: usize, const G: usize, S: DiscreteAction<N, G>> DiscreteAction<N, G> for From<S> {
    fn side(&self) -> Side {
        self.1
    }

    fn edge<T: Number>(&self, tail: &[Square<T, N>; G], head: &[Square<T, N>; G]) -> Vec<T> {
        self.0.edge(tail, head)
    }
}

fn derive(text: &str) -> Derivation {
    derive_source(text).unwrap_or_else(|e| panic!("{text}\nis refused:\n{e}"))
}

/// The largest disagreement between the derived residual and the variation of the action.
fn worst<const N: usize, const G: usize, S: Stated<N, G>>(
    text: &str,
    side: Side,
    basis: &[Square<f64, N>],
) -> f64 {
    let derivation = derive(text);
    assert!(derivation.spec.reduction.is_some());
    let mut source = Source::seeded(7);
    let mut worst: f64 = 0.0;
    for _ in 0..POINTS {
        let system = S::random(&mut source);
        let nodes: [[Square<f64, N>; G]; 3] = from_fn(|_| S::node(&mut source));
        let values = assignment(&system.given(&nodes), ("h", system.step()));
        let oracle = stationarity(&From(system, side), &nodes, basis);
        let engine = match derivation.residual(&values) {
            Ok(engine) => engine,
            Err(error) => panic!("{text}\ncannot be evaluated: {error}"),
        };
        worst = worse(worst, oracle.disagreement(&engine));
    }
    worst
}

fn body(update: &str) -> String {
    format!(
        "model Body {{
            param J: Sym<3>; group Λ: SO<3> velocity Ω;
            constraint next(Λ) = {update};
            lagrangian = tr((next(Λ) - Λ)*J*(next(Λ) - Λ)^T)/(2*h);
        }}"
    )
}

fn top(update: &str, rule: &str) -> String {
    format!(
        "model Top {{
            param J: Sym<3>; param gU, z: Vec<3>; group Λ: SO<3> velocity Ω;
            constraint next(Λ) = {update}; node {rule};
            lagrangian = -tr(J*Λ^T*next(Λ))/h - h*dot(z, Λ*gU);
        }}"
    )
}

fn bodies(first: &str, second: &str) -> String {
    format!(
        "model Bodies {{
            param J1, J2: Sym<3>; param d1, d2: Vec<3>; param eps: Real;
            group Λ1: SO<3> velocity Ω1; group Λ2: SO<3> velocity Ω2;
            constraint next(Λ1) = {first}; constraint next(Λ2) = {second};
            lagrangian = -(tr(J1*Λ1^T*next(Λ1)) + tr(J2*Λ2^T*next(Λ2))
                + eps*dot((next(Λ1) - Λ1)*d1, (next(Λ2) - Λ2)*d2))/h;
        }}"
    )
}

fn holds(what: &str, worst: f64) {
    println!("{what}: {worst:e}");
    assert!(worst < AGREEMENT, "{what}: {worst:e}");
}

#[test]
fn residuals_are_variations_of_the_action_as_stated() {
    let basis = rotations();
    for (update, side) in [("Λ*Ω", Side::Body), ("Ω*Λ", Side::Space)] {
        holds(update, worst::<3, 1, FreeBody>(&body(update), side, &basis));
        let rules = [
            worst::<3, 1, HeavyTop<0>>(&top(update, "symmetric"), side, &basis),
            worst::<3, 1, HeavyTop<1>>(&top(update, "incoming"), side, &basis),
            worst::<3, 1, HeavyTop<2>>(&top(update, "outgoing"), side, &basis),
        ];
        for found in rules {
            holds(update, found);
        }
    }
    let text = bodies("Λ1*Ω1", "Λ2*Ω2");
    holds(
        "bodies",
        worst::<3, 2, CoupledBodies<true>>(&text, Side::Body, &basis),
    );
    let text = bodies("Ω1*Λ1", "Ω2*Λ2");
    holds(
        "bodies in space",
        worst::<3, 2, CoupledBodies<true>>(&text, Side::Space, &basis),
    );
}

#[test]
fn residuals_of_elastic_bodies_too() {
    let ellipsoid = |update: &str, potential: &str| {
        format!(
            "model Ellipsoid {{
                param C0, I0: Sym<3>; param a, b, c, d: Real; group Q: GL<3> velocity G;
                constraint next(Q) = {update};
                lagrangian = tr(C0*(next(Q) - Q)*I0*(next(Q) - Q)^T)/(2*h) - h*({potential});
            }}"
        )
    };
    let stored = "a*I1(Q^T*C0*Q) + b*I2(Q^T*C0*Q) + c*det(Q^T*C0*Q) - (d/2)*log(det(Q^T*C0*Q))";
    let text = ellipsoid("Q*G", stored);
    let found = worst::<3, 1, EllipsoidConvective<3>>(&text, Side::Body, &entries());
    holds("convective", found);
    let text = ellipsoid("G*Q", "0*a*det(C0)");
    let found = worst::<3, 1, EllipsoidSpatial>(&text, Side::Space, &entries());
    holds("spatial", found);
}

#[test]
fn a_wrong_statement_disagrees() {
    let basis = rotations();
    // Mistakes: the sign of the weight, the other side, a factor in the coupling.
    let rising = top("Λ*Ω", "symmetric").replace("- h*dot", "+ h*dot");
    let wrong = [
        worst::<3, 1, HeavyTop<0>>(&rising, Side::Body, &basis),
        worst::<3, 1, HeavyTop<0>>(&top("Λ*Ω", "symmetric"), Side::Space, &basis),
        worst::<3, 2, CoupledBodies<true>>(
            &bodies("Λ1*Ω1", "Λ2*Ω2").replace("+ eps*", "+ 2*eps*"),
            Side::Body,
            &basis,
        ),
    ];
    for found in wrong {
        assert!(found > 1e4 * AGREEMENT, "{found:e}");
    }
}

clebsch::model! {
    model TopStated {
        param J: Sym<3>;
        param gU, z: Vec<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Λ^T*next(Λ))/h - h*dot(z, Λ*gU);
    }
}
clebsch::model! {
    model TopStatedInSpace {
        param J: Sym<3>;
        param gU, z: Vec<3>;
        group Λ: SO<3> velocity ω;
        constraint next(Λ) = ω*Λ;
        lagrangian = -tr(J*Λ^T*next(Λ))/h - h*dot(z, Λ*gU);
    }
}
clebsch::model! {
    model TopReduced {
        param J: Sym<3>;
        param gU, z: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ);
    }
}

#[test]
fn steps_are_those_of_the_reduced_statement() {
    let j = Matrix3::new(1.1, 0.1, 0.0, 0.1, 1.4, -0.2, 0.0, -0.2, 1.9);
    let (g, z) = (Vector3::new(0.4, -0.3, 0.9), Vector3::new(0.0, 0.6, 0.8));
    let attitude = Rotation::exp(&Vector3::new(0.3, -0.8, 0.5));
    let momentum = BodyMomentum(Vector3::new(0.4, -0.2, 0.9));
    let reduced = TopReduced::new(TopReducedParameters { J: j, gU: g, z }).unwrap();
    let stated = TopStated::new(TopStatedParameters { J: j, gU: g, z }).unwrap();
    let in_space = TopStatedInSpace::new(TopStatedInSpaceParameters { J: j, gU: g, z }).unwrap();
    let (mut a, mut work_a) = reduced
        .start(
            TopReducedInitial {
                Λ: attitude,
                body_momentum: momentum,
            },
            0.1,
        )
        .unwrap();
    let (mut b, mut work_b) = stated
        .start(
            TopStatedInitial {
                Λ: attitude,
                body_momentum: momentum,
            },
            0.1,
        )
        .unwrap();
    let spatial_momentum = SpatialMomentum(attitude.rotate(&momentum.0));
    let (mut c, mut work_c) = in_space
        .start(
            TopStatedInSpaceInitial {
                Λ: attitude,
                spatial_momentum,
            },
            0.1,
        )
        .unwrap();
    for _ in 0..200 {
        reduced.step(&mut a, &mut work_a).unwrap();
        stated.step(&mut b, &mut work_b).unwrap();
        in_space.step(&mut c, &mut work_c).unwrap();
    }
    // The same operations on the same numbers, hence bitwise equal.
    assert_eq!((a.Λ(), a.spatial_momentum()), (b.Λ(), b.spatial_momentum()));
    assert_eq!(reduced.Γ(&a), stated.z_body(&b));
    assert_eq!(reduced.energy(&a), stated.energy(&b));
    // Another form of the same step: a rounding error, slightly amplified by 200 steps of a tumbling top.
    let off = (a.Λ().matrix() - c.Λ().matrix()).norm();
    assert!(off < 1e-11, "{off:e}");
    // The stored source text is the stated one, and it derives the same model.
    assert!(TopStated::<f64>::SOURCE.contains("next(Λ)"));
    assert!(!TopStated::<f64>::SOURCE.contains("z_body"));
    assert_eq!(
        derive(TopStated::<f64>::SOURCE).spec.lagrangian,
        derive(&top("Λ*Ω", "symmetric")).spec.lagrangian
    );
}
