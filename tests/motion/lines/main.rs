//! Chains compiled for any number of sites. Steps from random states make the action stationary; the tests write its sums over
//! sites by hand. Tests also cover ends, rings, threads and errors.

// The fields of the models are Greek letters, as in the papers.
#![allow(
    mixed_script_confusables,
    confusable_idents,
    non_snake_case,
    missing_docs
)]

mod action;
mod against_hand;
mod banded_by_hand;
mod constraints;
mod experiments;
mod flaschka;
mod laws;
mod models;
mod quaternion_chains;
mod reflection;
mod rossby;
mod shear;

use action::{stationarity, stationarity_weighed};
use clebsch::line::LineError;
use clebsch::nalgebra::{SMatrix, Vector3};
use clebsch::{BodyMomentum, Snapshot, SnapshotError};
use clebsch_models::fluids;
use clebsch_models::lattices::geometrically_exact_rod::GeometricallyExactRodState;
use clebsch_models::lattices::{STATEMENTS, toda_chain::*};
use models::{Line, Linked, LinkedChainState, Rod, Toda};

/// Tested numbers of sites: smaller than any stencil, and larger.
const SIZES: [usize; 6] = [1, 2, 3, 5, 12, 50];

/// Tolerance: derivatives of the action sum terms of the size of momenta and forces, each with a few rounding errors of 2e-16. A
/// hundred terms give 1e-13 of the largest.
const STATIONARY: f64 = 2e-13;

fn holds(line: &dyn Line, seed: u64) {
    let states = line.three(seed);
    let residual = stationarity(line, &states);
    assert!(
        residual < STATIONARY,
        "{}: {residual:e} at seed {seed}",
        line.name()
    );
}

/// Slow: steps every chain at six sizes.
#[test]
fn steps_from_random_states_make_the_action_stationary() {
    for n in SIZES {
        for seed in 0..3 {
            for line in models::all(n) {
                holds(line.as_ref(), seed);
            }
        }
    }
}

#[test]
fn a_wrong_sign_in_any_term_is_seen() {
    for line in models::all(5) {
        let states = line.three(1);
        for term in 0..line.terms() {
            let residual = stationarity_weighed(line.as_ref(), &line.flipped(term), &states);
            assert!(
                residual > 1e-4,
                "{}: term {term} leaves {residual:e}",
                line.name()
            );
        }
    }
}

/// The engine reads tokens, so it emits the same code for texts with the same tokens.
#[test]
fn the_compiled_statements_are_those_of_the_files() {
    let tokens = |text: &str| {
        let tokens: proc_macro2::TokenStream = text.parse().expect("tokens");
        tokens.to_string()
    };
    for (file, compiled) in STATEMENTS.into_iter().chain(fluids::STATEMENTS) {
        let compiled = compiled.replacen("pub model", "model", 1);
        assert_eq!(tokens(file), tokens(&compiled));
    }
}

#[test]
fn threads_change_no_bit() {
    let n = 10_000;
    let start = |threads| {
        let rod = Rod::free(n).stepper().with_threads(threads);
        let (mut state, mut work) = rod.start(Rod::free(n).initial(3), 1e-3).expect("starts");
        for _ in 0..20 {
            rod.step(&mut state, &mut work).expect("steps");
        }
        state
    };
    let one = start(1);
    for threads in [2, 3, 7] {
        assert!(start(threads) == one, "{threads} threads");
    }
}

#[test]
fn errors_name_the_site() {
    let chain = Toda::ring(50).stepper();
    let q = vec![SMatrix::<f64, 1, 1>::zeros(); 50];
    let mut p = q.clone();
    p[37] = SMatrix::repeat(f64::NAN);
    let initial = TodaChainInitial {
        q: q.clone(),
        momentum_q: p,
    };
    match chain.start(initial, 0.1) {
        Err(LineError::Site { at, .. }) => assert_eq!(at.site, 37),
        other => panic!("{other:?}"),
    }
    let initial = TodaChainInitial {
        q: q.clone(),
        momentum_q: q[1..].to_vec(),
    };
    let told = chain.start(initial, 0.1).expect_err("a list too short");
    assert!(
        told.to_string()
            .contains("49 sites, but there are 50 nodes"),
        "{told}"
    );
    let none = TodaChain::<f64>::new(
        TodaChainParameters {
            m: 1.0,
            a: 1.0,
            b: 1.0,
        },
        TodaChainSites {
            N: 0,
            ends: TodaChainEnds::Open,
        },
    );
    assert!(matches!(
        none,
        Err(LineError::Count {
            found: 0,
            least: 1,
            ..
        })
    ));
}

