//! Functionals with values: a table of functions by name. Each computes its value, its derivatives along directions
//! and its pull-backs.

use super::{Assignment, Matrix};
use crate::expr::symbol::Symbols;
use clebsch_program::{Array, Call};
use std::sync::Arc;

/// A request for a value, a derivative or a pull-back. Arguments are counted from 0.
#[derive(Clone, Copy, Debug)]
pub struct FunctionalRequest<'a> {
    /// The arguments.
    pub arguments: &'a [Matrix],
    /// The argument and the direction of each derivative.
    pub along: &'a [(usize, Matrix)],
    /// The argument and the seed of the pull-back. None for a value or a derivative.
    pub back: Option<(usize, &'a Matrix)>,
}

/// The function that answers a request. None if it lacks the derivative.
type Answers = dyn Fn(&FunctionalRequest) -> Option<Matrix> + Send + Sync;

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
    /// Defines the function of a functional.
    pub fn define(
        &mut self,
        name: &str,
        f: impl Fn(&FunctionalRequest) -> Option<Matrix> + Send + Sync + 'static,
    ) {
        let table = &mut self.functionals.0;
        table.retain(|(known, _)| known != name);
        table.push((name.to_owned(), Arc::new(f)));
    }
}

impl Assignment {
    /// The value of a functional, of a derivative or of a pull-back.
    pub(super) fn functional(
        &self,
        symbols: &Symbols,
        call: &Call,
        given: &[&Array<f64>],
    ) -> Option<Array<f64>> {
        let name = &symbols.functionals()[call.functional].name;
        let all: Vec<Matrix> = given.iter().map(|a| Matrix::of(a)).collect();
        let (arguments, rest) = all.split_at_checked(call.arguments)?;
        let along = call.along.iter().zip(rest);
        let along: Vec<(usize, Matrix)> =
            along.map(|(i, x)| (usize::from(*i), x.clone())).collect();
        let seed = call.back.zip(rest.last());
        let asked = FunctionalRequest {
            arguments,
            along: &along,
            back: seed.map(|(i, seed)| (usize::from(i), seed)),
        };
        let table = &self.functionals.0;
        let (_, f) = table.iter().find(|(known, _)| known == name)?;
        let value = f(&asked)?;
        let fits = self.dim(call.shape.rows).ok()? == value.rows
            && self.dim(call.shape.cols).ok()? == value.cols
            && value.data.len() == value.rows * value.cols;
        fits.then(|| value.array())
    }
}
