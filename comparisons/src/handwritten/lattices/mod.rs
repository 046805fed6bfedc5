//! Lattices written by hand for every number of sites, in plain `f64`: the yardstick of the loops that are emitted. They
//! take parameters, places, attitudes and momenta site by site; give those after each step.

pub mod block_tridiagonal;
pub mod body_chain;
pub mod inextensible_rod;
mod section;
