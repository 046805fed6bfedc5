//! Residuals of a case against data. Takes data and names; gives what `clebsch_analysis::fit` needs.

use super::data::{Data, Datum};
use super::vary::Vary;
use crate::derivatives::expression::Expression;
use crate::derivatives::flow::{matrix, seen};
use crate::derivatives::problem::Problem;
use crate::models::gallery::Case;
use clebsch::derivatives::{Derivatives, NoDerivative, Point};
use clebsch::nalgebra::{DMatrix, DVector};
use clebsch_analysis::Residuals;

/// Residuals of a case.
pub(super) struct Misfit<'a> {
    pub problem: &'a Problem,
    pub data: &'a Data,
    pub vary: &'a [Vary],
    /// The number of local coordinates of a state.
    pub states: usize,
}

impl Misfit<'_> {
    /// The observables at every node of a datum, in the order of the data.
    pub fn observed(&self, case: &Case) -> Result<Vec<f64>, NoDerivative> {
        let mut flow = self.problem.open_case(case)?;
        let mut values = Vec::with_capacity(self.data.all.len());
        self.along(&mut *flow, false, &mut |flow, at, _, own| {
            let all = seen(flow, at)?;
            values.extend(own.iter().map(|datum| self.column(datum).value(&all)));
            Ok(())
        })?;
        Ok(values)
    }

    pub fn column(&self, datum: &Datum) -> &Expression {
        // Every datum has a column.
        &self.data.columns[datum.column]
    }

    /// Follows the run; calls `visit` at each node with data. With `tangents`, the derivative of the state in the initial
    /// state is passed on, otherwise the identity.
    pub fn along(
        &self,
        flow: &mut dyn Derivatives,
        tangents: bool,
        visit: Visit<'_>,
    ) -> Result<(), NoDerivative> {
        let mut at = flow.start();
        let mut product = DMatrix::identity(self.states, self.states);
        let mut rest = self.data.all.as_slice();
        for node in 0..=self.data.last() {
            let count = rest.iter().take_while(|datum| datum.node == node).count();
            let (own, later) = rest.split_at(count);
            rest = later;
            if !own.is_empty() {
                visit(flow, &at, &product, own)?;
            }
            if node == self.data.last() {
                break;
            }
            at = match tangents {
                false => flow.step(&at)?,
                true => {
                    let (next, tangent) = flow.tangent(&at)?;
                    product = matrix(&tangent) * product;
                    next
                }
            };
        }
        Ok(())
    }
}

/// The work at a node with data.
type Visit<'a> = &'a mut dyn FnMut(
    &mut dyn Derivatives,
    &Point,
    &DMatrix<f64>,
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
        // If a case does not exist, the search shortens its step.
        moved.unwrap_or(Case {
            h: f64::NAN,
            ..case
        })
    }
}
