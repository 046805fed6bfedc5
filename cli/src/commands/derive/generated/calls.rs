//! Formats calls of the runtime's protocol, whose macro arguments rustfmt would fill into lines without regard to
//! their meaning. Takes the text of a file; gives the text with a line for each part of such a call.

/// The largest number of columns in a line, as rustfmt counts them.
const WIDTH: usize = 89;

/// The text with one line for each part of a call of the protocol.
pub(super) fn with_calls(text: &str) -> String {
    let mut out = String::new();
    let mut call: Option<String> = None;
    for line in text.lines() {
        match (&mut call, line) {
            (None, _) => {
                out.push_str(line);
                out.push('\n');
                call = line.starts_with("::clebsch::stepper! {").then(String::new);
            }
            (Some(words), "}") => {
                parts(words).for_each(|part| filled(&part, &mut out));
                out.push_str("}\n");
                call = None;
            }
            (Some(words), line) => {
                let line = line.trim();
                // A path may be broken before a dot.
                if !words.is_empty() && !line.starts_with('.') {
                    words.push(' ');
                }
                words.push_str(line);
            }
        }
    }
    out
}

/// The parts of one call. A type ends with a comma; every other part begins with its keyword or a parenthesis.
fn parts(words: &str) -> impl Iterator<Item = String> {
    let mut all = vec![String::new()];
    let (mut depth, mut quoted) = (0usize, false);
    for word in words.split(' ') {
        let begins = matches!(word, "start" | "observables" | "invariants");
        let ended = all.last().is_some_and(|part| part.ends_with(','));
        if depth == 0 && !quoted && (begins || word.starts_with('(') || ended) {
            all.push(String::new());
        }
        if let Some(part) = all.last_mut() {
            if !part.is_empty() {
                part.push(' ');
            }
            part.push_str(word);
        }
        for c in word.chars() {
            match c {
                '"' => quoted = !quoted,
                '{' | '(' | '[' if !quoted => depth += 1,
                '}' | ')' | ']' if !quoted => depth = depth.saturating_sub(1),
                _ => {}
            }
        }
    }
    all.into_iter().filter(|part| !part.is_empty())
}

/// Writes one part on as many lines as it needs.
fn filled(part: &str, out: &mut String) {
    let (mut column, mut quoted) = (0, false);
    for word in part.split(' ') {
        let length = word.chars().count();
        match column {
            0 => {
                out.push_str("    ");
                column = 4 + length;
            }
            // A quoted text is not broken.
            _ if column + 1 + length > WIDTH && !quoted => {
                out.push_str("\n        ");
                column = 8 + length;
            }
            _ => {
                out.push(' ');
                column += 1 + length;
            }
        }
        out.push_str(word);
        quoted ^= word.matches('"').count() % 2 == 1;
    }
    out.push('\n');
}
