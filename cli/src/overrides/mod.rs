//! Options that replace numbers of a case: `--set`, `--h`, `--steps` and `--until`.
//! Takes the matches of a command and a case; changes the case.

mod brackets;
pub(crate) mod quantity;
pub(crate) mod substitute;

use crate::case_file::Motion;
use crate::models::gallery::Case;
use crate::overrides::quantity::Quantity;
use crate::overrides::substitute::replaces;
use crate::terminal::failure::Failure;
use crate::words::number;
use crate::words::plain::shown;
use clap::ArgMatches;
use clebsch::card::Card;

/// The largest number of steps of a run. Up to this number an f64 is exact.
const MOST_STEPS: f64 = 9_007_199_254_740_992.0;

/// Applies the options to a case, and to the text of the case if it has one. Gives the names that `--set` set.
///
/// # Errors
/// Usage: a quantity that the model does not have, a value that is not a number, or more steps than can be counted.
pub(crate) fn apply(
    case: &mut Case,
    motion: &mut Motion,
    card: &Card,
    text: Option<&str>,
    matches: &ArgMatches,
) -> Result<Vec<String>, Failure> {
    let mut names = Vec::new();
    // Lists, tables and their entries are already in the text of the case.
    let is_read = |set: &&String| match (text, set.split_once('=')) {
        (Some(text), Some((name, value))) => replaces(text, name.trim(), value),
        _ => false,
    };
    for text in set(matches) {
        if is_read(&text) {
            let name = text.split_once('=').map_or("", |(name, _)| name);
            names.push(name.trim().to_owned());
            continue;
        }
        let (name, numbers) = parts(text, case, card)
            .map_err(|why| Failure::Usage(format!("--set {}: {why}", shown(text))))?;
        if let Some(given) = motion.give(&name, card, &numbers) {
            given.map_err(|why| Failure::Usage(format!("--set {}: {why}", shown(text))))?;
            names.push(name);
            continue;
        }
        for (quantity, value) in read(&name, &numbers, card, motion)
            .map_err(|why| Failure::Usage(format!("--set {}: {why}", shown(text))))?
        {
            quantity.put(value, case, motion);
            names.push(quantity.name);
        }
    }
    case.h = matches.get_one::<f64>("h").copied().unwrap_or(case.h);
    case.steps = matches
        .get_one::<u64>("steps")
        .copied()
        .unwrap_or(case.steps);
    if let Some(time) = until(matches) {
        case.steps = steps_to(time, case.h).ok_or_else(|| {
            Failure::Usage(format!(
                "--until {time}: this needs too many steps of {}; give a larger --h",
                case.h
            ))
        })?;
    }
    Ok(names)
}

/// The values of `--set`, as written.
pub(crate) fn set(matches: &ArgMatches) -> impl Iterator<Item = &String> {
    let all = matches.try_get_many::<String>("set").ok().flatten();
    all.into_iter().flatten()
}

/// The values of `--set` and `--h` by name, as written.
///
/// # Errors
/// Usage: a bracket of a value lacks its partner. The values are inserted into the text of the case, which is right.
pub(crate) fn by_name(matches: &ArgMatches) -> Result<Vec<(String, String)>, Failure> {
    let mut all = Vec::new();
    for text in set(matches) {
        let Some((name, value)) = text.split_once('=') else {
            continue;
        };
        if let Some(why) = brackets::fault(value.trim()) {
            return Err(Failure::Usage(format!(
                "--set {}: {}",
                shown(text),
                shown(&why)
            )));
        }
        all.push((name.trim().to_owned(), value.trim().to_owned()));
    }
    let h = matches.try_get_one::<f64>("h").ok().flatten();
    all.extend(h.map(|h| ("h".to_owned(), format!("{h:?}"))));
    Ok(all)
}

/// Whether a value of `--set` is a list, a table, or the inertia of a body. Such a value is read like a value
/// in a case file.
pub(crate) fn needs_a_text(matches: &ArgMatches, card: &Card) -> bool {
    let is_own = |name: &str| {
        let mut all = card.parameters.iter().chain(card.initial);
        all.any(|field| field.ascii == name)
    };
    set(matches)
        .filter_map(|text| text.split_once('='))
        .any(|(name, value)| {
            let is_inertia = name.trim().starts_with('I') && !is_own(name.trim());
            is_inertia || value.trim_start().starts_with(['[', '{'])
        })
}

/// The time that `--until` gives.
pub(crate) fn until(matches: &ArgMatches) -> Option<f64> {
    matches.try_get_one::<f64>("until").ok().flatten().copied()
}

/// The number of steps of `h` that ends nearest to a time, at least one. `None` if it is too large to count.
pub(crate) fn steps_to(time: f64, h: f64) -> Option<u64> {
    let steps = (time / h).abs().round().max(1.0);
    // An integer, positive and exact.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    (steps <= MOST_STEPS).then_some(steps as u64)
}

/// The name and the numbers of `NAME=VALUE` or `NAME=VALUE,VALUE,...`. Expressions may use the step size and
/// the parameters of the case with a single value.
fn parts(text: &str, case: &Case, card: &Card) -> Result<(String, Vec<f64>), String> {
    let Some((name, values)) = text.split_once('=') else {
        return Err("give NAME=VALUE, such as gU.z=0.5".to_owned());
    };
    let known = |name: &str| {
        if name == "h" {
            return Some(case.h);
        }
        let mut all = card.parameters.iter().zip(&case.parameters);
        let (_, own) =
            all.find(|(field, _)| field.count() == 1 && [field.name, field.ascii].contains(&name))?;
        own.first().copied()
    };
    let values = values.trim();
    let inside = values
        .strip_prefix('[')
        .and_then(|rest| rest.strip_suffix(']'));
    let numbers = inside
        .unwrap_or(values)
        .split(',')
        .map(|one| number::value(one, &known));
    Ok((name.trim().to_owned(), numbers.collect::<Result<_, _>>()?))
}

/// The quantities that a name refers to, each with its number: one number, or the components of a vector.
fn read(
    name: &str,
    numbers: &[f64],
    card: &Card,
    motion: &Motion,
) -> Result<Vec<(Quantity, f64)>, String> {
    if let [value] = numbers {
        return Ok(vec![(Quantity::read(name, card, motion)?, *value)]);
    }
    match Quantity::components(name, card, motion) {
        Some(each) if each.len() == numbers.len() => {
            Ok(each.into_iter().zip(numbers.iter().copied()).collect())
        }
        Some(each) => Err(format!(
            "`{}` has {} components, but {} values are given",
            shown(name),
            each.len(),
            numbers.len()
        )),
        // The message lists the names of the model, or the components.
        None => Err(match Quantity::read(name, card, motion) {
            Err(why) => why,
            Ok(_) => format!("`{}` takes one number", shown(name)),
        }),
    }
}
