//! Models on SU(2) whose step reduces to a scalar equation: which models have this form, whether their steps satisfy the variation
//! of the unreduced action, and the error of a step size that is too large. Covers the gallery, models stated here, and random
//! states. A wrong body or node fails.

use super::text_model::{Given, TextModel, given};
use clebsch::card::Settings;
use clebsch::integrate::{Composition, CompositionOrder, Ensemble, Model, Stepper};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::solvers::unit_quaternions::QuaternionError;
use clebsch::{BodyMomentum, Rotation, StartError, StepCause, UnitQuaternion};
use clebsch_core::derive::select_solver::Method;
use clebsch_core::derive_source;
use clebsch_models::cayley_klein::{
    CayleyKlein, CayleyKleinInitial, CayleyKleinParameters, CayleyKleinState,
};
use clebsch_oracle::oracle::action::quaternions::{self, halves, left};
use clebsch_oracle::oracle::action::{DiscreteAction, Side, stationarity};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::physics::measure::worse;

/// A top in the body frame; its inertia has other axes.
const QUATERNION_TOP: &str = "model QuaternionTop {
    param a0, b, a13, a14: Real;
    param S: Sym<3>;
    param u, z: Vec<3>;
    group q: SU<2> velocity W;
    advected Γ: Vec<3> = rot(q)^T*z;
    constraint next(q) = q*W;
    constraint next(Γ) = rot(W)^T*Γ;
    lagrangian = a0*dot(im(W), S*im(W))/h + b*re(W)/h + a13*dot(Γ, S*Γ) + a14*dot(u, Γ);
}";

/// The same in the space frame: body and lever arm are advected.
const QUATERNION_TOP_SPATIAL: &str = "model QuaternionTopSpatial {
    param a0, b, a13, a14: Real;
    param z: Vec<3>;
    group q: SU<2> velocity w;
    advected S: Sym<3>;
    advected u: Vec<3>;
    constraint next(q) = w*q;
    constraint next(S) = rot(w)*S*rot(w)^T;
    constraint next(u) = rot(w)*u;
    lagrangian = a0*dot(im(w), S*im(w))/h + b*re(w)/h + a13*dot(z, S*z) + a14*dot(u, z);
}";

/// Tolerance of a solved equation, relative to its terms. Small steps are differences of attitudes, whose rounding matters more
/// because the terms have the size of the rotation angle. Errors of three nodes and two edges add up.
const ROUNDING: f64 = 2e-14;

type Node = [Square<f64, 4>; 1];

fn node(q: &UnitQuaternion) -> Node {
    [left(q.components())]
}

/// The oracle's derivative at the middle of three nodes, relative to the size of the terms.
fn off<A: DiscreteAction<4, 1>>(action: &A, nodes: &[UnitQuaternion; 3]) -> f64 {
    let found = stationarity(action, &nodes.map(|q| node(&q)), &halves());
    let most = found
        .derivative
        .iter()
        .fold(0.0, |m: f64, x| worse(m, x.abs()));
    most / found.scale
}

/// The three attitudes, with one rotated by an angle.
fn displaced([a, b, c]: [UnitQuaternion; 3], angle: f64) -> [UnitQuaternion; 3] {
    let turn = Rotation::exp(&(Vector3::new(0.6, -0.64, 0.48) * angle)).quaternion();
    [
        a,
        b * UnitQuaternion::from_components(turn).expect("unit"),
        c,
    ]
}

fn attitude(source: &mut Source) -> UnitQuaternion {
    let q: [f64; 4] = source.vector();
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    UnitQuaternion::from_components(q.map(|x| x / length)).expect("unit")
}

/// Attitudes at three nodes from a start; `None` if a step fails.
fn three(model: &TextModel, h: f64, given: &Given) -> Option<[UnitQuaternion; 3]> {
    let mut motion = model
        .start_with(Settings::step(h).to_inquire(), given)
        .ok()?;
    let mut out = [UnitQuaternion::identity(); 3];
    for (i, q) in out.iter_mut().enumerate() {
        if i > 0 {
            motion.step().ok()?;
        }
        let own = motion.numbers("q");
        *q = UnitQuaternion::from_components([own[0], own[1], own[2], own[3]]).expect("unit");
    }
    Some(out)
}

