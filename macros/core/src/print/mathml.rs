//! Presentation MathML on one line, for rustdoc. Tags are plain, and characters that Markdown could interpret are
//! written as numeric entities.

use super::Page;
use super::formula::Formula;
use super::layout::{Fence, Layout, Sign};
use super::lines::{self, Piece};
use super::unicode::relation;

/// A formula inside a sentence.
pub(super) fn inline(page: &Page, f: &Formula) -> String {
    format!("<math>{}</math>", element(&page.stacked(f)))
}

/// A displayed formula, as a table if it takes several lines.
pub(super) fn display(page: &Page, f: &Formula) -> String {
    let table = |rows: String| format!("<mtable displaystyle=\"true\">{rows}</mtable>");
    let points = page.style.points;
    let body = match f {
        Formula::Rows(parts) => {
            let layouts: Vec<Layout> = parts.iter().map(|part| page.stacked(part)).collect();
            table(lines::group(&layouts, points).iter().map(rows).collect())
        }
        _ => {
            let layout = page.stacked(f);
            match lines::typeset(&layout, points) {
                None => element(&layout),
                Some(broken) => table(rows(&broken)),
            }
        }
    };
    format!("<math display=\"block\">{body}</math>")
}

/// The rows of a table, aligned at relation signs.
fn rows(broken: &lines::Lines) -> String {
    let mut rows = String::new();
    for (i, row) in broken.lines.iter().enumerate() {
        let left = if i == 0 {
            pieces(&broken.left)
        } else {
            String::new()
        };
        let indent = if i == 0 || row.relation {
            String::new()
        } else {
            format!("<mspace width=\"{}em\"></mspace>", row.depth + 1)
        };
        rows.push_str(&format!(
            "<mtr><mtd style=\"text-align:right\"><mrow>{left}</mrow></mtd>\
             <mtd style=\"text-align:left\"><mrow>{indent}{}</mrow></mtd></mtr>",
            pieces(&row.pieces)
        ));
    }
    rows
}

/// Exactly one element.
fn element(layout: &Layout) -> String {
    match layout {
        Layout::Identifier(s) => tagged("mi", s),
        Layout::Typeset(_, shown) => element(shown),
        Layout::Number(s) => tagged("mn", s),
        Layout::Word(s) => tagged("mi", s),
        Layout::Text(s) => tagged("mtext", s),
        Layout::Sign(s) => sign(*s),
        Layout::Row(_) => format!("<mrow>{}</mrow>", content(layout)),
        Layout::Script { base, sub, sup } => {
            let tall = matches!(**base, Layout::Sign(Sign::Sum));
            let base = element(base);
            let (under, over, both) = if tall {
                ("munder", "mover", "munderover")
            } else {
                ("msub", "msup", "msubsup")
            };
            match (sub, sup) {
                (Some(a), Some(b)) => {
                    format!("<{both}>{base}{}{}</{both}>", element(a), element(b))
                }
                (Some(a), None) => format!("<{under}>{base}{}</{under}>", element(a)),
                (None, Some(b)) => format!("<{over}>{base}{}</{over}>", element(b)),
                (None, None) => base,
            }
        }
        Layout::Fraction(a, b) => format!("<mfrac>{}{}</mfrac>", element(a), element(b)),
        Layout::Root(a) => format!("<msqrt>{}</msqrt>", element(a)),
        Layout::Hat(a) => {
            let wide = !matches!(**a, Layout::Identifier(ref s) if s.chars().count() == 1);
            format!(
                "<mover accent=\"true\">{}<mo stretchy=\"{wide}\">&#94;</mo></mover>",
                element(a)
            )
        }
        Layout::Fenced(fence, inner) => enclosed(*fence, &content(inner)),
        Layout::Grid(rows) => {
            let entry = |a: &Layout| format!("<mtd>{}</mtd>", element(a));
            let row =
                |r: &Vec<Layout>| format!("<mtr>{}</mtr>", r.iter().map(entry).collect::<String>());
            let rows: String = rows.iter().map(row).collect();
            enclosed(Fence::Round, &format!("<mtable>{rows}</mtable>"))
        }
        Layout::Break(_) => String::new(),
    }
}

