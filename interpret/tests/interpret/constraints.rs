//! Models with constraints and functions by name: compiled and interpreted steps agree bit for bit.

use crate::side_by_side::compare;
use clebsch::card::{Card, Settings};
use clebsch_models::Case;

clebsch::model! {
    /// Two masses on rods, one below the other: scalar constraints, fields of one shape.
    pub model Rods {
        param m, M, L, l, g: Real;
        field x, y: Vec<2>;
        hold a: dot(x, x) = L^2;
        hold b: dot(y - x, y - x) = l^2;
        let u = next(x) - x;
        let v = next(y) - y;
        lagrangian = (m*dot(u, u) + M*dot(v, v))/(2*h) - h*g*(m*x[2] + M*y[2]);
    }
}

clebsch::model! {
    /// A fluid ellipsoid: a constrained determinant, and an integral by name.
    pub model Fluid {
        param I0: Sym<3>;
        param M: Real;
        given RF(Real, Real, Real): Real = clebsch::functions::carlson_rf_of_invariants;
        field Q: Mat<3>;
        hold λ: det(Q) = 1;
        let V = next(Q) - Q;
        let B = Q*Q^T;
        lagrangian = tr(V*I0*V^T)/(2*h) + h*(3/5)*M^2*RF(I1(B), I2(B), det(B));
    }
}

clebsch::model! {
    /// The ellipsoid with the matrix as the argument.
    pub model Drop {
        param I0: Sym<3>;
        param M: Real;
        given RF(Sym<3>): Real = clebsch::functions::carlson_rf;
        field Q: Mat<3>;
        hold λ: det(Q) = 1;
        lagrangian = tr((next(Q) - Q)*I0*(next(Q) - Q)^T)/(2*h) + h*(3/5)*M^2*RF(Q*Q^T);
    }
}

clebsch::model! {
    /// A joint: a vector constraint on a field and a rotation, and an unconstrained field.
    pub model Hung {
        param J: Sym<3>;
        param m, k: Real;
        param a, g: Vec<3>;
        field X: Vec<3>;
        group Λ: SO<3> velocity Ω;
        field z: Real;
        constraint next(Λ) = Λ*Ω;
        hold n: X + Λ*a = 0;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) - tr(J*Ω)/h + h*m*dot(g, X)
            + (next(z) - z)^2/(2*h) - (h/2)*k*z^2;
    }
}

clebsch::model! {
    /// Linear maps stated in space, with constrained shape.
    pub model Shape {
        param C0, I0: Sym<3>;
        param k: Real;
        group Q: GL<3> velocity g;
        advected I: Sym<3> = Q*I0*Q^T;
        constraint next(Q) = g*Q;
        constraint next(I) = g*I*g^T;
        hold λ: tr(I) = 2;
        lagrangian = tr(C0*(g - Id)*I*(g - Id)^T)/(2*h) - (h*k/2)*tr(I*I);
    }
}

clebsch::model! {
    /// A matrix that is constrained to be a rotation.
    pub model Matrices {
        param J: Sym<3>;
        field Q: Mat<3>;
        hold l: Q^T*Q = Id;
        lagrangian = tr((next(Q) - Q)*J*(next(Q) - Q)^T)/(2*h);
    }
}

clebsch::model! {
    /// The equivalent body.
    pub model Turning {
        param J: Sym<3>;
        group Q: SO<3> velocity W;
        constraint next(Q) = Q*W;
        lagrangian = -tr(J*W)/h;
    }
}

fn case(h: f64, parameters: &[&[f64]], initial: &[&[f64]]) -> Case {
    let lists = |all: &[&[f64]]| all.iter().map(|list| list.to_vec()).collect();
    Case {
        name: "here".to_owned(),
        doc: String::new(),
        h,
        steps: 100,
        parameters: lists(parameters),
        initial: lists(initial),
        bounds: Vec::new(),
    }
}

