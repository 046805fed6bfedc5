//! Runtime of discrete Clebsch variational integrators: the functions that emitted steppers call,
//! and the types you need to run them.
//!
//! Write a model with [`model!`]; the module [`language`] describes its syntax. The macro derives the
//! discrete Euler-Lagrange equations and emits a stepper. This crate supplies
//!
//! - [`scalar`]: the scalars that a stepper computes with;
//! - [`groups`]: the configuration groups and their momenta;
//! - [`solvers`]: the solvers of implicit steps;
//! - [`integrate`]: the integration loop with observers, and ensembles;
//! - [`mod@line`]: loops over the sites of a chain;
//! - [`mesh`]: meshes and grids of particles;
//! - [`card`]: the description of every model as data.
//!
//! [`prelude`] imports the names that most programs need. [`Error`] collects all errors.
//!
//! Conventions: a rotation `R` maps body to space; `hat(v) w = v x w`; `J` is the Poinsot (second-moment) matrix and
//! `I = tr(J) 1 - J` the moment of inertia; node `k` has configurations and momenta, edge `k -> k+1` has discrete
//! velocities `Omega = R_k^T R_{k+1}`.

mod any_error;
pub mod card;
pub mod derivatives;
pub mod domain;
#[doc(hidden)]
pub mod emitted;
pub mod error;
pub mod functions;
pub mod groups;
pub mod integrate;
pub mod kinetic;
pub mod language;
pub mod linalg;
pub mod line;
pub mod mesh;
mod number_format;
#[doc(hidden)]
pub mod of_numbers;
pub mod prelude;
pub mod record;
pub mod saved;
pub mod scalar;
mod snapshot;
pub mod solvers;
pub mod validate;

pub use any_error::Error;
pub use domain::{Contact, Met};
pub use error::{ParameterError, Problem, StartError, StepCause, StepError};
pub use groups::{
    AboutBody, Additive, BodyImpulse, BodyMomentum, BodyMomentumMatrix, BodyPlaneImpulse,
    CarriedImpulse, CarriedPlaneImpulse, Coadjoint, FieldMomentum, Group, Linear, NotARigidMotion,
    NotARotation, NotInvertible, Orthogonal, Placed, PlaneMotion, RigidMotion, Rotation,
    SpatialImpulse, SpatialMomentum, SpatialMomentumMatrix, SpatialPlaneImpulse, TurnedRotation,
    UnitQuaternion,
};
pub use scalar::{DoubleDouble, Dual, Lanes, OfScalars, Real};
pub use snapshot::{Snapshot, SnapshotError};
pub use solvers::moser_veselov::{MoserVeselovError, Order, Poinsot, PoinsotError};
pub use solvers::newton::NewtonError;

/// States a model; see the crate documentation.
pub use clebsch_macros::model;

/// The linear algebra of the public interface, so that emitted code uses exactly this version.
pub use nalgebra;
/// The traits `Zero` and `One` that [`Real`] builds on.
pub use num_traits;
