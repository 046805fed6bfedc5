//! Compares magnitudes with the change of an expression when its letters are rounded. A magnitude is never much
//! smaller, and at most a thousand times as large, even if factors nearly vanish. There, products of norms are larger
//! by up to twenty orders of magnitude.

use super::shape::{Dim, Shape, Structure};
use super::symbol::{Role, Symbols};
use super::{
    Expr, Function, add, call, cross, det, dot, gradient, here, identity, integer, letters,
    magnitude, mul, power, quotient, sub, trace,
};
use crate::algebra::Rational;
use crate::interpret::{Assignment, evaluate};

const THREE: Dim = Dim::Fixed(3);

/// The symbols `a`, `b`, `d`, `e`, `R` and `J`.
fn symbols() -> (Symbols, [Expr; 6]) {
    let mut s = Symbols::default();
    let mut add = |name: &str, shape, structure| s.add(name, shape, structure, Role::Element);
    let ids = [
        add("a", Shape::SCALAR, Structure::General),
        add("b", Shape::SCALAR, Structure::General),
        add("d", Shape::vector(THREE), Structure::General),
        add("e", Shape::vector(THREE), Structure::General),
        add("R", Shape::square(THREE), Structure::Orthogonal),
        add("J", Shape::square(THREE), Structure::Symmetric),
    ];
    let all = ids.map(|id| here(&s, id));
    (s, all)
}

/// `a` and `b`, `d` and `e`, `R` and the identity differ by about `gap`.
fn values(gap: f64) -> Assignment {
    let mut v = Assignment::new();
    v.set("a", 0, 1, 1, &[1.3]);
    v.set("b", 0, 1, 1, &[1.3 - gap]);
    v.set("d", 0, 3, 1, &[0.7, -1.1, 0.4]);
    v.set("e", 0, 3, 1, &[0.7 + gap, -1.1, 0.4 - 0.5 * gap]);
    let (sine, cosine) = gap.sin_cos();
    let turn = [cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0];
    v.set("R", 0, 3, 3, &turn);
    v.set(
        "J",
        0,
        3,
        3,
        &[2.0, 0.3, 0.1, 0.3, 1.5, -0.2, 0.1, -0.2, 1.0],
    );
    v
}

/// The change of the expression, in units of rounding, when every entry of every letter changes by one rounding
/// error.
fn change(s: &Symbols, e: &Expr, v: &Assignment) -> f64 {
    let each = letters(e).into_iter().map(|l| {
        let slope = evaluate(s, &gradient(s, e, l), v).unwrap();
        let own = evaluate(s, &super::letter(s, l.symbol, l.shift), v).unwrap();
        let both = slope.data.iter().zip(&own.data);
        both.map(|(x, y)| (x * y).abs()).sum::<f64>()
    });
    each.sum()
}

#[test]
fn sizes_are_what_rounding_makes_of_an_expression() {
    let (s, [a, b, d, e, r, j]) = symbols();
    let gap = || sub(a.clone(), b.clone());
    let way = || sub(d.clone(), e.clone());
    let across = || cross(d.clone(), e.clone());
    let turned = || sub(integer(3), trace(r.clone()));
    let to = |x: Expr, n: i64| power(x, Rational::integer(n));
    let from_rest = mul(j.clone(), sub(r.clone(), identity(THREE)));
    for (name, e) in [
        ("a b", mul(a.clone(), b.clone())),
        ("a - b", gap()),
        ("(a - b)^2", to(gap(), 2)),
        ("(a - b)^9", to(gap(), 9)),
        ("(a - b) (a + b)", mul(gap(), add(a.clone(), b.clone()))),
        (
            "(a - b)/(a + b)",
            quotient(gap(), add(a.clone(), b.clone())),
        ),
        ("a exp(a - b)", mul(a.clone(), call(Function::Exp, gap()))),
        ("|d - e|^2", dot(way(), way())),
        ("|d - e|^4", to(dot(way(), way()), 2)),
        ("|d - e|^2 (a - b)", mul(dot(way(), way()), gap())),
        ("|d x e|^2", dot(across(), across())),
        (
            "(d·(d x e) + a - b) b",
            mul(add(dot(d.clone(), across()), gap()), b.clone()),
        ),
        (
            "a det(J) (a - b)",
            mul(mul(a.clone(), det(j.clone())), gap()),
        ),
        ("(3 - tr R)^2", to(turned(), 2)),
        ("b (3 - tr R)^5", mul(b.clone(), to(turned(), 5))),
        ("tr(J (R - Id)) (a - b)", mul(trace(from_rest), gap())),
    ] {
        for size in [1.0, 1e-3, 1e-6] {
            let v = values(size);
            let change = change(&s, &e, &v);
            let found = evaluate(&s, &magnitude(&s, &e), &v).unwrap().data[0];
            assert!(
                0.5 * change <= found && found <= 1e3 * change,
                "{name} at {size}: {found:e} beside {change:e}"
            );
        }
    }
}
