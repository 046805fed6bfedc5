//! Reduction of a model that is stated by its configuration at both ends of a step: `next(Λ)` is
//! put in as `Λ Ω` (or `ω Λ`), and what is left of `Λ` is absorbed by parameters that are carried
//! along, as `z` by `Λ^T z`. Takes a checked model; gives the reduced one, with the advected
//! quantities that the statement holds, or the term that breaks the invariance.

mod segments;
mod terms;
#[cfg(test)]
mod tests;

use crate::algebra::Algebra;
use crate::check::spec::{Advected, Group, Reduction, Side, Spec};
use crate::derive::action;
use crate::derive::variation::at;
use crate::diagnostic::{Diagnostic, Errors};
use crate::expr::{self, Expr, Letter, Shift};
use terms::Reducer;

/// The reduced model; a model that has its velocities already is given back as it is.
pub fn reduce(mut spec: Spec) -> Result<Spec, Errors> {
    if !is_unreduced(&spec) {
        return Ok(spec);
    }
    matrix_groups_only(&spec)?;
    let symbols = spec.symbols.clone();
    let algebra = Algebra::new(&symbols);
    let forward: Vec<(Letter, Expr)> = spec
        .configurations
        .iter()
        .map(|c| (at(c.element, Shift::NEXT), c.update.clone()))
        .collect();
    let (edge, nodal) = action::split(&symbols, &spec.lagrangian);
    let [edge, nodal] = [edge, nodal].map(|e| expr::substitute(&symbols, &e, &forward));
    let mut r = Reducer::new(&spec, &algebra);
    let (Ok(new_edge), Ok(new_nodal)) = (r.number(&edge), r.number(&nodal)) else {
        return Err(refusal(&spec, &algebra, &forward));
    };
    let (symbols, carried) = (r.symbols, r.carried);
    // The proof: with the definitions put back, the reduced Lagrangian is the one that was stated.
    let definitions: Vec<(Letter, Expr)> = carried
        .iter()
        .map(|c| (at(c.quantity, Shift::HERE), c.definition.clone()))
        .collect();
    let proof = Algebra::new(&symbols);
    let back = |e: &Expr| expr::substitute(&symbols, e, &definitions);
    let difference = expr::sub(
        expr::add(back(&new_edge), back(&new_nodal)),
        expr::add(edge, nodal),
    );
    let Some(known) = proof.zero(&difference) else {
        return Err(too_large(&spec).into());
    };
    let place = spec.configurations.first().map(|c| (c.place, c.name_place));
    let (place, name_place) = place.unwrap_or((spec.lagrangian_place, spec.name_place));
    spec.advected.extend(carried.into_iter().map(|c| Advected {
        quantity: c.quantity,
        definition: Some(c.definition),
        definition_place: None,
        update: c.update,
        place,
        name_place,
        found: true,
    }));
    spec.symbols = symbols;
    spec.lagrangian = expr::add(new_edge.clone(), new_nodal.clone());
    spec.reduction = Some(Reduction {
        edge: new_edge,
        nodal: new_nodal,
        known,
    });
    velocities_remain(&spec)?;
    Ok(spec)
}

/// Whether some velocity is missing and the element at the end of the step stands in its place.
fn is_unreduced(spec: &Spec) -> bool {
    let used = expr::letters(&spec.lagrangian);
    spec.configurations.iter().any(|c| {
        let has = |symbol, shift| used.contains(&at(symbol, shift));
        !has(c.velocity, Shift::HERE) && has(c.element, Shift::NEXT)
    })
}

/// Quaternions and rigid motions act on vectors through maps that segments of words do not see.
fn matrix_groups_only(spec: &Spec) -> Result<(), Errors> {
    let other = spec
        .configurations
        .iter()
        .find(|c| matches!(c.group, Group::UnitQuaternions | Group::RigidMotions));
    match other {
        None => Ok(()),
        Some(c) => Err(Diagnostic::new(
            c.group_place,
            "a model stated by `next(...)` of its configuration is reduced for SO<n> and GL<n> only",
        )
        .help("state the reduced model: velocities and advected quantities")
        .into()),
    }
}

fn velocities_remain(spec: &Spec) -> Result<(), Errors> {
    let used = expr::letters(&spec.lagrangian);
    let mut errors = Errors::new();
    for c in &spec.configurations {
        if !used.contains(&at(c.velocity, Shift::HERE)) {
            let name = &spec.symbols.get(c.element).name;
            errors.push(
                Diagnostic::new(
                    spec.lagrangian_place,
                    format!("after reduction nothing is left that the velocity of `{name}` moves"),
                )
                .help(format!(
                    "add a kinetic term, for example `-tr(J*{name}^T*next({name}))/h`"
                )),
            );
        }
    }
    errors.propagate()
}

fn too_large(spec: &Spec) -> Diagnostic {
    Diagnostic::new(
        spec.lagrangian_place,
        "the reduction of this Lagrangian cannot be proved: its normal form does not fit",
    )
    .help("state the reduced model: velocities and advected quantities in place of `next(...)`")
}

/// The terms that break the invariance, each with what is left over.
fn refusal(spec: &Spec, algebra: &Algebra, forward: &[(Letter, Expr)]) -> Errors {
    let s = &spec.symbols;
    let style = crate::print::Style::new(&spec.time_index);
    let mut errors = Errors::new();
    let whole = (spec.lagrangian.clone(), spec.lagrangian_place);
    for (e, place) in spec.terms.iter().chain([&whole]) {
        if *e == whole.0 && errors.iter().next().is_some() {
            continue;
        }
        let e = expr::substitute(s, e, forward);
        let Err(left) = Reducer::new(spec, algebra).number(&e) else {
            continue;
        };
        let text = crate::print::expression(&left.0, s, &style, crate::print::Format::Text);
        let letters = expr::letters(&left.0);
        let of = letters.iter().find_map(|l| {
            let mut list = spec.configurations.iter();
            list.find(|c| c.element == l.symbol)
        });
        let Some(c) = of.or(spec.configurations.first()) else {
            continue;
        };
        let (g, w) = (&s.get(c.element).name, &s.get(c.velocity).name);
        let (words, example) = match c.side {
            Side::Body => (format!("next({g}) = {g} * {w}"), format!("dot(z, {g}*v)")),
            Side::Spatial => (format!("next({g}) = {w} * {g}"), format!("dot({g}*v, z)")),
        };
        errors.push(
            Diagnostic::new(
                *place,
                format!("this term is not invariant: with `{words}` it leaves {text}, where no parameter absorbs `{g}`"),
            )
            .help(format!("bring `{g}` in with a parameter beside it, which is then carried along, as in `{example}`; or state the reconstruction on the other side, or the reduced model in velocities and advected quantities")),
        );
    }
    if errors.iter().next().is_none() {
        errors.push(too_large(spec));
    }
    errors
}
