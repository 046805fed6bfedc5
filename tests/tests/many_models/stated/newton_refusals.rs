//! Failed steps of Newton's method: the suggestion in the error, and the absence of silent failures. Covers gallery models and
//! others on every group, with random data. The suggested step size works, a larger one fails, and every accepted step solves the
//! derived equations. The typed model of coupled bodies covers negative step sizes, ensembles and lanes.

#![allow(non_snake_case)]

mod drawn;

use super::text_model::{Given, TextModel, cause, given};
use clebsch::card::Settings;
use clebsch::groups::Part;
use clebsch::integrate::{Ensemble, Model};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::solvers::moser_veselov::largest_step;
use clebsch::{BodyMomentum, NewtonError, Rotation, StartError, StepCause};
use clebsch_models::coupled_bodies::{
    CoupledBodies, CoupledBodiesInitial, CoupledBodiesParameters, CoupledBodiesState,
};
use clebsch_oracle::oracle::points::asked_for;
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::random_states::Draws;
use drawn::{Drawn, coupled, fluid, in_four_dimensions, mixed, quaternion, rough, stiff};
use std::cell::RefCell;

/// The error of the first step from these data.
fn refusal(model: &TextModel, settings: Settings, given: &Given) -> Option<NewtonError> {
    let error = model.start_with(settings, given).err()?;
    match cause(&error) {
        StepCause::Newton(e) => Some(e),
        _ => panic!("{error}"),
    }
}

/// The typed model of coupled bodies, at data of its card.
fn typed(given: &Given) -> (CoupledBodies, CoupledBodiesState) {
    let list = |name: &str| {
        let found = given.iter().find(|(own, _)| own == name);
        found.expect("a value").1.as_slice()
    };
    let matrix = |name: &str| Matrix3::from_row_slice(list(name));
    let vector = |name: &str| Vector3::from_row_slice(list(name));
    let rotation = |name: &str| Rotation::from_matrix(&matrix(name)).expect("a rotation");
    let model = CoupledBodies::new(CoupledBodiesParameters {
        J1: matrix("J1"),
        J2: matrix("J2"),
        d1: vector("d1"),
        d2: vector("d2"),
        eps: list("eps")[0],
    });
    let model = model.expect("valid");
    let state = model.begin(CoupledBodiesInitial {
        Λ1: rotation("Λ1"),
        body_momentum_Λ1: BodyMomentum(vector("body_momentum_Λ1")),
        Λ2: rotation("Λ2"),
        body_momentum_Λ2: BodyMomentum(vector("body_momentum_Λ2")),
    });
    (model, state.expect("valid"))
}

/// A step size of zero or NaN is reported as such, and not as a missing solution.
#[test]
fn a_workspace_is_refused_for_a_step_that_is_none() {
    let (given, unit) = (coupled().draw)(&mut Draws::new(3));
    let (model, state) = typed(&given);
    for h in [0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        match model.workspace(&state, h) {
            Err(StartError::Initial(e)) => assert_eq!(e.field, "h", "{e}"),
            other => panic!("h = {h}: {:?}", other.err()),
        }
    }
    for h in [1e-3 * unit, -1e-3 * unit] {
        assert!(model.workspace(&state, h).is_ok());
    }
}

/// A card takes no negative step size, a workspace does: it suggests a negative one that works.
#[test]
fn a_negative_step_offered_is_taken() {
    let (mut draws, coupled) = (Draws::new(7), coupled());
    let mut found = 0;
    for _ in 0..60 {
        let (given, unit) = (coupled.draw)(&mut draws);
        let (model, state) = typed(&given);
        let h = -20.0 * unit;
        match model.workspace(&state, h) {
            Err(StartError::Refused(StepCause::Newton(back))) => {
                let largest = back.largest_step.expect("searched");
                assert!(h < largest && largest < 0.0, "{back}");
                assert!(model.workspace(&state, largest).is_ok(), "{back}");
                found += 1;
            }
            Err(other) => panic!("{other}"),
            Ok(_) => {}
        }
    }
    assert!(found > 30, "{found}");
}

/// A step size larger than the suggestion by this relative amount must fail.
const LONGER: f64 = 4e-6;

/// For `count` draws with a step size far too large: how many errors suggest a step size, and how many of these fail slightly
/// beyond it.
fn offers(drawn: &Drawn, count: u64) -> [u64; 2] {
    let mut draws = Draws::new(7);
    let mut found = [0; 2];
    for _ in 0..count {
        let (given, unit) = (drawn.draw)(&mut draws);
        let h = 20.0 * unit;
        let refused = |h: f64| refusal(&drawn.model, Settings::step(h), &given);
        let Some(e) = refused(h) else {
            continue;
        };
        assert_eq!(e.h, Some(h));
        let largest = e.largest_step.expect("searched");
        assert!(0.0 < largest && largest < h, "{e}");
        assert!(refused(largest).is_none(), "{e}");
        let said = e.to_string();
        let name = e.configuration().expect("named");
        assert!(drawn.names.contains(&name), "{said}");
        for words in [
            &format!("momentum of `{name}`"),
            "reduce it from",
            "times the largest",
        ] {
            assert!(said.contains(words), "{said}");
        }
        found[0] += 1;
        let longer = refused(largest * (1.0 + LONGER));
        found[1] += u64::from(longer.is_some());
    }
    println!("{}: {found:?} of {count}", drawn.names.join(" and "));
    found
}

