//! Gallery models on groups other than SO(3) against the variation of unreduced actions, at random points that solve nothing. The
//! engine must reject actions on the wrong side.

use super::common::oracle_bridge::{AGREEMENT, assignment};
use clebsch_core::{Derivation, derive_source};
use clebsch_oracle::oracle::action::motions::{self, KirchhoffBody, twists};
use clebsch_oracle::oracle::action::quaternions::{self, CayleyKlein, halves};
use clebsch_oracle::oracle::action::{DiscreteAction, Side, stationarity};
use clebsch_oracle::oracle::points::{NamedValue, Source};
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::sizes::POINTS;
use std::array::from_fn;

/// Three nodes of a configuration.
type Nodes<const N: usize> = [[Square<f64, N>; 1]; 3];

/// The derivation of an admissible model.
fn derived(text: &str) -> Derivation {
    derive_source(text).unwrap_or_else(|errors| panic!("{text}\nis refused:\n{errors}"))
}

/// The largest disagreement over several points.
fn worst<const N: usize, A: DiscreteAction<N, 1>>(
    d: &Derivation,
    source: &mut Source,
    points: usize,
    basis: &[Square<f64, N>],
    node: fn(&mut Source) -> [Square<f64, N>; 1],
    system: impl Fn(&mut Source) -> (A, f64),
    given: impl Fn(&A, &Nodes<N>) -> Vec<NamedValue>,
) -> f64 {
    let mut worst: f64 = 0.0;
    for _ in 0..points {
        let (action, h) = system(source);
        let nodes: Nodes<N> = from_fn(|_| node(source));
        let oracle = stationarity(&action, &nodes, basis);
        let values = assignment(&given(&action, &nodes), ("h", h));
        let engine = d.residual(&values).expect("all values are given");
        worst = worse(worst, oracle.disagreement(&engine));
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
        // Planar rotations commute, so both sides are valid actions.
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
