//! Functions of all sites at once, which models use by name (`mesh A: Real at a = voronoi_area(X);`): their interface
//! for steppers, the domains of their particles, and their errors.

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