/// Any number of elements, within a row.
fn content(layout: &Layout) -> String {
    match layout {
        Layout::Row(parts) => parts.iter().map(content).collect(),
        _ => element(layout),
    }
}

fn tagged(tag: &str, text: &str) -> String {
    format!("<{tag}>{}</{tag}>", escape(text))
}

/// Escapes ASCII punctuation that Markdown or HTML might interpret.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '(' | ')' | '+' | ',' | '/' | ':' | '=' | ';' => out.push(c),
            _ if c.is_ascii_punctuation() || c.is_ascii_control() || c == '\u{a0}' => {
                out.push_str(&format!("&#{};", u32::from(c)));
            }
            _ => out.push(c),
        }
    }
    out
}

fn sign(sign: Sign) -> String {
    let mo = |c: &str| format!("<mo>{c}</mo>");
    match sign {
        Sign::Plus => mo("+"),
        Sign::Minus => mo("−"),
        Sign::Negative => "<mo form=\"prefix\">−</mo>".to_owned(),
        // Invisible multiplication, with the usual space after it.
        Sign::Times => "<mo lspace=\"0\" rspace=\"0.17em\">&#8290;</mo>".to_owned(),
        Sign::Dot => mo("·"),
        Sign::Cross => mo("×"),
        Sign::Diamond => mo("⋄"),
        Sign::Slash => mo("/"),
        Sign::Comma => mo(","),
        Sign::Nabla => "<mo form=\"prefix\" rspace=\"0\">∇</mo>".to_owned(),
        Sign::Delta => "<mi>δ</mi>".to_owned(),
        Sign::Sum => mo("∑"),
        Sign::Root => mo("√"),
        Sign::Bar => "<mo stretchy=\"true\">&#124;</mo>".to_owned(),
        Sign::Star => mo("∗"),
        Sign::Wedge => mo("∧"),
        Sign::Apply => mo("&#8289;"),
        Sign::Operand | Sign::Thin => "<mspace width=\"0.17em\"></mspace>".to_owned(),
        Sign::Wide => "<mspace width=\"0.5em\"></mspace>".to_owned(),
        Sign::Tight('-') => mo("−"),
        Sign::Tight(c) => mo(&escape(&c.to_string())),
        Sign::Relation(r) => mo(&escape(relation(r))),
    }
}

fn brackets(fence: Fence) -> (&'static str, &'static str) {
    match fence {
        Fence::Round => ("(", ")"),
        Fence::Square => ("&#91;", "&#93;"),
        Fence::Angle => ("⟨", "⟩"),
        Fence::Bars => ("&#124;", "&#124;"),
    }
}

fn enclosed(fence: Fence, inside: &str) -> String {
    let (open, close) = brackets(fence);
    format!("<mrow><mo>{open}</mo>{inside}<mo>{close}</mo></mrow>")
}

fn pieces(list: &[Piece]) -> String {
    let mut out = String::new();
    let mut rest = list;
    while let Some((piece, after)) = rest.split_first() {
        rest = after;
        match piece {
            Piece::Whole(layout) => out.push_str(&content(layout)),
            Piece::Open(fence, _) => match lines::enclosed(after) {
                Some((inside, beyond)) => {
                    out.push_str(&enclosed(*fence, &pieces(inside)));
                    rest = beyond;
                }
                None => out.push_str(&parted("prefix", brackets(*fence).0)),
            },
            Piece::Close(fence, _) => out.push_str(&parted("postfix", brackets(*fence).1)),
            Piece::Break(..) => {}
        }
    }
    out
}

/// One bracket of a pair whose brackets are on different lines; it must not stretch to the height of its line.
fn parted(form: &str, bracket: &str) -> String {
    format!("<mo form=\"{form}\" stretchy=\"false\">{bracket}</mo>")
}
