//! The explicit form of a balance on GL(n) in which constant factors multiply the change of the configuration: in
//! space, `m = L ΔQ R Q^T + rest` with `Q' = Q + ΔQ`. An example is a kinetic energy with a constant metric and
//! constant second moments of mass. Both factors are inverted once, and no velocity is computed. Takes a derivation;
//! gives the factors, the rest and the force of the edge.

use super::Derivation;
use super::advection_rule::AdvectionRule;
use super::momentum_update::MomentumUpdate;
use super::select_solver::StepEquation;
use super::two_sided_linear::TwoSidedLinear;
use super::variation::at;
use crate::algebra::Algebra;
use crate::expr::symbol::{Role, SymbolId};
use crate::expr::{self, Expr, Letter, Node, Shift};

/// `h (m - rest) = left ΔQ right Q^T` with the spatial momentum `m` of the node, and `m' = m - rest + added`.
#[derive(Clone, Debug)]
pub struct SpatialIncrementForm {
    /// The factor to the left of the change; it depends on parameters.
    pub left: Expr,
    /// The factor to its right; it depends on parameters.
    pub right: Expr,
    /// The node momentum at zero velocity, in space.
    pub rest: Expr,
    /// The increment of the spatial momentum on the edge: the impulses and `left ΔQ right ΔQ^T/h`, which after the
    /// metric is symmetric for any rounding of the change. The letter of a direction of this configuration denotes
    /// its change.
    pub added: Expr,
    /// The quantity that the letter of a variation denotes in `rest` and `added`, in the frame of space: `Q^-T A Q^T`
    /// for a quantity `A` that is stated in the body.
    pub seen: Option<Expr>,
}

/// The form of configuration `i`, if it has one; `form` is the form in its velocity.
pub fn displaced(d: &Derivation, i: usize) -> Option<SpatialIncrementForm> {
    let c = &d.spec.configurations[i];
    let StepEquation::Linear(form) = &d.solve.riccati[i] else {
        return None;
    };
    if !c.group.is_linear() || velocity_is_asked(d, i) {
        return None;
    }
    let algebra = Algebra::new(&d.letters.symbols);
    let mut space = Space {
        d,
        i,
        algebra: &algebra,
        seen: None,
    };
    space.seen = space.only_quantity();
    let found = match space.form(form) {
        None if space.seen.take().is_some() => space.form(form),
        found => found,
    }?;
    (!algebra.exhausted()).then_some(found)
}

/// Whether a velocity is needed for anything but its own momentum.
fn velocity_is_asked(d: &Derivation, i: usize) -> bool {
    let velocity = at(d.spec.configurations[i].velocity, Shift::HERE);
    let carries = d.carries.iter().enumerate().filter(|(j, _)| *j != i);
    let others = carries.flat_map(|(_, carry)| carry.parts());
    let advanced = d.spec.advected.iter().zip(&d.transports);
    let advanced = advanced.filter(|(_, t)| matches!(t, AdvectionRule::Advanced));
    let mut all = others.chain(advanced.map(|(a, _)| &a.update));
    all.any(|e| expr::contains(e, velocity))
}

struct Space<'a> {
    d: &'a Derivation,
    i: usize,
    algebra: &'a Algebra<'a>,
    /// The only quantity of the model that is stated in the body, in the frame of space.
    seen: Option<Expr>,
}

