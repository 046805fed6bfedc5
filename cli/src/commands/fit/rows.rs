//! Exact derivatives of residuals: adjoints of runs for parameters, tangents of steps if only initial values vary.
//! Takes a case; gives one row for each datum.

use super::residuals::Misfit;
use super::vary::Vary;
use crate::derivatives::expression::Expression;
use crate::derivatives::flow::{matrix, seen};
use crate::models::gallery::Case;
use clebsch::derivatives::{Cost, Gradient, NoDerivative, Seen};
use clebsch::nalgebra::DVector;
use std::thread;

/// The most threads that differentiate runs.
const THREADS: usize = 16;

/// One datum as a cost.
struct One<'a> {
    of: &'a Expression,
    node: u64,
}

impl Cost for One<'_> {
    fn is_at(&self, node: u64) -> bool {
        node == self.node
    }

    fn weigh(
        &mut self,
        node: u64,
        seen: &Seen<'_>,
        weights: &mut [f64],
        of_invariants: &mut [f64],
    ) {
        if node != self.node {
            return;
        }
        let all = [seen.observables, seen.invariants].concat();
        self.of.weigh(&all, weights, of_invariants);
    }
}

impl Misfit<'_> {
    /// The row of a datum from the gradient of its quantity.
    fn row(&self, gradient: &Gradient) -> Vec<f64> {
        let initial = gradient.initial.concat();
        let mut row = Vec::new();
        for own in self.vary {
            match own {
                Vary::Parameter { places, .. } => row.push(
                    places
                        .iter()
                        .map(|(field, entry, sign)| {
                            let own = gradient.parameters.get(*field);
                            sign * own.and_then(|own| own.get(*entry)).copied().unwrap_or(0.0)
                        })
                        .sum(),
                ),
                Vary::Initial { first, names, .. } => {
                    row.extend(initial.iter().skip(*first).take(names.len()));
                }
            }
        }
        row
    }

    /// Rows by an adjoint for each datum, on several threads.
    pub fn by_adjoints(&self, case: &Case) -> Result<Vec<Vec<f64>>, NoDerivative> {
        let count = thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let count = count.clamp(1, THREADS);
        let rows = |part: usize| -> Result<Vec<(usize, Vec<f64>)>, NoDerivative> {
            let mut flow = self.problem.open_case(case)?;
            let own = self.data.all.iter().enumerate().skip(part).step_by(count);
            let each = own.map(|(i, datum)| {
                let mut cost = One {
                    of: self.column(datum),
                    node: datum.node,
                };
                Ok((i, self.row(&flow.gradient(datum.node, &mut cost)?)))
            });
            each.collect()
        };
        let rows = &rows;
        let parts: Vec<_> = thread::scope(|scope| {
            let all: Vec<_> = (0..count)
                .map(|part| scope.spawn(move || rows(part)))
                .collect();
            let stopped = || {
                Err(NoDerivative::Unrecorded {
                    what: "the residuals",
                })
            };
            all.into_iter()
                .map(|one| one.join().unwrap_or_else(|_| stopped()))
                .collect()
        });
        let mut found = Vec::new();
        for part in parts {
            found.extend(part?);
        }
        found.sort_by_key(|(i, _)| *i);
        Ok(found.into_iter().map(|(_, row)| row).collect())
    }

    /// Rows by the tangents of the steps of one run.
    pub fn by_tangents(&self, case: &Case) -> Result<Vec<Vec<f64>>, NoDerivative> {
        let mut flow = self.problem.open_case(case)?;
        let mut rows = Vec::with_capacity(self.data.all.len());
        self.along(&mut *flow, true, &mut |flow, at, product, own| {
            let all = seen(flow, at)?;
            let (observed, conserved) = (matrix(&flow.observed(at)?), matrix(&flow.conserved(at)?));
            for datum in own {
                let mut weights = DVector::zeros(observed.nrows());
                let mut of_invariants = DVector::zeros(conserved.nrows());
                let column = self.column(datum);
                column.weigh(&all, weights.as_mut_slice(), of_invariants.as_mut_slice());
                let slope = observed.tr_mul(&weights) + conserved.tr_mul(&of_invariants);
                rows.push(self.row(&Gradient {
                    parameters: Vec::new(),
                    initial: vec![product.tr_mul(&slope).as_slice().to_vec()],
                    step: 0.0,
                }));
            }
            Ok(())
        })?;
        Ok(rows)
    }
}
