//! A model with labels as one program for every number of sites: the model of a single site, the contributions of
//! neighbours to its momentum, and the contributions of the ends. A short chain is expanded to prove that these are
//! all of its equations. Takes a model with labels; gives the parts of a stepper with loops over sites, or why the
//! model must be expanded.

mod chain_constraint;
mod coordinates;
mod functional_force;
mod inertia;
mod neighbour_force;
mod proof;
mod signs;
mod site;
mod site_model;
#[cfg(test)]
mod tests;
mod total;
mod velocity;
mod velocity_coupling;

pub use chain_constraint::{ChainConstraint, ConstraintResponse, Matrix, Reach};
pub use coordinates::{CoordinateKind, Coordinates, restated};
pub use functional_force::FunctionalForce;
pub use inertia::{Inertia, of_site as inertia_of_site};
pub use neighbour_force::{EndTerm, Force, NeighbourForce};
pub use signs::{Signs, Wall, signs};
pub use site::{BASE, SiteCopy};
pub use site_model::{SiteModel, SiteSolve, SiteUnknown};
pub use total::{Density, Total, totals_on};
pub use velocity_coupling::{Part, VelocityCoupling};

use crate::algebra::Rational;
use crate::derive::Outline;
use crate::diagnostic::Errors;
use crate::expr::symbol::{Role, SymbolId};
use crate::expr::{self, Expr};
use crate::lattice::{ChainConfig, ExpandedModel, Lattice, any_name};
use crate::pipeline;
use crate::syntax::ast::{Extent, Model, NodeRule, Statement};

/// A model with labels for every number of sites.
pub struct Line {
    /// The model as stated; configurations that are stored in coordinates are stated in those.
    pub model: Model,
    /// Configurations of groups that are stored in coordinates.
    pub coordinates: Vec<Coordinates>,
    /// Its labels.
    pub lattice: Lattice,
    /// The expanded chain; the letters of [`NeighbourForce`] are letters of its copies.
    pub representative: RepresentativeChain,
    /// The model of a single site, for each kind of sites.
    pub lone: Vec<SiteModel>,
    /// The forces of neighbours; terms with equal ranges are combined.
    pub pulls: Vec<NeighbourForce>,
    /// The contributions of neighbour terms with velocities to momenta.
    pub ties: Vec<VelocityCoupling>,
    /// The constraints.
    pub holds: Vec<ChainConstraint>,
    /// The response of constrained configurations to impulses, for each kind of sites.
    pub units: Vec<Vec<ConstraintResponse>>,
    /// The contributions of end conditions.
    pub ends: Vec<EndTerm>,
    /// Unit quaternions that occur in a term with their neighbours.
    pub signs: Vec<Signs>,
    /// The contributions of terms with functionals of all sites.
    pub meshed: Option<FunctionalForce>,
    /// Conserved totals.
    pub totals: Vec<Total>,
    /// The shares of a nodal term at the end of the incoming edge and at the start of the outgoing edge: together the
    /// whole.
    pub shares: [Rational; 2],
}

/// One choice of sites and ends, expanded.
pub struct RepresentativeChain {
    /// The choice.
    pub choice: ChainConfig,
    /// The expanded model of that choice.
    pub unfolded: ExpandedModel,
    /// The variations of its copies, and their equations.
    pub d: Outline,
}

/// The reason why a model cannot be one program for every number of sites: it is then expanded, body by body.
#[derive(Debug)]
pub enum Refused {
    /// The model itself contains errors.
    Model(Errors),
    /// Loops over sites do not support its form; the reason in words.
    Form(String),
}

impl From<Errors> for Refused {
    fn from(errors: Errors) -> Refused {
        Refused::Model(errors)
    }
}

impl Line {
    /// The program of a model with labels.
    ///
    /// # Errors
    /// [`Refused`] if the model is wrong, or must be solved together along the chain.
    pub fn of(model: &Model) -> Result<Line, Refused> {
        let lattice = Lattice::read(model)?;
        stands_alone(model, &lattice)?;
        if let Some((restated, coordinates)) = coordinates::in_coordinates(model, &lattice)? {
            let lattice = Lattice::read(&restated)?;
            return Ok(Line {
                coordinates,
                ..Line::of_stated(&restated, lattice)?
            });
        }
        Line::of_stated(model, lattice)
    }

