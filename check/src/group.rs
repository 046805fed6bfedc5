//! The groups: elements from numbers, a basis of the Lie algebra for their variations, inverses, components of
//! momenta.

use crate::matrix::Matrix;
use crate::number::{Number, UNIT, larger};
use crate::stated::Side;
use crate::varied::{OF_AN_INCREMENT, small};

/// A group of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// `SO<n>`.
    Rotation(usize),
    /// `GL<n>`.
    Linear(usize),
    /// `SU<2>`, as 4 x 4 matrices of left multiplication.
    Quaternion,
    /// `SE<n>`, by homogeneous matrices, n = 2 or 3.
    Motion(usize),
}

/// The error of an entry of a rotation, in roundings of 1: one from the stored number, two from the product of the
/// previous element with a velocity, and one from solving for the velocity.
const OF_A_TURN: f64 = 4.0;

/// The largest defect, in roundings, of columns that are orthonormalised from time to time. A larger defect is an
/// error.
pub const MOST_OF_A_DEFECT: f64 = 256.0;

/// A matrix by its entries that are not zero: row, column, value.
pub type Entries = Vec<(usize, usize, f64)>;

/// The matrix of left multiplication by a quaternion: the component and the sign for each entry.
pub const LEFT: [[(usize, f64); 4]; 4] = [
    [(0, 1.0), (1, -1.0), (2, -1.0), (3, -1.0)],
    [(1, 1.0), (0, 1.0), (3, -1.0), (2, 1.0)],
    [(2, 1.0), (3, 1.0), (0, 1.0), (1, -1.0)],
    [(3, 1.0), (2, -1.0), (1, 1.0), (0, 1.0)],
];

impl Group {
    /// The group of this name and size.
    ///
    /// # Errors
    /// There is none.
    pub fn read(name: &str, size: usize) -> Result<Self, String> {
        match (name, size) {
            ("SO", n) => Ok(Self::Rotation(n)),
            ("GL", n) => Ok(Self::Linear(n)),
            ("SU", 2) => Ok(Self::Quaternion),
            ("SE", 2 | 3) => Ok(Self::Motion(size)),
            _ => Err(format!("the group {name}<{size}> is not supported")),
        }
    }

    /// The number of rows of its matrices.
    #[must_use]
    pub fn rows(self) -> usize {
        match self {
            Self::Rotation(n) | Self::Linear(n) => n,
            Self::Quaternion => 4,
            Self::Motion(n) => n + 1,
        }
    }

    /// An element from the numbers of a state in row-major order, or from the four components of a quaternion. `unit`
    /// is the relative error of one rounding. Entries of rotations have the error of 1, and entries of linear maps
    /// have the error of the largest entry. A spatial velocity rotates the coordinates of a motion, so each has the
    /// error of the largest coordinate. A body velocity adds to each coordinate, so each has its own error.
    #[must_use]
    pub fn element(self, side: Side, numbers: &[f64], unit: f64) -> Option<Matrix> {
        let n = self.rows();
        let places = (0..n.saturating_sub(1)).filter_map(|i| numbers.get(i * n + n - 1));
        let farthest = places.fold(0.0, |a: f64, x| a.max(x.abs()));
        let turned = OF_A_TURN * unit + self.defect(numbers).min(MOST_OF_A_DEFECT * unit);
        let entry = |i: usize, j: usize| -> Option<Number> {
            Some(match self {
                Self::Quaternion => {
                    let (which, sign) = LEFT[i][j];
                    Number::within(sign * numbers.get(which)?, turned)
                }
                Self::Rotation(_) => Number::within(*numbers.get(i * n + j)?, turned),
                Self::Linear(_) => {
                    let size = numbers.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
                    // A step multiplies by a matrix near the identity: an entry is a sum of n products, each rounded.
                    Number::within(*numbers.get(i * n + j)?, f64::from(small(n)) * unit * size)
                }
                Self::Motion(m) => {
                    let x = *numbers.get(i * n + j)?;
                    match (i < m, j < m) {
                        (true, true) => Number::within(x, turned),
                        (true, false) => Number::within(
                            x,
                            match side {
                                Side::Body => unit * x.abs(),
                                Side::Space => f64::from(small(n)) * unit * farthest,
                            },
                        ),
                        _ => Number::exact(x),
                    }
                }
            })
        };
        let count = match self {
            Self::Quaternion => 4,
            _ => n * n,
        };
        (numbers.len() == count)
            .then(|| Matrix::from_entries(n, n, |i, j| entry(i, j).unwrap_or_default()))
    }

