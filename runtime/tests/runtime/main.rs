//! Scalars, groups, solvers, orders, the integration loop, and models of every group that are solved by Newton's method. One
//! binary, since linking is most of what a test costs.

// The fields of the models are Greek letters, as in the papers.
#![allow(mixed_script_confusables)]

mod common;
mod composition;
mod discrete_energy;
mod driven;
mod forced;
mod free;
mod groups;
mod integrate;
mod kept_force;
mod kernels;
mod left_factor;
mod linear_group;
mod newton;
mod order;
mod principal;
mod quaternions_and_motions;
mod scalars;
mod scalars_through_solvers;
mod small_steps;
mod unit_quaternions;
mod units;
