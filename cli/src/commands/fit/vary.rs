//! The quantities that a fit varies. Takes names such as `k` or `initial:momentum`; gives places of a case.

use crate::derivatives::coordinates::local;
use crate::derivatives::problem::Problem;
use crate::overrides::quantity::Quantity;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use crate::words::suggestion::did_you_mean;

/// The varied quantities.
pub(super) enum Vary {
    /// A number of a parameter: fields and entries, each with a sign.
    Parameter {
        name: String,
        places: Vec<(usize, usize, f64)>,
    },
    /// An initial value: its field, and its local coordinates.
    Initial {
        field: usize,
        first: usize,
        names: Vec<String>,
    },
}

impl Vary {
    /// Reads `NAME` or `initial:NAME`.
    ///
    /// # Errors
    /// Usage: the name is not known.
    pub fn read(name: &str, problem: &Problem, dimensions: &[usize]) -> Result<Self, Failure> {
        let card = &problem.card;
        let wrong = |why: String| Failure::Usage(format!("--vary {}: {why}", shown(name)));
        let Some(initial) = name.strip_prefix("initial:") else {
            let quantity = Quantity::read(name, card, &problem.plan.motion).map_err(wrong)?;
            let places = quantity.of_parameter().ok_or_else(|| {
                wrong(format!(
                    "this is no parameter. Write initial:{} for an initial value; h is fixed by the times of the data",
                    shown(name)
                ))
            })?;
            return Ok(Vary::Parameter {
                name: name.to_owned(),
                places,
            });
        };
        let field = card
            .initial
            .iter()
            .position(|f| f.name == initial || f.ascii == initial);
        let Some(field) = field else {
            let known = card.initial.iter().map(|f| f.ascii);
            return Err(wrong(format!(
                "there is no such initial value{}",
                did_you_mean(initial, known)
            )));
        };
        let first: usize = dimensions.iter().take(field).sum();
        let count = dimensions.get(field).copied().unwrap_or(0);
        let names = local(card, dimensions);
        Ok(Vary::Initial {
            field,
            first,
            names: names.into_iter().skip(first).take(count).collect(),
        })
    }

    /// The names of its coordinates.
    pub fn names(&self) -> Vec<String> {
        match self {
            Vary::Parameter { name, .. } => vec![name.clone()],
            Vary::Initial { names, .. } => names.clone(),
        }
    }
}
