//! Whether the action of a step has a limit of small steps. Takes the limit as derived; gives the
//! warning that there is none, with what keeps it from having one.

use super::{Inputs, Topic, Warning};
use crate::derive::limit;
use crate::diagnostic::Diagnostic;

/// The warning, if there is no limit.
pub(super) fn limit(x: &Inputs) -> Option<Warning> {
    let why = x.limit.as_ref().err()?;
    if [limit::NOT_QUADRATIC, limit::DRIVEN].contains(&why.as_str()) {
        return None;
    }
    // Of a model for all matrices those that are symmetric may have one.
    if let Some(action) = x.for_symmetric_matrices(x.action) {
        let algebra = x.engine();
        let special = limit::limit(
            x.spec,
            x.letters,
            &action,
            x.variations,
            x.assumed,
            &algebra,
        );
        if special.is_ok() || algebra.exhausted() {
            return None;
        }
    }
    if *why == limit::INSIDE {
        let d = Diagnostic::new(
            x.spec.lagrangian_place,
            format!("no limit of small steps is seen: {why}, and what stands there is not expanded"),
        )
        .help(
            "take the step out, as of `sqrt(c^2*h^2 - x)` by `c*h*sqrt(1 - x/(c*h)^2)`: what is left \
             inside must be free of `h` for the velocity `(next(X) - X)/h`",
        );
        return Some(Warning::new(Topic::NoLimit, d));
    }
    let [kinetic, potential] = x.examples();
    let d = Diagnostic::new(
        x.spec.lagrangian_place,
        format!("the discrete Lagrangian has no limit of small steps: {why}"),
    )
    .help(format!(
        "the Lagrangian states (kinetic - potential energy) times the step: kinetic terms are \
         divided by `h`, potentials multiplied by `h`, as in `{kinetic} - {potential}`"
    ));
    Some(Warning::new(Topic::NoLimit, d))
}
