//! Collects like terms and cancels common numeric factors for display: `-V A - V A` becomes `-2 V A`, `h^2 a/(2 h)`
//! becomes `h a/2`. Takes an expression, gives an equal one. Products are not expanded, so that users recognise what
//! they wrote.

use super::substitute::bottom_up;
use super::*;
use crate::expr::symbol::Symbols;

/// A term as coefficient, powers of scalars, and matrices in order.
pub(crate) struct Parts {
    pub coefficient: Rational,
    pub numbers: Vec<(Expr, Rational)>,
    pub matrices: Vec<Expr>,
    pub shape: Shape,
}

/// The expression with like terms collected at every depth.
pub fn collect(symbols: &Symbols, e: &Expr) -> Expr {
    bottom_up(symbols, e, &|e| match e.node() {
        Node::Sum(terms) => sum_of(terms, e.shape()),
        Node::Product(_) | Node::Quotient(..) | Node::Neg(_) => cancelled(&e),
        _ => e,
    })
}

fn sum_of(terms: &[Expr], shape: Shape) -> Expr {
    let mut found: Vec<(Expr, Rational)> = Vec::new();
    for term in terms {
        let (coefficient, core) = coefficient(term);
        let known = found
            .iter_mut()
            .find(|(other, _)| *other == core)
            .map(|(_, c)| c);
        match known.map(|c| (c.plus(coefficient), c)) {
            Some((Some(total), c)) => *c = total,
            _ => found.push((core, coefficient)),
        }
    }
    let terms = found.into_iter().map(|(core, c)| scaled(c, core));
    sum(terms.collect::<Vec<_>>(), shape)
}

/// A scalar times a sum as the sum of the terms, each multiplied by the scalar: `2 (a/2 - b/2)` becomes `a - b`.
pub fn term_by_term(e: &Expr) -> Expr {
    let (number, core) = coefficient(e);
    let Node::Sum(terms) = core.node() else {
        return e.clone();
    };
    let own = terms.iter().map(|term| {
        let (own, core) = coefficient(term);
        number.times(own).map(|both| scaled(both, core))
    });
    match own.collect::<Option<Vec<Expr>>>() {
        Some(terms) => sum(terms, e.shape()),
        None => e.clone(),
    }
}

/// The sum with a positive term in front, if it has one: `-J A + A J` becomes `A J - J A`.
pub fn positive_first(e: &Expr) -> Expr {
    let Node::Sum(terms) = e.node() else {
        return e.clone();
    };
    let added = |t: &Expr| !parts(t).coefficient.is_negative();
    let Some(first) = terms.iter().position(added) else {
        return e.clone();
    };
    let mut terms = terms.clone();
    let front = terms.remove(first);
    terms.insert(0, front);
    sum(terms, e.shape())
}

/// `-(a x b)` is `b x a`, also under a hat.
fn turned(a: &Expr) -> Option<Expr> {
    match a.node() {
        Node::Cross(x, y) => Some(cross(y.clone(), x.clone())),
        Node::Hat(v) => turned(v).map(hat),
        Node::Product(list) => {
            let (last, rest) = list.split_last()?;
            let numbers = rest.iter().all(|f| f.shape().is_scalar());
            let last = numbers.then(|| turned(last)).flatten()?;
            Some(product(rest.iter().cloned().chain([last])))
        }
        Node::Quotient(top, bottom) => Some(quotient(turned(top)?, bottom.clone())),
        _ => None,
    }
}

/// `c a`, with the number in the numerator.
pub(super) fn scaled(c: Rational, a: Expr) -> Expr {
    if c.is_negative()
        && let Some(a) = turned(&a)
    {
        return scaled(c.negated(), a);
    }
    match a.node() {
        Node::Quotient(top, bottom) => quotient(scale(c, top.clone()), bottom.clone()),
        _ => scale(c, a),
    }
}

/// The numeric factor of a term, and the term without it.
pub fn coefficient(e: &Expr) -> (Rational, Expr) {
    let mut parts = parts(e);
    let coefficient = parts.coefficient;
    parts.coefficient = Rational::ONE;
    (coefficient, whole(parts))
}

fn cancelled(e: &Expr) -> Expr {
    let (coefficient, core) = coefficient(e);
    scaled(coefficient, core)
}

pub(crate) fn parts(e: &Expr) -> Parts {
    let mut out = Parts {
        coefficient: Rational::ONE,
        numbers: Vec::new(),
        matrices: Vec::new(),
        shape: e.shape(),
    };
    take(e, Rational::ONE, &mut out);
    out
}

