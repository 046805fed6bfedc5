//! Steppers written by hand from the published equations, in plain `f64`, as references for generated code. They take
//! inertia, initial attitude and momentum, and give attitudes and momenta. They do not use the library under test, so
//! that an agreement is independent evidence.

pub mod attitude;
pub mod body_in_field;
pub mod body_n;
pub mod cayley_klein;
pub mod cayley_klein_symmetric;
pub mod charged_particle;
pub mod coupled_bodies;
pub mod coupled_fixed_point;
pub mod ellipsoid;
pub mod fluid_ellipsoid;
pub mod free_body;
pub mod free_body_spatial;
pub mod heavy_top;
pub mod heavy_top_spatial;
pub mod kepler;
pub mod kirchhoff_body;
pub mod lattices;
pub mod mixed_four;
pub mod neo_hooke;
pub mod one_sided_top;
pub mod principal_axes;
pub mod principal_root;
pub mod pseudo_rigid;
pub mod spaced;

use std::fmt;

/// A step without a solution on the principal branch: the momentum is too large for the step size, or not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unsolvable;

impl fmt::Display for Unsolvable {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(
            "the discrete Moser-Veselov equation has no principal solution: reduce the step",
        )
    }
}

impl std::error::Error for Unsolvable {}
