//! Functionals on a uniform grid: depth deposited from particles by B-splines, smoothing by the inverse of a
//! Helmholtz operator. Directions are periodic, or end in reflecting walls.

mod axis;
mod bounded;
mod depth;
mod isotropic;
mod nodes;
mod padded;
mod periodic;
mod position;
mod reflection;
mod smoother;
mod sorted;
mod spline;
mod stencil;
mod waves;

pub use axis::Axis;
pub use depth::{deposit, deposit_quintic};
pub use isotropic::smooth_isotropic;
pub use nodes::Nodes;
pub use smoother::{smooth, smoothing_length};
pub use waves::fastest_wave;
