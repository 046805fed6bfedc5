//! The discrete Moser-Veselov equation `Omega C^T - C Omega^T = h N` on SO(n), for any left factor
//! `C` with a positive determinant. Takes the factor and the scaled edge momentum, a skew matrix
//! (`hat(h N)` in three dimensions); gives the rotation `Omega`.
//!
//! With `A = Omega C^T` it reads `A - A^T = V`, `A^T A = C C^T`, `V = h N`: a Riccati equation for
//! the symmetric part of `A` (Cardoso and Leite, Linear Algebra Appl. 360, 2003; Moser and Veselov,
//! Commun. Math. Phys. 139, 1991). The solvers find the principal solution, for which the spectrum of
//! `A` is in the right half plane. It tends to the polar factor of `C` as the momentum tends to zero,
//! and exists up to an exact bound ([`LeftFactor::reach`]).

mod davenport;
mod factor;
mod failure;
mod lie_newton;
mod principal;
mod reach;
mod schur;
mod sign;
mod symmetric_part;
mod tangent;

pub use davenport::{davenport, rotation_at};
pub use factor::{LeftFactor, LeftFactorError};
pub use failure::{Refusal, Unsolved};
pub use reach::reach_of;
