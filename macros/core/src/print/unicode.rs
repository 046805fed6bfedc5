//! Plain text in Unicode: formulas on one line, with Unicode subscripts and superscripts where characters exist and
//! `_{...}` and `^{...}` where not; documents wrapped for a terminal.

use super::Page;
use super::compose::parts::equations;
use super::document::{Block, Document, Inline, plain};
use super::formula::{Formula, Relation};
use super::layout::{Fence, Layout, Sign};
use super::lines::{self, Piece, Ruler};

/// A space at which text does not break.
const HARD_SPACE: char = '\u{a0}';

/// Columns for the number of a displayed equation.
const MARGIN: usize = 8;

/// A layout on one line.
pub(super) fn line(layout: &Layout) -> String {
    match layout {
        Layout::Identifier(s) | Layout::Number(s) | Layout::Word(s) | Layout::Text(s) => s.clone(),
        Layout::Typeset(_, shown) => line(shown),
        Layout::Sign(s) => sign(*s),
        Layout::Row(parts) => parts.iter().map(line).collect(),
        Layout::Script { base, sub, sup } => {
            let star = matches!(sup.as_deref(), Some(Layout::Sign(Sign::Star)));
            let sub = sub
                .as_deref()
                .map_or(String::new(), |s| subscript(&line(s)));
            let sup = sup
                .as_deref()
                .map_or(String::new(), |s| superscript(&line(s)));
            if star {
                line(base) + &sup + &sub
            } else {
                line(base) + &sub + &sup
            }
        }
        // For plain text the composer never produces these layouts; the match is complete anyway.
        Layout::Fraction(a, b) => format!("({})/({})", line(a), line(b)),
        Layout::Root(a) => format!("√({})", line(a)),
        Layout::Hat(a) => format!("hat({})", line(a)),
        Layout::Grid(rows) => {
            let row = |r: &Vec<Layout>| {
                let entries: Vec<String> = r.iter().map(line).collect();
                format!("[{}]", entries.join(", "))
            };
            let rows: Vec<String> = rows.iter().map(row).collect();
            format!("[{}]", rows.join(", "))
        }
        Layout::Fenced(fence, inner) => {
            let (open, close) = brackets(*fence);
            format!("{open}{}{close}", line(inner))
        }
        Layout::Break(_) => String::new(),
    }
}

fn sign(sign: Sign) -> String {
    let text = match sign {
        Sign::Plus => " + ",
        Sign::Minus => " - ",
        Sign::Negative => "-",
        Sign::Times | Sign::Operand | Sign::Thin | Sign::Wide => " ",
        Sign::Dot => "·",
        Sign::Cross => " × ",
        Sign::Diamond => " ◇ ",
        Sign::Slash => "/",
        Sign::Comma => ", ",
        Sign::Nabla => "∇",
        Sign::Delta => "δ",
        Sign::Sum => "∑",
        Sign::Root => "√",
        Sign::Bar => "|",
        Sign::Star => "*",
        Sign::Wedge => "∧",
        Sign::Apply => "",
        Sign::Tight(c) => return c.to_string(),
        Sign::Relation(r) => return format!(" {} ", relation(r)),
    };
    text.to_owned()
}

/// The character of a relation.
pub(super) fn relation(r: Relation) -> &'static str {
    match r {
        Relation::Equal => "=",
        Relation::Defined => ":=",
        Relation::Carried => "→",
        Relation::Identical => "≡",
        Relation::Approximate => "≈",
        Relation::Member => "∈",
        Relation::Less => "<",
        Relation::AtMost => "≤",
        Relation::Greater => ">",
        Relation::AtLeast => "≥",
        Relation::Implies => "⟹",
    }
}

fn brackets(fence: Fence) -> (char, char) {
    match fence {
        Fence::Round => ('(', ')'),
        Fence::Square => ('[', ']'),
        Fence::Angle => ('⟨', '⟩'),
        Fence::Bars => ('|', '|'),
    }
}

/// The digits of a number as subscripts, `₁₂` for `12`; `None` if there are other characters.
pub fn lowered(digits: &str) -> Option<String> {
    let digits = digits.chars();
    digits
        .map(|c| char::from_u32(0x2080 + c.to_digit(10)?))
        .collect()
}

fn subscript(text: &str) -> String {
    match lowered(text) {
        Some(small) => small,
        None if text.chars().count() == 1 => format!("_{text}"),
        None => format!("_{{{text}}}"),
    }
}

fn superscript(text: &str) -> String {
    const SMALL: [(char, char); 13] = [
        ('0', '⁰'),
        ('1', '¹'),
        ('2', '²'),
        ('3', '³'),
        ('4', '⁴'),
        ('5', '⁵'),
        ('6', '⁶'),
        ('7', '⁷'),
        ('8', '⁸'),
        ('9', '⁹'),
        ('-', '⁻'),
        ('T', 'ᵀ'),
        ('*', '*'),
    ];
    let small: Option<String> = text
        .chars()
        .map(|c| SMALL.iter().find(|(big, _)| *big == c).map(|(_, s)| *s))
        .collect();
    match small {
        Some(small) => small,
        None if text.chars().count() == 1 => format!("^{text}"),
        None => format!("^{{{text}}}"),
    }
}