const ONE: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// Plain steps, composed steps, longer steps until they fail, and data that violate the constraints.
fn both(built: &Card, case: &Case) {
    let read = clebsch_interpret::card(built.source).expect("is read");
    let made = compare(built, &read, case, Settings::step(case.h), case.steps);
    assert_eq!(made, case.steps, "{}", built.name);
    let settings = Settings::step(case.h).of_order(4);
    compare(built, &read, case, settings, 20);
    for times in [10.0, 100.0] {
        compare(built, &read, case, Settings::step(times * case.h), 20);
    }
    for i in 0..case.initial.len() {
        for off in [f64::NAN, 0.1] {
            let mut other = case.clone();
            other.initial[i][0] += off;
            compare(built, &read, &other, Settings::step(case.h), 2);
        }
    }
}

#[test]
fn numbers_held() {
    let parameters: [&[f64]; 5] = [&[1.0], &[0.7], &[1.0], &[0.5], &[9.81]];
    let initial: [&[f64]; 4] = [&[0.6, -0.8], &[0.0, 0.0], &[0.6, -0.3], &[0.2, 0.0]];
    both(&Rods::CARD, &case(0.01, &parameters, &initial));
}

#[test]
fn determinants_held() {
    let moments = [0.2, 0.0, 0.0, 0.0, 0.2, 0.0, 0.0, 0.0, 0.2];
    let parameters: [&[f64]; 2] = [&moments, &[1.0]];
    let momentum = [0.05, 0.04, 0.0, 0.0, -0.02, 0.01, 0.0, 0.0, -0.03];
    both(&Fluid::CARD, &case(0.02, &parameters, &[&ONE, &momentum]));
    both(&Drop::CARD, &case(0.02, &parameters, &[&ONE, &momentum]));
}

#[test]
fn vectors_held() {
    let inertia = [0.5, 0.1, 0.0, 0.1, 0.7, 0.0, 0.0, 0.0, 0.9];
    let parameters: [&[f64]; 5] = [
        &inertia,
        &[1.0],
        &[2.0],
        &[0.3, 0.0, 0.4],
        &[0.0, 0.0, -1.0],
    ];
    let initial: [&[f64]; 6] = [
        &[-0.3, 0.0, -0.4],
        &[0.0, 0.0, 0.0],
        &ONE,
        &[0.0, 0.0, 0.0],
        &[0.2],
        &[0.1],
    ];
    both(&Hung::CARD, &case(0.02, &parameters, &initial));
}

#[test]
fn shapes_held_in_space() {
    let moments = [0.5, 0.0, 0.0, 0.0, 0.7, 0.0, 0.0, 0.0, 0.8];
    let parameters: [&[f64]; 3] = [&ONE, &moments, &[0.4]];
    // A turn: C0 g I0 with g skew.
    let momentum = [0.0, -0.14, 0.08, 0.1, 0.0, 0.08, -0.05, -0.07, 0.0];
    both(&Shape::CARD, &case(0.02, &parameters, &[&ONE, &momentum]));
}

/// Six multipliers of a matrix, and the step of Moser and Veselov, to rounding.
#[test]
fn matrices_held_to_be_rotations_turn_as_bodies_do() {
    let moments = [1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0];
    // The momenta hat(w) J and (tr(J) - J) w of the angular velocity w.
    let w = [0.3, -0.2, 0.1];
    let momentum = [
        0.0,
        -2.0 * w[2],
        3.0 * w[1],
        w[2],
        0.0,
        -3.0 * w[0],
        -w[1],
        2.0 * w[0],
        0.0,
    ];
    let held = case(0.02, &[&moments], &[&ONE, &momentum]);
    both(&Matrices::CARD, &held);
    let body = case(
        0.02,
        &[&moments],
        &[&ONE, &[5.0 * w[0], 4.0 * w[1], 3.0 * w[2]]],
    );
    let start = |card: &Card, case: &Case| {
        (card.open)(&case.parameters, &case.initial, Settings::step(case.h)).expect("starts")
    };
    let mut matrix = start(&Matrices::CARD, &held);
    let mut turning = start(&Turning::CARD, &body);
    for _ in 0..100 {
        matrix.step().expect("steps");
        turning.step().expect("steps");
    }
    let observed = |card: &Card, of: &dyn clebsch::card::Trajectory| {
        let mut all = vec![0.0; card.observable_count()];
        of.observe(&mut all);
        all
    };
    let matrix = observed(&Matrices::CARD, &*matrix);
    let turning = observed(&Turning::CARD, &*turning);
    for (x, y) in matrix.iter().zip(&turning).take(9) {
        // A hundred steps with a few roundings each.
        assert!((x - y).abs() < 1e-13, "{x} {y}");
    }
    assert!(turning[1].abs() > 0.1);
}

