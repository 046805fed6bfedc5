//! How a case is run, as the options of `clebsch run` say it.

use crate::overrides::steps_to;
use crate::plan::Plan;
use crate::terminal::failure::Failure;
use clebsch::card::OpenError;
use clebsch::solvers::Method;
use clebsch_check::StepSelection;

/// The options of a run. A case gives the step size and the number of steps.
#[derive(Clone, Debug)]
pub struct Request {
    /// The end time, instead of a number of steps.
    pub until: Option<f64>,
    /// The number of nodes between samples; by default at most ten thousand nodes are sampled. 0 samples the start
    /// and the end.
    pub every: Option<u64>,
    /// The order of a step.
    pub order: Option<u32>,
    /// The solver of the implicit step.
    pub solver: Option<String>,
    /// Whether steps with modified moments are compensated.
    pub compensated: bool,
    /// Whether a failed step is retried as substeps.
    pub halve: bool,
    /// The steps to judge by the action as stated.
    pub judged: StepSelection,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            until: None,
            every: None,
            order: None,
            solver: None,
            compensated: false,
            halve: false,
            judged: StepSelection::None,
        }
    }
}

impl Request {
    /// Applies the options to a plan.
    ///
    /// # Errors
    /// Usage: an unknown solver, or more steps than can be counted.
    pub(super) fn applied(
        &self,
        plan: &mut Plan,
        offered: &'static [&'static str],
    ) -> Result<(), Failure> {
        if let Some(time) = self.until {
            if !(time.is_finite() && time > 0.0) {
                return Err(Failure::Usage(format!(
                    "until: the time must be positive and finite, found {time}"
                )));
            }
            plan.case.steps = steps_to(time, plan.case.h).ok_or_else(|| {
                let h = plan.case.h;
                Failure::Usage(format!(
                    "until: time {time} needs too many steps of {h}; give a larger h"
                ))
            })?;
        }
        if plan.case.steps == 0 {
            return Err(Failure::Usage(
                "steps: the case does not give a number of steps; give steps=N or until=T"
                    .to_owned(),
            ));
        }
        plan.every = self
            .every
            .unwrap_or_else(|| Plan::default_every(plan.case.steps));
        plan.order = self.order;
        plan.compensated = self.compensated;
        plan.halve = self.halve;
        plan.solver = match &self.solver {
            None => None,
            Some(name) => {
                let unknown =
                    |_| Failure::Usage(format!("solver: {}", OpenError::Solver { offered }));
                Some(name.parse::<Method>().map_err(unknown)?)
            }
        };
        Ok(())
    }
}
