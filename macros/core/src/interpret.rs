//! Evaluation of programs on plain numbers: the residual that is emitted, run without a compiler,
//! for oracles and mutation tests. Matrices are row-major `f64`.

mod functionals;

use crate::check::spec::Group;
use crate::derive::Derivation;
use crate::derive::transport::Transport;
use crate::expr::shape::{Dim, Structure};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr, Function, Letter, Map, Node, Part, Shift};
use crate::schedule::{Program, program};

pub use functionals::Asked;

/// A matrix with its rows and columns.
#[derive(Clone, PartialEq, Debug)]
pub struct Matrix {
    /// Rows.
    pub rows: usize,
    /// Columns.
    pub cols: usize,
    /// Entries, row by row.
    pub data: Vec<f64>,
}

impl Matrix {
    /// A matrix of zeros.
    pub fn zeros(rows: usize, cols: usize) -> Matrix {
        Matrix {
            rows,
            cols,
            data: vec![0.0; rows * cols],
        }
    }

    fn scalar(x: f64) -> Matrix {
        Matrix {
            rows: 1,
            cols: 1,
            data: vec![x],
        }
    }

    fn identity(n: usize) -> Matrix {
        Matrix::from_fn(n, n, |i, j| f64::from(u8::from(i == j)))
    }

    fn from_fn(rows: usize, cols: usize, f: impl Fn(usize, usize) -> f64) -> Matrix {
        let data = (0..rows * cols).map(|k| f(k / cols.max(1), k % cols.max(1)));
        Matrix {
            rows,
            cols,
            data: data.collect(),
        }
    }

    /// The entry in row `i`, column `j`; zero outside.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.data.get(i * self.cols + j).copied().unwrap_or(0.0)
    }

    fn minus(&self, b: &Matrix) -> Matrix {
        Matrix::from_fn(self.rows, self.cols, |i, j| self.get(i, j) - b.get(i, j))
    }

    fn times(&self, b: &Matrix) -> Matrix {
        if self.rows * self.cols == 1 || b.rows * b.cols == 1 {
            let (s, m) = if self.rows * self.cols == 1 {
                (self, b)
            } else {
                (b, self)
            };
            return Matrix::from_fn(m.rows, m.cols, |i, j| s.get(0, 0) * m.get(i, j));
        }
        Matrix::from_fn(self.rows, b.cols, |i, j| {
            (0..self.cols).map(|k| self.get(i, k) * b.get(k, j)).sum()
        })
    }

    fn plus(&self, b: &Matrix) -> Matrix {
        Matrix::from_fn(self.rows, self.cols, |i, j| self.get(i, j) + b.get(i, j))
    }

    fn transposed(&self) -> Matrix {
        Matrix::from_fn(self.cols, self.rows, |i, j| self.get(j, i))
    }

    /// Inverse and determinant by elimination with pivoting.
    fn inverse_and_det(&self) -> (Matrix, f64) {
        let n = self.rows;
        let (mut a, mut b, mut det) = (self.clone(), Matrix::identity(n), 1.0);
        for c in 0..n {
            let pivot = (c..n).max_by(|x, y| a.get(*x, c).abs().total_cmp(&a.get(*y, c).abs()));
            let p = pivot.unwrap_or(c);
            if p != c {
                det = -det;
            }
            for k in 0..n {
                a.data.swap(c * n + k, p * n + k);
                b.data.swap(c * n + k, p * n + k);
            }
            let d = a.get(c, c);
            det *= d;
            for k in 0..n {
                a.data[c * n + k] /= d;
                b.data[c * n + k] /= d;
            }
            for r in (0..n).filter(|r| *r != c) {
                let f = a.get(r, c);
                for k in 0..n {
                    a.data[r * n + k] -= f * a.get(c, k);
                    b.data[r * n + k] -= f * b.get(c, k);
                }
            }
        }
        (b, det)
    }
}

/// What went wrong in an evaluation.
#[derive(Clone, PartialEq, Debug)]
pub enum EvalError {
    /// No value was given for this letter.
    Missing(String),
    /// A value has another shape than its letter.
    Shape(String),
    /// A dimension has only a name.
    NamedDimension,
    /// No function was given for this functional, or none for the derivative asked for.
    Functional(String),
}