#[test]
fn the_step_offered_is_taken_and_a_longer_one_is_not() {
    for [offered, refused] in [
        offers(&coupled(), 60),
        offers(&rough(), 200),
        offers(&mixed(), 60),
        offers(&in_four_dimensions(), 12),
    ] {
        assert!(offered > 0);
        assert_eq!(offered, refused);
    }
    // A quartic term has other solutions, a few of them beyond the bound.
    let [offered, refused] = offers(&stiff(), 60);
    assert!(offered > 30 && 20 * refused > 19 * offered);
    // In a fluid, momentum can convert to ever faster translation. Beyond the first unsolvable step size, the iteration from zero
    // velocity can reach such solutions. The search passes over most of them.
    let [offered, refused] = offers(&fluid(), 60);
    assert!(offered > 30 && 2 * refused > offered);
}

/// Two uncoupled bodies that rotate about their own axes. sin(angle) cannot exceed one, so the bound is known.
fn apart(momenta: [Vector3<f64>; 2]) -> Given {
    let j = |a, b, c| Matrix3::from_diagonal(&Vector3::new(a, b, c));
    given! {
        J1: j(0.5, 0.7, 0.9), J2: j(1.0, 0.4, 0.6), d1: Vector3::x(), d2: Vector3::y(), eps: 0.0,
        Λ1: Rotation::identity(), body_momentum_Λ1: momenta[0],
        Λ2: Rotation::exp(&Vector3::new(0.3, 0.5, -0.2)), body_momentum_Λ2: momenta[1],
    }
}

/// The error of coupled bodies from these data.
fn of_coupled(given: &Given, h: f64) -> Option<NewtonError> {
    refusal(
        &TextModel::gallery("coupled-bodies"),
        Settings::step(h),
        given,
    )
}

#[test]
fn the_bound_of_a_body_about_an_axis_is_met_and_the_axis_named() {
    // I_zz of the second body is 1.4, and I_yy of the first is 1.4, too.
    for (axis, body, moment) in [(2, 1, 1.4), (1, 0, 1.4), (0, 1, 1.0), (0, 0, 1.6)] {
        let mut momenta = [Vector3::zeros(); 2];
        momenta[body][axis] = 2.0;
        momenta[1 - body][(axis + 1) % 3] = 0.3;
        let given = apart(momenta);
        let bound = moment / 2.0;
        let e = of_coupled(&given, 3.0 * bound).expect("too long");
        let largest = e.largest_step.expect("searched");
        // At the bound the solution is a double root, and the solution curve folds. The search does not suggest a step size closer
        // than 1e-6.
        let short = 1.0 - largest / bound;
        assert!(0.0 < short && short < 3e-6, "{e}: {bound}");
        assert_eq!(e.worst.part, Part::Axis(axis as u8), "{e}");
        assert_eq!(e.configuration(), Some(["Λ1", "Λ2"][body]), "{e}");
        assert!(e.to_string().contains("3.00000"), "{e}");
        assert!(of_coupled(&given, 0.999 * bound).is_none());
        assert!(of_coupled(&given, 1.001 * bound).is_some());
        // With twice the momentum this step size fails, so the test can fail.
        let faster = apart(momenta.map(|m| m * 2.0));
        assert!(of_coupled(&faster, 0.999 * largest).is_some());
    }
}

#[test]
fn values_that_no_step_can_use_are_said_to_be_so() {
    let given = apart([Vector3::zeros(), Vector3::new(0.0, 1e300, 0.0)]);
    let e = of_coupled(&given, 0.1).expect("far too fast");
    assert_eq!(e.largest_step, Some(0.0));
    assert!(
        e.to_string()
            .contains("steps from 4e-116 to 0.1 from this state failed too"),
        "{e}"
    );
}

/// A composed step returns the error with its own numbers.
fn composed(drawn: &Drawn, seed: u64) {
    let (given, unit) = (drawn.draw)(&mut Draws::new(seed));
    let h = 40.0 * unit;
    let order_four = |h: f64| Settings::step(h).of_order(4);
    let e = refusal(&drawn.model, order_four(h), &given).expect("too long");
    assert!((e.h.expect("known") / h - 1.0).abs() < 1e-14, "{e}");
    let largest = e.largest_step.expect("searched");
    assert!(0.0 < largest && largest < h, "{e}");
    let made = drawn.model.start_with(order_four(largest), &given);
    made.expect("the step offered").steps(1);
    let longer = order_four(largest * (1.0 + LONGER));
    let longer = drawn.model.start_with(longer, &given);
    assert!(longer.is_err() || longer.is_ok_and(|mut motion| motion.step().is_err()));
}

