//! The groups of velocities, with elements as lists of numbers: the runtime's own groups if they are types, otherwise
//! matrices in plain loops.

use crate::library::groups::{composed_kept, inverse_kept};
use crate::value::{MatrixGroup, Value};
use clebsch::groups::{Coordinate, Part};
use clebsch::linalg::{Dense, Reals};
use clebsch::{Group, OfScalars, PlaneMotion, Real, RigidMotion, Rotation, UnitQuaternion};

/// A group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Rotations of space.
    Rotation,
    /// Unit quaternions.
    Quaternion,
    /// Rigid motions of space.
    Motion,
    /// Rigid motions of the plane.
    Plane,
    /// Invertible maps in this number of dimensions.
    Linear(usize),
    /// Rotations in this number of dimensions.
    Orthogonal(usize),
    /// Fields with these numbers of rows and columns.
    Field(usize, usize),
}

/// An expression with the group of a kind as a type, or a second expression for matrices of any size.
macro_rules! of_type {
    ($kind:expr, $G:ident => $body:expr, $matrix:ident => $other:expr) => {{
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
            Kind::Linear(n) => {
                let $matrix = Matrix(MatrixGroup::Linear, n, n);
                $other
            }
            Kind::Orthogonal(n) => {
                let $matrix = Matrix(MatrixGroup::Orthogonal, n, n);
                $other
            }
            Kind::Field(rows, cols) => {
                let $matrix = Matrix(MatrixGroup::Field, rows, cols);
                $other
            }
        }
    }};
}

/// An element from its numbers.
pub fn read<G>(numbers: &[f64]) -> G
where
    G: Group<f64> + OfScalars<Scalar = f64, Over<f64> = G>,
{
    let mut all = numbers.iter().copied();
    G::identity().over(&mut |x| all.next().unwrap_or(x))
}

/// Appends the numbers of an element.
pub fn write<G: OfScalars<Scalar = f64>>(element: &G, out: &mut Reals) {
    element.over(&mut |x| {
        out.push(x);
        x
    });
}

impl Kind {
    /// How many coordinates it has.
    pub fn dimension(self) -> usize {
        of_type!(self, G => <G as Group<f64>>::DIMENSION, matrix => matrix.dimension())
    }

    /// How many numbers an element has.
    pub fn count(self) -> usize {
        match self {
            Kind::Linear(n) | Kind::Orthogonal(n) => n * n,
            Kind::Field(rows, cols) => rows * cols,
            _ => {
                let mut all = Reals::new();
                self.identity(&mut all);
                all.len()
            }
        }
    }

    /// How many parts its coordinates have.
    pub fn parts(self) -> usize {
        of_type!(self, G => <G as Group<f64>>::PARTS, _matrix => 1)
    }

    /// The meaning of a coordinate.
    pub fn coordinate(self, index: usize) -> Coordinate {
        match self {
            Kind::Linear(n) => Coordinate::of(Part::entry(index, n)),
            Kind::Orthogonal(n) => Coordinate::of(Part::of_pair(index, n)),
            Kind::Field(_, cols) => Coordinate::of(Part::entry(index, cols)),
            _ => of_type!(
                self,
                G => <G as Group<f64>>::coordinate(index),
                _matrix => Coordinate::of(Part::axis(index))
            ),
        }
    }

    /// The part of a coordinate.
    pub fn part_of(self, index: usize) -> usize {
        of_type!(self, G => <G as Group<f64>>::part_of(index), _matrix => 0)
    }

    /// Whether the group of a part is not a direct sum.
    pub fn is_pure(self, part: usize) -> bool {
        of_type!(
            self,
            G => <G as Group<f64>>::is_pure(part),
            matrix => matrix.0 != MatrixGroup::Field
        )
    }

    /// Whether elements of the group lack a natural scale.
    pub fn is_open(self) -> bool {
        matches!(self, Kind::Linear(_) | Kind::Field(..))
    }

    /// An element as a value.
    pub fn value(self, numbers: &[f64]) -> Value<f64> {
        match self {
            Kind::Rotation => Value::Rotation(read(numbers)),
            Kind::Quaternion => Value::Quaternion(read(numbers)),
            Kind::Motion => Value::Motion(Box::new(read(numbers))),
            Kind::Plane => Value::Plane(Box::new(read(numbers))),
            Kind::Linear(n) => Matrix(MatrixGroup::Linear, n, n).value(numbers),
            Kind::Orthogonal(n) => Matrix(MatrixGroup::Orthogonal, n, n).value(numbers),
            Kind::Field(rows, cols) => Matrix(MatrixGroup::Field, rows, cols).value(numbers),
        }
    }

