//! The cache of normal forms: each shared subexpression is lowered once. Takes an expression; gives its normal form,
//! shared between queries.

use super::Algebra;
use super::poly::Poly;
use crate::expr::Expr;
use std::rc::Rc;

/// The number of nodes from which the normal form of an expression is cached. The normal form of a smaller
/// expression is computed as fast as it is looked up.
const SHARED: u32 = 3;

/// A normal form and the work that it took.
pub(super) type Lowered = (Rc<Poly>, usize);

impl Algebra<'_> {
    /// The normal form of an expression.
    pub fn lower(&self, e: &Expr) -> Poly {
        Rc::unwrap_or_clone(self.lowered(e))
    }

    /// The normal form of an expression, shared with earlier queries.
    pub(super) fn lowered(&self, e: &Expr) -> Rc<Poly> {
        if e.size() < SHARED {
            return Rc::new(self.normal_form(e));
        }
        let forms = &self.lowered[usize::from(self.blocks.get())];
        if let Some((known, work)) = forms.borrow().get(e) {
            // The work counts again, so that a limit does not depend on earlier queries.
            self.spend(*work);
            return known.clone();
        }
        let before = self.work.get();
        let form = Rc::new(self.normal_form(e));
        if !self.exhausted() {
            let work = usize::try_from(self.work.get() - before).unwrap_or(usize::MAX);
            forms.borrow_mut().insert(e.clone(), (form.clone(), work));
        }
        form
    }
}
