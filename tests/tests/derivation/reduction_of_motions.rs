//! Models on SU(2), SE(3) and several groups at once, stated by their configurations at both ends of a step. Their residuals equal
//! the variation of the hand-written action and the residual of the reduced statement; their steps equal those of the reduced
//! model. A wrong statement disagrees.

use super::common::oracle_bridge::{AGREEMENT, assignment};
use clebsch::nalgebra::{Matrix3, SVector, Vector3, Vector4};
use clebsch::{BodyImpulse, BodyMomentum, Group, RigidMotion, Rotation, UnitQuaternion};
use clebsch_core::print::{Format, Style, expression};
use clebsch_core::{Derivation, derive_source};
use clebsch_models::cayley_klein::{CayleyKlein, CayleyKleinInitial, CayleyKleinParameters};
use clebsch_models::kirchhoff_body::{
    KirchhoffBody, KirchhoffBodyInitial, KirchhoffBodyParameters,
};
use clebsch_oracle::oracle::action::mixed::{self, Mixed};
use clebsch_oracle::oracle::action::motions::{self, twists};
use clebsch_oracle::oracle::action::quaternions::{self, halves};
use clebsch_oracle::oracle::action::{
    DiscreteAction, Side, Variation, stationarity, stationarity_along,
};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

const POINTS: usize = 200;

fn derive(text: &str) -> Derivation {
    derive_source(text).unwrap_or_else(|e| panic!("{text}\nis refused:\n{e}"))
}

/// The gallery's quaternion body, unreduced, on either side.
fn quaternion_body(update: &str) -> String {
    format!(
        "model Body {{
            param I: Diag<3>; param c: Real; group q: SU<2> velocity W;
            constraint next(q) = {update};
            let w = im(q^T*next(q));
            lagrangian = -(4*c/h)*re(q^T*next(q)) + (2/h)*dot(w, (I - c*Id)*w);
        }}"
    )
}

clebsch::model! {
    model QuaternionStated {
        param I: Diag<3>;
        param c: Real;
        group q: SU<2> velocity W;
        constraint next(q) = q*W;
        let w = im(q^T*next(q));
        lagrangian = -(4*c/h)*re(q^T*next(q)) + (2/h)*dot(w, (I - c*Id)*w);
    }
}

clebsch::model! {
    model KirchhoffStated {
        param J: Sym<3>;
        param M: Sym<3>;
        param D: Mat<3>;
        param b: Vec<4>;
        param Z: Vec<4>;
        group G: SE<3> velocity V;
        constraint next(G) = G*V;
        let x = pos(next(G)) - pos(G);
        let u = (rot(G) + rot(next(G)))^T*x/2;
        let turn = rot(G)^T*rot(next(G));
        lagrangian = -tr(J*turn)/h + dot(u, M*u)/(2*h) + dot(vee(turn), D*u)/h - h*dot(b, G^T*Z);
    }
}

clebsch::model! {
    model MixedStated {
        param K1: Diag<3>;
        param J2, J3, M: Sym<3>;
        param d1, d2, d3, z: Vec<3>;
        param eps: Real;
        group q: SU<2> velocity W;
        group R: SO<3> velocity U;
        group G: SE<3> velocity V;
        constraint next(q) = q*W;
        constraint next(R) = R*U;
        constraint next(G) = G*V;
        let w = im(q^T*next(q));
        let x = rot(G)^T*(pos(next(G)) - pos(G));
        lagrangian = (2*dot(w, K1*w) - tr(J2*R^T*next(R)) - tr(J3*rot(G)^T*rot(next(G)))
            + dot(x, M*x)/2 - eps*dot((rot(next(q)) - rot(q))*d1, (next(R) - R)*d2))/h
            - h*dot(z, rot(q)*d1) - h*dot(R*d2, rot(G)*d3);
    }
}

