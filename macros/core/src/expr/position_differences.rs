//! Differences of positions: sums in which the common part of positions far from the origin cancels, such as `X -
//! Y` of two fields or `y - x*E1` of a vector and a number. Expanded, they would be rounded relative to that
//! distance. Takes expressions; recognises such differences and names them.

use super::collect::parts;
use super::shape::{Dim, Shape, Structure};
use super::symbol::{Role, Symbols};
use super::*;

/// Whether the sum is such a difference, up to sign: of positions, or of positions and constants.
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
    // Constants may be forces: they count if positions alone do not cancel.
    places.count() > 0 && (is_zero(own) || is_zero(all)) || are_weighted(symbols, e, terms)
}

/// Whether positions with constant weights can be shifted together without changing their sum, as in `y - x*E1` for a
/// vector and a scalar or `x - r*φ` for two scalars. Coordinates along different axes cannot. All other terms must be
/// constants.
pub(crate) fn are_weighted(symbols: &Symbols, e: &Expr, terms: &[Expr]) -> bool {
    let mut known: Vec<(Expr, bool)> = Vec::new();
    let mut coordinates = 0;
    for t in terms {
        match weighted(symbols, t) {
            Some((place, has_weight)) => {
                let Some(own) = entries(place.shape()) else {
                    return false;
                };
                if !known.iter().any(|(other, _)| *other == place) {
                    coordinates += own;
                }
                known.push((place, has_weight));
            }
            None if is_constant(symbols, t) => {}
            None => return false,
        }
    }
    let is_free = entries(e.shape()).is_some_and(|own| coordinates > own);
    let several = known.iter().any(|(place, _)| *place != known[0].0);
    several && is_free && known.iter().any(|(_, has_weight)| *has_weight)
}

fn entries(shape: Shape) -> Option<u32> {
    match (shape.rows, shape.cols) {
        (Dim::Fixed(n), Dim::Fixed(m)) => Some(n.saturating_mul(m)),
        _ => None,
    }
}

fn is_constant(symbols: &Symbols, e: &Expr) -> bool {
    let letters = super::letters(e);
    letters
        .iter()
        .all(|l| symbols.get(l.symbol).role == Role::Parameter)
}

/// The position in a term that is linear in it and otherwise constant, and whether a factor other than a number
/// multiplies it.
fn weighted(symbols: &Symbols, term: &Expr) -> Option<(Expr, bool)> {
    let found = parts(term);
    let numbers = found.numbers.iter().map(|(f, q)| (f, *q));
    let matrices = found.matrices.iter().map(|f| (f, Rational::ONE));
    let mut place = None;
    let mut has_weight = false;
    for (factor, q) in numbers.chain(matrices) {
        if is_constant(symbols, factor) {
            has_weight = true;
            continue;
        }
        let own = match factor.node() {
            Node::Dot(a, b) if is_constant(symbols, a) => is_place(symbols, b).then_some((b, true)),
            Node::Dot(a, b) if is_constant(symbols, b) => is_place(symbols, a).then_some((a, true)),
            _ => is_place(symbols, factor).then_some((factor, false)),
        };
        let (own, along) = own.filter(|_| q.is_one() && place.is_none())?;
        place = Some(own.clone());
        has_weight |= along;
    }
    place.map(|place| (place, has_weight))
}

/// Whether it is the value of a field, or the position of a rigid motion.
fn is_place(symbols: &Symbols, e: &Expr) -> bool {
    let element = |e: &Expr, general: bool| match e.node() {
        Node::Letter(l) => {
            let symbol = symbols.get(l.symbol);
            symbol.role == Role::Element && (symbol.structure == Structure::General) == general
        }
        _ => false,
    };
    match e.node() {
        Node::Map(Map::Translation, a) => element(a, false),
        _ => element(e, true),
    }
}

fn is_zero(mut all: impl Iterator<Item = Rational>) -> bool {
    let total = all.try_fold(Rational::ZERO, |a, b| a.plus(b));
    total.is_some_and(Rational::is_zero)
}

/// The kind of a term of a sum, up to a numeric factor.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Bare {
    Place,
    Constant,
}

fn bare(symbols: &Symbols, term: &Expr) -> Option<(Rational, Bare)> {
    let found = parts(term);
    let only = match (found.matrices.as_slice(), found.numbers.as_slice()) {
        ([only], []) => only,
        // A scalar field is among the scalar factors.
        ([], [(only, q)]) if q.is_one() => only,
        _ => return None,
    };
    let kind = match only.node() {
        _ if is_place(symbols, only) => Bare::Place,
        Node::Letter(l) => {
            let symbol = symbols.get(l.symbol);
            let constant = symbol.role == Role::Parameter && symbol.structure == Structure::General;
            constant.then_some(Bare::Constant)?
        }
        _ => return None,
    };
    Some((found.coefficient, kind))
}

/// The constants in such differences, if the positions do not cancel without them.
pub(crate) fn centres(symbols: &Symbols, e: &Expr, out: &mut Vec<Letter>) {
    e.children()
        .into_iter()
        .for_each(|a| centres(symbols, a, out));
    if !is_between(symbols, e) {
        return;
    }
    let Node::Sum(terms) = e.node() else { return };
    // Positions with weights cancel among themselves, without a constant.
    if are_weighted(symbols, e, terms) {
        return;
    }
    let bare_terms = terms.iter().filter_map(|t| bare(symbols, t));
    let places = bare_terms.filter(|(_, kind)| *kind == Bare::Place);
    // If positions cancel among themselves, the constant is a length.
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

/// Such a difference with positions first, so that they cancel before anything is added.
pub(crate) fn first(symbols: &Symbols, e: Expr) -> Expr {
    let Node::Sum(terms) = e.node() else { return e };
    if terms.len() < 3 || !is_between(symbols, &e) {
        return e;
    }
    let rank = |t: &Expr| match bare(symbols, t) {
        Some((_, Bare::Place)) => 0,
        Some((_, Bare::Constant)) => 1,
        None if weighted(symbols, t).is_some() => 0,
        None => 2,
    };
    let mut terms = terms.clone();
    terms.sort_by_key(rank);
    sum(terms, e.shape())
}

/// An expression with letters for such differences.
pub(crate) struct NamedDifferences {
    /// The symbols of the expression, with these letters.
    pub(crate) symbols: Symbols,
    /// The expression.
    pub(crate) whole: Expr,
    /// The expressions that the letters replace.
    pub(crate) definitions: Vec<(Letter, Expr)>,
}

/// The expression with a letter for each such difference. `None` if there are none.
pub(crate) fn named(symbols: &Symbols, e: &Expr) -> Option<NamedDifferences> {
    let mut all = symbols.clone();
    let mut definitions = Vec::new();
    let whole = name(symbols, &mut all, &mut definitions, e);
    (!definitions.is_empty()).then_some(NamedDifferences {
        symbols: all,
        whole,
        definitions,
    })
}

fn name(s: &Symbols, all: &mut Symbols, found: &mut Vec<(Letter, Expr)>, e: &Expr) -> Expr {
    if !is_between(s, e) {
        let children = e.children().into_iter();
        let mut children = children
            .map(|x| name(s, all, found, x))
            .collect::<Vec<_>>()
            .into_iter();
        // Only `all` contains the letters of the names.
        return rebuild(all, e, &mut |x| {
            children.next().unwrap_or_else(|| x.clone())
        });
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
