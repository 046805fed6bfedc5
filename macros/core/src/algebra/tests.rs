//! Quaternions and rigid motions: identities that hold, and similar equations that do not.

use super::rational::Rational;
use super::{Algebra, Decision};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr};

struct Letters {
    symbols: Symbols,
}

impl Letters {
    fn new() -> Letters {
        let mut symbols = Symbols::default();
        let (four, three) = (Shape::square(Dim::Fixed(4)), Dim::Fixed(3));
        let mut add = |name: &str, shape, structure| {
            symbols.add(name, shape, structure, Role::Parameter);
        };
        for name in ["p", "q"] {
            add(name, four, Structure::UnitQuaternion);
        }
        for name in ["G", "F"] {
            add(name, four, Structure::RigidMotion);
        }
        for name in ["u", "v"] {
            add(name, Shape::vector(three), Structure::General);
        }
        add("K", four, Structure::General);
        add("J", Shape::square(three), Structure::Symmetric);
        Letters { symbols }
    }

    fn at(&self, name: &str) -> Expr {
        expr::here(&self.symbols, self.symbols.find(name).unwrap())
    }

    fn t(&self, e: Expr) -> Expr {
        expr::transpose(&self.symbols, e)
    }

    fn inverse(&self, e: Expr) -> Expr {
        expr::inverse(&self.symbols, e)
    }

    fn known(&self, left: Expr, right: Expr) -> Option<Decision> {
        Algebra::new(&self.symbols).zero(&expr::sub(left, right))
    }
}

#[test]
fn quaternions_turn_vectors() {
    let l = Letters::new();
    let (q, p, v) = (l.at("q"), l.at("p"), l.at("v"));
    let rot = |e: Expr| expr::rotation(&l.symbols, e);
    let conjugated = expr::product([q.clone(), expr::pure(v.clone()), l.t(q.clone())]);
    let turned = expr::mul(rot(q.clone()), v.clone());
    let found = l.known(expr::imaginary(conjugated.clone()), turned.clone());
    assert_eq!(found, Some(Decision::NormalForm));
    let backward = expr::mul(l.t(rot(q.clone())), v.clone());
    assert_eq!(l.known(expr::imaginary(conjugated), backward), None);
    // A homomorphism; orthogonality alone would not suffice.
    let both = expr::mul(q.clone(), p.clone());
    let product = expr::mul(rot(q.clone()), rot(p.clone()));
    assert_eq!(l.known(rot(both), product), Some(Decision::NormalForm));
    // R v = (w^2 - |x|^2) v + 2 (x.v) x + 2 w x × v, only if |q| = 1.
    let (w, x) = (expr::real(q.clone()), expr::imaginary(q.clone()));
    let two = || expr::integer(2);
    let square = |e: Expr| expr::mul(e.clone(), e);
    let rodrigues = |sign: i64| {
        expr::sum(
            [
                expr::mul(
                    expr::sub(square(w.clone()), expr::dot(x.clone(), x.clone())),
                    v.clone(),
                ),
                expr::product([two(), expr::dot(x.clone(), v.clone()), x.clone()]),
                expr::product([
                    expr::integer(2 * sign),
                    w.clone(),
                    expr::cross(x.clone(), v.clone()),
                ]),
            ],
            v.shape(),
        )
    };
    let found = l.known(turned.clone(), rodrigues(1));
    assert_eq!(found, Some(Decision::ExactEvaluation));
    assert_eq!(l.known(turned, rodrigues(-1)), None);
}

#[test]
fn imaginary_parts_are_projections_and_products_those_of_hamilton() {
    let l = Letters::new();
    let (q, u, v, k) = (l.at("q"), l.at("u"), l.at("v"), l.at("K"));
    let hamilton = expr::mul(expr::pure(u.clone()), expr::pure(v.clone()));
    let cross = expr::pure(expr::cross(u.clone(), v.clone()));
    let dot = expr::mul(
        expr::dot(u.clone(), v.clone()),
        expr::identity(Dim::Fixed(4)),
    );
    let product = expr::sub(cross, dot);
    assert_eq!(
        l.known(hamilton.clone(), product),
        Some(Decision::NormalForm)
    );
    let swapped = expr::mul(expr::pure(v.clone()), expr::pure(u.clone()));
    assert_eq!(l.known(hamilton, swapped), None);
    // im(g X g^T) = R im(X) and im(X^T) = -im(X) for any 4 x 4 matrix.
    let conjugated = expr::product([q.clone(), k.clone(), l.t(q.clone())]);
    let turned = expr::mul(
        expr::rotation(&l.symbols, q.clone()),
        expr::imaginary(k.clone()),
    );
    let found = l.known(expr::imaginary(conjugated), turned);
    assert_eq!(found, Some(Decision::NormalForm));
    let minus = |e: Expr| expr::neg(expr::imaginary(e));
    let back = expr::imaginary(l.t(q.clone()));
    assert_eq!(l.known(back, minus(q.clone())), Some(Decision::NormalForm));
    let back = expr::imaginary(l.t(k.clone()));
    assert_eq!(l.known(back, minus(k.clone())), Some(Decision::NormalForm));
    // The skew part of a quaternion depends on its imaginary part only; for a general matrix this is false.
    let skew = |e: &Expr| expr::part(expr::Part::Skew, e.clone());
    let pure = |e: &Expr| expr::pure(expr::imaginary(e.clone()));
    assert_eq!(l.known(skew(&q), pure(&q)), Some(Decision::NormalForm));
    assert_eq!(l.known(skew(&k), pure(&k)), None);
}

