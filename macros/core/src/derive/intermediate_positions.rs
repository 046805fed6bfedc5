//! Positions of fields between two nodes, such as `(next(y) + y)/2`. A power of such a sum has few rounding errors, but
//! its expansion consists of large terms that cancel if the field oscillates fast. Takes expressions; gives a form that
//! is reduced with each of these sums as a letter.

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
    let found = expr::substitute(&names.symbols, &reduced, &names.definitions);
    (!inner.exhausted()).then_some(found)
}

struct Names {
    symbols: Symbols,
    definitions: Vec<(Letter, Expr)>,
}

impl Names {
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
