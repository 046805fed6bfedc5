//! Validates per-site data before a chain is built.

use super::error::{LineError, Place};
use crate::solvers::largest_step::search_of;
use crate::{ParameterError, Real};

/// Checks that a list has one value for each site.
///
/// # Errors
/// [`LineError::Length`].
pub fn length_of<S>(
    quantity: &'static str,
    list: &[S],
    expected: usize,
    sites: &'static str,
) -> Result<(), LineError> {
    match list.len() == expected {
        true => Ok(()),
        false => Err(LineError::Length {
            quantity,
            expected,
            found: list.len(),
            sites,
        }),
    }
}

/// The largest admissible number of sites.
const MOST: usize = 1 << 40;

/// Checks that the number of sites is neither too small nor too large.
///
/// # Errors
/// [`LineError::Count`].
pub fn count_of(count: &'static str, found: usize, least: usize) -> Result<(), LineError> {
    match (least..=MOST).contains(&found) {
        true => Ok(()),
        false => Err(LineError::Count {
            count,
            found,
            least,
        }),
    }
}

/// Checks or computes one value for each site.
///
/// # Errors
/// [`LineError::Site`] for the first inadmissible value.
pub fn each<S, R>(
    quantity: &'static str,
    list: &[S],
    test: impl Fn(&S) -> Result<R, ParameterError>,
) -> Result<Vec<R>, LineError> {
    let site = |(site, value): (usize, &S)| {
        test(value).map_err(|error| LineError::Site {
            at: Place { quantity, site },
            error,
        })
    };
    list.iter().enumerate().map(site).collect()
}

/// Appends `beyond` sites to a list: the first sites on a ring, otherwise copies of the last site, which no term reads.
pub fn repeated<S: Clone>(list: &[S], beyond: usize, ring: bool) -> Vec<S> {
    let mut out = list.to_vec();
    for i in 0..beyond {
        let next = match ring {
            true => out.get(i),
            false => out.last(),
        };
        out.extend(next.cloned());
    }
    out
}

/// Halves the step size up to twenty times until the step succeeds. These trials do not search for a step size
/// themselves.
#[cold]
pub fn shorter<T: Real>(h: T, made: impl Fn(T) -> bool) -> Option<f64> {
    let mut half = h;
    let found = search_of(|| {
        (0..20).find(|_| {
            half *= T::from_f64(0.5);
            made(half)
        })
    });
    found.flatten().map(|_| half.value())
}
