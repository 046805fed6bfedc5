//! Held constraints in a derivation: what they state, how their multipliers are found, and how the momentum
//! is projected on arrival. Takes the sheet; gives paragraphs of sections, and a section.

use super::sheet::Sheet;
use crate::derive::holds;
use crate::expr::shape::Shape;
use crate::expr::{self, Expr, Letter, Shift};
use crate::print::document::{Document, Inline, Section};
use crate::print::formula::Formula;

/// What is held, in the section of constraints.
pub fn stated(sheet: &Sheet, section: &mut Section) {
    let d = sheet.d;
    if d.spec.holds.is_empty() {
        return;
    }
    for (j, hold) in d.spec.holds.iter().enumerate() {
        let multiplier = sheet.here(hold.multiplier);
        section.paragraph(["The multiplier ".into(), multiplier.into(), " holds".into()]);
        section.equation(Formula::equal(
            sheet.math(&hold.left),
            sheet.math(&hold.right),
        ));
        section.labelled(&label(j));
        let (own, paired) = (hold.left.shape(), hold.value.shape());
        if own != paired {
            let count = sheet.symbols().sizes(paired.rows).1;
            let name = &sheet.symbols().get(hold.multiplier).name;
            section.text(&format!(
                "Its {count} independent entries are paired with the components of {name}."
            ));
        }
    }
}

fn label(j: usize) -> String {
    format!("hold {j}")
}

/// How a step holds them.
pub fn held(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    let s = sheet.symbols();
    if d.spec.holds.is_empty() {
        return;
    }
    let section = doc.section("Held constraints");
    let names: Vec<Formula> = d
        .spec
        .holds
        .iter()
        .map(|h| sheet.here(h.multiplier))
        .collect();
    let mut words: Vec<Inline> = vec![match names.len() {
        1 => "The multiplier ".into(),
        _ => "The multipliers ".into(),
    }];
    for (i, name) in names.into_iter().enumerate() {
        if i > 0 {
            words.push(", ".into());
        }
        words.push(name.into());
    }
    words.push(
        match d.spec.holds.len() {
            1 => " is found with the step, so that the constraint holds at its end (SHAKE):",
            _ => " are found with the step, so that the constraints hold at its end (SHAKE):",
        }
        .into(),
    );
    section.paragraph(words);
    for hold in &d.spec.holds {
        let next = |e: &Expr| sheet.math(&expr::shift_time(s, e, Shift::NEXT.time));
        section.equation(Formula::equal(next(&hold.left), next(&hold.right)));
    }
    section.text("Among several solutions the principal one is taken, which continues from rest with zero multipliers.");
    let Ok(limit) = &d.limit else {
        section.text(
            "The momentum is not projected on arrival: the velocity is not known from it in closed form.",
        );
        return;
    };
    let impulses = (0..d.spec.holds.len()).map(|j| holds::rate_paired(d, j));
    let paired = expr::sum(impulses.collect::<Vec<_>>(), Shape::SCALAR);
    section.text(
        "On arrival the momentum is projected (RATTLE): impulses along the reactions are added,",
    );
    let here = |symbol| Letter {
        symbol,
        shift: Shift::HERE,
    };
    let zeta: Vec<(Letter, Expr)> = (d.spec.configurations.iter())
        .zip(d.letters.variation.iter().zip(&d.letters.rate))
        .map(|(c, (xi, zeta))| {
            let velocity = crate::derive::continuous::velocity(&d.letters, c.group, *zeta);
            (here(*xi), velocity)
        })
        .collect();
    let kinetic = expr::add(limit.kinetic.clone(), limit.linear.clone());
    for (i, c) in d.spec.configurations.iter().enumerate() {
        let along = |e: &Expr| {
            let y = expr::gradient(s, e, here(d.letters.variation[i]));
            expr::substitute(s, &c.group.of_gradient(s, y), &zeta)
        };
        let kick = along(&paired);
        if kick.is_zero() {
            continue;
        }
        let momentum = expr::here(s, d.letters.node_momentum[i]);
        let right = expr::sub(momentum, kick);
        section.equation(Formula::equal(
            sheet.math(&along(&kinetic)),
            sheet.math(&right),
        ));
    }
    section.text("so that the velocity on the left moves along the constraints:");
    for hold in &d.spec.holds {
        let rate = expr::substitute(s, &holds::rate(d, hold), &zeta);
        let zero = expr::zero(rate.shape());
        section.equation(Formula::equal(sheet.math(&rate), Formula::Expr(zero)));
    }
    section.text("The projection changes no configuration: the multiplier of the next step would supply the same impulse. The multiplier in the state is that of the step that ended at the node, including the impulse of the projection; it approximates the multiplier at the middle of the step to second order.");
}