#[test]
fn a_step_that_is_too_long_names_the_site_and_a_shorter_one() {
    let rod = Rod::free(8);
    let mut initial = rod.initial(0);
    initial.body_momentum_Λ[5] = BodyMomentum(Vector3::new(0.0, 0.0, 1e3));
    let stepper = rod.stepper();
    let told = stepper.start(initial.clone(), 0.1).expect_err("too long");
    let LineError::Step { at, works, .. } = told else {
        panic!("{told}");
    };
    assert_eq!((at.quantity, at.site), ("Λ", 5));
    let works = works.expect("a shorter step");
    assert!(stepper.start(initial, works).is_ok());
}

#[test]
fn a_workspace_of_another_model_is_made_anew() {
    let (soft, hard) = (Toda::ring(5).stepper(), Toda::hard(5));
    let initial = Toda::ring(5).initial(1);
    let (state, _) = hard.start(initial.clone(), 0.05).expect("starts");
    let (_, mut others) = soft.start(initial, 0.05).expect("starts");
    let (mut one, mut two) = (state.clone(), state);
    hard.step(&mut one, &mut others).expect("steps");
    let mut own = hard.workspace(&two, 0.05).expect("a workspace");
    hard.step(&mut two, &mut own).expect("steps");
    assert!(one == two);
    // The stepper rejects a state with another number of sites.
    let longer = Toda::ring(8).stepper();
    assert!(matches!(
        longer.step(&mut one, &mut own),
        Err(LineError::Length { .. })
    ));
}

/// A snapshot restores the state bit for bit, and the run continues with a new workspace to rounding. A state with another number
/// of sites rejects the snapshot and stays unchanged.
#[test]
fn a_state_is_kept_and_goes_on() {
    macro_rules! kept {
        ($stepper:expr, $initial:expr, $other:expr, $other_initial:expr, $apart:expr) => {{
            let (stepper, initial) = ($stepper, $initial);
            let (mut state, mut work) = stepper.start(initial.clone(), 0.03).expect("starts");
            for _ in 0..3 {
                stepper.step(&mut state, &mut work).expect("steps");
            }
            let bytes = Snapshot::of(&state).expect("is kept").to_bytes();
            let kept = Snapshot::from_bytes(&bytes).expect("is read");
            let taken = state.clone();
            for _ in 0..5 {
                stepper.step(&mut state, &mut work).expect("steps");
            }
            let (mut again, _) = stepper.start(initial, 0.03).expect("starts");
            kept.put_into(&mut again).expect("fits");
            assert!(again == taken);
            let mut work = stepper.workspace(&again, 0.03).expect("a workspace");
            for _ in 0..5 {
                stepper.step(&mut again, &mut work).expect("steps");
            }
            // A new workspace adds the rounding error of its own solution once.
            let apart: f64 = $apart(&again, &state);
            assert!(again.node() == state.node() && apart < 1e-13, "{apart:e}");
            let (mut other, _) = $other.start($other_initial, 0.03).expect("starts");
            let before = other.clone();
            assert!(matches!(
                kept.put_into(&mut other),
                Err(SnapshotError::Unlike { .. })
            ));
            assert!(other == before);
        }};
    }
    let (rod, longer) = (Rod::free(8), Rod::free(9));
    kept!(
        rod.stepper(),
        rod.initial(2),
        longer.stepper(),
        longer.initial(2),
        |a: &GeometricallyExactRodState, b: &GeometricallyExactRodState| {
            let both = a.φ().iter().zip(b.φ());
            clebsch::scalar::largest(both.map(|(x, y)| (x - y).norm()))
        }
    );
    let (chain, longer) = (Linked { n: 6, ends: 1 }, Linked { n: 7, ends: 1 });
    kept!(
        chain.stepper(),
        chain.initial(3),
        longer.stepper(),
        longer.initial(3),
        |a: &LinkedChainState, b: &LinkedChainState| {
            let both = a.q().iter().zip(b.q());
            clebsch::scalar::largest(both.map(|(x, y)| (x - y).norm()))
        }
    );
}

#[test]
fn terms_that_the_offset_of_a_ring_changes_are_refused_where_they_look_back() {
    let text =
        "model Off { label i in 0..N; periodic; param m, k: Real; field q: Real at nodes offset L;
        lagrangian = m*(next(q)-q)^2/(2*h) - h*k*cos(q + prev(q,i)); }";
    let model = clebsch_core::pipeline::parse_source(text).expect("a model");
    let told = clebsch_core::pipeline::emitted_line(&model, "").expect_err("refused");
    assert!(
        format!("{told:?}").contains("grow by their offsets"),
        "{told:?}"
    );
}
