//! Checks of initial data by their types: elements of groups and momenta are valid by construction, but may still
//! contain numbers that are not finite.

use super::finite;
use crate::groups::{
    Additive, BodyImpulse, BodyMomentum, BodyMomentumMatrix, BodyPlaneImpulse, FieldMomentum,
    Linear, PlaneMotion, RigidMotion, Rotation, SpatialImpulse, SpatialMomentum,
    SpatialMomentumMatrix, SpatialPlaneImpulse, UnitQuaternion,
};
use crate::{ParameterError, Real};

/// An element or a momentum that a trajectory starts from.
pub trait Initial {
    /// Every number of it is finite, see [`finite`].
    ///
    /// # Errors
    /// Names the first number that is not.
    fn is_finite(&self, field: &'static str) -> Result<(), ParameterError>;
}

/// Every number of an element or of a momentum is finite.
///
/// # Errors
/// Names the first number that is not.
pub fn initial(field: &'static str, value: &impl Initial) -> Result<(), ParameterError> {
    value.is_finite(field)
}

macro_rules! initial {
    ($($Type:ident [$($N:ident)*], $value:ident => $numbers:expr;)*) => {$(
        impl<T: Real, $(const $N: usize),*> Initial for $Type<$($N,)* T> {
            fn is_finite(&self, field: &'static str) -> Result<(), ParameterError> {
                let $value = self;
                finite(field, $numbers)
            }
        }
    )*};
}
initial! {
    Rotation [], g => &g.quaternion();
    UnitQuaternion [], g => &g.components();
    RigidMotion [], g => g.matrix().as_slice();
    PlaneMotion [], g => g.matrix().as_slice();
    Linear [N], g => g.matrix().as_slice();
    Additive [R C], x => x.matrix().as_slice();
    BodyMomentum [], m => m.0.as_slice();
    SpatialMomentum [], m => m.0.as_slice();
    BodyImpulse [], m => m.0.as_slice();
    SpatialImpulse [], m => m.0.as_slice();
    BodyPlaneImpulse [], m => m.0.as_slice();
    SpatialPlaneImpulse [], m => m.0.as_slice();
    BodyMomentumMatrix [N], m => m.0.as_slice();
    SpatialMomentumMatrix [N], m => m.0.as_slice();
    FieldMomentum [R C], m => m.0.as_slice();
}
