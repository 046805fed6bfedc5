//! Reduction of a model that is stated by its configuration at both ends of a step: `next(Λ)` is
//! put in as `Λ Ω` (or `ω Λ`), and what is left of `Λ` is absorbed by parameters that are carried
//! along, as `z` by `Λ^T z`. Takes a checked model; gives the reduced one, with the advected
//! quantities that the statement holds, or the term that breaks the invariance.

mod carry;
mod element;
mod relative;
mod segments;
mod settle;
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
    let (Ok(mut new_edge), Ok(mut new_nodal)) = (r.reduced(&edge), r.reduced(&nodal)) else {
        return Err(refusal(&spec, &algebra, &forward));
    };
    // A plane holds the vector of its normal: with the planes known from the start, the vector is
    // not carried a second time.
    let planes = r.planes();
    if !planes.is_empty() {
        r = Reducer::new(&spec, &algebra);
        r.declare_all(&planes);
        if let (Ok(e), Ok(n)) = (r.reduced(&edge), r.reduced(&nodal)) {
            (new_edge, new_nodal) = (e, n);
        }
    }
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

fn velocities_remain(spec: &Spec) -> Result<(), Errors> {
    let used = expr::letters(&spec.lagrangian);
    let mut errors = Errors::new();
    for c in &spec.configurations {
        if !used.contains(&at(c.velocity, Shift::HERE)) {
            let name = &spec.symbols.get(c.element).name;
            let example = match c.group {
                Group::SpecialOrthogonal(_) | Group::GeneralLinear(_) => {
                    format!("-tr(J*{name}^T*next({name}))/h")
                }
                Group::UnitQuaternions => format!("-(4*c/h)*re({name}^T*next({name}))"),
                Group::RigidMotions => format!("-tr(J*rot({name})^T*rot(next({name})))/h"),
            };
            errors.push(
                Diagnostic::new(
                    spec.lagrangian_place,
                    format!("after reduction nothing is left that the velocity of `{name}` moves"),
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
        None => "the reduction of this Lagrangian cannot be proved".to_owned(),
    };
    Diagnostic::new(crate::derive::place_of_most(spec), message)
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
        let Err(left) = Reducer::new(spec, algebra).reduced(&e) else {
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
        let words = match c.side {
            Side::Body => format!("next({g}) = {g} * {w}"),
            Side::Spatial => format!("next({g}) = {w} * {g}"),
        };
        let acting = match c.group {
            Group::UnitQuaternions => format!("rot({g})"),
            Group::SpecialOrthogonal(_) | Group::GeneralLinear(_) | Group::RigidMotions => {
                g.clone()
            }
        };
        let example = match c.side {
            Side::Body => format!("dot(z, {acting}*v)"),
            Side::Spatial => format!("dot({acting}*v, z)"),
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
        errors.push(too_large(spec, algebra));
    }
    errors
}
