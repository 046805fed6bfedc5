//! Models that run from their text, without a build; each step has the bits of a compiled step. Takes parameters and initial values
//! by name; gives state, invariants and errors of a motion by name.

use clebsch::card::{Card, Field, OpenError, Settings, Trajectory};
use clebsch::nalgebra::{SMatrix, SVector};
use clebsch::{
    BodyImpulse, BodyMomentum, PlaneMotion, RigidMotion, Rotation, SpatialMomentum, StartError,
    StepCause, StepError, UnitQuaternion,
};
use clebsch_oracle::oracle::square::Square;
use std::fmt;

/// A value as a list of numbers, row by row.
pub(crate) trait Numbers {
    fn numbers(&self) -> Vec<f64>;
}

impl Numbers for f64 {
    fn numbers(&self) -> Vec<f64> {
        vec![*self]
    }
}

impl<const N: usize> Numbers for [f64; N] {
    fn numbers(&self) -> Vec<f64> {
        self.to_vec()
    }
}

impl Numbers for Vec<f64> {
    fn numbers(&self) -> Vec<f64> {
        self.clone()
    }
}

impl<const R: usize, const C: usize> Numbers for SMatrix<f64, R, C> {
    fn numbers(&self) -> Vec<f64> {
        self.transpose().as_slice().to_vec()
    }
}

impl<const N: usize> Numbers for Square<f64, N> {
    fn numbers(&self) -> Vec<f64> {
        self.0.concat()
    }
}

impl Numbers for UnitQuaternion {
    fn numbers(&self) -> Vec<f64> {
        self.components().to_vec()
    }
}

/// Momenta of typed models.
macro_rules! by_components {
    ($($momentum:ty)*) => {
        $(impl Numbers for $momentum {
            fn numbers(&self) -> Vec<f64> {
                self.0.numbers()
            }
        })*
    };
}
by_components! { BodyMomentum SpatialMomentum BodyImpulse }

/// Elements that a card takes as matrices.
macro_rules! by_matrix {
    ($($element:ty)*) => {
        $(impl Numbers for $element {
            fn numbers(&self) -> Vec<f64> {
                self.matrix().numbers()
            }
        })*
    };
}
by_matrix! { Rotation RigidMotion PlaneMotion }

/// Parameters and initial values by name.
pub(crate) type Given = Vec<(String, Vec<f64>)>;

/// Values by name, as [`Given`].
macro_rules! given {
    ($($name:ident: $value:expr),* $(,)?) => {
        vec![$((stringify!($name).to_owned(), $crate::stated::text_model::Numbers::numbers(&$value))),*]
    };
}
pub(crate) use given;

/// The card of a text.
pub(crate) fn card(text: &str) -> Card {
    clebsch_interpret::card(text).unwrap_or_else(|e| panic!("{text}\n{e}"))
}

/// A model by its card.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TextModel {
    pub(crate) card: Card,
}

impl TextModel {
    pub(crate) fn read(text: &str) -> Self {
        Self { card: card(text) }
    }

    /// A compiled model of the gallery.
    pub(crate) fn gallery(kebab: &str) -> Self {
        let entry = clebsch_models::find(kebab).unwrap_or_else(|| panic!("{kebab}"));
        Self { card: entry.card }
    }

    /// The same model with another value of its named size.
    pub(crate) fn of_size(self, n: usize) -> Self {
        let card = (self.card.sized)(&[n]).unwrap_or_else(|| panic!("no size {n}"));
        Self { card }
    }

    /// Starts plain steps of `h`.
    pub(crate) fn start(&self, h: f64, given: &Given) -> Result<Motion, OpenError> {
        self.start_with(Settings::step(h), given)
    }

