//! Which groups a search for velocities is in, and what they do: the runtime's own groups where these are
//! types, matrices in plain loops where their sizes are known when a model is read.

use crate::library::groups::{composed_kept, inverse_kept};
use crate::value::{Kept, Value};
use clebsch::Group;
use clebsch::groups::{Coordinate, Part};
use clebsch::linalg::Dense;
use clebsch::solvers::newton::{Chart, Parts};
use clebsch::{PlaneMotion, RigidMotion, Rotation, UnitQuaternion};

/// A group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Rotations of space.
    Rotation,
    /// Unit quaternions.
    Quaternion,
    /// Rigid motions of space.
    Motion,
    /// Those of the plane.
    Plane,
    /// Invertible maps of so many dimensions.
    Linear(usize),
    /// Rotations of so many dimensions.
    Orthogonal(usize),
    /// Fields of so many rows and columns.
    Field(usize, usize),
}

/// The body for the group of a kind, where that is a type.
macro_rules! of_type {
    ($kind:expr, $G:ident, $body:expr, $other:expr) => {{
        macro_rules! with {
            ($g:ty) => {{
                type $G = $g;
                $body
            }};
        }
        match $kind {
            Kind::Rotation => with!(Rotation<f64>),
            Kind::Quaternion => with!(UnitQuaternion<f64>),
            Kind::Motion => with!(RigidMotion<f64>),
            Kind::Plane => with!(PlaneMotion<f64>),
            _ => $other,
        }
    }};
}

/// The element of an element that is a type, and what is made of it.
macro_rules! of_element {
    ($value:expr, $g:ident => $body:expr, ($kept:ident, $a:ident) => $other:expr) => {
        match $value {
            Value::Rotation($g) => Some($body),
            Value::Quaternion($g) => Some($body),
            Value::Motion(boxed) => {
                let $g = &**boxed;
                Some($body)
            }
            Value::Plane(boxed) => {
                let $g = &**boxed;
                Some($body)
            }
            Value::Element($kept, $a) => Some($other),
            _ => None,
        }
    };
}
/// An element as a value.
trait Told {
    fn told(self) -> Value<f64>;
}
impl Told for Rotation<f64> {
    fn told(self) -> Value<f64> {
        Value::Rotation(self)
    }
}
impl Told for UnitQuaternion<f64> {
    fn told(self) -> Value<f64> {
        Value::Quaternion(self)
    }
}
impl Told for RigidMotion<f64> {
    fn told(self) -> Value<f64> {
        Value::Motion(Box::new(self))
    }
}
impl Told for PlaneMotion<f64> {
    fn told(self) -> Value<f64> {
        Value::Plane(Box::new(self))
    }
}

impl Kind {
    /// How many coordinates.
    pub fn dimension(self) -> usize {
        match self {
            Kind::Linear(n) => n * n,
            Kind::Orthogonal(n) => n * n.saturating_sub(1) / 2,
            Kind::Field(rows, cols) => rows * cols,
            _ => of_type!(self, G, <G as Group<f64>>::DIMENSION, 0),
        }
    }

    /// How many parts these have.
    pub fn parts(self) -> usize {
        of_type!(self, G, <G as Group<f64>>::PARTS, 1)
    }

    fn coordinate(self, index: usize) -> Coordinate {
        match self {
            Kind::Linear(n) => Coordinate::of(Part::entry(index, n)),
            Kind::Orthogonal(n) => Coordinate::of(Part::of_pair(index, n)),
            Kind::Field(_, cols) => Coordinate::of(Part::entry(index, cols)),
            _ => of_type!(
                self,
                G,
                <G as Group<f64>>::coordinate(index),
                Coordinate::of(Part::axis(index))
            ),
        }
    }

    fn part_of(self, index: usize) -> usize {
        of_type!(self, G, <G as Group<f64>>::part_of(index), 0)
    }

