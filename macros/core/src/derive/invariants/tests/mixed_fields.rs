//! Symmetries that mix components of fields: rotations of space in coordinates, rotations about a skew axis,
//! hyperbolic rotations. Each test has a statement that breaks the symmetry.

use super::{Family, derive};
use crate::print::{Format, Style};

/// Names and formulas of the Noether momenta.
fn momenta(text: &str) -> Vec<(String, String)> {
    let d = derive(text);
    let own = d.invariants.iter().filter(|v| v.family == Family::Noether);
    let shown = own.map(|v| {
        let value = v.value.as_ref().expect("a formula");
        (
            v.name.clone(),
            crate::print::expression(value, &d.letters.symbols, &Style::new("k"), Format::Text),
        )
    });
    shown.collect()
}

fn names(text: &str) -> Vec<String> {
    momenta(text).into_iter().map(|(name, _)| name).collect()
}

/// A particle in a potential that depends on its three coordinates.
fn coordinates(potential: &str) -> String {
    format!(
        "model Particle {{
            param m, k: Real; field x, y, z: Real;
            lagrangian = m*((next(x) - x)^2 + (next(y) - y)^2 + (next(z) - z)^2)/(2*h) - h*k*{potential};
        }}"
    )
}

#[test]
fn an_angular_momentum_is_found_in_coordinates() {
    let turns = ["xy", "xz", "yz"].map(|pair| {
        let (a, b) = pair.split_at(1);
        format!("momentum_angular_{a}_{b}")
    });
    assert_eq!(names(&coordinates("1/sqrt(x^2 + y^2 + z^2)")), turns);
    assert_eq!(names(&coordinates("(x^2 + y^2)^2*z^2")), turns[..1]);
    assert_eq!(names(&coordinates("(x^2 + 2*y^2)^2*z^2")), [""; 0]);
    let first = &momenta(&coordinates("(x^2 + y^2)^2*z^2"))[0].1;
    assert_eq!(first, "x_k p_{2,k} - y_k p_{1,k}");
}

#[test]
fn vectors_and_numbers_turn_together() {
    let text = |square: &str| {
        format!(
            "model Particle {{
                param m, k: Real; field X: Vec<2>; field z: Real; let V = next(X) - X;
                lagrangian = m*(dot(V, V) + (next(z) - z)^2)/(2*h) - h*k*({square})^2;
            }}"
        )
    };
    let all = names(&text("dot(X, X) + z^2"));
    assert_eq!(all.len(), 3, "{all:?}");
    assert_eq!(names(&text("dot(X, X) + 3*z^2")), ["momentum_X_angular"]);
}

#[test]
fn a_turn_about_a_skew_axis_is_found() {
    let text = |last: &str| {
        format!(
            "model Particle {{
                param m, k: Real; field X: Vec<3>; let V = next(X) - X; let s = X[1] + X[2] + {last};
                lagrangian = m*dot(V, V)/(2*h) - h*k*dot(X, X)^2 - h*s^4;
            }}"
        )
    };
    assert_eq!(names(&text("X[3]")), ["momentum_angular_X1_X2_X3"]);
    assert_eq!(names(&text("2*X[3]")), ["momentum_angular_X1_X2_X3"]);
    assert_eq!(names(&text("X[3]^2")), [""; 0]);
}

#[test]
fn linear_maps_that_are_no_turns_are_found_and_total_differences() {
    let text = "model Particle { param m, k: Real; field x, y: Real;
        lagrangian = m*(next(x) - x)*(next(y) - y)/h - h*k*(x*y)^2; }";
    assert_eq!(names(text), ["joint_momentum_x_y"]);
    let field = "model Particle { param m, k, f: Real; field x, y: Real;
        lagrangian = m*((next(x) - x)^2 + (next(y) - y)^2)/(2*h) + f*x*(next(y) - y) + f*(next(x) - x)*(next(y) - y)/2
            - h*k*(x^2 + y^2)^2; }";
    assert_eq!(names(field), ["momentum_angular_x_y"]);
}

