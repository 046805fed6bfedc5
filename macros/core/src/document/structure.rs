//! The geometry behind the invariants: the Lie-Poisson bracket of the reduced space, the number of its Casimirs, and
//! the Lax form of a free body. Each function adds a section.

use super::sheet::Sheet;
use crate::derive::Derivation;
use crate::derive::invariants::{CasimirSearch, Count};
use crate::derive::variation::at;
use crate::expr::shape::Dim;
use crate::expr::{self, Expr, Node, Shift};
use crate::print::document::{Document, Section};
use crate::print::formula::Formula;

fn braces(sheet: &Sheet, first: &Expr, second: &Expr) -> Formula {
    Formula::Sequence(vec![
        Formula::Text("{".to_owned()),
        Formula::List(vec![sheet.math(first), sheet.math(second)]),
        Formula::Text("}".to_owned()),
    ])
}

/// Describes the reduction of a model that was declared unreduced.
pub fn reduction(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    if !d.spec.reduction.as_ref().is_some_and(|r| r.carries) {
        return;
    }
    let section = doc.section("Reduction");
    section.text("The discrete Lagrangian is stated in terms of the configuration at both ends of the step. Substituting the reconstruction turns each parameter multiplied by the remaining configuration into an advected quantity:");
    for a in d.spec.advected.iter().filter(|a| a.found) {
        let own = sheet.here(a.quantity);
        if let Some(definition) = &a.definition {
            section.equation(Formula::defined(own, sheet.math(definition)));
        }
    }
    for a in d.spec.advected.iter().filter(|a| a.found) {
        if let Some(meaning) = a.definition.as_ref().and_then(|e| meaning(sheet, e)) {
            let own = sheet.here(a.quantity);
            section.paragraph([own.into(), format!(" is {meaning}.").into()]);
        }
    }
    section.equation(Formula::equal(
        Formula::name("ℓ"),
        sheet.math(&d.spec.typed),
    ));
    section.noted(
        "As stated; substituting the definitions gives the reduced discrete Lagrangian below.",
    );
}

/// The meaning of an advected quantity that does not come from a parameter: it depends on one configuration only.
fn meaning(sheet: &Sheet, definition: &Expr) -> Option<String> {
    let d = sheet.d;
    let mut all = d.spec.configurations.iter();
    let c = all.find(|c| expr::contains(definition, at(c.element, Shift::HERE)))?;
    let letters = expr::letters(definition);
    if letters.iter().any(|l| l.symbol != c.element) {
        return None;
    }
    let (of, seen) = c.side.of(("space", "body"), ("the body", "space"));
    let from = match seen {
        "body" => "the body",
        other => other,
    };
    let units = unit(definition);
    Some(match units {
        Some((n, axis)) if c.group.rigid().is_some() && axis == expr::last_axis(n) => {
            format!("the origin of {of} seen from {from}, in homogeneous coordinates")
        }
        Some((_, axis)) => format!("the unit vector E{} of {of} seen from {from}", axis + 1),
        None if definition.shape().is_square() => {
            format!("the scalar product of {of} seen from {from}")
        }
        None => return None,
    })
}

/// A unit vector in an expression, if there is one.
fn unit(e: &Expr) -> Option<(Dim, u8)> {
    match e.node() {
        Node::Unit(n, axis) => Some((*n, *axis)),
        _ => e.children().into_iter().find_map(unit),
    }
}

/// The section on the bracket, row by row.
pub fn bracket(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    let section = match d.bracket.holds_elements {
        true => doc.section("Bracket"),
        false => doc.section("Lie-Poisson bracket"),
    };
    section.text(match d.bracket.holds_elements {
        true => "On the phase space, for constant elements of the Lie algebra; all other brackets vanish:",
        false => "On momenta and advected quantities, for constant elements of the Lie algebra; all other brackets vanish:",
    });
    for row in d.bracket.rows.iter().filter(|row| !row.value.is_zero()) {
        section.equation(Formula::equal(
            braces(sheet, &row.first, &row.second),
            sheet.derived(&row.value),
        ));
    }
    let counts = match &d.integrability.casimirs {
        CasimirSearch::Counted(counts) => counts,
        CasimirSearch::NotSought(why) => {
            if d.bracket.holds_elements {
                section.text("The equations contain the configuration itself, so clebsch does not look for Casimirs of a reduced space.");
                return;
            }
            section.text(&format!(
                "clebsch neither counted its Casimirs nor looked for them: {why}. Every Casimir is conserved."
            ));
            return;
        }
    };
    match counts.as_slice() {
        [] => {
            section.text(
                "clebsch does not count its Casimirs, because several sizes vary independently.",
            );
        }
        [one] if one.size.is_none() => {
            section.text(&format!(
                "At a general point its rank is {} of {}, so there {}; {}.",
                one.rank,
                one.dimension,
                number(one.all()),
                listed(one)
            ));
        }
        many => by_size(d, many, section),
    }
}