/// Adds the factors of `e` raised to `power`, which is 1 for matrices.
pub(super) fn take(e: &Expr, power: Rational, out: &mut Parts) {
    let number = |out: &mut Parts, base: &Expr, power: Rational| {
        let known = out.numbers.iter_mut().find(|(other, _)| other == base);
        match known.map(|(_, e)| (e.plus(power), e)) {
            Some((Some(total), e)) => *e = total,
            _ => out.numbers.push((base.clone(), power)),
        }
    };
    match e.node() {
        Node::Neg(a) if power.as_integer().is_some() => {
            if power.as_integer().is_some_and(|n| n % 2 != 0) {
                out.coefficient = out.coefficient.negated();
            }
            take(a, power, out);
        }
        Node::Number(q) => {
            let raised = power.as_integer().and_then(|n| q.power(n));
            match raised.and_then(|r| out.coefficient.times(r)) {
                Some(c) => out.coefficient = c,
                None => number(out, e, power),
            }
        }
        Node::Product(list) if power.is_one() || list.iter().all(|f| f.shape().is_scalar()) => {
            // A row times a column is one scalar.
            if e.shape().is_scalar() && !list.iter().all(|f| f.shape().is_scalar()) {
                let (numbers, word): (Vec<Expr>, Vec<Expr>) =
                    list.iter().cloned().partition(|f| f.shape().is_scalar());
                numbers.iter().for_each(|f| take(f, power, out));
                number(out, &product(word), power);
            } else {
                list.iter().for_each(|f| take(f, power, out));
            }
        }
        Node::Quotient(a, b) => {
            take(a, power, out);
            take(b, power.negated(), out);
        }
        Node::Power(a, q) => match q.times(power) {
            Some(total) if q.as_integer().is_some() => take(a, total, out),
            _ => number(out, e, power),
        },
        _ if e.shape().is_scalar() => number(out, e, power),
        // `(-A - B) C` becomes `-(A + B) C`.
        Node::Sum(terms) if terms.iter().all(|t| parts(t).coefficient.is_negative()) => {
            out.coefficient = out.coefficient.negated();
            out.matrices.push(neg(e.clone()));
        }
        _ => out.matrices.push(e.clone()),
    }
}

/// The product of the parts, with negative powers in the denominator.
pub(super) fn whole(mut parts: Parts) -> Expr {
    // Letters precede scalar products and traces.
    parts
        .numbers
        .sort_by_key(|(base, _)| !matches!(base.node(), Node::Letter(_)));
    let mut over = vec![number(parts.coefficient)];
    let mut under = Vec::new();
    for (base, exponent) in parts.numbers {
        if exponent.is_negative() {
            under.push(power(base, exponent.negated()));
        } else {
            over.push(power(base, exponent));
        }
    }
    let square = parts.matrices.is_empty() && !parts.shape.is_scalar();
    over.extend(parts.matrices);
    if square {
        over.push(identity(parts.shape.rows));
    }
    let top = product(over);
    if under.is_empty() {
        top
    } else {
        quotient(top, product(under))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::shape::Structure;
    use crate::expr::symbol::{Role, SymbolId};

    fn table() -> (Symbols, [SymbolId; 4]) {
        let mut s = Symbols::default();
        let three = Shape::square(Dim::Fixed(3));
        let h = s.add("h", Shape::SCALAR, Structure::General, Role::Step);
        let a = s.add("a", Shape::SCALAR, Structure::General, Role::Parameter);
        let v = s.add("V", three, Structure::General, Role::Multiplier);
        let m = s.add("A", three, Structure::General, Role::Parameter);
        (s, [h, a, v, m])
    }

    #[test]
    fn like_terms_are_one() {
        let (s, [h, a, v, m]) = table();
        let l = |id| here(&s, id);
        let word = mul(l(v), l(m));
        let twice = collect(&s, &neg(add(word.clone(), word.clone())));
        assert_eq!(twice, scale(Rational::integer(-2), word.clone()));
        assert!(collect(&s, &sub(word.clone(), word.clone())).is_zero());
        // Halves over a common divisor.
        let half = quotient(word.clone(), scale(Rational::integer(2), l(h)));
        let whole = quotient(word, l(h));
        assert_eq!(collect(&s, &add(half.clone(), half)), whole);
        // h^2 a/(2 h)
        let square = power(l(h), Rational::integer(2));
        let long = quotient(mul(square, l(a)), scale(Rational::integer(2), l(h)));
        let short = product([number(Rational::HALF), l(h), l(a)]);
        assert_eq!(collect(&s, &long), short);
        // Unlike terms are unchanged.
        let other = add(mul(l(v), l(m)), mul(l(m), l(v)));
        assert_eq!(collect(&s, &other), other);
    }

    #[test]
    fn a_multiple_of_the_identity_keeps_its_shape() {
        let (s, [h, ..]) = table();
        let id = || identity(Dim::Fixed(3));
        let e = add(quotient(id(), here(&s, h)), quotient(id(), here(&s, h)));
        let one = quotient(scale(Rational::integer(2), id()), here(&s, h));
        assert_eq!(collect(&s, &e), one);
        assert_eq!(collect(&s, &e).shape(), Shape::square(Dim::Fixed(3)));
    }
}
