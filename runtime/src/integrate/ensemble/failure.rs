//! Why an ensemble cannot start or continue, and which body causes this. Takes the body's index and
//! its own error; gives text.

use core::fmt;

/// At least one body could not start or continue.
///
/// Bodies step side by side in lanes; if one of them fails, the other bodies of its group stay at the same node. All
/// other bodies have completed their steps.
#[derive(Clone, Debug, PartialEq)]
pub struct EnsembleError<E> {
    /// The index of the body, in the order of the bodies; the first such body if several fail.
    pub body: usize,
    /// The number of bodies, starting at `body`, that may be the cause. It is 1 unless every body of a
    /// group succeeds alone and they fail only side by side.
    pub among: usize,
    /// How many bodies have failed.
    pub failed: usize,
    /// The error of the first of these bodies.
    pub cause: E,
}

impl<E: fmt::Display> fmt::Display for EnsembleError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.among {
            0 | 1 => write!(f, "body at index {}: {}", self.body, self.cause)?,
            n => write!(
                f,
                "bodies at indices {} to {}, stepped together: {}",
                self.body,
                self.body + n - 1,
                self.cause
            )?,
        }
        match self.failed {
            0 | 1 => Ok(()),
            n => write!(f, " ({n} bodies failed)"),
        }
    }
}

impl<E: std::error::Error + 'static> std::error::Error for EnsembleError<E> {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.cause)
    }
}

/// The first failure, with the number of bodies that failed in all.
pub(super) fn first<E>(
    failures: impl Iterator<Item = EnsembleError<E>>,
) -> Result<(), EnsembleError<E>> {
    let mut told: Option<EnsembleError<E>> = None;
    for failure in failures {
        match &mut told {
            Some(told) => told.failed += failure.failed,
            None => told = Some(failure),
        }
    }
    told.map_or(Ok(()), Err)
}