    /// Adds the rounding of the increment from the numbers `before` to the positions of motions and to linear maps. The
    /// equations of an increment couple its entries, so each has the error of the largest.
    pub fn add_rounding_of_increment(self, element: &mut Matrix, before: &[f64], numbers: &[f64]) {
        let n = self.rows();
        let is_open = |k: usize| match self {
            Self::Linear(_) => true,
            Self::Motion(m) => k / n < m && k % n == m,
            Self::Rotation(_) | Self::Quaternion => false,
        };
        let both = before.iter().zip(numbers).enumerate();
        let open = both.filter(|(k, _)| is_open(*k));
        let most = open.fold(0.0, |most, (_, (a, b))| larger(most, (a - b).abs()));
        let entries = element.entries_mut().iter_mut().enumerate();
        for (_, x) in entries.filter(|(k, _)| is_open(*k)) {
            x.error += OF_AN_INCREMENT * UNIT * most;
        }
    }

    /// The defect of a rotation, whose columns should be orthonormal, or of a unit quaternion; 0 for other groups.
    #[must_use]
    pub fn defect(self, numbers: &[f64]) -> f64 {
        let n = self.rows();
        let size = match self {
            Self::Rotation(n) | Self::Motion(n) => n,
            Self::Quaternion => {
                return (numbers.iter().map(|x| x * x).sum::<f64>() - 1.0).abs();
            }
            Self::Linear(_) => return 0.0,
        };
        let at = |i: usize, j: usize| numbers.get(i * n + j).copied().unwrap_or(f64::NAN);
        let of = |j: usize, k: usize| -> f64 {
            let product: f64 = (0..size).map(|i| at(i, j) * at(i, k)).sum();
            (product - f64::from(u8::from(j == k))).abs()
        };
        let all = (0..size).flat_map(|j| (j..size).map(move |k| (j, k)));
        all.map(|(j, k)| of(j, k))
            .fold(0.0, |a, x| if a >= x { a } else { x })
    }

    /// The inverse of an element.
    #[must_use]
    pub fn inverse(self, element: &Matrix) -> Option<Matrix> {
        match self {
            Self::Rotation(_) | Self::Quaternion => Some(element.transposed()),
            Self::Linear(_) => element.inverse(),
            Self::Motion(n) => {
                let turn = Matrix::from_entries(n, n, |i, j| element.at(j, i));
                let place = Matrix::from_entries(n, 1, |i, _| element.at(i, n));
                let back = turn.times(&place)?.negated();
                Some(Matrix::from_entries(n + 1, n + 1, |i, j| {
                    match (i < n, j < n) {
                        (true, true) => turn.at(i, j),
                        (true, false) => back.at(i, 0),
                        (false, true) => Number::default(),
                        (false, false) => Number::exact(1.0),
                    }
                }))
            }
        }
    }

    /// A basis of the Lie algebra, in the order of the components of momenta.
    #[must_use]
    pub fn basis(self) -> Vec<Entries> {
        let turn = |i: usize, j: usize| vec![(i, j, 1.0), (j, i, -1.0)];
        match self {
            Self::Rotation(3) => vec![turn(2, 1), turn(0, 2), turn(1, 0)],
            Self::Rotation(n) => pairs(n).map(|(i, j)| turn(i, j)).collect(),
            Self::Linear(n) => (0..n * n).map(|k| vec![(k / n, k % n, 1.0)]).collect(),
            Self::Quaternion => (1..4)
                .map(|which| {
                    let all = (0..16).map(|k| (k / 4, k % 4, LEFT[k / 4][k % 4]));
                    let own = all.filter(|(_, _, (w, _))| *w == which);
                    own.map(|(i, j, (_, sign))| (i, j, 0.5 * sign)).collect()
                })
                .collect(),
            Self::Motion(2) => vec![turn(1, 0), vec![(0, 2, 1.0)], vec![(1, 2, 1.0)]],
            Self::Motion(_) => vec![
                turn(2, 1),
                turn(0, 2),
                turn(1, 0),
                vec![(0, 3, 1.0)],
                vec![(1, 3, 1.0)],
                vec![(2, 3, 1.0)],
            ],
        }
    }

    /// The components of a momentum from the numbers of a state, in the order of the basis.
    #[must_use]
    pub fn momentum(self, numbers: &[f64]) -> Option<Vec<f64>> {
        match self {
            // If the model has a generic size, the momentum is a skew matrix in three dimensions too.
            Self::Rotation(n) if numbers.len() == n * n => {
                let own = self
                    .basis()
                    .into_iter()
                    .filter_map(|entries| entries.first().copied());
                // Both halves are looked at.
                let at = |i: usize, j: usize| numbers.get(i * n + j).copied();
                own.map(|(i, j, _)| Some(0.5 * (at(i, j)? - at(j, i)?)))
                    .collect()
            }
            _ => (numbers.len() == self.basis().len()).then(|| numbers.to_vec()),
        }
    }
}

/// The pairs of directions of a skew matrix.
fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |i| (i + 1..n).map(move |j| (i, j)))
}
