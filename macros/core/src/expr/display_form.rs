//! Collects like terms for display: powers of one number become one power, `√a a` becomes `a^{3/2}`, and terms are
//! alike for any order of their scalars. Takes an expression, gives one that is equal wherever the first is defined.

use super::collect::{Parts, coefficient, parts, scaled, take, whole};
use super::substitute::bottom_up;
use super::*;
use crate::expr::symbol::Symbols;

/// The expression with like terms and powers collected at every depth.
pub fn shown(symbols: &Symbols, e: &Expr) -> Expr {
    bottom_up(symbols, e, &|e| match e.node() {
        Node::Sum(terms) => sum_of(terms, e.shape()),
        Node::Product(_) | Node::Quotient(..) | Node::Neg(_) => {
            let (coefficient, core) = of_one_power(&e);
            scaled(coefficient, core)
        }
        Node::Power(a, _) if matches!(a.node(), Node::Power(..)) => {
            let (coefficient, core) = of_one_power(&e);
            scaled(coefficient, core)
        }
        _ => e,
    })
}

/// A sum with like terms combined.
fn sum_of(terms: &[Expr], shape: Shape) -> Expr {
    let mut found: Vec<(Parts, Rational)> = Vec::new();
    for term in terms {
        let mut own = joined(parts(term));
        let coefficient = std::mem::replace(&mut own.coefficient, Rational::ONE);
        let known = found.iter_mut().find(|(other, _)| are_alike(other, &own));
        match known.map(|(_, c)| (c.plus(coefficient), c)) {
            Some((Some(total), c)) => *c = total,
            _ => found.push((own, coefficient)),
        }
    }
    let terms = found.into_iter().map(|(core, c)| scaled(c, whole(core)));
    sum(terms.collect::<Vec<_>>(), shape)
}

/// The numeric factor of a term, and the term without it, with powers of each scalar combined.
fn of_one_power(e: &Expr) -> (Rational, Expr) {
    let own = parts(e);
    match own.numbers.iter().any(|(base, _)| root(base).is_some()) {
        false => coefficient(e),
        true => {
            let mut own = joined(own);
            let coefficient = std::mem::replace(&mut own.coefficient, Rational::ONE);
            (coefficient, whole(own))
        }
    }
}

/// The radicand of a root, and its exponent.
fn root(e: &Expr) -> Option<(&Expr, Rational)> {
    match e.node() {
        Node::Power(a, q) if q.as_integer().is_none() => Some((a, *q)),
        _ => None,
    }
}

/// The parts with the powers of each scalar combined.
fn joined(own: Parts) -> Parts {
    let Parts {
        coefficient,
        numbers,
        matrices,
        shape,
    } = own;
    let mut powers: Vec<(Expr, Rational)> = Vec::new();
    for (base, exponent) in numbers {
        let opened = root(&base).and_then(|(a, q)| Some((a.clone(), q.times(exponent)?)));
        let (base, exponent) = opened.unwrap_or((base, exponent));
        match powers.iter_mut().find(|(known, _)| is_same(known, &base)) {
            Some((_, total)) => match total.plus(exponent) {
                Some(sum) => *total = sum,
                None => powers.push((base, exponent)),
            },
            None => powers.push((base, exponent)),
        }
    }
    let mut out = Parts {
        coefficient,
        numbers: Vec::new(),
        matrices,
        shape,
    };
    for (base, exponent) in powers {
        match exponent.as_integer() {
            // `√(a b) √(a b)` is `a b`.
            Some(_) => take(&base, exponent, &mut out),
            None => out.numbers.push((base, exponent)),
        }
    }
    out.numbers.retain(|(_, exponent)| !exponent.is_zero());
    out
}

/// Whether two scalars are equal; the factors of a scalar product may be in either order.
fn is_same(a: &Expr, b: &Expr) -> bool {
    a == b
        || match (a.node(), b.node()) {
            (Node::Dot(x, y), Node::Dot(z, w)) => x == w && y == z,
            _ => false,
        }
}

