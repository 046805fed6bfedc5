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

/// The reduced form of an expression in which such positions remain sums. `None` if it is linear in all of them, or if a
/// field cancels in the form `short`, in which these sums are expanded.
pub(super) fn reduced(algebra: &Algebra, e: &Expr, short: &Expr) -> Option<Expr> {
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
    let found = expr::sum(apart.chain([expanded]).collect::<Vec<_>>(), e.shape());
    let known = expr::letters(short);
    let remain = expr::letters(&found).iter().all(|l| known.contains(l));
    remain.then_some(found)
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
    use crate::expr::{self, Expr, Node};

    /// Whether a power of the value of a field occurs outside of such a sum.
    fn has_expanded_power(symbols: &Symbols, e: &Expr) -> bool {
        let is_value = |e: &Expr| match e.node() {
            Node::Letter(l) => symbols.get(l.symbol).role == Role::Element,
            _ => false,
        };
        let numbers = expr::parts(e).numbers;
        let is_power = numbers
            .iter()
            .any(|(factor, q)| is_value(factor) && q.value() > 1.0);
        let mut children = e.children().into_iter();
        is_power || !is_intermediate(symbols, e) && children.any(|x| has_expanded_power(symbols, x))
    }

    fn expands(lagrangian: &str) -> bool {
        let text = format!(
            "model Stiff {{ param m, k, a: Real; field x, y: Real;
            let X = (next(x) + x)/2; let Y = (next(y) + y)/2;
            let u = (next(x) - x)/h; let v = (next(y) - y)/h;
            lagrangian = h*({lagrangian}); }}"
        );
        let d = derive_source(&text).unwrap_or_else(|e| panic!("{e:?}"));
        let mut momenta = d.balances.iter().map(|balance| &balance.outgoing);
        momenta.any(|momentum| has_expanded_power(&d.letters.symbols, momentum))
    }

    /// The expanded cube of a midpoint is rounded relative to the position, although the midpoint is near zero if the
    /// field oscillates fast. Several terms with the inverse of the step size are combined before the derivation.
    #[test]
    fn powers_of_midpoints_stay_powers() {
        assert!(!expands(
            "m*(1 + Y^2)*u^2/2 + m*(2 + sin(X))*v^2/2 - k*Y^4/4 - k*X^2/2 - a*X*Y"
        ));
    }

    /// A kinetic energy that is spelled out does not depend on the position.
    #[test]
    fn fields_that_cancel_do_not_remain() {
        let kinetic = "m*(next(y)^2 - 2*next(y)*y + y^2)/(2*h^2)";
        assert!(!expands(&format!("{kinetic} + m*u^2/2 - k*Y^4/4")));
    }

    /// For a long increment, the terms of third order in it cancel.
    #[test]
    fn products_with_the_own_increment_are_expanded() {
        assert!(expands("(m + a*Y^2)*v^2/2 + m*u^2/2 + a*cos(X)*u^2/2"));
    }
}
