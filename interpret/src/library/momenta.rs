//! Momenta between the frames of body and space.

use super::groups::linear_inverse;
use crate::code::Native;
use crate::value::{Frame, MatrixGroup, Value};
use clebsch::emitted::{AboutBody, BodyMomentum, Coadjoint, SpatialMomentum};
use clebsch::linalg::Dense;
use clebsch::{
    BodyImpulse, BodyPlaneImpulse, CarriedImpulse, CarriedPlaneImpulse, Real, SpatialImpulse,
    SpatialPlaneImpulse,
};
use nalgebra::Vector3;

/// Transforms a covector with an element stored as a matrix: to space, or to the body.
fn by_matrix<T: Real>(element: &Value<T>, covector: &Dense<T>, to_space: bool) -> Option<Dense<T>> {
    let Value::Element(kept, g) = element else {
        return None;
    };
    if *kept != MatrixGroup::Field && !g.fits(covector) {
        return None;
    }
    Some(match (kept, to_space) {
        (MatrixGroup::Orthogonal, true) => g.times(covector).times(&g.transpose()),
        (MatrixGroup::Orthogonal, false) => g.tr_mul(&covector.times(g)),
        (MatrixGroup::Linear, true) => linear_inverse(g).tr_mul(covector).times(&g.transpose()),
        (MatrixGroup::Linear, false) => g.tr_mul(covector).times(&linear_inverse(g).transpose()),
        (MatrixGroup::Field, _) => covector.clone(),
    })
}

/// Transforms a covector with any element.
macro_rules! covector {
    ($method:ident, $to_space:literal) => {
        |a, _| {
            let (element, covector) = (a.first()?, a.get(1)?);
            match (element, covector) {
                (Value::Rotation(g), Value::Vector(v)) => Some(Value::Vector(g.$method(v))),
                (Value::Quaternion(g), Value::Vector(v)) => Some(Value::Vector(g.$method(v))),
                (Value::Plane(g), Value::Vector(v)) => Some(Value::Vector(g.$method(v))),
                (Value::Motion(g), Value::Dense(v)) => {
                    Some(Value::of(Dense::of(&g.$method(&v.fixed::<6, 1>()))))
                }
                _ => {
                    let all = covector.dense()?;
                    by_matrix(element, &all, $to_space).map(Value::of)
                }
            }
        }
    };
}

/// A covector of a rigid motion about its own origin.
macro_rules! turned {
    ($method:ident) => {
        |a, _| match (a.first()?, a.get(1)?) {
            (Value::Motion(g), Value::Dense(v)) => {
                Some(Value::of(Dense::of(&g.$method(&v.fixed::<6, 1>()))))
            }
            (Value::Plane(g), Value::Vector(v)) => Some(Value::Vector(g.$method(v))),
            _ => None,
        }
    };
}

fn to_space<T: Real>(a: &[&Value<T>], _: &[usize]) -> Option<Value<T>> {
    let (momentum, element) = (a.first()?, a.get(1)?);
    Some(match (momentum, element) {
        (Value::Momentum(Frame::Body, v), Value::Rotation(g)) => {
            spatial(BodyMomentum(*v).to_space(g))
        }
        (Value::Momentum(Frame::Body, v), Value::Quaternion(g)) => {
            spatial(BodyMomentum(*v).to_space(g))
        }
        (Value::Momentum(Frame::Body, v), Value::Plane(g)) => {
            Value::Momentum(Frame::Spatial, BodyPlaneImpulse(*v).to_space(g).0)
        }
        (Value::Momentum(Frame::Carried, v), Value::Plane(g)) => {
            Value::Momentum(Frame::Spatial, CarriedPlaneImpulse(*v).to_space(g).0)
        }
        (Value::Impulse(Frame::Body, v), Value::Motion(g)) => {
            impulse(Frame::Spatial, &BodyImpulse(v.fixed()).to_space(g).0)
        }
        (Value::Impulse(Frame::Carried, v), Value::Motion(g)) => {
            impulse(Frame::Spatial, &CarriedImpulse(v.fixed()).to_space(g).0)
        }
        _ => {
            let all = components(momentum)?;
            let there = by_matrix(element, &all, true)?;
            Value::momentum(Frame::Spatial, &Value::of(there))?
        }
    })
}

