//! Hand-written chain steppers: loops over sites, with one list per component of a site or one array per site, and no
//! allocation in a step. They take data of the sites and the ends, and return positions, attitudes and momenta at the
//! nodes.

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