    /// The program of a model in fields and rotations.
    fn of_stated(model: &Model, lattice: Lattice) -> Result<Line, Refused> {
        let choice = pipeline::representative(model, &lattice)?;
        let representative = written(model, &lattice, choice)?;
        without_clocks(&representative)?;
        let (pulls, ties) = neighbour_force::pulls(&lattice, &representative)?;
        let lone = site_model::lone(model, &lattice, &representative, &ties)?;
        let meshed = functional_force::meshed(&lattice, &representative)?;
        let holds = chain_constraint::held(&lattice, &representative, &lone)?;
        let units = lone.iter().map(|l| chain_constraint::units(l, &holds));
        let units = units.collect::<Result<Vec<_>, Refused>>()?;
        let ends = neighbour_force::ends(model, &lattice, &representative.choice)?;
        let signs = signs::of_parts(&lattice, &representative, &ends)?;
        let mut pulls = pulls;
        if !holds.is_empty() {
            pulls.extend(neighbour_force::collecting(&lattice, &pulls, &ends));
        }
        let mut totals = total::totals(model, &lattice, &representative)?;
        if let Some(m) = &meshed {
            totals.extend(total::beside_functionals(
                &lattice,
                &representative,
                &lone,
                m,
            ));
        }
        // A total is computed from a state, which does not contain the step size.
        let holds_step =
            |e: &Expr| expr::contains_role(&representative.d.letters.symbols, e, Role::Step);
        totals.retain(|t| {
            let mut densities = t.densities.iter();
            !densities.any(|d| {
                holds_step(&d.value) || representative.is_turned_by_walls(&lattice, &d.value)
            })
        });
        total::name_apart(&lattice, &mut totals);
        let shares = representative.shares();
        let line = Line {
            model: model.clone(),
            coordinates: Vec::new(),
            lattice,
            representative,
            lone,
            pulls,
            ties,
            holds,
            units,
            ends,
            signs,
            meshed,
            totals,
            shares,
        };
        line.ends_are_collected()?;
        line.holds_are_alone()?;
        line.prove()?;
        Ok(line)
    }

    /// Checks that ends act only on configurations on which neighbours act, and that prescribed configurations are
    /// solved for by themselves.
    fn ends_are_collected(&self) -> Result<(), Refused> {
        let pulled = |name: &str| {
            let mut all = self.pulls.iter().flat_map(|p| &p.forces);
            all.any(|f| f.on == name)
        };
        let mut acted = self.ends.iter().flat_map(|e| &e.forces);
        if let Some(alone) = acted.find(|f| !pulled(&f.on)) {
            let words = format!(
                "a term of an end acts on `{}`, but no term between neighbours does",
                alone.on
            );
            return Err(Refused::Form(words));
        }
        for alternative in self.lattice.ends.iter().flatten() {
            let is_held = |name: &str| alternative.given.iter().any(|n| n.text == name);
            let held = alternative.given.iter();
            for (lone, mover) in held.filter_map(|name| self.mover(&name.text)) {
                let block = lone.blocks.iter().find(|b| b.contains(&mover.index));
                let mut others = lone.movers.iter().filter(|m| {
                    let beside = block.is_some_and(|b| b.contains(&m.index));
                    beside && !is_held(&m.name)
                });
                if mover.how.added().is_some()
                    && let Some(other) = others.next()
                {
                    let words = format!(
                        "an end condition prescribes `{}`, whose velocity is solved together with the velocity of `{}`, which \
                         it does not prescribe",
                        mover.name, other.name
                    );
                    return Err(Refused::Form(words));
                }
            }
        }
        Ok(())
    }

    /// Multipliers are supported only if velocities are not coupled along the chain.
    fn holds_are_alone(&self) -> Result<(), Refused> {
        let refused = |words: &str| Err(Refused::Form(words.to_owned()));
        if self.holds.is_empty() {
            return Ok(());
        }
        if !self.ties.is_empty() {
            return refused(
                "the model combines a `hold` constraint with a term that contains velocities of neighbours",
            );
        }
        if self.meshed.is_some() {
            return refused("the model combines a `hold` constraint with functionals of all sites");
        }
        let domains = self.lattice.quantities.iter();
        match domains.into_iter().any(|q| q.domain.is_some()) {
            true => refused("a `hold` constraint applies to particles in a domain"),
            false => Ok(()),
        }
    }

