//! Reduction of a model that is stated by its configuration at both ends of a step: `next(Λ)` becomes `Λ Ω` (or `ω
//! Λ`), and parameters such as `z` absorb the remaining `Λ`: `Λ^T z` becomes an advected quantity. Takes a checked
//! model; gives the reduced model with these advected quantities. For fields, `next(X)` becomes `X + ΔX`.

mod cancelled_elements;
mod carry;
mod element;
mod increments;
mod relative;
mod segments;
mod terms;
#[cfg(test)]
mod tests;

use crate::algebra::{Algebra, Decision};
use crate::check::spec::{Advected, Reduction, Spec};
use crate::derive::action;
use crate::derive::balance::shorter;
use crate::derive::variation::at;
use crate::diagnostic::{Diagnostic, Errors};
use crate::expr::{self, Expr, Letter, Shift};
pub(crate) use increments::is_singular;
use terms::Reducer;

/// The reduced model; a model that is stated by velocities is unchanged. If no parameter absorbs a configuration, the
/// statement is unchanged, and the equations contain the configuration.
pub fn reduce(mut spec: Spec) -> Result<Spec, Errors> {
    let ends = increments::ends(&spec);
    let symbols = spec.symbols.clone();
    let algebra = Algebra::new(&symbols);
    if !ends.is_empty() {
        spec.lagrangian = increments::gathered(&spec, &algebra, &ends);
    }
    put_velocities_in(&mut spec, &algebra, &ends);
    let (edge, nodal) = action::split(&symbols, &spec.lagrangian);
    let unreduced = is_unreduced(&spec, &edge);
    if !unreduced && ends.is_empty() {
        return Ok(spec);
    }
    let edge = increments::by_increments(&spec, &algebra, &ends, &edge);
    if !unreduced {
        spec.lagrangian = expr::add(edge.clone(), nodal.clone());
        spec.reduction = Some(Reduction {
            edge,
            nodal,
            known: Decision::NormalForm,
            carries: false,
        });
        velocities_remain(&spec)?;
        return Ok(spec);
    }
    let forward = configurations_at_the_end(&spec);
    let [edge, nodal] = [edge, nodal].map(|e| expr::substitute(&symbols, &e, &forward));
    let mut r = Reducer::new(&spec, &algebra);
    let (mut new_edge, mut new_nodal) = (r.as_far_as_possible(&edge), r.as_far_as_possible(&nodal));
    if algebra.exhausted() {
        return Err(too_large(&spec, &algebra).into());
    }
    // A plane contains the vector of its normal: if planes are known from the start, the vector is not advected a
    // second time.
    let planes = r.planes();
    if !planes.is_empty() {
        r = Reducer::new(&spec, &algebra);
        r.declare_all(&planes);
        (new_edge, new_nodal) = (r.as_far_as_possible(&edge), r.as_far_as_possible(&nodal));
    }
    let (symbols, carried) = (r.symbols, r.carried);
    // The proof: with the definitions substituted, the reduced Lagrangian equals the stated one.
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
        return Err(too_large(&spec, &proof).into());
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
        carries: true,
    });
    velocities_remain(&spec)?;
    Ok(spec)
}

/// Constraints of advected quantities that contain a configuration at the end of the edge, expressed by its velocity:
/// `Y + next(X) - X` becomes `Y + ΔX`. Only this form shows that they state an action.
fn put_velocities_in(spec: &mut Spec, algebra: &Algebra, ends: &[(Letter, Expr)]) {
    let symbols = algebra.symbols();
    let forward = configurations_at_the_end(spec);
    let written: Vec<Expr> = spec
        .advected
        .iter()
        .map(|a| {
            if !forward.iter().any(|(l, _)| expr::contains(&a.update, *l)) {
                return a.update.clone();
            }
            let put = increments::by_increments(spec, algebra, ends, &a.update);
            let put = expr::substitute(symbols, &put, &forward);
            shorter(algebra, put)
        })
        .collect();
    for (a, update) in spec.advected.iter_mut().zip(written) {
        a.update = update;
    }
}

/// Every configuration at the end of the edge, expressed by its constraint.
fn configurations_at_the_end(spec: &Spec) -> Vec<(Letter, Expr)> {
    let list = spec.configurations.iter();
    list.map(|c| (at(c.element, Shift::NEXT), c.update.clone()))
        .collect()
}

/// Whether some term of the edge contains the element at its end instead of a velocity.
fn is_unreduced(spec: &Spec, edge: &Expr) -> bool {
    let groups = spec
        .configurations
        .iter()
        .filter(|c| !c.group.is_additive());
    groups
        .into_iter()
        .any(|c| expr::contains(edge, at(c.element, Shift::NEXT)))
}

fn velocities_remain(spec: &Spec) -> Result<(), Errors> {
    let used = expr::letters(&spec.lagrangian);
    let mut errors = Errors::new();
    for c in &spec.configurations {
        if !spec.of_site && !used.contains(&at(c.velocity, Shift::HERE)) {
            let name = &spec.symbols.get(c.element).name;
            let example = c.group.kinetic_example(name);
            errors.push(
                Diagnostic::new(
                    spec.lagrangian_place,
                    format!("after reduction, no term contains the velocity of `{name}`"),
                )
                .help(format!("add a kinetic term, for example `{example}`")),
            );
        }
    }
    errors.propagate()
}

fn too_large(spec: &Spec, algebra: &Algebra) -> Diagnostic {
    let message = match algebra.excess() {
        Some(excess) => format!("the reduction of this Lagrangian is too large: {excess}"),
        None => "clebsch cannot prove the reduction of this Lagrangian".to_owned(),
    };
    Diagnostic::new(crate::derive::place_of_most(spec), message).help(
        "write the reduced model, with velocities and advected quantities instead of `next(...)`",
    )
}
