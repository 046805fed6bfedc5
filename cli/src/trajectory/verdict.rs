//! The conservation of invariants in a run: the drift of each against the bound of the case.
//! Takes the drifts of all components; gives one outcome per invariant and the table to print.

use crate::case_file::DEFAULT_BOUND;
use crate::models::gallery::Case;
use crate::words::number::{plain, short};
use crate::words::width::paragraph;
use clebsch::card::{Card, Conserved, Invariant};
use clebsch::integrate::Drift;
use clebsch::scalar::larger;
use serde_json::{Value, json};

/// The outcome of an invariant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Within its bound at every checked node.
    Kept,
    /// Beyond its bound (or not a number) at some node.
    Left,
    /// No bound is set: the drift is reported, not judged.
    Bounded,
}

impl Verdict {
    /// The word that is printed and written to files.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Kept => "within bound",
            Self::Left => "EXCEEDED",
            Self::Bounded => "no bound",
        }
    }
}

/// The outcome of one invariant, its components taken together.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The invariant.
    pub invariant: &'static Invariant,
    /// Drift of each component.
    pub components: Vec<Drift>,
    /// Largest natural scale of a component, see [`Drift`].
    pub scale: f64,
    /// Largest drift of a component at any node that was looked at, relative to its scale or absolute without one.
    pub worst: f64,
    /// Drift at the last node of the component that changed most, with its sign, in the same units as `worst`.
    pub last: f64,
    /// Bound on the drift, if there is one.
    pub bound: Option<f64>,
    /// Whether the drift is within the bound.
    pub verdict: Verdict,
    /// The parameters that are zero in this case and make every term of the formula zero at every node. An example is
    /// the momentum about a vertical given as a zero vector. The invariant then tests nothing. Empty otherwise.
    pub zero_by: Vec<&'static str>,
}

/// Judges the drifts of all components, in the order of the card.
#[must_use]
pub fn judge(card: &Card, case: &Case, drifts: &[Drift]) -> Vec<Outcome> {
    let mut drifts = drifts.iter();
    let one = |invariant: &'static Invariant| {
        let components: Vec<Drift> = drifts.by_ref().take(invariant.rows).copied().collect();
        let worst = components.iter().map(|drift| drift.worst).fold(0.0, larger);
        let bound = bound(case, invariant);
        let zero = |drift: &Drift| drift.scale == 0.0 && drift.worst == 0.0;
        let zero_by = match components.iter().all(zero) {
            true => zero_parameters(card, case, invariant.formula),
            false => Vec::new(),
        };
        Outcome {
            invariant,
            scale: components.iter().map(|drift| drift.scale).fold(0.0, larger),
            worst,
            last: components.iter().map(|drift| drift.last).fold(0.0, farther),
            bound,
            // A drift that is not a number is not within any bound.
            verdict: match bound {
                Some(bound) if worst <= bound => Verdict::Kept,
                None if worst.is_finite() => Verdict::Bounded,
                _ => Verdict::Left,
            },
            zero_by,
            components,
        }
    };
    card.invariants.iter().map(one).collect()
}

/// The parameters in the formula that are zero.
fn zero_parameters(card: &Card, case: &Case, formula: &str) -> Vec<&'static str> {
    let words: Vec<&str> = formula.split(|c: char| !c.is_alphanumeric()).collect();
    let all = card.parameters.iter().zip(&case.parameters);
    let own = all.filter(|(field, numbers)| {
        words.contains(&field.name) && numbers.iter().all(|number| *number == 0.0)
    });
    own.map(|(field, _)| field.name).collect()
}

/// The number farther from zero; NaN wins.
fn farther(a: f64, b: f64) -> f64 {
    let most = larger(a.abs(), b.abs());
    if most.is_nan() {
        most
    } else if b.abs() == most && a.abs() < most {
        b
    } else {
        a
    }
}

fn bound(case: &Case, invariant: &Invariant) -> Option<f64> {
    let stated = case.bounds.iter().find(|(name, _)| name == invariant.name);
    match (stated, invariant.conserved) {
        (Some((_, bound)), _) => Some(*bound),
        (None, Conserved::Exactly) => Some(DEFAULT_BOUND),
        (None, Conserved::Boundedly) => None,
    }
}

impl Outcome {
    /// The outcome for files.
    #[must_use]
    pub fn json(&self) -> Value {
        let parts: fn(&Drift) -> Value = |drift| json!({"scale": drift.scale, "absolute": drift.is_absolute(), "worst": drift.worst, "last": drift.last});
        json!({
            "name": self.invariant.name,
            "formula": self.invariant.formula,
            "conserved": match self.invariant.conserved {
                Conserved::Exactly => "exactly",
                Conserved::Boundedly => "boundedly",
            },
            "scale": self.scale,
            "absolute": self.components.iter().any(Drift::is_absolute),
            "worst_drift": self.worst,
            "last_drift": self.last,
            "lost_at": self.components.iter().filter_map(|drift| drift.lost).min(),
            "bound": self.bound,
            "zero_by": self.zero_by,
            "verdict": match self.verdict {
                Verdict::Kept => "kept",
                Verdict::Left => "left",
                Verdict::Bounded => "bounded",
            },
            "components": self.components.iter().map(parts).collect::<Vec<_>>(),
        })
    }