    /// Whether the momentum of a configuration contains velocities of neighbours.
    pub fn is_tied(&self, name: &str) -> bool {
        let mut parts = self.ties.iter().flat_map(|t| &t.parts);
        parts.any(|p| p.on == name)
    }

    /// The unknown with this name, and the model of its site.
    pub fn mover(&self, name: &str) -> Option<(&SiteModel, &SiteUnknown)> {
        self.lone
            .iter()
            .find_map(|l| Some((l, l.movers.iter().find(|m| m.name == name)?)))
    }

    /// The largest number of sites that terms reach beyond the last one.
    pub fn beyond(&self) -> usize {
        let tied = self.ties.iter().map(|t| t.width);
        let pulled = self.pulls.iter().map(|p| p.width);
        let held = self.holds.iter().map(|h| h.width);
        pulled.chain(tied).chain(held).max().unwrap_or(0)
    }
}

impl RepresentativeChain {
    /// The shares of a nodal term at the end of the incoming edge and at the start of the outgoing edge.
    fn shares(&self) -> [Rational; 2] {
        let (all, none) = (Rational::integer(1), Rational::integer(0));
        match self.d.spec.node_rule {
            NodeRule::Symmetric => [Rational::HALF; 2],
            NodeRule::Incoming => [all, none],
            NodeRule::Outgoing => [none, all],
        }
    }
}

fn written(
    model: &Model,
    lattice: &Lattice,
    choice: ChainConfig,
) -> Result<RepresentativeChain, Errors> {
    let (unfolded, d) = pipeline::outline_lattice(model, lattice, &choice)?;
    Ok(RepresentativeChain {
        choice,
        unfolded,
        d,
    })
}

/// Checks that every configuration belongs to sites, and that nothing scales the action.
fn stands_alone(model: &Model, lattice: &Lattice) -> Result<(), Refused> {
    let refused = |words: &str| Err(Refused::Form(words.to_owned()));
    for statement in &model.statements {
        let without_site = match statement {
            Statement::Group { name, .. } => lattice.find(&name.text).is_none(),
            Statement::Field { names, .. } | Statement::Advected { names, .. } => {
                names.iter().any(|n| lattice.find(&n.text).is_none())
            }
            Statement::Scale(_) => return refused("the model has a `scale` statement"),
            Statement::Assume { left, right, .. } => {
                let sited = |n: &str| lattice.find(n).is_some();
                if any_name(left, &sited) || any_name(right, &sited) {
                    return refused("an assumption contains a quantity that differs between sites");
                }
                false
            }
            Statement::Dim { .. } => return refused("the size of a shape is a name"),
            _ => false,
        };
        if without_site {
            return refused("a moving quantity is not declared at sites");
        }
    }
    Ok(())
}

/// Rejects clocks, which advance with the step size only: loops over sites store no time.
fn without_clocks(representative: &RepresentativeChain) -> Result<(), Refused> {
    let spec = &representative.d.spec;
    match spec.clocks().first() {
        None => Ok(()),
        Some(clock) => Err(Refused::Form(format!(
            "`{}` advances with the step by itself",
            spec.symbols.get(*clock).name
        ))),
    }
}

impl RepresentativeChain {
    /// Whether walls change a value: it contains the momentum of positions in a box.
    pub(crate) fn is_turned_by_walls(&self, lattice: &Lattice, e: &Expr) -> bool {
        let mut letters = expr::letters(e).into_iter();
        letters.any(|l| {
            let Some(at) = self.sited(l.symbol) else {
                return false;
            };
            let of = at.momentum_of().and_then(|of| lattice.find(of));
            of.is_some_and(|q| matches!(q.domain, Some(Extent::Box(_))))
        })
    }

    /// An expression in the letters of another chain of the same model, with copies of equal sites.
    pub(crate) fn in_letters_of(&self, other: &RepresentativeChain, e: &Expr) -> Option<Expr> {
        let (own, s) = (&self.d.letters.symbols, &other.d.letters.symbols);
        let there = |id: SymbolId| match self.sited(id) {
            Some(at) => other.copy(&at.of, at.site),
            None => s.find(&own.get(id).name),
        };
        let mut list = Vec::new();
        for l in expr::letters(e) {
            list.push((l, expr::letter(s, there(l.symbol)?, l.shift)));
        }
        Some(expr::substitute(s, e, &list))
    }
}
