//! Calls of the runtime's protocol in a formatted file: the formatter fills lines with the words of a macro, whatever they
//! mean. Takes the text of a file; gives it with a line for each part of such a call.

/// Columns of a line at most, as those of the formatter.
const WIDTH: usize = 89;

/// The text with what calls of the protocol say in lines of their own.
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
                // A path may be broken at its point.
                if !words.is_empty() && !line.starts_with('.') {
                    words.push(' ');
                }
                words.push_str(line);
            }
        }
    }
    out
}

/// What is said in one call: a type ends with a comma, what else there is begins with its word or a parenthesis.
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

/// One part in as many lines as it needs.
fn filled(part: &str, out: &mut String) {
    let (mut column, mut quoted) = (0, false);
    for word in part.split(' ') {
        let length = word.chars().count();
        match column {
            0 => {
                out.push_str("    ");
                column = 4 + length;
            }
            // A text stays what it is.
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
