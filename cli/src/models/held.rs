//! Constraints that a model holds: whether it has some, and what a case of such a model is told.

use clebsch::card::Card;
use clebsch_core::pipeline;
use clebsch_core::syntax::ast::{Model, Statement};

/// Whether the model of a card holds constraints.
pub(crate) fn is_held(card: &Card) -> bool {
    pipeline::parse_source(card.source).is_ok_and(|model| has_holds(&model))
}

/// What a case of such a model is told at its head.
pub(crate) const OF_HELD: &str = "Constraints are held: the initial configuration must satisfy them, and momenta must belong to velocities along them.";

/// Whether configurations are held by constraints, across which no momentum may point: samples are at rest.
pub(crate) fn has_holds(model: &Model) -> bool {
    let mut statements = model.statements.iter();
    statements.any(|s| matches!(s, Statement::Hold { .. }))
}
