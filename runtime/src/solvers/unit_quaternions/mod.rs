//! The equation of a step in unit quaternions, `w A v + v x A v + β v = h N / 2` for the velocity `w + v`.
//! Takes the symmetric matrix `A`, the number `β` and the edge momentum; gives the velocity.
//!
//! It belongs to discrete Lagrangians `(2/h) (v . A v) - (4/h) β w` (thesis section 2.8, the
//! Cayley-Klein form; there `A = I - c`, `β = c`). With `β = 0` it is the Moser-Veselov equation
//! seen from SU(2). Let `I = A + β`, `u = h N / 2` and `s = v . A v + β (1 - w)`. Then
//! `(I - s - hat u) v = w u` is linear. With `det = det(I - s - hat u)` and
//! `n = adj(I - s - hat u) u` its solution is `(w, v) = (det, n) / |(det, n)|`. The remaining equation
//! `u . n - s det = β (|(det, n)| - det)` determines `s`.
//!
//! The solver finds the principal solution, which is connected to the neutral element at `u = 0`. If
//! it does not exist, [`QuaternionError`] gives the largest possible step.

mod body;
mod branch;
mod edge;
mod failure;
mod shift;

pub use body::QuaternionBody;
pub use failure::QuaternionError;
