//! Velocities in bounds, of any groups together: the runtime's own regions, as values that equations are
//! evaluated on.

use super::element::Element;
use super::shape::{kinds, of_kind};
use crate::dense::Dense;
use crate::library::NAMES;
use crate::value::{Kept, Layout, Struct, Value};
use clebsch::Real;
use clebsch::solvers::newton::{
    AdditiveRegion, Enclosure, LinearRegion, MotionRegion, OrthogonalRegion, PlaneMotionRegion,
    QuaternionRegion, Region, RotationRegion,
};
use std::sync::{Arc, OnceLock};

/// Regions of all factors.
pub struct Regions<const D: usize, const K: usize> {
    values: Vec<Value<Enclosure<K>>>,
}

impl<const D: usize, const K: usize> Regions<D, K> {
    /// As emitted code has them: a list.
    pub fn value(&self) -> Value<Enclosure<K>> {
        Value::List(self.values.clone())
    }
}

impl<const D: usize, const K: usize> Region<K> for Regions<D, K> {
    type Centre = Element<D>;
    const VARIABLES: usize = K;

    fn around(centre: &Element<D>, radii: &[f64], first: usize) -> Self {
        let (mut part, mut next) = (0, first);
        let values = kinds().iter().enumerate().map(|(i, kind)| {
            let own = radii.get(part..).unwrap_or(&[]);
            let value = of_kind!(
                *kind,
                G,
                R,
                N,
                R::<K>::around(&centre.factor::<G>(i), own, next).seen(),
                Value::None
            );
            part += kind.parts();
            next += kind.variables();
            value
        });
        Regions {
            values: values.collect(),
        }
    }

    fn chart_tangent(
        radii: &[f64],
        first: usize,
        put: &mut impl FnMut(usize, usize, Enclosure<K>),
    ) {
        let (mut part, mut next, mut at) = (0, first, 0);
        for kind in kinds() {
            let own = radii.get(part..).unwrap_or(&[]);
            of_kind!(
                *kind,
                G,
                R,
                N,
                R::<K>::chart_tangent(own, next, &mut |i, j, x| put(at + i, at + j, x)),
                ()
            );
            part += kind.parts();
            next += kind.variables();
            at += kind.dimension().unwrap_or(0);
        }
    }
}

/// A region as a value, of which its matrix and its parts are asked.
trait Seen<T: Real> {
    fn seen(&self) -> Value<T>;
}

/// The fields by which parts of a region go.
fn layout() -> Arc<Layout> {
    static LAYOUT: OnceLock<Arc<Layout>> = OnceLock::new();
    let made = || {
        let numbers = 0..NAMES.len() as u32;
        Arc::new(Layout {
            name: "Region".to_owned(),
            fields: numbers.collect(),
        })
    };
    LAYOUT.get_or_init(made).clone()
}

fn parts<T: Real>(list: &[(&str, Value<T>)]) -> Value<T> {
    let find = |name: &str| {
        list.iter()
            .find(|(n, _)| *n == name)
            .map(|(_, v)| v.clone())
    };
    Value::Struct(Struct {
        layout: layout(),
        values: NAMES
            .iter()
            .map(|n| find(n).unwrap_or(Value::None))
            .collect(),
    })
}

impl<const K: usize> Seen<Enclosure<K>> for RotationRegion<K> {
    fn seen(&self) -> Value<Enclosure<K>> {
        Value::Element(Kept::Orthogonal, Dense::of(&self.matrix()))
    }
}

impl<const K: usize> Seen<Enclosure<K>> for QuaternionRegion<K> {
    fn seen(&self) -> Value<Enclosure<K>> {
        parts(&[
            ("real", Value::Real(self.real())),
            ("imaginary", Value::Vector(self.imaginary())),
            ("matrix", Value::of(Dense::of(&self.matrix()))),
        ])
    }
}

impl<const K: usize> Seen<Enclosure<K>> for MotionRegion<K> {
    fn seen(&self) -> Value<Enclosure<K>> {
        parts(&[
            ("rotation", self.rotation.seen()),
            ("translation", Value::Vector(self.translation)),
            ("matrix", Value::of(Dense::of(&self.matrix()))),
        ])
    }
}

impl<const K: usize> Seen<Enclosure<K>> for PlaneMotionRegion<K> {
    fn seen(&self) -> Value<Enclosure<K>> {
        Value::Element(Kept::Linear, Dense::of(&self.matrix()))
    }
}

impl<const N: usize, const K: usize> Seen<Enclosure<K>> for LinearRegion<N, K> {
    fn seen(&self) -> Value<Enclosure<K>> {
        Value::Element(Kept::Linear, Dense::of(&self.matrix()))
    }
}

impl<const N: usize, const K: usize> Seen<Enclosure<K>> for OrthogonalRegion<N, K> {
    fn seen(&self) -> Value<Enclosure<K>> {
        Value::Element(Kept::Orthogonal, Dense::of(&self.matrix()))
    }
}

impl<const R: usize, const C: usize, const K: usize> Seen<Enclosure<K>>
    for AdditiveRegion<R, C, K>
{
    fn seen(&self) -> Value<Enclosure<K>> {
        Value::Element(Kept::Field, Dense::of(&self.matrix()))
    }
}
