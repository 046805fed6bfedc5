//! Rotations, SO(n). The Lie algebra consists of the skew matrices. In three dimensions, covectors and velocities in
//! continuous time are axial vectors, otherwise skew matrices.

use super::{Chart, Element, ElementStorage, Record, Sizes, THREE};
use crate::algebra::Rational;
use crate::derive::bracket::skew_entries;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr};

/// Rotations in n dimensions.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct SpecialOrthogonal(pub Dim);

impl SpecialOrthogonal {
    fn is_of_space(self) -> bool {
        self.0 == THREE
    }
}

impl Record for SpecialOrthogonal {
    fn chart(&self) -> Option<Chart> {
        (self.0 == Dim::Fixed(2)).then_some(Chart::Angle)
    }

    fn shape(&self) -> Shape {
        Shape::square(self.0)
    }

    fn structure(&self) -> Structure {
        Structure::Orthogonal
    }

    fn variation(&self) -> (Shape, Structure) {
        (Shape::square(self.0), Structure::Skew)
    }

    fn dual(&self) -> (Shape, Structure) {
        match self.is_of_space() {
            true => (Shape::vector(THREE), Structure::General),
            false => self.variation(),
        }
    }

    fn basis(&self, size: &Sizes) -> Vec<Element> {
        skew_entries(size(self.0))
            .into_iter()
            .map(|(i, j)| vec![(i, j, 1), (j, i, -1)])
            .collect()
    }

    fn rate(&self, zeta: Expr) -> Expr {
        match self.is_of_space() {
            true => expr::hat(zeta),
            false => zeta,
        }
    }

    /// `2 vee(Y)`, which is paired with the axial vector of `ξ`, or `Y - Y^T`.
    fn covector(&self, s: &Symbols, y: Expr) -> Expr {
        match self.is_of_space() {
            true => expr::scale(Rational::integer(2), expr::vee(y)),
            false => self.as_algebra(s, y),
        }
    }

    fn as_algebra(&self, s: &Symbols, y: Expr) -> Expr {
        expr::sub(y.clone(), expr::transpose(s, y))
    }

    fn of_gradient(&self, s: &Symbols, y: Expr) -> Expr {
        self.covector(s, y)
    }

    fn of_rate_gradient(&self, s: &Symbols, y: Expr) -> Expr {
        match self.is_of_space() {
            true => y,
            false => self.covector(s, y),
        }
    }

    fn pairing(&self, s: &Symbols, covector: Expr, xi: Expr) -> Expr {
        if self.is_of_space() {
            return expr::dot(covector, expr::vee(xi));
        }
        let word = expr::mul(expr::transpose(s, covector), xi);
        expr::scale(Rational::HALF, expr::trace(word))
    }

    fn to_space(&self, s: &Symbols, g: &Expr, covector: Expr) -> Expr {
        match self.is_of_space() {
            true => expr::mul(g.clone(), covector),
            false => expr::product([g.clone(), covector, expr::transpose(s, g.clone())]),
        }
    }

    fn bracket(&self, s: &Symbols, mu: Expr, xi: Expr, eta: Expr) -> Expr {
        if self.is_of_space() {
            return expr::dot(mu, expr::cross(expr::vee(xi), expr::vee(eta)));
        }
        let commutator = expr::sub(expr::mul(xi.clone(), eta.clone()), expr::mul(eta, xi));
        self.pairing(s, mu, commutator)
    }

    fn coadjoint(&self, s: &Symbols, mu: Expr, zeta: Expr) -> Expr {
        if self.is_of_space() {
            return expr::cross(mu, zeta);
        }
        let turned = expr::transpose(s, zeta);
        expr::sub(expr::mul(turned.clone(), mu.clone()), expr::mul(mu, turned))
    }

    fn coadjoint_in_space(&self, s: &Symbols, mu: Expr, zeta: Expr) -> Expr {
        match self.is_of_space() {
            true => expr::cross(zeta, mu),
            false => expr::scale(Rational::MINUS_ONE, self.coadjoint(s, mu, zeta)),
        }
    }

    fn weight(&self) -> Rational {
        Rational::HALF
    }

    fn turn(&self, _: &Symbols, g: &Expr) -> Option<Expr> {
        self.is_of_space().then(|| g.clone())
    }

    fn kept(&self) -> ElementStorage {
        match self.is_of_space() {
            true => ElementStorage::Rotation,
            false => ElementStorage::Orthogonal(self.0),
        }
    }

    fn variation_words(&self) -> [String; 2] {
        let words = " is an arbitrary skew matrix.";
        [words.to_owned(), words.to_owned()]
    }

    fn statement(&self, size: &dyn Fn(Dim) -> String) -> String {
        format!("SO<{}>", size(self.0))
    }

    fn name(&self, size: &dyn Fn(Dim) -> String) -> String {
        format!("SO({})", size(self.0))
    }

    fn kinetic_example(&self, element: &str) -> String {
        format!("-tr(J*{element}^T*next({element}))/h")
    }
}
