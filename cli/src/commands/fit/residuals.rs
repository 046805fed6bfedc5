//! Residuals of a case against data, with exact derivatives: adjoints of runs for parameters, tangents of steps if only
//! initial values vary. Takes data and names; gives what `clebsch_analysis::fit` needs.

use super::data::{Data, Datum};
use super::vary::Vary;
use crate::derivatives::expression::Expression;
use crate::derivatives::flow::{matrix, seen};
use crate::derivatives::problem::Problem;
use crate::models::gallery::Case;
use clebsch::derivatives::{Cost, Derivatives, Gradient, NoDerivative, Seen};
use clebsch::nalgebra::{DMatrix, DVector};
use clebsch_analysis::Residuals;
use std::thread;

/// The most threads that differentiate runs.
const THREADS: usize = 16;

/// Residuals of a case.
pub(super) struct Misfit<'a> {
    pub problem: &'a Problem,
    pub data: &'a Data,
    pub vary: &'a [Vary],
    /// The number of local coordinates of a state.
    pub states: usize,
}

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
    /// What is observed at every node of a datum, in the order of the data.
    pub fn observed(&self, case: &Case) -> Result<Vec<f64>, NoDerivative> {
        let mut flow = self.problem.open_case(case)?;
        let mut values = Vec::with_capacity(self.data.all.len());
        self.along(&mut *flow, &mut |flow, at, own| {
            let all = seen(flow, at)?;
            values.extend(own.iter().map(|datum| self.column(datum).value(&all)));
            Ok(())
        })?;
        Ok(values)
    }

    fn column(&self, datum: &Datum) -> &Expression {
        // Every datum has a column.
        &self.data.columns[datum.column]
    }

    /// Follows the run; calls `visit` at each node with data.
    fn along(&self, flow: &mut dyn Derivatives, visit: Visit<'_>) -> Result<(), NoDerivative> {
        let mut at = flow.start();
        let mut rest = self.data.all.as_slice();
        for node in 0..=self.data.last() {
            let count = rest.iter().take_while(|datum| datum.node == node).count();
            let (own, later) = rest.split_at(count);
            rest = later;
            if !own.is_empty() {
                visit(flow, &at, own)?;
            }
            if node < self.data.last() {
                at = flow.step(&at)?;
            }
        }
        Ok(())
    }

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
    fn by_adjoints(&self, case: &Case) -> Result<Vec<Vec<f64>>, NoDerivative> {
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
    fn by_tangents(&self, case: &Case) -> Result<Vec<Vec<f64>>, NoDerivative> {
        let mut flow = self.problem.open_case(case)?;
        let n = self.states;
        let (mut product, mut at) = (DMatrix::<f64>::identity(n, n), flow.start());
        let mut rows = Vec::with_capacity(self.data.all.len());
        let mut rest = self.data.all.as_slice();
        for node in 0..=self.data.last() {
            let count = rest.iter().take_while(|datum| datum.node == node).count();
            let (own, later) = rest.split_at(count);
            rest = later;
            if !own.is_empty() {
                let all = seen(&mut *flow, &at)?;
                let (observed, conserved) =
                    (matrix(&flow.observed(&at)?), matrix(&flow.conserved(&at)?));
                for datum in own {
                    let mut weights = vec![0.0; observed.nrows()];
                    let mut of_invariants = vec![0.0; conserved.nrows()];
                    self.column(datum)
                        .weigh(&all, &mut weights, &mut of_invariants);
                    let slope = observed.tr_mul(&DVector::from_vec(weights))
                        + conserved.tr_mul(&DVector::from_vec(of_invariants));
                    let whole = product.tr_mul(&slope);
                    rows.push(self.row(&Gradient {
                        parameters: Vec::new(),
                        initial: vec![whole.as_slice().to_vec()],
                        step: 0.0,
                    }));
                }
            }
            if node < self.data.last() {
                let (next, tangent) = flow.tangent(&at)?;
                product = matrix(&tangent) * product;
                at = next;
            }
        }
        Ok(rows)
    }
}

/// What is done at a node with data.
type Visit<'a> = &'a mut dyn FnMut(
    &mut dyn Derivatives,
    &clebsch::derivatives::Point,
    &[Datum],
) -> Result<(), NoDerivative>;

impl Residuals for Misfit<'_> {
    type Parameters = Case;
    type Error = NoDerivative;

    fn dimension(&self) -> usize {
        self.vary.iter().map(|own| own.names().len()).sum()
    }

    fn residuals(&self, at: &Case) -> Result<DVector<f64>, NoDerivative> {
        let observed = self.observed(at)?;
        let pairs = observed.iter().zip(&self.data.all);
        Ok(DVector::from_vec(
            pairs.map(|(x, datum)| x - datum.value).collect(),
        ))
    }

    fn jacobian(&self, at: &Case) -> Result<DMatrix<f64>, NoDerivative> {
        let varies_parameters = self
            .vary
            .iter()
            .any(|own| matches!(own, Vary::Parameter { .. }));
        let rows = match varies_parameters {
            true => self.by_adjoints(at)?,
            false => self.by_tangents(at)?,
        };
        let n = self.dimension();
        Ok(DMatrix::from_row_iterator(
            rows.len(),
            n,
            rows.into_iter().flatten(),
        ))
    }

    fn moved(&self, at: &Case, by: &[f64]) -> Case {
        let mut case = at.clone();
        let mut local = vec![0.0; self.states];
        let mut moves = false;
        let mut by = by.iter().copied();
        for own in self.vary {
            match own {
                Vary::Parameter { places, .. } => {
                    let d = by.next().unwrap_or(0.0);
                    for (field, entry, sign) in places {
                        let place = case
                            .parameters
                            .get_mut(*field)
                            .and_then(|own| own.get_mut(*entry));
                        if let Some(place) = place {
                            *place += sign * d;
                        }
                    }
                }
                Vary::Initial { first, names, .. } => {
                    moves = true;
                    for (place, d) in local
                        .iter_mut()
                        .skip(*first)
                        .zip(by.by_ref().take(names.len()))
                    {
                        *place = d;
                    }
                }
            }
        }
        if !moves {
            return case;
        }
        let moved = self.problem.open_case(&case).and_then(|mut flow| {
            let start = flow.start();
            let at = flow.moved(&start, &local)?;
            self.problem.case_at(&case, &mut *flow, &at)
        });
        // A case that does not exist has no residuals, and the step is shortened.
        moved.unwrap_or(Case {
            h: f64::NAN,
            ..case
        })
    }
}
