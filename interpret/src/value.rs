//! The values of expressions in a step: numbers, matrices, group elements, momenta, prepared solvers.

use crate::failure::Failure;
use crate::functional;
use crate::sites::Column;
use clebsch::Real;
use clebsch::domain;
use clebsch::emitted::{
    Edge, Free, Method, Order, PlaneMotion, Poinsot, QuaternionBody, RigidMotion, Rotation,
    TurnedRotation, UnitQuaternion,
};
use clebsch::kinetic::KineticWarning;
use clebsch::linalg::Dense;
use clebsch::line;
use nalgebra::{Matrix3, Vector3};
use std::sync::Arc;

/// The frame of a momentum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// The body frame.
    Body,
    /// The space frame.
    Spatial,
    /// The axes of space, about the origin of the body.
    Carried,
    /// The only frame of a field.
    Field,
}

/// A group whose elements are stored as matrices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MatrixGroup {
    /// Rotations of n-dimensional space.
    Orthogonal,
    /// Invertible maps.
    Linear,
    /// Fields.
    Field,
}

/// A named list of fields.
#[derive(Debug, PartialEq)]
pub struct Layout {
    /// The name of the struct.
    pub name: String,
    /// The names of its fields, as numbers.
    pub fields: Vec<u32>,
}

/// A struct of the emitted code.
#[derive(Debug)]
pub struct Struct<T: Real> {
    /// The names of the fields.
    pub layout: Arc<Layout>,
    /// Their values.
    pub values: Vec<Value<T>>,
}

impl<T: Real> Clone for Struct<T> {
    fn clone(&self) -> Self {
        Struct {
            layout: self.layout.clone(),
            values: self.values.clone(),
        }
    }

    // Stores the state before a step without a new allocation.
    fn clone_from(&mut self, source: &Self) {
        if !Arc::ptr_eq(&self.layout, &source.layout) {
            self.layout = source.layout.clone();
        }
        self.values.clone_from(&source.values);
    }
}

impl<T: Real> Struct<T> {
    /// A field by the number of its name.
    #[inline]
    pub fn field(&self, name: u32) -> Option<&Value<T>> {
        let at = self.layout.fields.iter().position(|f| *f == name)?;
        self.values.get(at)
    }

    /// Like `field`, by mutable reference.
    #[inline]
    pub fn field_mut(&mut self, name: u32) -> Option<&mut Value<T>> {
        let at = self.layout.fields.iter().position(|f| *f == name)?;
        self.values.get_mut(at)
    }
}