    fn is_pure(self, part: usize) -> bool {
        let other = !matches!(self, Kind::Field(..));
        of_type!(self, G, <G as Group<f64>>::is_pure(part), other)
    }

    fn identity(self) -> Value<f64> {
        match self {
            Kind::Linear(n) => Value::Element(Kept::Linear, Dense::identity(n, n)),
            Kind::Orthogonal(n) => Value::Element(Kept::Orthogonal, Dense::identity(n, n)),
            Kind::Field(rows, cols) => Value::Element(Kept::Field, Dense::zeros(rows, cols)),
            _ => of_type!(self, G, <G as Group<f64>>::identity().told(), Value::None),
        }
    }
}

/// An element kept as its matrix, moved by coordinates.
fn retracted(kept: Kept, a: &Dense<f64>, xi: &[f64]) -> Dense<f64> {
    let x = |i: usize, j: usize| xi.get(a.cols * i + j).copied().unwrap_or(0.0);
    match kept {
        Kept::Linear => a.plus(&a.times(&Dense::from_fn(a.rows, a.cols, x))),
        Kept::Field => a.plus(&Dense::from_fn(a.rows, a.cols, x)),
        Kept::Orthogonal => {
            let half = Dense::skew_from(a.rows, xi).scaled(0.5);
            let one = Dense::identity(a.rows, a.rows);
            match one.minus(&half).solved(&one) {
                Some(inverse) => a
                    .times(&inverse.plus(&inverse).minus(&one))
                    .orthonormalised(),
                None => Dense::unknown(a.rows, a.cols),
            }
        }
    }
}

fn retract(g: &Value<f64>, xi: &[f64]) -> Option<Value<f64>> {
    of_element!(
        g,
        g => Group::retract(g, xi).told(),
        (kept, a) => Value::Element(*kept, retracted(*kept, a, xi))
    )
}

fn retract_from_left(kind: Kind, g: &Value<f64>, xi: &[f64]) -> Option<Value<f64>> {
    let from = kind.identity();
    of_element!(
        g,
        g => Group::retract_from_left(g, xi).told(),
        (kept, a) => match retract(&from, xi)? {
            Value::Element(_, moved) => Value::Element(*kept, composed_kept(*kept, &moved, a)),
            _ => return None,
        }
    )
}

fn between(from: &Value<f64>, to: &Value<f64>) -> Option<Value<f64>> {
    fn of<G: Group<f64>>(from: &G, to: &G) -> G {
        from.inverse().compose(to)
    }
    Some(match (from, to) {
        (Value::Rotation(a), Value::Rotation(b)) => of(a, b).told(),
        (Value::Quaternion(a), Value::Quaternion(b)) => of(a, b).told(),
        (Value::Motion(a), Value::Motion(b)) => of(&**a, b).told(),
        (Value::Plane(a), Value::Plane(b)) => of(&**a, b).told(),
        (Value::Element(kept, a), Value::Element(_, b)) => {
            Value::Element(*kept, composed_kept(*kept, &inverse_kept(*kept, a), b))
        }
        _ => return None,
    })
}

fn extents(g: &Value<f64>, out: &mut [f64]) -> Option<()> {
    of_element!(
        g,
        g => g.extents(out),
        (kept, a) => if let Some(first) = out.first_mut() {
            *first = match kept {
                Kept::Linear => a.minus_one().squares().sqrt(),
                Kept::Field => a.squares().sqrt(),
                Kept::Orthogonal => {
                    let eighth = a.minus_one().squares() * 0.125;
                    let square = eighth * 4.0 / (1.0 - eighth);
                    if eighth < 1.0 { square.sqrt() } else { f64::INFINITY }
                }
            };
        }
    )
}

