//! Differences of places: sums in which what places far from the origin have in common cancels,
//! `X - Y` of two fields. Opened and multiplied out they would be rounded to that distance.
//! Takes expressions; says which are such, and gives them names.

use super::collect::parts;
use super::shape::Structure;
use super::symbol::{Role, Symbols};
use super::*;

/// Whether it is such a difference, up to sign: of places, or of places and constants.
pub(crate) fn is_between(symbols: &Symbols, e: &Expr) -> bool {
    let terms = match e.node() {
        Node::Sum(terms) => terms,
        Node::Neg(a) => return is_between(symbols, a),
        _ => return false,
    };
    let bare: Vec<(Rational, Bare)> = terms.iter().filter_map(|t| bare(symbols, t)).collect();
    let all = bare.iter().map(|(times, _)| *times);
    let places = bare.iter().filter(|(_, kind)| *kind == Bare::Place);
    let own = places.clone().map(|(times, _)| *times);
    // Constants may be forces: they count where places alone do not cancel.
    places.count() > 0 && (is_zero(own) || is_zero(all))
}

fn is_zero(mut all: impl Iterator<Item = Rational>) -> bool {
    let total = all.try_fold(Rational::ZERO, |a, b| a.plus(b));
    total.is_some_and(Rational::is_zero)
}

/// What stands by itself in a sum, up to a number.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Bare {
    Place,
    Constant,
}

fn bare(symbols: &Symbols, term: &Expr) -> Option<(Rational, Bare)> {
    let found = parts(term);
    let only = match (found.matrices.as_slice(), found.numbers.as_slice()) {
        ([only], []) => only,
        // A field of numbers stands among the numbers.
        ([], [(only, q)]) if q.is_one() => only,
        _ => return None,
    };
    let role = |l: &Letter| symbols.get(l.symbol).role;
    let kind = match only.node() {
        Node::Map(Map::Translation, a) => match a.node() {
            Node::Letter(l) if role(l) == Role::Element => Bare::Place,
            _ => return None,
        },
        Node::Letter(l) => {
            let general = symbols.get(l.symbol).structure == Structure::General;
            match role(l) {
                Role::Element if general => Bare::Place,
                Role::Parameter if general => Bare::Constant,
                _ => return None,
            }
        }
        _ => return None,
    };
    Some((found.coefficient, kind))
}

/// Constants that places are taken from in such differences.
pub(crate) fn centres(symbols: &Symbols, e: &Expr, out: &mut Vec<Letter>) {
    e.children()
        .into_iter()
        .for_each(|a| centres(symbols, a, out));
    if !is_between(symbols, e) {
        return;
    }
    let Node::Sum(terms) = e.node() else { return };
    let bare_terms = terms.iter().filter_map(|t| bare(symbols, t));
    let places = bare_terms.filter(|(_, kind)| *kind == Bare::Place);
    // From places that cancel among themselves a length is subtracted.
    if is_zero(places.map(|(times, _)| times)) {
        return;
    }
    for t in terms {
        if let Some((_, Bare::Constant)) = bare(symbols, t) {
            let letters = super::letters(t).into_iter();
            out.extend(letters.filter(|l| symbols.get(l.symbol).role == Role::Parameter));
        }
    }
}

/// Such a difference with places first, so that they cancel before anything is added.
pub(crate) fn first(symbols: &Symbols, e: Expr) -> Expr {
    let Node::Sum(terms) = e.node() else { return e };
    if terms.len() < 3 || !is_between(symbols, &e) {
        return e;
    }
    let rank = |t: &Expr| match bare(symbols, t) {
        Some((_, Bare::Place)) => 0,
        Some((_, Bare::Constant)) => 1,
        None => 2,
    };
    let mut terms = terms.clone();
    terms.sort_by_key(rank);
    sum(terms, e.shape())
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