#[test]
fn steps_of_the_gallery_make_the_unreduced_action_stationary() {
    let mut source = Source::seeded(61);
    let [body, space] = ["cayley-klein", "cayley-klein-spatial"].map(TextModel::gallery);
    let (mut worst, mut made) = (0.0_f64, 0);
    for case in 0..4000 {
        let mut action = quaternions::CayleyKlein::random(&mut source, Side::Body);
        action.h *= [1.0, 0.1, 0.01][case % 3];
        let (h, c) = (action.h, action.c);
        let (q, momentum) = (attitude(&mut source), Vector3::from(source.vector::<3>()));
        let inertia = Matrix3::from_diagonal(&Vector3::from(action.moments));
        let given = given! { I: inertia, c: c, q: q, body_momentum: momentum };
        let seen = three(&body, h, &given);
        let r = q.rotation().matrix();
        let moved = r * inertia * r.transpose();
        let given = given! { c: c, q: q, spatial_momentum: r * momentum, I: moved };
        let carried = three(&space, h, &given);
        assert_eq!(seen.is_some(), carried.is_some(), "case {case}");
        let (Some(seen), Some(carried)) = (seen, carried) else {
            continue;
        };
        made += 1;
        worst = worse(worst, off(&action, &seen));
        action.side = Side::Space;
        worst = worse(worst, off(&action, &carried));
        // Neither a different attitude nor a different member of the family passes.
        assert!(
            off(&action, &displaced(carried, 1e-8)) > 1e-10,
            "case {case}"
        );
        action.moments[1] *= 1.0 + 1e-5;
        let turned = seen[0].inverse() * seen[1];
        if turned.components()[2].abs() > 1e-3 {
            assert!(off(&action, &seen) > 10.0 * ROUNDING, "case {case}");
        }
    }
    println!("{made} of 4000, worst {worst:e}");
    assert!(made > 3000 && worst < ROUNDING, "{made} {worst:e}");
}

#[test]
fn steps_of_tops_stated_here_do_so_too() {
    let mut source = Source::seeded(62);
    let [body, space] = [QUATERNION_TOP, QUATERNION_TOP_SPATIAL].map(TextModel::read);
    let (mut worst, mut apart, mut made) = (0.0_f64, 0.0_f64, 0);
    for _ in 0..4000 {
        let mut action = quaternions::QuaternionTop::random(&mut source);
        let h = action.h * 0.3;
        let b = source.between(-8.0, -2.0);
        action.h = h;
        // Coefficients as the model states them; not all terms are divided by the step size.
        action.weights[1] = b / h;
        let [a0, _, a13, a14] = action.weights;
        let q = attitude(&mut source);
        let s = Matrix3::from_fn(|i, j| action.symmetric.0[i][j]);
        let (u, z) = (Vector3::from(action.lever), Vector3::from(action.vertical));
        let momentum = Vector3::from(source.vector::<3>());
        let common = given! { a0: a0, b: b, a13: a13, a14: a14, z: z, q: q };
        let own = given! { S: s, u: u, body_momentum: momentum };
        // Not every random matrix is an admissible inertia.
        let seen = three(&body, h, &[common.clone(), own].concat());
        let r = q.rotation().matrix();
        let own = given! { S: r * s * r.transpose(), u: r * u, spatial_momentum: r * momentum };
        let carried = three(&space, h, &[common, own].concat());
        let (Some(seen), Some(carried)) = (seen, carried) else {
            continue;
        };
        made += 1;
        worst = worse(worst, worse(off(&action, &seen), off(&action, &carried)));
        let (one, other) = (seen[2].components(), carried[2].components());
        apart = one
            .iter()
            .zip(other)
            .fold(apart, |m, (x, y)| worse(m, (x - y).abs()));
        assert!(off(&action, &displaced(seen, 1e-8)) > 1e-10);
        action.weights[3] += 1e-3;
        assert!(
            off(&action, &seen) > 10.0 * ROUNDING || u.cross(&(r.transpose() * z)).norm() < 1e-3
        );
    }
    println!("{made} of 4000, worst {worst:e}, both sides apart {apart:e}");
    assert!(made > 1000 && worst < ROUNDING, "{made} {worst:e}");
    // Near a bound, two steps amplify rounding by its square root.
    assert!(apart < 1e-9, "{apart:e}");
}

#[test]
fn what_is_of_the_form_is_solved_so_and_nothing_else() {
    let body = |terms: &str| {
        format!(
            "model M {{ param S: Sym<3>; param A: Mat<3>; param c, d: Real; param u, z: Vec<3>;
            group q: SU<2> velocity W; advected Γ: Vec<3> = rot(q)^T*z;
            constraint next(q) = q*W; constraint next(Γ) = rot(W)^T*Γ;
            lagrangian = {terms}; }}"
        )
    };
    let simple = "dot(im(W), S*im(W))/h";
    let yes = [
        "0*c".to_owned(),
        "c*re(W)/h".to_owned(),
        "c*re(W)/h - h*dot(u, Γ)".to_owned(),
        "c*d*re(W)/h - h*d*dot(Γ, S*Γ)^2 - h*log(3 + dot(u, Γ)^2)".to_owned(),
        "d*dot(im(W), im(W))/h".to_owned(),
        "d*re(W)^2/h".to_owned(),
        // The skew part of a matrix does not contribute to its quadratic form.
        "dot(im(W), A*im(W))/h".to_owned(),
    ];
    for term in yes {
        let text = body(&format!("{simple} + {term}"));
        let d = derive_source(&text).unwrap_or_else(|e| panic!("{text}\n{e}"));
        assert!(
            matches!(d.solve.method, Method::UnitQuaternions),
            "{term}: {}",
            d.solve.reason
        );
    }
    let no = [
        // A factor without 1/h, or a velocity in another form.
        "c*re(W)",
        "c*re(W)^3/h",
        "dot(u, im(W))/h",
        "c*re(W)*dot(im(W), S*im(W))/h",
        "sqrt(2 + re(W))/h",
        "h*dot(u, rot(W)*Γ)",
        "tr(A*rot(W))/h",
    ];
    for term in no {
        let text = body(&format!("{simple} + {term}"));
        let d = derive_source(&text).unwrap_or_else(|e| panic!("{text}\n{e}"));
        assert!(
            matches!(d.solve.method, Method::Newton),
            "{term}: {}",
            d.solve.reason
        );
    }
}

