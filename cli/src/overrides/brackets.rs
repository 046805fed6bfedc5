//! Brackets of a value of an option. Takes the value; gives the first bracket without a partner.

/// The message about the first bracket without a partner, outside strings.
pub(super) fn fault(value: &str) -> Option<String> {
    let mut open: Vec<char> = Vec::new();
    let mut quote: Option<char> = None;
    for c in value.chars() {
        match (quote, c) {
            (Some(q), _) if q == c => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '(' | '[' | '{') => open.push(c),
            (None, ')' | ']' | '}') => {
                let partner = partner(c);
                match open.pop() {
                    Some(own) if own == partner => {}
                    Some(own) => {
                        return Some(format!(
                            "`{c}` closes `{own}` in `{value}`; write `{}`",
                            self::partner(own)
                        ));
                    }
                    None => {
                        return Some(format!(
                            "this `{c}` in `{value}` has no matching `{partner}`; remove it, or add the missing one"
                        ));
                    }
                }
            }
            _ => {}
        }
    }
    let own = open.pop()?;
    Some(format!(
        "the bracket `{own}` in `{value}` is not closed; add `{}`",
        partner(own)
    ))
}

fn partner(c: char) -> char {
    match c {
        '(' => ')',
        '[' => ']',
        '{' => '}',
        ')' => '(',
        ']' => '[',
        _ => '{',
    }
}