/// The constraint and the force depend on differences of positions. A distance from the origin adds only the rounding
/// of the positions.
#[test]
fn sizes_of_differences_do_not_grow_with_the_places() {
    let sizes = |text: &str, place: f64, length: f64| {
        let card = clebsch_interpret::card(text).expect("is read");
        let initial = [
            vec![place, place, place],
            vec![0.0, 0.3, 0.0],
            vec![place + length, place, place],
            vec![0.0, -0.3, 0.0],
        ];
        let parameters: Vec<Vec<f64>> = card.parameters.iter().map(|_| vec![0.5]).collect();
        let opened = (card.open)(&parameters, &initial, clebsch::card::Settings::step(0.01));
        opened.map(|t| {
            let mut scales = vec![0.0; card.invariant_count()];
            t.scales(&mut scales);
            let names = card.invariants.iter().flat_map(|i| vec![i.name; i.rows]);
            names.zip(scales).collect::<Vec<_>>()
        })
    };
    let of = |all: &[(&str, f64)], name: &str| {
        let found = all.iter().find(|(own, _)| *own == name);
        found.unwrap_or_else(|| panic!("{name} in {all:?}")).1
    };
    let link = "model Link { param a: Real; field x, y: Vec<3>; hold l: dot(y - x, y - x) = a^2;
        lagrangian = (dot(next(x) - x, next(x) - x) + dot(next(y) - y, next(y) - y))/(2*h); }";
    let near = of(&sizes(link, 0.0, 0.5).expect("opens"), "constraint_l");
    let far = of(&sizes(link, 1e6, 0.5).expect("opens"), "constraint_l");
    // The rounding of two positions of three components, times twice the length, counted in either way.
    assert!(near < 5.0 && far < 2e7, "{near} {far}");
    assert!(sizes(link, 1e6, 0.51).is_err(), "a link that is too long");
    let spring = "model Spring { param k: Real; field x, y: Vec<3>;
        lagrangian = (dot(next(x) - x, next(x) - x) + dot(next(y) - y, next(y) - y))/(2*h) - h*k*dot(x - y, x - y)^2; }";
    let near = of(&sizes(spring, 0.0, 0.5).expect("opens"), "energy");
    let far = of(&sizes(spring, 1e3, 0.5).expect("opens"), "energy");
    // Impulses of 1e-3, to which positions of 1e3 add a rounding error of the same size.
    assert!(far < 3e2 * near, "{near} {far}");
}

/// A cart and its bob far from the origin. The length is the length of a difference, of components or along an axis.
#[test]
fn the_length_between_a_number_and_a_vector_is_tested_far_away() {
    let cart = |constraint: &str| {
        format!(
            "model Cart {{ param M, m, g, L: Real; field x: Real; field y: Vec<3>; hold n: {constraint} = L^2;
             lagrangian = M*(next(x) - x)^2/(2*h) + m*dot(next(y) - y, next(y) - y)/(2*h) - h*m*g*y[3]; }}"
        )
    };
    let parameters = vec![vec![1.0]; 4];
    for constraint in ["(y[1] - x)^2 + y[2]^2 + y[3]^2", "dot(y - x*E1, y - x*E1)"] {
        let card = clebsch_interpret::card(&cart(constraint)).expect("is read");
        let opened = |place: f64, length: f64| {
            let initial = [
                vec![place],
                vec![0.1],
                vec![place + length, 0.0, 0.0],
                vec![0.1, 0.0, 0.0],
            ];
            (card.open)(&parameters, &initial, clebsch::card::Settings::step(0.01)).is_ok()
        };
        for place in [0.0, 1e6] {
            assert!(opened(place, 1.0), "{constraint} at {place}");
            // Wrong by a hundredth, ten times the accepted tolerance, which is ten digits of 1e7.
            assert!(!opened(place, 1.01), "{constraint} at {place}");
        }
    }
}
