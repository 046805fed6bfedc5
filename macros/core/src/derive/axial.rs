//! Axial vectors of a velocity as letters of their own. If both ends of an edge are rotated together, the velocity
//! and its axis rotate too: the change of `vee(O)` is a cross product with three components, whereas the change of
//! the whole matrix has eighteen terms. Takes a scalar and the changes of all letters; gives the same covector in
//! cross products.

use super::variation::at;
use crate::algebra::Algebra;
use crate::check::spec::{Configuration, Group};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Shift};

const VECTOR: Shape = Shape::vector(Dim::Fixed(3));

/// The changes of all letters on an edge if its ends are rotated together, with letters for the axial vectors of one
/// velocity.
pub(super) struct Axial {
    symbols: Symbols,
    velocity: Letter,
    /// The rotation, a vector.
    turn: Letter,
    /// Axial vectors of the velocity, and the letters that replace them.
    parts: Vec<(Expr, Letter)>,
    changes: Vec<(Letter, Expr)>,
}

impl Axial {
    /// `along` gives the changes of all letters for the variation `xi` of the configuration. `None` for groups whose
    /// velocities have no axial vector.
    pub(super) fn of(
        symbols: &Symbols,
        c: &Configuration,
        xi: SymbolId,
        along: &[(Letter, Expr)],
    ) -> Option<Axial> {
        let matrix = expr::here(symbols, c.velocity);
        let parts = match c.group {
            group if group.is_of_space() => vec![expr::vee(matrix)],
            Group::UnitQuaternions(_) => {
                let rotation = expr::rotation(symbols, matrix.clone());
                vec![expr::imaginary(matrix), expr::vee(rotation)]
            }
            _ => return None,
        };
        let mut symbols = symbols.clone();
        let mut fresh = |base: &str| {
            let name = symbols.fresh_name(base);
            let symbol = symbols.add(&name, VECTOR, Structure::General, Role::Derived);
            at(symbol, Shift::HERE)
        };
        let turn = fresh("t");
        let parts: Vec<(Expr, Letter)> = parts.into_iter().map(|a| (a, fresh("a"))).collect();
        // The rotation as a vector, wherever the variation occurs as its matrix.
        let here = |l: Letter| expr::here(&symbols, l.symbol);
        let as_vector = match c.group.coordinates() {
            Some(_) => here(turn),
            None => expr::hat(here(turn)),
        };
        let as_vector = [(at(xi, Shift::HERE), as_vector)];
        let algebra = Algebra::new(&symbols);
        let velocity = at(c.velocity, Shift::HERE);
        let mut changes = Vec::new();
        for (l, amount) in along {
            let change = (*l, expr::substitute(&symbols, amount, &as_vector));
            if *l != velocity {
                changes.push(change);
                continue;
            }
            for (part, axis) in &parts {
                let whole = expr::directional(&symbols, part, std::slice::from_ref(&change));
                let (t, a) = (here(turn), here(*axis));
                let turns = [expr::cross(t.clone(), a.clone()), expr::cross(a, t)];
                let turned = turns.into_iter().find(|turned| {
                    let of_part = [(*axis, part.clone())];
                    let there = expr::substitute(&symbols, turned, &of_part);
                    algebra.is_zero(&expr::sub(whole.clone(), there))
                });
                changes.push((*axis, turned?));
            }
        }
        Some(Axial {
            symbols,
            velocity,
            turn,
            parts,
            changes,
        })
    }

    /// The derivative of a scalar along the rotation, as a covector. `None` if the scalar contains the velocity other
    /// than through its axial vectors.
    pub(super) fn covector(&self, e: &Expr) -> Option<Expr> {
        let s = &self.symbols;
        let written = self.written(e);
        if written == *e || expr::contains(&written, self.velocity) {
            return None;
        }
        let change = expr::directional(s, &written, &self.changes);
        let covector = expr::gradient(s, &change, self.turn);
        let back: Vec<(Letter, Expr)> = self.parts.iter().map(|(a, l)| (*l, a.clone())).collect();
        Some(expr::substitute(s, &covector, &back))
    }

    /// The expression with letters for the axial vectors.
    fn written(&self, e: &Expr) -> Expr {
        match self.parts.iter().find(|(part, _)| part == e) {
            Some((_, axis)) => expr::here(&self.symbols, axis.symbol),
            None => expr::rebuild(&self.symbols, e, &mut |x| self.written(x)),
        }
    }
}
