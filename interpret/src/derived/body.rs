//! A model of bodies as data: its emitted program and its warnings.

use super::{Data, json};
use crate::Refused;
use clebsch_core::derive::select_solver::Method;
use clebsch_core::diagnostic::Report;
use clebsch_core::{Derivation, derive_source, emit};
use serde_json::{Value, json};

/// A model of bodies. Its program is the same for all sizes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Body {
    /// The name of the model.
    pub name: String,
    /// The emitted items.
    pub program: String,
    /// Whether Newton's method solves a step.
    pub has_newton: bool,
    /// Warnings on its text.
    pub warnings: Vec<Report>,
}

impl Body {
    /// Derives a text.
    ///
    /// # Errors
    /// [`Refused`], if the text is not a valid model or the model does not have a stepper.
    pub fn derive(source: &str) -> Result<Self, Refused> {
        let d = derive_source(source).map_err(Refused::Model)?;
        let warnings = d.warnings.iter().map(|w| w.diagnostic.report()).collect();
        Self::of(&d, warnings)
    }

    /// The emitted program of a derivation.
    ///
    /// # Errors
    /// [`Refused`], if the model does not have a stepper.
    pub fn of(d: &Derivation, warnings: Vec<Report>) -> Result<Self, Refused> {
        if let Some(refused) = emit::refusal_of_read(d) {
            return Err(Refused::Model(refused.into()));
        }
        Ok(Body {
            name: d.spec.name.clone(),
            program: emit::emit(d, false).to_string(),
            has_newton: matches!(d.solve.method, Method::Newton | Method::Blocks),
            warnings,
        })
    }
}

impl Data for Body {
    const KIND: &'static str = "body";

    fn to_json(&self) -> Value {
        json!({
            "name": self.name,
            "program": self.program,
            "has_newton": self.has_newton,
            "warnings": json::of_reports(&self.warnings),
        })
    }

    fn from_json(json: &Value) -> Option<Self> {
        Some(Body {
            name: json::text(json, "name")?,
            program: json::text(json, "program")?,
            has_newton: json::truth(json, "has_newton")?,
            warnings: json::reports(json, "warnings")?,
        })
    }
}
