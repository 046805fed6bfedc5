//! Unit quaternions, SU(2), as 4 x 4 matrices of left multiplication. Letters of variation and covectors are vectors.
//! The element of the Lie algebra is half the vector, so that the coordinates are the angular velocity of space.

use super::{Element, ElementStorage, Record, Sizes, THREE};
use crate::algebra::Rational;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr};

/// Unit quaternions.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct UnitQuaternions;

impl Record for UnitQuaternions {
    fn shape(&self) -> Shape {
        Shape::square(Dim::Fixed(4))
    }

    fn structure(&self) -> Structure {
        Structure::UnitQuaternion
    }

    fn coordinates(&self) -> Option<Dim> {
        Some(THREE)
    }

    fn variation(&self) -> (Shape, Structure) {
        (Shape::vector(THREE), Structure::General)
    }

    fn basis(&self, _: &Sizes) -> Vec<Element> {
        (0..3).map(|i| vec![(i, 0, 1)]).collect()
    }

    fn element(&self, x: Expr) -> Expr {
        expr::scale(Rational::HALF, expr::pure(x))
    }

    fn covector(&self, _: &Symbols, y: Expr) -> Expr {
        expr::scale(Rational::integer(2), expr::imaginary(y))
    }

    fn pairing(&self, _: &Symbols, covector: Expr, xi: Expr) -> Expr {
        expr::dot(covector, xi)
    }

    fn to_space(&self, s: &Symbols, g: &Expr, covector: Expr) -> Expr {
        expr::mul(expr::rotation(s, g.clone()), covector)
    }

    fn bracket(&self, s: &Symbols, mu: Expr, xi: Expr, eta: Expr) -> Expr {
        self.pairing(s, mu, expr::cross(xi, eta))
    }

    fn coadjoint(&self, _: &Symbols, mu: Expr, zeta: Expr) -> Expr {
        expr::cross(mu, zeta)
    }

    fn turn(&self, s: &Symbols, g: &Expr) -> Option<Expr> {
        Some(expr::rotation(s, g.clone()))
    }

    fn kept(&self) -> ElementStorage {
        ElementStorage::Quaternion
    }

    fn variation_words(&self) -> [String; 2] {
        let words = " is an arbitrary vector, an angular displacement; quat(v) is the left multiplication by the quaternion v.";
        [words.to_owned(), words.to_owned()]
    }

    fn statement(&self, _: &dyn Fn(Dim) -> String) -> String {
        "SU<2>".to_owned()
    }

    fn name(&self, _: &dyn Fn(Dim) -> String) -> String {
        "SU(2)".to_owned()
    }

    fn kinetic_example(&self, element: &str) -> String {
        format!("-(4*c/h)*re({element}^T*next({element}))")
    }
}
