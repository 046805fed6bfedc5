//! Compares derivatives of functionals with derivatives of their definitions and with difference quotients.

use super::sample::{Sample, THREE, at};
use crate::algebra::{Algebra, Rational};
use crate::expr::shape::{Shape, Structure};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Function, Node, Shift};
use crate::interpret::{Assignment, Evaluator, Matrix};
use crate::schedule::program;

/// A derivative of some order.
type Order<'a> = dyn Fn(&Expr) -> Expr + 'a;

/// Letters, functionals, and scalars that contain them.
pub(crate) struct Table {
    pub(crate) sample: Sample,
    pub(crate) x: SymbolId,
    pub(crate) y: SymbolId,
    pub(crate) u: SymbolId,
    pub(crate) v: SymbolId,
    pub(crate) m: SymbolId,
}

impl Table {
    pub(crate) fn new() -> Table {
        let mut s = Symbols::default();
        let vector = Shape::vector(THREE);
        let mut add = |name: &str, shape, role| s.add(name, shape, Structure::General, role);
        let [x, y] = ["X", "Y"].map(|n| add(n, vector, Role::Element));
        let [u, v] = ["u", "v"].map(|n| add(n, vector, Role::Parameter));
        let m = add("m", Shape::SCALAR, Role::Parameter);
        let sample = Sample::over(s);
        Table {
            sample,
            x,
            y,
            u,
            v,
            m,
        }
    }

    pub(crate) fn at(&self, id: SymbolId) -> Expr {
        expr::here(&self.sample.symbols, id)
    }

    pub(crate) fn values(&self) -> Assignment {
        let mut values = Assignment::new();
        self.sample.define(&mut values);
        values.set("X", 0, 3, 1, &[0.3, -0.2, 0.7]);
        values.set("Y", 0, 3, 1, &[-0.5, 0.4, 0.1]);
        values.set("u", 0, 3, 1, &[0.2, 0.9, -0.3]);
        values.set("v", 0, 3, 1, &[-0.8, 0.1, 0.6]);
        values.set_scalar("m", 1.3);
        values
    }

    pub(crate) fn value(&self, e: &Expr, values: &Assignment) -> Matrix {
        let p = program(&self.sample.symbols, std::slice::from_ref(e), "t");
        let mut found = Evaluator::of(&p)
            .run(values)
            .unwrap_or_else(|error| panic!("{error}: {e:?}"));
        found.remove(0)
    }

    /// Scalars with functionals in every position.
    pub(crate) fn numbers(&self) -> Vec<Expr> {
        let s = &self.sample;
        let (x, y, u, m) = (
            &self.at(self.x),
            &self.at(self.y),
            &self.at(self.u),
            &self.at(self.m),
        );
        let f = |x: &Expr| s.of("f", &[x]);
        let g = |x: &Expr, y: &Expr| s.of("g", &[x, y]);
        let k = |a: &Expr| s.of("k", &[a]);
        let half = |e: Expr| expr::scale(Rational::HALF, e);
        let outer =
            |a: &Expr, b: &Expr| expr::mul(a.clone(), expr::transpose(&s.symbols, b.clone()));
        let symmetric = expr::add(outer(x, y), outer(y, x));
        vec![
            f(x),
            expr::mul(m.clone(), f(&half(expr::add(x.clone(), y.clone())))),
            expr::dot(g(x, y), u.clone()),
            expr::mul(f(x), expr::dot(g(x, y), y.clone())),
            expr::power(k(&f(x)), Rational::integer(-2)),
            f(&g(&g(x, y), x)),
            k(&expr::call(
                Function::Cos,
                k(&expr::dot(x.clone(), y.clone())),
            )),
            s.of("r", &[&symmetric]),
            expr::trace(expr::mul(
                s.of("q", &[&outer(x, u)]),
                s.of("q", &[&expr::hat(y.clone())]),
            )),
            expr::dot(
                u.clone(),
                expr::mul(s.of("q", &[&outer(&g(x, x), y)]), x.clone()),
            ),
        ]
    }
}