    /// Starts a motion from values of all parameters and initial values.
    pub(crate) fn start_with(
        &self,
        settings: Settings,
        given: &Given,
    ) -> Result<Motion, OpenError> {
        let value = |field: &Field| {
            let found = given.iter().find(|(name, _)| name == field.name);
            let found = found.unwrap_or_else(|| panic!("no value for `{}`", field.name));
            found.1.clone()
        };
        let [parameters, initial] = [self.card.parameters, self.card.initial];
        assert_eq!(
            given.len(),
            parameters.len() + initial.len(),
            "{}",
            self.card.name
        );
        let parameters: Vec<_> = parameters.iter().map(value).collect();
        let initial: Vec<_> = initial.iter().map(value).collect();
        let run = (self.card.open)(&parameters, &initial, settings)?;
        Ok(Motion {
            card: self.card,
            parameters,
            run,
        })
    }
}

/// A motion at one node.
pub(crate) struct Motion {
    card: Card,
    parameters: Vec<Vec<f64>>,
    run: Box<dyn Trajectory>,
}

impl fmt::Debug for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at node {}", self.card.name, self.node())
    }
}

impl Motion {
    pub(crate) fn step(&mut self) -> Result<(), StepError> {
        self.run.step()
    }

    /// Steps that must succeed.
    pub(crate) fn steps(&mut self, count: usize) {
        for _ in 0..count {
            self.step().unwrap_or_else(|e| panic!("{self:?}: {e}"));
        }
    }

    pub(crate) fn node(&self) -> u64 {
        self.run.node()
    }

    /// All observables, one after another.
    pub(crate) fn observed(&self) -> Vec<f64> {
        let mut all = vec![0.0; self.card.observable_count()];
        self.run.observe(&mut all);
        all
    }

    /// An observable, row by row.
    pub(crate) fn numbers(&self, name: &str) -> Vec<f64> {
        let mut from = 0;
        for field in self.card.observables {
            if field.name == name {
                return self.observed()[from..from + field.count()].to_vec();
            }
            from += field.count();
        }
        let names: Vec<_> = self.card.observables.iter().map(|f| f.name).collect();
        panic!("`{name}` is not among {names:?}");
    }

    pub(crate) fn number(&self, name: &str) -> f64 {
        let [x] = self.numbers(name)[..] else {
            panic!("`{name}` is no number");
        };
        x
    }

    pub(crate) fn vector<const N: usize>(&self, name: &str) -> SVector<f64, N> {
        SVector::from_row_slice(&self.numbers(name))
    }

    pub(crate) fn matrix<const R: usize, const C: usize>(&self, name: &str) -> SMatrix<f64, R, C> {
        SMatrix::from_row_slice(&self.numbers(name))
    }

    pub(crate) fn square<const N: usize>(&self, name: &str) -> Square<f64, N> {
        let all = self.numbers(name);
        assert_eq!(all.len(), N * N, "{name}");
        Square::from_entries(|i, j| all[N * i + j])
    }

    /// An invariant.
    pub(crate) fn invariant(&self, name: &str) -> Vec<f64> {
        let mut all = vec![0.0; self.card.invariant_count()];
        self.run.invariants(&mut all);
        let mut from = 0;
        for invariant in self.card.invariants {
            if invariant.name == name {
                return all[from..from + invariant.rows].to_vec();
            }
            from += invariant.rows;
        }
        let names: Vec<_> = self.card.invariants.iter().map(|v| v.name).collect();
        panic!("`{name}` is not among {names:?}");
    }

    pub(crate) fn energy(&self) -> f64 {
        self.invariant("energy")[0]
    }

    /// A new motion from the state at this node, with steps of `h`.
    pub(crate) fn again(&self, h: f64) -> Result<Motion, OpenError> {
        let initial: Vec<_> = self
            .card
            .initial
            .iter()
            .map(|f| self.numbers(f.name))
            .collect();
        let run = (self.card.open)(&self.parameters, &initial, Settings::step(h))?;
        Ok(Motion {
            card: self.card,
            parameters: self.parameters.clone(),
            run,
        })
    }
}

/// Why a first step fails.
pub(crate) fn cause(error: &OpenError) -> StepCause {
    match error {
        OpenError::Start(StartError::Refused(cause)) => *cause,
        OpenError::Kinetic { refused, .. } => *refused,
        other => panic!("{other}"),
    }
}