/// Whether two matrices are equal; the inverse of a transpose equals the transpose of the inverse.
fn is_same_matrix(a: &Expr, b: &Expr) -> bool {
    fn of(e: &Expr) -> Option<&Expr> {
        match e.node() {
            Node::Transpose(inner) => match inner.node() {
                Node::Inverse(x) => Some(x),
                _ => None,
            },
            Node::Inverse(inner) => match inner.node() {
                Node::Transpose(x) => Some(x),
                _ => None,
            },
            _ => None,
        }
    }
    a == b || of(a).is_some_and(|x| of(b) == Some(x))
}

/// Whether two terms differ only in their coefficients.
fn are_alike(a: &Parts, b: &Parts) -> bool {
    let same = |x: &(Expr, Rational), y: &(Expr, Rational)| x.1 == y.1 && is_same(&x.0, &y.0);
    let mut matrices = a.matrices.iter().zip(&b.matrices);
    a.matrices.len() == b.matrices.len()
        && matrices.all(|(x, y)| is_same_matrix(x, y))
        && a.numbers.len() == b.numbers.len()
        && a.numbers
            .iter()
            .all(|x| b.numbers.iter().any(|y| same(x, y)))
}

/// For a power of `x·x` or of a square, the vector or number `x` and the exponent of its length: `(x·x)^{3/2}` is
/// `|x|^3`.
pub fn power_of_length(e: &Expr) -> Option<(&Expr, Rational)> {
    let (square, q) = root(e)?;
    let twice = q.times(Rational::integer(2))?;
    twice.as_integer()?;
    match square.node() {
        Node::Dot(a, b) if a == b => Some((a, twice)),
        Node::Power(a, two) if *two == Rational::integer(2) => Some((a, twice)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::shape::Structure;
    use crate::expr::symbol::Role;

    #[test]
    fn powers_of_one_number_are_one() {
        let mut s = Symbols::default();
        let three = Shape::vector(Dim::Fixed(3));
        let add = |s: &mut Symbols, name, shape| {
            let id = s.add(name, shape, Structure::General, Role::Parameter);
            here(s, id)
        };
        let a = add(&mut s, "a", Shape::SCALAR);
        let b = add(&mut s, "b", Shape::SCALAR);
        let x = add(&mut s, "x", three);
        let y = add(&mut s, "y", three);
        let (half, two) = (Rational::HALF, Rational::integer(2));
        let square = dot(x.clone(), x.clone());
        let length = power(square.clone(), half);
        let of = |n: i128, q: i128| power(square.clone(), Rational::new(n, q).unwrap());
        // sqrt(x.x) (x.x)^2, and its inverse times x.x
        let long = mul(length.clone(), power(square.clone(), two));
        assert_eq!(shown(&s, &long), of(5, 2));
        let short = quotient(integer(1), of(3, 2));
        assert_eq!(shown(&s, &quotient(square.clone(), long.clone())), short);
        assert_eq!(
            shown(&s, &power(length.clone(), Rational::integer(3))),
            of(3, 2)
        );
        assert_eq!(shown(&s, &mul(length.clone(), length.clone())), square);
        // Like terms in other orders, and with different forms of one power.
        let one = quotient(product([a.clone(), b.clone(), x.clone()]), long);
        let other = quotient(product([b.clone(), a.clone(), x.clone()]), of(5, 2));
        assert!(shown(&s, &sub(one.clone(), other.clone())).is_zero());
        let both = quotient(
            product([integer(2), a.clone(), b.clone(), x.clone()]),
            of(5, 2),
        );
        assert_eq!(shown(&s, &super::super::add(one, other)), both);
        let turned = sub(dot(x.clone(), y.clone()), dot(y, x.clone()));
        assert!(shown(&s, &turned).is_zero());
        // A root of a square is not a first power.
        let size = power(power(a.clone(), two), half);
        assert_eq!(shown(&s, &size), size);
        assert_eq!(power_of_length(&size), Some((&a, Rational::ONE)));
        let cube = of(3, 2);
        assert_eq!(power_of_length(&cube), Some((&x, Rational::integer(3))));
        assert_eq!(power_of_length(&square), None);
    }
}
