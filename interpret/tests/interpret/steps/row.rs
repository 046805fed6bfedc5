//! A model of the table: its text, its action typed by hand, and known facts about its steps.

use clebsch_oracle::oracle::step::Action;

/// Values by the names of fields.
pub type Named = std::collections::BTreeMap<&'static str, Vec<f64>>;

/// A model.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Its text.
    pub text: &'static str,
    /// Its action.
    pub action: Action,
    /// Parameters that are inertias: positive, and of the scale of masses.
    pub inertias: &'static [&'static str],
    /// Numbers and positions that stay positive.
    pub positive: &'static [&'static str],
    /// Moves random data onto the constraints.
    pub settle: fn(&mut Named),
    /// Data on which no motion depends.
    pub idle: &'static [&'static str],
    /// The number of failed steps.
    pub refused: usize,
    /// The known error, if it exceeds the bound.
    pub known: Option<f64>,
}

impl Row {
    /// A model whose steps all succeed.
    pub const fn of(text: &'static str, action: Action, inertias: &'static [&'static str]) -> Self {
        Self {
            text,
            action,
            inertias,
            positive: &[],
            settle: |_| {},
            idle: &[],
            refused: 0,
            known: None,
        }
    }

    /// With numbers that stay positive.
    #[must_use]
    pub const fn positive(self, positive: &'static [&'static str]) -> Self {
        Self { positive, ..self }
    }

    /// With data that are moved onto the constraints.
    #[must_use]
    pub const fn settled(self, settle: fn(&mut Named)) -> Self {
        Self { settle, ..self }
    }

    /// With data on which no motion depends.
    #[must_use]
    pub const fn idle(self, idle: &'static [&'static str]) -> Self {
        Self { idle, ..self }
    }

    /// With this number of failed steps.
    #[must_use]
    pub const fn refused(self, refused: usize) -> Self {
        Self { refused, ..self }
    }

    /// With a known defect.
    #[must_use]
    pub const fn misses(self, off: f64) -> Self {
        Self {
            known: Some(off),
            ..self
        }
    }

    /// The name of the model.
    #[must_use]
    pub fn name(&self) -> &'static str {
        let mut words = self.text.split_whitespace();
        words.find(|w| *w == "model");
        words.next().unwrap_or("")
    }
}
