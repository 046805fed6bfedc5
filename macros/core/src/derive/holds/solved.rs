//! Constraints solved for letters that they contain linearly, positions of bodies before parameters: after
//! substitution, an expression keeps its value wherever the constraints are satisfied. Takes the constraints; gives
//! these letters in terms of the others.

use super::here;
use crate::algebra::Algebra;
use crate::check::spec::{Hold, Spec};
use crate::derive::Letters;
use crate::expr::symbol::{Role, SymbolId};
use crate::expr::{self, Expr, Letter, Node};

/// Letters that the constraints determine, expressed by the remaining letters.
pub(crate) struct Solved(Vec<(Letter, Expr)>);

impl Solved {
    /// Solves one constraint after the other. Constraints without such a letter are skipped.
    pub(crate) fn of(spec: &Spec, letters: &Letters, algebra: &Algebra) -> Solved {
        let s = &letters.symbols;
        let mut all: Vec<(Letter, Expr)> = Vec::new();
        for (hold, held) in spec.holds.iter().zip(&letters.held) {
            let value = expr::substitute(s, &hold.value, &all);
            let found = candidates(spec, letters, hold).find_map(|letter| {
                Some((
                    letter,
                    solution(letters, &value, letter, held.direction, algebra)?,
                ))
            });
            let Some(found) = found else { continue };
            for (_, known) in &mut all {
                *known = expr::substitute(s, known, std::slice::from_ref(&found));
            }
            all.push(found);
        }
        Solved(all)
    }

    /// The determined letters with their values.
    pub(crate) fn list(&self) -> &[(Letter, Expr)] {
        &self.0
    }

    /// Whether an expression vanishes wherever the constraints hold.
    pub(super) fn vanishes(&self, e: &Expr, algebra: &Algebra) -> bool {
        if algebra.is_zero(e) {
            return true;
        }
        !self.0.is_empty() && algebra.is_zero(&expr::substitute(algebra.symbols(), e, &self.0))
    }
}

/// Letters in a constraint that have its shape and may take any value: additive configurations, then parameters; in
/// each group, the last declared comes first.
fn candidates(spec: &Spec, letters: &Letters, hold: &Hold) -> impl Iterator<Item = Letter> {
    let s = &letters.symbols;
    let found = expr::letters(&hold.value);
    let fits = |id: &SymbolId| {
        s.get(*id).shape == hold.value.shape() && found.iter().any(|l| l.symbol == *id)
    };
    let additive = spec.configurations.iter().filter(|c| c.group.is_additive());
    let places = additive.map(|c| c.element).rev();
    let parameters = spec.parameters.iter().rev().copied();
    let free = parameters.filter(|id| {
        let symbol = s.get(*id);
        symbol.role == Role::Parameter && symbol.shape.is_vector()
    });
    let all: Vec<Letter> = places.chain(free).filter(fits).map(here).collect();
    all.into_iter()
}

/// The value of the letter at which `value` vanishes, if the letter occurs once, multiplied by invertible factors.
/// `direction` is an unused letter of the same shape.
fn solution(
    letters: &Letters,
    value: &Expr,
    letter: Letter,
    direction: SymbolId,
    algebra: &Algebra,
) -> Option<Expr> {
    let s = &letters.symbols;
    let nothing = expr::zero(value.shape());
    let rest = expr::substitute(s, value, &[(letter, nothing)]);
    if expr::contains(&rest, letter) {
        return None;
    }
    let direction = expr::here(s, direction);
    let change = expr::directional(s, value, &[(letter, direction.clone())]);
    let found = [expr::neg(rest.clone()), rest.clone()]
        .into_iter()
        .zip([change.clone(), expr::neg(change.clone())])
        .find_map(|(found, along)| {
            let plain = algebra.is_zero(&expr::sub(along, direction.clone()));
            plain.then_some(found)
        });
    let found = found.or_else(|| {
        let (is_negative, factor) = factor(s, &change, &direction)?;
        let found = expr::mul(expr::inverse(s, factor), rest);
        Some(if is_negative { found } else { expr::neg(found) })
    })?;
    let checked = expr::substitute(s, value, &[(letter, found.clone())]);
    (!expr::contains(&found, letter) && algebra.is_zero(&checked)).then_some(found)
}

/// The invertible factor before the direction, and whether its sign is negative.
fn factor(s: &expr::symbol::Symbols, change: &Expr, direction: &Expr) -> Option<(bool, Expr)> {
    let (is_negative, e) = match change.node() {
        Node::Neg(inner) => (true, inner),
        _ => (false, change),
    };
    let Node::Product(factors) = e.node() else {
        return None;
    };
    let (last, before) = factors.split_last()?;
    let factor = expr::product(before.iter().cloned());
    let fits = last == direction && expr::is_invertible(s, &factor);
    fits.then_some((is_negative, factor))
}