fn close(a: &Matrix, b: &Matrix, to: f64) -> bool {
    let size = a.data.iter().fold(1.0f64, |m, x| m.max(x.abs()));
    let pairs = a.data.iter().zip(&b.data);
    (a.rows, a.cols) == (b.rows, b.cols)
        && pairs.into_iter().all(|(x, y)| (x - y).abs() <= to * size)
}

#[test]
fn gradients_are_those_of_what_functionals_are() {
    let t = Table::new();
    let s = &t.sample.symbols;
    let values = t.values();
    for e in t.numbers() {
        let open = t.sample.opened(&e);
        for (id, name) in [(t.x, "X"), (t.y, "Y")] {
            let own = expr::gradient(s, &e, at(id));
            let gradient = t.value(&own, &values);
            let wanted = t.value(&expr::gradient(s, &open, at(id)), &values);
            assert!(
                close(&gradient, &wanted, 1e-13),
                "{e:?}\n{gradient:?} {wanted:?}"
            );
            // Difference quotients of the values.
            let quotient = (0..3).map(|i| {
                let moved = |by: f64| {
                    let mut values = values.clone();
                    let mut place = t.value(&t.at(id), &values).data;
                    place[i] += by;
                    values.set(name, 0, 3, 1, &place);
                    t.value(&e, &values).get(0, 0)
                };
                (moved(1e-5) - moved(-1e-5)) / 2e-5
            });
            let quotient = Matrix {
                rows: 3,
                cols: 1,
                data: quotient.collect(),
            };
            assert!(
                close(&gradient, &quotient, 1e-7),
                "{gradient:?} {quotient:?}"
            );
            // A gradient is linear in its seed.
            let twice = expr::gradient(s, &expr::mul(t.at(t.m), e.clone()), at(id));
            let scaled = t.value(&expr::mul(t.at(t.m), own), &values);
            assert!(close(&t.value(&twice, &values), &scaled, 1e-13));
        }
    }
}

#[test]
fn derivatives_of_derivatives_stay_among_the_two_kinds() {
    let t = Table::new();
    let s = &t.sample.symbols;
    let values = t.values();
    let along = |e: &Expr, by: SymbolId| {
        expr::directional(s, e, &[(at(t.x), t.at(by)), (at(t.y), t.at(t.x))])
    };
    // The definitions of nested functionals would be very long.
    let numbers = t.numbers();
    for e in [0, 2, 3, 7].map(|i| &numbers[i]) {
        let open = t.sample.opened(e);
        let orders: [(&str, &Order); 5] = [
            ("d", &|e| along(e, t.u)),
            ("d d", &|e| along(&along(e, t.u), t.v)),
            ("grad d", &|e| expr::gradient(s, &along(e, t.u), at(t.x))),
            ("d grad", &|e| along(&expr::gradient(s, e, at(t.x)), t.v)),
            ("grad of a number of gradients", &|e| {
                let g = expr::gradient(s, e, at(t.y));
                let h = expr::gradient(s, e, at(t.x));
                expr::gradient(s, &expr::dot(along(&g, t.u), h), at(t.x))
            }),
        ];
        for (name, of) in orders {
            let (own, wanted) = (t.value(&of(e), &values), t.value(&of(&open), &values));
            assert!(
                close(&own, &wanted, 1e-11),
                "{name} of {e:?}\n{own:?} {wanted:?}"
            );
        }
    }
}

