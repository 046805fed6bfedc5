//! Names of quantities at sites: `m_7` is the value of `m` at site 7. Takes names; gives their parts, and their
//! lines in a case.

use std::collections::BTreeMap;

/// The line of a value. A value at a site may have the line of its quantity (`parameters.m` for
/// `parameters.m_7`).
pub(crate) fn line_of(lines: &BTreeMap<String, usize>, key: &str) -> Option<usize> {
    let found = lines.get(key).or_else(|| lines.get(quantity_of(key)?));
    found.copied()
}

/// The quantity in the name of its value at a site: `m` of `m_7`.
pub(crate) fn quantity_of(name: &str) -> Option<&str> {
    let (quantity, site) = name.rsplit_once('_')?;
    site.bytes().all(|b| b.is_ascii_digit()).then_some(quantity)
}

/// The quantity and the number of the site: `m` and 7 of `m_7`.
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
