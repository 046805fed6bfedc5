//! Numbers, vectors and matrices under addition: fields. The velocity of an edge is the increment `next(X) - X`, and
//! variations are arbitrary arrays of the same shape. All frames are equal, so momenta are not transformed.

use super::{Element, ElementStorage, Record, Sizes, entries};
use crate::check::spec::Side;
use crate::diagnostic::article;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr};

/// Arrays of a given shape.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Additive(pub Shape);

impl Record for Additive {
    fn shape(&self) -> Shape {
        self.0
    }

    fn structure(&self) -> Structure {
        Structure::General
    }

    fn variation(&self) -> (Shape, Structure) {
        (self.0, Structure::General)
    }

    fn basis(&self, size: &Sizes) -> Vec<Element> {
        entries(self.0, size)
    }

    fn covector(&self, _: &Symbols, y: Expr) -> Expr {
        y
    }

    fn pairing(&self, s: &Symbols, covector: Expr, xi: Expr) -> Expr {
        match (self.0.is_scalar(), self.0.is_vector()) {
            (true, _) => expr::mul(covector, xi),
            (false, true) => expr::dot(covector, xi),
            (false, false) => expr::trace(expr::mul(expr::transpose(s, covector), xi)),
        }
    }

    fn to_space(&self, _: &Symbols, _: &Expr, covector: Expr) -> Expr {
        covector
    }

    fn bracket(&self, _: &Symbols, _: Expr, _: Expr, _: Expr) -> Expr {
        expr::integer(0)
    }

    fn coadjoint(&self, _: &Symbols, _: Expr, _: Expr) -> Expr {
        expr::zero(self.0)
    }

    fn identity(&self) -> Expr {
        expr::zero(self.0)
    }

    fn compose(&self, a: Expr, b: Expr) -> Expr {
        expr::add(a, b)
    }

    fn inverse(&self, _: &Symbols, a: Expr) -> Expr {
        expr::neg(a)
    }

    fn moved(&self, _: Side, _: Expr, xi: Expr) -> Expr {
        xi
    }

    fn second(&self, _: Expr) -> Expr {
        expr::zero(self.0)
    }

    fn pulled_back(&self, _: &Symbols, _: Side, _: Expr, y: Expr) -> Expr {
        y
    }

    fn has_normal(&self) -> bool {
        false
    }

    fn kept(&self) -> ElementStorage {
        ElementStorage::Field(self.0)
    }

    fn variation_words(&self) -> [String; 2] {
        let words = match (self.0.is_scalar(), self.0.is_vector()) {
            (true, _) => " is an arbitrary number.",
            (false, true) => " is an arbitrary vector.",
            (false, false) => " is an arbitrary matrix.",
        };
        [words.to_owned(), words.to_owned()]
    }

    fn place(&self, _: &Symbols, g: &Expr) -> Option<Expr> {
        Some(g.clone())
    }

    fn is_isometric(&self) -> bool {
        true
    }

    fn statement(&self, size: &dyn Fn(Dim) -> String) -> String {
        match (self.0.is_scalar(), self.0.is_vector()) {
            (true, _) => "Real".to_owned(),
            (false, true) => format!("Vec<{}>", size(self.0.rows)),
            (false, false) if self.0.rows == self.0.cols => format!("Mat<{}>", size(self.0.rows)),
            (false, false) => format!("Mat<{}, {}>", size(self.0.rows), size(self.0.cols)),
        }
    }

    fn name(&self, size: &dyn Fn(Dim) -> String) -> String {
        match (self.0.is_scalar(), self.0.is_vector()) {
            (true, _) => "a number".to_owned(),
            (false, true) => format!("a vector of {} components", size(self.0.rows)),
            (false, false) => {
                let (rows, cols) = (size(self.0.rows), size(self.0.cols));
                format!("{} {rows} x {cols} matrix", article(&rows))
            }
        }
    }

    fn kinetic_example(&self, element: &str) -> String {
        let step = format!("next({element}) - {element}");
        match (self.0.is_scalar(), self.0.is_vector()) {
            (true, _) => format!("m*({step})^2/(2*h)"),
            (false, true) => format!("m*dot({step}, {step})/(2*h)"),
            (false, false) => format!("m*tr(({step})^T*({step}))/(2*h)"),
        }
    }
}
