//! Scalars summed over all sites: `s D A(X)[u]` and `<u, (D A(X))^T[s]>` differ at a site but have the same sum. The
//! second form decides whether two such scalars are equal. Identities of an action, its variation and energies are of
//! this kind; the equations of a site contain no derivative along a direction.

use crate::algebra::monomial::{Atom, Monomial};
use crate::algebra::poly::{Poly, Term};
use crate::algebra::{Algebra, Rational};
use crate::expr::{self, Expr, Node, Reach};

/// The largest number of rounds; each removes one derivative along a direction.
const MOST: usize = 16;

impl Algebra<'_> {
    /// The scalar with every derivative of a functional of all sites as a pull-back; `None` if it contains no such
    /// derivative.
    pub(in crate::algebra) fn by_parts(&self, number: &Poly) -> Option<Poly> {
        let functionals = self.symbols.functionals();
        let of_sites = functionals.iter().any(|f| f.reach == Reach::Sites);
        if !of_sites || !number.shape.is_scalar() {
            return None;
        }
        let mut all = number.clone();
        let mut changed = false;
        for _ in 0..MOST {
            let mut found = false;
            let terms = all.terms.iter().map(|(t, c)| match self.term_by_parts(t) {
                Some(e) => {
                    found = true;
                    expr::mul(expr::number(*c), e)
                }
                None => self.raise(&Poly::term(all.shape, *c, t.clone())),
            });
            let terms: Vec<Expr> = terms.collect();
            if !found || self.exhausted() {
                break;
            }
            changed = true;
            all = self.lower(&expr::sum(terms, all.shape));
        }
        changed.then_some(all)
    }

    /// Writes a term with a derivative along a direction as a pull-back; its seed contains all other factors.
    fn term_by_parts(&self, t: &Term) -> Option<Expr> {
        let along = |atom: &Atom| {
            let Atom::Given(_) = atom else {
                return None;
            };
            let value = self.raise_atom(atom);
            let Node::Given(a) = value.node() else {
                return None;
            };
            let of_sites = self.symbols.functional(a.functional).reach == Reach::Sites;
            (of_sites && !a.along.is_empty()).then(|| a.clone())
        };
        let place = t
            .monomial
            .iter()
            .position(|(atom, power)| *power == Rational::ONE && along(atom).is_some())?;
        let mut a = along(&t.monomial.get(place)?.0)?;
        let (which, amount) = a.along.pop()?;
        let rest: Monomial = t
            .monomial
            .iter()
            .enumerate()
            .filter(|(i, _)| *i != place)
            .map(|(_, x)| x.clone())
            .collect();
        let beside = Term {
            monomial: rest,
            word: t.word.clone(),
        };
        let seed = self.raise(&Poly::term(
            crate::expr::shape::Shape::SCALAR,
            Rational::ONE,
            beside,
        ));
        let back = expr::pull_back(self.symbols, a, which, seed);
        Some(expr::pairing(self.symbols, back, amount))
    }
}
