//! Arguments that no algorithm accepts.

use nalgebra::{DMatrix, DVector};
use std::fmt;

/// An argument, or a value of a user's function, that an algorithm cannot use.
#[derive(Clone, Debug, PartialEq)]
pub enum Invalid {
    /// A step size is zero, infinite or NaN.
    StepSize {
        /// The step size.
        h: f64,
    },
    /// A number that must be positive is zero.
    Zero {
        /// The counted things.
        what: &'static str,
    },
    /// A number is larger than allowed.
    TooMany {
        /// The counted things.
        what: &'static str,
        /// The number.
        given: usize,
        /// The largest allowed number.
        most: usize,
    },
    /// A value is infinite or NaN.
    NotFinite {
        /// The quantity with this value.
        what: &'static str,
    },
    /// An array has a wrong shape.
    Shape {
        /// The quantity with this shape.
        what: &'static str,
        /// Its rows and columns.
        shape: (usize, usize),
        /// The rows and columns that were expected.
        expected: (usize, usize),
    },
    /// A number is outside its range.
    Range {
        /// The name of the number.
        what: &'static str,
        /// The number.
        given: f64,
        /// The range, in words.
        range: &'static str,
    },
}

impl fmt::Display for Invalid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StepSize { h } => {
                write!(
                    f,
                    "The step size is {h}. Give a finite step size that is not zero."
                )
            }
            Self::Zero { what } => write!(f, "The number of {what} is zero. Give at least one."),
            Self::TooMany { what, given, most } => {
                write!(f, "The number of {what} is {given}. Give at most {most}.")
            }
            Self::NotFinite { what } => {
                write!(
                    f,
                    "The {what} has an infinite or undefined number. Start elsewhere, or use a smaller step size."
                )
            }
            Self::Shape {
                what,
                shape,
                expected,
            } => write!(
                f,
                "The {what} has {} rows and {} columns. Return {} rows and {} columns.",
                shape.0, shape.1, expected.0, expected.1
            ),
            Self::Range { what, given, range } => {
                write!(f, "The {what} is {given}. Give a number {range}.")
            }
        }
    }
}

impl std::error::Error for Invalid {}

/// Says that a step of a trajectory failed, and why.
pub(crate) fn failed_step(
    f: &mut fmt::Formatter<'_>,
    step: usize,
    source: &impl fmt::Display,
) -> fmt::Result {
    write!(
        f,
        "Step {step} of the trajectory failed: {}. Use a smaller step size, or start elsewhere.",
        clause(source)
    )
}

/// Accepts a step size that is finite and not zero.
pub(crate) fn step_size(h: f64) -> Result<(), Invalid> {
    match h.is_finite() && h != 0.0 {
        true => Ok(()),
        false => Err(Invalid::StepSize { h }),
    }
}

/// Accepts a number of things between one and `most`.
pub(crate) fn number(what: &'static str, given: usize, most: usize) -> Result<(), Invalid> {
    match given {
        0 => Err(Invalid::Zero { what }),
        _ if given > most => Err(Invalid::TooMany { what, given, most }),
        _ => Ok(()),
    }
}

/// Accepts finite numbers.
pub(crate) fn finite(what: &'static str, numbers: &[f64]) -> Result<(), Invalid> {
    match numbers.iter().all(|x| x.is_finite()) {
        true => Ok(()),
        false => Err(Invalid::NotFinite { what }),
    }
}

/// Accepts a finite matrix of the given shape.
pub(crate) fn matrix(
    what: &'static str,
    of: &DMatrix<f64>,
    expected: (usize, usize),
) -> Result<(), Invalid> {
    match of.shape() == expected {
        true => finite(what, of.as_slice()),
        false => Err(Invalid::Shape {
            what,
            shape: of.shape(),
            expected,
        }),
    }
}

/// Accepts a finite vector of the given length.
pub(crate) fn vector(what: &'static str, of: &DVector<f64>, length: usize) -> Result<(), Invalid> {
    match of.len() == length {
        true => finite(what, of.as_slice()),
        false => Err(Invalid::Shape {
            what,
            shape: of.shape(),
            expected: (length, 1),
        }),
    }
}

/// The text of an error without its full stop, as a part of a longer sentence.
pub(crate) fn clause(of: &impl fmt::Display) -> String {
    of.to_string().trim_end().trim_end_matches('.').to_owned()
}
