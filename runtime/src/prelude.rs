//! The names that nearly every program with a model needs: `use clebsch::prelude::*;`. The prelude: the macro, the
//! groups and momenta, the loop, the errors, and the matrices of nalgebra.

pub use crate::card::Card;
pub use crate::integrate::{Ensemble, Model, Stepper, Summary, Watch, run};
pub use crate::scalar::Real;
pub use crate::{
    Additive, BodyMomentum, Error, FieldMomentum, ParameterError, RigidMotion, Rotation,
    SpatialMomentum, StartError, StepError, UnitQuaternion, model,
};
pub use nalgebra::{Matrix2, Matrix3, Matrix4, Vector2, Vector3, Vector4};
