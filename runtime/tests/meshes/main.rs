//! Functionals of meshes and grids against independent formulas, and velocities of one site of a chain. All tests share one binary,
//! because linking costs more than the tests.

mod cut;
mod derivatives;
mod grid;
mod line_root;
mod operators;
mod printed;
mod regularised;
mod smoother;
mod voronoi;
