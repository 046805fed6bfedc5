//! The verdict on a run: which steps are judged, and the result. Takes judgements of steps; gives one verdict, as a
//! sentence and as numbers.

use crate::judge::{Judged, Part};
use crate::sites::mixed;
use std::collections::BTreeSet;
use std::fmt;

/// The number of judged steps of a long run, in addition to the last step.
const SAMPLE: usize = 100;

/// If at least this many equations hold exactly whatever the state, the check has measured nothing. One or two may hold
/// exactly by chance.
const ENOUGH: u64 = 8;

/// A residual below this fraction of one rounding of its terms cannot result from rounding.
pub(crate) const FAR_BELOW: f64 = 1e-3;

/// The selection of judged steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepSelection {
    /// A hundred at random, and the last.
    Sample,
    /// Every step.
    All,
    /// None.
    None,
}

/// The judged steps, by number: step n ends at node n. They depend only on the number of steps, so a resumed run
/// judges the same steps.
#[derive(Clone, Debug)]
pub struct Chosen {
    which: StepSelection,
    steps: BTreeSet<u64>,
}

impl Chosen {
    /// Chooses from a run with `total` steps.
    #[must_use]
    pub fn new(which: StepSelection, total: u64) -> Self {
        let mut steps = BTreeSet::new();
        if which == StepSelection::Sample && total > 0 {
            if total <= SAMPLE as u64 + 1 {
                steps.extend(1..=total);
            } else {
                let mut draws = (0..).map(|i| 1 + mixed(i) % (total - 1));
                while steps.len() < SAMPLE {
                    steps.extend(draws.next());
                }
                steps.insert(total);
            }
        }
        Self { which, steps }
    }

    /// Whether this step is judged.
    #[must_use]
    pub fn contains(&self, step: u64) -> bool {
        match self.which {
            StepSelection::All => true,
            StepSelection::None => false,
            StepSelection::Sample => self.steps.contains(&step),
        }
    }
}

/// The result of the judged steps.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// How many steps were judged.
    pub judged: u64,
    /// The worst equation, and the node at the end of its step.
    pub worst: Option<(u64, Part)>,
    /// The number of equations that tested anything. Steps whose arithmetic is exact do not count, if the check detects a
    /// change of their state.
    pub tested: u64,
    /// The largest residual of the tested equations, in roundings of its own terms.
    pub roundings: f64,
    /// Why steps were not judged, if they were not.
    pub not_judged: Option<String>,
}

impl Verdict {
    /// Adds the judgement of the step that ends at `node`.
    pub fn take(&mut self, node: u64, judged: Result<Judged, String>) {
        match judged {
            Ok(judged) => {
                self.judged += 1;
                self.tested += judged.tested;
                self.roundings = match judged.roundings.is_nan() {
                    true => f64::INFINITY,
                    false => self.roundings.max(judged.roundings),
                };
                let ratio = |w: &Option<(u64, Part)>| w.as_ref().map(|(_, part)| part.ratio());
                let worst = judged.worst.map(|part| (node, part));
                let better = match (ratio(&self.worst), ratio(&worst)) {
                    (_, None) => false,
                    (None, _) => true,
                    (Some(old), Some(new)) => !old.is_nan() && (new.is_nan() || new > old),
                };
                if better {
                    self.worst = worst;
                }
            }
            Err(why) => self.not_judged = Some(why),
        }
    }

    /// The largest residual in units of its bound.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        self.worst.as_ref().map_or(0.0, |(_, part)| part.ratio())
    }

    /// Whether a residual is larger than rounding explains.
    #[must_use]
    pub fn is_broken(&self) -> bool {
        let ratio = self.ratio();
        ratio > 1.0 || ratio.is_nan()
    }

    /// Whether all residuals are far below the rounding of their terms, although the check does not detect a change of the
    /// state. It has then measured nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.tested >= ENOUGH && self.roundings < FAR_BELOW
    }

    /// Whether the run passes.
    #[must_use]
    pub fn holds(&self) -> bool {
        !self.is_broken() && !self.is_empty()
    }

    /// The verdict as numbers, from which [`Verdict::of_numbers`] restores it.
    #[must_use]
    #[allow(clippy::cast_precision_loss)]
    pub fn numbers(&self) -> Vec<f64> {
        let mut out = vec![self.judged as f64, self.tested as f64, self.roundings];
        if let Some((node, p)) = &self.worst {
            let site = p.site.map_or(-1.0, |s| s as f64);
            out.extend([*node as f64, p.residual, p.bound, p.terms, site]);
            out.extend([p.component as f64, p.node as f64]);
            out.extend(p.what.chars().map(|c| f64::from(u32::from(c))));
        }
        out
    }

    /// A verdict from the numbers in which it was saved; an empty verdict if the numbers are invalid.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub fn of_numbers(numbers: &[f64]) -> Self {
        let [judged, tested, roundings, rest @ ..] = numbers else {
            return Self::default();
        };
        let worst = match rest {
            [
                node,
                residual,
                bound,
                terms,
                site,
                component,
                end,
                what @ ..,
            ] => {
                let part = Part {
                    what: what
                        .iter()
                        .filter_map(|c| char::from_u32(*c as u32))
                        .collect(),
                    site: (*site >= 0.0).then_some(*site as usize),
                    component: *component as usize,
                    node: *end as usize,
                    residual: *residual,
                    bound: *bound,
                    terms: *terms,
                };
                Some((*node as u64, part))
            }
            _ => None,
        };
        Self {
            judged: *judged as u64,
            tested: *tested as u64,
            roundings: *roundings,
            worst,
            not_judged: None,
        }
    }
}

/// A sentence for the summary of a run.
impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "action as stated: ")?;
        if let Some(why) = self.not_judged.as_ref().filter(|_| !self.is_broken()) {
            return write!(f, "not checked: {why}");
        }
        let Some((node, part)) = &self.worst else {
            return write!(f, "no step checked");
        };
        let steps = if self.judged == 1 { "step" } else { "steps" };
        let ratio = self.ratio();
        write!(
            f,
            "{} {steps} checked, largest residual {} of its rounding bound, at node {node}",
            self.judged,
            short(ratio)
        )?;
        if self.is_broken() {
            let site = part
                .site
                .map_or_else(String::new, |s| format!(" at site {s}"));
            let end = if part.node == 0 { "start" } else { "end" };
            return write!(
                f,
                ". It does NOT hold: {}{site}, component {}, at the {end} of that step has an error of {:.3e}; its rounding \
                 bound is {:.3e}",
                part.what, part.component, part.residual, part.bound
            );
        }
        if self.is_empty() {
            return write!(
                f,
                ". FAILURE OF THE CHECK: {} equations hold exactly, and they also hold if the state changes, so the check has \
                 measured nothing",
                self.tested
            );
        }
        Ok(())
    }
}

fn short(x: f64) -> String {
    match x {
        0.0 => "0".to_owned(),
        x if (0.01..1000.0).contains(&x) => format!("{x:.2}"),
        x => format!("{x:.1e}"),
    }
}