    /// Appends the neutral element.
    pub fn identity(self, out: &mut Reals) {
        of_type!(
            self,
            G => write(&<G as Group<f64>>::identity(), out),
            matrix => out.extend(matrix.identity().data)
        );
    }

    /// Appends the element moved by coordinates from the right.
    pub fn retract(self, at: &[f64], xi: &[f64], out: &mut Reals) {
        of_type!(
            self,
            G => write(&Group::retract(&read::<G>(at), xi), out),
            matrix => match matrix.0 {
                MatrixGroup::Field => out.extend(matrix.places().map(|(i, j, k)| {
                    at.get(k).copied().unwrap_or(0.0) + matrix.coordinate(xi, i, j)
                })),
                _ => out.extend(matrix.retract(&matrix.read(at), xi).data),
            }
        );
    }

    /// Appends the element moved by coordinates from the left.
    pub fn retract_from_left(self, at: &[f64], xi: &[f64], out: &mut Reals) {
        of_type!(
            self,
            G => write(&Group::retract_from_left(&read::<G>(at), xi), out),
            matrix => {
                out.extend(matrix.retract_from_left(&matrix.read(at), xi).data);
            }
        );
    }

    /// Appends `from^-1 . to`.
    pub fn between(self, from: &[f64], to: &[f64], out: &mut Reals) {
        of_type!(
            self,
            G => write(&read::<G>(from).inverse().compose(&read::<G>(to)), out),
            matrix => {
                let back = inverse_kept(matrix.0, &matrix.read(from));
                out.extend(composed_kept(matrix.0, &back, &matrix.read(to)).data);
            }
        );
    }

    /// The squared lengths of the parts of an element, and its squared distances from coordinates: see
    /// [`Group::compared`].
    pub fn compared(self, of: &[f64], xi: &[f64], out: &mut [[f64; 2]]) {
        of_type!(
            self,
            G => Group::compared(&read::<G>(of), xi, out),
            matrix => if let Some(first) = out.first_mut() {
                *first = matrix.compared(of, xi);
            }
        );
    }

    /// Whether an element is within a reach: see [`Group::is_within`].
    pub fn is_within(self, of: &[f64], reach: &[f64]) -> bool {
        of_type!(
            self,
            G => Group::is_within(&read::<G>(of), reach),
            matrix => matrix.is_within(of, reach.first().copied().unwrap_or(0.0))
        )
    }

    /// Appends the weighted combination of past elements that predicts the next one: see [`Group::combined`].
    pub fn combined<'a>(self, weights: &[f64], past: &dyn Fn(usize) -> &'a [f64], out: &mut Reals) {
        of_type!(
            self,
            G => write(&<G as Group<f64>>::combined(weights, |i| read(past(i))), out),
            matrix => match matrix.0 {
                MatrixGroup::Orthogonal => out.extend_from_slice(past(0)),
                _ => out.extend(matrix.places().map(|(_, _, k)| {
                    let entry = |i: usize| past(i).get(k).copied().unwrap_or(0.0);
                    let terms = weights.iter().enumerate();
                    terms.fold(0.0, |sum, (i, weight)| sum + entry(i) * weight)
                })),
            }
        );
    }
}

/// An element moved by coordinates, from the right or from the left, for any scalar. Returns nothing if the value is not an
/// element of a group.
pub fn moved<T: Real>(element: &Value<T>, xi: &[T], from_left: bool) -> Option<Value<T>> {
    fn typed<T: Real, G: Group<T>>(g: &G, xi: &[T], from_left: bool) -> G {
        match from_left {
            true => g.retract_from_left(xi),
            false => g.retract(xi),
        }
    }
    Some(match element {
        Value::Rotation(g) => Value::Rotation(typed(g, xi, from_left)),
        Value::Quaternion(g) => Value::Quaternion(typed(g, xi, from_left)),
        Value::Motion(g) => Value::Motion(Box::new(typed(&**g, xi, from_left))),
        Value::Plane(g) => Value::Plane(Box::new(typed(&**g, xi, from_left))),
        Value::Element(group, a) => {
            let matrix = Matrix(*group, a.rows, a.cols);
            let moved = match from_left {
                true => matrix.retract_from_left(a, xi),
                false => matrix.retract(a, xi),
            };
            Value::Element(*group, moved)
        }
        _ => return None,
    })
}

