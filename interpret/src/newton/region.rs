//! Velocities in bounds, of any groups together: the runtime's own regions, as values that equations are
//! evaluated on.

use super::bound::{Along, Bound};
use super::shape::Kind;
use crate::library::NAMES;
use crate::value::{Kept, Layout, Struct, Value};
use clebsch::linalg::Dense;
use clebsch::solvers::newton::{
    Enclosure, MotionRegion, PlaneMotionRegion, QuaternionRegion, Region, RotationRegion,
};
use nalgebra::SMatrix;
use num_traits::Zero;
use std::sync::{Arc, OnceLock};

/// All elements whose coordinates, seen from one, do not exceed radii, in the variables from `first` on, of
/// `width` in all.
pub fn around(g: &Value<f64>, radii: &[f64], first: usize, width: usize) -> Value<Bound> {
    fn of<R: Region<K> + Seen, const K: usize>(
        g: &R::Centre,
        radii: &[f64],
        first: usize,
    ) -> Value<Bound> {
        R::around(g, radii, 0).seen(first)
    }
    // Without variables each number is by itself.
    macro_rules! of {
        ($region:ident, $variables:literal, $g:expr) => {
            match width {
                0 => of::<$region<0>, 0>($g, radii, 0),
                _ => of::<$region<$variables>, $variables>($g, radii, first),
            }
        };
    }
    match g {
        Value::Rotation(g) => of!(RotationRegion, 9, g),
        Value::Quaternion(g) => of!(QuaternionRegion, 6, g),
        Value::Motion(g) => of!(MotionRegion, 12, g),
        Value::Plane(g) => of!(PlaneMotionRegion, 9, g),
        Value::Element(kept, a) => {
            let radius = radii.first().copied().unwrap_or(0.0);
            let near = match kept {
                Kept::Linear => times(a, &near_one(a.rows, radius, first)),
                Kept::Orthogonal => {
                    let turned = cayley_root(a.rows, radius, first).map(|x| x.times(2.0));
                    times(a, &turned.minus_one())
                }
                Kept::Field => Dense::from_fn(a.rows, a.cols, |i, j| {
                    Bound::exactly(a.at(i, j)) + Bound::variable(radius, first + a.cols * i + j)
                }),
            };
            Value::Element(*kept, near)
        }
        _ => Value::None,
    }
}

/// The derivative of the chart of a group, entry by entry.
pub fn chart_tangent(
    kind: Kind,
    radii: &[f64],
    first: usize,
    width: usize,
    put: &mut dyn FnMut(usize, usize, Bound),
) {
    macro_rules! of {
        ($region:ident, $variables:literal) => {
            match width {
                0 => $region::<0>::chart_tangent(radii, 0, &mut |i, j, x| put(i, j, lift(&x, 0))),
                _ => $region::<$variables>::chart_tangent(radii, 0, &mut |i, j, x| {
                    put(i, j, lift(&x, first));
                }),
            }
        };
    }
    let radius = radii.first().copied().unwrap_or(0.0);
    match kind {
        Kind::Rotation => of!(RotationRegion, 9),
        Kind::Quaternion => of!(QuaternionRegion, 6),
        Kind::Motion => of!(MotionRegion, 12),
        Kind::Plane => of!(PlaneMotionRegion, 9),
        Kind::Field(rows, cols) => {
            for k in 0..rows * cols {
                put(k, k, Bound::exactly(1.0));
            }
        }
        Kind::Linear(n) => {
            let back = inverse(&near_one(n, radius, first));
            for i in 0..n {
                for k in 0..n {
                    for j in 0..n {
                        put(n * i + j, n * k + j, back.at(i, k));
                    }
                }
            }
        }
        Kind::Orthogonal(n) => {
            let p = cayley_root(n, radius, first);
            let p = |i, j| p.at(i, j);
            for (row, (i, j)) in pairs(n).enumerate() {
                for (column, (k, l)) in pairs(n).enumerate() {
                    put(row, column, p(l, j) * p(k, i) - p(k, j) * p(l, i));
                }
            }
        }
    }
}

/// The matrices whose entries are as near to those of the identity.
fn near_one(n: usize, radius: f64, first: usize) -> Dense<Bound> {
    Dense::from_fn(n, n, |i, j| {
        let one = Bound::exactly(f64::from(u8::from(i == j)));
        one + Bound::variable(radius, first + n * i + j)
    })
}

/// The pairs `i < j` of axes, row by row.
fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |i| (i + 1..n).map(move |j| (i, j)))
}

/// `(1 - X/2)^-1`: the Cayley map is twice that less one.
fn cayley_root(n: usize, radius: f64, first: usize) -> Dense<Bound> {
    let half = 0.5 * radius;
    let mut a = Dense::identity(n, n);
    for (k, (i, j)) in pairs(n).enumerate() {
        let x = Bound::variable(half, first + k);
        a.set(i, j, x);
        a.set(j, i, -x);
    }
    inverse(&a)
}

/// The inverse; unbounded where there may be none.
fn inverse(a: &Dense<Bound>) -> Dense<Bound> {
    let unknown = Bound::around(f64::NAN, f64::NAN);
    a.inverse()
        .unwrap_or_else(|| Dense::repeat(a.rows, a.cols, unknown))
}

/// The matrix times a known one from the left.
fn times(a: &Dense<f64>, b: &Dense<Bound>) -> Dense<Bound> {
    Dense::from_fn(a.rows, b.cols, |i, j| {
        (0..a.cols).fold(Bound::zero(), |sum, k| sum + b.at(k, j).times(a.at(i, k)))
    })
}

/// A number with its variables counted from `first` on.
fn lift<const K: usize>(x: &Enclosure<K>, first: usize) -> Bound {
    x.over(Along::placed(x.linear(), first))
}

/// A region as a value, of which its matrix and its parts are asked.
pub trait Seen {
    /// That value, its variables counted from `first` on.
    fn seen(&self, first: usize) -> Value<Bound>;
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

fn dense<const R: usize, const C: usize, const K: usize>(
    a: &SMatrix<Enclosure<K>, R, C>,
    first: usize,
) -> Dense<Bound> {
    Dense::of(&a.map(|x| lift(&x, first)))
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

impl<const K: usize> Seen for RotationRegion<K> {
    fn seen(&self, first: usize) -> Value<Bound> {
        Value::Element(Kept::Orthogonal, dense(&self.matrix(), first))
    }
}

impl<const K: usize> Seen for QuaternionRegion<K> {
    fn seen(&self, first: usize) -> Value<Bound> {
        parts(&[
            ("real", Value::Real(lift(&self.real(), first))),
            (
                "imaginary",
                Value::Vector(self.imaginary().map(|x| lift(&x, first))),
            ),
            ("matrix", Value::of(dense(&self.matrix(), first))),
        ])
    }
}

impl<const K: usize> Seen for MotionRegion<K> {
    fn seen(&self, first: usize) -> Value<Bound> {
        parts(&[
            ("rotation", self.rotation.seen(first)),
            (
                "translation",
                Value::Vector(self.translation.map(|x| lift(&x, first))),
            ),
            ("matrix", Value::of(dense(&self.matrix(), first))),
        ])
    }
}

impl<const K: usize> Seen for PlaneMotionRegion<K> {
    fn seen(&self, first: usize) -> Value<Bound> {
        Value::Element(Kept::Linear, dense(&self.matrix(), first))
    }
}
