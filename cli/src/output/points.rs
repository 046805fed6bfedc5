//! Tells which fields are points of the plane or of space: moving vectors, except the diagonals of matrices, which
//! are stored as vectors. Also tells which matrices are invertible maps. Takes a card; gives the names of diagonals
//! and of maps.

use clebsch::card::{Card, Field, Kind};
use std::collections::HashSet;

/// The fields of a model that are diagonals.
pub(crate) struct Diagonals(HashSet<&'static str>);

impl Diagonals {
    /// Reads the text of the model.
    pub(crate) fn of(card: &Card) -> Self {
        // The source of a card declares them as vectors and uses them as `diag(D)`.
        let text: String = card.source.split_whitespace().collect();
        let stated = |name: &str| text.contains(&format!("diag({name})"));
        let fields = card.observables.iter().filter(|f| stated(f.name));
        Self(fields.map(|f| f.ascii).collect())
    }

    /// Whether a field is such a diagonal.
    pub(crate) fn have(&self, field: &Field) -> bool {
        self.0.contains(field.ascii)
    }

    /// Whether it is a point; `behind` is the kind of the next field.
    pub(crate) fn leave(&self, field: &Field, behind: Option<Kind>) -> bool {
        behind == Some(Kind::FieldMomentum)
            && field.cols == 1
            && [2, 3].contains(&field.rows)
            && !self.have(field)
    }
}

/// The elements of GL(n) of a model.
pub(crate) struct Linear(HashSet<&'static str>);

impl Linear {
    /// Reads the text of the model.
    pub(crate) fn of(card: &Card) -> Self {
        let text: String = card.source.split_whitespace().collect();
        let stated = |name: &str| text.contains(&format!("group{name}:GL<"));
        let fields = card.observables.iter().filter(|f| stated(f.name));
        Self(fields.map(|f| f.ascii).collect())
    }

    /// Whether a field is such a map.
    pub(crate) fn have(&self, field: &Field) -> bool {
        self.0.contains(field.ascii)
    }
}