/// The largest disagreement of a statement with the variation of the action, and with the residual of another statement of the same
/// model.
fn worst<const G: usize, A: DiscreteAction<4, G>>(
    [text, other]: [&str; 2],
    system: impl Fn(&mut Source) -> (A, f64),
    node: fn(&mut Source) -> [Square<f64, 4>; G],
    given: impl Fn(&A, &[[Square<f64, 4>; G]; 3]) -> Vec<clebsch_oracle::oracle::points::NamedValue>,
    oracle: impl Fn(&A, &[[Square<f64, 4>; G]; 3]) -> Variation,
) -> (f64, f64) {
    let (d, other) = (derive(text), derive(other));
    let mut source = Source::seeded(91);
    let (mut from_oracle, mut from_other): (f64, f64) = (0.0, 0.0);
    for _ in 0..POINTS {
        let (action, h) = system(&mut source);
        let nodes: [[Square<f64, 4>; G]; 3] = from_fn(|_| node(&mut source));
        let values = assignment(&given(&action, &nodes), ("h", h));
        let wanted = oracle(&action, &nodes);
        let found = d.residual(&values).expect("all values are given");
        from_oracle = worse(from_oracle, wanted.disagreement(&found));
        let second = other.residual(&values).expect("all values are given");
        let against = Variation {
            derivative: second,
            scale: wanted.scale,
        };
        from_other = worse(from_other, against.disagreement(&found));
    }
    println!("oracle {from_oracle:e}, the other statement {from_other:e}");
    (from_oracle, from_other)
}

fn holds((a, b): (f64, f64)) {
    assert!(a < AGREEMENT && b < AGREEMENT, "{a:e} {b:e}");
}

fn quaternions_worst(texts: [&str; 2], side: Side) -> (f64, f64) {
    worst(
        texts,
        |s| {
            let a = quaternions::CayleyKlein::random(s, side);
            let h = a.h;
            (a, h)
        },
        quaternions::node,
        // The unreduced statement uses body moments on either side.
        |a, nodes| {
            let side = Side::Body;
            quaternions::CayleyKlein { side, ..a.clone() }.given(nodes)
        },
        |a, nodes| stationarity(a, nodes, &halves()),
    )
}

fn kirchhoff_worst(texts: [&str; 2]) -> (f64, f64) {
    worst(
        texts,
        |s| {
            let a = motions::KirchhoffBody::random(s);
            let h = a.h;
            (a, h)
        },
        motions::node,
        motions::KirchhoffBody::given,
        |a, nodes| stationarity(a, nodes, &twists()),
    )
}

fn mixed_worst(texts: [&str; 2]) -> (f64, f64) {
    let bases = mixed::bases();
    worst(
        texts,
        |s| {
            let a = Mixed::random(s);
            let h = a.h;
            (a, h)
        },
        mixed::node,
        Mixed::given,
        |a, nodes| stationarity_along(a, nodes, bases.each_ref().map(Vec::as_slice)),
    )
}

#[test]
fn residuals_are_variations_and_those_of_the_reduced_statement() {
    let body = clebsch_models::find("cayley-klein").expect("in the gallery");
    let stated = quaternion_body("q*W");
    holds(quaternions_worst([&stated, body.card.source], Side::Body));
    let in_space = quaternion_body("W*q");
    holds(quaternions_worst([&in_space, &in_space], Side::Space));
    let fluid = clebsch_models::find("kirchhoff-body").expect("in the gallery");
    let stated = KirchhoffStated::<f64>::SOURCE;
    holds(kirchhoff_worst([stated, fluid.card.source]));
}

#[test]
fn different_groups_in_one_model() {
    holds(mixed_worst([mixed::REDUCED, mixed::UNREDUCED]));
    let d = derive(mixed::UNREDUCED);
    let found: Vec<&str> = d
        .spec
        .advected
        .iter()
        .map(|a| d.letters.symbols.get(a.quantity).name.as_str())
        .collect();
    assert_eq!(found, ["relative_q_R", "z_body_q", "relative_R_G"]);
}

#[test]
fn the_reduced_action_is_the_typed_one() {
    let show = |d: &Derivation| {
        let s = &d.letters.symbols;
        expression(&d.spec.lagrangian, s, &Style::new("k"), Format::Text)
    };
    let body = clebsch_models::find("cayley-klein").expect("in the gallery");
    assert_eq!(
        show(&derive(&quaternion_body("q*W"))),
        show(&derive(body.card.source))
    );
}

