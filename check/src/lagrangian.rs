//! The derivative of the discrete Lagrangian of a step, as stated, by all variations of both nodes. Takes a scene; gives derivatives
//! with the bounds of their errors and the sizes of their terms.

use crate::evaluate::Here;
use crate::number::{Number, UNIT};
use crate::scene::{Scene, Varied};
use crate::setup::Setup;
use crate::sites::{Moving, indices};
use crate::stated::Stated;
use crate::terms::{Term, TermTime};
use clebsch_core::syntax::ast::NodeRule;

/// The derivative by one variable.
#[derive(Clone, Copy, Debug, Default)]
pub struct Derivative {
    /// Its value.
    pub value: f64,
    /// A bound on its error.
    pub error: f64,
    /// The sizes of its terms, summed.
    pub terms: f64,
}

/// The derivatives by all variables.
///
/// # Errors
/// A term cannot be evaluated.
pub fn derivatives(
    stated: &Stated,
    setup: &Setup,
    nodes: [&[f64]; 2],
    moving: &[Moving<'_>],
    varied: &Varied<'_>,
) -> Result<Vec<Derivative>, String> {
    let count: usize = moving.iter().map(|m| 2 * m.components).sum();
    let mut out = vec![Derivative::default(); count];
    let scene = Scene::new(stated, setup, nodes, varied).of_a_step();
    let by = match &stated.scale {
        None => None,
        Some(scale) => {
            let value = scene.value(scale, Here::at(0))?;
            let number = value.as_number().cloned();
            Some(number.ok_or("the scale is not a number")?)
        }
    };
    for term in &stated.terms {
        for index in indices(stated, setup, term, moving) {
            add(&scene, stated, term, Here::at(index), by.as_ref(), &mut out)?;
        }
    }
    if let (Some(label), false) = (stated.line, setup.periodic) {
        for (last, all) in stated.ends.iter().enumerate() {
            let Some(end) = all.get(setup.ends[last]) else {
                continue;
            };
            let site = match last {
                0 => 0,
                _ => setup.counts.get(label).copied().unwrap_or(0),
            };
            let scene = Scene::new(stated, setup, nodes, varied)
                .of_a_step()
                .with_end(&end.params, site);
            let here = Here {
                at_last: last == 1,
                ..Here::at(i64::try_from(site).unwrap_or(i64::MAX))
            };
            for term in &end.terms {
                add(&scene, stated, term, here, by.as_ref(), &mut out)?;
            }
        }
    }
    Ok(out)
}

/// Adds a term at an index, distributed over the nodes of the edge.
fn add(
    scene: &Scene<'_>,
    stated: &Stated,
    term: &Term,
    here: Here,
    by: Option<&Number>,
    out: &mut [Derivative],
) -> Result<(), String> {
    let mut one = |here: Here, weight: f64| -> Result<(), String> {
        let value = scene.value(&term.value, here)?;
        let number = value
            .as_number()
            .ok_or("a term of the Lagrangian is not a number")?;
        let number = match by {
            Some(by) => number.over(by),
            None => number.clone(),
        };
        for slope in &number.slopes {
            let of = usize::try_from(slope.of).unwrap_or(usize::MAX);
            let Some(sum) = out.get_mut(of) else { continue };
            let value = weight * slope.value;
            sum.value += value;
            sum.error += weight * slope.error + UNIT * sum.value.abs();
            sum.terms += value.abs();
        }
        Ok(())
    };
    let TermTime::Node(level) = term.lives else {
        return match term.lives {
            TermTime::Nowhere => Ok(()),
            _ => one(here, 1.0),
        };
    };
    match stated.rule {
        NodeRule::Symmetric => {
            one(here.later(-level), 0.5)?;
            one(here.later(1 - level), 0.5)
        }
        NodeRule::Incoming => one(here.later(1 - level), 1.0),
        NodeRule::Outgoing => one(here.later(-level), 1.0),
    }
}
