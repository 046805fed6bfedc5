//! The geometry behind the invariants: the Lie-Poisson bracket of the reduced space, the count of
//! its Casimirs, and the Lax form of a free body. Takes a derivation; adds sections.

use super::sheet::Sheet;
use crate::expr::Expr;
use crate::print::document::Document;
use crate::print::formula::Formula;

fn braces(sheet: &Sheet, first: &Expr, second: &Expr) -> Formula {
    Formula::Sequence(vec![
        Formula::Text("{".to_owned()),
        Formula::List(vec![sheet.math(first), sheet.math(second)]),
        Formula::Text("}".to_owned()),
    ])
}

/// How a model that was stated unreduced was reduced.
pub fn reduction(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    if d.spec.reduction.is_none() {
        return;
    }
    let section = doc.section("Reduction");
    section.text("The action is stated by the configuration at both ends of the step. With the reconstruction put in, parameters absorb what is left of the configuration and are carried along:");
    for a in d.spec.advected.iter().filter(|a| a.found) {
        let own = sheet.here(a.quantity);
        if let Some(definition) = &a.definition {
            section.equation(Formula::defined(own, sheet.math(definition)));
        }
    }
    section.equation(Formula::equal(
        Formula::name("ℓ"),
        sheet.math(&d.spec.typed),
    ));
    section.noted("As stated; with the definitions put in, the reduced action below is this one.");
}

/// The bracket, row by row.
pub fn bracket(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    let section = doc.section("Lie-Poisson bracket");
    section.text("On momenta and advected quantities, for constant elements of the Lie algebra; all other brackets vanish:");
    for row in &d.bracket.rows {
        section.equation(Formula::equal(
            braces(sheet, &row.first, &row.second),
            sheet.derived(&row.value),
        ));
    }
    if let Some((dimension, rank)) = d.integrability.rank {
        let (corank, found) = (dimension - rank, d.integrability.casimirs);
        let listed = match corank == found {
            true => "all of them are listed below".to_owned(),
            false => format!("{found} of them are listed below"),
        };
        section.text(&format!(
            "At a general point its rank is {rank} of {dimension}, so there are {corank} independent Casimirs; {listed}."
        ));
    }
}

/// The Lax form of the step.
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
        " the matrix L of the node after is similar to that of the node before, so its eigenvalues are conserved:".into(),
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
