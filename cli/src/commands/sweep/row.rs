//! One point of a sweep: its plan, and its row of the table.

use super::{Sweep, table, vary};
use crate::named::resolve::Resolved;
use crate::plan::Plan;
use crate::terminal::failure::Failure;
use crate::trajectory::verdict::{Verdict, judge};
use clebsch::integrate::{Observer, RunError, Watch};
use std::borrow::Cow;

/// Steps of a point between two looks at the signals.
const AT_A_TIME: u64 = 256;

impl Sweep<'_> {
    /// The plan of a point, and the varied values at that point. Momenta are computed from velocities at that
    /// point.
    fn at(&self, point: u64) -> (Result<Plan, Failure>, Vec<f64>) {
        let values = vary::at(self.axes, point);
        let mut plan = match self.read_again(&values) {
            Ok(plan) => plan,
            Err(failure) => return (Err(failure), values),
        };
        for (axis, value) in self.axes.iter().zip(&values) {
            match axis.quantity.is_step() {
                true => plan = plan.with_step(*value),
                false => axis.quantity.put(*value, &mut plan.case, &mut plan.motion),
            }
        }
        let started = plan.start_anew(self.card);
        (started.map(|()| plan), values)
    }

    /// The plan of a point before its values are inserted. The case is read again if its expressions depend on
    /// them.
    fn read_again(&self, values: &[f64]) -> Result<Plan, Failure> {
        let Some((resolved, matches)) = self.again else {
            return Ok(self.plan.clone());
        };
        let names = self.axes.iter().map(|axis| axis.quantity.name.clone());
        let values: Vec<(String, String)> =
            names.zip(values.iter().map(|x| format!("{x:?}"))).collect();
        let there = Resolved {
            entry: Cow::Borrowed(&*resolved.entry),
            case: resolved.case.clone().with(&values),
            compiled: resolved.compiled,
        };
        let mut plan = Plan::new(&there, matches)?;
        // The step size and the number of steps come from the plan of the sweep.
        (plan.case.h, plan.case.steps) = (self.plan.case.h, self.plan.case.steps);
        Ok(plan)
    }

    /// The reason why a point cannot be started.
    pub(super) fn refusal(&self, point: u64) -> String {
        let (plan, _) = self.at(point);
        match plan.and_then(|plan| plan.open(self.card)) {
            Err(failure) => failure.to_string(),
            Ok(mut trajectory) => match trajectory.step() {
                Err(error) => error.to_string(),
                Ok(()) => "an observed value is not a number at the start".to_owned(),
            },
        }
    }

    /// Computes the row of a point; false if `asked` stopped it before its end.
    pub(super) fn row(&self, point: u64, row: &mut [u64], asked: &dyn Fn() -> bool) -> bool {
        let (plan, values) = self.at(point);
        row.fill(f64::NAN.to_bits());
        let mut slots = row.iter_mut();
        if let Some(slot) = slots.next() {
            *slot = point;
        }
        let mut put = |x: f64| {
            if let Some(slot) = slots.next() {
                // The same NaN in all rows, so that rows do not depend on its origin.
                *slot = if x.is_nan() { f64::NAN } else { x }.to_bits();
            }
        };
        values.into_iter().for_each(&mut put);
        let opened = plan.and_then(|plan| Ok((plan.open(self.card)?, plan)));
        let Ok((mut trajectory, plan)) = opened else {
            put(table::REFUSED);
            put(0.0);
            put(0.0);
            return true;
        };
        let steps = plan.case.steps;
        // Samples at looks: if a number is not finite, the row has the state of the last look before it.
        let mut watch = Watch::new(trajectory.as_ref(), steps, Plan::default_every(steps));
        let mut last = Last(vec![f64::NAN; self.card.observable_count()]);
        let status = loop {
            match watch.advance(trajectory.as_mut(), &mut last, AT_A_TIME) {
                Err(error) => {
                    watch.stop(trajectory.as_ref(), &mut last, &error);
                    break match (watch.summary().steps, error) {
                        (0, RunError::Step(_)) => table::REFUSED,
                        _ => table::STOPPED,
                    };
                }
                Ok(()) if watch.is_over() => break table::DONE,
                Ok(()) if asked() => return false,
                Ok(()) => {}
            }
        };
        let summary = watch.summary();
        let outcomes = judge(self.card, &plan.case, &summary.drifts);
        let kept = outcomes
            .iter()
            .all(|outcome| outcome.verdict != Verdict::Left);
        put(status);
        put(summary.steps as f64);
        put(summary.time);
        put(f64::from(u8::from(kept)));
        let mut drifts = summary.drifts.iter().map(|drift| drift.worst);
        (0..self.card.invariant_count()).for_each(|_| put(drifts.next().unwrap_or(f64::NAN)));
        last.0.into_iter().for_each(&mut put);
        true
    }
}

/// The observables of the last sample.
struct Last(Vec<f64>);

impl Observer for Last {
    fn sample(&mut self, _: u64, _: f64, observables: &[f64], _: &[f64]) {
        self.0.copy_from_slice(observables);
    }
}
