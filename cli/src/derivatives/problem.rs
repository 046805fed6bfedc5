//! A case whose steps are differentiated. Takes the arguments of a command; gives the model from its text, the plan,
//! and trajectories with derivatives.

use crate::derivatives::flow::Steps;
use crate::models::gallery::{Case, Gallery};
use crate::named::resolve::resolved;
use crate::plan::Plan;
use crate::terminal::Streams;
use crate::terminal::failure::Failure;
use crate::terminal::waiting::Waiting;
use crate::words::plain::shown;
use clap::ArgMatches;
use clebsch::card::{Card, Settings};
use clebsch::derivatives::{Derivatives, NoDerivative, Point};
use serde_json::{Value, json};

/// A model with a plan.
pub(crate) struct Problem {
    /// The model, read from its text.
    pub card: Card,
    /// The case, options applied.
    pub plan: Plan,
}

impl Problem {
    /// The problem of the arguments of a command.
    ///
    /// # Errors
    /// Usage: the model or the case is wrong. Failed: the first step fails.
    pub fn new(
        gallery: &Gallery,
        matches: &ArgMatches,
        streams: &mut Streams<'_>,
    ) -> Result<Self, Failure> {
        let resolved = resolved(gallery, matches, streams)?;
        let plan = Plan::new(&resolved, matches)?;
        if plan.halve {
            return Err(Failure::Usage(
                "--halve: subdivided steps have no derivative. Remove the option, or use a smaller --h".to_owned(),
            ));
        }
        let own = resolved.entry.card_of(&plan.case);
        // Compiled steppers explain wrong values of a case.
        drop(plan.open(&own)?);
        let card = match own.differentiate {
            Some(_) => own,
            None => {
                let _told = Waiting::showing("deriving the equations".to_owned(), streams.progress);
                from_text(&own, &plan, gallery)?
            }
        };
        Ok(Self { card, plan })
    }

    /// The trajectory of the case.
    ///
    /// # Errors
    /// Failed: the model cannot be differentiated.
    pub fn open(&self) -> Result<Box<dyn Derivatives>, Failure> {
        self.open_case(&self.plan.case)
            .map_err(|why| self.refused(&why))
    }

    /// The trajectory of another case of the model.
    ///
    /// # Errors
    /// The case is not valid, or the model cannot be differentiated.
    pub fn open_case(&self, case: &Case) -> Result<Box<dyn Derivatives>, NoDerivative> {
        let settings = Settings {
            order: self.plan.order,
            solver: self.plan.solver,
            compensated: self.plan.compensated,
            ..Settings::step(case.h)
        };
        let differentiate = self
            .card
            .differentiate
            .ok_or(NoDerivative::Unrecorded { what: "the steps" })?;
        differentiate(&case.parameters, &case.initial, settings)
    }

    /// The steps of the case, for the algorithms of the analysis.
    ///
    /// # Errors
    /// Failed: the model cannot be differentiated.
    pub fn steps(&self) -> Result<Steps, Failure> {
        let constraint = self
            .card
            .invariants
            .iter()
            .find(|i| i.name.starts_with("constraint_"));
        if let Some(constraint) = constraint {
            return Err(Failure::Failed(format!(
                "the states of model `{}` satisfy constraints (`{}`), and clebsch has no local coordinates of such states yet. Use \
                 a model without constraints, or `clebsch gradient` and `clebsch section`, which work here",
                self.card.kebab, constraint.name
            )));
        }
        let steps = Steps::new(self.open()?);
        // States of some models do not have coordinates.
        let seen = steps
            .start()
            .and_then(|at| steps.with(|own| own.observed(&at)));
        seen.map_err(|why| self.refused(&why))?;
        Ok(steps)
    }

    /// The message for a derivative that does not exist.
    pub fn refused(&self, why: &NoDerivative) -> Failure {
        Failure::Failed(format!("model `{}`: {why}", self.card.kebab))
    }

    /// The case at another state, whose initial values are among the observables.
    ///
    /// # Errors
    /// Failed: an initial value is not observed.
    pub fn case_at(
        &self,
        case: &Case,
        flow: &mut dyn Derivatives,
        at: &Point,
    ) -> Result<Case, NoDerivative> {
        let seen = flow.observe(at)?;
        let mut found = case.clone();
        for (field, values) in self.card.initial.iter().zip(&mut found.initial) {
            let unseen = NoDerivative::Unseen { field: field.name };
            let mut first = 0;
            let mut own = None;
            for observable in self.card.observables {
                let count = observable.count();
                if observable.name == field.name && count == field.count() {
                    own = seen.get(first..first + count);
                }
                first += count;
            }
            *values = own.ok_or(unseen)?.to_vec();
        }
        Ok(found)
    }

    /// The JSON object of a command with its results.
    pub fn object(&self, results: Value) -> Value {
        json!({
            "version": env!("CARGO_PKG_VERSION"),
            "model": self.card.kebab,
            "fingerprint": format!("{:016x}", self.card.fingerprint),
            "case": self.plan.case.name,
            "h": self.plan.case.h,
            "order": self.plan.order.unwrap_or(self.card.order),
            "arguments": self.plan.arguments,
            "results": results,
        })
    }

    /// Model and case, for titles.
    pub fn title(&self) -> String {
        format!("{}, case {}", self.card.kebab, shown(&self.plan.case.name))
    }

    /// The steps of the case as a number of the algorithms.
    pub fn count(&self) -> usize {
        usize::try_from(self.plan.case.steps).unwrap_or(usize::MAX)
    }
}

/// The card of a compiled model, read from its text.
fn from_text(compiled: &Card, plan: &Plan, gallery: &Gallery) -> Result<Card, Failure> {
    let no = |why: &dyn std::fmt::Display| {
        Failure::Failed(format!(
            "the text of model `{}`, which derivatives need, cannot be used: {why}",
            compiled.kebab
        ))
    };
    if let Some(choice) = &plan.choice {
        let read = gallery.cache.card_on_lattice(compiled.source, choice);
        return read.map(|(card, _)| card).map_err(|why| no(&why));
    }
    let read = gallery.cache.card(compiled.source);
    let (card, _) = read.map_err(|why| no(&why))?;
    let sizes: Vec<usize> = compiled.dimensions.iter().map(|d| d.value).collect();
    let same = card
        .dimensions
        .iter()
        .map(|d| d.value)
        .eq(sizes.iter().copied());
    match same {
        true => Ok(card),
        false => (card.sized)(&sizes)
            .ok_or_else(|| no(&"it does not admit the size of the case. Choose another case")),
    }
}
