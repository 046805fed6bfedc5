//! Names of quantities at sites: `m_7` is the value of `m` at the site 7. Takes names; gives their parts, and the lines of a case
//! where they are given.

use std::collections::BTreeMap;

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
    use super::line_of;
    use std::collections::BTreeMap;

    #[test]
    fn values_have_the_line_of_their_quantity() {
        let lines = [("parameters.m", 7), ("parameters.m_3", 9)];
        let lines: BTreeMap<String, usize> = lines
            .into_iter()
            .map(|(key, n)| (key.to_owned(), n))
            .collect();
        let line = |key: &str| line_of(&lines, key);
        assert_eq!(line("parameters.m_12"), Some(7));
        assert_eq!(line("parameters.m_3"), Some(9));
        assert_eq!(
            [line("parameters.m_x"), line("parameters.n_1"), line("h")],
            [None; 3]
        );
    }
}