impl core::fmt::Display for EvalError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            EvalError::Missing(name) => write!(f, "no value given for {name}"),
            EvalError::Shape(name) => write!(f, "the value of {name} has the wrong shape"),
            EvalError::NamedDimension => write!(f, "a dimension is not a number"),
            EvalError::Functional(name) => write!(f, "no function given for {name}"),
        }
    }
}

impl std::error::Error for EvalError {}

/// Values of letters by name and time level.
#[derive(Clone, Default, Debug)]
pub struct Assignment {
    values: Vec<(String, i8, Matrix)>,
    sizes: Vec<usize>,
    functionals: functionals::Table,
}

impl Assignment {
    /// Without values.
    pub fn new() -> Assignment {
        Assignment::default()
    }

    /// Sets a matrix or vector, row by row, at a time level (parameters: level 0).
    pub fn set(&mut self, name: &str, shift: i8, rows: usize, cols: usize, data: &[f64]) {
        let value = Matrix {
            rows,
            cols,
            data: data.to_vec(),
        };
        match self
            .values
            .iter_mut()
            .find(|(n, s, _)| n == name && *s == shift)
        {
            Some(slot) => slot.2 = value,
            None => self.values.push((name.to_owned(), shift, value)),
        }
    }

    /// Gives every dimension that has only a name its size, in the order of declaration.
    #[must_use]
    pub fn sized(mut self, sizes: Vec<usize>) -> Assignment {
        self.sizes = sizes;
        self
    }

    /// Sets a number that does not change in time.
    pub fn set_scalar(&mut self, name: &str, value: f64) {
        self.set(name, 0, 1, 1, &[value]);
    }

    /// The value that does not change in time, under this name.
    pub(crate) fn value(&self, name: &str) -> Option<&Matrix> {
        let found = self.values.iter().find(|(n, s, _)| n == name && *s == 0);
        found.map(|(_, _, value)| value)
    }

    fn get(&self, symbols: &Symbols, l: Letter) -> Result<Matrix, EvalError> {
        let symbol = symbols.get(l.symbol);
        let found = self
            .values
            .iter()
            .find(|(n, s, _)| *n == symbol.name && *s == l.shift.time);
        let Some((_, _, value)) = found else {
            return Err(EvalError::Missing(format!(
                "{} at level {}",
                symbol.name, l.shift.time
            )));
        };
        let fits = self.dim(symbol.shape.rows)? == value.rows
            && self.dim(symbol.shape.cols)? == value.cols
            && value.data.len() == value.rows * value.cols;
        if fits {
            Ok(value.clone())
        } else {
            Err(EvalError::Shape(symbol.name.clone()))
        }
    }

    fn dim(&self, d: Dim) -> Result<usize, EvalError> {
        match d {
            Dim::Fixed(n) => Ok(n as usize),
            Dim::Named(i) => {
                let size = self.sizes.get(i as usize).copied();
                size.ok_or(EvalError::NamedDimension)
            }
        }
    }
}

