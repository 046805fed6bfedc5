//! Functionals with values: a table of functions by name, each asked for a value, a derivative along
//! directions or a pull-back.

use super::{Assignment, EvalError, Matrix, evaluate};
use crate::expr::symbol::Symbols;
use crate::expr::{Applied, Expr};
use std::sync::Arc;

/// What a functional is asked for. Arguments are counted from 0.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// The arguments.
    pub arguments: &'a [Matrix],
    /// The argument and the direction of each derivative.
    pub along: &'a [(usize, Matrix)],
    /// The argument and the seed of the pull-back; nothing where the value itself is asked for.
    pub back: Option<(usize, &'a Matrix)>,
}

/// A function that answers; nothing where it has no such derivative.
type Answers = dyn Fn(&Asked) -> Option<Matrix> + Send + Sync;

/// Functions by name.
#[derive(Clone, Default)]
pub(super) struct Table(Vec<(String, Arc<Answers>)>);

impl core::fmt::Debug for Table {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_list()
            .entries(self.0.iter().map(|(n, _)| n))
            .finish()
    }
}

impl Assignment {
    /// Gives a functional its values.
    pub fn define(
        &mut self,
        name: &str,
        f: impl Fn(&Asked) -> Option<Matrix> + Send + Sync + 'static,
    ) {
        let table = &mut self.functionals.0;
        table.retain(|(known, _)| known != name);
        table.push((name.to_owned(), Arc::new(f)));
    }
}

/// The value of a functional, of a derivative or of a pull-back.
pub(super) fn called(
    symbols: &Symbols,
    e: &Expr,
    a: &Applied,
    back: Option<(u8, &Expr)>,
    values: &Assignment,
) -> Result<Matrix, EvalError> {
    let name = &symbols.functional(a.functional).name;
    let go = |x: &Expr| evaluate(symbols, x, values);
    let arguments: Vec<Matrix> = a.arguments.iter().map(go).collect::<Result<_, _>>()?;
    let along = a.along.iter().map(|(i, x)| Ok((usize::from(*i), go(x)?)));
    let along: Vec<(usize, Matrix)> = along.collect::<Result<_, EvalError>>()?;
    let back = match back {
        Some((i, seed)) => Some((usize::from(i), go(seed)?)),
        None => None,
    };
    let asked = Asked {
        arguments: &arguments,
        along: &along,
        back: back.as_ref().map(|(i, seed)| (*i, seed)),
    };
    let found = values.functionals.0.iter().find(|(known, _)| known == name);
    let value = found.and_then(|(_, f)| f(&asked));
    let value = value.ok_or_else(|| EvalError::Functional(name.clone()))?;
    let shape = e.shape();
    let fits = values.dim(shape.rows)? == value.rows
        && values.dim(shape.cols)? == value.cols
        && value.data.len() == value.rows * value.cols;
    match fits {
        true => Ok(value),
        false => Err(EvalError::Shape(name.clone())),
    }
}