/// The group of a matrix, its rows and its columns.
#[derive(Clone, Copy)]
struct Matrix(MatrixGroup, usize, usize);

impl Matrix {
    fn dimension(self) -> usize {
        let Matrix(kept, rows, cols) = self;
        match kept {
            MatrixGroup::Orthogonal => rows * rows.saturating_sub(1) / 2,
            _ => rows * cols,
        }
    }

    fn read(self, numbers: &[f64]) -> Dense<f64> {
        Dense {
            rows: self.1,
            cols: self.2,
            data: numbers.to_vec(),
        }
    }

    fn value(self, numbers: &[f64]) -> Value<f64> {
        Value::Element(self.0, self.read(numbers))
    }

    fn identity<T: Real>(self) -> Dense<T> {
        match self.0 {
            MatrixGroup::Field => Dense::zeros(self.1, self.2),
            _ => Dense::identity(self.1, self.2),
        }
    }

    /// Row, column and index of each number.
    fn places(self) -> impl Iterator<Item = (usize, usize, usize)> {
        let Matrix(_, rows, cols) = self;
        (0..rows * cols).map(move |k| (k % rows, k / rows, k))
    }

    fn coordinate<T: Real>(self, xi: &[T], i: usize, j: usize) -> T {
        xi.get(self.2 * i + j).copied().unwrap_or(T::zero())
    }

    fn coordinates<T: Real>(self, xi: &[T]) -> Dense<T> {
        Dense::from_fn(self.1, self.2, |i, j| self.coordinate(xi, i, j))
    }

    /// The sum of the squares of an element's distance from the identity.
    fn squares(self, a: &[f64]) -> f64 {
        self.places().fold(0.0, |sum, place| {
            let x = self.beyond_identity(a, place);
            sum + x * x
        })
    }

    /// A number of an element minus the same number of the identity.
    fn beyond_identity(self, a: &[f64], (i, j, k): (usize, usize, usize)) -> f64 {
        let x = a.get(k).copied().unwrap_or(0.0);
        match self.0 {
            MatrixGroup::Field => x,
            _ => x - if i == j { 1.0 } else { 0.0 },
        }
    }

    fn retract<T: Real>(self, a: &Dense<T>, xi: &[T]) -> Dense<T> {
        match self.0 {
            MatrixGroup::Linear => a.plus(&a.times(&self.coordinates(xi))),
            MatrixGroup::Field => a.plus(&self.coordinates(xi)),
            MatrixGroup::Orthogonal => {
                let half = Dense::skew_from(a.rows, xi).scaled(T::from_f64(0.5));
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

    fn retract_from_left<T: Real>(self, a: &Dense<T>, xi: &[T]) -> Dense<T> {
        composed_kept(self.0, &self.retract(&self.identity(), xi), a)
    }

    fn compared(self, a: &[f64], xi: &[f64]) -> [f64; 2] {
        match self.0 {
            MatrixGroup::Linear | MatrixGroup::Field => {
                let mut both = [0.0; 2];
                for i in 0..self.1 {
                    for j in 0..self.2 {
                        let x = self.beyond_identity(a, (i, j, j * self.1 + i));
                        let off = x - self.coordinate(xi, i, j);
                        both[0] += x * x;
                        both[1] += off * off;
                    }
                }
                both
            }
            MatrixGroup::Orthogonal => {
                let a = self.read(a);
                let half = Dense::skew_from(a.rows, xi).scaled(0.5);
                let off = a.minus(&a.times(&half)).minus(&half).minus_one();
                let eighth = a.minus_one().squares() * 0.125;
                let near = 1.0 - eighth;
                match near > 0.0 {
                    true => [eighth * 4.0 / near, off.squares() * 0.5 / near],
                    false => [f64::INFINITY; 2],
                }
            }
        }
    }

    fn is_within(self, a: &[f64], reach: f64) -> bool {
        match self.0 {
            MatrixGroup::Linear | MatrixGroup::Field => self.squares(a) - reach * reach <= 0.0,
            MatrixGroup::Orthogonal => {
                let eighth = self.squares(a) * 0.125;
                eighth * 4.0 - (1.0 - eighth) * (reach * reach) <= 0.0
            }
        }
    }
}
