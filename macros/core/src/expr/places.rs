//! Differences of places: sums in which what places far from the origin have in common cancels,
//! `X - Y` of two fields. Opened and multiplied out they would be rounded to that distance.
//! Takes expressions; says which are such, and gives them names.

use super::collect::parts;
use super::shape::Structure;
use super::symbol::{Role, Symbols};
use super::*;

/// Whether it is such a difference, up to sign.
pub(crate) fn is_between(symbols: &Symbols, e: &Expr) -> bool {
    let terms = match e.node() {
        Node::Sum(terms) => terms,
        Node::Neg(a) => return is_between(symbols, a),
        _ => return false,
    };
    let place = |e: &Expr| match e.node() {
        Node::Map(Map::Translation, a) => {
            matches!(a.node(), Node::Letter(l) if symbols.get(l.symbol).role == Role::Element)
        }
        Node::Letter(l) => {
            let symbol = symbols.get(l.symbol);
            symbol.role == Role::Element && symbol.structure == Structure::General
        }
        _ => false,
    };
    let count = |t: &Expr| {
        let found = parts(t);
        let (placed, numbers) = match found.matrices.as_slice() {
            [only] => (place(only), found.numbers.is_empty()),
            // A field of numbers stands among the numbers.
            [] => match found.numbers.as_slice() {
                [(only, q)] => (place(only), q.is_one()),
                _ => return None,
            },
            _ => return None,
        };
        (placed && numbers).then_some(found.coefficient)
    };
    let found: Vec<Rational> = terms.iter().filter_map(count).collect();
    let total = found.iter().try_fold(Rational::ZERO, |a, b| a.plus(*b));
    !found.is_empty() && total.is_some_and(Rational::is_zero)
}

/// An expression with letters for such differences.
pub(crate) struct Named {
    /// The symbols of the expression, with these letters.
    pub(crate) symbols: Symbols,
    /// The expression.
    pub(crate) whole: Expr,
    /// What the letters stand for.
    pub(crate) definitions: Vec<(Letter, Expr)>,
}

/// The expression with a letter for each such difference. None where there is none.
pub(crate) fn named(symbols: &Symbols, e: &Expr) -> Option<Named> {
    let mut all = symbols.clone();
    let mut definitions = Vec::new();
    let whole = name(symbols, &mut all, &mut definitions, e);
    (!definitions.is_empty()).then_some(Named {
        symbols: all,
        whole,
        definitions,
    })
}

fn name(s: &Symbols, all: &mut Symbols, found: &mut Vec<(Letter, Expr)>, e: &Expr) -> Expr {
    if !is_between(s, e) {
        return rebuild(s, e, &mut |x| name(s, all, found, x));
    }
    let known = |found: &[(Letter, Expr)], e: &Expr| {
        let same = found.iter().find(|(_, known)| known == e);
        same.map(|(l, _)| letter(all, l.symbol, l.shift))
    };
    let opposite = neg(e.clone());
    if let Some(known) = known(found, e) {
        return known;
    }
    if let Some(known) = known(found, &opposite) {
        return neg(known);
    }
    let symbol = all.add(
        &all.fresh_name("r"),
        e.shape(),
        Structure::General,
        Role::Derived,
    );
    let at = Letter {
        symbol,
        shift: Shift::HERE,
    };
    found.push((at, e.clone()));
    letter(all, symbol, Shift::HERE)
}
