//! Equal forms that cost less: `(Id + Q^T) Q` becomes `Q + Id`, and `(Id + A) v` becomes `v + A v`. If `A` is
//! symmetric, the axial vector of `A Q^T` is the axial vector of `-Q A`. Used for emitted code. Takes an expression,
//! gives an equal one.

use super::shape::Structure;
use super::*;
use crate::expr::symbol::Symbols;

/// The expression with such sums expanded at every depth.
pub fn simpler(symbols: &Symbols, e: &Expr) -> Expr {
    let e = rebuild(symbols, e, &mut |x| simpler(symbols, x));
    match e.node() {
        Node::Product(factors) => product_of(symbols, factors).unwrap_or(e),
        Node::Vee(a) => match a.node() {
            Node::Sum(terms) => {
                let own = |t: &Expr| upright(symbols, t).map_or_else(|| t.clone(), neg);
                let turned = terms.iter().filter(|t| !is_symmetric(symbols, t));
                vee(sum(turned.map(own).collect::<Vec<_>>(), a.shape()))
            }
            _ if is_symmetric(symbols, a) => zero(e.shape()),
            _ => upright(symbols, a).map_or(e, |turned| neg(vee(turned))),
        },
        Node::Trace(a) => upright(symbols, a).map_or(e, trace),
        _ => e,
    }
}

/// Whether the expression equals its transpose, so that its axial vector is zero.
fn is_symmetric(symbols: &Symbols, e: &Expr) -> bool {
    transpose(symbols, e.clone()) == *e
}

/// The transpose, if it contains fewer transposes.
fn upright(symbols: &Symbols, e: &Expr) -> Option<Expr> {
    let turned = transpose(symbols, e.clone());
    (transposes(&turned) < transposes(e)).then_some(turned)
}

/// The number of matrices that are accessed by rows.
fn transposes(e: &Expr) -> usize {
    let inner: usize = e.children().into_iter().map(transposes).sum();
    inner + usize::from(matches!(e.node(), Node::Transpose(_)))
}

fn product_of(symbols: &Symbols, factors: &[Expr]) -> Option<Expr> {
    let pair = (1..factors.len()).find_map(|i| {
        let [a, b] = [&factors[i - 1], &factors[i]];
        let together = match (identity_and(a), identity_and(b)) {
            (Some((sign, x)), _) if are_inverse(symbols, &x, b) || b.shape().is_vector() => {
                let own = mul(x, b.clone());
                sum([cancelled(symbols, own), scale(sign, b.clone())], b.shape())
            }
            (_, Some((sign, x))) if are_inverse(symbols, a, &x) => {
                let own = mul(a.clone(), x);
                sum([cancelled(symbols, own), scale(sign, a.clone())], a.shape())
            }
            _ => return None,
        };
        Some((i, together))
    });
    let (i, together) = pair?;
    let mut word = factors[..i - 1].to_vec();
    word.push(together);
    word.extend_from_slice(&factors[i + 1..]);
    Some(match product_of(symbols, &word) {
        Some(further) => further,
        None => product(word),
    })
}

/// `x` and the sign of `Id` in a sum of the two.
pub(super) fn identity_and(e: &Expr) -> Option<(Rational, Expr)> {
    let Node::Sum(terms) = e.node() else {
        return None;
    };
    let sign = |t: &Expr| match t.node() {
        Node::Identity(_) => Some(Rational::ONE),
        Node::Neg(a) if matches!(a.node(), Node::Identity(_)) => Some(Rational::MINUS_ONE),
        _ => None,
    };
    match terms.as_slice() {
        [a, b] => match (sign(a), sign(b)) {
            (Some(q), None) => Some((q, b.clone())),
            (None, Some(q)) => Some((q, a.clone())),
            _ => None,
        },
        _ => None,
    }
}

/// Whether the product of the two, up to sign, is the identity: a rotation and its transpose.
fn are_inverse(symbols: &Symbols, a: &Expr, b: &Expr) -> bool {
    let bare = |e: &Expr| match e.node() {
        Node::Neg(inner) => inner.clone(),
        _ => e.clone(),
    };
    let (a, b) = (bare(a), bare(b));
    let turn = |e: &Expr| match e.node() {
        Node::Letter(at) => symbols.get(at.symbol).structure == Structure::Orthogonal,
        _ => false,
    };
    match (a.node(), b.node()) {
        (Node::Transpose(x), _) => *x == b && turn(x),
        (_, Node::Transpose(y)) => *y == a && turn(y),
        _ => false,
    }
}

/// The product of a rotation and its transpose, up to sign, is the identity.
fn cancelled(symbols: &Symbols, e: Expr) -> Expr {
    let (negative, bare) = match e.node() {
        Node::Neg(a) => (true, a.clone()),
        _ => (false, e.clone()),
    };
    let one = match bare.node() {
        Node::Product(list) => match list.as_slice() {
            [a, b] if are_inverse(symbols, a, b) => identity(e.shape().rows),
            _ => return e,
        },
        _ => return e,
    };
    if negative { neg(one) } else { one }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::symbol::Role;

    #[test]
    fn sums_with_the_identity_are_multiplied_out_where_that_costs_less() {
        let mut s = Symbols::default();
        let (three, vector) = (Shape::square(Dim::Fixed(3)), Shape::vector(Dim::Fixed(3)));
        let mut letter = |name: &str, shape, structure| {
            let id = s.add(name, shape, structure, Role::Parameter);
            here(&s, id)
        };
        let q = letter("Q", three, Structure::Orthogonal);
        let a = letter("A", three, Structure::Symmetric);
        let b = letter("B", three, Structure::General);
        let v = letter("v", vector, Structure::General);
        let one = || identity(Dim::Fixed(3));
        let back = transpose(&s, q.clone());
        let less = |x: Expr| sub(x, one());
        let short = sum([one(), neg(q.clone())], three);
        let turned = mul(less(back.clone()), q.clone());
        assert_eq!(simpler(&s, &turned), short);
        let turned = product([a.clone(), q.clone(), add(one(), back.clone())]);
        let short = mul(a.clone(), sum([one(), q.clone()], three));
        assert_eq!(simpler(&s, &turned), short);
        let seen = product([a.clone(), less(b.clone()), v.clone()]);
        let short = mul(a.clone(), sub(mul(b.clone(), v.clone()), v.clone()));
        assert_eq!(simpler(&s, &seen), short);
        assert_eq!(
            simpler(&s, &vee(mul(a.clone(), back.clone()))),
            neg(vee(mul(q.clone(), a.clone())))
        );
        let (other, word) = (mul(b.clone(), q.clone()), mul(a.clone(), back.clone()));
        assert_eq!(
            simpler(&s, &vee(add(other.clone(), word.clone()))),
            vee(sub(other, mul(q.clone(), a.clone())))
        );
        assert_eq!(simpler(&s, &trace(word)), trace(mul(q.clone(), a.clone())));
        assert!(simpler(&s, &vee(a.clone())).is_zero());
        assert_eq!(simpler(&s, &vee(add(a.clone(), b.clone()))), vee(b.clone()));
        // Expansion would save nothing.
        for stays in [
            mul(less(b.clone()), q.clone()),
            mul(add(a.clone(), b.clone()), v),
            vee(mul(b, q)),
        ] {
            assert_eq!(simpler(&s, &stays), stays);
        }
    }
}