fn compared(g: &Value<f64>, xi: &[f64], out: &mut [[f64; 2]]) -> Option<()> {
    let of = |own: &Dense<f64>| {
        let mut both = [0.0; 2];
        for i in 0..own.rows {
            for j in 0..own.cols {
                let x = own.at(i, j);
                let off = x - xi.get(own.cols * i + j).copied().unwrap_or(0.0);
                both[0] += x * x;
                both[1] += off * off;
            }
        }
        both
    };
    of_element!(
        g,
        g => g.compared(xi, out),
        (kept, a) => if let Some(first) = out.first_mut() {
            *first = match kept {
                Kept::Linear => of(&a.minus_one()),
                Kept::Field => of(a),
                Kept::Orthogonal => {
                    let half = Dense::skew_from(a.rows, xi).scaled(0.5);
                    let off = a.minus(&a.times(&half)).minus(&half).minus_one();
                    let eighth = a.minus_one().squares() * 0.125;
                    let near = 1.0 - eighth;
                    match near > 0.0 {
                        true => [eighth * 4.0 / near, off.squares() * 0.5 / near],
                        false => [f64::INFINITY; 2],
                    }
                }
            };
        }
    )
}

fn is_within(g: &Value<f64>, reach: &[f64]) -> Option<bool> {
    of_element!(
        g,
        g => g.is_within(reach),
        (kept, a) => {
            let reach = reach.first().copied().unwrap_or(0.0);
            match kept {
                Kept::Linear => a.minus_one().squares() - reach * reach <= 0.0,
                Kept::Field => a.squares() - reach * reach <= 0.0,
                Kept::Orthogonal => {
                    let eighth = a.minus_one().squares() * 0.125;
                    eighth * 4.0 - (1.0 - eighth) * (reach * reach) <= 0.0
                }
            }
        }
    )
}

fn combined(kind: Kind, weights: &[f64], past: &[&Value<f64>]) -> Value<f64> {
    macro_rules! of {
        ($kind:ident, $g:ident => $element:expr) => {{
            let one = |i: usize| match past.get(i) {
                Some(Value::$kind($g)) => $element,
                _ => Group::<f64>::identity(),
            };
            Group::combined(weights, one).told()
        }};
    }
    let first = || past.first().map_or(Value::None, |x| (*x).clone());
    match kind {
        Kind::Rotation => of!(Rotation, g => *g),
        Kind::Quaternion => of!(Quaternion, g => *g),
        Kind::Motion => of!(Motion, g => **g),
        Kind::Plane => of!(Plane, g => **g),
        Kind::Orthogonal(_) => first(),
        Kind::Linear(_) | Kind::Field(..) => {
            let Some(Value::Element(kept, a)) = past.first() else {
                return first();
            };
            let mut sum = Dense::zeros(a.rows, a.cols);
            for (weight, x) in weights.iter().zip(past) {
                if let Value::Element(_, x) = x {
                    sum = sum.plus(&x.scaled(*weight));
                }
            }
            Value::Element(*kept, sum)
        }
    }
}

/// The groups of the velocities that are found together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shape {
    /// One after the other.
    kinds: Vec<Kind>,
    parts: Parts,
}

impl Shape {
    /// Of these groups.
    pub fn new(kinds: Vec<Kind>) -> Self {
        let mut parts = Parts {
            of: Vec::new(),
            pure: Vec::new(),
            open: Vec::new(),
        };
        for kind in &kinds {
            let before = parts.pure.len();
            let own = (0..kind.dimension()).map(|i| before + kind.part_of(i));
            parts.of.extend(own);
            parts
                .pure
                .extend((0..kind.parts()).map(|i| kind.is_pure(i)));
            let open = matches!(kind, Kind::Linear(_) | Kind::Field(..));
            parts.open.extend((0..kind.parts()).map(|_| open));
        }
        Shape { kinds, parts }
    }

    /// Which coordinates of all unknowns those of this part of them are.
    pub fn within(&self, whole: &Shape) -> Vec<usize> {
        let (mut first, mut all) = (0, Vec::new());
        for (own, kind) in self.kinds.iter().zip(&whole.kinds) {
            all.extend(first..first + own.dimension());
            first += kind.dimension();
        }
        all
    }