#[test]
fn rigid_motions_are_decided_in_blocks() {
    let l = Letters::new();
    let (g, f, j) = (l.at("G"), l.at("F"), l.at("J"));
    let s = &l.symbols;
    let (rot, pos) = (|e: &Expr| expr::block(s, e), |e: &Expr| expr::column(s, e));
    let both = expr::mul(g.clone(), f.clone());
    let product = expr::mul(rot(&g), rot(&f));
    assert_eq!(l.known(rot(&both), product), Some(Decision::NormalForm));
    let moved = expr::add(expr::mul(rot(&g), pos(&f)), pos(&g));
    assert_eq!(
        l.known(pos(&both), moved.clone()),
        Some(Decision::NormalForm)
    );
    assert_eq!(l.known(pos(&expr::mul(f, g.clone())), moved), None);
    // The inverse has the parts R^T and -R^T x.
    let back = l.inverse(g.clone());
    assert_eq!(
        l.known(rot(&back), l.t(rot(&g))),
        Some(Decision::NormalForm)
    );
    let opposite = expr::neg(expr::mul(l.t(rot(&g)), pos(&g)));
    assert_eq!(l.known(pos(&back), opposite), Some(Decision::NormalForm));
    // A rigid motion is not orthogonal, but its rotation block is.
    let one = expr::identity(Dim::Fixed(4));
    assert_eq!(l.known(expr::mul(l.t(g.clone()), g.clone()), one), None);
    let energy = |r: Expr| expr::trace(expr::product([r.clone(), j.clone(), l.t(r)]));
    let found = l.known(energy(rot(&g)), expr::trace(j.clone()));
    assert_eq!(found, Some(Decision::NormalForm));
    assert_eq!(
        l.known(expr::det(g), expr::integer(1)),
        Some(Decision::NormalForm)
    );
}

#[test]
fn products_of_quaternions_are_taken_apart() {
    let l = Letters::new();
    let (q, p, u, v) = (l.at("q"), l.at("p"), l.at("u"), l.at("v"));
    let rot = |e: &Expr| expr::rotation(&l.symbols, e.clone());
    let pure = |e: &Expr| expr::pure(e.clone());
    let between = expr::mul(l.t(q.clone()), p.clone());
    let back = expr::mul(l.t(p.clone()), q.clone());
    let seen = |x: &Expr, by: &Expr| expr::mul(l.t(rot(by)), x.clone());
    let words = [
        between.clone(),
        back.clone(),
        expr::product([between.clone(), pure(&v)]),
        expr::product([back.clone(), pure(&u), between.clone()]),
        // A rotation followed by a relative rotation of the vector moves to the other side of it.
        expr::product([
            between.clone(),
            pure(&seen(&expr::mul(rot(&q), u.clone()), &p)),
        ]),
        expr::product([l.t(q.clone()), q.clone(), pure(&v)]),
        expr::mul(
            l.t(q.clone()),
            expr::sub(
                expr::product([q.clone(), pure(&u)]),
                expr::product([expr::integer(3), p.clone(), pure(&v)]),
            ),
        ),
        expr::quotient(
            expr::neg(expr::mul(between.clone(), between)),
            expr::integer(5),
        ),
    ];
    for word in words {
        for e in [
            expr::imaginary(word.clone()),
            expr::real(word.clone()),
            expr::trace(word.clone()),
        ] {
            let parted = expr::quaternion_components(&l.symbols, &e);
            assert!(l.known(parted.clone(), e.clone()).is_some(), "{e:?}");
            assert!(is_parted(&parted), "{parted:?}");
            if !e.is_zero() {
                let twice = expr::scale(crate::algebra::Rational::integer(2), parted);
                assert_eq!(l.known(twice, e.clone()).is_some(), parts_vanish(&l, &e));
            }
        }
    }
    // A rigid motion is not a quaternion.
    let motion = expr::trace(l.at("G"));
    assert_eq!(expr::quaternion_components(&l.symbols, &motion), motion);
}

fn parts_vanish(l: &Letters, e: &Expr) -> bool {
    l.known(e.clone(), expr::zero(e.shape())).is_some()
}