#[test]
fn wrong_statements_disagree() {
    let wrong = [
        quaternions_worst(
            [&quaternion_body("q*W").replace("4*c", "2*c"); 2].map(String::as_str),
            Side::Body,
        ),
        quaternions_worst([&quaternion_body("W*q"); 2].map(String::as_str), Side::Body),
        kirchhoff_worst(
            [&KirchhoffStated::<f64>::SOURCE.replace("- h", "+ h"); 2].map(String::as_str),
        ),
        mixed_worst([&mixed::UNREDUCED.replace("- eps", "+ eps"); 2].map(String::as_str)),
        mixed_worst(
            [&mixed::REDUCED.replace("dot(d2, B*d3)", "dot(d3, B*d2)"); 2].map(String::as_str),
        ),
    ];
    for (found, _) in wrong {
        assert!(found > 1e4 * AGREEMENT, "{found:e}");
    }
}

#[test]
fn steps_of_the_quaternion_body_are_those_of_the_reduced_statement() {
    let moments = Matrix3::from_diagonal(&Vector3::new(3.5, 2.5, 2.0));
    let mu = BodyMomentum(Vector3::new(-0.5, 0.1, 1.0));
    let q = UnitQuaternion::identity().retract(&[0.4, -0.2, 0.7]);
    let reduced = CayleyKlein::new(CayleyKleinParameters { I: moments, c: 1.0 }).unwrap();
    let stated = QuaternionStated::new(QuaternionStatedParameters { I: moments, c: 1.0 }).unwrap();
    let initial = CayleyKleinInitial {
        q,
        body_momentum: mu,
    };
    let (mut a, mut work_a) = reduced.start(initial, 0.1).unwrap();
    let initial = QuaternionStatedInitial {
        q,
        body_momentum: mu,
    };
    let (mut b, mut work_b) = stated.start(initial, 0.1).unwrap();
    for _ in 0..200 {
        reduced.step(&mut a, &mut work_a).unwrap();
        stated.step(&mut b, &mut work_b).unwrap();
    }
    // Both derive the same action and emit the same operations.
    assert_eq!((a.q(), a.spatial_momentum()), (b.q(), b.spatial_momentum()));
}

#[test]
fn steps_of_kirchhoffs_body_are_those_of_the_reduced_statement() {
    let (j, m) = (
        Matrix3::new(1.0, 0.1, 0.0, 0.1, 0.7, -0.1, 0.0, -0.1, 0.4),
        Matrix3::new(1.5, 0.0, 0.2, 0.0, 2.0, 0.1, 0.2, 0.1, 3.0),
    );
    let d = Matrix3::from_diagonal(&Vector3::new(0.1, -0.05, 0.15));
    let (b, z) = (
        Vector4::new(0.1, 0.0, -0.2, 0.3),
        Vector4::new(0.0, 0.6, 0.8, 0.0),
    );
    let start = RigidMotion::identity().retract(&[0.3, -0.2, 0.5, 1.0, 0.4, -0.7]);
    let impulse = BodyImpulse(SVector::from([0.3, -0.2, 0.8, 0.9, 0.2, 0.4]));
    let reduced = KirchhoffBody::new(KirchhoffBodyParameters {
        J: j,
        M: m,
        D: d,
        b,
        Z: z,
    })
    .unwrap();
    let stated = KirchhoffStated::new(KirchhoffStatedParameters {
        J: j,
        M: m,
        D: d,
        b,
        Z: z,
    })
    .unwrap();
    let initial = KirchhoffBodyInitial {
        G: start,
        body_momentum: impulse,
    };
    let (mut one, mut work_one) = reduced.start(initial, 0.05).unwrap();
    let initial = KirchhoffStatedInitial {
        G: start,
        body_momentum: impulse,
    };
    let (mut two, mut work_two) = stated.start(initial, 0.05).unwrap();
    let mut first = 0.0;
    for k in 0..100 {
        reduced.step(&mut one, &mut work_one).unwrap();
        stated.step(&mut two, &mut work_two).unwrap();
        if k == 0 {
            first = (one.G().matrix() - two.G().matrix()).amax();
        }
    }
    let last = (one.G().matrix() - two.G().matrix()).amax();
    println!("one step {first:e}, a hundred {last:e}");
    // Another form of the same equation: the rounding error of one step, later amplified by the motion.
    assert!(first < 1e-14 && last < 1e-11, "{first:e} {last:e}");
}

