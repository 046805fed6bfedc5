//! The meaning of a value under the key of a field: the field itself, the inertia of a body instead of its
//! second moments, or a velocity.
//! Takes a value of a case, or numbers of an array; gives the numbers of the field.

use super::inertia;
use super::value::{self, Numbers};
use clebsch::card::{Field, Kind};
use toml::de::DeValue;

/// The meaning of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TakenAs {
    Itself,
    Inertia,
    Velocity,
}

impl TakenAs {
    /// The field whose shape an array must have.
    pub(super) fn of_array(self, field: &Field) -> Field {
        match self {
            Self::Inertia => inertia::field(field),
            Self::Itself | Self::Velocity => *field,
        }
    }

    /// The numbers of a field from a value.
    pub(super) fn value(
        self,
        field: &Field,
        value: &DeValue<'_>,
        of: &Numbers<'_>,
    ) -> Result<Vec<f64>, String> {
        match self {
            Self::Itself => value::numbers(field, value, of),
            Self::Inertia => inertia::second_moments(field, value, of),
            Self::Velocity => checked(field, value::numbers(field, value, of)?),
        }
    }

    /// Converts numbers of an array, which has one of the shapes of [`TakenAs::of_array`].
    pub(super) fn array(
        self,
        field: &Field,
        numbers: &[f64],
        shape: &[usize],
    ) -> Result<Vec<f64>, String> {
        let all = value::of_array(&self.of_array(field), numbers, shape)?;
        match self {
            Self::Itself => Ok(all),
            Self::Inertia => inertia::of_entries(field, &all),
            Self::Velocity => checked(field, all),
        }
    }
}

/// Checks that the matrix of a velocity is skew.
fn checked(field: &Field, all: Vec<f64>) -> Result<Vec<f64>, String> {
    let n = field.rows;
    let at = |i: usize, j: usize| all.get(i * n + j).copied().unwrap_or_default();
    let off =
        |k: usize| (at(k / n, k % n) + at(k % n, k / n)).abs() > 1e-9 * at(k / n, k % n).abs();
    match field.kind == Kind::Skew && (0..n * n).any(off) {
        true => Err("not skew: an angular velocity W in n dimensions is a skew matrix, with rate of change R*W of R".to_owned()),
        false => Ok(all),
    }
}
