//! Values from lists of numbers: how the fields of a card become the parameters and the initial data of a model.
//! Takes the numbers of one field, row by row; gives its value, or an error that names the field. And back: the
//! numbers of observables and invariants.

use crate::StartError;
use crate::card::{Field, OpenError};
use crate::emitted::rows;
use crate::groups::{
    Additive, BodyImpulse, BodyMomentum, BodyMomentumMatrix, BodyPlaneImpulse, FieldMomentum,
    Linear, Orthogonal, PlaneMotion, RigidMotion, Rotation, SpatialImpulse, SpatialMomentum,
    SpatialMomentumMatrix, SpatialPlaneImpulse, UnitQuaternion,
};
use core::marker::PhantomData;
use nalgebra::SMatrix;

/// A type whose values can be built from numbers.
pub trait OfNumbers: Sized {
    /// The value of these numbers, matrices row by row.
    ///
    /// # Errors
    /// Names the field whose numbers are too few, too many or not admissible.
    fn of_numbers(field: &'static str, values: &[f64]) -> Result<Self, OpenError>;
}

/// A type whose values can be written as numbers.
pub trait Shown: Sized {
    /// The numbers, matrices row by row.
    fn numbers(self) -> impl Iterator<Item = f64>;
}

/// Writes the numbers of a value to the front of `out`; returns the rest of `out`.
pub fn put(value: impl Shown, out: &mut [f64]) -> &mut [f64] {
    crate::emitted::put(out, value.numbers())
}

/// The numbers of several fields, read field by field.
pub struct FieldNumbers<'a> {
    fields: core::slice::Iter<'a, Field>,
    values: core::slice::Iter<'a, Vec<f64>>,
}

impl<'a> FieldNumbers<'a> {
    /// The fields of a card, and the numbers of each.
    #[must_use]
    pub fn new(fields: &'a [Field], values: &'a [Vec<f64>]) -> Self {
        Self {
            fields: fields.iter(),
            values: values.iter(),
        }
    }

    /// The value of the next field.
    ///
    /// # Errors
    /// As [`OfNumbers::of_numbers`].
    pub fn take<X: OfNumbers>(&mut self) -> Result<X, OpenError> {
        let field = self.fields.next().map_or("", |field| field.name);
        X::of_numbers(field, self.values.next().map_or(&[], Vec::as_slice))
    }
}

impl<const R: usize, const C: usize> OfNumbers for SMatrix<f64, R, C> {
    fn of_numbers(field: &'static str, values: &[f64]) -> Result<Self, OpenError> {
        if values.len() != R * C {
            return Err(OpenError::Count {
                field,
                expected: R * C,
                found: values.len(),
            });
        }
        Ok(SMatrix::from_row_slice(values))
    }
}

impl<const R: usize, const C: usize> Shown for SMatrix<f64, R, C> {
    fn numbers(self) -> impl Iterator<Item = f64> {
        rows(self)
    }
}

impl Shown for f64 {
    fn numbers(self) -> impl Iterator<Item = f64> {
        core::iter::once(self)
    }
}

impl OfNumbers for f64 {
    fn of_numbers(field: &'static str, values: &[f64]) -> Result<Self, OpenError> {
        SMatrix::<f64, 1, 1>::of_numbers(field, values).map(|m| m.x)
    }
}

/// The field of the parameters of a model without parameters.
impl OfNumbers for PhantomData<f64> {
    fn of_numbers(_: &'static str, _: &[f64]) -> Result<Self, OpenError> {
        Ok(PhantomData)
    }
}

impl<const R: usize, const C: usize> OfNumbers for Additive<R, C, f64> {
    fn of_numbers(field: &'static str, values: &[f64]) -> Result<Self, OpenError> {
        SMatrix::of_numbers(field, values).map(Additive::new)
    }
}

impl<const R: usize, const C: usize> Shown for Additive<R, C, f64> {
    fn numbers(self) -> impl Iterator<Item = f64> {
        rows(self.matrix())
    }
}

/// The output of a unit quaternion equals its input.
impl Shown for UnitQuaternion<f64> {
    fn numbers(self) -> impl Iterator<Item = f64> {
        self.components().into_iter()
    }
}

/// A unit quaternion is given by `(w, x, y, z)`.
impl OfNumbers for UnitQuaternion<f64> {
    fn of_numbers(field: &'static str, values: &[f64]) -> Result<Self, OpenError> {
        let [components] = SMatrix::<f64, 4, 1>::of_numbers(field, values)?.data.0;
        Self::from_components(components)
            .map_err(|e| OpenError::Start(StartError::Initial(e.in_field(field))))
    }
}

/// Elements of groups are given by their matrices; for rigid motions these are homogeneous.
macro_rules! elements {
    ($($Element:ty [$($N:ident)?] of $rows:tt;)*) => {$(
        impl $(<const $N: usize>)? OfNumbers for $Element {
            fn of_numbers(field: &'static str, values: &[f64]) -> Result<Self, OpenError> {
                let matrix = SMatrix::<f64, $rows, $rows>::of_numbers(field, values)?;
                Self::from_matrix(&matrix)
                    .map_err(|e| OpenError::Start(StartError::Initial(e.in_field(field))))
            }
        }

        impl $(<const $N: usize>)? Shown for $Element {
            fn numbers(self) -> impl Iterator<Item = f64> {
                rows(self.matrix())
            }
        }
    )*};
}
elements! {
    Rotation<f64> [] of 3;
    RigidMotion<f64> [] of 4;
    PlaneMotion<f64> [] of 3;
    Orthogonal<N, f64> [N] of N;
    Linear<N, f64> [N] of N;
}

macro_rules! momenta {
    ($($Momentum:ty [$($N:ident)*];)*) => {$(
        impl<$(const $N: usize),*> OfNumbers for $Momentum {
            fn of_numbers(field: &'static str, values: &[f64]) -> Result<Self, OpenError> {
                SMatrix::of_numbers(field, values).map(Self)
            }
        }

        impl<$(const $N: usize),*> Shown for $Momentum {
            fn numbers(self) -> impl Iterator<Item = f64> {
                rows(self.0)
            }
        }
    )*};
}
momenta! {
    BodyMomentum<f64> [];
    SpatialMomentum<f64> [];
    BodyImpulse<f64> [];
    SpatialImpulse<f64> [];
    BodyPlaneImpulse<f64> [];
    SpatialPlaneImpulse<f64> [];
    BodyMomentumMatrix<N, f64> [N];
    SpatialMomentumMatrix<N, f64> [N];
    FieldMomentum<R, C, f64> [R C];
}
