//! SU(2) and SE(3) against the variation of unreduced actions, at random points that solve nothing:
//! the gallery's models, and sums of random terms on both sides. Actions of the wrong side are
//! refused, and a residual with one term changed is found out.

use super::oracle_bridge::{AGREEMENT, assignment, disagreement};
use clebsch_core::{Derivation, derive_source};
use clebsch_oracle::oracle::action::motions::{self, KirchhoffBody, MotionSum, twists};
use clebsch_oracle::oracle::action::quaternions::{self, CayleyKlein, QuaternionSum, halves};
use clebsch_oracle::oracle::action::{DiscreteAction, Side, stationarity};
use clebsch_oracle::oracle::points::{Given, Source};
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

/// Random points for every system.
const POINTS: usize = 1000;
/// Random Lagrangians of each group and side, and points for each.
const LAGRANGIANS: usize = 60;
const POINTS_EACH: usize = 20;

type Nodes = [[Square<f64, 4>; 1]; 3];

fn derived(text: &str) -> Derivation {
    derive_source(text).unwrap_or_else(|errors| panic!("{text}\nis refused:\n{errors}"))
}

/// The worst disagreement over some points.
fn worst<A: DiscreteAction<4, 1>>(
    d: &Derivation,
    source: &mut Source,
    points: usize,
    basis: &[Square<f64, 4>],
    node: fn(&mut Source) -> [Square<f64, 4>; 1],
    system: impl Fn(&mut Source) -> (A, f64),
    given: impl Fn(&A, &Nodes) -> Vec<Given>,
) -> f64 {
    let mut worst: f64 = 0.0;
    for _ in 0..points {
        let (action, h) = system(source);
        let nodes: Nodes = from_fn(|_| node(source));
        let oracle = stationarity(&action, &nodes, basis);
        let values = assignment(&given(&action, &nodes), ("h", h));
        let engine = d.residual(&values).expect("all values are given");
        worst = worse(worst, disagreement(&oracle, &engine));
    }
    worst
}

#[test]
fn cayley_klein_on_both_sides() {
    for (side, name) in [
        (Side::Body, "cayley-klein"),
        (Side::Space, "cayley-klein-spatial"),
    ] {
        let model = clebsch_models::find(name).expect("in the gallery");
        let found = worst(
            &derived(model.card.source),
            &mut Source::seeded(51),
            POINTS,
            &halves(),
            quaternions::node,
            |s| {
                let a = CayleyKlein::random(s, side);
                let h = a.h;
                (a, h)
            },
            CayleyKlein::given,
        );
        println!("{name}: {found:e}");
        assert!(found < AGREEMENT, "{name}: {found:e}");
    }
}

#[test]
fn kirchhoff_body() {
    let model = clebsch_models::find("kirchhoff-body").expect("in the gallery");
    let found = worst(
        &derived(model.card.source),
        &mut Source::seeded(52),
        POINTS,
        &twists(),
        motions::node,
        |s| {
            let a = KirchhoffBody::random(s);
            let h = a.h;
            (a, h)
        },
        KirchhoffBody::given,
    );
    println!("{found:e}");
    assert!(found < AGREEMENT, "{found:e}");
}

fn quaternion_sum(terms: &[usize], side: Side, defined: bool, seed: u64, points: usize) -> f64 {
    let text = QuaternionSum::text(side, terms, defined);
    worst(
        &derived(&text),
        &mut Source::seeded(seed),
        points,
        &halves(),
        quaternions::node,
        |s| {
            let a = QuaternionSum::random(s, side, terms);
            let h = a.h;
            (a, h)
        },
        QuaternionSum::given,
    )
}

fn motion_sum(terms: &[usize], side: Side, defined: bool, seed: u64, points: usize) -> f64 {
    let text = MotionSum::text(side, terms, defined);
    worst(
        &derived(&text),
        &mut Source::seeded(seed),
        points,
        &twists(),
        motions::node,
        |s| {
            let a = MotionSum::random(s, side, terms);
            let h = a.h;
            (a, h)
        },
        MotionSum::given,
    )
}

#[test]
fn every_term_on_quaternions() {
    for side in [Side::Body, Side::Space] {
        for term in 1..quaternions::TERMS.len() {
            for defined in [true, false] {
                let found = quaternion_sum(&[0, term], side, defined, 53, 60);
                let text = quaternions::TERMS[term];
                assert!(found < AGREEMENT, "{side:?} {text}: {found:e}");
            }
        }
    }
}

