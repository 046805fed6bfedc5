//! Values of functionals are letters: equal for equal arguments, different for others. Linearity is the only known
//! property of their derivatives.

use crate::algebra::{Algebra, Decision, Rational};
use crate::expr::functional::tests::Table;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::Role;
use crate::expr::{self, Applied, Expr, Functional, Kind, Reach, range};

#[test]
fn equal_arguments_give_equal_values_and_others_do_not() {
    let t = Table::new();
    let s = &t.sample.symbols;
    let algebra = Algebra::new(s);
    let (x, y, u, m) = (t.at(t.x), t.at(t.y), t.at(t.u), t.at(t.m));
    let f = |x: &Expr| t.sample.of("f", &[x]);
    let g = |x: &Expr, y: &Expr| t.sample.of("g", &[x, y]);
    let two = |e: Expr| expr::scale(Rational::integer(2), e);
    let more = expr::add(x.clone(), y.clone());
    // (x + y) + (x - y) is 2 x only in normal form.
    let twice = expr::sum([more.clone(), x.clone(), expr::neg(y.clone())], x.shape());
    let turned = expr::cross(expr::neg(y.clone()), x.clone());
    for (a, b) in [
        (f(&twice), f(&two(x.clone()))),
        (f(&turned), f(&expr::cross(x.clone(), y.clone()))),
        (
            g(&twice, &more),
            g(&two(x.clone()), &expr::add(y.clone(), x.clone())),
        ),
        (f(&g(&twice, &y)), f(&g(&two(x.clone()), &y))),
        (
            expr::quotient(expr::power(f(&x), Rational::integer(2)), f(&x)),
            f(&x),
        ),
        (expr::mul(f(&x), m.clone()), expr::mul(m.clone(), f(&x))),
    ] {
        assert_eq!(algebra.zero(&expr::sub(a, b)), Some(Decision::NormalForm));
    }
    assert!(algebra.is_zero(&expr::det(g_outer(&t))));
    // An identity of three dimensions in the argument.
    let (a, b) = (
        expr::cross(x.clone(), expr::cross(y.clone(), u.clone())),
        expr::sub(
            expr::mul(expr::dot(x.clone(), u.clone()), y.clone()),
            expr::mul(expr::dot(x.clone(), y.clone()), u.clone()),
        ),
    );
    assert!(algebra.equal(&f(&a), &f(&b)));
    let none = expr::zero(x.shape());
    for (a, b) in [
        (f(&x), f(&y)),
        (f(&two(x.clone())), two(f(&x))),
        (f(&two(x.clone())), expr::scale(Rational::integer(4), f(&x))),
        (f(&more), expr::add(f(&x), f(&y))),
        (f(&expr::neg(x.clone())), f(&x)),
        (f(&expr::neg(x.clone())), expr::neg(f(&x))),
        (f(&none), expr::integer(0)),
        (g(&x, &y), g(&y, &x)),
        (g(&x, &y), expr::neg(g(&y, &x))),
        (t.sample.of("k", &[&f(&x)]), f(&x)),
        (
            expr::power(expr::power(f(&x), Rational::integer(2)), Rational::HALF),
            f(&x),
        ),
    ] {
        assert!(!algebra.equal(&a, &b), "{a:?} {b:?}");
        assert!(!algebra.agree(&a, &b), "{a:?} {b:?}");
    }
    assert!(!algebra.exhausted());
    // Its sign and range are unknown.
    let bounds = range::range(&f(&x));
    assert!(!bounds.is_not_negative() && !bounds.is_not_positive() && !bounds.overflows());
}

/// A matrix of rank one, whose determinant vanishes for every functional.
fn g_outer(t: &Table) -> Expr {
    let g = t.sample.of("g", &[&t.at(t.x), &t.at(t.y)]);
    expr::mul(g.clone(), expr::transpose(&t.sample.symbols, g))
}

#[test]
fn what_is_raised_is_what_was_lowered() {
    let t = Table::new();
    let s = &t.sample.symbols;
    let algebra = Algebra::new(s);
    for e in t.numbers() {
        for e in [
            expr::gradient(s, &e, crate::expr::functional::sample::at(t.x)),
            e,
        ] {
            let raised = algebra.raise(&algebra.lower(&e));
            assert!(algebra.agree(&raised, &e), "{e:?}\n{raised:?}");
            assert!(algebra.equal(&raised, &e));
        }
    }
}

