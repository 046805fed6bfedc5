//! Solvers selected by name, for every gallery model with a choice. Each solver must give the same motion, and each error must list
//! the available solvers and the admissible step size.

use clebsch::card::{Card, OpenError, Settings, Trajectory};
use clebsch::solvers::Method;
use clebsch::{StartError, StepCause};
use clebsch_models::gallery;
use clebsch_oracle::physics::measure::worse;

/// Number of nodes to compare: enough for a wrong solution to show, and few enough that the motion does not amplify rounding.
const STEPS: usize = 50;

fn observed(trajectory: &dyn Trajectory, card: &Card) -> Vec<f64> {
    let mut out = vec![0.0; card.observable_count()];
    trajectory.observe(&mut out);
    out
}

fn by(method: Option<Method>, order: Option<u32>, h: f64) -> Settings {
    Settings {
        order,
        solver: method,
        ..Settings::step(h)
    }
}

/// The largest difference of the observables relative to the largest observable, along both trajectories.
fn difference(card: &Card, a: &mut dyn Trajectory, b: &mut dyn Trajectory) -> f64 {
    let mut worst: f64 = 0.0;
    for _ in 0..STEPS {
        a.step().expect("solvable");
        b.step().expect("solvable");
        let (x, y) = (observed(a, card), observed(b, card));
        let size = x.iter().fold(0.0_f64, |m, v| worse(m, v.abs()));
        let apart = x.iter().zip(&y).map(|(v, w)| (v - w).abs());
        worst = worse(worst, apart.fold(0.0, worse) / size);
    }
    worst
}

#[test]
fn every_solver_gives_the_same_motion() {
    let (mut compared, mut refused) = (0, 0);
    for entry in gallery() {
        for case in entry.cases.iter().filter(|c| !c.name.contains("bound")) {
            let card = entry.card_of(case);
            let open = |settings| (card.open)(&case.parameters, &case.initial, settings);
            for name in card.solvers {
                let method: Method = name.parse().expect("a solver");
                let mut own = open(by(None, None, case.h)).expect("a good case");
                let mut other = match open(by(Some(method), None, case.h)) {
                    Ok(other) => other,
                    // For a flat body the Hamiltonian matrix has a zero eigenvalue, which has no sign.
                    Err(OpenError::Start(StartError::Refused(StepCause::MoserVeselov(e))))
                        if e.ratio < 1.0 =>
                    {
                        assert!(e.to_string().ends_with("use kappa"), "{e}");
                        assert!(matches!(method, Method::Sign | Method::Schur), "{e}");
                        println!("{} {} {name}: {e}", card.kebab, case.name);
                        refused += 1;
                        continue;
                    }
                    Err(e) => panic!("{} {} {name}: {e}", card.kebab, case.name),
                };
                let worst = difference(&card, own.as_mut(), other.as_mut());
                // A solution is accurate to a few hundred rounding errors, including those of a root of the Hamiltonian matrix.
                // Fifty steps add them up.
                assert!(
                    worst < 2e-12,
                    "{} {} {name}: {worst:e}",
                    card.kebab,
                    case.name
                );
                compared += 1;
            }
        }
    }
    assert!(
        compared > 100 && refused < compared / 10,
        "{compared}, {refused}"
    );
}

/// Different orders differ by far more than different solvers, so the comparison above can fail.
#[test]
fn preprocessed_orders_take_every_solver() {
    let entry = clebsch_models::find("free-body").expect("in the gallery");
    let (card, case) = (entry.card, &entry.cases[0]);
    let open = |settings| (card.open)(&case.parameters, &case.initial, settings).expect("a case");
    for order in [4, 10] {
        for method in Method::ALL {
            let mut own = open(by(None, Some(order), case.h));
            let mut other = open(by(Some(method), Some(order), case.h));
            let worst = difference(&card, own.as_mut(), other.as_mut());
            assert!(worst < 2e-12, "{order} {method}: {worst:e}");
            let mut plain = open(by(Some(method), None, case.h));
            let mut own = open(by(None, Some(order), case.h));
            let apart = difference(&card, own.as_mut(), plain.as_mut());
            assert!(apart > 1e-7, "{order} {method}: {apart:e}");
        }
    }
}

