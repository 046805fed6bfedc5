//! Constraints of a model: whether it has any, and the remark for its cases.

use clebsch::card::Card;
use clebsch_core::pipeline;
use clebsch_core::syntax::ast::{Model, Statement};

/// Whether the model of a card has constraints.
pub(crate) fn card_has_constraints(card: &Card) -> bool {
    pipeline::parse_source(card.source).is_ok_and(|model| has_constraints(&model))
}

/// The remark at the head of a case if the model has constraints.
pub(crate) const CONSTRAINTS_REMARK: &str = "Initial positions must satisfy the constraints, and initial velocities must be tangent to them.";

/// Whether a model has constraints. A momentum must be tangent to them, so sample cases start at rest.
pub(crate) fn has_constraints(model: &Model) -> bool {
    let mut statements = model.statements.iter();
    statements.any(|s| matches!(s, Statement::Hold { .. }))
}
