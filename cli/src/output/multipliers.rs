//! Finds the outputs of a run that are multipliers of constraints. Takes names; every multiplier has its own
//! invariants.

/// Whether a quantity is a multiplier, or the copy of one at a site. For each multiplier a run has two
/// invariants: the residual of its constraint, and the rate of change. `said` tells whether a name is the name
/// of an invariant.
pub(crate) fn is_multiplier(name: &str, said: impl Fn(&str) -> bool) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let copy = name.rsplit_once('_').filter(|(_, site)| is_number(site));
    let names = std::iter::once(name).chain(copy.map(|(own, _)| own));
    let mut names = names.filter(|own| !own.is_empty());
    names.any(|own| {
        let parts = ["constraint", "constraint_rate"].map(|part| format!("{part}_{own}"));
        parts.iter().all(|part| said(part))
    })
}

#[cfg(test)]
mod tests {
    use super::is_multiplier;

    #[test]
    fn multipliers_are_told_by_their_invariants() {
        let names = ["energy", "constraint_tension", "constraint_rate_tension"];
        let said = |name: &str| names.contains(&name);
        for (name, is) in [("tension", true), ("tension_0", true), ("x_0", false)] {
            assert_eq!(is_multiplier(name, said), is, "{name}");
        }
        assert!(!is_multiplier("rate_tension", said));
        assert!(!is_multiplier("_0", said));
    }
}