fn number(n: usize) -> String {
    match n {
        0 => "are no Casimirs".to_owned(),
        1 => "is 1 independent Casimir".to_owned(),
        n => format!("are {n} independent Casimirs"),
    }
}

fn listed(c: &Count) -> String {
    let shown = c.found.saturating_sub(c.same);
    match c.all() == c.found {
        all if c.same > 0 => {
            let others = match all {
                true => "",
                false => {
                    "; clebsch found no others among the scalar products, traces and determinants"
                }
            };
            let same = match c.same {
                1 => "1 has the same value for every state and is not listed".to_owned(),
                n => format!("{n} have the same value for every state and are not listed"),
            };
            let shown = match shown {
                0 => "none of them is".to_owned(),
                1 => "1 of them is".to_owned(),
                n => format!("{n} of them are"),
            };
            format!("{shown} listed below; {same}{others}")
        }
        true if c.found == 0 => {
            "the quantities listed below are conserved for other reasons".to_owned()
        }
        true if c.found == 1 => "it is listed below".to_owned(),
        true => "all of them are listed below".to_owned(),
        false => format!(
            "{} of them are listed below; clebsch found no others among the scalar products, traces and determinants",
            c.found
        ),
    }
}

/// The counts for a model whose dimension is symbolic.
fn by_size(d: &Derivation, counts: &[Count], section: &mut Section) {
    let name = d.spec.dimensions.first().map_or("", |n| n.name.as_str());
    let each = counts.iter().map(|c| {
        let size = c.size.unwrap_or_default();
        let mut text = format!(
            "for {name} = {size} it is {} of {}, and there {}",
            c.rank,
            c.dimension,
            number(c.all())
        );
        if c.found < c.all() {
            text.push_str(&format!(", {} of them listed below", c.found));
        }
        text
    });
    section.text(&format!(
        "Its rank at a general point: {}.",
        each.collect::<Vec<_>>().join("; ")
    ));
    let complete = counts.iter().all(|c| c.found == c.all());
    let largest = counts.last().and_then(|c| c.size).unwrap_or_default();
    let beyond = d.spec.dimensions.iter().any(|n| n.to > largest as u64);
    if let Some(same) = counts.iter().map(|c| c.same).max().filter(|n| *n > 0) {
        section.text(&format!(
            "{same} of them have the same value for every state and are not listed."
        ));
    }
    section.text(match (complete, beyond) {
        (true, false) => {
            "All of them are listed below; at the smaller sizes, the listed Casimirs depend on one another."
        }
        (true, true) => {
            "Up to the largest of these sizes, all of them are listed below; clebsch did not count Casimirs at larger sizes."
        }
        (false, _) => {
            "clebsch found no others among the scalar products, traces and determinants."
        }
    });
}

/// The section on the Lax form of the step.
pub fn lax(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    let Some(lax) = &d.integrability.lax else {
        return;
    };
    let section = doc.section("Lax form");
    let spectral = sheet.here(d.letters.spectral);
    section.paragraph([
        "For every ".into(),
        spectral.into(),
        ", the matrix L at the next node is similar to the matrix L at this node, so its eigenvalues are conserved:".into(),
    ]);
    let letter = |base: &str, by: i8| {
        let base = sheet.symbols().fresh_name(base);
        Formula::name(&format!("{base}_{{{}}}", sheet.index(by)))
    };
    section.equation(Formula::defined(letter("L", 0), sheet.math(&lax.matrix)));
    section.labelled("Lax");
    let p = letter("K", 0);
    section.equation(Formula::defined(p.clone(), sheet.math(&lax.intertwiner)));
    section.cited(
        Formula::equal(
            Formula::Product(vec![letter("L", 1), p.clone()]),
            Formula::Product(vec![p, letter("L", 0)]),
        ),
        "discrete Lax equation of Moser and Veselov",
    );
}
