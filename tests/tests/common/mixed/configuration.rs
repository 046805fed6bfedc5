//! A configuration of a random model: what it is, its node and its neighbours drawn and moved, its
//! kinetic energy, and what it shows at a node or over an edge, in text and in numbers.

use super::Feature;
use clebsch_core::Assignment;
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::{Square, cross, dot, hat};
use std::array::from_fn;

/// What a configuration is. Nodes are flat: matrices row by row, quaternions `(w, x, y, z)`, motions as
/// rotation and place.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Kind {
    Rotation,
    Quaternion,
    Motion,
    Linear,
    Vector,
    Number,
    Matrix,
}

pub(super) const KINDS: [Kind; 7] = [
    Kind::Rotation,
    Kind::Quaternion,
    Kind::Motion,
    Kind::Linear,
    Kind::Vector,
    Kind::Number,
    Kind::Matrix,
];

/// Parameters: vectors `c1 ..`, numbers `k1 ..`, symmetric matrices `J1 ..`.
pub(super) const VECTORS: usize = 4;
pub(super) const NUMBERS: usize = 4;
pub(super) const MATRICES: usize = 2;

pub(super) struct Parameters {
    pub(super) vectors: [[f64; 3]; VECTORS],
    pub(super) numbers: [f64; NUMBERS],
    pub(super) matrices: [Square<f64, 3>; MATRICES],
}

#[derive(Clone, Debug)]
pub(super) struct Configuration {
    pub(super) kind: Kind,
    pub(super) name: String,
    pub(super) velocity: String,
    pub(super) spatial: bool,
    pub(super) at: usize,
}

impl Kind {
    pub(super) fn entries(self) -> usize {
        match self {
            Kind::Rotation | Kind::Linear | Kind::Matrix => 9,
            Kind::Quaternion => 4,
            Kind::Motion => 12,
            Kind::Vector => 3,
            Kind::Number => 1,
        }
    }

    pub(super) fn is_field(self) -> bool {
        matches!(self, Kind::Vector | Kind::Number | Kind::Matrix)
    }
}
pub(super) fn turn<T: Number>(x: &[T]) -> Square<T, 3> {
    Square::from_entries(|i, j| x[3 * i + j])
}

pub(super) fn vector<T: Number>(x: &[T]) -> [T; 3] {
    from_fn(|i| x[i])
}

pub(super) fn rotation_of<T: Number>(q: &[T]) -> Square<T, 3> {
    let axis = vector(&q[1..]);
    let columns: [[T; 3]; 3] = from_fn(|j| {
        let unit: [T; 3] = from_fn(|i| T::constant(f64::from(u8::from(i == j))));
        let once = cross(&axis, &unit);
        let twice = cross(&axis, &once);
        from_fn(|i| unit[i] + T::constant(2.0) * (q[0] * once[i] + twice[i]))
    });
    Square::from_entries(|i, j| columns[j][i])
}

pub(super) fn constant<T: Number>(v: &[f64; 3]) -> [T; 3] {
    from_fn(|i| T::constant(v[i]))
}