impl Space<'_> {
    fn form(&self, form: &TwoSidedLinear) -> Option<SpatialIncrementForm> {
        let (d, s) = (self.d, &self.d.letters.symbols);
        let c = &d.spec.configurations[self.i];
        let placement = expr::here(s, c.element);
        let back = expr::inverse(s, placement.clone());
        let across = expr::transpose(s, back.clone());
        let (left, right) = if c.side.is_body() {
            (
                expr::product([across, form.left.clone(), back]),
                form.right.clone(),
            )
        } else {
            (
                form.left.clone(),
                expr::product([back, form.right.clone(), across]),
            )
        };
        let step = expr::here(s, d.spec.step);
        let left = self.constant(&expr::mul(step, left))?;
        let right = self.constant(&right)?;
        let (leave, arrive) = match &d.carries[self.i] {
            MomentumUpdate::Through { leave, arrive, .. } if c.side.is_body() => (
                self.in_space(leave, Shift::HERE.time)?,
                self.in_space(arrive, Shift::NEXT.time)?,
            ),
            MomentumUpdate::Kept(added) if c.side.is_spatial() => {
                (self.in_space(added, Shift::HERE.time)?, (None, None))
            }
            _ => return None,
        };
        let (rest, moved) = self.in_space(&form.rest, Shift::HERE.time)?;
        if moved.is_some() {
            return None;
        }
        let shape = form.rest.shape();
        let sum = |list: [Option<Expr>; 3]| expr::sum(list.into_iter().flatten(), shape);
        let change = expr::here(s, d.letters.direction[self.i]);
        let gained = [
            left.clone(),
            change.clone(),
            right.clone(),
            expr::transpose(s, change),
        ];
        let gained = expr::quotient(expr::product(gained), expr::here(s, d.spec.step));
        let moved = sum([leave.1, arrive.1, None]);
        if !self.algebra.is_zero(&expr::sub(moved, gained.clone())) {
            return None;
        }
        let acting = self
            .algebra
            .shortest(&sum([leave.0, arrive.0, rest.clone()]));
        Some(SpatialIncrementForm {
            left,
            right,
            added: expr::add(gained, acting),
            rest: rest.unwrap_or_else(|| expr::zero(shape)),
            seen: self.seen.clone(),
        })
    }

    /// The shortest form of a factor that contains only parameters.
    fn constant(&self, e: &Expr) -> Option<Expr> {
        let s = &self.d.letters.symbols;
        let short = self.algebra.shortest(&self.defined(e));
        let constant = |l: &Letter| s.get(l.symbol).role == Role::Parameter;
        let all = expr::letters(&short).iter().all(constant);
        (all && short.shape() == e.shape()).then_some(short)
    }

    /// The part of a covector at zero velocity, and the remaining part, both in the frame of space and without
    /// inverse configurations.
    fn in_space(&self, e: &Expr, time: i8) -> Option<(Option<Expr>, Option<Expr>)> {
        let (d, s) = (self.d, &self.d.letters.symbols);
        let c = &d.spec.configurations[self.i];
        let velocity = at(c.velocity, Shift::HERE);
        let one = c.group.identity();
        let still = expr::substitute(s, e, &[(velocity, one.clone())]);
        let back = expr::inverse(s, expr::here(s, c.element));
        let change = expr::here(s, d.letters.direction[self.i]);
        let along = c.side.product(back, change);
        let moving = match expr::contains(e, velocity) {
            true => {
                let way = [(velocity, expr::add(one, along))];
                let less = expr::sub(expr::substitute(s, e, &way), still.clone());
                let less = self.covector_in_space(self.defined(&less), time);
                self.algebra.shortest(&less)
            }
            false => expr::zero(e.shape()),
        };
        let still = if c.side.is_body() {
            self.turned(&still, time)?
        } else {
            super::balance::shorter(self.algebra, still)
        };
        let some = |e: Expr| (!e.is_zero()).then_some(e);
        (!divides(s, &still) && !divides(s, &moving)).then(|| (some(still), some(moving)))
    }

    /// A covector of the side in the frame of space, expressed by configurations or by quantities in that frame;
    /// proved.
    fn turned(&self, e: &Expr, time: i8) -> Option<Expr> {
        let Some(seen) = &self.seen else {
            return Some(
                self.algebra
                    .shortest(&self.covector_in_space(self.defined(e), time)),
            );
        };
        let s = &self.d.letters.symbols;
        let placement = self.d.spec.configurations[self.i].element;
        let (quantity, letter) = (
            self.d.spec.advected[0].quantity,
            self.d.letters.variation[self.i],
        );
        let (mut there, mut back) = (Vec::new(), Vec::new());
        for time in [Shift::HERE.time, Shift::NEXT.time] {
            let shift = Shift {
                time,
                ..Shift::HERE
            };
            let placement = expr::letter(s, placement, shift);
            let value = [
                expr::transpose(s, placement.clone()),
                expr::letter(s, letter, shift),
                expr::transpose(s, expr::inverse(s, placement)),
            ];
            there.push((at(quantity, shift), expr::product(value)));
            back.push((at(letter, shift), expr::shift_time(s, seen, time)));
        }
        let e = self.determinants(e, quantity);
        let found = self.covector_in_space(expr::substitute(s, &e, &there), time);
        let found = self.algebra.shortest(&found);
        let stated = expr::substitute(s, &self.covector_in_space(self.defined(&e), time), &back);
        let less = expr::sub(expr::substitute(s, &found, &back), stated);
        self.algebra.is_zero(&less).then_some(found)
    }

    /// Replaces determinants of a quantity by determinants of the quantity as seen from space.
    fn determinants(&self, e: &Expr, quantity: SymbolId) -> Expr {
        let s = &self.d.letters.symbols;
        if let Node::Det(a) = e.node()
            && let Node::Letter(l) = a.node()
            && l.symbol == quantity
        {
            let seen = self.d.letters.variation[self.i];
            return expr::det(expr::letter(s, seen, l.shift));
        }
        expr::rebuild(s, e, &mut |part| self.determinants(part, quantity))
    }

    /// A covector of the side, transformed to space.
    fn covector_in_space(&self, e: Expr, time: i8) -> Expr {
        let s = &self.d.letters.symbols;
        let c = &self.d.spec.configurations[self.i];
        let placement = expr::shift_time(s, &expr::here(s, c.element), time);
        if c.side.is_body() {
            let across = expr::transpose(s, expr::inverse(s, placement.clone()));
            expr::product([across, e, expr::transpose(s, placement)])
        } else {
            e
        }
    }

    /// The only quantity of a model that is stated in the body, by its definition and in the frame of space.
    fn only_quantity(&self) -> Option<Expr> {
        let d = self.d;
        let c = &d.spec.configurations[self.i];
        let ([quantity], [AdvectionRule::Defined(value)]) =
            (d.spec.advected.as_slice(), d.transports.as_slice())
        else {
            return None;
        };
        let s = &d.letters.symbols;
        let square = s.get(quantity.quantity).shape == c.group.shape();
        if c.side.is_spatial() || !square {
            return None;
        }
        let seen = self.covector_in_space(value.clone(), Shift::HERE.time);
        let seen = self.algebra.shortest(&seen);
        (!divides(s, &seen)).then_some(seen)
    }

    /// Quantities by their definitions.
    fn defined(&self, e: &Expr) -> Expr {
        let s = &self.d.letters.symbols;
        let advected = self.d.spec.advected.iter().zip(&self.d.transports);
        let values = advected.flat_map(|(a, t)| match t {
            AdvectionRule::Defined(value) => vec![
                (at(a.quantity, Shift::HERE), value.clone()),
                (at(a.quantity, Shift::NEXT), expr::shift_time(s, value, 1)),
            ],
            AdvectionRule::Carried { .. } | AdvectionRule::Advanced => Vec::new(),
        });
        expr::substitute(s, e, &values.collect::<Vec<_>>())
    }
}

/// Whether an expression contains the inverse of a configuration.
fn divides(s: &expr::symbol::Symbols, e: &Expr) -> bool {
    let moves = |e: &Expr| expr::contains_role(s, e, Role::Element);
    matches!(e.node(), Node::Inverse(a) if moves(a))
        || e.children().into_iter().any(|c| divides(s, c))
}
