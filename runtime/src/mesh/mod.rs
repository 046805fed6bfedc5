//! Functions of all sites at once, which models take by name (`mesh A: Real at a = voronoi_area(X);`): what they
//! are to a stepper, the domains that their particles live in, and what can go wrong.

mod domain;
mod error;
mod functional;
mod grid;
mod length;
mod voronoi;

pub use domain::{Domain, Wall};
pub use error::MeshError;
pub use functional::{Functional, Setting};
pub use grid::{
    Axis, Nodes, deposit, deposit_quintic, fastest_wave, smooth, smooth_isotropic, smoothing_length,
};
pub use voronoi::{
    Between, Counted, Face, Triangle, Voronoi, helmholtz_depth, helmholtz_twice, kernel_depth,
    pair_core, placement, second_moment, voronoi_area,
};
