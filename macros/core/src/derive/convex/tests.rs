//! Actions reported as convex are convex at random points. Actions that are not convex, or whose form does not decide
//! it, are left to the proof of each step.

use super::convexity;
use crate::derive::variation::at;
use crate::expr::shape::Dim;
use crate::expr::{self, Shift};
use crate::interpret::{Assignment, evaluate};
use crate::{Derivation, derive_source};

fn derived(body: &str) -> Derivation {
    let text = format!(
        "model Points {{ param m, n, b, c: Real; param a: Vec<3>; param M: Mat<3>; {body} }}"
    );
    derive_source(&text).unwrap_or_else(|e| panic!("{text}: {e:?}"))
}

/// The coefficients whose signs decide: those that must be positive, then those that must not be negative.
fn signs(d: &Derivation) -> Option<[Vec<String>; 2]> {
    let s = &d.letters.symbols;
    let found = convexity(&d.spec, s, &d.action)?;
    let text = |list: &[expr::Expr]| {
        let each = list.iter().map(|e| expr::letters(e).into_iter());
        each.map(|l| l.map(|l| s.get(l.symbol).name.clone()).collect())
            .collect()
    };
    Some([text(&found.positive), text(&found.not_negative)])
}

/// The second derivative of the action of an edge along a velocity, at a random point.
fn curvature(d: &Derivation, seed: u64) -> f64 {
    let s = &d.letters.symbols;
    let edge = expr::substitute(s, &d.action.edge, &d.spec.end_of_edge());
    let along: Vec<_> = d
        .spec
        .configurations
        .iter()
        .zip(&d.letters.variation)
        .map(|(c, xi)| (at(c.velocity, Shift::HERE), expr::here(s, *xi)))
        .collect();
    let twice = expr::directional(s, &expr::directional(s, &edge, &along), &along);
    let mut state = seed;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut values = Assignment::new();
    for l in expr::letters(&twice) {
        let symbol = s.get(l.symbol);
        let count = |n: Dim| match n {
            Dim::Fixed(n) => n as usize,
            _ => 1,
        };
        let (rows, cols) = (count(symbol.shape.rows), count(symbol.shape.cols));
        // Scalars are coefficients or the step size, and are positive.
        let data: Vec<f64> = (0..rows * cols)
            .map(|_| match rows * cols {
                1 if symbol.name.len() == 1 => 0.1 + random(),
                _ => 4.0 * random() - 2.0,
            })
            .collect();
        values.set(&symbol.name, l.shift.time, rows, cols, &data);
    }
    evaluate(s, &twice, &values).expect("a value").get(0, 0)
}

const FREE: &str = "field X, Y: Vec<3>; let d = next(X) - X; let e = next(Y) - Y; \
     lagrangian = m*dot(d, d)/(2*h) + n*dot(e, e)/(2*h)";

#[test]
fn sums_of_convex_functions_are_convex_where_their_coefficients_say_so() {
    let cases = [
        (
            "+ (b/h^3)*dot(d, d)^2 + (c/h^3)*dot(e, e)^2 - h*m*dot(a, X)",
            [2, 2],
        ),
        (
            "+ (b/h^3)*(dot(d, d)*dot(d, d)) + (c/h)*dot(d - e, d - e)^2",
            [2, 2],
        ),
        (
            "+ (b/h)*exp(dot(d, d)/h^2) + (b*c/h)*exp(dot(a, e)/h)",
            [2, 2],
        ),
        (
            "+ b*h*cosh(dot(a, d)/h) + (c/h^3)*dot(a, d)^4 + dot(M*a, d)/h",
            [2, 2],
        ),
        ("+ (b/h^2)*dot(M*d, M*d)^(3/2)", [2, 1]),
    ];
    for (more, count) in cases {
        let d = derived(&format!("{FREE} {more};"));
        let [positive, others] = signs(&d).unwrap_or_else(|| panic!("{more}"));
        assert_eq!([positive.len(), others.len()], count, "{more}");
        for seed in 1..200 {
            let found = curvature(&d, seed);
            assert!(found > 0.0, "{more}: {found} at {seed}");
        }
    }
    let matrix = derived(
        "field Q: Mat<2, 3>; let d = next(Q) - Q; lagrangian = m*tr(d*d^T)/(2*h) + (b/h^3)*tr(d^T*d)^2;",
    );
    assert!(signs(&matrix).is_some());
}

#[test]
fn what_is_not_convex_by_its_form_is_left_to_the_proof() {
    for more in [
        "+ (b/h^3)*dot(d, d)^2*dot(e, e)",
        "+ (b/h^2)*dot(a, d)^3",
        "- h*b*sqrt(c + dot(d, d)/h^2)",
        "+ (b/h^3)*dot(d, d)^2*dot(X, X)",
        "+ (b/h)*dot(d, d)^2/(1 + dot(e, e))",
        "+ h*b*sin(dot(a, d)/h)",
        "+ (dot(a, X)/h^3)*dot(e, e)^2",
    ] {
        assert!(
            signs(&derived(&format!("{FREE} {more};"))).is_none(),
            "{more}"
        );
    }
    // There is no square term in the velocity of Y alone.
    let body = "field X, Y: Vec<3>; let d = next(X) - X; let e = next(Y) - Y; \
         lagrangian = m*dot(d, d)/(2*h) + (n/h^3)*dot(d + e, d + e)^2;";
    assert!(signs(&derived(body)).is_none());
    // The velocity of a group is not an additive unknown, so no convexity is reported.
    let group = "group R: SO<3> velocity V; constraint next(R) = R*V; \
         lagrangian = -m*tr(V)/h + (b/h)*tr(M*V)^2;";
    assert!(signs(&derived(group)).is_none());
}
