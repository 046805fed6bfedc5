//! The kinetic energy in the limit of small steps, if neighbour terms contain velocities: momenta as linear functions
//! of velocities, for single sites and for those terms. Takes limits; gives the derivatives that are inverted for all
//! sites together.

use super::{RepresentativeChain, SiteModel, VelocityCoupling, velocity};
use crate::algebra::Algebra;
use crate::check::spec::Spec;
use crate::derive::Letters;
use crate::derive::action::Action;
use crate::derive::limit::{self, Limit};
use crate::expr::shape::Shape;
use crate::expr::{self, Expr, Letter, Shift};

/// Momenta that are linear in velocities.
#[derive(Clone, Debug)]
pub struct Inertia {
    /// The momentum of each configuration at zero velocity.
    pub at_rest: Vec<Expr>,
    /// For each configuration, the derivative with respect to the velocities of each; one column per axis.
    pub columns: Vec<Vec<Expr>>,
}

/// The inertia of these configurations in a limit.
fn of(spec: &Spec, letters: &Letters, limit: &Limit, members: &[usize]) -> Inertia {
    let s = &letters.symbols;
    let gradient = |of: &Expr, i: usize| {
        let xi = Letter {
            symbol: letters.variation[i],
            shift: Shift::HERE,
        };
        let c = &spec.configurations[i];
        c.group.of_gradient(s, expr::gradient(s, of, xi))
    };
    let columns = members.iter().map(|i| {
        let momentum = gradient(&limit.kinetic, *i);
        let by = members.iter().flat_map(|j| {
            let c = &spec.configurations[*j];
            velocity::columns_of_limit(s, &momentum, c, letters.variation[*j])
        });
        by.collect()
    });
    Inertia {
        columns: columns.collect(),
        at_rest: members
            .iter()
            .map(|i| gradient(&limit.linear, *i))
            .collect(),
    }
}

/// The inertia of configurations of a single site, if there is a limit.
pub fn of_site(lone: &SiteModel, members: &[usize]) -> Option<Inertia> {
    let limit = lone.d.limit.as_ref().ok()?;
    Some(of(&lone.d.spec, &lone.d.letters, limit, members))
}

/// The inertia of a term of neighbours, its parts in order; `None` if its limit does not exist or contains more
/// than velocities.
pub(super) fn of_tie(part: &RepresentativeChain, tie: &VelocityCoupling) -> Option<Inertia> {
    let d = &part.d;
    let algebra = Algebra::new(&d.letters.symbols);
    let none = || expr::zero(Shape::SCALAR);
    let action = Action {
        total: tie.terms.clone(),
        edge: tie.terms.clone(),
        nodal: none(),
        distributed: none(),
    };
    let limit = limit::limit(&d.spec, &d.letters, &action, &d.variations, &[], &algebra).ok()?;
    if !limit.potential.is_zero() {
        return None;
    }
    let all = &d.spec.configurations;
    let place = |p: &super::Part| all.iter().position(|c| c.velocity == p.velocity.symbol);
    let members: Option<Vec<usize>> = tie.parts.iter().map(place).collect();
    Some(of(&d.spec, &d.letters, &limit, &members?))
}
