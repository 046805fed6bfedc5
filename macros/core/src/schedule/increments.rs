//! Velocities of linear maps by their difference from the identity: `S G - S` as `S (G - Id)`, and `tr(G S G^T) - 2
//! tr(G S) + tr(S)` as `tr((G - Id) S (G - Id)^T)`. For small steps a velocity is near the identity, and the terms of
//! a momentum cancel down to the size of the step. Takes an expression; gives an equal one without this cancellation.

use crate::algebra::Algebra;
use crate::expr::shape::{Dim, Structure};
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{
    Expr, Letter, Map, Node, add, identity, letters, position_differences, quotient, rebuild, sub,
    substitute, sum,
};

/// The largest number of terms after expansion. An expression with more terms stays as it is, because the program
/// of a step is read and compiled.
const MOST_TERMS: u64 = 64;

/// Whether the letter is the velocity of a linear map.
fn is_velocity(symbols: &Symbols, l: &Letter) -> bool {
    let symbol = symbols.get(l.symbol);
    let by_matrix = match symbol.structure {
        Structure::Invertible => true,
        Structure::Orthogonal => symbols.differences() || symbol.shape.rows != Dim::Fixed(3),
        _ => false,
    };
    symbol.role == Role::Velocity && by_matrix
}

/// Whether the expression is such a velocity or its transpose, minus the identity.
pub(super) fn is_increment(symbols: &Symbols, e: &Expr) -> bool {
    let velocity = |x: &Expr| match x.node() {
        Node::Letter(l) => is_velocity(symbols, l),
        Node::Transpose(a) => matches!(a.node(), Node::Letter(l) if is_velocity(symbols, l)),
        _ => false,
    };
    let rest = |x: &Expr| matches!(x.node(), Node::Neg(a) if matches!(a.node(), Node::Identity(_)));
    match e.node() {
        Node::Sum(terms) => match terms.as_slice() {
            [a, b] => velocity(a) && rest(b) || velocity(b) && rest(a),
            _ => false,
        },
        _ => false,
    }
}

/// The expression, expanded in the differences of such velocities from the identity. Differences of positions, and
/// terms without cancellation, are unchanged.
pub(super) fn by_increments(symbols: &Symbols, e: &Expr) -> Expr {
    let mut velocities = letters(e);
    velocities.retain(|l| is_velocity(symbols, l));
    if velocities.is_empty() || count(symbols, e) > MOST_TERMS {
        return e.clone();
    }
    let (mut open, named, definitions) = match position_differences::named(symbols, e) {
        Some(named) => (named.symbols, named.whole, named.definitions),
        None => (symbols.clone(), e.clone(), Vec::new()),
    };
    let mut increments: Vec<(Letter, Letter)> = Vec::new();
    for velocity in velocities {
        let name = open.fresh_name("increment");
        let shape = symbols.get(velocity.symbol).shape;
        let symbol = open.add(&name, shape, Structure::General, Role::Velocity);
        let shift = velocity.shift;
        increments.push((velocity, Letter { symbol, shift }));
    }
    let algebra = Algebra::new(&open);
    let (moving, still): (Vec<Expr>, Vec<Expr>) = terms(&named).into_iter().partition(|t| {
        letters(t)
            .iter()
            .any(|l| increments.iter().any(|(velocity, _)| velocity == l))
    });
    let moving = sum(moving, e.shape());
    let mut whole = algebra.lower(&opened(&open, &moving, &increments));
    let mut kept = Vec::new();
    for term in still {
        let own = algebra.lower(&term);
        let meets = own.terms.keys().any(|t| whole.terms.contains_key(t));
        if !meets {
            kept.push(term);
        } else if !own.terms.iter().all(|(t, c)| whole.push(t.clone(), *c)) {
            return e.clone();
        }
    }
    if algebra.exhausted() {
        return e.clone();
    }
    let made = sum(kept.into_iter().chain([algebra.raise(&whole)]), e.shape());
    let difference = |(velocity, increment): &(Letter, Letter)| {
        let v = crate::expr::letter(symbols, velocity.symbol, velocity.shift);
        (*increment, sub(v.clone(), identity(v.shape().rows)))
    };
    let meanings: Vec<(Letter, Expr)> = increments
        .iter()
        .map(difference)
        .chain(definitions)
        .collect();
    substitute(&open, &made, &meanings)
}

/// The terms of a sum.
fn terms(e: &Expr) -> Vec<Expr> {
    match e.node() {
        Node::Sum(terms) => terms.clone(),
        _ => vec![e.clone()],
    }
}

