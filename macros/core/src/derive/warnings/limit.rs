//! Whether the action of a step has a limit of small steps. Takes the derived limit; gives the warning with its
//! reason if there is none.

use super::terms::{action_of, place, typed};
use super::{Inputs, Topic, Warning};
use crate::algebra::Algebra;
use crate::derive::action::Action;
use crate::derive::limit::{self, Limit};
use crate::diagnostic::Diagnostic;
use crate::expr::{self, Expr};

/// The warning, if the limit does not exist.
pub(super) fn limit(x: &Inputs) -> Option<Warning> {
    let why = x.limit.as_ref().err()?;
    if [limit::NOT_QUADRATIC, limit::DRIVEN].contains(&why.as_str()) {
        return None;
    }
    // A model for all matrices may have a limit for symmetric ones.
    if let Some(action) = x.for_symmetric_matrices(x.action) {
        let algebra = x.engine();
        let special = limit_of(x, &action, &algebra);
        if special.is_ok() || algebra.exhausted() {
            return None;
        }
    }
    if *why == limit::INSIDE {
        let d = Diagnostic::new(
            x.spec.lagrangian_place,
            format!("clebsch cannot find the limit of small steps: {why}, and clebsch does not expand such terms"),
        )
        .help(
            "take the step out of it, for example write `c*h*sqrt(1 - x/(c*h)^2)` for `sqrt(c^2*h^2 - x)`: apart from \
             velocities `(next(X) - X)/h`, the rest must not contain `h`",
        );
        return Some(Warning::new(Topic::NoLimit, d));
    }
    let [kinetic, potential] = x.examples();
    let (addends, all) = typed(x);
    let term = blamed(x, &addends, why).or_else(|| blamed(x, &all, why));
    let d = Diagnostic::new(
        place(x, term.as_ref()),
        format!("the discrete Lagrangian has no limit of small steps: {why}"),
    )
    .help(format!(
        "the Lagrangian is (kinetic - potential energy) times the step: divide kinetic terms by `h` and multiply potentials by \
         `h`, as in `{kinetic} - {potential}`"
    ));
    Some(Warning::new(Topic::NoLimit, d))
}

/// The warning about a Lagrangian per unit time, which must be multiplied by the step size, such as `m*v^2/2 - V`
/// with `v = (next(x) - x)/h`.
pub(super) fn per_unit_time(x: &Inputs) -> Option<Warning> {
    if x.limit.as_ref().err()? != limit::STANDING {
        return None;
    }
    let s = &x.letters.symbols;
    let algebra = x.engine();
    let of_step = |e: &Expr| {
        let action = action_of(x, &expr::mul(expr::here(s, x.spec.step), e.clone()));
        limit_of(x, &action, &algebra)
    };
    let whole = of_step(&x.spec.typed).ok()?;
    // A potential that already contains the step size would vanish.
    let vanishes = |term: &Expr| of_step(term).is_ok_and(|limit| limit.lagrangian.is_zero());
    let (_, all) = typed(x);
    if whole.kinetic.is_zero() || all.iter().any(vanishes) || algebra.exhausted() {
        return None;
    }
    let h = &s.get(x.spec.step).name;
    let d = Diagnostic::new(
        x.spec.lagrangian_place,
        format!(
            "this Lagrangian is per unit time: the discrete Lagrangian of a step is `{h}` times it"
        ),
    );
    let help = format!("multiply by the step: `lagrangian = {h}*(...);`");
    Some(Warning::new(Topic::NoLimit, d.help(help)))
}

/// The limit of small steps of an action of this model.
fn limit_of(x: &Inputs, action: &Action, algebra: &Algebra<'_>) -> Result<Limit, String> {
    limit::limit(x.spec, x.letters, action, x.variations, x.assumed, algebra)
}

/// The first term without a limit of its own, for the same reason; None if this holds for every term.
fn blamed(x: &Inputs, terms: &[Expr], why: &str) -> Option<Expr> {
    let without = |term: &&Expr| {
        let algebra = x.engine();
        let action = action_of(x, term);
        let found = limit_of(x, &action, &algebra);
        !algebra.exhausted() && found.is_err_and(|own| own == why)
    };
    let own: Vec<&Expr> = terms.iter().filter(without).collect();
    match own.len() == terms.len() {
        true => None,
        false => own.first().map(|term| (*term).clone()),
    }
}