/// The step size that the error suggests works, and a slightly larger one fails.
#[test]
fn refusals_offer_the_largest_step_whatever_the_solver() {
    for model in [
        "free-body",
        "free-body-spatial",
        "heavy-top",
        "heavy-top-spatial",
    ] {
        let entry = clebsch_models::find(model).expect("in the gallery");
        let (card, case) = (entry.card, &entry.cases[0]);
        let open = |settings| (card.open)(&case.parameters, &case.initial, settings);
        for method in Method::ALL {
            let refused = open(by(Some(method), None, 40.0 * case.h)).err();
            let Some(OpenError::Start(StartError::Refused(StepCause::MoserVeselov(e)))) = refused
            else {
                panic!("{model} {method}: not refused as too long a step");
            };
            assert!(e.ratio > 1.0, "{model} {method}: {e}");
            let largest = e.largest_step.expect("a step that would do");
            // Iterations may fail slightly below the bound, where the solution is a double root.
            let inside = (1.0 - 1e-5) * largest;
            assert!(
                open(by(Some(method), None, inside)).is_ok(),
                "{model} {method}: {e}"
            );
            assert!(
                open(by(Some(method), None, 1.001 * largest)).is_err(),
                "{model} {method}"
            );
        }
    }
}

#[test]
fn an_unknown_solver_is_answered_with_those_there_are() {
    let error = "kapa".parse::<Method>().expect_err("no such solver");
    for name in Method::NAMES {
        assert!(error.to_string().contains(name), "{error}");
    }
    let entry = clebsch_models::find("body-n").expect("in the gallery");
    let case = &entry.cases[0];
    let card = entry.card_of(case);
    let opened = (card.open)(
        &case.parameters,
        &case.initial,
        by(Some(Method::Kappa), None, case.h),
    );
    let error = opened.err().expect("kappa is for three dimensions");
    assert!(
        error.to_string().contains("lie-newton, sign, schur"),
        "{error}"
    );
}

/// With a smaller step size, a composition passes through different states, and modified moments depend on the step size. The
/// suggested step size must work nevertheless.
#[test]
fn higher_orders_offer_the_largest_step_too() {
    for model in [
        "free-body",
        "free-body-spatial",
        "heavy-top",
        "heavy-top-spatial",
    ] {
        let entry = clebsch_models::find(model).expect("in the gallery");
        let case = &entry.cases[0];
        let card = entry.card_of(case);
        let open = |settings| (card.open)(&case.parameters, &case.initial, settings);
        for order in [4, 6, 8] {
            let cause = match open(by(None, Some(order), 40.0 * case.h)) {
                Err(OpenError::Start(StartError::Refused(cause))) => cause,
                Err(e) => panic!("{model} {order}: {e}"),
                Ok(_) => panic!("{model} {order}: taken"),
            };
            let largest = match cause {
                StepCause::MoserVeselov(e) => e.largest_step,
                StepCause::LeftFactor(e) => e.largest_step,
                _ => None,
            };
            let largest = largest.expect("a step that would do");
            assert!(largest > 0.1 * case.h, "{model} {order}: {cause}");
            let mut made = open(by(None, Some(order), largest)).expect("the step offered");
            assert!(made.step().is_ok(), "{model} {order}: {cause}");
            // The suggestion is the largest solvable step size: with a larger one, the start or the step fails.
            let longer = open(by(None, Some(order), 1.001 * largest));
            assert!(
                longer.is_err() || longer.is_ok_and(|mut t| t.step().is_err()),
                "{model} {order}"
            );
        }
    }
}
