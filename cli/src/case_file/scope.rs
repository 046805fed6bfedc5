//! The numbers that expressions of a case can use: its step size `h`, and its parameters with a single value. Takes
//! the tables of a case; gives the values of names, which may be defined in any order.

use super::names::{Nameless, Names};
use super::value::number;
use clebsch_core::lattice::value::SiteData;
use std::collections::{BTreeMap, HashMap};
use toml::de::{DeTable, DeValue};

/// The largest number of names in a message.
const LISTED: usize = 12;

/// The numbers of a case by name.
#[derive(Clone, Debug, Default)]
pub(super) struct Scope {
    known: HashMap<String, f64>,
    /// Expressions without a value, by name: they depend on a site, are circular, or are wrong.
    open: BTreeMap<String, String>,
    /// Names with a value.
    names: Vec<String>,
}

impl Names for Scope {
    fn number(&self, name: &str) -> Option<f64> {
        self.known.get(name).copied()
    }
}

impl Scope {
    /// The scope of a case.
    pub(super) fn of(top: &DeTable<'_>) -> Self {
        let step = top.get("h").map(|v| ("h".to_owned(), v.get_ref()));
        let parameters = top.get("parameters").and_then(|t| t.get_ref().as_table());
        let stated = parameters.into_iter().flatten();
        let stated = stated.map(|(k, v)| (k.get_ref().to_string(), v.get_ref()));
        let mut out = Self::default();
        let mut rest: Vec<(String, SiteData)> = Vec::new();
        for (key, value) in step.into_iter().chain(stated) {
            match value {
                DeValue::String(text) => {
                    out.open.insert(key.clone(), text.to_string());
                    rest.extend(SiteData::read(text).ok().map(|data| (key, data)));
                }
                plain => {
                    if let Ok(x) = number(plain, &Nameless) {
                        out.names.push(key.clone());
                        out.known.insert(key, x);
                    }
                }
            }
        }
        // Repeat until no further value is found. The remaining expressions depend on a site and are read
        // there.
        loop {
            let before = rest.len();
            rest.retain(|(key, data)| {
                let value = data.value(&|name| out.number(name)).ok();
                let Some(x) = value.filter(|x| x.is_finite()) else {
                    return true;
                };
                out.names.push(key.clone());
                out.known.insert(key.clone(), x);
                out.open.remove(key);
                false
            });
            if rest.len() == before {
                return out;
            }
        }
    }

    /// The error of an expression, followed by the help that its unknown name calls for.
    pub(super) fn explained(&self, why: String) -> String {
        let Some(name) = missing(&why) else {
            return why;
        };
        if let Some(help) = clebsch_core::lattice::value::instead_of(name) {
            return format!("{why}; {help}");
        }
        let (mut chain, mut at) = (Vec::new(), name.to_owned());
        while let Some(text) = self.open.get(&at) {
            chain.push(format!("{at} = \"{text}\""));
            let names = SiteData::read(text).map(|data| data.names());
            let next = names
                .into_iter()
                .flatten()
                .find(|n| self.number(n).is_none());
            let Some(next) = next else {
                return format!("{why}: {} is not a finite number", chain.join(", "));
            };
            if chain
                .iter()
                .any(|link| link.starts_with(&format!("{next} = ")))
            {
                return format!("{why}: {} are circular definitions", chain.join(", "));
            }
            at = next;
        }
        let why = match chain.is_empty() {
            true => why,
            false => format!("{why}: {}, and `{at}` has no value", chain.join(", ")),
        };
        let mut names: Vec<&str> = self.names.iter().map(String::as_str).collect();
        names.sort_unstable();
        names.truncate(LISTED);
        match names.is_empty() {
            true => format!("{why}; an expression may contain numbers, functions and `pi`"),
            false => format!(
                "{why}; an expression may contain the step and parameters that are single numbers: {}",
                names.join(", ")
            ),
        }
    }

    /// A number, or an expression that has one.
    pub(super) fn read(&self, value: &DeValue<'_>) -> Result<f64, String> {
        number(value, self).map_err(|why| self.explained(why))
    }

    /// An integer, or an expression that is an integer up to rounding.
    pub(super) fn whole(&self, value: &DeValue<'_>) -> Result<Option<u64>, String> {
        match value {
            DeValue::Integer(n) => Ok(u64::from_str_radix(n.as_str(), n.radix()).ok()),
            DeValue::String(_) => self.read(value).map(rounded),
            _ => Ok(None),
        }
    }
}

/// The name without a value in a message.
fn missing(why: &str) -> Option<&str> {
    let before = why.strip_suffix("` has no value here")?;
    before.rsplit('`').next()
}

/// The integer nearest to `x`, if they agree up to the rounding of an expression.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
pub(super) fn rounded(x: f64) -> Option<u64> {
    const ROUNDING: f64 = 1e-9;
    const MOST: f64 = 9_007_199_254_740_992.0;
    let whole = x.round();
    let is_whole = (x - whole).abs() <= ROUNDING * whole.abs();
    (is_whole && (0.0..MOST).contains(&whole)).then_some(whole as u64)
}

#[cfg(test)]
mod tests {
    use super::{Names as _, Scope, rounded};
    use toml::de::DeTable;

    #[test]
    fn parameters_are_found_in_any_order_and_circles_are_told() {
        let text = "h = \"T/100\"\n[parameters]\na = \"2*b\"\nb = \"c + h\"\nc = 1\nT = 1.0\nx = \"y\"\ny = \"x\"\nq = [1, 2]\n";
        let document = DeTable::parse(text).expect("it is TOML");
        let scope = Scope::of(document.get_ref());
        assert_eq!(scope.number("h"), Some(0.01));
        assert_eq!(scope.number("a"), Some(2.02));
        assert_eq!(scope.number("x"), None);
        assert_eq!(scope.number("q"), None);
        let why = scope.explained("\"x + 1\": `x` has no value here".to_owned());
        assert!(why.contains("are circular"), "{why}");
        let why = scope.explained("\"z\": `z` has no value here".to_owned());
        assert!(why.contains("T, a, b, c, h"), "{why}");
        let text = "[parameters]\na = \"b\"\nb = \"n\"\nc = \"1/0\"\n";
        let document = DeTable::parse(text).expect("it is TOML");
        let scope = Scope::of(document.get_ref());
        let told = |name: &str| scope.explained(format!("\"{name}\": `{name}` has no value here"));
        let why = told("a");
        assert!(
            why.contains("a = \"b\", b = \"n\", and `n` has no value"),
            "{why}"
        );
        let why = told("c");
        assert!(why.contains("c = \"1/0\" is not a finite number"), "{why}");
    }

    #[test]
    fn what_is_whole_but_for_rounding_is_whole() {
        assert_eq!(rounded(0.3 / 0.1), Some(3));
        assert_eq!([rounded(2.5), rounded(-1.0), rounded(1e17)], [None; 3]);
    }
}