impl Configuration {
    pub(super) fn group(&self) -> Option<&'static str> {
        match self.kind {
            Kind::Rotation => Some("SO<3>"),
            Kind::Quaternion => Some("SU<2>"),
            Kind::Motion => Some("SE<3>"),
            Kind::Linear => Some("GL<3>"),
            Kind::Vector | Kind::Number | Kind::Matrix => None,
        }
    }

    pub(super) fn declared(&self) -> String {
        let (x, v) = (&self.name, &self.velocity);
        let update = match self.spatial {
            true => format!("{v}*{x}"),
            false => format!("{x}*{v}"),
        };
        match self.group() {
            Some(group) => {
                format!("group {x}: {group} velocity {v}; constraint next({x}) = {update};")
            }
            None => {
                let shape = match self.kind {
                    Kind::Vector => "Vec<3>",
                    Kind::Number => "Real",
                    _ => "Mat<3>",
                };
                format!("field {x}: {shape};")
            }
        }
    }

    pub(super) fn features(&self) -> Vec<Feature> {
        let turned = [false, true].map(|transposed| Feature::Turned { transposed });
        match self.kind {
            Kind::Rotation | Kind::Linear | Kind::Matrix => turned.to_vec(),
            Kind::Quaternion => [&turned[..], &[Feature::Imaginary]].concat(),
            Kind::Motion => [&turned[..], &[Feature::Place]].concat(),
            Kind::Vector | Kind::Number => vec![Feature::Place],
        }
    }

    pub(super) fn kinetic_text(&self, by_velocity: bool) -> String {
        let (x, v) = (&self.name, &self.velocity);
        let d = format!("(next({x}) - {x})");
        match self.kind {
            Kind::Rotation if by_velocity && self.spatial => format!("-tr(J1*{x}^T*{v}*{x})/h"),
            Kind::Rotation if by_velocity => format!("-tr(J1*{v})/h"),
            Kind::Rotation => format!("-tr(J1*{x}^T*next({x}))/h"),
            Kind::Quaternion => format!("-(4*k1/h)*re({x}^T*next({x}))"),
            Kind::Motion => format!(
                "-tr(J1*rot({x})^T*rot(next({x})))/h + k1*dot(pos(next({x})) - pos({x}), pos(next({x})) - pos({x}))/(2*h)"
            ),
            Kind::Linear | Kind::Matrix => format!("tr({d}*J2*{d}^T)/(2*h)"),
            Kind::Vector => format!("k2*dot({d}, {d})/(2*h)"),
            Kind::Number => format!("k2*{d}^2/(2*h)"),
        }
    }

    pub(super) fn kinetic<T: Number>(
        &self,
        tail: &[T],
        head: &[T],
        p: &Parameters,
        h: f64,
    ) -> Vec<T> {
        let own = |x: &[T]| x[self.at..self.at + self.kind.entries()].to_vec();
        let (a, b) = (own(tail), own(head));
        let over = |x: f64| T::constant(x / h);
        let trace = |j: &Square<f64, 3>, from: &Square<T, 3>, to: &Square<T, 3>| {
            let each = (0..27).map(|n| [n / 9, n / 3 % 3, n % 3]);
            let each = each.map(|[i, j_, k]| over(-j.0[i][j_]) * from.0[k][j_] * to.0[k][i]);
            each.collect::<Vec<T>>()
        };
        let square = |weight: T, x: &[T], y: &[T]| {
            let each = x.iter().zip(y).map(|(x, y)| *y - *x);
            each.map(|d| weight * d * d).collect::<Vec<T>>()
        };
        match self.kind {
            Kind::Rotation => trace(&p.matrices[0], &turn(&a), &turn(&b)),
            Kind::Quaternion => a
                .iter()
                .zip(&b)
                .map(|(x, y)| over(-4.0 * p.numbers[0]) * *x * *y)
                .collect(),
            Kind::Motion => {
                let mut all = trace(&p.matrices[0], &turn(&a), &turn(&b));
                all.extend(square(over(0.5 * p.numbers[0]), &a[9..], &b[9..]));
                all
            }
            Kind::Linear | Kind::Matrix => {
                let d: Vec<T> = a.iter().zip(&b).map(|(x, y)| *y - *x).collect();
                let each = (0..27).map(|n| [n / 9, n / 3 % 3, n % 3]);
                let each = each.map(|[i, j, k]| {
                    over(0.5 * p.matrices[1].0[j][k]) * d[3 * i + j] * d[3 * i + k]
                });
                each.collect()
            }
            Kind::Vector | Kind::Number => square(over(0.5 * p.numbers[1]), &a, &b),
        }
    }

    /// The variations of a node along the coordinates of the Lie algebra.
    pub(super) fn directions(&self, node: &[f64]) -> Vec<Vec<f64>> {
        let x = &node[self.at..];
        let unit = |i: usize| -> [f64; 3] { from_fn(|j| f64::from(u8::from(i == j))) };
        let rows = |m: Square<f64, 3>| m.0.concat();
        let turned = |of: Square<f64, 3>, by: Square<f64, 3>| match self.spatial {
            true => rows(by * of),
            false => rows(of * by),
        };
        let entry = |n: usize| Square::from_entries(|i, j| f64::from(u8::from(3 * i + j == n)));
        match self.kind {
            Kind::Rotation => (0..3).map(|i| turned(turn(x), hat(&unit(i)))).collect(),
            Kind::Linear => (0..9).map(|n| turned(turn(x), entry(n))).collect(),
            Kind::Quaternion => (0..3)
                .map(|i| {
                    let axis: [f64; 3] = from_fn(|j| x[j + 1]);
                    let across = match self.spatial {
                        true => cross(&unit(i), &axis),
                        false => cross(&axis, &unit(i)),
                    };
                    let mut all = vec![-0.5 * axis[i]];
                    all.extend((0..3).map(|j| 0.5 * (x[0] * unit(i)[j] + across[j])));
                    all
                })
                .collect(),
            Kind::Motion => {
                let place: [f64; 3] = from_fn(|j| x[9 + j]);
                let angular = (0..3).map(|i| {
                    let moved = match self.spatial {
                        true => cross(&unit(i), &place),
                        false => [0.0; 3],
                    };
                    [turned(turn(x), hat(&unit(i))), moved.to_vec()].concat()
                });
                let linear = (0..3).map(|i| {
                    let moved = match self.spatial {
                        true => unit(i),
                        false => turn(x).apply(&unit(i)),
                    };
                    [vec![0.0; 9], moved.to_vec()].concat()
                });
                angular.chain(linear).collect()
            }
            Kind::Vector | Kind::Number | Kind::Matrix => (0..self.kind.entries())
                .map(|n| {
                    let all = 0..self.kind.entries();
                    all.map(|m| f64::from(u8::from(m == n))).collect()
                })
                .collect(),
        }
    }

    pub(super) fn draw(&self, source: &mut Source) -> Vec<f64> {
        let orthogonal = |source: &mut Source| source.orthogonal::<3>().0.concat();
        match self.kind {
            Kind::Rotation => orthogonal(source),
            Kind::Linear => source.invertible::<3>().0.concat(),
            Kind::Matrix => source.matrix::<3>().0.concat(),
            Kind::Vector => source.vector::<3>().to_vec(),
            Kind::Number => vec![source.between(-1.0, 1.0)],
            Kind::Motion => [orthogonal(source), source.vector::<3>().to_vec()].concat(),
            Kind::Quaternion => {
                let q: [f64; 4] = source.vector();
                let length = dot(&q, &q).sqrt();
                q.map(|x| x / length).to_vec()
            }
        }
    }

    pub(super) fn assign(&self, values: &mut Assignment, shift: i8, node: &[f64]) {
        let x = &node[self.at..self.at + self.kind.entries()];
        match self.kind {
            Kind::Rotation | Kind::Linear | Kind::Matrix => {
                values.set(&self.name, shift, 3, 3, x);
            }
            Kind::Vector => values.set(&self.name, shift, 3, 1, x),
            Kind::Number => values.set(&self.name, shift, 1, 1, x),
            Kind::Quaternion => {
                let [w, a, b, c] = [x[0], x[1], x[2], x[3]];
                let rows = [[w, -a, -b, -c], [a, w, -c, b], [b, c, w, -a], [c, -b, a, w]];
                values.set(&self.name, shift, 4, 4, &rows.concat());
            }
            Kind::Motion => {
                let mut rows = Vec::new();
                for i in 0..3 {
                    rows.extend_from_slice(&x[3 * i..3 * i + 3]);
                    rows.push(x[9 + i]);
                }
                rows.extend([0.0, 0.0, 0.0, 1.0]);
                values.set(&self.name, shift, 4, 4, &rows);
            }
        }
    }
}