#[test]
fn compositions_offer_a_step_too() {
    composed(&coupled(), 1);
    composed(&stiff(), 2);
    composed(&fluid(), 3);
}

#[test]
fn ensembles_name_the_body_and_its_equation() {
    let slow = Vector3::new(0.1, 0.2, 0.1);
    let bodies = (0..5).map(|i| {
        let fast = if i == 3 { 30.0 } else { 1.0 };
        let (model, state) = typed(&apart([slow, Vector3::z() * fast]));
        (*model.parameters(), state)
    });
    let error = Ensemble::<CoupledBodies, 4>::resume(bodies, 0.3, ()).expect_err("one too fast");
    assert_eq!((error.body, error.failed), (3, 1));
    let StartError::Refused(StepCause::Newton(e)) = error.cause else {
        panic!("{error}");
    };
    assert_eq!((e.worst.part, e.lane), (Part::Axis(2), 0));
    let said = error.to_string();
    assert!(
        said.contains("body at index 3: ") && said.contains("`Λ2`"),
        "{said}"
    );
}

#[test]
fn lanes_are_named() {
    use clebsch::Lanes;
    let slow = Vector3::new(0.1, 0.2, 0.1);
    let given = [1.0, 1.0, 9.0, 4.0].map(|fast| apart([slow, Vector3::z() * fast]));
    let alone = given.each_ref().map(typed);
    let parameters =
        clebsch::scalar::gather::<CoupledBodiesParameters, 4>(|i| *alone[i].0.parameters());
    let state = clebsch::scalar::gather::<CoupledBodiesState, 4>(|i| alone[i].1);
    let model = CoupledBodies::<Lanes<4>>::new(parameters).expect("valid");
    let refused = model
        .workspace(&state, Lanes([1.0; 4]))
        .expect_err("two too fast");
    let StartError::Refused(StepCause::Newton(e)) = refused else {
        panic!("{refused}");
    };
    let own = of_coupled(&given[2], 1.0).and_then(|e| e.largest_step);
    let (told, own) = (e.largest_step.expect("searched"), own.expect("searched"));
    assert_eq!((e.lane, e.worst.part), (2, Part::Axis(2)), "{e}");
    assert!((told / own - 1.0).abs() < 1e-9, "{e}: {own}");
    assert!(e.to_string().starts_with("lane 3: "), "{e}");
}

/// Accepted steps solve the equations to this fraction of the size of their terms. The solver stops at a thousand rounding errors
/// at worst, and attitudes are accurate to a few.
const ROUNDING: f64 = 1e-12;

/// Random problems per model; `NEWTON_PROBLEMS=200000` gives a million in all. Each step is certified, which takes milliseconds.
fn problems() -> u64 {
    asked_for("NEWTON_PROBLEMS", 2000)
}

/// Random problems around the bound: no failure is silent.
fn none_is_silent(drawn: &Drawn, count: u64) {
    let mut draws = Draws::new(11);
    let (mut solved, mut refused, mut silent, mut worst, mut turned) = (0, 0, 0, 0.0_f64, 0);
    for _ in 0..count {
        let (given, unit) = (drawn.draw)(&mut draws);
        // From small step sizes to slightly beyond the largest solvable one.
        let h = unit * 10.0_f64.powf(draws.uniform(-2.0, 0.2));
        let made = RefCell::new(None);
        // Inside a search, a failed step does not start another search, which would take a hundred times as long.
        let _ = largest_step(1.0, |_| {
            made.replace(drawn.two_steps(h, &given));
            Some(0.0)
        });
        let Some(past) = made.into_inner() else {
            refused += 1;
            continue;
        };
        solved += 1;
        let left = drawn.left(h, &given, &past, 0.0);
        worst = worse(worst, left);
        silent += u64::from(left.is_nan() || left > ROUNDING);
        turned += u64::from(drawn.left(h, &given, &past, 1e-8) > ROUNDING);
    }
    println!(
        "{}: {solved} solved, {refused} refused, {silent} silent; residual at most {worst:.1e}",
        drawn.names.join(" and ")
    );
    assert_eq!(silent, 0);
    assert!(
        refused * 50 > count && solved * 2 > count,
        "{refused} of {count}"
    );
    // The check detects an attitude error of 1e-8.
    assert_eq!(turned, solved);
}

#[test]
fn no_failure_is_silent() {
    let count = problems();
    for drawn in [coupled(), quaternion(), stiff(), fluid(), rough(), mixed()] {
        none_is_silent(&drawn, count);
    }
    none_is_silent(&in_four_dimensions(), count / 8);
}
