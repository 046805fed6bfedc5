//! Values of a case that need no reading: those of the particles and nodes of a fluid, computed from what the case says of all of
//! them. Takes them by table and field; gives them back where the fields of a card are read, and the lines that they came from.

use std::collections::{BTreeMap, BTreeSet};

/// Such values.
#[derive(Clone, Debug, Default)]
pub(crate) struct Beside {
    /// By table: of each field of the card, in order.
    tables: BTreeMap<&'static str, Vec<Option<Vec<f64>>>>,
    /// Lines of the file by table and quantity, such as `parameters.m`.
    lines: BTreeMap<String, usize>,
    /// Parameters, values that an end holds, whose values stand among the initial ones.
    initial: BTreeSet<String>,
}

impl Beside {
    /// Keeps the numbers of a field of a table.
    pub fn keep(&mut self, table: &'static str, field: usize, numbers: &[f64]) {
        let own = self.tables.entry(table).or_default();
        if own.len() <= field {
            own.resize(field + 1, None);
        }
        if let Some(place) = own.get_mut(field) {
            *place = Some(numbers.to_vec());
        }
    }

    /// Keeps the line of the file in which a quantity of a table is given.
    pub fn stands(&mut self, table: &str, quantity: &str, line: usize) {
        self.lines.insert(format!("{table}.{quantity}"), line);
    }

    /// Says that the value of a parameter stands among the initial ones.
    pub fn is_initial(&mut self, parameter: &str) {
        self.initial.insert(parameter.to_owned());
    }

    /// Whether it does.
    pub fn initial(&self, parameter: &str) -> bool {
        self.initial.contains(parameter)
    }

    /// The parameters of which it does.
    pub fn all_initial(&self) -> impl Iterator<Item = &str> {
        self.initial.iter().map(String::as_str)
    }

    /// The numbers of a field.
    pub fn get(&self, table: &str, field: usize) -> Option<&[f64]> {
        self.tables.get(table)?.get(field)?.as_deref()
    }

    /// The lines of quantities.
    pub fn lines(&self) -> BTreeMap<String, usize> {
        self.lines.clone()
    }
}

/// The line of a value: its own, or that of its quantity at all sites (`parameters.m` of `parameters.m_7`).
pub(crate) fn line_of(lines: &BTreeMap<String, usize>, key: &str) -> Option<usize> {
    let found = lines.get(key).or_else(|| lines.get(quantity_of(key)?));
    found.copied()
}

/// The quantity of which a name is that of the value at a site: `m` of `m_7`.
pub(crate) fn quantity_of(name: &str) -> Option<&str> {
    let (quantity, site) = name.rsplit_once('_')?;
    site.bytes().all(|b| b.is_ascii_digit()).then_some(quantity)
}

/// The same with the number of the site: `m` and 7 of `m_7`.
pub(crate) fn at_site(name: &str) -> Option<(&str, usize)> {
    let quantity = quantity_of(name)?;
    let site = name.strip_prefix(quantity)?.strip_prefix('_')?;
    Some((quantity, site.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::{Beside, line_of};

    #[test]
    fn values_are_told_by_the_line_of_their_quantity() {
        let mut beside = Beside::default();
        beside.keep("parameters", 2, &[1.0, 2.0]);
        beside.stands("parameters", "m", 7);
        assert_eq!(beside.get("parameters", 2), Some(&[1.0, 2.0][..]));
        assert_eq!(beside.get("parameters", 1), None);
        assert_eq!(beside.get("initial", 2), None);
        let mut lines = beside.lines();
        lines.insert("parameters.m_3".to_owned(), 9);
        let line = |key: &str| line_of(&lines, key);
        assert_eq!(line("parameters.m_12"), Some(7));
        assert_eq!(line("parameters.m_3"), Some(9));
        assert_eq!(
            [line("parameters.m_x"), line("parameters.n_1"), line("h")],
            [None; 3]
        );
    }
}