/// Evaluates an expression.
pub fn evaluate(symbols: &Symbols, e: &Expr, values: &Assignment) -> Result<Matrix, EvalError> {
    let go = |x: &Expr| evaluate(symbols, x, values);
    let number = |x: &Expr| go(x).map(|m| m.get(0, 0));
    let (rows, cols) = (values.dim(e.shape().rows)?, values.dim(e.shape().cols)?);
    Ok(match e.node() {
        Node::Number(q) => Matrix::scalar(q.value()),
        Node::Constant(c) => Matrix::scalar(c.value()),
        Node::Letter(l) => values.get(symbols, *l)?,
        Node::Identity(_) => Matrix::identity(rows),
        Node::Zero(_) => Matrix::zeros(rows, cols),
        Node::Unit(_, axis) => {
            Matrix::from_fn(rows, 1, |i, _| f64::from(u8::from(i == *axis as usize)))
        }
        Node::Inclusion(_, at) => {
            let at = *at as usize;
            Matrix::from_fn(rows, cols, |i, j| f64::from(u8::from(i == at + j)))
        }
        Node::Sum(list) => {
            let mut total = Matrix::zeros(rows, cols);
            for x in list {
                total = total.plus(&go(x)?);
            }
            total
        }
        Node::Neg(a) => Matrix::scalar(-1.0).times(&go(a)?),
        Node::Product(list) => {
            let mut total = Matrix::scalar(1.0);
            for x in list {
                total = total.times(&go(x)?);
            }
            total
        }
        Node::Quotient(a, b) => Matrix::scalar(1.0 / number(b)?).times(&go(a)?),
        Node::Power(a, q) => Matrix::scalar(match q.as_integer() {
            Some(n) => number(a)?.powi(n),
            None => number(a)?.powf(q.value()),
        }),
        Node::Transpose(a) => go(a)?.transposed(),
        Node::Inverse(a) => go(a)?.inverse_and_det().0,
        Node::Trace(a) => {
            let a = go(a)?;
            Matrix::scalar((0..a.rows).map(|i| a.get(i, i)).sum())
        }
        Node::Det(a) => Matrix::scalar(go(a)?.inverse_and_det().1),
        Node::Adjugate(a) => go(&expr::adjugate_polynomial(a))?,
        Node::Dot(a, b) => go(a)?.transposed().times(&go(b)?),
        Node::Cross(a, b) => hat(&go(a)?).times(&go(b)?),
        Node::Hat(a) => hat(&go(a)?),
        Node::Vee(a) => {
            let a = go(a)?;
            let half = |i, j| (a.get(i, j) - a.get(j, i)) / 2.0;
            Matrix {
                rows: 3,
                cols: 1,
                data: vec![half(2, 1), half(0, 2), half(1, 0)],
            }
        }
        Node::Part(part, a) => {
            let a = go(a)?;
            Matrix::from_fn(rows, cols, |i, j| match part {
                Part::Symmetric => (a.get(i, j) + a.get(j, i)) / 2.0,
                Part::Skew => (a.get(i, j) - a.get(j, i)) / 2.0,
                Part::Diagonal => {
                    if i == j {
                        a.get(i, j)
                    } else {
                        0.0
                    }
                }
            })
        }
        Node::Call(function, a) => {
            let x = number(a)?;
            Matrix::scalar(match function {
                Function::Exp => x.exp(),
                Function::Log => x.ln(),
                Function::Sin => x.sin(),
                Function::Cos => x.cos(),
                Function::Sinh => x.sinh(),
                Function::Cosh => x.cosh(),
                Function::Tanh => x.tanh(),
                Function::Abs => x.abs(),
                Function::Sign if x == 0.0 => 0.0,
                Function::Sign => x.signum(),
            })
        }
        Node::Map(map, a) => mapped(symbols, *map, a, &go(a)?),
        Node::Given(a) => functionals::called(symbols, e, a, None, values)?,
        Node::PullBack(a, which, seed) => {
            functionals::called(symbols, e, a, Some((*which, seed)), values)?
        }
    })
}

/// A map of quaternions, rigid motions or diagonals.
fn mapped(symbols: &Symbols, map: Map, argument: &Expr, a: &Matrix) -> Matrix {
    let column = |data: Vec<f64>| Matrix {
        rows: data.len(),
        cols: 1,
        data,
    };
    let pure = |v: &[f64]| {
        let [x, y, z] = [0, 1, 2].map(|i| v.get(i).copied().unwrap_or(0.0));
        let rows = [
            [0.0, -x, -y, -z],
            [x, 0.0, -z, y],
            [y, z, 0.0, -x],
            [z, -y, x, 0.0],
        ];
        Matrix::from_fn(4, 4, |i, j| rows[i][j])
    };
    let real = (0..4).map(|i| a.get(i, i)).sum::<f64>() / 4.0;
    let imaginary = || {
        let unit = |k: usize| pure(&[0, 1, 2].map(|i| f64::from(u8::from(i == k))));
        [0, 1, 2].map(|k| {
            let entries = a.data.iter().zip(unit(k).data);
            entries.map(|(x, y)| x * y).sum::<f64>() / 4.0
        })
    };
    match map {
        Map::Real => Matrix::scalar(real),
        Map::Imaginary => column(imaginary().to_vec()),
        Map::Pure => pure(&a.data),
        Map::Rotation if expr::is_motion(symbols, argument) => {
            Matrix::from_fn(a.rows - 1, a.rows - 1, |i, j| a.get(i, j))
        }
        Map::Translation => Matrix::from_fn(a.rows - 1, 1, |i, _| a.get(i, a.rows - 1)),
        Map::Diagonal => {
            let n = a.rows;
            Matrix::from_fn(n, n, |i, j| if i == j { a.get(i, 0) } else { 0.0 })
        }
        Map::DiagonalOf => Matrix::from_fn(a.rows, 1, |i, _| a.get(i, i)),
        Map::Twist => {
            let (turn, linear) = match a.rows {
                3 => (quarter(a.get(0, 0)), 1),
                _ => (hat(a), 3),
            };
            let last = turn.rows;
            Matrix::from_fn(last + 1, last + 1, |i, j| match (i == last, j == last) {
                (true, _) => 0.0,
                (false, true) => a.get(i + linear, 0),
                (false, false) => turn.get(i, j),
            })
        }
        Map::Rotation => {
            let v = imaginary();
            let turn = hat(&column(v.to_vec()));
            let square: f64 = v.iter().map(|x| x * x).sum();
            Matrix::from_fn(3, 3, |i, j| {
                let diagonal = if i == j { real * real - square } else { 0.0 };
                diagonal + 2.0 * v[i] * v[j] + 2.0 * real * turn.get(i, j)
            })
        }
    }
}

