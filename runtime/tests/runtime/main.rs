//! Scalars, groups, solvers, orders and the integration loop, without the engine. One binary, since linking is most of
//! what a test costs.

mod common;
mod composition;
mod forced;
mod free;
mod groups;
mod integrate;
mod left_factor;
mod newton;
mod order;
mod quaternions_and_motions;
mod scalars;
mod scalars_through_solvers;
mod unit_quaternions;