fn piece(p: &Piece) -> String {
    match p {
        Piece::Whole(layout) => line(layout),
        Piece::Open(fence, _) => brackets(*fence).0.to_string(),
        Piece::Close(fence, _) => brackets(*fence).1.to_string(),
        Piece::Break(..) => String::new(),
    }
}

fn pieces(list: &[Piece]) -> String {
    list.iter().map(piece).collect()
}

fn columns(text: &str) -> usize {
    text.chars().count()
}

/// A displayed formula in lines of at most `limit` columns; continuation lines align after the relation sign.
pub(super) fn display(page: &Page, f: &Formula, limit: usize) -> Vec<String> {
    if let Formula::Rows(parts) = f {
        let lines = parts.iter().flat_map(|part| display(page, part, limit));
        return lines.collect();
    }
    if let Some(parts) = equations(f) {
        let all = parts.iter().all(|part| page.says_nothing(part));
        let parts = parts.iter().filter(|part| all || !page.says_nothing(part));
        return parts.flat_map(|part| display(page, part, limit)).collect();
    }
    let layout = page.linear(f);
    let indent = |depth: usize, aligned: bool| 2 * depth + if aligned { 0 } else { 4 };
    let ruler = Ruler {
        limit,
        measure: &|p| columns(&piece(p)),
        indent: &indent,
    };
    let Some(broken) = lines::broken(&layout, &ruler) else {
        return vec![line(&layout)];
    };
    let left = pieces(&broken.left);
    let aligned = !broken.left.is_empty();
    let mut after = columns(&left);
    let mut out: Vec<String> = Vec::new();
    for (i, row) in broken.lines.iter().enumerate() {
        let text = pieces(&row.pieces);
        if row.relation {
            let lead = row.pieces.iter().take_while(|p| p.is_relation());
            after = columns(&left) + lead.map(|p| columns(&piece(p))).sum::<usize>();
        }
        let start = match (i, row.relation) {
            (0, _) => left.clone(),
            (_, true) => " ".repeat(columns(&left)),
            (_, false) => " ".repeat(after + indent(row.depth, aligned)),
        };
        let text = if i > 0 && !row.relation {
            text.trim_start().to_owned()
        } else {
            text
        };
        out.push((start + &text).trim_end().to_owned());
    }
    out
}

/// A whole document.
pub(super) fn document(page: &Page, document: &Document) -> String {
    let limit = page.style.columns;
    let mut out = String::new();
    let heading = |out: &mut String, title: &str, under: char| {
        let rule: String = std::iter::repeat_n(under, columns(title)).collect();
        out.push_str(&format!("{title}\n{rule}\n"));
    };
    heading(&mut out, &document.title, '=');
    let mut number = 0usize;
    for section in &document.sections {
        out.push('\n');
        heading(&mut out, &section.title, '-');
        for block in &section.blocks {
            out.push('\n');
            match block {
                Block::Paragraph(parts) => fill(&mut out, &words(page, parts), limit, "", ""),
                Block::List(items) => {
                    for item in items {
                        fill(&mut out, &words(page, item), limit, "- ", "  ");
                    }
                }
                Block::Code(text) => {
                    for code in text.lines() {
                        out.push_str(format!("    {code}").trim_end());
                        out.push('\n');
                    }
                }
                Block::Equation {
                    formula, tag, note, ..
                } => {
                    number += 1;
                    let mut first = format!("  ({number})");
                    let margin = " ".repeat(MARGIN);
                    first.push_str(&" ".repeat(MARGIN.saturating_sub(columns(&first))));
                    for row in display(page, formula, limit.saturating_sub(MARGIN)) {
                        out.push_str(&format!("{first}{row}\n"));
                        first.clone_from(&margin);
                    }
                    let tag = tag.as_ref().map(|t| format!("[{}]", plain(t)));
                    let remark = tag.into_iter().chain(note.clone()).collect::<Vec<_>>();
                    if !remark.is_empty() {
                        fill(&mut out, &remark.join(" "), limit, &margin, &margin);
                    }
                }
            }
        }
    }
    out
}

fn words(page: &Page, parts: &[Inline]) -> String {
    let mut text = String::new();
    for part in parts {
        match part {
            Inline::Plain(words) | Inline::Notation { line: words, .. } => text.push_str(words),
            Inline::Code(code) => text.push_str(&format!("`{code}`")),
            Inline::Reference { number, .. } => text.push_str(&format!("({number})")),
            Inline::Math(f) => {
                let math = line(&page.linear(f));
                if columns(&math) <= page.style.columns / 2 {
                    text.push_str(&math.replace(' ', &HARD_SPACE.to_string()));
                } else {
                    text.push_str(&math);
                }
            }
        }
    }
    text
}

/// Wraps text; the first line begins with `first`, the others with `next`.
fn fill(out: &mut String, text: &str, limit: usize, first: &str, next: &str) {
    let mut row = first.to_owned();
    let mut empty = true;
    for word in text.split([' ', '\n', '\t']).filter(|w| !w.is_empty()) {
        if !empty && columns(&row) + 1 + columns(word) > limit {
            out.push_str(&row.replace(HARD_SPACE, " "));
            out.push('\n');
            row = next.to_owned();
            empty = true;
        }
        if !empty {
            row.push(' ');
        }
        row.push_str(word);
        empty = false;
    }
    out.push_str(row.replace(HARD_SPACE, " ").trim_end());
    out.push('\n');
}
