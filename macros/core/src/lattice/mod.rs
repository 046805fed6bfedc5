//! Models with labels: chains, rods, rings and sets of bodies from one statement. A model with labels is expanded,
//! for chosen numbers of sites and end conditions, to a model of as many bodies. The rest of the engine treats it
//! like any other model. The equations printed for every number of sites are recovered from a short chain, on which
//! each equation already has all its neighbours.

mod chain_config;
mod declared;
mod mesh;
mod names;
mod parts;
mod range;
mod substitution;
mod summands;
#[cfg(test)]
mod tests;
mod unfold;
pub mod value;

pub use chain_config::{ChainConfig, Refusal};
pub use declared::{Kind, Label, Lattice, Quantity, Sites};
pub use mesh::{FunctionalKind, Mesh, Source};
pub use names::{Copied, copy_name};
pub(crate) use parts::holds_sums;
pub use range::Range;
pub(crate) use substitution::any_name;
pub use unfold::{ExpandedModel, StatedHold, StatedTotal, Summand, Summed, unfold};
pub(crate) use unfold::{LARGEST, definitions, inlined};

use crate::diagnostic::Diagnostic;
use crate::syntax::ast::{Model, Statement};

/// Whether a model is declared with labels.
pub fn has_labels(model: &Model) -> bool {
    model.statements.iter().any(|s| match s {
        Statement::Label { .. }
        | Statement::Periodic(_)
        | Statement::End { .. }
        | Statement::Grid(_)
        | Statement::Mesh { .. } => true,
        Statement::Field {
            domain: Some(_), ..
        } => true,
        Statement::Param { at, .. }
        | Statement::Group { at, .. }
        | Statement::Field { at, .. }
        | Statement::Advected { at, .. } => at.is_some(),
        Statement::Dim { .. }
        | Statement::Time { .. }
        | Statement::Assume { .. }
        | Statement::Constraint { .. }
        | Statement::Hold { .. }
        | Statement::Given { .. }
        | Statement::Let { .. }
        | Statement::Scale(_)
        | Statement::Node(..)
        | Statement::Lagrangian(_) => false,
    })
}

/// The error for a model with labels for which no stepper for every number of sites is compiled, with the reason.
pub fn not_emitted(model: &Model, why: &str) -> Diagnostic {
    let label = model.statements.iter().find_map(|s| match s {
        Statement::Label { index, .. } => Some(index.place),
        _ => None,
    });
    let message = format!("clebsch cannot compile a stepper for every number of sites: {why}");
    let functional = model.statements.iter().find_map(|s| match s {
        Statement::Mesh { name, .. } => Some(name.place),
        _ => None,
    });
    if let Some(place) = functional {
        return Diagnostic::new(place, message).help(
            "a model with functionals of all sites has no other stepper, so state the model without this; `clebsch derive \
             FILE` prints its equations",
        );
    }
    Diagnostic::new(label.unwrap_or(model.name.place), message).help(
        "put the model into a file: `clebsch derive FILE` prints its equations, `clebsch run FILE` runs it",
    )
}