fn to_body<T: Real>(a: &[&Value<T>], _: &[usize]) -> Option<Value<T>> {
    let (momentum, element) = (a.first()?, a.get(1)?);
    Some(match (momentum, element) {
        (Value::Momentum(Frame::Spatial, v), Value::Rotation(g)) => {
            body(SpatialMomentum(*v).to_body(g))
        }
        (Value::Momentum(Frame::Spatial, v), Value::Quaternion(g)) => {
            body(SpatialMomentum(*v).to_body(g))
        }
        (Value::Momentum(Frame::Spatial, v), Value::Plane(g)) => {
            Value::Momentum(Frame::Body, SpatialPlaneImpulse(*v).to_body(g).0)
        }
        (Value::Momentum(Frame::Carried, v), Value::Plane(g)) => {
            Value::Momentum(Frame::Body, CarriedPlaneImpulse(*v).to_body(g).0)
        }
        (Value::Impulse(Frame::Spatial, v), Value::Motion(g)) => {
            impulse(Frame::Body, &SpatialImpulse(v.fixed()).to_body(g).0)
        }
        (Value::Impulse(Frame::Carried, v), Value::Motion(g)) => {
            impulse(Frame::Body, &CarriedImpulse(v.fixed()).to_body(g).0)
        }
        _ => {
            let all = components(momentum)?;
            let there = by_matrix(element, &all, false)?;
            Value::momentum(Frame::Body, &Value::of(there))?
        }
    })
}

fn carried<T: Real>(a: &[&Value<T>], _: &[usize]) -> Option<Value<T>> {
    Some(match (a.first()?, a.get(1)?) {
        (Value::Momentum(Frame::Body, v), Value::Plane(g)) => {
            Value::Momentum(Frame::Carried, BodyPlaneImpulse(*v).carried(g).0)
        }
        (Value::Impulse(Frame::Body, v), Value::Motion(g)) => {
            impulse(Frame::Carried, &BodyImpulse(v.fixed()).carried(g).0)
        }
        _ => return None,
    })
}

fn gained<T: Real>(a: &[&Value<T>], _: &[usize]) -> Option<Value<T>> {
    let [element, velocity, turned] = a else {
        return None;
    };
    Some(match (element, velocity, turned) {
        (Value::Motion(g), Value::Motion(v), Value::Dense(m)) => {
            Value::of(Dense::of(&g.gained_along(v, &m.fixed::<6, 1>())))
        }
        (Value::Plane(g), Value::Plane(v), Value::Vector(m)) => Value::Vector(g.gained_along(v, m)),
        _ => return None,
    })
}

fn spatial<T: Real>(m: SpatialMomentum<T>) -> Value<T> {
    Value::Momentum(Frame::Spatial, m.0)
}

fn body<T: Real>(m: BodyMomentum<T>) -> Value<T> {
    Value::Momentum(Frame::Body, m.0)
}

fn impulse<T: Real>(frame: Frame, v: &nalgebra::SVector<T, 6>) -> Value<T> {
    Value::Impulse(frame, Dense::of(v))
}

fn components<T: Real>(momentum: &Value<T>) -> Option<Dense<T>> {
    match momentum {
        Value::Momentum(_, v) => Some(Dense::of::<3, 1>(v)),
        Value::Impulse(_, a) => Some(a.clone()),
        _ => None,
    }
}

/// The components of a momentum on SO(3).
pub(super) fn three<T: Real>(frame: Frame, a: &Value<T>) -> Option<Vector3<T>> {
    match a {
        Value::Momentum(f, v) if *f == frame => Some(*v),
        _ => None,
    }
}

pub(super) fn native<T: Real>(name: &str, arguments: usize) -> Option<Native<T>> {
    Some(match (name, arguments) {
        ("to_space", 2) => to_space,
        ("to_body", 2) => to_body,
        ("carried", 2) => carried,
        ("covector_to_space", 2) => covector!(covector_to_space, true),
        ("covector_to_body", 2) => covector!(covector_to_body, false),
        ("covector_turned", 2) => turned!(covector_turned),
        ("covector_turned_back", 2) => turned!(covector_turned_back),
        ("gained_along", 3) => gained,
        _ => return None,
    })
}
