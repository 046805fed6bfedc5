//! Rigid motions of the plane, SE(2), as 3 x 3 homogeneous matrices. Letters of variation and covectors are vectors
//! of three components, an angle stacked on a translation.

use super::{Chart, Element, ElementStorage, Euclidean, Names, Record, Sizes, THREE};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr};

/// Rigid motions of the plane.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PlaneMotions;

const ONE: Dim = Dim::Fixed(1);
const TWO: Dim = Dim::Fixed(2);

/// A vector after a quarter turn, `(x, y) -> (-y, x)`.
fn quarter(s: &Symbols, v: Expr) -> Expr {
    expr::mul(expr::quarter_turn(s), v)
}

impl Record for PlaneMotions {
    fn chart(&self) -> Option<Chart> {
        Some(Chart::AngleAndPlace)
    }

    fn shape(&self) -> Shape {
        Shape::square(THREE)
    }

    fn structure(&self) -> Structure {
        Structure::RigidMotion
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
        expr::twist(x)
    }

    fn covector(&self, s: &Symbols, y: Expr) -> Expr {
        expr::paired_with_twists(s, &y)
    }

    fn pairing(&self, _: &Symbols, covector: Expr, xi: Expr) -> Expr {
        expr::dot(covector, xi)
    }

    /// `(a, l) -> (a + x × R l, R l)`.
    fn to_space(&self, s: &Symbols, g: &Expr, covector: Expr) -> Expr {
        let rigid: &dyn Euclidean = self;
        let linear = expr::mul(expr::block(s, g), rigid.linear(s, &covector));
        let moment = rigid.moment(s, expr::column(s, g), linear.clone());
        expr::stacked(expr::add(rigid.angular(s, &covector), moment), linear)
    }

    /// `[(ω, v), (ω', v')] = (0, ω i v' - ω' i v)` with the quarter turn `i`.
    fn bracket(&self, s: &Symbols, mu: Expr, xi: Expr, eta: Expr) -> Expr {
        let rigid: &dyn Euclidean = self;
        let moved = |a: &Expr, b: &Expr| rigid.swept(s, rigid.angular(s, a), rigid.linear(s, b));
        let moved = expr::sub(moved(&xi, &eta), moved(&eta, &xi));
        expr::dot(rigid.linear(s, &mu), moved)
    }

    /// `(l × v, -ω i l)` of the momentum `(a, l)` and the velocity `(ω, v)`.
    fn coadjoint(&self, s: &Symbols, mu: Expr, zeta: Expr) -> Expr {
        let rigid: &dyn Euclidean = self;
        let linear = rigid.linear(s, &mu);
        let angular = rigid.moment(s, linear.clone(), rigid.linear(s, &zeta));
        let turned = rigid.swept(s, rigid.angular(s, &zeta), linear);
        expr::stacked(angular, expr::neg(turned))
    }

    fn turn(&self, s: &Symbols, g: &Expr) -> Option<Expr> {
        Some(expr::block(s, g))
    }

    fn kept(&self) -> ElementStorage {
        ElementStorage::Coordinates(Names {
            element: "PlaneMotion",
            momentum: "PlaneImpulse",
            coordinates: 3,
            kind: "RigidMotion",
            words: "position, body to plane",
        })
    }

    fn rigid(&self) -> Option<&dyn Euclidean> {
        Some(self)
    }

    fn variation_words(&self) -> [String; 2] {
        let both = " is an arbitrary vector of an angle and a displacement; twist of it is the matrix of the Lie algebra";
        [
            format!(
                "{both}, ang and lin take its parts, and x[1:2] the first two entries of a longer vector."
            ),
            format!("{both}."),
        ]
    }

    fn motions_words(&self) -> &'static str {
        "rigid motions of the plane"
    }

    fn statement(&self, _: &dyn Fn(Dim) -> String) -> String {
        "SE<2>".to_owned()
    }

    fn name(&self, _: &dyn Fn(Dim) -> String) -> String {
        "SE(2)".to_owned()
    }

    fn kinetic_example(&self, element: &str) -> String {
        format!("-tr(J*rot({element})^T*rot(next({element})))/h")
    }
}

impl Euclidean for PlaneMotions {
    fn space(&self) -> Dim {
        TWO
    }

    fn angles(&self) -> Dim {
        ONE
    }

    fn swept(&self, s: &Symbols, turning: Expr, place: Expr) -> Expr {
        expr::mul(turning, quarter(s, place))
    }

    fn moment(&self, s: &Symbols, place: Expr, linear: Expr) -> Expr {
        expr::dot(quarter(s, place), linear)
    }

    /// Rotations of the plane commute: an angular momentum is the same number in all frames.
    fn turned(&self, _: Expr, angular: Expr) -> Expr {
        angular
    }

    fn as_turn(&self, s: &Symbols, angular: Expr) -> Expr {
        expr::mul(angular, expr::quarter_turn(s))
    }

    fn of_turn(&self, turn: Expr) -> Expr {
        expr::dot(expr::unit(TWO, 1), expr::mul(turn, expr::unit(TWO, 0)))
    }
}
