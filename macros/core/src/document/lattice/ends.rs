//! The ends of a chain: for each end condition, the equations of the sites that differ from the interior.

use super::{equations, like_the_middle, say, stated_configurations};
use crate::document::indexed_notation::{IndexOrigin, IndexedNotation, Part};
use crate::lattice::Lattice;
use crate::print::document::{Document, Inline};
use crate::print::formula::Formula;

/// Adds the sections on the ends of an open chain.
pub(super) fn ends(folded: &mut IndexedNotation, parts: &[Part], doc: &mut Document) {
    let lattice = folded.lattice;
    let Some(line) = lattice.line_label() else {
        return;
    };
    for last in [false, true] {
        let site = if last { line.count.text.as_str() } else { "0" };
        for (which, name) in lattice.alternatives(last).iter().enumerate() {
            let Some(part) = part_of(parts, last, which) else {
                continue;
            };
            let title = format!("End {} = {site}: {name}", line.index.text);
            end(folded, part, last, which, &title, doc);
        }
    }
}

/// The open chain with this end condition, and the default condition at the other end.
fn part_of(parts: &[Part], last: bool, which: usize) -> Option<&Part> {
    let end = usize::from(last);
    parts
        .iter()
        .find(|p| !p.choice.periodic && p.choice.ends[end] == which && p.choice.ends[1 - end] == 0)
}

fn end(
    folded: &mut IndexedNotation,
    part: &Part,
    last: bool,
    which: usize,
    title: &str,
    doc: &mut Document,
) {
    let from = if last {
        IndexOrigin::Last
    } else {
        IndexOrigin::First
    };
    let terms = folded.terms(part);
    let section = doc.section(title);
    let lattice: &Lattice = folded.lattice;
    let alternative = lattice.ends[usize::from(last)].get(which);
    if let Some(given) = alternative.map(|a| &a.given).filter(|g| !g.is_empty()) {
        let names: Vec<&str> = given.iter().map(|n| n.text.as_str()).collect();
        let (is, values) = match names.len() {
            1 => ("is", "its value comes"),
            _ => ("are", "their values come"),
        };
        say(
            section,
            format!(
                "Here {} {is} prescribed: {values} from the case.",
                names.join(", ")
            ),
        );
    }
    for (s, e) in part.unfolded.summands.iter().zip(terms) {
        if let (Some((at, _)), Some(e)) = (s.end, e)
            && at == last
        {
            let words: [Inline; 3] = [
                "This end adds the term ".into(),
                Formula::Expr(e).into(),
                " to the Lagrangian.".into(),
            ];
            section.paragraph(words);
        }
    }
    let mut any = false;
    for s in stated_configurations(part) {
        if lattice
            .find(&s.name)
            .is_none_or(|q| lattice.line != Some(q.label))
        {
            continue;
        }
        let (first, end) = like_the_middle(folded, part, &s);
        let own: Vec<(usize, usize)> = match last {
            false => s.copies[..first].to_vec(),
            true => s.copies[end + 1..].to_vec(),
        };
        for (i, _) in own {
            any = true;
            for equation in equations(folded, part, i, from) {
                section.equation(equation);
            }
        }
    }
    if !any {
        section.text("The equations of a site hold up to this end.");
    }
}
