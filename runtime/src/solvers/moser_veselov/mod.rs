//! The discrete Moser-Veselov equation `Omega J - J Omega^T = hat(h N)` on SO(3).
//! Takes the Poinsot matrix `J` and the scaled edge momentum; gives the rotation `Omega`.
//!
//! Let `I = tr(J) 1 - J`, `u = h N / 2` and `c` the Rodrigues vector of `Omega`. The equation is then
//! `I c + c x I c = (1 + |c|^2) u` (Hairer and Vilmart, J. Phys. A 39, 2006). For a known
//! `kappa = u . c` it is linear, `(I - kappa - hat u) c = u`. `kappa` is the smallest root of a quartic
//! whose coefficients depend on the body, `|u|^2` and the energy alone. Free motion conserves these, so
//! [`Free`] finds `kappa` once; [`forced()`] solves the quartic in each step.
//!
//! The solvers find the principal solution, which tends to the identity as the step tends to zero. It
//! exists up to a bound on the step ([`reach()`]); beyond it, [`MoserVeselovError`] carries the
//! numbers.

mod cayley;
mod coefficients;
mod compensation;
mod edge;
mod failure;
mod forced;
mod free;
mod kappa;
mod phase;
mod poinsot;
mod preprocess;
mod principal;
mod reach;

pub use super::largest_step::largest_step;
pub(in crate::solvers) use cayley::dot;
pub use edge::Edge;
pub use failure::MoserVeselovError;
pub(in crate::solvers) use failure::{fastest, index};
pub use forced::forced;
pub(in crate::solvers) use forced::forced_together;
pub use free::Free;
pub(in crate::solvers) use kappa::choose;
pub(in crate::solvers) use poinsot::symmetric_times;
pub use poinsot::{Poinsot, PoinsotError};
pub use preprocess::Order;
pub use reach::reach;
