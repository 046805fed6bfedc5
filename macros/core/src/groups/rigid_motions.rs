//! Rigid motions of space, SE(3), as 4 x 4 homogeneous matrices. Letters of variation and covectors are vectors of
//! six components, an angular part stacked on a linear part.

use super::{Chart, Element, ElementStorage, Euclidean, Names, Record, SIX, Sizes, THREE};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr};

/// Rigid motions of space.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct RigidMotions;

impl Record for RigidMotions {
    fn chart(&self) -> Option<Chart> {
        Some(Chart::TurnAndPlace)
    }

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
        expr::paired_with_twists(s, &y)
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
        let part = |e: &Expr, row| expr::part_of_six(s, e, row);
        let (a, b) = (part(&xi, 0), part(&eta, 0));
        let moved = expr::sub(
            expr::cross(a.clone(), part(&eta, 3)),
            expr::cross(b.clone(), part(&xi, 3)),
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

    fn kept(&self) -> ElementStorage {
        ElementStorage::Coordinates(Names {
            element: "RigidMotion",
            momentum: "Impulse",
            coordinates: 6,
            kind: "RigidMotion",
            words: "position, body to space",
        })
    }

    fn rigid(&self) -> Option<&dyn Euclidean> {
        Some(self)
    }

    fn variation_words(&self) -> [String; 2] {
        let both = " is an arbitrary vector of an angular and a linear displacement; twist of it is the matrix of the Lie algebra";
        [
            format!(
                "{both}, ang and lin take its parts, and x[1:3] the first three entries of a longer vector."
            ),
            format!("{both}."),
        ]
    }

    fn motions_words(&self) -> &'static str {
        "rigid motions of space"
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

impl Euclidean for RigidMotions {
    fn space(&self) -> Dim {
        THREE
    }

    fn angles(&self) -> Dim {
        THREE
    }

    fn swept(&self, _: &Symbols, turning: Expr, place: Expr) -> Expr {
        expr::cross(turning, place)
    }

    fn moment(&self, _: &Symbols, place: Expr, linear: Expr) -> Expr {
        expr::cross(place, linear)
    }

    fn turned(&self, turn: Expr, angular: Expr) -> Expr {
        expr::mul(turn, angular)
    }

    fn as_turn(&self, _: &Symbols, angular: Expr) -> Expr {
        angular
    }

    fn of_turn(&self, turn: Expr) -> Expr {
        turn
    }
}
