//! Derivatives of momenta with respect to the velocities of a site, for fields and for rotations in the body frame.
//! Takes a momentum and the velocity; gives the columns of its derivative, side by side.

use crate::check::spec::{Configuration, Side};
use crate::derive::tangent::Direction;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Shift};

/// The velocity of a configuration as a letter.
pub(super) fn letter(c: &Configuration) -> Letter {
    Letter {
        symbol: c.velocity,
        shift: Shift::HERE,
    }
}

/// Whether its velocity may be found together with others, or by Newton's method. This holds for fields and for
/// rotations of space in the body frame.
pub(super) fn is_free(c: &Configuration) -> bool {
    turns(c) || c.group.is_additive() && expr::axes(c.group.shape()).is_some()
}

/// Whether it is a rotation of space in the body frame.
pub(super) fn turns(c: &Configuration) -> bool {
    c.group.is_of_space() && c.side == Side::Body
}

/// The derivative with respect to a velocity, columns side by side: one per axis of a field; all three together for a
/// rotation `Ω`, along `Ω hat(η)`. `None` for other groups.
pub(super) fn columns(s: &Symbols, momentum: &Expr, c: &Configuration) -> Option<Vec<Expr>> {
    let velocity = letter(c);
    if !turns(c) {
        let axes = match c.group.is_additive() {
            true => expr::axes(c.group.shape())?,
            false => return None,
        };
        let along = |axis: Expr| expr::directional(s, momentum, &[(velocity, axis)]);
        return Some(axes.into_iter().map(along).collect());
    }
    let three = Dim::Fixed(3);
    let mut symbols = s.clone();
    let name = symbols.fresh_name("η");
    let eta = symbols.add(
        &name,
        Shape::vector(three),
        Structure::General,
        Role::Derived,
    );
    let turned = |eta: Expr| {
        let change = expr::mul(expr::here(&symbols, c.velocity), expr::hat(eta));
        expr::directional(&symbols, momentum, &[(velocity, change)])
    };
    let direction = Direction {
        symbols: &symbols,
        letter: eta,
    };
    let derivative = turned(expr::here(&symbols, eta));
    let whole = direction.matrix(&expr::collect(&symbols, &derivative));
    let shape = Shape {
        rows: momentum.shape().rows,
        cols: three,
    };
    let by_columns = || {
        let each = (0..3).map(|axis| {
            let axis = expr::unit(three, axis);
            let row = expr::transpose(&symbols, axis.clone());
            expr::mul(turned(axis), row)
        });
        expr::sum(each.collect::<Vec<_>>(), shape)
    };
    Some(vec![whole.unwrap_or_else(by_columns)])
}

/// The derivative of a momentum in the limit of small steps with respect to the velocity `xi` of a configuration, one
/// column per axis.
pub(super) fn columns_of_limit(
    s: &Symbols,
    momentum: &Expr,
    c: &Configuration,
    xi: SymbolId,
) -> Vec<Expr> {
    let rows = s.get(xi).shape.rows;
    let axes = match c.group.is_additive() {
        true => expr::axes(s.get(xi).shape).unwrap_or_default(),
        false => (0..3)
            .map(|axis| expr::hat(expr::unit(rows, axis)))
            .collect(),
    };
    let own = Letter {
        symbol: xi,
        shift: Shift::HERE,
    };
    let along = |axis: Expr| expr::directional(s, momentum, &[(own, axis)]);
    axes.into_iter().map(along).collect()
}
