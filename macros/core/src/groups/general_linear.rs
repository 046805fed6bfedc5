//! Invertible matrices, GL(n). The Lie algebra consists of all matrices. Covectors are matrices with the pairing
//! `tr(M^T X)`.

use super::{Chart, Element, ElementStorage, Record, Sizes, entries};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr};

/// Invertible matrices with n rows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct GeneralLinear(pub Dim);

impl Record for GeneralLinear {
    fn chart(&self) -> Option<Chart> {
        match self.0 {
            Dim::Fixed(n) => Some(Chart::Entries(n)),
            _ => None,
        }
    }

    fn shape(&self) -> Shape {
        Shape::square(self.0)
    }

    fn structure(&self) -> Structure {
        Structure::Invertible
    }

    fn variation(&self) -> (Shape, Structure) {
        (Shape::square(self.0), Structure::General)
    }

    fn basis(&self, size: &Sizes) -> Vec<Element> {
        entries(self.shape(), size)
    }

    fn covector(&self, _: &Symbols, y: Expr) -> Expr {
        y
    }

    fn pairing(&self, s: &Symbols, covector: Expr, xi: Expr) -> Expr {
        expr::trace(expr::mul(expr::transpose(s, covector), xi))
    }

    fn to_space(&self, s: &Symbols, g: &Expr, covector: Expr) -> Expr {
        let t = expr::transpose(s, g.clone());
        expr::product([expr::inverse(s, t.clone()), covector, t])
    }

    fn bracket(&self, s: &Symbols, mu: Expr, xi: Expr, eta: Expr) -> Expr {
        let commutator = expr::sub(expr::mul(xi.clone(), eta.clone()), expr::mul(eta, xi));
        self.pairing(s, mu, commutator)
    }

    fn coadjoint(&self, s: &Symbols, mu: Expr, zeta: Expr) -> Expr {
        let turned = expr::transpose(s, zeta);
        expr::sub(expr::mul(turned.clone(), mu.clone()), expr::mul(mu, turned))
    }

    fn has_normal(&self) -> bool {
        false
    }

    fn kept(&self) -> ElementStorage {
        ElementStorage::Linear(self.0)
    }

    fn variation_words(&self) -> [String; 2] {
        let words = " is an arbitrary matrix.";
        [words.to_owned(), words.to_owned()]
    }

    fn motions_words(&self) -> &'static str {
        "linear maps of space"
    }

    fn statement(&self, size: &dyn Fn(Dim) -> String) -> String {
        format!("GL<{}>", size(self.0))
    }

    fn name(&self, size: &dyn Fn(Dim) -> String) -> String {
        format!("GL({})", size(self.0))
    }

    fn kinetic_example(&self, element: &str) -> String {
        format!("-tr(J*{element}^T*next({element}))/h")
    }
}
