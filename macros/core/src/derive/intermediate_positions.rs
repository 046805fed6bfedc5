//! Positions of fields between two nodes, such as `(next(y) + y)/2`. A power of such a sum has few rounding errors, but
//! its expansion consists of large terms that cancel if the field oscillates fast. Takes expressions; gives a form that
//! is reduced with each of these sums as a letter.
//!
//! Terms linear in such a sum are expanded, so that they combine with other linear terms. Products with the increment of
//! the same field are expanded, too: in the momentum of a mass that depends on the position, their largest terms cancel
//! exactly if the increment is long.

use super::action::summands;
use crate::algebra::Algebra;
use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter, Node, Shift};

/// The reduced form of an expression in which such positions remain sums. `None` if it is linear in all of them.
pub(super) fn reduced(algebra: &Algebra, e: &Expr) -> Option<Expr> {
    let mut names = Names {
        symbols: algebra.symbols().clone(),
        definitions: Vec::new(),
    };
    let whole = names.replace(e);
    let is_nonlinear = |(letter, _): &(Letter, Expr)| {
        let itself = expr::letter(&names.symbols, letter.symbol, Shift::HERE);
        let scaled = |e: &Expr| expr::directional(&names.symbols, e, &[(*letter, itself.clone())]);
        // A term of first order is its own derivative along the letter.
        let first = scaled(&whole);
        first != scaled(&first)
    };
    if !names.definitions.iter().any(is_nonlinear) {
        return None;
    }
    let inner = Algebra::new(&names.symbols);
    let reduced = inner.shortest(&whole);
    if inner.exhausted() {
        return None;
    }
    let defined = |e: &Expr| expr::substitute(&names.symbols, e, &names.definitions);
    let (mixed, apart): (Vec<Expr>, Vec<Expr>) = summands(&names.symbols, &reduced)
        .into_iter()
        .partition(|term| names.mixes(term) || names.is_linear(term));
    if apart.is_empty() {
        return None;
    }
    let expanded = algebra.shortest(&defined(&expr::sum(mixed, e.shape())));
    let apart = apart.iter().map(defined);
    Some(expr::sum(
        apart.chain([expanded]).collect::<Vec<_>>(),
        e.shape(),
    ))
}

struct Names {
    symbols: Symbols,
    definitions: Vec<(Letter, Expr)>,
}

impl Names {
    /// Whether a term contains such a position and the increment of the same field.
    fn mixes(&self, term: &Expr) -> bool {
        let letters = expr::letters(term);
        let named = self.definitions.iter().filter(|(l, _)| letters.contains(l));
        let increments = |e: &Expr| {
            let all = expr::letters(e).into_iter();
            all.filter(|l| self.symbols.get(l.symbol).role == Role::Velocity)
        };
        let mut within = named.flat_map(|(_, definition)| increments(definition));
        within.any(|increment| letters.contains(&increment))
    }

    /// Whether such a position occurs in a term only once, as a factor.
    fn is_linear(&self, term: &Expr) -> bool {
        let is_named = |l: &Letter| self.definitions.iter().any(|(named, _)| named == l);
        let found = expr::parts(term);
        let numbers = found.numbers.iter().map(|(factor, q)| (factor, q.is_one()));
        let factors = numbers.chain(found.matrices.iter().map(|factor| (factor, true)));
        let mut within = factors.filter(|(factor, _)| expr::letters(factor).iter().any(is_named));
        let only = (within.next(), within.next());
        matches!(only, (Some((factor, true)), None) if matches!(factor.node(), Node::Letter(_)))
    }

    fn replace(&mut self, e: &Expr) -> Expr {
        if is_intermediate(&self.symbols, e) {
            return self.letter_of(e);
        }
        let children = e.children().into_iter().map(|x| self.replace(x));
        let children: Vec<Expr> = children.collect();
        let mut children = children.into_iter();
        expr::rebuild(&self.symbols, e, &mut |x| {
            children.next().unwrap_or_else(|| x.clone())
        })
    }

    fn letter_of(&mut self, e: &Expr) -> Expr {
        let known = self.definitions.iter().find(|(_, known)| known == e);
        let symbol = match known {
            Some((letter, _)) => letter.symbol,
            None => {
                let name = self.symbols.fresh_name("r");
                let symbol = self
                    .symbols
                    .add(&name, e.shape(), Structure::General, Role::Derived);
                let letter = Letter {
                    symbol,
                    shift: Shift::HERE,
                };
                self.definitions.push((letter, e.clone()));
                symbol
            }
        };
        expr::letter(&self.symbols, symbol, Shift::HERE)
    }
}

/// Whether it is a sum of a field and a multiple of its increment, both with numbers as factors.
fn is_intermediate(symbols: &Symbols, e: &Expr) -> bool {
    let Node::Sum(terms) = e.node() else {
        return false;
    };
    let roles = terms.iter().map(|t| {
        let found = expr::parts(t);
        let only = match (found.matrices.as_slice(), found.numbers.as_slice()) {
            ([only], []) => only,
            ([], [(only, q)]) if q.is_one() => only,
            _ => return None,
        };
        let Node::Letter(l) = only.node() else {
            return None;
        };
        let symbol = symbols.get(l.symbol);
        (symbol.structure == Structure::General).then_some(symbol.role)
    });
    let roles: Option<Vec<Role>> = roles.collect();
    let has = |role| matches!(&roles, Some(all) if all.contains(&role));
    let only = |all: &[Role]| {
        all.iter()
            .all(|r| [Role::Element, Role::Velocity].contains(r))
    };
    has(Role::Element) && has(Role::Velocity) && roles.as_deref().is_some_and(only)
}

#[cfg(test)]
mod tests {
    use super::is_intermediate;
    use crate::derive_source;
    use crate::expr::symbol::{Role, Symbols};
    use crate::expr::{Expr, Node};

    /// Whether the value of a field occurs outside of such a sum.
    fn has_separate_field(symbols: &Symbols, e: &Expr) -> bool {
        match e.node() {
            Node::Letter(l) => symbols.get(l.symbol).role == Role::Element,
            _ if is_intermediate(symbols, e) => false,
            _ => e
                .children()
                .into_iter()
                .any(|x| has_separate_field(symbols, x)),
        }
    }

    /// The expanded cube of a midpoint is rounded relative to the position, although the midpoint is near zero if the
    /// field oscillates fast. Several terms with the inverse of the step size are combined before the derivation.
    #[test]
    fn powers_of_midpoints_stay_powers() {
        let text = "model Stiff { param m, k, a: Real; field x, y: Real;
            let X = (next(x) + x)/2; let Y = (next(y) + y)/2;
            let u = (next(x) - x)/h; let v = (next(y) - y)/h;
            lagrangian = h*(m*(1 + Y^2)*u^2/2 + m*(2 + sin(X))*v^2/2 - k*Y^4/4 - k*X^2/2 - a*X*Y); }";
        let d = derive_source(text).unwrap_or_else(|e| panic!("{e:?}"));
        for balance in &d.balances {
            let symbols = &d.letters.symbols;
            assert!(
                !has_separate_field(symbols, &balance.outgoing),
                "{:?}",
                balance.outgoing
            );
        }
    }
}
