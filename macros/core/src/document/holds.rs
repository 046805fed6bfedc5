//! Describes constraints in a derivation: what they state, how a step finds their multipliers, and how the momentum
//! is projected on arrival. The functions add paragraphs to sections, and one section.

use super::sheet::Sheet;
use crate::algebra::Algebra;
use crate::check::spec::Hold;
use crate::derive::balance::shorter;
use crate::derive::limit::Limit;
use crate::derive::variation::at;
use crate::derive::{Derivation, holds};
use crate::expr::shape::Shape;
use crate::expr::{self, Expr, Letter, Shift};
use crate::print::document::{Document, Inline, Section};
use crate::print::formula::Formula;

/// Adds the `hold` statements to the section on constraints.
pub fn stated(sheet: &Sheet, section: &mut Section) {
    let d = sheet.d;
    if d.spec.holds.is_empty() {
        return;
    }
    for (j, hold) in d.spec.holds.iter().enumerate() {
        let multiplier = sheet.here(hold.multiplier);
        section.paragraph([
            "The multiplier ".into(),
            multiplier.into(),
            " enforces".into(),
        ]);
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

/// Describes how a step enforces the constraints.
pub fn held(sheet: &Sheet, doc: &mut Document) {
    let d = sheet.d;
    let s = sheet.symbols();
    if d.spec.holds.is_empty() {
        return;
    }
    let section = doc.section("Constraints on configurations");
    let names: Vec<Formula> = d
        .spec
        .holds
        .iter()
        .map(|h| sheet.here(h.multiplier))
        .collect();
    let mut words: Vec<Inline> = vec![match names.len() {
        1 => "The step solves for the multiplier ".into(),
        _ => "The step solves for the multipliers ".into(),
    }];
    for (i, name) in names.into_iter().enumerate() {
        if i > 0 {
            words.push(", ".into());
        }
        words.push(name.into());
    }
    words.push(
        match d.spec.holds.len() {
            1 => ", so that the constraint is satisfied at its end (SHAKE):",
            _ => ", so that the constraints are satisfied at its end (SHAKE):",
        }
        .into(),
    );
    section.paragraph(words);
    for hold in &d.spec.holds {
        let next = |e: &Expr| sheet.math(&expr::shift_time(s, e, Shift::NEXT.time));
        section.equation(Formula::equal(next(&hold.left), next(&hold.right)));
    }
    section.text(
        "The step takes the principal root, which continues from rest with zero multipliers.",
    );
    let Ok(limit) = &d.limit else {
        section.text(
            "The step does not project the momentum at its end, because the momentum does not give the velocity in closed form.",
        );
        return;
    };
    section.text(ON_ARRIVAL);
    for i in 0..d.spec.configurations.len() {
        if let Some([left, right]) = projected(d, limit, i) {
            section.equation(Formula::equal(sheet.math(&left), sheet.math(&right)));
        }
    }
    section.text(ALONG);
    for hold in &d.spec.holds {
        let rate = rate_on_arrival(d, hold);
        let zero = expr::zero(rate.shape());
        section.equation(Formula::equal(sheet.math(&rate), Formula::Expr(zero)));
    }
    section.text(&no_change(d));
    for j in 0..d.spec.holds.len() {
        section.equation(sheet.math(&reported_multiplier(d, j)));
    }
    section.text(MIDDLE);
}

/// Sentences on the projection of momenta.
pub(super) const ON_ARRIVAL: &str = "At its end the step projects the momentum (RATTLE): it adds impulses along the constraint forces,";
pub(super) const ALONG: &str = "so that the velocity on the left is tangent to the constraints:";
/// The sentence before the equations for the reported multipliers; `MIDDLE` follows these equations.
pub(super) fn no_change(d: &Derivation) -> String {
    format!(
        "The projection does not change the configuration: without it, the multiplier of the next step would supply the same impulse. The reported multiplier at node {} is the multiplier of the step that ended there, combined with the impulse of the projection divided by the step size:",
        d.spec.time_index
    )
}
pub(super) const MIDDLE: &str = "It approximates the multiplier at the middle of that step to second order; its two parts contribute about half each.";

/// Substitutes velocities for variations.
fn velocities(d: &Derivation) -> Vec<(Letter, Expr)> {
    let all = d.spec.configurations.iter();
    all.zip(d.letters.variation.iter().zip(&d.letters.rate))
        .map(|(c, (xi, zeta))| {
            let velocity = crate::derive::continuous::velocity(&d.letters, c.group, *zeta);
            (at(*xi, Shift::HERE), velocity)
        })
        .collect()
}

/// The momentum of configuration `i` as a function of the velocity, and its value on arrival after the projection.
/// `None` if no constraint force acts on the configuration.
pub(super) fn projected(d: &Derivation, limit: &Limit, i: usize) -> Option<[Expr; 2]> {
    let s = &d.letters.symbols;
    let (c, xi) = (d.spec.configurations.get(i)?, d.letters.variation.get(i)?);
    let (velocities, algebra) = (velocities(d), Algebra::new(s));
    let along = |e: &Expr| {
        let y = expr::gradient(s, e, at(*xi, Shift::HERE));
        let covector = expr::substitute(s, &c.group.of_gradient(s, y), &velocities);
        shorter(&algebra, covector)
    };
    let impulses = (0..d.spec.holds.len()).map(|j| holds::rate_paired(d, j));
    let kick = along(&expr::sum(impulses.collect::<Vec<_>>(), Shape::SCALAR));
    if kick.is_zero() {
        return None;
    }
    let momentum = expr::here(s, *d.letters.node_momentum.get(i)?);
    let kinetic = expr::add(limit.kinetic.clone(), limit.linear.clone());
    Some([along(&kinetic), expr::sub(momentum, kick)])
}

/// The rate of change of the constraint function, as a function of the velocities.
pub(super) fn rate_on_arrival(d: &Derivation, hold: &Hold) -> Expr {
    expr::substitute(&d.letters.symbols, &holds::rate(d, hold), &velocities(d))
}

/// The reported multiplier of constraint `j`: the multiplier of the previous step minus the impulse of the projection
/// divided by the step size.
pub(super) fn reported_multiplier(d: &Derivation, j: usize) -> Expr {
    let s = &d.letters.symbols;
    let own = expr::here(s, d.spec.holds[j].multiplier);
    let own = expr::shift_time(s, &own, -Shift::NEXT.time);
    let impulse = expr::here(s, d.letters.held[j].variation);
    expr::sub(own, expr::quotient(impulse, expr::here(s, d.spec.step)))
}
