//! SU(2), SE(2) and SE(3) against the variation of unreduced actions, at random points that solve nothing:
//! the gallery's models, and some sums of random terms on both sides. Actions of the wrong side are refused, and a
//! residual with one term changed is found out.

use super::common::groups::{
    Nodes, derived, every_term, of_every_group, random_lagrangians, worst,
};
use super::common::oracle_bridge::{AGREEMENT, assignment, disagreement};
use clebsch_core::derive_source;
use clebsch_oracle::oracle::action::motions::{self, KirchhoffBody, twists};
use clebsch_oracle::oracle::action::quaternions::{self, CayleyKlein, halves};
use clebsch_oracle::oracle::action::{Side, TermSum, stationarity};
use clebsch_oracle::oracle::points::Source;
use std::array::from_fn;

/// Random points for every system.
const POINTS: usize = 1000;
/// One in so many of the terms of every group, and so many sums of random ones: all of them are those of
/// `tests/tests/many_models/`.
const ONE_IN: usize = 4;
const LAGRANGIANS: usize = 6;

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

#[test]
fn terms_on_every_group() {
    of_every_group!(every_term, ONE_IN);
}

#[test]
fn random_lagrangians_on_every_group_and_side() {
    of_every_group!(random_lagrangians, LAGRANGIANS);
}

/// Terms of every kind, the kinetic one, two of the velocity and the node, one of the node alone.
fn changed_term<const N: usize, S: TermSum<N>>(group: &str) {
    for side in [Side::Body, Side::Space] {
        let terms = [0, 3, 8, 14];
        let d = derived(&S::text(side, &terms, false));
        let mut source = Source::seeded(56);
        let action = S::random(&mut source, side, &terms);
        let nodes: Nodes<N> = from_fn(|_| S::node(&mut source));
        let oracle = stationarity(&action, &nodes, &S::basis());
        let values = assignment(&action.given(&nodes), ("h", action.step()));
        let mutants = d.mutations();
        assert!(mutants.len() > 8, "{group}: {}", mutants.len());
        for mutant in &mutants {
            let engine = mutant.residual(&values).expect("all values are given");
            let found = disagreement(&oracle, &engine);
            let told = mutant.describe();
            assert!(
                found > 1e3 * AGREEMENT,
                "{group}, {side:?}, {told}: {found:e}"
            );
        }
    }
}

#[test]
fn one_changed_term_is_found_out() {
    of_every_group!(changed_term);
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
    let of_space = |n: u32, update: &str, shape: &str, carried: &str| {
        format!(
            "model M {{ param M: Sym<{n}>; group G: SE<{n}> velocity V; advected a: {shape};
            constraint next(G) = {update}; constraint next(a) = {carried};
            lagrangian = dot(pos(V), M*pos(V))/h; }}"
        )
    };
    let motions = |update: &str, shape: &str, carried: &str| of_space(3, update, shape, carried);
    let plane = |update: &str, shape: &str, carried: &str| of_space(2, update, shape, carried);
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
        plane("G*V", "Vec<2>", "rot(V)^T*a"),
        // Turns of the plane commute: both ways round are actions.
        plane("G*V", "Vec<2>", "rot(V)*a"),
        plane("V*G", "Vec<2>", "rot(V)*a"),
        plane("G*V", "Vec<3>", "V^-1*a"),
        plane("G*V", "Vec<3>", "V^T*a"),
        plane("V*G", "Vec<3>", "V*a"),
        plane("G*V", "Mat<3>", "V^-1*a*V"),
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
        plane("G*V", "Vec<3>", "V*a"),
        plane("G*V", "Vec<3>", "(V^-1)^T*a"),
        plane("V*G", "Vec<3>", "V^-1*a"),
        plane("V*G", "Mat<3>", "V^-1*a*V"),
    ];
    for text in &wrong {
        let refusal = match derive_source(text) {
            Ok(_) => panic!("{text} is not refused"),
            Err(errors) => errors.to_string(),
        };
        assert!(
            refusal.contains("is not advected by the group"),
            "{refusal}"
        );
    }
}