#[test]
fn every_term_on_rigid_motions() {
    for side in [Side::Body, Side::Space] {
        for term in 1..motions::TERMS.len() {
            for defined in [true, false] {
                let found = motion_sum(&[0, term], side, defined, 54, 60);
                let text = motions::TERMS[term];
                assert!(found < AGREEMENT, "{side:?} {text}: {found:e}");
            }
        }
    }
}

#[test]
fn random_lagrangians_on_both_groups_and_sides() {
    let mut source = Source::seeded(55);
    let mut worst: f64 = 0.0;
    for n in 0..LAGRANGIANS {
        let side = if n % 2 == 0 { Side::Body } else { Side::Space };
        let terms = QuaternionSum::choice(&mut source);
        let found = quaternion_sum(&terms, side, n % 3 == 0, n as u64, POINTS_EACH);
        assert!(found < AGREEMENT, "SU(2), {terms:?}, {side:?}: {found:e}");
        worst = worse(worst, found);
        let terms = MotionSum::choice(&mut source);
        let found = motion_sum(&terms, side, n % 3 == 0, n as u64, POINTS_EACH);
        assert!(found < AGREEMENT, "SE(3), {terms:?}, {side:?}: {found:e}");
        worst = worse(worst, found);
    }
    println!("worst {worst:e}");
}

#[test]
fn one_changed_term_is_found_out() {
    let terms = [0, 3, 8, 14];
    let d = derived(&QuaternionSum::text(Side::Body, &terms, false));
    let mut source = Source::seeded(56);
    let action = QuaternionSum::random(&mut source, Side::Body, &terms);
    let nodes: Nodes = from_fn(|_| quaternions::node(&mut source));
    let oracle = stationarity(&action, &nodes, &halves());
    let values = assignment(&action.given(&nodes), ("h", action.h));
    let mutants = d.mutations();
    assert!(mutants.len() > 8);
    for mutant in &mutants {
        let engine = mutant.residual(&values).expect("all values are given");
        let found = disagreement(&oracle, &engine);
        assert!(found > 1e3 * AGREEMENT, "{}: {found:e}", mutant.describe());
    }
}

#[test]
fn actions_of_the_wrong_side_are_refused() {
    let quaternions = |update: &str, carried: &str| {
        format!(
            "model M {{ param I: Diag<3>; group q: SU<2> velocity W; advected Γ: Vec<3>;
            constraint next(q) = {update}; constraint next(Γ) = {carried};
            lagrangian = dot(im(W), I*im(W))/h; }}"
        )
    };
    let motions = |update: &str, shape: &str, carried: &str| {
        format!(
            "model M {{ param M: Sym<3>; group G: SE<3> velocity V; advected a: {shape};
            constraint next(G) = {update}; constraint next(a) = {carried};
            lagrangian = dot(pos(V), M*pos(V))/h; }}"
        )
    };
    let right = [
        quaternions("q*W", "rot(W)^T*Γ"),
        quaternions("W*q", "rot(W)*Γ"),
        quaternions("q*W", "im(W^T*quat(Γ)*W)"),
        motions("G*V", "Vec<3>", "rot(V)^T*a"),
        motions("V*G", "Vec<3>", "rot(V)*a"),
        motions("G*V", "Vec<4>", "V^-1*a"),
        motions("G*V", "Vec<4>", "V^T*a"),
        motions("V*G", "Vec<4>", "V*a"),
        motions("G*V", "Mat<4>", "V^-1*a*V"),
    ];
    for text in &right {
        assert!(derive_source(text).is_ok(), "{text}");
    }
    let wrong = [
        quaternions("q*W", "rot(W)*Γ"),
        quaternions("W*q", "rot(W)^T*Γ"),
        motions("G*V", "Vec<3>", "rot(V)*a"),
        motions("G*V", "Vec<4>", "V*a"),
        motions("G*V", "Vec<4>", "(V^-1)^T*a"),
        motions("V*G", "Vec<4>", "V^-1*a"),
        motions("V*G", "Mat<4>", "V^-1*a*V"),
    ];
    for text in &wrong {
        let refusal = derive_source(text).expect_err("refused").to_string();
        assert!(
            refusal.contains("is not advected by the group"),
            "{refusal}"
        );
    }
}