/// A multiple of the quarter turn of the plane.
fn quarter(x: f64) -> Matrix {
    Matrix {
        rows: 2,
        cols: 2,
        data: vec![0.0, -x, x, 0.0],
    }
}

fn hat(v: &Matrix) -> Matrix {
    let (x, y, z) = (v.get(0, 0), v.get(1, 0), v.get(2, 0));
    Matrix {
        rows: 3,
        cols: 3,
        data: vec![0.0, -z, y, z, 0.0, -x, -y, x, 0.0],
    }
}

/// Runs a program: the values of its results.
pub fn run(program: &Program, values: &Assignment) -> Result<Vec<Matrix>, EvalError> {
    let mut values = values.clone();
    for (id, e) in &program.temporaries {
        let value = evaluate(&program.symbols, e, &values)?;
        let name = &program.symbols.get(*id).name;
        values.set(name, 0, value.rows, value.cols, &value.data);
    }
    let results = program.results.iter();
    results
        .map(|e| evaluate(&program.symbols, e, &values))
        .collect()
}

/// The numbers of a covector in the basis of its Lie algebra. SO(3): the vector. SO(n): for
/// `i < j`, row by row, the pairing with the element that has -1 at (i, j) and +1 at (j, i).
/// GL(n): all entries, row by row (the variation being the matrix unit). SU(2): the vector, whose
/// variation is half the imaginary unit. Rigid motions: the angular, then the linear components.
fn coordinates(group: Group, m: &Matrix) -> Vec<f64> {
    if group.dual().1 != Structure::Skew {
        return m.data.clone();
    }
    let pairs = (0..m.rows).flat_map(|i| (i + 1..m.rows).map(move |j| (i, j)));
    pairs.map(|(i, j)| m.get(j, i)).collect()
}

impl Derivation {
    /// The residual of the discrete Euler-Lagrange equations at node k, incoming minus outgoing
    /// edge, for each configuration: the program that the macro emits.
    pub fn residual_program(&self) -> Program {
        program(&self.letters.symbols, &self.residual_expressions(), "t")
    }

    fn residual_expressions(&self) -> Vec<Expr> {
        let s = &self.letters.symbols;
        self.balances
            .iter()
            .map(|b| {
                let incoming = expr::shift_time(s, &b.incoming, Shift::PREVIOUS.time);
                expr::sub(incoming, b.outgoing.clone())
            })
            .collect()
    }

    /// Evaluates the residual at three consecutive configurations (levels -1, 0, 1), which need
    /// not be a solution. Velocities and defined advected quantities are computed; values of
    /// parameters, the step and undefined advected quantities must be given. See the emitted
    /// `balance` for the meaning of the components.
    pub fn residual(&self, values: &Assignment) -> Result<Vec<f64>, EvalError> {
        let program = self.residual.get_or_init(|| self.residual_program());
        self.evaluate_residual(program, values)
    }

    fn evaluate_residual(
        &self,
        program: &Program,
        values: &Assignment,
    ) -> Result<Vec<f64>, EvalError> {
        let values = self.completed(values)?;
        let results = run(program, &values)?;
        let groups = self.spec.configurations.iter().zip(&results);
        Ok(groups.flat_map(|(c, m)| coordinates(c.group, m)).collect())
    }

