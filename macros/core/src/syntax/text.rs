//! Prepares the text of a model for splitting into tokens. In strings a backslash denotes itself, so that LaTeX names
//! can be written directly (`as "m g \chi"`). Rust tokens would reject `\c` as an escape. Columns do not change.

/// Replaces a backslash that does not begin a Rust escape: a private-use character.
pub(super) const BACKSLASH: char = '\u{e000}';

/// Replaces such backslashes in strings; comments, raw strings and character literals are unchanged.
pub(super) fn with_plain_backslashes(source: &str) -> String {
    read(source, |_, _| {}).0
}

/// The same, and passes every character outside comments and literals to `code`, with its byte offset in the returned
/// text. Also returns whether every comment and string is terminated.
pub(super) fn read(source: &str, mut code: impl FnMut(usize, char)) -> (String, bool) {
    let mut out = String::with_capacity(source.len());
    let mut rest = source.chars().peekable();
    let mut before = ' ';
    let mut whole = true;
    while let Some(c) = rest.next() {
        code(out.len(), c);
        out.push(c);
        match (c, rest.peek().copied()) {
            ('/', Some('/')) => {
                while let Some(d) = rest.next_if(|d| *d != '\n') {
                    out.push(d);
                }
            }
            ('/', Some('*')) => {
                let (mut depth, mut last) = (0, c);
                for d in rest.by_ref() {
                    out.push(d);
                    match (last, d) {
                        ('/', '*') => (depth, last) = (depth + 1, ' '),
                        ('*', '/') => (depth, last) = (depth - 1, ' '),
                        _ => last = d,
                    }
                    if depth == 0 {
                        break;
                    }
                }
                whole &= depth == 0;
            }
            ('\'', Some('"')) => out.extend(rest.next()),
            ('\'', Some('(' | ')' | '[' | ']' | '{' | '}'))
                if rest.clone().nth(1) == Some('\'') =>
            {
                out.extend(rest.next());
            }
            ('r', Some('"' | '#')) if !before.is_alphanumeric() && before != '_' => {
                whole &= raw(&mut rest, &mut out);
            }
            ('"', _) => whole &= string(&mut rest, &mut out),
            _ => {}
        }
        before = c;
    }
    (out, whole)
}

type Rest<'a> = std::iter::Peekable<std::str::Chars<'a>>;

/// Copies a raw string after `r`; returns whether it is terminated.
fn raw(rest: &mut Rest, out: &mut String) -> bool {
    let mut hashes = 0;
    while rest.next_if_eq(&'#').is_some() {
        out.push('#');
        hashes += 1;
    }
    if rest.next_if_eq(&'"').is_none() {
        return true;
    }
    out.push('"');
    let mut closing: Option<usize> = None;
    for d in rest.by_ref() {
        out.push(d);
        closing = match (d, closing) {
            ('"', _) => Some(0),
            ('#', Some(n)) => Some(n + 1),
            _ => None,
        };
        if closing == Some(hashes) {
            return true;
        }
    }
    false
}

/// Copies a string after its opening quote; returns whether it is terminated.
fn string(rest: &mut Rest, out: &mut String) -> bool {
    while let Some(d) = rest.next() {
        match (d, rest.peek().copied()) {
            ('"', _) => {
                out.push(d);
                return true;
            }
            ('\\', Some(e @ ('n' | 'r' | 't' | '\\' | '0' | '\'' | '"' | '\n'))) => {
                out.extend([d, e]);
                rest.next();
            }
            ('\\', _) => out.push(BACKSLASH),
            _ => out.push(d),
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::with_plain_backslashes as plain;

    #[test]
    fn only_what_rust_would_refuse_is_replaced() {
        assert_eq!(
            plain(r#"as "m \chi \nu \\xi""#),
            "as \"m \u{e000}chi \\nu \\\\xi\""
        );
        let kept = [
            "// \"a \\chi\n b",
            "/* \"\\chi /* \" */ \\c */ a",
            "r\"\\chi\" r#\"\\c\"\\c\"# x",
            "'\"' \\c",
            "a'b \"\\\" \\n\"",
        ];
        for text in kept {
            assert_eq!(plain(text), text);
        }
        let x = plain("\"\\xi\"");
        assert_eq!(x.chars().count(), 5);
    }
}