#[test]
fn derivatives_are_linear_symmetric_and_transposed() {
    let t = Table::new();
    let sample = &t.sample;
    let s = &sample.symbols;
    let algebra = Algebra::new(s);
    let (x, y, u, v, m) = (t.at(t.x), t.at(t.y), t.at(t.u), t.at(t.v), t.at(t.m));
    let back = |seed: &Expr| sample.back("g", &[&x, &y], 1, seed);
    let along = |list: &[(u8, &Expr)]| expr::derived(s, sample.along("g", &[&x, &y], list));
    let both = expr::sub(u.clone(), expr::mul(m.clone(), v.clone()));
    let scaled = |a: Expr, b: Expr| expr::sub(a, expr::mul(m.clone(), b));
    let normal = |a: Expr, b: Expr| {
        assert_eq!(algebra.zero(&expr::sub(a, b)), Some(Decision::NormalForm));
    };
    normal(back(&both), scaled(back(&u), back(&v)));
    normal(
        along(&[(0, &both)]),
        scaled(along(&[(0, &u)]), along(&[(0, &v)])),
    );
    normal(
        expr::dot(v.clone(), along(&[(1, &u)])),
        expr::dot(back(&v), u.clone()),
    );
    let mixed = along(&[(0, &u), (1, &v)]);
    normal(mixed.clone(), along(&[(1, &v), (0, &u)]));
    assert!(algebra.equal(&along(&[(0, &u), (0, &v)]), &along(&[(0, &v), (0, &u)])));
    for (a, b) in [
        (mixed, along(&[(0, &v), (1, &u)])),
        (along(&[(0, &u)]), along(&[(1, &u)])),
        (back(&u), sample.back("g", &[&x, &y], 0, &u)),
        (
            expr::dot(v.clone(), along(&[(1, &u)])),
            expr::dot(back(&u), v.clone()),
        ),
    ] {
        assert!(!algebra.equal(&a, &b));
    }
    // The gradient with respect to a symmetric argument is symmetric.
    let square = expr::mul(x.clone(), expr::transpose(s, x.clone()));
    let gradient = sample.back("r", &[&square], 0, &expr::integer(1));
    assert_eq!(expr::transpose(s, gradient.clone()), gradient);
    let raised = algebra.raise(&algebra.lower(&gradient));
    assert_eq!(raised, gradient);
    normal(
        expr::dot(u.clone(), expr::mul(gradient.clone(), v.clone())),
        expr::dot(v.clone(), expr::mul(gradient.clone(), u.clone())),
    );
    let q = sample.of("q", &[&square]);
    assert!(!algebra.equal(&q, &expr::transpose(s, q.clone())));
    // Inverse and determinant follow the rules for a letter.
    normal(
        expr::mul(expr::inverse(s, q.clone()), q.clone()),
        expr::identity(q.shape().rows),
    );
    let skew = expr::sub(q.clone(), expr::transpose(s, q.clone()));
    normal(
        expr::vee(skew),
        expr::scale(Rational::integer(2), expr::vee(q)),
    );
}

#[test]
fn structures_of_values_and_sizes_with_names_hold_at_points() {
    let mut t = Table::new();
    let named = t.sample.symbols.add_dim("n", 2, 6);
    let value = |structure, shape| Kind { structure, shape };
    let functional = |name: &str, kind: Kind, value: Kind, reach| Functional {
        name: name.to_owned(),
        arguments: vec![kind],
        value,
        reach,
        path: String::new(),
        typeset: None,
    };
    let three = Shape::square(Dim::Fixed(3));
    let vector = Kind::of(Shape::vector(named));
    let s = &mut t.sample.symbols;
    let skew = s.add_functional(functional(
        "w",
        Kind::of(Shape::SCALAR),
        value(Structure::Skew, three),
        Reach::Point,
    ));
    let long = s.add_functional(functional("l", vector, vector, Reach::Point));
    let sites = s.add_functional(functional(
        "b",
        vector,
        Kind::of(Shape::SCALAR),
        Reach::Sites,
    ));
    let letter = |s: &mut expr::symbol::Symbols, name: &str| {
        let id = s.add(name, vector.shape, Structure::General, Role::Parameter);
        expr::here(s, id)
    };
    let [a, b, c] = ["a", "b", "c"].map(|name| letter(s, name));
    let m = t.at(t.m);
    let s = &t.sample.symbols;
    let algebra = Algebra::new(s);
    let w = expr::given(s, skew, vec![m.clone()]);
    assert_eq!(expr::transpose(s, w.clone()), expr::neg(w.clone()));
    assert!(algebra.is_zero(&expr::sub(expr::hat(expr::vee(w.clone())), w.clone())));
    assert!(!algebra.is_zero(&w));
    // <s, D l(a)[u]> = <(D l(a))^T[s], u> for a size without known entries.
    let applied = |along: Vec<(u8, Expr)>| Applied {
        functional: long,
        arguments: vec![a.clone()],
        along,
    };
    let change = expr::derived(s, applied(vec![(0, b.clone())]));
    let back = expr::pull_back(s, applied(Vec::new()), 0, c.clone());
    let (left, right) = (expr::dot(c.clone(), change), expr::dot(back, b.clone()));
    assert_eq!(
        algebra.zero(&expr::sub(left.clone(), right)),
        Some(Decision::ExactEvaluation)
    );
    assert!(!algebra.is_zero(&left));
    // A functional of all sites has no value at a point, and its scalar factors do not move out.
    let over = |along, seed: &Expr| {
        let a = Applied {
            functional: sites,
            arguments: vec![a.clone()],
            along,
        };
        expr::pull_back(s, a, 0, seed.clone())
    };
    let one = expr::integer(1);
    let (seed, own) = (over(Vec::new(), &m), over(Vec::new(), &one));
    assert!(!algebra.equal(&seed, &expr::mul(m.clone(), own.clone())));
    let more = over(
        Vec::new(),
        &expr::add(expr::scale(Rational::integer(3), m.clone()), one),
    );
    let apart = expr::add(expr::scale(Rational::integer(3), seed), own);
    assert_eq!(
        algebra.zero(&expr::sub(more, apart)),
        Some(Decision::NormalForm)
    );
}