/// A value. `Ok(x)` and `Some(x)` are `x` itself.
#[derive(Clone, Debug)]
pub enum Value<T: Real> {
    /// `()`.
    Unit,
    /// No value.
    None,
    /// A truth.
    Bool(bool),
    /// A count.
    Int(i64),
    /// A number.
    Real(T),
    /// A number that is `f64` for any scalar.
    Double(f64),
    /// A text.
    Text(&'static str),
    /// A vector of three components.
    Vector(Vector3<T>),
    /// A 3 x 3 matrix.
    Matrix(Matrix3<T>),
    /// A matrix of any other size.
    Dense(Dense<T>),
    /// Zeros whose size follows from the other operand.
    Zeros,
    /// A rotation of space.
    Rotation(Rotation<T>),
    /// A rotation that is not normalised yet.
    Turned(TurnedRotation<T>),
    /// A unit quaternion.
    Quaternion(UnitQuaternion<T>),
    /// A rigid motion of space.
    Motion(Box<RigidMotion<T>>),
    /// A rigid motion of the plane.
    Plane(Box<PlaneMotion<T>>),
    /// An element stored as its matrix.
    Element(MatrixGroup, Dense<T>),
    /// A momentum of three components.
    Momentum(Frame, Vector3<T>),
    /// A momentum of any other shape.
    Impulse(Frame, Dense<T>),
    /// The momentum of an edge on SO(3) or SU(2).
    Edge(Edge<T>),
    /// A body on SO(3).
    Poinsot(Arc<Poinsot<T>>),
    /// A body on SU(2).
    QuaternionBody(Arc<QuaternionBody<T>>),
    /// A left factor: its matrix and prepared data.
    LeftFactor(crate::library::Factor<T>),
    /// The solver of a free body.
    Free(Box<Free<T>>),
    /// A solver by name.
    Method(Method),
    /// An order of modified moments.
    Order(Order),
    /// The domain of the argument of a function.
    Domain(domain::Domain),
    /// A function with a domain.
    Function(domain::Function),
    /// A function call.
    Call(&'static domain::Call),
    /// A warning about the kinetic energy.
    Warning(KineticWarning),
    /// A struct of the emitted code.
    Struct(Struct<T>),
    /// An array or a tuple.
    List(Vec<Value<T>>),
    /// A value for each site of a chain.
    Sites(Column<T>),
    /// The attitude of a site.
    Attitude(Box<line::Attitude<T>>),
    /// The state for which a workspace was prepared.
    Stamp(line::Stamp),
    /// A quantity at a site.
    At(line::Place),
    /// A search for the impulses of constraints.
    Multipliers(Box<line::Multipliers<T>>),
    /// A search for the velocities of all sites together.
    Band(Box<line::AnyBand<T>>),
    /// A search for velocities.
    Search(crate::newton::SearchValue),
    /// Part of an array, starting at an offset: the place of the array.
    Part(usize, usize),
    /// A domain of particles.
    Extent(functional::Extent),
    /// The setting of functionals of all sites.
    FunctionalSetting(Box<functional::FunctionalSetting>),
    /// A functional of all sites.
    Functional(functional::AnyFunctional<T>),
    /// An error.
    Failed(Box<Failure>),
}

impl<T: Real> Value<T> {
    /// A matrix of any size, in its stored form.
    #[inline]
    pub fn of(a: Dense<T>) -> Self {
        match (a.rows, a.cols, a.data.as_slice()) {
            (3, 1, _) => Value::Vector(a.fixed()),
            (3, 3, _) => Value::Matrix(a.fixed()),
            _ => Value::Dense(a),
        }
    }

    /// Any matrix as one of any size.
    #[inline]
    pub fn dense(&self) -> Option<Dense<T>> {
        Some(match self {
            Value::Vector(v) => Dense::of(v),
            Value::Matrix(m) => Dense::of(m),
            Value::Dense(a) => a.clone(),
            _ => return None,
        })
    }

    /// A momentum.
    pub fn momentum(frame: Frame, a: &Value<T>) -> Option<Self> {
        Some(match a {
            Value::Vector(v) => Value::Momentum(frame, *v),
            other => Value::Impulse(frame, other.dense()?),
        })
    }

    /// An error.
    pub fn failed(e: impl Into<Failure>) -> Self {
        Value::Failed(Box::new(e.into()))
    }

    /// A result.
    pub fn result(r: Result<Self, impl Into<Failure>>) -> Self {
        r.unwrap_or_else(Self::failed)
    }

    /// A count.
    pub fn count(&self) -> Option<usize> {
        match self {
            Value::Int(n) => usize::try_from(*n).ok(),
            _ => None,
        }
    }
}

impl<T: Real> PartialEq for Value<T> {
    /// Compares numbers, matrices, group elements and momenta. Prepared data never compare equal.
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Value::Unit, Value::Unit) | (Value::None, Value::None) => true,
            (Value::Bool(a), Value::Bool(b)) => a == b,
            (Value::Int(a), Value::Int(b)) => a == b,
            (Value::Real(a), Value::Real(b)) => a == b,
            (Value::Double(a), Value::Double(b)) => a == b,
            (Value::Vector(a), Value::Vector(b)) => a == b,
            (Value::Matrix(a), Value::Matrix(b)) => a == b,
            (Value::Dense(a), Value::Dense(b)) => a == b,
            (Value::Rotation(a), Value::Rotation(b)) => a == b,
            (Value::Quaternion(a), Value::Quaternion(b)) => a == b,
            (Value::Motion(a), Value::Motion(b)) => a == b,
            (Value::Plane(a), Value::Plane(b)) => a == b,
            (Value::Element(k, a), Value::Element(l, b)) => k == l && a == b,
            (Value::Momentum(f, a), Value::Momentum(g, b)) => f == g && a == b,
            (Value::Impulse(f, a), Value::Impulse(g, b)) => f == g && a == b,
            (Value::Method(a), Value::Method(b)) => a == b,
            (Value::Struct(a), Value::Struct(b)) => a.values == b.values,
            (Value::List(a), Value::List(b)) => a == b,
            (Value::Sites(a), Value::Sites(b)) => a == b,
            (Value::Attitude(a), Value::Attitude(b)) => a == b,
            (Value::Edge(a), Value::Edge(b)) => a == b,
            (Value::Stamp(a), Value::Stamp(b)) => a == b,
            _ => false,
        }
    }
}

// Values are moved often, so they must stay small.
const _: () = assert!(size_of::<Value<f64>>() <= 128);