/// The number of terms after expansion.
fn count(symbols: &Symbols, e: &Expr) -> u64 {
    let of = |x: &Expr| count(symbols, x);
    match e.node() {
        Node::Letter(l) if is_velocity(symbols, l) => 2,
        Node::Sum(terms) => terms.iter().map(of).fold(0, u64::saturating_add),
        Node::Product(factors) => factors.iter().map(of).fold(1, u64::saturating_mul),
        Node::Dot(a, b) | Node::Cross(a, b) => of(a).saturating_mul(of(b)),
        Node::Power(a, q) => match q.as_integer() {
            Some(n @ 0..) => of(a).saturating_pow(u32::try_from(n).unwrap_or(u32::MAX)),
            _ => 1,
        },
        Node::Quotient(a, _) => of(a),
        node if is_opaque(node) => 1,
        // Computed entry by entry.
        Node::Map(Map::Diagonal | Map::DiagonalOf, _) => u64::MAX,
        _ => e.children().into_iter().map(of).fold(1, u64::max),
    }
}

/// Whether a velocity inside this node is unchanged, because the node is not a polynomial in it.
fn is_opaque(node: &Node) -> bool {
    match node {
        Node::Power(_, q) => q.as_integer().is_none_or(|n| n < 0),
        Node::Inverse(_)
        | Node::Det(_)
        | Node::Adjugate(_)
        | Node::Call(..)
        | Node::Given(_)
        | Node::PullBack(..) => true,
        _ => false,
    }
}

/// Replaces each velocity by `Id + increment`, except in nodes that are not polynomials in it.
fn opened(open: &Symbols, e: &Expr, increments: &[(Letter, Letter)]) -> Expr {
    match e.node() {
        Node::Letter(l) => match increments.iter().find(|(velocity, _)| velocity == l) {
            Some((_, i)) => {
                let increment = crate::expr::letter(open, i.symbol, i.shift);
                add(identity(e.shape().rows), increment)
            }
            None => e.clone(),
        },
        Node::Quotient(a, b) => quotient(opened(open, a, increments), b.clone()),
        node if is_opaque(node) => e.clone(),
        _ => rebuild(open, e, &mut |x| opened(open, x, increments)),
    }
}

#[cfg(test)]
mod tests {
    use super::by_increments;
    use crate::algebra::Algebra;
    use crate::algebra::Rational;
    use crate::expr::shape::{Dim, Shape, Structure};
    use crate::expr::symbol::{Role, Symbols};
    use crate::expr::{Expr, here, mul, scale, sub, sum, trace, transpose};
    use crate::interpret::{Assignment, evaluate};

    /// `G`, `S`, `x` and `y`.
    fn letters() -> (Symbols, [Expr; 4]) {
        let mut s = Symbols::default();
        let (two, vector) = (Shape::square(Dim::Fixed(2)), Shape::vector(Dim::Fixed(2)));
        let ids = [
            s.add("G", two, Structure::Invertible, Role::Velocity),
            s.add("S", two, Structure::Symmetric, Role::Parameter),
            s.add("x", vector, Structure::General, Role::Element),
            s.add("y", vector, Structure::General, Role::Element),
        ];
        let all = ids.map(|id| here(&s, id));
        (s, all)
    }

    #[test]
    fn terms_that_cancel_at_rest_are_those_of_the_increment() {
        let (s, [g, m, ..]) = letters();
        let across = |a: &Expr, b: &Expr| mul(mul(a.clone(), m.clone()), transpose(&s, b.clone()));
        // tr(G S G^T) - 2 tr(G S) + tr(S), with G - Id of 1e-9 along one entry: 1e-18 S_11.
        let square = sum(
            [
                trace(across(&g, &g)),
                scale(Rational::integer(-2), trace(mul(g.clone(), m.clone()))),
                trace(m.clone()),
            ],
            Shape::SCALAR,
        );
        let made = by_increments(&s, &square);
        assert!(Algebra::new(&s).equal(&made, &square));
        let mut at = Assignment::new();
        let small = f64::powi(2.0, -30);
        at.set("G", 0, 2, 2, &[1.0 + small, 0.0, 0.0, 1.0]);
        at.set("S", 0, 2, 2, &[3.0, 0.5, 0.5, 7.0]);
        let value = evaluate(&s, &made, &at).unwrap().data[0];
        assert_eq!(value, 3.0 * small * small);
    }

    #[test]
    fn differences_of_places_stay_whole() {
        let (s, [g, m, x, y]) = letters();
        let way = sub(x, y);
        let outer = mul(way.clone(), transpose(&s, way.clone()));
        let still = trace(mul(m.clone(), outer.clone()));
        let moving = trace(mul(g, outer));
        let whole = crate::expr::add(still.clone(), moving);
        let made = by_increments(&s, &whole);
        assert!(Algebra::new(&s).equal(&made, &whole));
        let mut at = Assignment::new();
        at.set("G", 0, 2, 2, &[1.0, 0.0, 0.0, 1.0]);
        at.set("S", 0, 2, 2, &[1.0, 0.0, 0.0, 1.0]);
        // Far from the origin, and close to each other.
        at.set("x", 0, 2, 1, &[1e8 + 1.0, 1e8]);
        at.set("y", 0, 2, 1, &[1e8, 1e8]);
        assert_eq!(evaluate(&s, &made, &at).unwrap().data[0], 2.0);
    }
}
