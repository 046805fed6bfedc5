//! Lattices stepped by hand: loops over sites, a list for each number of a site or an array for each site, nothing allocated
//! in a step. Take data of the sites and of the ends; give places, attitudes and momenta at the nodes.

pub mod block_tridiagonal;
pub mod body_chain;
pub mod columns;
pub mod coupled_tops;
pub mod geometrically_exact_rod;
pub mod inextensible_rod;
pub mod instruction_set;
mod section;
pub mod sine_gordon;
pub mod toda_chain;
pub mod turning;