fn refusal<M: Model<Scalar = f64>>(model: &M, state: &M::State, h: f64) -> Option<QuaternionError> {
    match Stepper::workspace(model, state, h) {
        Err(StartError::Refused(StepCause::Quaternions(e))) => Some(e),
        Err(other) => panic!("{other}"),
        Ok(_) => None,
    }
}

/// A ball that rotates about an axis, and its largest step size: `sin t ((i - c) cos t + c) = h m / 2`.
fn ball(axis: usize, moment: f64, c: f64, momentum: f64) -> (CayleyKlein, CayleyKleinState, f64) {
    let inertia = Matrix3::from_diagonal_element(moment);
    let model = CayleyKlein::new(CayleyKleinParameters { I: inertia, c }).expect("valid");
    let mut along = Vector3::zeros();
    along[axis] = momentum;
    let initial = CayleyKleinInitial {
        q: UnitQuaternion::identity(),
        body_momentum: BodyMomentum(along),
    };
    let state = model.begin(initial).expect("valid");
    // The maximum: (i - c)(2 x^2 - 1) + c x = 0 with x = cos t.
    let a = moment - c;
    let x = (-c + (c * c + 8.0 * a * a).sqrt()) / (4.0 * a);
    let bound = 2.0 * (1.0 - x * x).sqrt() * (a * x + c) / momentum;
    (model, state, bound)
}

#[test]
fn the_bound_of_a_ball_is_met_and_the_axis_named() {
    for (axis, c) in [(0, 0.0), (1, 0.6), (2, 1.0), (2, -0.5)] {
        let (model, state, bound) = ball(axis, 1.4, c, 2.0);
        let e = refusal(&model, &state, 3.0 * bound).expect("too long");
        let largest = e.largest_step.expect("known");
        assert!((largest / bound - 1.0).abs() < 1e-9, "{e}: {bound}");
        assert!((e.ratio - 3.0).abs() < 1e-8 && e.component == axis, "{e}");
        assert_eq!(e.h, Some(3.0 * bound));
        let said = e.to_string();
        for words in [
            "by a factor 3.000000",
            &format!("component {}", axis + 1),
            "reduce the step size from",
        ] {
            assert!(said.contains(words), "{said}");
        }
        assert!(refusal(&model, &state, largest).is_none(), "{e}");
        assert!(refusal(&model, &state, -largest).is_none(), "{e}");
        assert!(refusal(&model, &state, bound * 1.000_001).is_some(), "{e}");
        let back = refusal(&model, &state, -3.0 * bound).and_then(|e| e.largest_step);
        assert!((back.expect("known") + largest).abs() < 1e-9, "{e}");
        // With twice the momentum this step size fails, so the test can fail.
        let (_, faster, _) = ball(axis, 1.4, c, 4.0);
        assert!(refusal(&model, &faster, 0.999 * largest).is_some());
    }
}

#[test]
fn compositions_and_ensembles_pass_a_refusal_on() {
    let (model, state, bound) = ball(2, 1.4, 1.0, 2.0);
    let start = |h| Composition::start(&model, &state, h, CompositionOrder::Four);
    let h = 40.0 * bound;
    let e = match start(h) {
        Err(StartError::Refused(StepCause::Quaternions(e))) => e,
        other => panic!("{:?}", other.map(|_| ())),
    };
    assert!((e.h.expect("known") / h - 1.0).abs() < 1e-14, "{e}");
    let largest = e.largest_step.expect("known");
    let mut moved = state;
    let mut made = start(largest).expect("the step offered");
    made.step(&model, &mut moved).expect("the step offered");
    let longer = start(largest * (1.0 + 1e-6));
    let mut moved = state;
    assert!(longer.is_err() || longer.is_ok_and(|mut s| s.step(&model, &mut moved).is_err()));
    let bodies = (0..5).map(|i| {
        let (model, state, _) = ball(1, 1.4, 0.3, if i == 3 { 30.0 } else { 1.0 });
        (*model.parameters(), state)
    });
    let error = Ensemble::<CayleyKlein, 4>::resume(bodies, 0.3, ()).expect_err("one too fast");
    assert_eq!((error.body, error.failed), (3, 1));
    let StartError::Refused(StepCause::Quaternions(e)) = error.cause else {
        panic!("{error}");
    };
    assert_eq!((e.component, e.lane), (1, 0));
    assert!(error.to_string().contains("body at index 3: "), "{error}");
}
