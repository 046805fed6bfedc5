//! Moving Voronoi meshes on the periodic plane: the mesh itself ([`Voronoi`]), functionals of it that models take
//! by name, and what can be seen on it. Takes the places of particles, wrapped or not; gives sums over cells.
//!
//! Conventions: an edge leads from site `a` to site `b`, along `d = X_b - X_a` of length `R`; the face between their
//! cells has the length `l`, and its middle is `c`. Triangles go counterclockwise.

mod area;
mod bins;
mod cells;
mod conjugate;
mod delaunay;
mod extrapolated;
mod half_edges;
mod helmholtz;
mod insertion;
mod laplacian;
mod masses;
mod mesh;
mod moment;
mod operators;
pub mod placement;
mod polygons;
mod predicates;
mod repulsion;
mod rows;
mod saved;
mod shared;
mod smoothed;
mod spacing;
mod torus;
mod within;

pub use area::voronoi_area;
pub use cells::Face;
pub use delaunay::Counted;
pub use helmholtz::{helmholtz_depth, helmholtz_twice, kernel_depth};
pub use mesh::{Triangle, Voronoi};
pub use moment::second_moment;
pub use repulsion::pair_core;
pub use spacing::Between;
