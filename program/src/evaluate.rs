//! The evaluation of a kernel over any arithmetic.
//!
//! Every operation performs the steps of the runtime's operation on statically sized matrices in the same order, so that results
//! agree bit for bit.

use crate::arithmetic::Arithmetic;
use crate::array::Array;
use crate::kernel::{Kernel, Value};
use crate::operation::{Number, Operation, Pair, Single};
use crate::shape::Dim;
use core::fmt;

/// Why an evaluation of a kernel failed.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Unvalued {
    /// The value of this input is missing, or has another size.
    Input(String),
    /// A declared name lacks a size.
    Size(Dim),
    /// The arithmetic does not offer this operation.
    Operation(&'static str),
    /// No value is known for the functional with this index.
    Functional(usize),
}

impl fmt::Display for Unvalued {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unvalued::Input(name) => write!(f, "no value of the right size was given for {name}"),
            Unvalued::Size(dim) => write!(f, "dimension {dim} lacks a size"),
            Unvalued::Operation(word) => write!(f, "this arithmetic does not offer `{word}`"),
            Unvalued::Functional(which) => {
                write!(f, "the value of functional {which} is unknown here")
            }
        }
    }
}

impl std::error::Error for Unvalued {}

/// The outputs of a kernel. `inputs` are in the kernel's order; `sizes` gives the sizes of declared names.
///
/// # Errors
/// [`Unvalued`] if an input does not fit, a size is missing or the arithmetic lacks an operation.
pub fn evaluate<A: Arithmetic>(
    arithmetic: &A,
    kernel: &Kernel,
    inputs: &[Array<A::Number>],
    sizes: &[usize],
) -> Result<Vec<Array<A::Number>>, Unvalued> {
    for (at, input) in kernel.inputs().iter().enumerate() {
        let shape = input.kind.shape();
        let fits = |given: &Array<A::Number>| {
            shape.rows.size(sizes) == Some(given.rows())
                && shape.cols.size(sizes) == Some(given.cols())
        };
        if !inputs.get(at).is_some_and(fits) {
            return Err(Unvalued::Input(input.name.clone()));
        }
    }
    let mut running = Running {
        arithmetic,
        inputs,
        sizes,
        values: Vec::with_capacity(kernel.lines().len()),
    };
    for line in kernel.lines() {
        let value = running.line(&line.operation)?;
        running.values.push(value);
    }
    let outputs = kernel.outputs.iter();
    Ok(outputs.map(|v| running.values[v.line()].clone()).collect())
}

struct Running<'a, A: Arithmetic> {
    arithmetic: &'a A,
    inputs: &'a [Array<A::Number>],
    sizes: &'a [usize],
    values: Vec<Array<A::Number>>,
}

