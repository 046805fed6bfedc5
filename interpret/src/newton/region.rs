//! Velocities in bounds, of any groups together: the runtime's own regions, as values that equations are
//! evaluated on.

use super::bound::{Bound, VARIABLES};
use super::element::Element;
use super::shape::kinds;
use crate::dense::Dense;
use crate::library::NAMES;
use crate::value::{Kept, Layout, Struct, Value};
use clebsch::solvers::newton::{
    AdditiveRegion, Enclosure, LinearRegion, MotionRegion, OrthogonalRegion, PlaneMotionRegion,
    QuaternionRegion, Region, RotationRegion,
};
use nalgebra::SMatrix;
use std::sync::{Arc, OnceLock};

/// Regions of all factors.
pub struct Regions<const D: usize> {
    values: Vec<Value<Bound>>,
}

impl<const D: usize> Regions<D> {
    /// As emitted code has them: a list.
    pub fn value(&self) -> Value<Bound> {
        Value::List(self.values.clone())
    }
}

impl<const D: usize> Region<VARIABLES> for Regions<D> {
    type Centre = Element<D>;
    const VARIABLES: usize = VARIABLES;

    fn around(centre: &Element<D>, radii: &[f64], first: usize) -> Self {
        let (mut part, mut next) = (0, first);
        let values = kinds().iter().enumerate().map(|(i, kind)| {
            let own = radii.get(part..).unwrap_or(&[]);
            let value = centre.at(i).around(own, next);
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
        put: &mut impl FnMut(usize, usize, Enclosure<VARIABLES>),
    ) {
        let (mut part, mut next, mut at) = (0, first, 0);
        for kind in kinds() {
            let own = radii.get(part..).unwrap_or(&[]);
            kind.chart_tangent(own, next, &mut |i, j, x| put(at + i, at + j, x));
            part += kind.parts();
            next += kind.variables();
            at += kind.dimension().unwrap_or(0);
        }
    }
}

/// A region as a value, of which its matrix and its parts are asked.
pub trait Seen {
    /// That value.
    fn seen(&self) -> Value<Bound>;
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

fn dense<const R: usize, const C: usize>(a: &SMatrix<Enclosure<VARIABLES>, R, C>) -> Dense<Bound> {
    Dense::of(&a.map(Bound))
}

fn parts(list: &[(&str, Value<Bound>)]) -> Value<Bound> {
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

impl Seen for RotationRegion<VARIABLES> {
    fn seen(&self) -> Value<Bound> {
        Value::Element(Kept::Orthogonal, dense(&self.matrix()))
    }
}

impl Seen for QuaternionRegion<VARIABLES> {
    fn seen(&self) -> Value<Bound> {
        parts(&[
            ("real", Value::Real(Bound(self.real()))),
            ("imaginary", Value::Vector(self.imaginary().map(Bound))),
            ("matrix", Value::of(dense(&self.matrix()))),
        ])
    }
}

impl Seen for MotionRegion<VARIABLES> {
    fn seen(&self) -> Value<Bound> {
        parts(&[
            ("rotation", self.rotation.seen()),
            ("translation", Value::Vector(self.translation.map(Bound))),
            ("matrix", Value::of(dense(&self.matrix()))),
        ])
    }
}

impl Seen for PlaneMotionRegion<VARIABLES> {
    fn seen(&self) -> Value<Bound> {
        Value::Element(Kept::Linear, dense(&self.matrix()))
    }
}

impl<const N: usize> Seen for LinearRegion<N, VARIABLES> {
    fn seen(&self) -> Value<Bound> {
        Value::Element(Kept::Linear, dense(&self.matrix()))
    }
}

impl<const N: usize> Seen for OrthogonalRegion<N, VARIABLES> {
    fn seen(&self) -> Value<Bound> {
        Value::Element(Kept::Orthogonal, dense(&self.matrix()))
    }
}

impl<const R: usize, const C: usize> Seen for AdditiveRegion<R, C, VARIABLES> {
    fn seen(&self) -> Value<Bound> {
        Value::Element(Kept::Field, dense(&self.matrix()))
    }
}