    /// Evaluates the continuous equations of motion, `-dμ/dt ± ad*_ζ μ + Σ ∂L/∂a ◇ a`, at one
    /// moment of any curve: level 0 of elements and of advected quantities without definition,
    /// velocities under the names of [`Letters::rate`](crate::derive::Letters), accelerations under
    /// those of `acceleration`. Components as in [`Derivation::residual`], whose limit over the
    /// step this is; nothing where the action has no limit.
    pub fn continuous_balance(&self, values: &Assignment) -> Result<Option<Vec<f64>>, EvalError> {
        let s = &self.letters.symbols;
        let Some(continuous) = &self.continuous else {
            return Ok(None);
        };
        let mut all = values.clone();
        for (a, t) in self.spec.advected.iter().zip(&self.transports) {
            if let Transport::Defined(definition) = t {
                let value = evaluate(s, definition, &all)?;
                let name = &s.get(a.quantity).name;
                all.set(name, 0, value.rows, value.cols, &value.data);
            }
        }
        let mut out = Vec::new();
        for (c, e) in self.spec.configurations.iter().zip(&continuous.balances) {
            out.extend(coordinates(c.group, &evaluate(s, e, &all)?));
        }
        Ok(Some(out))
    }

    /// Adds velocities on both edges and defined advected quantities at all three nodes.
    fn completed(&self, values: &Assignment) -> Result<Assignment, EvalError> {
        let s = &self.letters.symbols;
        let mut all = values.clone();
        for c in &self.spec.configurations {
            for level in [-1, 0] {
                let at = |time: i8| {
                    let shift = Shift {
                        time,
                        label: [0, 0],
                    };
                    values.get(
                        s,
                        Letter {
                            symbol: c.element,
                            shift,
                        },
                    )
                };
                let (g, next) = (at(level)?, at(level + 1)?);
                let inverse = |g: &Matrix| match c.group.is_orthogonal() {
                    true => g.transposed(),
                    false => g.inverse_and_det().0,
                };
                let w = match c.side.is_body() {
                    _ if c.group.is_additive() => next.minus(&g),
                    true => inverse(&g).times(&next),
                    false => next.times(&inverse(&g)),
                };
                all.set(&s.get(c.velocity).name, level, w.rows, w.cols, &w.data);
            }
        }
        for (a, t) in self.spec.advected.iter().zip(&self.transports) {
            let Transport::Defined(definition) = t else {
                continue;
            };
            for level in [-1, 0, 1] {
                let e = expr::shift_time(s, definition, level);
                let value = evaluate(s, &e, &all)?;
                all.set(
                    &s.get(a.quantity).name,
                    level,
                    value.rows,
                    value.cols,
                    &value.data,
                );
            }
        }
        Ok(all)
    }

    /// Every residual that differs from the emitted one by one term: dropped, or with its sign
    /// flipped.
    pub fn mutations(&self) -> Vec<Mutant<'_>> {
        let s = &self.letters.symbols;
        let original = self.residual_expressions();
        let mut out = Vec::new();
        for (slot, e) in original.iter().enumerate() {
            for change in expr::changes(s, e) {
                let mut results = original.clone();
                results[slot] = change.changed;
                out.push(Mutant {
                    derivation: self,
                    program: program(s, &results, "t"),
                    term: change.term,
                    flipped: change.flipped,
                });
            }
        }
        out
    }
}

/// A residual with one term changed.
pub struct Mutant<'a> {
    derivation: &'a Derivation,
    program: Program,
    term: Expr,
    flipped: bool,
}

impl Mutant<'_> {
    /// Which term, and what was done to it.
    pub fn describe(&self) -> String {
        let style = crate::print::Style::new(&self.derivation.spec.time_index);
        let format = crate::print::Format::Text;
        let term = crate::print::expression(&self.term, &self.program.symbols, &style, format);
        format!(
            "{} {term}",
            if self.flipped { "flipped" } else { "dropped" }
        )
    }

    /// Its value, as [`Derivation::residual`].
    pub fn residual(&self, values: &Assignment) -> Result<Vec<f64>, EvalError> {
        self.derivation.evaluate_residual(&self.program, values)
    }
}
