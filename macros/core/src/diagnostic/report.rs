//! A diagnostic as plain data. A [`Place`] belongs to the thread that has read the text; a report does not, so it can
//! be kept and rendered later.

use super::Place;

/// A range of characters of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextRange {
    /// The first character: its line, counted from 1, and its column, counted from 0.
    pub start: (usize, usize),
    /// The character after the last one.
    pub end: (usize, usize),
}

impl TextRange {
    /// The characters of a place.
    pub fn of(place: Place) -> TextRange {
        let (start, end) = (place.first.start(), place.last.end());
        TextRange {
            start: (start.line, start.column),
            end: (end.line, end.column),
        }
    }
}

/// A mistake or a warning as plain data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// The characters to underline.
    pub range: TextRange,
    /// States what is wrong and why.
    pub message: String,
    /// States what to write instead.
    pub help: Vec<String>,
    /// Other ranges involved, with a note on each.
    pub also: Vec<(TextRange, String)>,
}

impl Report {
    /// The report for a terminal, with a severity level: file, line, column, the source line and carets.
    pub fn render(&self, level: &str, source: &str, file: &str) -> String {
        let mut out = format!("{level}: {}\n", self.message);
        out.push_str(&snippet(source, file, self.range));
        for (range, text) in &self.also {
            out.push_str(&format!("  note: {text}\n"));
            out.push_str(&snippet(source, file, *range));
        }
        for line in &self.help {
            out.push_str(&format!("  = help: {line}\n"));
        }
        out.push('\n');
        out
    }
}

/// The maximum number of quoted characters of a line.
const LONGEST: usize = 200;

fn snippet(source: &str, file: &str, range: TextRange) -> String {
    let ((line, start), (last_line, end)) = (range.start, range.end);
    let line_text = source.lines().nth(line.saturating_sub(1)).unwrap_or("");
    let number = line.to_string();
    let pad = " ".repeat(number.len());
    let width = if last_line == line && end > start {
        end - start
    } else {
        line_text.chars().count().saturating_sub(start).max(1)
    };
    // Quote only the part around the position if the line is very long; it may contain a whole model.
    let length = line_text.chars().count();
    let (from, shown) = match length > LONGEST {
        true => {
            let before = LONGEST.saturating_sub(width.min(LONGEST)) / 2;
            let from = start.saturating_sub(before).min(length - LONGEST);
            (from, LONGEST)
        }
        false => (0, length),
    };
    let before = if from > 0 { "..." } else { "" };
    let behind = if from + shown < length { "..." } else { "" };
    let part: String = line_text.chars().skip(from).take(shown).collect();
    let column = start.saturating_sub(from);
    let carets = width.min(shown.saturating_sub(column)).max(1);
    // Keep tabs, so that the caret is below its token.
    let lead: String = (before.chars().chain(part.chars()))
        .take(before.len() + column)
        .map(|c| if c == '\t' { '\t' } else { ' ' })
        .collect();
    format!(
        "{pad}--> {file}:{line}:{}\n{pad} |\n{number} | {before}{part}{behind}\n{pad} | {lead}{}\n",
        start + 1,
        "^".repeat(carets)
    )
}
