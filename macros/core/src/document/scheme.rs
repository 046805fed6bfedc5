//! The scheme before its derivation, as in a paper: a section with the variational principle and the algorithm of a
//! step, which refers to the equations below.

use super::compose::transport_label;
use super::motion::equations_name;
use super::sheet::{Sheet, listed};
use crate::expr::Shift;
use crate::print::document::{Document, Inline, Section};
use crate::print::formula::{Formula, Relation};

/// Inserts the section after the section on the model.
pub fn up_front(sheet: &Sheet, doc: &mut Document) {
    let mut out = Document::default();
    let section = out.section("Scheme");
    principle(sheet, section);
    algorithm(sheet, section);
    let place = doc.sections.len().min(1);
    doc.sections.splice(place..place, out.sections);
}

/// States that the action is stationary.
fn principle(sheet: &Sheet, section: &mut Section) {
    let k = &sheet.d.spec.time_index;
    section.text("The variational principle is");
    let action = Formula::SumOver {
        index: k.clone(),
        from: None,
        to: None,
        of: Box::new(Formula::name(&format!("ℓ^c_{k}"))),
    };
    let zero = Formula::Relation(
        vec![Formula::Variation(Box::new(action)), Formula::name("0")],
        Relation::Equal,
    );
    section.equation(zero);
    section.labelled("principle");
    section.paragraph([
        "where ".into(),
        Formula::name(&format!("ℓ^c_{k}")).into(),
        " is the Clebsch action of the step that begins at node ".into(),
        Formula::name(k).into(),
        ". It yields the discrete ".into(),
        equations_name(sheet).into(),
        " equations, which advance the state from node to node:".into(),
    ]);
}

/// Lists the operations of a step, in order.
fn algorithm(sheet: &Sheet, section: &mut Section) {
    let d = sheet.d;
    let configurations = &d.spec.configurations;
    let all = |label: &str| {
        let each =
            (0..configurations.len()).map(|i| vec![Inline::reference(&format!("{label} {i}"))]);
        listed(each.collect())
    };
    let velocities = configurations
        .iter()
        .map(|c| vec![Inline::Math(sheet.here(c.velocity))]);
    let mut solve: Vec<Inline> = vec!["Given the momentum at the node, solve ".into()];
    solve.extend(all("outgoing"));
    solve.push(match configurations.len() {
        1 => " for the velocity ".into(),
        _ => " for the velocities ".into(),
    });
    solve.extend(listed(velocities.collect()));
    if !d.spec.holds.is_empty() {
        solve.push(" and the multipliers of the constraints on configurations".into());
    }
    solve.push(".".into());
    let mut advance: Vec<Inline> = vec!["Advance the configuration by ".into()];
    let updates = configurations.iter().map(|c| {
        let next = sheet.at(c.element, Shift::NEXT);
        vec![Inline::Math(Formula::equal(next, sheet.math(&c.update)))]
    });
    advance.extend(listed(updates.collect()));
    let carried = (0..d.spec.advected.len()).map(|j| vec![Inline::reference(&transport_label(j))]);
    let carried: Vec<Vec<Inline>> = carried.collect();
    if !carried.is_empty() {
        advance.push(", and advected quantities by ".into());
        advance.extend(listed(carried));
    }
    advance.push(".".into());
    let mut momentum: Vec<Inline> = vec!["The momentum at the next node is ".into()];
    momentum.extend(all("incoming"));
    momentum.push(".".into());
    section.list(vec![solve, advance, momentum]);
}
