//! Models that are in no gallery: groups, fields and functions that those of the gallery have not, built here
//! and read from their texts.

#![allow(missing_docs)]

mod side_by_side;

use clebsch::card::{Card, Settings};
use clebsch_models::Case;
use side_by_side::compare;

clebsch::model! {
    /// Rigid motion of the plane on a slope, by Newton's method.
    pub model Sledge {
        param J: Sym<2>;
        param m: Real;
        param a, w: Vec<2>;
        group G: SE<2> velocity V;
        constraint next(G) = G*V;
        let y = pos(next(G)) - pos(G);
        lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h) - h*dot(w, pos(G) + rot(G)*a);
    }
}

clebsch::model! {
    /// A point before a wall, which it must not reach.
    pub model Wall {
        param m: Real;
        param g: Real;
        field x: Real;
        lagrangian = m*(next(x) - x)^2/(2*h) + h*(log(x) - g*x);
    }
}

clebsch::model! {
    /// A kinetic energy that is not quadratic, convex.
    pub model Quartic {
        param m: Real;
        param b: Real;
        param k: Real;
        field X: Vec<2>;
        let d = next(X) - X;
        lagrangian = m*dot(d, d)/(2*h) + (b/h^3)*dot(d, d)^2 - (h/2)*k*dot(X, X);
    }
}

clebsch::model! {
    /// A body that hangs on a point that moves: two different groups, solved together.
    pub model Hanging {
        param J: Sym<3>;
        param m: Real;
        param M: Real;
        param a: Vec<3>;
        param g: Vec<3>;
        param k: Real;
        group R: SO<3> velocity W;
        field x: Vec<3>;
        constraint next(R) = R*W;
        let d = next(x) - x;
        let y = d + next(R)*a - R*a;
        lagrangian = -tr(J*W)/h + M*dot(d, d)/(2*h) + m*dot(y, y)/(2*h)
            - (h/2)*k*dot(x, x) + h*m*dot(g, x + R*a);
    }
}

clebsch::model! {
    /// Fractions that no binary number is, assumptions of every kind, and a field of nine components.
    pub model Nine {
        param k, c, e: Real;
        assume k < 9;
        assume c <= 1;
        assume c >= -1;
        assume e == 2;
        field X: Vec<9>;
        field y: Real;
        let d = next(X) - X;
        lagrangian = dot(d, d)/(2*h) + (next(y) - y)^2/(3*h)
            - h*(k*dot(X, X)/3 + 0.1*y^2 + c*y^3/7 + y^4/e + log(3 + y^2));
    }
}

fn case(h: f64, parameters: &[&[f64]], initial: &[&[f64]]) -> Case {
    let lists = |all: &[&[f64]]| all.iter().map(|list| list.to_vec()).collect();
    Case {
        name: "here".to_owned(),
        doc: String::new(),
        h,
        steps: 400,
        parameters: lists(parameters),
        initial: lists(initial),
        bounds: Vec::new(),
    }
}

/// Plain and composed steps, longer ones until they are refused, and values that are none.
fn both(built: &Card, case: &Case) {
    let read = clebsch_interpret::card(built.source).expect("is read");
    let made = compare(built, &read, case, Settings::step(case.h), case.steps);
    assert_eq!(made, case.steps, "{}", built.name);
    for order in [1, 2, 4, 6] {
        let settings = Settings::step(case.h).of_order(order);
        compare(built, &read, case, settings, 40);
    }
    for times in [10.0, 1e2, 1e4] {
        compare(built, &read, case, Settings::step(times * case.h), 60);
    }
    for i in 0..case.initial.len() {
        let mut other = case.clone();
        other.initial[i][0] = f64::NAN;
        compare(built, &read, &other, Settings::step(case.h), 2);
    }
}

const ONE: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

#[test]
fn fractions_assumptions_and_long_fields() {
    let place = [0.3, -0.2, 0.1, 0.7, 0.5, -0.4, 0.9, 0.8, -0.6];
    let momentum = [0.1, 0.2, -0.3, 0.4, -0.5, 0.6, -0.7, 0.8, 0.9];
    let initial: [&[f64]; 4] = [&place, &momentum, &[0.4], &[-0.2]];
    both(
        &Nine::CARD,
        &case(0.05, &[&[1.3], &[0.3], &[2.0]], &initial),
    );
    // Each assumption refuses alike.
    let read = clebsch_interpret::card(Nine::CARD.source).expect("is read");
    for (k, c, e) in [
        (9.0, 0.3, 2.0),
        (1.0, 1.5, 2.0),
        (1.0, -1.5, 2.0),
        (1.0, 0.3, 2.1),
    ] {
        let wrong = case(0.05, &[&[k], &[c], &[e]], &initial);
        assert_eq!(
            compare(&Nine::CARD, &read, &wrong, Settings::step(0.05), 2),
            0
        );
    }
}

#[test]
fn motions_of_the_plane() {
    let parameters: [&[f64]; 4] = [&[0.4, 0.1, 0.1, 0.7], &[1.3], &[0.2, -0.1], &[0.3, 1.1]];
    both(
        &Sledge::CARD,
        &case(0.05, &parameters, &[&ONE, &[0.4, 0.2, -0.3]]),
    );
}

#[test]
fn domains_of_functions() {
    let parameters: [&[f64]; 2] = [&[1.0], &[0.5]];
    both(&Wall::CARD, &case(0.02, &parameters, &[&[1.0], &[0.4]]));
    // Into the wall.
    let read = clebsch_interpret::card(Wall::CARD.source).expect("is read");
    for momentum in [-3.0, -30.0, -300.0] {
        let fast = case(0.1, &parameters, &[&[1.0], &[momentum]]);
        compare(&Wall::CARD, &read, &fast, Settings::step(0.1), 100);
    }
}

#[test]
fn energies_that_are_not_quadratic() {
    let parameters: [&[f64]; 3] = [&[1.0], &[0.3], &[2.0]];
    both(
        &Quartic::CARD,
        &case(0.05, &parameters, &[&[1.0, 0.2], &[0.1, 0.9]]),
    );
}

#[test]
fn different_groups_together() {
    let inertia = [0.5, 0.1, 0.0, 0.1, 0.7, 0.0, 0.0, 0.0, 0.9];
    let parameters: [&[f64]; 6] = [
        &inertia,
        &[1.0],
        &[2.0],
        &[0.3, 0.0, 0.4],
        &[0.0, 0.0, -1.0],
        &[3.0],
    ];
    let initial: [&[f64]; 4] = [&ONE, &[0.1, 0.5, 0.2], &[0.1, 0.0, 0.2], &[0.3, 0.1, 0.0]];
    both(&Hanging::CARD, &case(0.05, &parameters, &initial));
}
