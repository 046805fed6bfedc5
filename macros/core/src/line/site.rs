//! Letters of an expanded chain, by the quantity and the site of which they are copies.

use super::{RepresentativeChain, SiteModel};
use crate::check::spec::Configuration;
use crate::expr::symbol::SymbolId;
use crate::expr::{self, Expr, Letter};
use crate::lattice::copy_name;

/// The site from which letters of neighbour terms are counted. It is the first site whose equation has all its
/// neighbours, for every width.
pub const BASE: usize = 1;

/// The prefix that turns the name of a configuration into the name of its node momentum.
const MOMENTUM: &str = "momentum of ";

/// The prefix that turns the name of a field into the name of its velocity.
const VELOCITY: &str = "velocity of ";

/// A copy of a quantity, the node momentum of a configuration, or the velocity of a field.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SiteCopy {
    /// The name of the quantity as stated.
    pub of: String,
    /// Its site.
    pub site: usize,
}

impl SiteCopy {
    /// The name of the declared quantity.
    pub fn plain(&self) -> &str {
        let of = self.momentum_of().or_else(|| self.velocity_of());
        of.unwrap_or(&self.of)
    }

    /// The field whose velocity it is.
    pub fn velocity_of(&self) -> Option<&str> {
        self.of.strip_prefix(VELOCITY)
    }

    /// The configuration whose momentum it is.
    pub fn momentum_of(&self) -> Option<&str> {
        self.of.strip_prefix(MOMENTUM)
    }
}

impl RepresentativeChain {
    /// The quantity and the site of a letter, if it is a copy.
    pub fn sited(&self, symbol: SymbolId) -> Option<SiteCopy> {
        let name = &self.d.letters.symbols.get(symbol).name;
        if let Some(copy) = self.unfolded.copy(name) {
            let (of, site) = (copy.of.clone(), copy.site);
            return Some(SiteCopy { of, site });
        }
        let momenta = &self.d.letters.node_momentum;
        let all = &self.d.spec.configurations;
        let (what, i) = match momenta.iter().position(|m| *m == symbol) {
            Some(i) => (MOMENTUM, i),
            None => {
                let is_own = |c: &Configuration| c.velocity == symbol && c.group.is_additive();
                (VELOCITY, all.iter().position(is_own)?)
            }
        };
        let c = all.get(i)?;
        let element = &self.d.letters.symbols.get(c.element).name;
        let copy = self.unfolded.copy(element)?;
        Some(SiteCopy {
            of: format!("{what}{}", copy.of),
            site: copy.site,
        })
    }

    /// The copy of a quantity at a site.
    pub fn copy(&self, of: &str, site: usize) -> Option<SymbolId> {
        let s = &self.d.letters.symbols;
        let (momentum, velocity) = (of.strip_prefix(MOMENTUM), of.strip_prefix(VELOCITY));
        let Some(element) = momentum.or(velocity) else {
            return s.find(&copy_name(of, site));
        };
        let element = s.find(&copy_name(element, site))?;
        let mut all = self.d.spec.configurations.iter();
        let i = all.position(|c| c.element == element)?;
        match velocity {
            Some(_) => Some(self.d.spec.configurations.get(i)?.velocity),
            None => self.d.letters.node_momentum.get(i).copied(),
        }
    }

    /// An expression of a single site in the letters of one of its copies, including momenta.
    pub fn of_site(&self, lone: &SiteModel, e: &Expr, site: usize) -> Option<Expr> {
        let s = &self.d.letters.symbols;
        let own = &lone.d.letters;
        let mut list: Vec<(Letter, Expr)> = Vec::new();
        for l in expr::letters(e) {
            let mut movers = lone.movers.iter();
            let mover = movers.find(|m| own.node_momentum.get(m.index) == Some(&l.symbol));
            let there = match mover {
                Some(m) => self.copy(&format!("{MOMENTUM}{}", m.name), site)?,
                None => {
                    let name = &own.symbols.get(l.symbol).name;
                    self.copy(name, site).or_else(|| s.find(name))?
                }
            };
            list.push((l, expr::letter(s, there, l.shift)));
        }
        Some(expr::substitute(s, e, &list))
    }

    /// An expression moved along the chain; `None` if a copy does not exist there.
    pub fn moved(&self, e: &Expr, by: isize) -> Option<Expr> {
        let s = &self.d.letters.symbols;
        let mut list: Vec<(Letter, Expr)> = Vec::new();
        for l in expr::letters(e) {
            let Some(at) = self.sited(l.symbol) else {
                continue;
            };
            let site = at.site.checked_add_signed(by)?;
            let there = self.copy(&at.of, site)?;
            list.push((l, expr::letter(s, there, l.shift)));
        }
        Some(expr::substitute(s, e, &list))
    }
}
