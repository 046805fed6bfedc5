//! How the configuration determines the advected quantities: by their definition, or by their constraint with the
//! group element in place of its velocity, applied to a constant reference value. Recomputing the quantities in this
//! way prevents rounding errors from accumulating.

use super::Letters;
use super::variation::at;
use crate::algebra::Algebra;
use crate::check::spec::{Advected, Spec};
use crate::diagnostic::{Diagnostic, Errors};
use crate::expr::{self, Expr, Letter, Shift};

/// The value of one advected quantity at a node.
#[derive(Clone, Debug)]
pub enum AdvectionRule {
    /// Its definition: group elements and parameters.
    Defined(Expr),
    /// The action on a constant reference value; the quantity's own letter denotes the reference value.
    Carried {
        /// The value at a node, with elements acting on the reference value.
        value: Expr,
        /// The reference value, with inverse elements acting on the value at node 0.
        reference: Expr,
    },
    /// Neither: the constraint itself advances the quantity.
    Advanced,
}

/// The rules of all advected quantities. A definition that contradicts its constraint is an error.
pub fn transports(
    spec: &Spec,
    letters: &Letters,
    algebra: &Algebra,
) -> Result<Vec<AdvectionRule>, Errors> {
    let mut errors = Errors::new();
    let mut out = Vec::new();
    for a in &spec.advected {
        match &a.definition {
            Some(d) => {
                check_definition(spec, letters, algebra, a, d, &mut errors);
                out.push(AdvectionRule::Defined(d.clone()));
            }
            None => out.push(carried(spec, letters, algebra, a)),
        }
    }
    errors.propagate()?;
    Ok(out)
}

/// Group elements at the next node, by their constraints.
fn next_elements(spec: &Spec) -> Vec<(Letter, Expr)> {
    let list = spec.configurations.iter();
    list.map(|c| (at(c.element, Shift::NEXT), c.update.clone()))
        .collect()
}

fn check_definition(
    spec: &Spec,
    letters: &Letters,
    algebra: &Algebra,
    a: &Advected,
    definition: &Expr,
    errors: &mut Errors,
) {
    let s = &letters.symbols;
    let next = expr::shift_time(s, definition, Shift::NEXT.time);
    let by_definition = expr::substitute(s, &next, &next_elements(spec));
    let own: Vec<(Letter, Expr)> = spec
        .advected
        .iter()
        .filter_map(|b| Some((at(b.quantity, Shift::HERE), b.definition.clone()?)))
        .collect();
    let by_constraint = expr::substitute(s, &a.update, &own);
    let difference = expr::sub(by_constraint, by_definition.clone());
    if algebra.is_zero(&difference) || algebra.exhausted() {
        return;
    }
    let rest = algebra.lower(&difference);
    let name = &s.get(a.quantity).name;
    let style = crate::print::Style::new(&spec.time_index);
    let show = |e: &Expr| crate::print::expression(e, s, &style, crate::print::Format::Text);
    let by_definition = show(&algebra.raise(&algebra.lower(&by_definition)));
    let mut d = Diagnostic::new(
        a.definition_place.unwrap_or(a.place),
        format!("the definition of `{name}` contradicts its constraint: at the next node it gives {by_definition}, and the two \
            differ by {}", show(&algebra.raise(&rest))),
    )
    .help(match spec.has_only_fields() {
        true => "correct one of the two; for a field `X`, the constraint of `Y = X - a` is `next(Y) = Y + (next(X) - X)`",
        false => "correct one of the two; for `next(Λ) = Λ * Ω`, the constraint of `Γ = Λ^T * z` is `next(Γ) = Ω^T * Γ`",
    });
    d = d.also(a.place, format!("the constraint of `{name}` is here"));
    errors.push(d);
}

/// Reads the constraint as a group action and checks that it is one: acting by `Λ` and then by `Ω` equals acting by
/// `next(Λ)`.
fn carried(spec: &Spec, letters: &Letters, algebra: &Algebra, a: &Advected) -> AdvectionRule {
    let s = &letters.symbols;
    let others = expr::letters(&a.update).iter().any(|l| {
        let advected = spec.advected.iter().any(|b| b.quantity == l.symbol);
        advected && l.symbol != a.quantity
    });
    if others {
        return AdvectionRule::Advanced;
    }
    let by = |f: &dyn Fn(&crate::check::spec::Configuration) -> Expr| {
        let list: Vec<(Letter, Expr)> = spec
            .configurations
            .iter()
            .map(|c| (at(c.velocity, Shift::HERE), f(c)))
            .collect();
        expr::substitute(s, &a.update, &list)
    };
    let value = by(&|c| expr::here(s, c.element));
    let reference = by(&|c| c.group.inverse(s, expr::here(s, c.element)));
    let twice = expr::substitute(
        s,
        &a.update,
        &[(at(a.quantity, Shift::HERE), value.clone())],
    );
    let once = by(&|c| {
        let (g, w) = (expr::here(s, c.element), expr::here(s, c.velocity));
        c.group.advanced(c.side, g, w)
    });
    let back = expr::substitute(
        s,
        &value,
        &[(at(a.quantity, Shift::HERE), reference.clone())],
    );
    let own = expr::here(s, a.quantity);
    if algebra.equal(&twice, &once) && algebra.equal(&back, &own) {
        AdvectionRule::Carried { value, reference }
    } else {
        AdvectionRule::Advanced
    }
}
