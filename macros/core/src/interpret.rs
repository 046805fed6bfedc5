//! Evaluates kernels with plain numbers: the emitted computation without a compiler, for checks, oracles and mutation
//! tests. Matrices are row-major `f64`.

mod functionals;
mod mutants;
mod residual;

use crate::expr::shape::Dim;
use crate::expr::symbol::Symbols;
use crate::expr::{Expr, Letter};
use crate::lower::{self, Inputs, Lowered, Source};
use crate::schedule::Program;
use clebsch_program::{Array, Call, Doubles, Unvalued};

pub use functionals::FunctionalRequest;
pub use mutants::Mutant;

/// A matrix with its numbers of rows and columns.
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

    /// The entry in row `i`, column `j`; zero outside.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.data.get(i * self.cols + j).copied().unwrap_or(0.0)
    }

    fn of(a: &Array<f64>) -> Matrix {
        Matrix {
            rows: a.rows(),
            cols: a.cols(),
            data: a.by_rows().collect(),
        }
    }

    fn array(&self) -> Array<f64> {
        Array::from_fn(self.rows, self.cols, |i, j| self.get(i, j))
    }
}

/// Why an evaluation failed.
#[derive(Clone, PartialEq, Debug)]
pub enum EvalError {
    /// No value was given for this letter.
    Missing(String),
    /// A value and its letter have different shapes.
    Shape(String),
    /// The size of a dimension is not given.
    NamedDimension,
    /// No function was given for this functional, or the function lacks the requested derivative.
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
    /// No values.
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

    /// Sets the sizes of all named dimensions, in the order of declaration.
    #[must_use]
    pub fn sized(mut self, sizes: Vec<usize>) -> Assignment {
        self.sizes = sizes;
        self
    }

    /// Sets a scalar that does not change in time.
    pub fn set_scalar(&mut self, name: &str, value: f64) {
        self.set(name, 0, 1, 1, &[value]);
    }

    /// The value of this name that does not change in time.
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

/// Names for letters at every time level.
struct ByLevel;

impl Inputs for ByLevel {
    fn letter(&self, symbols: &Symbols, letter: Letter) -> String {
        let name = &symbols.get(letter.symbol).name;
        format!("{name} at level {}", letter.shift.time)
    }
}

/// A kernel that takes its inputs from an [`Assignment`].
#[derive(Clone, Debug)]
pub struct Evaluator {
    symbols: Symbols,
    lowered: Lowered,
}

impl Evaluator {
    /// Lowers a program.
    pub fn of(p: &Program) -> Evaluator {
        let name = |id| p.symbols.get(id).name.clone();
        Evaluator {
            symbols: p.symbols.clone(),
            lowered: lower::program(p, &ByLevel, &name),
        }
    }

    /// The values of the results of the program.
    pub fn run(&self, values: &Assignment) -> Result<Vec<Matrix>, EvalError> {
        run_lowered(&self.symbols, &self.lowered, values)
    }
}

fn run_lowered(
    symbols: &Symbols,
    lowered: &Lowered,
    values: &Assignment,
) -> Result<Vec<Matrix>, EvalError> {
    let inputs = lowered.sources.iter().map(|source| match source {
        Source::Letter(l) | Source::RotationOf(l) | Source::QuaternionOf(l) => {
            Ok(values.get(symbols, *l)?.array())
        }
    });
    let inputs: Vec<Array<f64>> = inputs.collect::<Result<_, EvalError>>()?;
    let functionals = |call: &Call, given: &[&Array<f64>]| values.functional(symbols, call, given);
    let arithmetic = Doubles::with(&functionals);
    let found = clebsch_program::evaluate(&arithmetic, &lowered.kernel, &inputs, &values.sizes);
    let found = found.map_err(|e| match e {
        Unvalued::Input(name) => EvalError::Shape(name),
        Unvalued::Size(_) => EvalError::NamedDimension,
        Unvalued::Operation(word) => EvalError::Functional(word.to_owned()),
        Unvalued::Functional(which) => {
            EvalError::Functional(symbols.functionals()[which].name.clone())
        }
    })?;
    Ok(found.iter().map(Matrix::of).collect())
}

/// Evaluates an expression.
pub fn evaluate(symbols: &Symbols, e: &Expr, values: &Assignment) -> Result<Matrix, EvalError> {
    let lowered = lower::expression(symbols, e, &ByLevel);
    let mut all = run_lowered(symbols, &lowered, values)?;
    // One output for one expression.
    Ok(all.swap_remove(0))
}
