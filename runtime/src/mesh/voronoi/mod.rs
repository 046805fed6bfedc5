//! Moving Voronoi meshes on the periodic plane: the mesh ([`Voronoi`]), the functionals that models use by name, and
//! diagnostics. Takes the positions of particles, wrapped or not; gives sums over cells.
//!
//! Conventions: an edge leads from site `a` to site `b` along `d = X_b - X_a`, which has length `R`. The face between
//! their cells has length `l` and midpoint `c`. Triangles are counterclockwise.

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