/// Names with their formulas.
fn momentum_formulas(text: &str) -> Vec<String> {
    let list = momenta(text).into_iter();
    list.map(|(name, value)| format!("{name} = {value}"))
        .collect()
}

#[test]
fn numbers_move_along_components_of_vectors() {
    let cart = |constraint: &str, potential: &str| {
        format!(
            "model Cart {{ param m, M, l, g: Real; field x: Real; field y: Vec<2>; hold n: {constraint} = l^2; \
             lagrangian = M*(next(x) - x)^2/(2*h) + m*dot(next(y) - y, next(y) - y)/(2*h) - h*m*g*{potential}; }}"
        )
    };
    let bob = "dot(y - x*E1, y - x*E1)";
    let kept = "total_momentum_E1 = p_{2,k}·E₁ + p_{1,k}";
    assert_eq!(momentum_formulas(&cart(bob, "dot(E2, y)")), [kept]);
    // A cart on a slope, and a constraint that depends on the position of the cart, conserve nothing.
    assert!(momentum_formulas(&cart(bob, "(dot(E2, y) + x)")).is_empty());
    let crossed = "dot(y - x*E1, y - x*E1) + x*dot(E1, y)";
    assert!(momentum_formulas(&cart(crossed, "dot(E2, y)")).is_empty());
}

#[test]
fn an_angle_turns_with_a_vector() {
    let spring = |angle: &str| {
        format!(
            "model Slot {{ param m, k, j: Real; field a: Real; field y: Vec<2>; lagrangian = \
             j*(next(a) - a)^2/(2*h) + m*dot(next(y) - y, next(y) - y)/(2*h) \
             - h*k*(dot(E1, y)*cos({angle}) + dot(E2, y)*sin({angle}))^2/2; }}"
        )
    };
    assert_eq!(
        momentum_formulas(&spring("a")),
        ["joint_momentum_angular_E1_E2 = p_{1,k} + E₁·((-p_{2,k} y_kᵀ + y_k p_{2,k}ᵀ) E₂)"]
    );
    // If the potential depends on twice the angle, the angle moves half as far.
    let twice = momentum_formulas(&spring("2*a"));
    assert_eq!(twice.len(), 1, "{twice:?}");
    assert!(twice[0].contains('2') && twice != momentum_formulas(&spring("a")));
    assert!(momentum_formulas(&spring("a^2")).is_empty());
}

#[test]
fn numbers_move_in_proportion_to_parameters() {
    let wheel = |way: &str| {
        format!(
            "model Wheel {{ param m, j, r, k: Real; field x: Real; field p: Real; lagrangian = \
             m*(next(x) - x)^2/(2*h) + j*(next(p) - p)^2/(2*h) - h*k*({way})^2/2; }}"
        )
    };
    assert_eq!(
        momentum_formulas(&wheel("x - r*p")),
        ["total_momentum_r = ϖ_{2,k} + r ϖ_{1,k}"]
    );
    assert!(momentum_formulas(&wheel("x - r*p^2")).is_empty());
    // The same for a component of a vector in a constraint.
    let string = |way: &str| {
        format!(
            "model String {{ param m, j, r: Real; field x: Vec<2>; field p: Real; hold n: {way} = 0; lagrangian = \
             m*dot(next(x) - x, next(x) - x)/(2*h) + j*(next(p) - p)^2/(2*h); }}"
        )
    };
    let kept = momentum_formulas(&string("x[1] - r*p"));
    assert!(
        kept.iter()
            .any(|m| m.contains("ϖ_{2,k}") && m.contains("r E₁")),
        "{kept:?}"
    );
    assert!(
        !momentum_formulas(&string("x[1] - r*p^2"))
            .iter()
            .any(|m| m.contains("ϖ_{2,k}"))
    );
}