    /// Each group with a list of its own lengths.
    fn each<'a>(&'a self, radii: &'a [f64]) -> impl Iterator<Item = (Kind, &'a [f64])> {
        let mut part = 0;
        self.kinds.iter().map(move |kind| {
            let own = radii.get(part..).unwrap_or(&[]);
            part += kind.parts();
            (*kind, own)
        })
    }

    /// The coordinates of each factor.
    fn split<'a>(&'a self, xi: &'a [f64]) -> impl Iterator<Item = (Kind, &'a [f64])> {
        let mut rest = xi;
        self.kinds.iter().map(move |kind| {
            let (own, others) = rest.split_at(kind.dimension().min(rest.len()));
            rest = others;
            (*kind, own)
        })
    }
}

impl Chart for Shape {
    type Element = Vec<Value<f64>>;

    fn parts(&self) -> &Parts {
        &self.parts
    }

    fn part(&self, whole: &Vec<Value<f64>>) -> Vec<Value<f64>> {
        let pairs = self.kinds.iter().zip(whole);
        pairs
            .map(|(kind, value)| match (kind, value) {
                (Kind::Rotation, Value::Motion(g)) => Value::Rotation(g.rotation),
                _ => value.clone(),
            })
            .collect()
    }

    fn coordinate(&self, index: usize) -> Coordinate {
        let mut rest = index;
        for (i, kind) in self.kinds.iter().enumerate() {
            if rest < kind.dimension() {
                return kind.coordinate(rest).in_factor(i);
            }
            rest -= kind.dimension();
        }
        Coordinate::of(Part::axis(index))
    }

    fn identity(&self) -> Vec<Value<f64>> {
        self.kinds.iter().map(|kind| kind.identity()).collect()
    }

    fn retract(&self, at: &Vec<Value<f64>>, xi: &[f64]) -> Vec<Value<f64>> {
        let each = at.iter().zip(self.split(xi));
        each.map(|(g, (_, own))| retract(g, own).unwrap_or(Value::None))
            .collect()
    }

    fn retract_from_left(&self, at: &Vec<Value<f64>>, xi: &[f64]) -> Vec<Value<f64>> {
        let each = at.iter().zip(self.split(xi));
        each.map(|(g, (kind, own))| retract_from_left(kind, g, own).unwrap_or(Value::None))
            .collect()
    }

    fn combined(&self, weights: &[f64], past: &[Vec<Value<f64>>]) -> Vec<Value<f64>> {
        let each = self.kinds.iter().enumerate();
        each.map(|(k, kind)| {
            let own: Vec<&Value<f64>> = past.iter().filter_map(|all| all.get(k)).collect();
            combined(*kind, weights, &own)
        })
        .collect()
    }

    fn between(&self, from: &Vec<Value<f64>>, to: &Vec<Value<f64>>) -> Vec<Value<f64>> {
        let pairs = from.iter().zip(to);
        pairs
            .map(|(g, next)| between(g, next).unwrap_or(Value::None))
            .collect()
    }

    fn extents(&self, of: &Vec<Value<f64>>, out: &mut [f64]) {
        let mut rest = out;
        for (kind, g) in self.kinds.iter().zip(of) {
            let (own, others) = rest.split_at_mut(kind.parts().min(rest.len()));
            let _ = extents(g, own);
            rest = others;
        }
    }

    fn compared(&self, of: &Vec<Value<f64>>, xi: &[f64], out: &mut [[f64; 2]]) {
        let mut rest = out;
        for (g, (kind, xi)) in of.iter().zip(self.split(xi)) {
            let (own, others) = rest.split_at_mut(kind.parts().min(rest.len()));
            let _ = compared(g, xi, own);
            rest = others;
        }
    }

    fn is_within(&self, of: &Vec<Value<f64>>, reach: &[f64]) -> bool {
        let all = self.each(reach).zip(of);
        all.fold(true, |all, ((_, own), g)| {
            all & is_within(g, own).unwrap_or(false)
        })
    }
}
