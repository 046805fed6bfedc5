//! Failed steps of Newton's method: the suggestion in the error, and the absence of silent failures. Covers gallery models and
//! others on every group, with random data. The suggested step size works, a larger one fails, and every accepted step solves the
//! derived equations.

#![allow(non_snake_case)]

mod drawn;

use clebsch::groups::Part;
use clebsch::integrate::{Composition, CompositionOrder, Ensemble, Model, Reversible, Stepper};
use clebsch::nalgebra::Vector3;
use clebsch::solvers::moser_veselov::largest_step;
use clebsch::{BodyMomentum, NewtonError, Rotation, StartError, StepCause};
use clebsch_models::coupled_bodies::{
    CoupledBodies, CoupledBodiesInitial, CoupledBodiesParameters, CoupledBodiesState,
};
use clebsch_oracle::oracle::points::asked_for;
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::random_states::Draws;
use drawn::{Coupled, Drawn, Fluid, InFourDimensions, Mixed, Quaternion, Rough, Stiff};
use std::cell::Cell;

/// The error of a step of size `h` from this state.
fn refusal<M: Model<Scalar = f64>>(model: &M, state: &M::State, h: f64) -> Option<NewtonError> {
    match model.workspace(state, h) {
        Err(StartError::Refused(StepCause::Newton(e))) => Some(e),
        Err(other) => panic!("{other}"),
        Ok(_) => None,
    }
}

