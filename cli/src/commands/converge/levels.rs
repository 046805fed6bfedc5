//! Runs of one case to the same time with step sizes h, h/2, h/4, ...
//! Takes a plan; gives errors at that time and the orders between them.

use crate::commands::compare::course::{extrapolation, generated};
use crate::commands::compare::score::errors;
use crate::plan::Plan;
use crate::terminal::failure::Failure;
use clebsch::card::Card;
use clebsch::record::Record;

/// Relative errors below this are the rounding errors of some thousand steps; no order is computed from them.
pub(super) const ROUNDING: f64 = 1e-12;

/// The errors of one step size.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Level {
    /// The step size.
    pub h: f64,
    /// How many steps lead to the time.
    pub steps: u64,
    /// The error of each quantity, relative to its largest size.
    pub errors: Vec<f64>,
    /// The order between the previous step size and this step size. `None` for the first step size, and if the errors
    /// are rounding.
    pub orders: Vec<Option<f64>>,
}

/// The results of the measurement.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Measured {
    /// The quantities, by the names of files.
    pub names: Vec<&'static str>,
    /// The largest step size first.
    pub levels: Vec<Level>,
    /// The order of each quantity: the slope of a line fitted to the logarithms of its errors. `None` if fewer than
    /// two errors exceed rounding.
    pub fitted: Vec<Option<f64>>,
}

/// If consecutive orders differ by more than this, the step sizes are not yet in the asymptotic range.
const SETTLED: f64 = 0.2;

/// If the differences between runs decrease with a lower order than this, the error has odd powers of the step
/// size too.
const EVEN: f64 = 1.5;

impl Measured {
    /// Runs a case with `count` step sizes.
    ///
    /// # Errors
    /// Usage or failed, as for a run; failed when a run does not reach the time.
    pub fn of(card: &Card, plan: &Plan, count: u32, progress: bool) -> Result<Self, Failure> {
        let mut runs: Vec<(f64, u64, Record)> = Vec::new();
        for level in 0..count {
            let parts = 1_u64 << level;
            let mut finer = plan.clone();
            #[allow(clippy::cast_precision_loss)]
            let h = plan.case.h / parts as f64;
            finer.case.h = h;
            finer.case.steps = plan.case.steps.saturating_mul(parts);
            // Only the start and the end are sampled.
            finer.every = finer.case.steps;
            let (course, _) =
                generated(card, &finer, progress).map_err(|failure| at(h, failure))?;
            runs.push((h, finer.case.steps, course.record));
        }
        // The error of a reversible step has only even powers of h.
        let power = if card.reversible { 2 } else { 1 };
        let records: Vec<&Record> = runs.iter().map(|(_, _, record)| record).collect();
        let limit = |power: i32| {
            let places = (0..count).map(|level| 2_f64.powi(level.cast_signed()).powi(-power));
            extrapolation(&records, &places.collect::<Vec<f64>>())
        };
        let (by_step, all_powers) = (limit(power)?, limit(1)?);
        let is_even = evens(card, &records);
        let mut names = Vec::new();
        let mut levels: Vec<Level> = Vec::new();
        for (h, steps, record) in &runs {
            let curves = errors(card, record, &by_step);
            names = curves.iter().map(|curve| curve.name).collect();
            // A quantity at a node may have a lower order than the motion, such as a momentum that is not
            // projected.
            let odd = errors(card, record, &all_powers);
            let each = curves.iter().zip(&odd).zip(&is_even);
            let errors: Vec<f64> = each
                .map(|((even, odd), is_even)| if *is_even { even.last() } else { odd.last() })
                .collect();
            let orders = match levels.last() {
                None => vec![None; errors.len()],
                Some(before) => before.errors.iter().zip(&errors).map(order).collect(),
            };
            levels.push(Level {
                h: *h,
                steps: *steps,
                errors,
                orders,
            });
        }
        let fitted = (0..names.len()).map(|at| fitted(&levels, at)).collect();
        Ok(Self {
            names,
            levels,
            fitted,
        })
    }

