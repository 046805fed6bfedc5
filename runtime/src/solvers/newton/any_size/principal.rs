//! Tests by one correction from rest whether a solution is the principal root. Takes the solution and the residual at
//! rest.

use super::{AnyNewton, Chart};
use crate::linalg::{Dense, DenseFactors, Reals};
use crate::scalar::larger;
use crate::solvers::newton::checked_points::{CheckedPoint, Remainders, looks, shared_noise};
use crate::solvers::newton::continuation_stage::{less, times};
use crate::solvers::newton::parts::{SlowPartTest, Squares};

impl<C: Chart> AnyNewton<'_, C> {
    /// Whether the solution is the principal root: see [`Newton::is_principal`](super::super::Newton::is_principal).
    #[must_use]
    pub fn is_principal(
        &self,
        solution: &C::Element,
        at_rest: &[f64],
        residual: impl Fn(&C::Element) -> Reals,
    ) -> bool {
        self.follows(solution, at_rest, residual) || self.holds(solution)
    }

    /// Like `is_principal`, for all unknowns: see [`Newton::is_part_of_principal`](super::super::Newton::is_part_of_principal).
    pub fn is_part_of_principal(
        &mut self,
        solution: &C::Element,
        at_rest: &[f64],
        tangent: impl FnOnce() -> Dense<f64>,
    ) -> bool {
        let (chart, size) = (self.whole, self.whole.parts().dimension());
        let (factors, units) = self.search.whole.get_or_insert_with(|| {
            let tangent = tangent();
            let units = chart
                .parts()
                .units(&|i, j| tangent.at(i, j), SlowPartTest::OfStep);
            let mut factors = DenseFactors::none(size, true);
            factors.set(&tangent);
            (factors, units.into_vec())
        });
        let correction = factors.solve(at_rest);
        correction.is_some_and(|x| comes_near(chart, &x, solution, units, &|_| 0.0))
            || self.holds(solution)
    }

    fn holds(&self, solution: &C::Element) -> bool {
        self.anchor.as_ref().is_some_and(|anchor| {
            let from = self.whole.between(&anchor.root, solution);
            self.whole.is_within(&from, &anchor.reach)
        })
    }

    fn follows(
        &self,
        solution: &C::Element,
        at_rest: &[f64],
        residual: impl Fn(&C::Element) -> Reals,
    ) -> bool {
        let (search, chart) = (&*self.search, self.chart);
        let right: Reals = at_rest.iter().map(|x| x * search.unit).collect();
        let noise = |b: usize| search.noise.get(b).copied().unwrap_or(0.0);
        let units = &search.units;
        let correction = search.factors.solve(&right);
        let Some(x) = correction.filter(|x| comes_near(chart, x, solution, units, &noise)) else {
            return false;
        };
        if !search.open {
            return true;
        }
        let parts = chart.parts();
        let ways = parts.lengths(&x);
        let near = |off: &[f64], noise: &dyn Fn(usize) -> f64| {
            let off = parts.lengths(off);
            let squares = ways.iter().zip(&off).map(|(x, y)| [x * x, y * y]);
            parts.are_near(&squares.collect::<Squares>(), units, noise)
        };
        // If the rounding error is unknown, differences may be only rounding.
        let shared = shared_noise(&search.noise, units);
        let known = shared > 0.0;
        let noises = |b: usize| larger(noise(b), shared * units.get(b).copied().unwrap_or(0.0));
        let (rest, mut at) = (chart.identity(), C::Element::default());
        let mut so_far = Remainders::nothing(Reals::from_elem(0.0, x.len()));
        let varies_little = |look: CheckedPoint| {
            let step: Reals = x.iter().map(|x| -x * look.share).collect();
            chart.retract(&rest, &step, &mut at);
            let found = residual(&at);
            let goals = at_rest.iter().map(|x| x * (1.0 - look.share));
            let left = found.iter().zip(goals).map(|(x, y)| (x - y) * search.unit);
            let left: Reals = left.collect();
            search.factors.solve(&left).is_some_and(|off| {
                let judged = so_far.next(look, &off, |x, y| less(x, y));
                let mut judged = judged.iter().flatten();
                near(&off, &noise)
                    && (!known
                        || judged.all(|x| {
                            let difference: Reals = times(&x.difference, x.factor);
                            near(&difference, &|b: usize| x.noise(noises(b)))
                        }))
            })
        };
        let lengths = chart.lengths(solution);
        let shares = lengths.iter().zip(&ways).zip(&parts.open);
        let shares = shares
            .filter(|(_, open)| **open)
            .map(|((length, way), _)| length / way);
        let reach = shares.filter(|x| x.is_finite()).fold(1.0, larger);
        looks(reach).all(varies_little)
    }

    /// Whether the test evaluates the equations.
    #[must_use]
    pub fn asks_equations(&self) -> bool {
        let reduced = self.chart.parts() != self.whole.parts();
        self.search.open || reduced && self.search.whole.is_none()
    }
}

/// Whether the negative of `correction`, applied at rest, comes within a quarter of the displacement of the solution.
fn comes_near<C: Chart>(
    chart: &C,
    correction: &[f64],
    solution: &C::Element,
    units: &[f64],
    noise: &dyn Fn(usize) -> f64,
) -> bool {
    let step: Reals = correction.iter().map(|x| -x).collect();
    let mut squares = Squares::from_elem([0.0; 2], chart.parts().count());
    chart.compared(solution, &step, &mut squares);
    chart.parts().are_near(&squares, units, noise)
}