/// A step size of zero or NaN is reported as such, and not as a missing solution.
#[test]
fn a_workspace_is_refused_for_a_step_that_is_none() {
    let (model, state, unit) = Coupled::draw(&mut Draws::new(3));
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

/// A step size larger than the suggestion by this relative amount must fail.
const LONGER: f64 = 4e-6;

/// For `count` draws with a step size far too large: how many errors suggest a step size, and how many of these fail slightly
/// beyond it.
fn offers<D: Drawn>(count: u64) -> [u64; 2] {
    let mut draws = Draws::new(7);
    let mut found = [0; 2];
    for _ in 0..count {
        let (model, state, unit) = D::draw(&mut draws);
        let h = 20.0 * unit;
        let Some(e) = refusal(&model, &state, h) else {
            continue;
        };
        assert_eq!(e.h, Some(h));
        let largest = e.largest_step.expect("searched");
        assert!(0.0 < largest && largest < h, "{e}");
        assert!(model.workspace(&state, largest).is_ok(), "{e}");
        let said = e.to_string();
        let name = e.configuration().expect("named");
        assert!(D::NAMES.contains(&name), "{said}");
        for words in [
            &format!("momentum of `{name}`"),
            "reduce it from",
            "times the largest",
        ] {
            assert!(said.contains(words), "{said}");
        }
        // The same for negative step sizes.
        if let Some(back) = refusal(&model, &state, -h) {
            let largest = back.largest_step.expect("searched");
            assert!(-h < largest && largest < 0.0, "{back}");
            assert!(model.workspace(&state, largest).is_ok(), "{back}");
        }
        found[0] += 1;
        let longer = refusal(&model, &state, largest * (1.0 + LONGER));
        found[1] += u64::from(longer.is_some());
    }
    println!("{}: {found:?} of {count}", D::NAMES.join(" and "));
    found
}

#[test]
fn the_step_offered_is_taken_and_a_longer_one_is_not() {
    for [offered, refused] in [
        offers::<Coupled>(60),
        offers::<Rough>(200),
        offers::<Mixed>(60),
        offers::<InFourDimensions>(12),
    ] {
        assert!(offered > 0);
        assert_eq!(offered, refused);
    }
    // A quartic term has other solutions, a few of them beyond the bound.
    let [offered, refused] = offers::<Stiff>(60);
    assert!(offered > 30 && 20 * refused > 19 * offered);
    // In a fluid, momentum can convert to ever faster translation. Beyond the first unsolvable step size, the iteration from zero
    // velocity can reach such solutions. The search passes over most of them.
    let [offered, refused] = offers::<Fluid>(60);
    assert!(offered > 30 && 2 * refused > offered);
}

/// Two uncoupled bodies that rotate about their own axes. sin(angle) cannot exceed one, so the bound is known.
fn apart(momenta: [Vector3<f64>; 2]) -> (CoupledBodies, CoupledBodiesState) {
    let j = |a, b, c| clebsch::nalgebra::Matrix3::from_diagonal(&Vector3::new(a, b, c));
    let parameters = CoupledBodiesParameters {
        J1: j(0.5, 0.7, 0.9),
        J2: j(1.0, 0.4, 0.6),
        d1: Vector3::x(),
        d2: Vector3::y(),
        eps: 0.0,
    };
    let [one, two] = momenta.map(BodyMomentum);
    let initial = CoupledBodiesInitial {
        Λ1: Rotation::identity(),
        body_momentum_Λ1: one,
        Λ2: Rotation::exp(&Vector3::new(0.3, 0.5, -0.2)),
        body_momentum_Λ2: two,
    };
    let model = CoupledBodies::new(parameters).expect("valid");
    let state = model.begin(initial).expect("valid");
    (model, state)
}

#[test]
fn the_bound_of_a_body_about_an_axis_is_met_and_the_axis_named() {
    // I_zz of the second body is 1.4, and I_yy of the first is 1.4, too.
    for (axis, body, moment) in [(2, 1, 1.4), (1, 0, 1.4), (0, 1, 1.0), (0, 0, 1.6)] {
        let mut momenta = [Vector3::zeros(); 2];
        momenta[body][axis] = 2.0;
        momenta[1 - body][(axis + 1) % 3] = 0.3;
        let (model, state) = apart(momenta);
        let bound = moment / 2.0;
        let e = refusal(&model, &state, 3.0 * bound).expect("too long");
        let largest = e.largest_step.expect("searched");
        // At the bound the solution is a double root, and the solution curve folds. The search does not suggest a step size closer
        // than 1e-6.
        let short = 1.0 - largest / bound;
        assert!(0.0 < short && short < 3e-6, "{e}: {bound}");
        assert_eq!(e.worst.part, Part::Axis(axis as u8), "{e}");
        assert_eq!(e.configuration(), Some(["Λ1", "Λ2"][body]), "{e}");
        assert!(e.to_string().contains("3.00000"), "{e}");
        assert!(refusal(&model, &state, 0.999 * bound).is_none());
        assert!(refusal(&model, &state, 1.001 * bound).is_some());
        // With twice the momentum this step size fails, so the test can fail.
        let (_, faster) = apart(momenta.map(|m| m * 2.0));
        assert!(refusal(&model, &faster, 0.999 * largest).is_some());
    }
}

#[test]
fn values_that_no_step_can_use_are_said_to_be_so() {
    let (model, state) = apart([Vector3::zeros(), Vector3::new(0.0, 1e300, 0.0)]);
    let e = refusal(&model, &state, 0.1).expect("far too fast");
    assert_eq!(e.largest_step, Some(0.0));
    assert!(
        e.to_string()
            .contains("steps from 4e-116 to 0.1 from this state failed too"),
        "{e}"
    );
}

/// A composed step returns the error with its own numbers.
fn composed<D: Drawn>(seed: u64)
where
    D::M: Reversible,
{
    let mut draws = Draws::new(seed);
    let (model, state, unit) = D::draw(&mut draws);
    let h = 40.0 * unit;
    let start = |h| Composition::start(&model, &state, h, CompositionOrder::Four);
    let e = match start(h) {
        Err(StartError::Refused(StepCause::Newton(e))) => e,
        other => panic!("{:?}", other.map(|_| ())),
    };
    assert!((e.h.expect("known") / h - 1.0).abs() < 1e-14, "{e}");
    let largest = e.largest_step.expect("searched");
    assert!(0.0 < largest && largest < h, "{e}");
    let mut moved = state;
    let mut made = start(largest).expect("the step offered");
    made.step(&model, &mut moved).expect("the step offered");
    let mut moved = state;
    let longer = start(largest * (1.0 + LONGER));
    assert!(longer.is_err() || longer.is_ok_and(|mut s| s.step(&model, &mut moved).is_err()));
}

#[test]
fn compositions_offer_a_step_too() {
    composed::<Coupled>(1);
    composed::<Stiff>(2);
    composed::<Fluid>(3);
}

#[test]
fn ensembles_name_the_body_and_its_equation() {
    let slow = Vector3::new(0.1, 0.2, 0.1);
    let bodies = (0..5).map(|i| {
        let fast = if i == 3 { 30.0 } else { 1.0 };
        let (model, state) = apart([slow, Vector3::z() * fast]);
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
    let alone = [1.0, 1.0, 9.0, 4.0].map(|fast| apart([slow, Vector3::z() * fast]));
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
    let own = refusal(&alone[2].0, &alone[2].1, 1.0).and_then(|e| e.largest_step);
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

/// The first three nodes.
fn two_steps<M: Model<Scalar = f64>>(model: &M, start: M::State, h: f64) -> Option<[M::State; 3]> {
    let mut work = model.workspace(&start, h).ok()?;
    let mut past = [start; 3];
    for i in 1..3 {
        past[i] = past[i - 1];
        model.advance(&mut past[i], &mut work).ok()?;
    }
    Some(past)
}

/// Random problems around the bound: no failure is silent.
fn none_is_silent<D: Drawn>(count: u64) {
    let mut draws = Draws::new(11);
    let (mut solved, mut refused, mut silent, mut worst, mut turned) = (0, 0, 0, 0.0_f64, 0);
    for _ in 0..count {
        let (model, start, unit) = D::draw(&mut draws);
        // From small step sizes to slightly beyond the largest solvable one.
        let h = unit * 10.0_f64.powf(draws.uniform(-2.0, D::BEYOND));
        let made = Cell::new(None);
        // Inside a search, a failed step does not start another search, which would take a hundred times as long.
        let _ = largest_step(1.0, |_| {
            made.set(two_steps(&model, start, h));
            Some(0.0)
        });
        let Some(past) = made.get() else {
            refused += 1;
            continue;
        };
        solved += 1;
        let left = D::residual(&model, h, &past, 0.0);
        worst = worse(worst, left);
        silent += u64::from(left.is_nan() || left > ROUNDING);
        turned += u64::from(D::residual(&model, h, &past, 1e-8) > ROUNDING);
    }
    println!(
        "{}: {solved} solved, {refused} refused, {silent} silent; residual at most {worst:.1e}",
        D::NAMES.join(" and ")
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
    none_is_silent::<Coupled>(count);
    none_is_silent::<Quaternion>(count);
    none_is_silent::<Stiff>(count);
    none_is_silent::<Fluid>(count);
    none_is_silent::<Rough>(count);
    none_is_silent::<Mixed>(count);
    none_is_silent::<InFourDimensions>(count / 8);
}
