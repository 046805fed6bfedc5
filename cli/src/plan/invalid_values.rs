//! Reports an invalid value that a model computes from parameters, by naming these parameters with their sites,
//! lines and values. Takes the formula of the value; gives the beginning of a message.

use crate::case_file::stated::Stated;
use crate::case_file::{at_site, line_of, quantity_of};
use crate::models::gallery::Case;
use crate::words::number;
use crate::words::plain::shown;
use clebsch::card::{Card, Field};
use clebsch_core::expr::symbol::ascii;
use std::collections::BTreeMap;
use toml::de::{DeTable, DeValue};

/// The largest number of characters of a printed value.
const LETTERS: usize = 60;

/// The file of a case, and the lines of its keys.
pub(crate) type Origin = (String, BTreeMap<String, usize>);

/// `rod.toml:16: parameters.s = 0.1 and parameters.A = 0 at i = 5 (given by `1 - 0.2*i`) make s A₅`; `None` if
/// the formula contains no parameters of the card.
pub(crate) fn parameter_report(
    card: &Card,
    case: &Case,
    origin: Option<&Origin>,
    formula: &str,
) -> Option<String> {
    let names: Vec<String> = words(formula).collect();
    let stated = Stated::read(card.source);
    let text = origin.and_then(|(file, _)| std::fs::read_to_string(file).ok());
    let own = card.parameters.iter().zip(&case.parameters);
    let own = own.filter(|(field, _)| names.contains(&field.ascii.replace('_', "")));
    let mut told = Vec::new();
    let mut lines = Vec::new();
    for (field, numbers) in own {
        let site = site_of(stated.as_ref(), field);
        let key = match site {
            Some(_) => quantity_of(field.ascii).unwrap_or(field.ascii),
            None => field.ascii,
        };
        let expressions = text
            .as_deref()
            .and_then(|text| expressions(text, [key, field.name, field.ascii]))
            .unwrap_or_default();
        let value = short(&plainly(field, numbers));
        let at = site.map_or_else(String::new, |(index, site)| format!(" at {index} = {site}"));
        let by = match expressions.is_empty() {
            true => String::new(),
            false => format!(" (given by {})", short(&expressions.join(", "))),
        };
        told.push(format!("parameters.{key} = {value}{at}{by}"));
        let line =
            origin.and_then(|(_, lines)| line_of(lines, &format!("parameters.{}", field.ascii)));
        let negative = numbers.len() == 1 && numbers.iter().any(|x| *x <= 0.0);
        lines.push((!negative, expressions.is_empty(), line));
    }
    let verb = if told.len() == 1 { "makes" } else { "make" };
    let last = told.pop()?;
    let list = match told.is_empty() {
        true => last,
        false => format!("{} and {last}", told.join(", ")),
    };
    // The line of a number that is not positive, else of an expression, else of the first parameter.
    let line = lines
        .into_iter()
        .min_by_key(|(number, expression, _)| (*number, *expression));
    let line = line.and_then(|(_, _, line)| line);
    let place = match (origin, line) {
        (Some((file, _)), Some(line)) => format!("{}:{line}", shown(file)),
        (Some((file, _)), None) => shown(file).to_string(),
        (None, _) => format!("case `{}`", shown(&case.name)),
    };
    Some(format!("{place}: {list} {verb} {formula}"))
}

/// The names in a formula in ASCII, with digits for subscripts: `J5` for `J₅`. `A1` and `J_5` are printed in
/// the same way.
fn words(formula: &str) -> impl Iterator<Item = String> {
    let words = formula.split(|c: char| !c.is_alphanumeric());
    words.filter(|word| !word.is_empty()).map(|word| {
        let plain = |letter: char| match u32::from(letter) {
            code @ 0x2080..=0x2089 => char::from_digit(code - 0x2080, 10).unwrap_or(letter),
            _ => letter,
        };
        ascii(&word.chars().map(plain).collect::<String>())
    })
}

/// The label and the number of the site, if the field is a value at a site.
fn site_of(stated: Option<&Stated>, field: &Field) -> Option<(String, usize)> {
    let lattice = &stated?.lattice;
    let (quantity, site) = at_site(field.ascii)?;
    let own = lattice.quantities.iter();
    let own = own.clone().find(|q| ascii(&q.name.text) == quantity)?;
    let index = lattice.labels.get(own.label)?.index.text.clone();
    Some((index, site))
}

/// The distinct expressions in the value of a parameter in a file. The file gives the parameter under one of
/// these names.
fn expressions(text: &str, names: [&str; 3]) -> Option<Vec<String>> {
    let table = DeTable::parse(text).ok()?;
    let parameters = table.get_ref().get("parameters")?.get_ref().as_table()?;
    let value = names.iter().find_map(|name| parameters.get(*name))?;
    let mut all = Vec::new();
    collect(value.get_ref(), &mut all);
    Some(all)
}

fn collect(value: &DeValue<'_>, all: &mut Vec<String>) {
    match value {
        DeValue::String(text) => {
            let own = format!("`{text}`");
            if !all.contains(&own) {
                all.push(own);
            }
        }
        DeValue::Array(list) => list.iter().for_each(|own| collect(own.get_ref(), all)),
        _ => {}
    }
}

/// The numbers of a field, of a matrix by its rows.
fn plainly(field: &Field, numbers: &[f64]) -> String {
    let list = |numbers: &[f64]| {
        let all: Vec<String> = numbers.iter().map(|x| number::short(*x)).collect();
        format!("[{}]", all.join(", "))
    };
    match numbers {
        [one] => number::short(*one),
        all if field.cols > 1 => {
            let rows: Vec<String> = all.chunks(field.cols).map(list).collect();
            format!("[{}]", rows.join(", "))
        }
        all => list(all),
    }
}

/// A value shortened for a sentence.
fn short(value: &str) -> String {
    match value.chars().count() {
        ..=LETTERS => value.to_owned(),
        _ => value.chars().take(LETTERS).chain(" ...".chars()).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::{short, words};

    #[test]
    fn names_of_a_formula_are_those_of_its_parameters() {
        let of = |formula: &str| words(formula).collect::<Vec<String>>();
        assert_eq!(of("s J₁₅"), ["s", "J15"]);
        assert_eq!(
            of("s A₃ Id - (β·b) E₃"),
            ["s", "A3", "Id", "beta", "b", "E3"]
        );
        assert_eq!(short(&"1".repeat(70)).len(), 64);
    }
}
