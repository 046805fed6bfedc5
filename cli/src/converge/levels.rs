//! Runs of one case to the same time with step sizes h, h/2, h/4, ...
//! Takes a plan; gives errors at that time and the orders between them.

use crate::compare::course::{extrapolation, generated};
use crate::compare::score::errors;
use crate::failure::Failure;
use crate::plan::Plan;
use clebsch::card::Card;
use clebsch::record::Record;

/// Relative errors below this are rounding of some thousand steps, and have no order.
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
    /// The order between this step size and the one before; none where there is none, or where errors are rounding.
    pub orders: Vec<Option<f64>>,
}

/// What was measured.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Measured {
    /// The quantities, by the names of files.
    pub names: Vec<&'static str>,
    /// The largest step size first.
    pub levels: Vec<Level>,
}

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
            // The start and the end alone.
            finer.every = finer.case.steps;
            let (course, _) =
                generated(card, &finer, progress).map_err(|failure| at(h, failure))?;
            runs.push((h, finer.case.steps, course.record));
        }
        // The error of a reversible step has even powers of h alone.
        let power = if card.reversible { 2 } else { 1 };
        let places: Vec<f64> = (0..count)
            .map(|level| 2_f64.powi(level.cast_signed()).powi(-power))
            .collect();
        let records: Vec<&Record> = runs.iter().map(|(_, _, record)| record).collect();
        let truth = extrapolation(&records, &places)?;
        let mut names = Vec::new();
        let mut levels: Vec<Level> = Vec::new();
        for (h, steps, record) in &runs {
            let curves = errors(card, record, &truth);
            names = curves.iter().map(|curve| curve.name).collect();
            let errors: Vec<f64> = curves.iter().map(|curve| curve.last()).collect();
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
        Ok(Self { names, levels })
    }
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
    use super::order;

    #[test]
    fn an_order_is_the_logarithm_of_a_ratio_above_rounding() {
        assert_eq!(order((&4e-3, &1e-3)), Some(2.0));
        assert_eq!(order((&4e-13, &1e-13)), None);
        assert_eq!(order((&1e-3, &0.0)), None);
        assert_eq!(order((&f64::NAN, &1e-3)), None);
    }
}
