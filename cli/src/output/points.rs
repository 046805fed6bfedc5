//! Which fields are points of the plane or of space: vectors that move, but no diagonals of matrices, which are kept as
//! vectors. Takes a card; gives the names of the latter.

use clebsch::card::{Card, Field, Kind};
use clebsch_core::expr::symbol::ascii;
use clebsch_core::pipeline;
use clebsch_core::syntax::ast::Statement;
use std::collections::HashSet;

/// The fields of a model that are diagonals.
pub(crate) struct Diagonals(HashSet<String>);

impl Diagonals {
    /// As the model is stated.
    pub(crate) fn of(card: &Card) -> Self {
        let model = pipeline::parse_source(card.source).ok();
        let statements = model.iter().flat_map(|m| &m.statements);
        let names = statements.filter_map(|s| match s {
            Statement::Field { names, shape, .. } if shape.name.text == "Diag" => Some(names),
            _ => None,
        });
        Self(names.flatten().map(|n| ascii(&n.text)).collect())
    }

    /// Whether it is a point, behind which this is shown.
    pub(crate) fn leave(&self, field: &Field, behind: Option<Kind>) -> bool {
        behind == Some(Kind::FieldMomentum)
            && field.cols == 1
            && [2, 3].contains(&field.rows)
            && !self.0.contains(field.ascii)
    }
}