fn four(r: &Matrix3<f64>) -> Square<f64, 4> {
    Square::from_entries(|i, j| match (i, j) {
        (3, 3) => 1.0,
        (3, _) | (_, 3) => 0.0,
        (i, j) => r[(i, j)],
    })
}

#[test]
fn steps_on_different_groups_make_the_action_stationary() {
    let mut source = Source::seeded(17);
    let mut action = Mixed::random(&mut source);
    // The parameters by name, from the oracle.
    let given = action.given(&from_fn(|_| mixed::node(&mut source)));
    let data = |name: &str| {
        let found = given.iter().find(|g| g.name == name).expect("a parameter");
        found.data.clone()
    };
    let (square, vector) = (
        |name: &str| Matrix3::from_row_slice(&data(name)),
        |name: &str| Vector3::from_row_slice(&data(name)),
    );
    let h = 0.02;
    (action.h, action.coupling) = (h, 0.1);
    let model = MixedStated::new(MixedStatedParameters {
        K1: square("K1"),
        J2: square("J2"),
        J3: square("J3"),
        M: square("M"),
        d1: vector("d1"),
        d2: vector("d2"),
        d3: vector("d3"),
        z: vector("z"),
        eps: action.coupling,
    })
    .unwrap();
    let initial = MixedStatedInitial {
        q: UnitQuaternion::identity().retract(&[0.4, -0.2, 0.7]),
        R: Rotation::exp(&Vector3::new(0.3, -0.8, 0.5)),
        G: RigidMotion::identity().retract(&[0.3, -0.2, 0.5, 1.0, 0.4, -0.7]),
        body_momentum_q: BodyMomentum(Vector3::new(0.2, -0.3, 0.4)),
        body_momentum_R: BodyMomentum(Vector3::new(-0.1, 0.3, 0.2)),
        body_momentum_G: BodyImpulse(SVector::from([0.3, -0.2, 0.2, 0.3, 0.2, 0.4])),
    };
    let (mut state, mut work) = model.start(initial, h).unwrap();
    let mut nodes = Vec::new();
    for _ in 0..30 {
        nodes.push([
            Square::from_entries(|i, j| state.q().matrix()[(i, j)]),
            four(&state.R().matrix()),
            Square::from_entries(|i, j| state.G().matrix()[(i, j)]),
        ]);
        model.step(&mut state, &mut work).unwrap();
    }
    let bases = mixed::bases();
    let mut worst: f64 = 0.0;
    for three in nodes.windows(3) {
        let three: [[Square<f64, 4>; 3]; 3] = from_fn(|i| three[i]);
        let v = stationarity_along(&action, &three, bases.each_ref().map(Vec::as_slice));
        let largest = v.derivative.iter().fold(0.0_f64, |m, x| worse(m, x.abs()));
        worst = worse(worst, largest / v.scale);
    }
    println!("stationary to {worst:e}");
    assert!(worst < 1e-13, "{worst:e}");
    // Negative control: one element perturbed by 1e-3.
    let mut moved: [[Square<f64, 4>; 3]; 3] = from_fn(|i| nodes[i]);
    moved[1][1] = four(
        &(Rotation::exp(&Vector3::new(1e-3, 0.0, 0.0)).matrix()
            * Matrix3::from_fn(|i, j| moved[1][1].0[i][j])),
    );
    let v = stationarity_along(&action, &moved, bases.each_ref().map(Vec::as_slice));
    assert!(v.derivative.iter().any(|x| x.abs() / v.scale > 1e-6));
}