    /// Whether the order of a quantity has converged: its last three values agree. They require four step
    /// sizes.
    pub(super) fn is_settled(&self, at: usize) -> bool {
        let orders = self
            .levels
            .iter()
            .filter_map(|level| *level.orders.get(at)?);
        let orders: Vec<f64> = orders.collect();
        match orders.as_slice() {
            [.., a, b, c] => (a - c).abs().max((b - c).abs()) <= SETTLED,
            _ => false,
        }
    }
}

/// Whether the differences between runs fall as even powers of the step do, for each quantity.
fn evens(card: &Card, records: &[&Record]) -> Vec<bool> {
    let pairs = records.windows(2).filter_map(|two| match two {
        [coarse, fine] => Some(errors(card, coarse, fine)),
        _ => None,
    });
    let apart: Vec<Vec<f64>> = pairs
        .map(|curves| curves.iter().map(|curve| curve.last()).collect())
        .collect();
    let count = apart.first().map_or(0, Vec::len);
    let falls = |at: usize| {
        let of = |row: &Vec<f64>| row.get(at).copied().unwrap_or(0.0);
        let mut each = apart.windows(2).filter_map(|two| match two {
            [coarse, fine] => order((&of(coarse), &of(fine))),
            _ => None,
        });
        // The last difference above rounding: for small steps the lowest power dominates.
        each.next_back()
    };
    (0..count)
        .map(|at| falls(at).is_none_or(|order| order >= EVEN))
        .collect()
}

/// The slope of the line through the logarithms of the errors of a quantity that are above rounding.
fn fitted(levels: &[Level], at: usize) -> Option<f64> {
    let points = levels.iter().filter_map(|level| {
        let error = level.errors.get(at).filter(|error| **error > ROUNDING)?;
        Some((level.h.ln(), error.ln()))
    });
    let points: Vec<(f64, f64)> = points.collect();
    #[allow(clippy::cast_precision_loss)]
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let both: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let square: f64 = points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum();
    (points.len() > 1).then(|| both / square)
}

/// A failure of the run with this step size.
fn at(h: f64, failure: Failure) -> Failure {
    match failure {
        Failure::Failed(why) => Failure::Failed(format!("with h = {h}: {why}")),
        other => other,
    }
}

/// The order between errors of steps h and h/2.
fn order((coarse, fine): (&f64, &f64)) -> Option<f64> {
    let measured = *fine > ROUNDING && *coarse > ROUNDING;
    measured.then(|| (coarse / fine).log2())
}

#[cfg(test)]
mod tests {
    use super::{Level, fitted, order};

    #[test]
    fn an_order_is_fitted_to_all_errors_above_rounding() {
        let level = |h: f64, error: f64| Level {
            h,
            steps: 1,
            errors: vec![error],
            orders: vec![None],
        };
        let levels = [
            level(0.4, 1.6),
            level(0.2, 0.4),
            level(0.1, 0.1),
            level(0.05, 1e-15),
        ];
        let found = fitted(&levels, 0).expect("three errors");
        assert!((found - 2.0).abs() < 1e-12, "{found}");
        assert_eq!(fitted(&levels[2..], 0), None);
    }

    #[test]
    fn an_order_settles_where_it_stops_changing() {
        let of = |orders: &[f64]| {
            let level = |order: &f64| Level {
                h: 1.0,
                steps: 1,
                errors: vec![1.0],
                orders: vec![Some(*order)],
            };
            let levels = orders.iter().map(level).collect();
            let (names, fitted) = (vec!["x"], vec![Some(1.0)]);
            super::Measured {
                names,
                levels,
                fitted,
            }
            .is_settled(0)
        };
        assert!(of(&[0.5, 1.9, 1.95, 2.0]));
        // The steps are too long: these orders belong to a model that reaches order 2 later.
        assert!(!of(&[0.9, 0.58, 0.56]));
        assert!(!of(&[2.0, 2.0]));
    }

    #[test]
    fn an_order_is_the_logarithm_of_a_ratio_above_rounding() {
        assert_eq!(order((&4e-3, &1e-3)), Some(2.0));
        assert_eq!(order((&4e-13, &1e-13)), None);
        assert_eq!(order((&1e-3, &0.0)), None);
        assert_eq!(order((&f64::NAN, &1e-3)), None);
    }
}
