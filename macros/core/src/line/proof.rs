//! Proves that the model of a single site and the contributions of neighbours are the whole equation of a site. The
//! proof uses the expanded chain, at a site with all its neighbours.

use super::{Line, Refused, SiteModel, SiteUnknown};
use crate::algebra::Algebra;
use crate::expr::shape::Shape;
use crate::expr::{self, Expr, Shift};
use crate::lattice::Sites;

impl Line {
    /// Proves it for every configuration.
    ///
    /// # Errors
    /// [`Refused::Form`] if the two cannot be shown to be equal.
    pub(super) fn prove(&self) -> Result<(), Refused> {
        for lone in &self.lone {
            for mover in &lone.movers {
                self.prove_one(lone, mover)?;
            }
        }
        Ok(())
    }

    fn prove_one(&self, lone: &SiteModel, mover: &SiteUnknown) -> Result<(), Refused> {
        let refused = || {
            Refused::Form(format!(
                "clebsch cannot prove that the parts of a site and of its neighbours add up to the equation of `{name}`: it \
                 recognises only some terms that contain both ends of a step, such as terms in the velocity at the middle \
                 of the step",
                name = mover.name
            ))
        };
        let part = &self.representative;
        let d = &part.d;
        let s = &d.letters.symbols;
        // The site in the middle of the expanded chain.
        let site = match lone.sites {
            Sites::Members => 0,
            Sites::Nodes | Sites::Segments => self.beyond() + 1,
        };
        let element = part.copy(&mover.name, site).ok_or_else(refused)?;
        let mut configurations = d.spec.configurations.iter();
        let i = configurations
            .position(|c| c.element == element)
            .ok_or_else(refused)?;
        let (whole, own) = (&d.balances[i], &lone.d.balances[mover.index]);
        let here = |e: &Expr| part.of_site(lone, e, site).ok_or_else(refused);
        let pulled = self.pulled(&mover.name, site).ok_or_else(refused)?;
        let next = expr::shift_time(s, &pulled, Shift::NEXT.time);
        let [arriving, leaving] = self.shares;
        let algebra = Algebra::new(s);
        let tied = self.tied(&mover.name, site).ok_or_else(refused)?;
        let zero = |e: Expr| {
            let by_start = || expr::substitute(s, &e, &d.spec.end_of_edge());
            tied.is_none() && algebra.is_zero(&d.defined(&e))
                || algebra.is_zero(&d.defined(&by_start()))
        };
        let without = |e: Expr, own: usize| match &tied {
            Some(both) => expr::sub(e, both[own].clone()),
            None => e,
        };
        let out = expr::sub(
            whole.outgoing.clone(),
            here(&lone.outline.defined(&own.outgoing))?,
        );
        let into = expr::sub(
            whole.incoming.clone(),
            here(&lone.outline.defined(&own.incoming))?,
        );
        let (out, into) = (without(out, 0), without(into, 1));
        let reacted = self.reacted(&mover.name, site).ok_or_else(refused)?;
        let mut written = super::chain_constraint::written_out(part, i);
        written.push(expr::neg(reacted));
        let reactions = expr::sum(written, whole.outgoing.shape());
        let equal = zero(expr::add(out, expr::scale(leaving, pulled)))
            && zero(expr::sub(into, expr::scale(arriving, next)))
            && zero(reactions);
        equal.then_some(()).ok_or_else(refused)
    }

    /// The contributions of neighbour terms with velocities to the momenta of the outgoing and of the incoming edge.
    #[allow(clippy::option_option)] // Outer option: whether its letters exist. Inner option: whether there are such terms.
    fn tied(&self, name: &str, site: usize) -> Option<Option<[Expr; 2]>> {
        let mut out: Option<[Expr; 2]> = None;
        for own in self
            .ties
            .iter()
            .flat_map(|t| &t.parts)
            .filter(|p| p.on == name)
        {
            let by =
                isize::try_from(site).ok()? - isize::try_from(own.site + super::site::BASE).ok()?;
            let moved = |e: &Expr| self.representative.moved(e, by);
            let (leaving, coming) = (moved(&own.momentum)?, moved(&own.incoming)?);
            out = Some(match out {
                None => [leaving, coming],
                Some([a, b]) => [expr::add(a, leaving), expr::add(b, coming)],
            });
        }
        Some(out)
    }

    /// The contributions of constraints at a site of the representative, for their multipliers there.
    fn reacted(&self, name: &str, site: usize) -> Option<Expr> {
        let part = &self.representative;
        let mut terms = Vec::new();
        let (lone, mover) = self.mover(name)?;
        let shape = lone.d.balances[mover.index].outgoing.shape();
        for held in &self.holds {
            for r in held.reaches.iter().filter(|r| r.on == name) {
                let index = site.checked_sub(r.site);
                let one_each = held.beside.is_none();
                if index.is_none_or(|i| one_each && part.copy(&held.name, i).is_none()) {
                    continue;
                }
                let by = isize::try_from(site).ok()?
                    - isize::try_from(r.site + super::site::BASE).ok()?;
                terms.push(part.moved(&r.reaction, by)?);
            }
        }
        Some(expr::sum(terms, shape))
    }

    /// The contributions of neighbours at a site of the representative.
    fn pulled(&self, name: &str, site: usize) -> Option<Expr> {
        let part = &self.representative;
        let mut terms = Vec::new();
        let mut shape = Shape::SCALAR;
        for pull in &self.pulls {
            for f in pull.forces.iter().filter(|f| f.on == name) {
                let by = isize::try_from(site).ok()?
                    - isize::try_from(f.site + super::site::BASE).ok()?;
                shape = f.value.shape();
                terms.push(part.moved(&f.value, by)?);
            }
        }
        let of_functionals = self.meshed.iter().flat_map(|m| &m.forces);
        for f in of_functionals.filter(|f| f.on == name) {
            shape = f.value.shape();
            terms.push(f.value.clone());
        }
        if terms.is_empty() {
            let (lone, mover) = self.mover(name)?;
            shape = lone.d.balances[mover.index].outgoing.shape();
        }
        Some(expr::sum(terms, shape))
    }
}
