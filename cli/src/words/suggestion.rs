//! "Did you mean": the known name nearest to a mistyped one.
//! Takes the typed name and the known names; gives the sentence to append to a message.

/// Jaro-Winkler similarity above which a name is worth suggesting. One mistake in a name of five letters or more
/// scores above 0.8; unrelated names of this project's vocabulary score below 0.65.
const LIKE: f64 = 0.75;

/// Longer lists are not printed; the models of the gallery and the keys of a case are fewer.
const MOST: usize = 40;

/// The known name most similar to the typed name, if one is similar. Case is ignored. If several are equally
/// similar, the first is taken.
#[must_use]
pub fn nearest<'a>(typed: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let typed = typed.to_lowercase();
    let mut best: Option<(f64, &str)> = None;
    for name in known {
        let score = strsim::jaro_winkler(&typed, &name.to_lowercase());
        if score >= LIKE && best.is_none_or(|(so_far, _)| score > so_far) {
            best = Some((score, name));
        }
    }
    best.map(|(_, name)| name)
}

/// The only known name that differs from the typed name by one letter, or by two adjacent letters in the other
/// order.
#[must_use]
pub fn slip<'a>(typed: &str, known: &[&'a str]) -> Option<&'a str> {
    let is_near = |name: &&&str| strsim::damerau_levenshtein(typed, name) == 1;
    let mut near = known.iter().filter(is_near);
    match (near.next(), near.next()) {
        (Some(only), None) => Some(only),
        _ => None,
    }
}

/// Gives `; did you mean ...?` for the [`nearest`] name, else `; known: ...`, else an empty text.
#[must_use]
pub fn did_you_mean<'a>(typed: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    match nearest(typed, known.iter().copied()) {
        Some(name) => format!("; did you mean `{name}`?"),
        None if known.is_empty() => String::new(),
        None if known.len() > MOST => format!(
            "; known: {}, and {} more",
            known[..MOST].join(", "),
            known.len() - MOST
        ),
        None => format!("; known: {}", known.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::{did_you_mean, slip};

    #[test]
    fn a_slip_has_one_name_near_it() {
        let names = ["velocity_x", "velocity_y"];
        assert_eq!(slip("velocty_y", &names), Some("velocity_y"));
        assert_eq!(slip("velcoity_x", &names), Some("velocity_x"));
        assert_eq!(
            [slip("velocity_z", &names), slip("velocity", &names)],
            [None; 2]
        );
    }

    #[test]
    fn of_many_names_some_are_told() {
        let names: Vec<String> = (0..1000).map(|i| format!("momentum_q_{i}")).collect();
        let told = did_you_mean("zzz", names.iter().map(String::as_str));
        assert!(told.ends_with("momentum_q_39, and 960 more"), "{told}");
    }

    #[test]
    fn nearest_name_or_all_names() {
        let names = ["heavy-top", "free-body", "coupled-bodies"];
        assert_eq!(
            did_you_mean("heavytop", names),
            "; did you mean `heavy-top`?"
        );
        assert_eq!(
            did_you_mean("FREE-BDOY", names),
            "; did you mean `free-body`?"
        );
        assert_eq!(
            did_you_mean("zzz", names),
            "; known: heavy-top, free-body, coupled-bodies"
        );
        assert_eq!(did_you_mean("zzz", []), "");
    }
}
