//! The residual of the derived equations of a model: the program that the macro emits as `balance`, evaluated on numbers. Takes
//! parameters, and configurations at three nodes; gives one component per direction.

use super::text_model::Given;
use clebsch::card::{Card, Field, Kind};
use clebsch_core::interpret::Assignment;
use clebsch_core::{Derivation, derive_source};
use clebsch_oracle::oracle::action::quaternions::left;

/// The equations of a model.
pub(crate) struct DerivedResidual {
    card: Card,
    derivation: Derivation,
}

impl DerivedResidual {
    pub(crate) fn of(card: Card) -> Self {
        let derivation = derive_source(card.source).unwrap_or_else(|e| panic!("{e}"));
        Self { card, derivation }
    }

    /// The residual with step size `h`. Each node has its configurations, and its advected quantities without a definition.
    pub(crate) fn at(&self, h: f64, parameters: &Given, nodes: &[Given; 3]) -> Vec<f64> {
        let sizes = self.card.dimensions.iter().map(|d| d.value).collect();
        let mut values = Assignment::new().sized(sizes);
        values.set_scalar("h", h);
        put(&mut values, self.card.parameters, 0, parameters);
        for (level, node) in [-1, 0, 1].into_iter().zip(nodes) {
            put(&mut values, self.card.initial, level, node);
        }
        self.derivation
            .residual(&values)
            .expect("all values are given")
    }
}

/// Sets the values of those fields that have one.
fn put(values: &mut Assignment, fields: &[Field], level: i8, given: &Given) {
    for field in fields {
        let Some((_, list)) = given.iter().find(|(name, _)| name == field.name) else {
            continue;
        };
        match field.kind {
            Kind::UnitQuaternion => {
                let q = [list[0], list[1], list[2], list[3]];
                values.set(field.name, level, 4, 4, &left(q).0.concat());
            }
            _ => values.set(field.name, level, field.rows, field.cols, list),
        }
    }
}
