//! Rigid motions of space, SE(3), as 4 x 4 homogeneous matrices. Letters of variation and covectors
//! are vectors of six components, an angular part on top of a linear one.

use super::{Element, Record, SIX, Sizes, THREE};
use crate::algebra::Rational;
use crate::derive::bracket::{angular, linear};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr};

/// Rigid motions of space.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct RigidMotions;

impl Record for RigidMotions {
    fn shape(&self) -> Shape {
        Shape::square(Dim::Fixed(4))
    }

    fn structure(&self) -> Structure {
        Structure::RigidMotion
    }

    fn coordinates(&self) -> Option<Dim> {
        Some(SIX)
    }

    fn variation(&self) -> (Shape, Structure) {
        (Shape::vector(SIX), Structure::General)
    }

    fn basis(&self, _: &Sizes) -> Vec<Element> {
        (0..6).map(|i| vec![(i, 0, 1)]).collect()
    }

    fn element(&self, x: Expr) -> Expr {
        expr::twist(x)
    }

    fn covector(&self, s: &Symbols, y: Expr) -> Expr {
        let turn = expr::scale(Rational::integer(2), expr::vee(expr::block(s, &y)));
        expr::stacked(turn, expr::column(s, &y))
    }

    fn pairing(&self, _: &Symbols, covector: Expr, xi: Expr) -> Expr {
        expr::dot(covector, xi)
    }

    /// `(a, l) -> (R a + x × R l, R l)`.
    fn to_space(&self, s: &Symbols, g: &Expr, covector: Expr) -> Expr {
        let turn = expr::block(s, g);
        let part = |row| expr::transpose(s, expr::inclusion(SIX, THREE, row));
        let angular = expr::product([turn.clone(), part(0), covector.clone()]);
        let linear = expr::product([turn, part(3), covector]);
        let moment = expr::cross(expr::column(s, g), linear.clone());
        expr::stacked(expr::add(angular, moment), linear)
    }

    /// `[(ω, v), (ω', v')] = (ω × ω', ω × v' - ω' × v)`.
    fn bracket(&self, s: &Symbols, mu: Expr, xi: Expr, eta: Expr) -> Expr {
        let (a, b) = (angular(s, &xi), angular(s, &eta));
        let moved = expr::sub(
            expr::cross(a.clone(), linear(s, &eta)),
            expr::cross(b.clone(), linear(s, &xi)),
        );
        self.pairing(s, mu, expr::stacked(expr::cross(a, b), moved))
    }

    /// `(a × ω + l × v, l × ω)` of the momentum `(a, l)` and the velocity `(ω, v)`.
    fn coadjoint(&self, s: &Symbols, mu: Expr, zeta: Expr) -> Expr {
        let part = |e: &Expr, row| expr::part_of_six(s, e, row);
        let turn = part(&zeta, 0);
        let angular = expr::add(
            expr::cross(part(&mu, 0), turn.clone()),
            expr::cross(part(&mu, 3), part(&zeta, 3)),
        );
        expr::stacked(angular, expr::cross(part(&mu, 3), turn))
    }

    fn turn(&self, s: &Symbols, g: &Expr) -> Option<Expr> {
        Some(expr::block(s, g))
    }

    fn statement(&self, _: &dyn Fn(Dim) -> String) -> String {
        "SE<3>".to_owned()
    }

    fn name(&self, _: &dyn Fn(Dim) -> String) -> String {
        "SE(3)".to_owned()
    }

    fn kinetic_example(&self, element: &str) -> String {
        format!("-tr(J*rot({element})^T*rot(next({element})))/h")
    }
}
