//! Scalars, groups, solvers, orders, the integration loop, and models on every group that use Newton's method. All tests share one
//! binary, because linking dominates the build time of a test.

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
