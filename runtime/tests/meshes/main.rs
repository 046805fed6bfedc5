//! Functionals of meshes and grids by formulas that share nothing with the runtime, and velocities of one site of a line.
//! One binary: linking costs more than these tests.

mod cut;
mod derivatives;
mod grid;
mod line_root;
mod operators;
mod printed;
mod regularised;
mod smoother;
mod voronoi;
