//! Lie algebras and their duals as expressions: which matrix a letter of variation stands for, what
//! a matrix gives as a covector, and how covectors are carried between the frames of two nodes.

use super::Letters;
use crate::algebra::Rational;
use crate::check::spec::{Configuration, Group, Side};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Shift};

const THREE: Dim = Dim::Fixed(3);
const SIX: Dim = Dim::Fixed(6);

/// Shape of the covectors of SE(3): three angular and three linear components.
pub const IMPULSE: Shape = Shape::vector(SIX);

/// Shape and structure of a letter of variation: a matrix of the Lie algebra, or its coordinates.
pub fn variation(group: Group) -> (Shape, Structure) {
    match group.coordinates() {
        Some(n) => (Shape::vector(n), Structure::General),
        None if group.is_orthogonal() => (Shape::square(group.size()), Structure::Skew),
        None => (Shape::square(group.size()), Structure::General),
    }
}

/// The element of the Lie algebra that a letter of variation stands for. For SU(2) that is half the
/// vector, so that it turns space with the angular velocity of its coordinates.
pub fn element(symbols: &Symbols, group: Group, letter: SymbolId) -> Expr {
    of_letter(group, expr::here(symbols, letter))
}

/// The same of any expression in place of the letter.
pub fn of_letter(group: Group, x: Expr) -> Expr {
    match group {
        Group::SpecialOrthogonal(_) | Group::GeneralLinear(_) => x,
        Group::UnitQuaternions => expr::scale(Rational::HALF, expr::pure(x)),
        Group::RigidMotions => expr::twist(x),
    }
}

/// The covector that a matrix `Y` gives on the Lie algebra, `ξ -> <Y, ξ>`, in the form in which
/// momenta are written: `2 vee(Y)` for SO(3) (pairing with the axial vector of `ξ`), `Y - Y^T` for
/// SO(n), `Y` for GL(n), pairings with the coordinates for SU(2) and SE(3).
pub fn covector(letters: &Letters, group: Group, y: Expr) -> Expr {
    let s = &letters.symbols;
    let two = Rational::integer(2);
    match group {
        Group::SpecialOrthogonal(Dim::Fixed(3)) => expr::scale(two, expr::vee(y)),
        Group::SpecialOrthogonal(_) => expr::sub(y.clone(), expr::transpose(s, y)),
        Group::GeneralLinear(_) => y,
        Group::UnitQuaternions => expr::scale(two, expr::imaginary(y)),
        Group::RigidMotions => {
            let turn = expr::scale(two, expr::vee(expr::block(s, &y)));
            expr::stacked(turn, expr::column(s, &y))
        }
    }
}

/// The covector that the gradient of a number linear in the letter of variation is.
pub fn of_gradient(letters: &Letters, group: Group, y: Expr) -> Expr {
    match group.coordinates() {
        Some(_) => y,
        None => covector(letters, group, y),
    }
}

/// The number that a covector gives on a letter of variation.
pub fn pairing(letters: &Letters, group: Group, covector: Expr, xi: Expr) -> Expr {
    let s = &letters.symbols;
    match group {
        Group::SpecialOrthogonal(Dim::Fixed(3)) => expr::dot(covector, expr::vee(xi)),
        Group::SpecialOrthogonal(_) => expr::scale(
            Rational::HALF,
            expr::trace(expr::mul(expr::transpose(s, covector), xi)),
        ),
        Group::GeneralLinear(_) => expr::trace(expr::mul(expr::transpose(s, covector), xi)),
        Group::UnitQuaternions | Group::RigidMotions => expr::dot(covector, xi),
    }
}

/// A body covector as seen from space, `Ad*` of the inverse of `g`: what keeps its pairing when
/// `ξ` goes to `g ξ g^-1`.
pub fn to_space(symbols: &Symbols, group: Group, g: &Expr, covector: Expr) -> Expr {
    let t = |e: Expr| expr::transpose(symbols, e);
    match group {
        Group::SpecialOrthogonal(Dim::Fixed(3)) => expr::mul(g.clone(), covector),
        Group::SpecialOrthogonal(_) => expr::product([g.clone(), covector, t(g.clone())]),
        Group::GeneralLinear(_) => {
            let back = expr::inverse(symbols, t(g.clone()));
            expr::product([back, covector, t(g.clone())])
        }
        Group::UnitQuaternions => expr::mul(expr::rotation(symbols, g.clone()), covector),
        // (a, l) -> (R a + x × R l, R l)
        Group::RigidMotions => {
            let turn = expr::block(symbols, g);
            let part = |row| t(expr::inclusion(SIX, THREE, row));
            let angular = expr::product([turn.clone(), part(0), covector.clone()]);
            let linear = expr::product([turn, part(3), covector]);
            let moment = expr::cross(expr::column(symbols, g), linear.clone());
            expr::stacked(expr::add(angular, moment), linear)
        }
    }
}

/// The momentum at the end of an edge as the start of the edge sees it: spatial momenta are one
/// and the same, body momenta are carried by the velocity.
pub fn seen_from_start(symbols: &Symbols, c: &Configuration, covector: Expr) -> Expr {
    match c.side {
        Side::Body => to_space(symbols, c.group, &expr::here(symbols, c.velocity), covector),
        Side::Spatial => covector,
    }
}

/// A letter of variation with the element of the Lie algebra it stands for, to substitute.
pub fn letter(symbol: SymbolId) -> Letter {
    Letter {
        symbol,
        shift: Shift::HERE,
    }
}