#[test]
fn directional_derivatives_are_pairings_with_gradients() {
    let t = Table::new();
    let s = &t.sample.symbols;
    let algebra = Algebra::new(s);
    for e in t.numbers() {
        let change = expr::directional(s, &e, &[(at(t.x), t.at(t.u))]);
        let paired = expr::dot(expr::gradient(s, &e, at(t.x)), t.at(t.u));
        assert!(
            algebra.equal(&change, &paired),
            "{e:?}\n{change:?}\n{paired:?}"
        );
        assert!(!algebra.is_zero(&paired));
        // Derivatives in two directions commute.
        let other = [(at(t.x), t.at(t.v))];
        let first = expr::directional(s, &change, &other);
        let second = expr::directional(s, &e, &other);
        let second = expr::directional(s, &second, &[(at(t.x), t.at(t.u))]);
        assert!(algebra.equal(&first, &second), "{e:?}");
    }
    assert!(!algebra.exhausted());
}

#[test]
fn functionals_are_shifted_and_substituted_through_their_arguments() {
    let t = Table::new();
    let s = &t.sample.symbols;
    let (x, next) = (t.at(t.x), expr::letter(s, t.x, Shift::NEXT));
    let g = |x: &Expr| t.sample.of("g", &[x, &t.at(t.u)]);
    let back = |x: &Expr, seed: &Expr| t.sample.back("g", &[x, &t.at(t.u)], 1, seed);
    assert_eq!(expr::shift_time(s, &g(&x), 1), g(&next));
    assert_eq!(expr::shift_time(s, &back(&x, &x), 1), back(&next, &next));
    let replaced = expr::substitute(s, &back(&x, &x), &[(at(t.x), g(&t.at(t.y)))]);
    assert_eq!(replaced, back(&g(&t.at(t.y)), &g(&t.at(t.y))));
    let mut found = vec![at(t.x), at(t.u)];
    found.sort();
    assert_eq!(expr::letters(&back(&x, &x)), found);
    assert!(expr::contains(&g(&x), at(t.u)) && !expr::contains(&g(&x), at(t.y)));
    assert_eq!(g(&x).shape(), Shape::vector(THREE));
    assert_eq!(back(&x, &x).size(), 4);
    // Derivatives with a zero seed or a zero direction.
    assert!(
        expr::substitute(
            s,
            &back(&t.at(t.y), &x),
            &[(at(t.x), expr::zero(x.shape()))]
        )
        .is_zero()
    );
}

#[test]
fn numbers_come_out_of_derivatives_but_not_of_those_over_sites() {
    let t = Table::new();
    let s = &t.sample.symbols;
    let (x, u, m) = (t.at(t.x), t.at(t.u), t.at(t.m));
    let scaled = expr::neg(expr::mul(m.clone(), u.clone()));
    let back = t.sample.back("g", &[&x, &u], 0, &scaled);
    let alone = t.sample.back("g", &[&x, &u], 0, &u);
    assert_eq!(back, expr::neg(expr::mul(m.clone(), alone)));
    // For a scalar functional, the gradient remains.
    let gradient = t.sample.back("f", &[&x], 0, &m);
    let one = t.sample.back("f", &[&x], 0, &expr::integer(1));
    assert_eq!(gradient, expr::mul(m.clone(), one.clone()));
    assert!(matches!(one.node(), Node::PullBack(..)));
    let change = expr::directional(s, &t.sample.of("f", &[&x]), &[(at(t.x), u.clone())]);
    assert_eq!(change, expr::dot(one, u.clone()));
    // The argument of `area` is one value per site: the mass of a site remains in the seed, the constant 2 does not.
    let seed = expr::scale(Rational::integer(2), m.clone());
    let area = t.sample.back("area", &[&x], 0, &seed);
    let own = t.sample.back("area", &[&x], 0, &m);
    assert_eq!(area, expr::scale(Rational::integer(2), own.clone()));
    assert!(matches!(own.node(), Node::PullBack(_, _, seed) if *seed == m));
    let change = expr::directional(s, &t.sample.of("area", &[&x]), &[(at(t.x), u)]);
    assert!(matches!(change.node(), Node::Given(a) if a.along.len() == 1));
}