/// Whether parts are taken only of single quaternions and of relative quaternions.
fn is_parted(e: &Expr) -> bool {
    match e.node() {
        expr::Node::Map(expr::Map::Real | expr::Map::Imaginary, a) => match a.node() {
            expr::Node::Letter(_) => true,
            expr::Node::Product(two) => {
                two.len() == 2 && two.iter().all(|f| expr::letters(f).len() == 1)
            }
            _ => false,
        },
        expr::Node::Trace(_) => false,
        _ => e.children().into_iter().all(is_parted),
    }
}

#[test]
fn diagonals_are_those_of_the_entries() {
    let l = Letters::new();
    let (k, v) = (l.at("K"), l.at("J"));
    let diagonal = |e: Expr| expr::part(expr::Part::Diagonal, e);
    let agree = |a: Expr, b: Expr| assert!(l.known(a, b).is_some());
    // diag(A) = diag(A^T), tr diag(A) = tr A, tr(diag(A) B) = tr(diag(A) diag(B)), diag(diag(A)) = diag(A).
    for a in [k.clone(), v.clone()] {
        let d = diagonal(a.clone());
        let turned = diagonal(l.t(a.clone()));
        assert_eq!(l.known(d.clone(), turned), Some(Decision::NormalForm));
        agree(expr::trace(d.clone()), expr::trace(a.clone()));
        agree(diagonal(d.clone()), d.clone());
        let square = expr::mul(a.clone(), a.clone());
        let both = expr::mul(d.clone(), diagonal(square.clone()));
        agree(expr::trace(expr::mul(d.clone(), square)), expr::trace(both));
        assert_eq!(l.known(d, a), None);
    }
}

/// Products of fractional powers of a sum, a multiple and a trace are integer powers of them.
#[test]
fn fractional_powers_multiply_to_whole_ones() {
    let l = Letters::new();
    let (j, third) = (l.at("J"), Rational::new(1, 3).expect("a fraction"));
    let trace = expr::trace(j.clone());
    let squares = expr::trace(expr::product([j.clone(), j]));
    let difference = expr::sub(expr::product([trace.clone(), trace.clone()]), squares);
    let half = Rational::new(1, 2).expect("a fraction");
    let bases = [
        trace.clone(),
        expr::scale(half, trace),
        difference.clone(),
        expr::scale(half, difference),
    ];
    for base in bases {
        for n in [-3, -2, -1, 1, 2, 5, 6] {
            let rest = Rational::integer(n).plus(third).expect("a fraction");
            let product = expr::product([
                expr::power(base.clone(), rest),
                expr::power(base.clone(), third.negated()),
            ]);
            let whole = expr::power(base.clone(), Rational::integer(n));
            let found = l.known(product.clone(), whole.clone());
            assert_eq!(found, Some(Decision::NormalForm), "{n}");
            let other = expr::scale(half, whole);
            assert_eq!(l.known(product, other), None, "{n}");
        }
    }
}

/// A product of orthogonal letters that cancels to the identity has trace 3, even if the product comes from two axial
/// vectors.
#[test]
fn squares_of_axial_vectors_keep_the_trace_of_the_identity() {
    let mut symbols = Symbols::default();
    let square = Shape::square(Dim::Fixed(3));
    for (name, structure) in [
        ("R", Structure::Orthogonal),
        ("S", Structure::Orthogonal),
        ("A", Structure::General),
        ("B", Structure::General),
    ] {
        symbols.add(name, square, structure, Role::Parameter);
    }
    let at = |name: &str| expr::here(&symbols, symbols.find(name).unwrap());
    let t = |e: Expr| expr::transpose(&symbols, e);
    let axial = |a: Expr, b: Expr| expr::dot(expr::vee(a), expr::vee(b));
    // 4 vee(A) . vee(B) = tr(A B^T) - tr(A B).
    let by_traces = |a: Expr, b: Expr| {
        let difference = expr::sub(
            expr::trace(expr::mul(a.clone(), t(b.clone()))),
            expr::trace(expr::mul(a, b)),
        );
        expr::scale(Rational::QUARTER, difference)
    };
    let (r, s) = (at("R"), at("S"));
    let product = expr::mul(r.clone(), s.clone());
    for (a, b) in [
        (r.clone(), r.clone()),
        (r.clone(), t(r.clone())),
        (r.clone(), s.clone()),
        (product.clone(), product.clone()),
        (product, expr::mul(t(s), t(r.clone()))),
        (at("A"), at("B")),
        (at("A"), at("A")),
        (expr::mul(r.clone(), at("A")), expr::mul(r, at("A"))),
    ] {
        let algebra = Algebra::new(&symbols);
        let (given, wanted) = (axial(a.clone(), b.clone()), by_traces(a, b));
        let whole = expr::mul(given.clone(), given.clone());
        assert!(algebra.equal(&given, &wanted), "{given:?}");
        let squared = expr::mul(wanted.clone(), wanted);
        assert!(algebra.equal(&whole, &squared), "{given:?}");
        assert!(
            algebra.agree(&given, &algebra.shortest(&given)),
            "{given:?}"
        );
    }
}
