//! The width of the terminal, and text that fits it. Takes the process's terminal; gives a number of characters, and
//! paragraphs with lines of at most this length.

use std::io::{self, IsTerminal};

/// A narrower terminal counts as this wide: a line of numbers needs some room.
const LEAST: usize = 20;

/// The number of characters in a line of the terminal, or `None` if standard output is not a terminal. The variable
/// COLUMNS, as shells set it, takes precedence.
pub(crate) fn of_the_terminal() -> Option<usize> {
    let columns = std::env::var("COLUMNS").ok();
    let stated = columns.and_then(|columns| columns.trim().parse::<usize>().ok());
    let measured = || {
        let size = io::stdout()
            .is_terminal()
            .then(terminal_size::terminal_size);
        size.flatten().map(|(width, _)| usize::from(width.0))
    };
    stated
        .filter(|width| *width > 0)
        .or_else(measured)
        .map(|width| width.max(LEAST))
}

/// The words of `text` in lines of at most `width` characters, without line ends. A longer word is broken, after an
/// underscore if it contains one. At least one line, possibly empty.
pub(crate) fn wrapped(text: &str, width: usize) -> Vec<String> {
    let width = width.max(1);
    let mut lines = vec![String::new()];
    let mut used = 0;
    for word in text.split(' ') {
        let mut letters: Vec<char> = word.chars().collect();
        let gap = usize::from(used > 0);
        if used > 0 && used + gap + letters.len() > width {
            lines.push(String::new());
            used = 0;
        } else if used > 0 {
            add(&mut lines, &[' ']);
            used += 1;
        }
        while letters.len() > width {
            // A long name is broken after an underscore, if it contains one.
            let score = letters
                .iter()
                .take(width)
                .rposition(|letter| *letter == '_');
            let rest = letters.split_off(score.map_or(width, |at| at + 1));
            add(&mut lines, &letters);
            lines.push(String::new());
            letters = rest;
        }
        used += letters.len();
        add(&mut lines, &letters);
    }
    lines
}

fn add(lines: &mut [String], letters: &[char]) {
    if let Some(line) = lines.last_mut() {
        line.extend(letters);
    }
}

/// A paragraph for the terminal: `text`, ended by a new line; lines after the first are indented.
pub(crate) fn paragraph(text: &str, width: Option<usize>, indent: usize) -> String {
    let Some(width) = width else {
        return format!("{text}\n");
    };
    let mut lines = wrapped(text, width).into_iter();
    let mut all = lines.next().unwrap_or_default();
    // The lines after the first are shorter by the indentation, so the rest of the text is wrapped again.
    let taken = all.chars().count();
    let rest: String = text.chars().skip(taken).collect();
    all.push('\n');
    if rest.trim().is_empty() {
        return all;
    }
    for line in wrapped(rest.trim_start(), width.saturating_sub(indent)) {
        all.push_str(&format!("{:indent$}{line}\n", ""));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::{paragraph, wrapped};

    #[test]
    fn lines_are_as_long_as_they_may_be() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("Γ₁·Γ₂ b", 5), ["Γ₁·Γ₂", "b"]);
        assert_eq!(wrapped("a abcdefgh c", 3), ["a", "abc", "def", "gh", "c"]);
        assert_eq!(wrapped("abcdefgh c", 4), ["abcd", "efgh", "c"]);
        assert_eq!(wrapped("", 4), [""]);
        assert_eq!(wrapped("long_name_of_it", 7), ["long_", "name_", "of_it"]);
    }

    #[test]
    fn paragraphs_hang() {
        assert_eq!(
            paragraph("one two three four", Some(9), 2),
            "one two\n  three\n  four\n"
        );
        assert_eq!(paragraph("one two", None, 2), "one two\n");
    }
}
