//! Checks the data at sites before anything is built from them.

use super::error::{LineError, Place};
use crate::solvers::largest_step::search_of;
use crate::{ParameterError, Real};

/// Whether a list has a value for each of its sites.
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

/// Most sites: beyond it not even their numbers are counted.
const MOST: usize = 1 << 40;

/// Whether there are enough sites, and not too many.
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
/// [`LineError::Site`] of the first that is not admissible.
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

/// The list with this number of sites appended: on a ring the first sites, otherwise copies of the
/// last site, which no term reads.
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

/// The first of twenty successive halves of a step that succeeds. A trial does not search for a step size itself.
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