impl<A: Arithmetic> Running<'_, A> {
    fn of(&self, v: Value) -> &Array<A::Number> {
        &self.values[v.line()]
    }

    fn size(&self, dim: Dim) -> Result<usize, Unvalued> {
        dim.size(self.sizes).ok_or(Unvalued::Size(dim))
    }

    fn double(&self, x: f64) -> A::Number {
        self.arithmetic.constant(Number::Double(x))
    }

    /// Ones on the diagonal that is `at` rows below the main diagonal, zeros elsewhere.
    fn ones(&self, shape: crate::Shape, at: usize) -> Result<Array<A::Number>, Unvalued> {
        let (one, zero) = (self.double(1.0), self.double(0.0));
        let (rows, cols) = (self.size(shape.rows)?, self.size(shape.cols)?);
        Ok(Array::from_fn(rows, cols, |i, j| {
            if i == at + j { one } else { zero }
        }))
    }

    fn line(&self, operation: &Operation) -> Result<Array<A::Number>, Unvalued> {
        let number = |x: A::Number| Ok(Array::number(x));
        match operation {
            Operation::Input(at) => Ok(self.inputs[*at].clone()),
            Operation::Number(n) => number(self.arithmetic.constant(*n)),
            Operation::Identity(shape) => self.ones(*shape, 0),
            Operation::Inclusion(shape, at) => self.ones(*shape, *at),
            Operation::Zero(shape) => {
                let (rows, cols) = (self.size(shape.rows)?, self.size(shape.cols)?);
                let zero = self.double(0.0);
                Ok(Array::from_fn(rows, cols, |_, _| zero))
            }
            Operation::Unit(dim, axis) => self.ones(crate::Shape::vector(*dim), *axis),
            Operation::One(single, a) => self.single(*single, self.of(*a)),
            Operation::Two(pair, a, b) => Ok(self.pair(*pair, self.of(*a), self.of(*b))),
            Operation::Power(a, n) => number(self.arithmetic.power(self.of(*a).at(0, 0), *n)),
            Operation::Root(a, num, den) => {
                number(self.arithmetic.root(self.of(*a).at(0, 0), *num, *den))
            }
            Operation::Entry(a, row) => number(self.of(*a).at(*row, 0)),
            Operation::EntryAt(a, row, col) => number(self.of(*a).at(*row, *col)),
            Operation::RowsFrom(a, whole, at) => {
                let (a, rows) = (self.of(*a), self.size(whole.cols)?);
                Ok(self.moved(rows, a.cols(), |i, j| a.get(at + i, j)))
            }
            Operation::IntoRows(a, whole, at) => {
                let (a, rows) = (self.of(*a), self.size(whole.rows)?);
                Ok(self.moved(rows, a.cols(), |i, j| a.get(i.checked_sub(*at)?, j)))
            }
            Operation::ColumnsFrom(a, whole, at) => {
                let (a, cols) = (self.of(*a), self.size(whole.cols)?);
                Ok(self.moved(a.rows(), cols, |i, j| a.get(i, at + j)))
            }
            Operation::IntoColumns(a, whole, at) => {
                let (a, cols) = (self.of(*a), self.size(whole.rows)?);
                Ok(self.moved(a.rows(), cols, |i, j| a.get(i, j.checked_sub(*at)?)))
            }
            Operation::Functional(call) => {
                let values: Vec<&Array<A::Number>> =
                    call.values.iter().map(|v| self.of(*v)).collect();
                let value = self.arithmetic.functional(call, &values);
                value.ok_or(Unvalued::Functional(call.functional))
            }
        }
    }

    fn moved(
        &self,
        rows: usize,
        cols: usize,
        entry: impl Fn(usize, usize) -> Option<A::Number>,
    ) -> Array<A::Number> {
        let zero = self.double(0.0);
        Array::from_fn(rows, cols, |i, j| entry(i, j).unwrap_or(zero))
    }

    fn single(&self, single: Single, a: &Array<A::Number>) -> Result<Array<A::Number>, Unvalued> {
        let on = self.arithmetic;
        let (zero, half) = (self.double(0.0), self.double(0.5));
        let n = a.rows();
        let x = |i: usize, j: usize| a.at(i, j);
        Ok(match single {
            Single::Neg => a.map(|x| on.neg(x)),
            Single::Transpose => Array::from_fn(a.cols(), n, |i, j| x(j, i)),
            Single::Trace => Array::number((0..n).fold(zero, |sum, i| on.add(sum, x(i, i)))),
            Single::Sqrt
            | Single::Exp
            | Single::Log
            | Single::Sin
            | Single::Cos
            | Single::Sinh
            | Single::Cosh
            | Single::Tanh
            | Single::Abs
            | Single::Sign => Array::number(on.function(single, x(0, 0))),
            Single::Inverse => on.inverse(a).ok_or(Unvalued::Operation(single.word()))?,
            Single::Determinant => Array::number(self.determinant(a)?),
            Single::Adjugate => self.adjugate(a)?,
            Single::Hat => {
                let [p, q, r] = [x(0, 0), x(1, 0), x(2, 0)];
                let rows = [
                    [zero, on.neg(r), q],
                    [r, zero, on.neg(p)],
                    [on.neg(q), p, zero],
                ];
                Array::from_fn(3, 3, |i, j| rows[i][j])
            }
            Single::AxialOfDifference => self.axial(a),
            Single::Vee => self.axial(a).map(|x| on.mul(x, half)),
            Single::TraceComplement => Array::from_fn(3, 3, |i, j| match (i, j) {
                (0, 0) => on.add(x(1, 1), x(2, 2)),
                (1, 1) => on.add(x(0, 0), x(2, 2)),
                (2, 2) => on.add(x(0, 0), x(1, 1)),
                _ => on.neg(x(i, j)),
            }),
            Single::LessIdentity => self.less_identity(a),
            Single::SymmetricPart => {
                Array::from_fn(n, n, |i, j| on.mul(on.add(x(i, j), x(j, i)), half))
            }
            Single::SkewPart => Array::from_fn(n, n, |i, j| on.mul(on.sub(x(i, j), x(j, i)), half)),
            Single::DiagonalPart => {
                Array::from_fn(n, n, |i, j| if i == j { x(i, i) } else { zero })
            }
            Single::Diagonal => Array::from_fn(n, n, |i, j| if i == j { x(i, 0) } else { zero }),
            Single::DiagonalOf => Array::from_fn(n, 1, |i, _| x(i, i)),
            Single::MotionRotation => Array::from_fn(n - 1, n - 1, x),
            Single::MotionTranslation => Array::from_fn(n - 1, 1, |i, _| x(i, n - 1)),
            Single::Twist if n == 3 => {
                let rows = [
                    [zero, on.neg(x(0, 0)), x(1, 0)],
                    [x(0, 0), zero, x(2, 0)],
                    [zero; 3],
                ];
                Array::from_fn(3, 3, |i, j| rows[i][j])
            }
            Single::Twist => {
                let turn = self.single(Single::Hat, &Array::from_fn(3, 1, |i, _| x(i, 0)))?;
                Array::from_fn(4, 4, |i, j| match (i, j) {
                    (3, _) => zero,
                    (_, 3) => x(i + 3, 0),
                    _ => turn.at(i, j),
                })
            }
            Single::Real => Array::number(x(0, 0)),
            Single::Imaginary => Array::from_fn(3, 1, |i, _| x(i + 1, 0)),
            Single::QuaternionReal => Array::number(self.nearest(a)[0]),
            Single::QuaternionImaginary => {
                let q = self.nearest(a);
                Array::from_fn(3, 1, |i, _| q[i + 1])
            }
            Single::PureQuaternion => {
                let [p, q, r] = [x(0, 0), x(1, 0), x(2, 0)];
                let rows = [
                    [zero, on.neg(p), on.neg(q), on.neg(r)],
                    [p, zero, on.neg(r), q],
                    [q, r, zero, on.neg(p)],
                    [r, on.neg(q), p, zero],
                ];
                Array::from_fn(4, 4, |i, j| rows[i][j])
            }
            Single::QuaternionRotation => self.rotation(a)?,
        })
    }

    /// The axial vector of `A - Aᵀ`.
    fn axial(&self, a: &Array<A::Number>) -> Array<A::Number> {
        let of = |i, j| self.arithmetic.sub(a.at(i, j), a.at(j, i));
        let all = [of(2, 1), of(0, 2), of(1, 0)];
        Array::from_fn(3, 1, |i, _| all[i])
    }

    /// The diagonal from the other entries: `A_ii - 1 = -|A e_i - e_i|²/2`.
    fn less_identity(&self, a: &Array<A::Number>) -> Array<A::Number> {
        let on = self.arithmetic;
        let (one, factor) = (self.double(1.0), self.double(-0.5));
        let mut out = a.clone();
        for i in 0..a.rows() {
            let moved = on.sub(a.at(i, i), one);
            let others = (0..a.rows()).filter(|k| *k != i).map(|k| a.at(k, i));
            let square = others.fold(on.mul(moved, moved), |sum, x| on.add(sum, on.mul(x, x)));
            out.set(i, i, on.mul(square, factor));
        }
        out
    }

    /// The quaternion closest to a 4 x 4 matrix.
    fn nearest(&self, a: &Array<A::Number>) -> [A::Number; 4] {
        let on = self.arithmetic;
        let quarter = self.double(0.25);
        // Column first, then row.
        let c = |col: usize, row: usize| a.at(row, col);
        let difference = |x, y| on.sub(x, y);
        [
            on.add(on.add(c(0, 0), c(1, 1)), on.add(c(2, 2), c(3, 3))),
            on.add(difference(c(0, 1), c(1, 0)), difference(c(2, 3), c(3, 2))),
            on.add(difference(c(0, 2), c(2, 0)), difference(c(3, 1), c(1, 3))),
            on.add(difference(c(0, 3), c(3, 0)), difference(c(1, 2), c(2, 1))),
        ]
        .map(|x| on.mul(x, quarter))
    }

    /// The rotation of the closest quaternion.
    fn rotation(&self, a: &Array<A::Number>) -> Result<Array<A::Number>, Unvalued> {
        let on = self.arithmetic;
        let (zero, two) = (self.double(0.0), self.double(2.0));
        let [w, x, y, z] = self.nearest(a);
        let v = Array::from_fn(3, 1, |i, _| [x, y, z][i]);
        let diagonal = on.sub(on.mul(w, w), self.dot(&v, &v));
        let turn = self.single(Single::Hat, &v)?;
        let twice = on.mul(two, w);
        Ok(Array::from_fn(3, 3, |i, j| {
            let first = if i == j { diagonal } else { zero };
            let square = on.mul(on.mul(v.at(i, 0), v.at(j, 0)), two);
            on.add(on.add(first, square), on.mul(turn.at(i, j), twice))
        }))
    }

    fn determinant(&self, a: &Array<A::Number>) -> Result<A::Number, Unvalued> {
        let on = self.arithmetic;
        let x = |i: usize, j: usize| a.at(i, j);
        let minor = |p: (usize, usize), q: (usize, usize), r: (usize, usize), s: (usize, usize)| {
            on.sub(
                on.mul(x(p.0, p.1), x(q.0, q.1)),
                on.mul(x(r.0, r.1), x(s.0, s.1)),
            )
        };
        Ok(match a.rows() {
            0 => self.double(1.0),
            1 => x(0, 0),
            2 => minor((0, 0), (1, 1), (0, 1), (1, 0)),
            3 => {
                let first = on.mul(x(0, 0), minor((1, 1), (2, 2), (1, 2), (2, 1)));
                let second = on.mul(x(0, 1), minor((1, 2), (2, 0), (1, 0), (2, 2)));
                let third = on.mul(x(0, 2), minor((1, 0), (2, 1), (1, 1), (2, 0)));
                on.add(on.add(first, second), third)
            }
            _ => on
                .determinant(a)
                .ok_or(Unvalued::Operation("determinant"))?,
        })
    }

    fn adjugate(&self, a: &Array<A::Number>) -> Result<Array<A::Number>, Unvalued> {
        let on = self.arithmetic;
        let x = |i: usize, j: usize| a.at(i, j);
        match a.rows() {
            2 => {
                let rows = [[x(1, 1), on.neg(x(0, 1))], [on.neg(x(1, 0)), x(0, 0)]];
                Ok(Array::from_fn(2, 2, |i, j| rows[i][j]))
            }
            3 => Ok(Array::from_fn(3, 3, |i, j| {
                // The cofactor of the entry (j, i).
                let (p, q) = ((j + 1) % 3, (j + 2) % 3);
                let (r, s) = ((i + 1) % 3, (i + 2) % 3);
                on.sub(on.mul(x(p, r), x(q, s)), on.mul(x(p, s), x(q, r)))
            })),
            _ => Err(Unvalued::Operation("adjugate")),
        }
    }

    fn pair(&self, pair: Pair, a: &Array<A::Number>, b: &Array<A::Number>) -> Array<A::Number> {
        let on = self.arithmetic;
        let x = |i: usize| a.at(i, 0);
        let y = |i: usize| b.at(i, 0);
        match pair {
            Pair::Add => a.zip(b, |x, y| on.add(x, y)),
            Pair::Sub => a.zip(b, |x, y| on.sub(x, y)),
            Pair::Mul if b.columns().len() == 1 => a.map(|x| on.mul(x, b.at(0, 0))),
            Pair::Mul => self.product(a, b),
            Pair::Div => a.map(|x| on.div(x, b.at(0, 0))),
            Pair::TransposedMul => Array::from_fn(a.cols(), b.cols(), |i, j| {
                self.dot_columns(a.column(i), b.column(j))
            }),
            Pair::Dot => Array::number(self.dot(a, b)),
            Pair::Cross => {
                let of = |p: usize, q: usize| on.sub(on.mul(x(p), y(q)), on.mul(x(q), y(p)));
                let all = [of(1, 2), of(2, 0), of(0, 1)];
                Array::from_fn(3, 1, |i, _| all[i])
            }
            Pair::Crossed => Array::from_fn(3, 3, |i, j| {
                let (p, q) = ((i + 1) % 3, (i + 2) % 3);
                on.sub(on.mul(x(p), b.at(q, j)), on.mul(x(q), b.at(p, j)))
            }),
            Pair::Crossing => Array::from_fn(3, 3, |i, j| {
                let (p, q) = ((j + 1) % 3, (j + 2) % 3);
                on.sub(on.mul(a.at(i, p), y(q)), on.mul(a.at(i, q), y(p)))
            }),
            Pair::DiagonalTimes => {
                Array::from_fn(b.rows(), b.cols(), |i, j| on.mul(b.at(i, j), a.at(i, i)))
            }
            Pair::TimesDiagonal => {
                Array::from_fn(a.rows(), a.cols(), |i, j| on.mul(a.at(i, j), b.at(j, j)))
            }
            Pair::Between => self.between(a, b),
        }
    }

    /// The weighted columns of the first matrix, summed in order.
    fn product(&self, a: &Array<A::Number>, b: &Array<A::Number>) -> Array<A::Number> {
        let on = self.arithmetic;
        Array::from_fn(a.rows(), b.cols(), |i, j| {
            let of = |k: usize| on.mul(a.at(i, k), b.at(k, j));
            match a.cols() {
                0 => self.double(0.0),
                n => (1..n).fold(of(0), |sum, k| on.add(of(k), sum)),
            }
        })
    }

    fn dot(&self, a: &Array<A::Number>, b: &Array<A::Number>) -> A::Number {
        match a.cols() {
            1 => self.dot_columns(a.column(0), b.column(0)),
            n => (0..n).fold(self.double(0.0), |sum, j| {
                self.dot_long(sum, a.column(j), b.column(j))
            }),
        }
    }

    /// Short columns use a different order of summation.
    fn dot_columns(&self, a: &[A::Number], b: &[A::Number]) -> A::Number {
        let on = self.arithmetic;
        let of = |k: usize| on.mul(a[k], b[k]);
        match a.len() {
            2 => on.add(of(0), of(1)),
            3 => on.add(on.add(of(0), of(1)), of(2)),
            4 => on.add(on.add(of(0), of(2)), on.add(of(1), of(3))),
            _ => self.dot_long(self.double(0.0), a, b),
        }
    }

    /// Eight parallel sums, then the rest.
    fn dot_long(&self, mut sum: A::Number, a: &[A::Number], b: &[A::Number]) -> A::Number {
        let on = self.arithmetic;
        let whole = a.len() - a.len() % 8;
        let mut parts = [self.double(0.0); 8];
        for k in 0..whole {
            parts[k % 8] = on.add(parts[k % 8], on.mul(a[k], b[k]));
        }
        for k in 0..4 {
            sum = on.add(sum, on.add(parts[k], parts[k + 4]));
        }
        (whole..a.len()).fold(sum, |sum, k| on.add(sum, on.mul(a[k], b[k])))
    }

    /// `conj(p) q` of quaternions `(w, x, y, z)`.
    fn between(&self, p: &Array<A::Number>, q: &Array<A::Number>) -> Array<A::Number> {
        let on = self.arithmetic;
        let conjugate = [0, 1, 2, 3].map(|i| match i {
            0 => p.at(0, 0),
            _ => on.neg(p.at(i, 0)),
        });
        let of = |i: usize, j: usize| on.mul(conjugate[i], q.at(j, 0));
        let all = [
            on.sub(on.sub(of(0, 0), of(1, 1)), on.add(of(2, 2), of(3, 3))),
            on.add(on.add(of(0, 1), of(1, 0)), on.sub(of(2, 3), of(3, 2))),
            on.add(on.add(of(0, 2), of(2, 0)), on.sub(of(3, 1), of(1, 3))),
            on.add(on.add(of(0, 3), of(3, 0)), on.sub(of(1, 2), of(2, 1))),
        ];
        Array::from_fn(4, 1, |i, _| all[i])
    }
}
