//! The verdict by the action as stated. `clebsch-check` judges chosen steps of a trajectory; it shares only the text
//! of the model with derivation and emission. Takes a card, a plan and a trajectory; gives the same trajectory with
//! an observer.

use crate::case_file::statement;
use crate::plan::Plan;
use clebsch::StepError;
use clebsch::card::{Card, Trajectory};
use clebsch::integrate::Halvings;
use clebsch::kinetic::KineticWarning;
use clebsch::saved::{Saved, Words};
use clebsch_check::{Chosen, Judge, Judged, StepSelection, Verdict};
use serde_json::{Value, json};

/// A trajectory whose steps are judged.
pub(crate) struct JudgedTrajectory {
    inner: Box<dyn Trajectory>,
    chosen: Chosen,
    judge: Result<Judge, String>,
    verdict: Verdict,
}

impl JudgedTrajectory {
    /// The trajectory `inner` of the planned run, with its steps judged.
    pub(crate) fn new(
        card: &Card,
        plan: &Plan,
        which: StepSelection,
        inner: Box<dyn Trajectory>,
    ) -> Self {
        let judge = match which {
            StepSelection::None => Err("not requested".to_owned()),
            _ => judge(card, plan),
        };
        let verdict = Verdict {
            // If steps were judged before an interruption, the restored state contains their verdict.
            not_judged: judge
                .as_ref()
                .err()
                .filter(|_| which != StepSelection::None)
                .cloned(),
            ..Verdict::default()
        };
        Self {
            inner,
            chosen: Chosen::new(which, plan.case.steps),
            judge,
            verdict,
        }
    }

    /// The verdict on the judged steps.
    pub(crate) fn verdict(&self) -> &Verdict {
        &self.verdict
    }
}

/// The judge for the steps of this case.
fn judge(card: &Card, plan: &Plan) -> Result<Judge, String> {
    let modified = plan
        .order
        .filter(|order| card.preprocessed && *order > card.order);
    if let Some(order) = modified {
        return Err(format!("a step of order {order} uses modified moments"));
    }
    let (stated, setup) = statement(card, plan.choice.as_ref(), &plan.case, card.observables)?;
    Judge::new(stated, setup)
}

impl Trajectory for JudgedTrajectory {
    fn node(&self) -> u64 {
        self.inner.node()
    }

    fn time(&self) -> f64 {
        self.inner.time()
    }

    fn step(&mut self) -> Result<(), StepError> {
        let number = self.inner.node() + 1;
        let Some(judge) = self
            .judge
            .as_ref()
            .ok()
            .filter(|_| self.chosen.contains(number))
        else {
            return self.inner.step();
        };
        let mut judged = None;
        self.inner.step_in_parts(&mut |share, before, after| {
            let all = judged.take().unwrap_or_else(|| Ok(Judged::nothing()));
            judged =
                Some(all.and_then(|all| Ok(all.and(judge.part(number, share, before, after)?))));
        })?;
        // The parts of a subdivided step cannot be judged.
        if let Some(judged) = judged {
            self.verdict.take(number, judged);
        }
        Ok(())
    }

    fn card(&self) -> &'static Card {
        self.inner.card()
    }

    fn kinetic_warning(&self) -> Option<KineticWarning> {
        self.inner.kinetic_warning()
    }

    fn halvings(&self) -> Option<Halvings> {
        self.inner.halvings()
    }

    fn observe(&self, out: &mut [f64]) {
        self.inner.observe(out);
    }

    fn invariants(&self, out: &mut [f64]) {
        self.inner.invariants(out);
    }

    fn scales(&self, out: &mut [f64]) {
        self.inner.scales(out);
    }

    /// The verdict so far is saved with the trajectory, so that a resumed run reports all its steps.
    fn words(&mut self, words: &mut Words) {
        self.inner.words(words);
        let mut numbers = self.verdict.numbers();
        numbers.words(words);
        if words.are_given() {
            let not_judged = self.verdict.not_judged.take();
            self.verdict = Verdict::of_numbers(&numbers);
            self.verdict.not_judged = not_judged;
        }
    }
}

/// The verdict for files.
pub(crate) fn verdict_json(verdict: &Verdict) -> Value {
    let worst = verdict.worst.as_ref().map(|(node, part)| {
        json!({
            "ratio": part.ratio(),
            "node": node,
            "of": part.what,
            "site": part.site,
            "component": part.component,
            "at_end": part.node == 1,
            "residual": part.residual,
            "bound": part.bound,
        })
    });
    json!({
        "judged": verdict.judged,
        "holds": verdict.not_judged.is_none().then(|| verdict.holds()),
        "measures_nothing": verdict.is_empty(),
        "not_judged": verdict.not_judged,
        "worst": worst,
    })
}
