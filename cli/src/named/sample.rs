//! Sample positions that satisfy the constraints. Takes a model and placeholder values; gives fields moved onto the
//! constraints by the smallest change, so that the case runs.

use crate::models::gallery::Case;
use clebsch::card::{Card, Kind};
use clebsch::nalgebra::{DMatrix, DVector};
use clebsch_core::check::{self, spec::Spec};
use clebsch_core::interpret::{Assignment, evaluate};
use clebsch_core::syntax::ast::Model;

/// The largest number of Newton steps. Far from a solution a step at least halves the distance; near it the
/// convergence is quadratic.
const MOST: usize = 60;

/// The rounding error of a constraint whose terms have size one.
const ROUNDING: f64 = 4e-16;

/// Moves the fields of a case onto the constraints of a model. If that fails, or if only rotations are
/// constrained, the fields are unchanged.
pub(crate) fn onto_constraints(model: &Model, card: &Card, case: &mut Case) {
    let Ok(spec) = check::check(model) else {
        return;
    };
    let held = ConstrainedCase { spec, card };
    if let Some(moved) = held.moved(case) {
        case.initial = moved;
    }
}

struct ConstrainedCase<'a> {
    spec: Spec,
    card: &'a Card,
}

impl ConstrainedCase<'_> {
    /// The entries that may change, each as a field and an entry of it.
    fn free(&self) -> Vec<(usize, usize)> {
        let symbols = &self.spec.symbols;
        let is_field = |name: &str| {
            let mut all = self.spec.configurations.iter();
            all.any(|c| c.group.is_additive() && symbols.get(c.element).name == name)
        };
        let fields = self.card.initial.iter().enumerate();
        fields
            .filter(|(_, f)| is_field(f.name))
            .flat_map(|(i, f)| (0..f.count()).map(move |entry| (i, entry)))
            .filter(|(i, entry)| self.is_entry(*i, *entry))
            .collect()
    }

    /// Whether an entry is independent: a diagonal matrix has only its diagonal.
    fn is_entry(&self, i: usize, entry: usize) -> bool {
        let f = &self.card.initial[i];
        f.kind != Kind::Diagonal || entry / f.cols == entry % f.cols
    }

    /// The residuals of the constraints.
    fn left(&self, case: &Case, initial: &[Vec<f64>]) -> Option<DVector<f64>> {
        let mut values = Assignment::new();
        let parameters = self.card.parameters.iter().zip(&case.parameters);
        for (f, v) in parameters.chain(self.card.initial.iter().zip(initial)) {
            values.set(f.name, 0, f.rows, f.cols, v);
        }
        let mut out = Vec::new();
        for hold in &self.spec.holds {
            let value = evaluate(&self.spec.symbols, &hold.value, &values).ok()?;
            let rows = hold.value.shape().rows;
            let count = self.spec.symbols.sizes(rows).0;
            out.extend((0..count).map(|i| value.get(i, 0)));
        }
        let all_finite = out.iter().all(|x: &f64| x.is_finite());
        all_finite.then(|| DVector::from_vec(out))
    }

    fn moved(&self, case: &Case) -> Option<Vec<Vec<f64>>> {
        let free = self.free();
        if free.is_empty() {
            return None;
        }
        let mut at = case.initial.clone();
        for round in 0..MOST {
            let left = self.left(case, &at)?;
            if left.amax() <= ROUNDING {
                return Some(at);
            }
            let columns = free.iter().map(|&(i, entry)| {
                // Central differences are accurate to ten digits, and Newton's method squares the residual.
                let d = 1e-5 * at[i][entry].abs().max(1.0);
                let beside = |by: f64| {
                    let mut other = at.clone();
                    other[i][entry] += by;
                    self.left(case, &other)
                };
                Some((beside(d)? - beside(-d)?) / (2.0 * d))
            });
            let columns: Option<Vec<DVector<f64>>> = columns.collect();
            let slope = DMatrix::from_columns(&columns?);
            let normal = &slope * slope.transpose();
            let change = normal.clone().lu().solve(&left).filter(|_| {
                let least = normal.symmetric_eigenvalues().min();
                least > 1e-12 * normal.amax()
            });
            let before = at.clone();
            match change {
                Some(weights) => {
                    let step = slope.transpose() * weights;
                    for (&(i, entry), by) in free.iter().zip(step.iter()) {
                        at[i][entry] -= by;
                    }
                }
                // The constraints have no independent derivatives, as for the distance of two equal positions:
                // separate the entries.
                None => {
                    for (n, &(i, entry)) in free.iter().enumerate() {
                        at[i][entry] += 0.1 * (1 + n + round) as f64;
                    }
                }
            }
            let closer = self
                .left(case, &at)
                .is_some_and(|now| now.amax() < left.amax());
            if left.amax() < 1e-12 && !closer {
                return Some(before);
            }
        }
        None
    }
}
