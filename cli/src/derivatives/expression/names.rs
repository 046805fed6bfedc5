//! The names of observables and invariants in expressions. Takes a card; gives the place of `X[1]`, `X.x`, `X_1`,
//! `q[3]` (site 3) or `energy` among all observed numbers.

use crate::words::suggestion::nearest;
use clebsch::card::Card;
use std::collections::HashMap;

/// The meaning of a name: its place, rows and columns.
#[derive(Clone, Copy, Debug)]
struct Quantity {
    first: usize,
    rows: usize,
    cols: usize,
}

/// All names of a card.
#[derive(Debug)]
pub(super) struct Names {
    fields: HashMap<String, Quantity>,
    /// Names of single numbers, as in CSV files.
    columns: HashMap<String, usize>,
    /// The names for messages.
    listed: Vec<String>,
}

/// The names listed in a message, at most.
const MOST: usize = 24;

impl Names {
    /// The names of a card.
    pub fn of(card: &Card) -> Self {
        let mut fields = HashMap::new();
        let mut listed = Vec::new();
        let mut first = 0;
        let mut add = |names: &[&str], rows: usize, cols: usize| {
            let own = Quantity { first, rows, cols };
            for name in names {
                fields.entry((*name).to_owned()).or_insert(own);
            }
            listed.push(
                names
                    .first()
                    .map_or_else(String::new, |n| example(n, rows, cols)),
            );
            first += rows * cols;
        };
        for field in card.observables {
            add(&[field.ascii, field.name], field.rows, field.cols);
        }
        for invariant in card.invariants {
            let long = clebsch::record::invariant_name(invariant);
            add(&[invariant.name, &long], invariant.rows, 1);
        }
        let columns = clebsch::record::columns(card).into_iter().enumerate();
        Self {
            fields,
            columns: columns.map(|(at, name)| (name, at)).collect(),
            listed,
        }
    }

    /// The place of a name with its components.
    ///
    /// # Errors
    /// What is wrong, and what to do.
    pub fn place(&self, name: &str, components: &[usize]) -> Result<usize, (String, String)> {
        if let Some(own) = self.fields.get(name) {
            return place(name, *own, components);
        }
        if let (Some(at), []) = (self.columns.get(name), components) {
            return Ok(*at);
        }
        if let [site, rest @ ..] = components {
            let copy = format!("{name}_{site}");
            if let Some(own) = self.fields.get(&copy) {
                return place(&copy, *own, rest);
            }
        }
        let known = self.fields.keys().chain(self.columns.keys());
        // The order of a hash map changes between runs.
        let mut known: Vec<&str> = known.map(String::as_str).collect();
        known.sort_unstable();
        let near = nearest(name, known);
        let near = near.map_or_else(String::new, |near| format!("Did you mean `{near}`? "));
        let more = match self.listed.len().saturating_sub(MOST) {
            0 => String::new(),
            more => format!(", and {more} more"),
        };
        let listed: Vec<&str> = self.listed.iter().take(MOST).map(String::as_str).collect();
        Err((
            format!("`{name}` is neither an observable nor an invariant"),
            format!("{near}Available: {}{more}", listed.join(", ")),
        ))
    }
}

/// A name with its components.
fn example(name: &str, rows: usize, cols: usize) -> String {
    match (rows, cols) {
        (1, 1) => name.to_owned(),
        (rows, 1) => format!("{name}[1..{rows}]"),
        (rows, cols) => format!("{name}[1..{rows}, 1..{cols}]"),
    }
}

fn place(name: &str, of: Quantity, components: &[usize]) -> Result<usize, (String, String)> {
    let Quantity { first, rows, cols } = of;
    let inside = |i: usize, most: usize| (1..=most).contains(&i);
    match *components {
        [] if rows * cols == 1 => Ok(first),
        [i] if cols == 1 && inside(i, rows) => Ok(first + i - 1),
        [i, j] if inside(i, rows) && inside(j, cols) => Ok(first + (i - 1) * cols + j - 1),
        _ => {
            let given: Vec<String> = components.iter().map(usize::to_string).collect();
            let what = match given.is_empty() {
                true => format!("`{name}` has {} components", rows * cols),
                false => format!("`{name}` has no component [{}]", given.join(", ")),
            };
            let remedy = match rows * cols {
                1 => format!("Write `{name}` without a component."),
                _ => format!(
                    "Write {}. Components count from 1.",
                    example(name, rows, cols)
                ),
            };
            Err((what, remedy))
        }
    }
}

/// The column of a component: `X_1` of `X.1` and of `X.x`.
pub(super) fn column(name: &str, part: &str) -> String {
    let number = match part {
        "x" => "1",
        "y" => "2",
        "z" => "3",
        other => other,
    };
    format!("{name}_{number}")
}
