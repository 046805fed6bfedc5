//! Solves a single equation that does not belong to a trajectory. Takes a guess, the size of the terms, the residual
//! and its tangent; gives a converged element or an error.

use super::{BOUND_ROUNDINGS, LAST_ATTEMPT, NewtonError, Progress, REMEMBERED, Search, Solved};
use crate::groups::Group;
use crate::scalar::Real;
use nalgebra::{SMatrix, SVector};

/// Solves `residual(g) = 0` from the guess `g`. `tangent(g)` and the size `scale` of the residual's terms are as in
/// [`Newton`](super::Newton).
///
/// # Errors
/// [`NewtonError`]; an unconverged element is never returned.
pub fn solve<T: Real, G: Group<T>, const D: usize>(
    guess: G,
    scale: f64,
    mut residual: impl FnMut(&G) -> SVector<T, D>,
    mut tangent: impl FnMut(&G) -> SMatrix<T, D, D>,
) -> Result<Solved<G>, NewtonError> {
    let mut search = Search::<T, G, D, G, D>::from_rest();
    search.past = [guess; 2 * REMEMBERED];
    (search.known, search.next) = (1, 1);
    let mut newton = search.begin(1);
    // Makes a single attempt.
    newton.attempt = LAST_ATTEMPT;
    let rounding = SVector::repeat(scale * BOUND_ROUNDINGS * f64::EPSILON / 2.0);
    loop {
        let trial = newton.trial();
        if newton.wants_scale() {
            newton.set_scale(|_| rounding);
        }
        if newton.assess(residual(&trial)) {
            newton.set_tangent(&tangent(&trial));
        }
        match newton.correct() {
            Progress::Continue => {}
            Progress::Solved(found) => return Ok(found),
            Progress::Failed(why) => return Err(why),
        }
    }
}
