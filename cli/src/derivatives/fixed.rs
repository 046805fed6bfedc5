//! The quantities that are held fixed in a search for equilibria. Takes the option `--fix` and the start; gives
//! components of invariants, and initial values.

use crate::derivatives::coordinates::{self, turns};
use crate::derivatives::problem::Problem;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use crate::words::suggestion::did_you_mean;
use clebsch::card::{Card, Conserved};

/// A fixed quantity.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fixed {
    /// Its name.
    pub name: String,
    /// Where it is.
    pub place: Place,
}

/// Where a fixed quantity is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// A component of the invariants.
    Invariant(usize),
    /// A local coordinate that is an entry of an initial value.
    Coordinate(usize),
}

/// A value counts as zero below this part of the largest one.
const ZERO: f64 = 1e-12;

/// The component of the invariants that is the energy.
pub(crate) fn energy(card: &Card) -> Option<usize> {
    components(card).position(|(name, _, _)| name == "energy")
}

/// Each component of the invariants: the name of the invariant, its component, and whether it is conserved exactly.
fn components(card: &Card) -> impl Iterator<Item = (&'static str, String, bool)> {
    card.invariants.iter().flat_map(|own| {
        (1..=own.rows).map(|i| {
            let name = match own.rows {
                1 => own.name.to_owned(),
                _ => format!("{}.{i}", own.name),
            };
            (own.name, name, own.conserved == Conserved::Exactly)
        })
    })
}

/// Whether an invariant is a constraint of the model, which defines its states.
fn is_constraint(name: &str) -> bool {
    name.starts_with("constraint_")
}

/// The quantities that `--fix` names. `values` are the invariants at the start.
///
/// # Errors
/// Usage: a name is not known.
pub(crate) fn fixed(
    problem: &Problem,
    option: Option<&str>,
    values: &[f64],
    dimensions: &[usize],
) -> Result<Vec<Fixed>, Failure> {
    let card = &problem.card;
    let all: Vec<(&str, String, bool)> = components(card).collect();
    let choose = |is: &dyn Fn(usize, &str, bool) -> bool| -> Vec<Fixed> {
        let own = all.iter().enumerate();
        let own = own.filter(|(i, (name, _, exact))| is(*i, name, *exact) && *name != "energy");
        let fixed = own.map(|(i, (_, name, _))| Fixed {
            name: name.clone(),
            place: Place::Invariant(i),
        });
        fixed.collect()
    };
    let largest = clebsch::scalar::largest(values.iter().map(|x| x.abs()));
    let is_zero = |i: usize| {
        values
            .get(i)
            .is_none_or(|x| x.abs() <= ZERO * largest.max(1.0))
    };
    let Some(option) = option else {
        return Ok(choose(&|i, name, exact| {
            exact && (is_constraint(name) || !is_zero(i))
        }));
    };
    match option.trim() {
        "none" => return Ok(choose(&|_, name, _| is_constraint(name))),
        "all" => return Ok(choose(&|_, _, exact| exact)),
        _ => {}
    }
    let mut found = choose(&|_, name, _| is_constraint(name));
    let locals = coordinates::local(card, dimensions);
    let moves = card.initial.iter().zip(dimensions);
    let plain: Vec<bool> = moves
        .flat_map(|(field, count)| std::iter::repeat_n(!turns(field), *count))
        .collect();
    for name in option.split(',').map(str::trim) {
        let own = choose(&|i, whole, _| {
            whole == name || all.get(i).is_some_and(|(_, own, _)| own == name)
        });
        let coordinate = locals.iter().position(|own| own == name);
        let coordinate = coordinate.filter(|at| plain.get(*at) == Some(&true));
        match (own.is_empty(), coordinate) {
            (false, _) => found.extend(own.into_iter().filter(|f| !is_constraint(&f.name))),
            (true, Some(at)) => found.push(Fixed {
                name: name.to_owned(),
                place: Place::Coordinate(at),
            }),
            (true, None) => {
                let names = card.invariants.iter().map(|own| own.name);
                let names = names.filter(|name| *name != "energy");
                let plain = locals.iter().zip(&plain).filter(|(_, plain)| **plain);
                let names = names.chain(plain.map(|(name, _)| name.as_str()));
                return Err(Failure::Usage(format!(
                    "--fix {}: there is no such invariant or initial value{}",
                    shown(name),
                    did_you_mean(name, names.chain(["none", "all"]))
                )));
            }
        }
    }
    Ok(found)
}
