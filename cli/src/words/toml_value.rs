//! Values of options in the form of a case file: `[1, 2, pi/2]`, `{axis = [0, 0, 1], angle = pi/4}`. Takes the typed
//! text, from which a shell may have removed the quotes; gives TOML.

/// The TOML of a value: expressions without quotes get quotes. Mistakes in the value are reported by the reader of
/// the case.
pub(crate) fn quoted(text: &str) -> String {
    let mut out = String::new();
    let mut word = String::new();
    let (mut depth, mut in_quotes) = (0_usize, None);
    for c in text.chars() {
        match (in_quotes, c) {
            (Some(quote), _) => {
                word.push(c);
                if c == quote {
                    in_quotes = None;
                }
                continue;
            }
            (None, '"' | '\'') => in_quotes = Some(c),
            (None, '(') => depth += 1,
            (None, ')') => depth = depth.saturating_sub(1),
            (None, '[' | ']' | '{' | '}' | ',' | '=') if depth == 0 => {
                out.push_str(&entry(&word, c == '='));
                word.clear();
                out.push(c);
                continue;
            }
            _ => {}
        }
        word.push(c);
    }
    out.push_str(&entry(&word, false));
    out
}

/// A key, a number or a string unchanged; an expression in quotes.
fn entry(word: &str, is_key: bool) -> String {
    let own = word.trim();
    let is_plain = own.is_empty() || is_key || own.starts_with(['"', '\'']);
    let is_number = own.starts_with(|c: char| c.is_ascii_digit() || c == '-')
        && !own.ends_with('.')
        && own.parse::<f64>().is_ok();
    match is_plain || is_number {
        true => word.to_owned(),
        false => word.replace(own, &format!("\"{own}\"")),
    }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn expressions_get_the_quotes_that_a_shell_took() {
        for (typed, toml) in [
            ("0.5", "0.5"),
            ("-pi/2", "\"-pi/2\""),
            ("[1, -2e3, pi/2]", "[1, -2e3, \"pi/2\"]"),
            ("[[1,0],[0,atan2(1,2)]]", "[[1,0],[0,\"atan2(1,2)\"]]"),
            (
                "{axis=[0,0,1], angle = 2*pi/3}",
                "{axis=[0,0,1], angle = \"2*pi/3\"}",
            ),
            (
                "{euler=zxz, angles=[0, \"pi/2\", 1]}",
                "{euler=\"zxz\", angles=[0, \"pi/2\", 1]}",
            ),
            ("[.5, inf]", "[\".5\", \"inf\"]"),
        ] {
            assert_eq!(quoted(typed), toml);
        }
    }
}