    /// The word for its verdict, or `zero` if the invariant is zero for every motion.
    #[must_use]
    pub const fn word(&self) -> &'static str {
        match self.zero_by.is_empty() {
            true => self.verdict.word(),
            false => "zero",
        }
    }

    /// The name, if drift and bound are absolute. If only some components have zero scale, their numbers
    /// follow.
    fn absolute(&self) -> Option<String> {
        if !self.zero_by.is_empty() {
            return None;
        }
        let name = self.invariant.name;
        let components = self.components.iter().enumerate();
        let without: Vec<String> = components
            .filter(|(_, drift)| drift.is_absolute())
            .map(|(index, _)| (index + 1).to_string())
            .collect();
        match without.len() {
            0 => None,
            all if all == self.components.len() => Some(name.to_owned()),
            _ => Some(format!("{name} (components {})", without.join(", "))),
        }
    }

    fn cells(&self) -> Vec<String> {
        vec![
            self.invariant.name.to_owned(),
            number(self.scale),
            number(self.worst),
            number(self.last),
            self.bound
                .map_or_else(|| "-".to_owned(), |bound| format!("{bound:e}")),
            self.word().to_owned(),
            shortened(self.invariant.formula),
        ]
    }
}

/// A number with four digits, without an exponent if it is of moderate size.
fn number(x: f64) -> String {
    match x.abs() {
        size if size == 0.0 || (1e-3..1e5).contains(&size) => short(x),
        _ => format!("{x:.3e}"),
    }
}

/// The longest formula that a table prints in full. The derivation prints all formulas in full.
const LONGEST: usize = 240;

/// A formula for a table, shortened if it is too long.
fn shortened(formula: &str) -> String {
    if formula.chars().count() <= LONGEST {
        return formula.to_owned();
    }
    let start: String = formula.chars().take(LONGEST).collect();
    let whole_words = start
        .rsplit_once(' ')
        .map_or(start.as_str(), |(words, _)| words);
    format!("{whole_words} ...: see `clebsch derive`")
}

/// Sentences on invariants without a bound that changed by more than their terms at the start.
#[must_use]
pub fn lost(outcomes: &[Outcome], h: f64) -> Vec<String> {
    let free = outcomes.iter().filter(|o| o.verdict == Verdict::Bounded);
    let each = free.filter_map(|outcome| {
        let node = outcome.components.iter().filter_map(|drift| drift.lost).min()?;
        #[allow(clippy::cast_precision_loss)]
        let time = plain(node as f64 * h);
        Some(format!(
            "the {} is not conserved from node {node} (time {time}) on: it changed by more than the size of its initial terms. \
                The step is too large for this motion; reduce h",
            outcome.invariant.name
        ))
    });
    each.collect()
}

/// Sentences about invariants that are zero for every motion of this case, one sentence for each list of zero
/// parameters.
#[must_use]
pub fn zeros(outcomes: &[Outcome]) -> Vec<String> {
    let mut all: Vec<(&[&str], Vec<&str>)> = Vec::new();
    for outcome in outcomes.iter().filter(|o| !o.zero_by.is_empty()) {
        let by = outcome.zero_by.as_slice();
        match all.iter_mut().find(|(known, _)| *known == by) {
            Some((_, names)) => names.push(outcome.invariant.name),
            None => all.push((by, vec![outcome.invariant.name])),
        }
    }
    let sentence = |(by, names): (&[&str], Vec<&str>)| {
        let by: Vec<String> = by.iter().map(|name| format!("{name} = 0")).collect();
        let names = names.join(", ");
        format!(
            "zero because {}, so these invariants are not tested: {names}",
            by.join(", ")
        )
    };
    all.into_iter().map(sentence).collect()
}

/// The table of all outcomes, and a line about outcomes that are measured absolutely. Drifts are relative to the
/// natural scale if it is not zero.
#[must_use]
pub fn table(outcomes: &[Outcome], width: Option<usize>) -> String {
    let head = [
        "invariant",
        "scale",
        "max drift",
        "final drift",
        "bound",
        "verdict",
        // The last column: on a narrow terminal it is wrapped below, and the verdict stays next to the numbers.
        "formula",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(outcomes.iter().map(Outcome::cells));
    let mut text = crate::words::columns::aligned(&rows, &[1, 2, 3, 4], width);
    let absolute: Vec<String> = outcomes.iter().filter_map(Outcome::absolute).collect();
    if !absolute.is_empty() {
        let said = format!(
            "absolute, because the scale is zero: {}",
            absolute.join(", ")
        );
        text.push('\n');
        text.push_str(&paragraph(&said, width, 2));
    }
    for said in zeros(outcomes) {
        text.push('\n');
        text.push_str(&paragraph(&said, width, 2));
    }
    text
}
