//! The update of the momentum from one node to the next: the impulse of the step is added to it. The momentum is
//! never recomputed from the velocity, because the rounding errors of `1/h` would affect conserved quantities. Takes
//! the action and its variations; gives the increment, in the form with the smallest rounding error.

use super::Letters;
use super::action::Action;
use super::advection_rule::AdvectionRule;
use super::axial::Axial;
use super::balance::{Balance, shorter};
use super::rounding::{Displacements, Rounding};
use super::variation::{Variation, at};
use crate::algebra::Algebra;
use crate::check::spec::{Configuration, Spec};
use crate::expr::shape::Shape;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter, Node, Shift};

/// The update of the node momentum of one configuration, with covectors in the frame of its side.
#[derive(Clone, Debug)]
pub enum MomentumUpdate {
    /// In this frame: `m' = m + added`. Exact if the action is invariant when both ends of the edge move together in
    /// this frame.
    Kept(Expr),
    /// Along the edge: `m' = Ad*(m + leave) + arrive`, with the impulses at its start and at its end. Exact if the
    /// action is invariant in the other frame.
    Through {
        /// The impulse at the start of the edge.
        leave: Expr,
        /// The impulse at its end.
        arrive: Expr,
        /// For a rigid motion in its body frame: whether the linear momentum is parallel to the displacement, as for
        /// a body about its centre of mass. The moment of the displacement is then zero; if computed, it would be the
        /// rounding error of two long vectors.
        straight: bool,
    },
}

impl MomentumUpdate {
    /// The expressions it contains.
    pub fn parts(&self) -> Vec<&Expr> {
        match self {
            MomentumUpdate::Kept(added) => vec![added],
            MomentumUpdate::Through { leave, arrive, .. } => vec![leave, arrive],
        }
    }

    fn is_zero(&self) -> bool {
        self.parts().into_iter().all(Expr::is_zero)
    }
}

/// The largest number of terms of a Lagrangian that are examined in groups.
const MOST_TERMS: usize = 32;

/// The results of the derivation so far.
pub struct Inputs<'a> {
    /// The model.
    pub spec: &'a Spec,
    /// Its letters.
    pub letters: &'a Letters,
    /// The action of one step.
    pub action: &'a Action,
    /// The changes of all quantities along the variations.
    pub variations: &'a [Variation],
    /// The balances.
    pub balances: &'a [Balance],
    /// How advected quantities follow from the configuration.
    pub transports: &'a [AdvectionRule],
}

/// The update of every momentum.
pub fn carries(inputs: &Inputs) -> Vec<MomentumUpdate> {
    let displacements = Displacements::of(inputs.spec, &inputs.letters.symbols);
    let symbols = &displacements.symbols;
    let algebra = Algebra::new(symbols);
    let work = Work {
        inputs,
        symbols,
        algebra: &algebra,
        displacements: &displacements,
    };
    (0..inputs.balances.len()).map(|i| work.carry(i)).collect()
}

struct Work<'a> {
    inputs: &'a Inputs<'a>,
    symbols: &'a Symbols,
    algebra: &'a Algebra<'a>,
    displacements: &'a Displacements,
}

impl Work<'_> {
    fn carry(&self, i: usize) -> MomentumUpdate {
        let (c, b) = (
            &self.inputs.spec.configurations[i],
            &self.inputs.balances[i],
        );
        let through = MomentumUpdate::Through {
            leave: expr::neg(b.node_out.clone()),
            arrive: b.node_in.clone(),
            straight: self.is_straight(c, b),
        };
        // An increment that is free of velocities is a force, and of the order of the step size.
        match &b.increment {
            Some(added) if c.side.is_spatial() => return MomentumUpdate::Kept(added.clone()),
            _ if c.side.is_body() && !self.moving(&through) => return through,
            _ => {}
        }
        let through = self.rounded_least(i, c, through);
        let kept = MomentumUpdate::Kept(self.added(i, c));
        if self.algebra.exhausted() {
            // For a model at the work limit, the plain difference is correct but less accurate.
            return if c.side.is_body() {
                through
            } else {
                MomentumUpdate::Kept(expr::sub(b.incoming.clone(), b.outgoing.clone()))
            };
        }
        let (first, second) = c.side.ordered(through, kept);
        let loss = |carry: &MomentumUpdate| match carry.is_zero() {
            true => f64::INFINITY,
            false => {
                let parts = carry.parts().into_iter();
                parts.fold(0.0, |worst: f64, e| worst.min(self.rounding().error(e)))
            }
        };
        match loss(&second) > loss(&first) {
            true => second,
            false => first,
        }
    }

    /// The impulses at the ends of the edge, in the form with the smallest rounding error: divisions by the step size
    /// may cancel in it.
    fn rounded_least(&self, i: usize, c: &Configuration, carry: MomentumUpdate) -> MomentumUpdate {
        let MomentumUpdate::Through {
            leave,
            arrive,
            straight,
        } = carry
        else {
            return carry;
        };
        let v = &self.inputs.variations[i];
        let least = |e: Expr, time: i8| {
            let moving = expr::contains_role(self.symbols, &e, Role::Velocity);
            if !moving || self.rounding().error(&e) >= 0.0 {
                return e;
            }
            let changes = v.advected.iter().chain([&v.element]).map(|(l, change)| {
                let change = expr::shift_time(self.symbols, change, time);
                (at(l.symbol, Shift { time, ..l.shift }), change)
            });
            let changes: Vec<(Letter, Expr)> = changes.collect();
            let derived = self.covector(i, c, &self.inputs.action.total, &changes);
            let all = [e, derived].into_iter().flat_map(|e| self.forms(&e));
            self.rounding().best(all.collect())
        };
        MomentumUpdate::Through {
            leave: least(leave, Shift::HERE.time),
            arrive: least(arrive, Shift::NEXT.time),
            straight,
        }
    }

    /// Whether the linear momentum due to the velocity is parallel to the displacement, in body axes.
    fn is_straight(&self, c: &Configuration, b: &Balance) -> bool {
        let s = self.symbols;
        let Some(rigid) = c.group.rigid().filter(|_| c.side.is_body()) else {
            return false;
        };
        let way = expr::column(s, &expr::here(s, c.velocity));
        let moment = rigid.moment(s, way, rigid.linear(s, &b.edge_out));
        self.algebra.is_zero(&moment)
    }

    fn rounding(&self) -> Rounding<'_> {
        Rounding {
            spec: self.inputs.spec,
            symbols: self.symbols,
            algebra: self.algebra,
        }
    }

    fn moving(&self, carry: &MomentumUpdate) -> bool {
        let parts = carry.parts().into_iter();
        parts
            .into_iter()
            .any(|e| expr::contains_role(self.symbols, e, Role::Velocity))
    }

    /// The increment of the momentum in one step, in the frame of the side: the derivative of the action when both ends
    /// of the edge move together.
    fn added(&self, i: usize, c: &Configuration) -> Expr {
        let along = self.alike(i);
        let terms = self.felt(&self.inputs.action.total, &along);
        let terms = self.without_groups(terms, &along);
        let each: Vec<Expr> = terms
            .iter()
            .map(|t| self.covector(i, c, t, &along))
            .collect();
        let shape = self.inputs.balances[i].outgoing.shape();
        let total = expr::sum(each.clone(), shape);
        let xi = self.inputs.letters.variation[i];
        let axial = Axial::of(self.symbols, c, xi, &along);
        let apart = each.iter().zip(&terms).map(|(e, t)| {
            let turned = axial.as_ref().and_then(|axial| axial.covector(t));
            let all = turned.into_iter().chain([e.clone()]);
            self.rounding()
                .best(all.flat_map(|e| self.forms(&e)).collect())
        });
        let apart = expr::sum(apart.collect::<Vec<_>>(), shape);
        let mut all = vec![apart];
        all.extend(self.forms(&total));
        self.rounding().best(all)
    }

    /// The changes of all quantities on the edge if its two ends move together.
    fn alike(&self, i: usize) -> Vec<(Letter, Expr)> {
        let (s, v) = (self.symbols, &self.inputs.variations[i]);
        let next = |(l, e): &(Letter, Expr)| (at(l.symbol, Shift::NEXT), expr::shift_time(s, e, 1));
        let (_, arriving) = next(&v.incoming);
        let (velocity, leaving) = &v.outgoing;
        let mut all = vec![(*velocity, expr::add(leaving.clone(), arriving))];
        for change in v.advected.iter().chain([&v.element]) {
            all.extend([change.clone(), next(change)]);
        }
        all
    }

    /// Whether the derivative of a scalar along a variation vanishes, with everything expressed by the start of the
    /// edge.
    fn vanishes(&self, e: &Expr, along: &[(Letter, Expr)]) -> bool {
        let s = self.symbols;
        let change = expr::directional(s, e, along);
        if change.is_zero() {
            return true;
        }
        let forward = expr::substitute(s, &change, &self.inputs.spec.end_of_edge());
        if self.algebra.is_zero(&forward) {
            return true;
        }
        // The definition of a quantity shows properties that its letter does not.
        let advected = self.inputs.spec.advected.iter();
        let defined: Vec<(Letter, Expr)> = advected
            .zip(self.inputs.transports)
            .filter_map(|(a, t)| match t {
                AdvectionRule::Defined(value) | AdvectionRule::Carried { value, .. } => {
                    Some((at(a.quantity, Shift::HERE), value.clone()))
                }
                AdvectionRule::Advanced => None,
            })
            .collect();
        !defined.is_empty()
            && self
                .algebra
                .is_zero(&expr::substitute(s, &forward, &defined))
    }

    /// The terms of a scalar that change along a variation.
    fn felt(&self, e: &Expr, along: &[(Letter, Expr)]) -> Vec<Expr> {
        if e.is_zero() || self.vanishes(e, along) {
            return Vec::new();
        }
        let constant = |x: &Expr| {
            let fixed = |l: &Letter| !along.iter().any(|(moved, _)| moved == l);
            expr::letters(x).iter().all(fixed)
        };
        match e.node() {
            Node::Sum(terms) => terms.iter().flat_map(|t| self.felt(t, along)).collect(),
            Node::Neg(a) => self.felt(a, along).into_iter().map(expr::neg).collect(),
            Node::Quotient(a, b) if constant(b) => {
                let terms = self.felt(a, along).into_iter();
                terms.map(|t| expr::quotient(t, b.clone())).collect()
            }
            Node::Product(factors) => {
                let (fixed, moved): (Vec<Expr>, Vec<Expr>) =
                    factors.iter().cloned().partition(constant);
                let [only] = moved.as_slice() else {
                    return vec![e.clone()];
                };
                if !only.shape().is_scalar() || !fixed.iter().all(|f| f.shape().is_scalar()) {
                    return vec![e.clone()];
                }
                let with = |t| expr::product(fixed.iter().cloned().chain([t]));
                self.felt(only, along).into_iter().map(with).collect()
            }
            _ => vec![e.clone()],
        }
    }

    /// Removes groups of terms in the same velocities whose changes cancel.
    fn without_groups(&self, mut terms: Vec<Expr>, along: &[(Letter, Expr)]) -> Vec<Expr> {
        if terms.len() > MOST_TERMS {
            return terms;
        }
        let velocities = |e: &Expr| -> Vec<Letter> {
            let letters = expr::letters(e).into_iter();
            letters
                .filter(|l| self.symbols.get(l.symbol).role == Role::Velocity)
                .collect()
        };
        let mut kinds: Vec<Vec<Letter>> = terms.iter().map(&velocities).collect();
        kinds.sort();
        kinds.dedup();
        for kind in kinds {
            let group = terms.iter().filter(|t| velocities(t) == kind).cloned();
            let group: Vec<Expr> = group.collect();
            if group.len() > 1 && self.vanishes(&expr::sum(group, Shape::SCALAR), along) {
                terms.retain(|t| velocities(t) != kind);
            }
        }
        terms
    }

    /// The derivative of a scalar along a variation as a covector.
    fn covector(&self, i: usize, c: &Configuration, e: &Expr, along: &[(Letter, Expr)]) -> Expr {
        let xi = at(self.inputs.letters.variation[i], Shift::HERE);
        let change = expr::directional(self.symbols, e, along);
        let y = expr::gradient(self.symbols, &change, xi);
        c.group.of_gradient(self.symbols, y)
    }

    /// The covector as derived, in its normal form, and in the normal form for velocities minus the identity.
    fn forms(&self, e: &Expr) -> Vec<Expr> {
        vec![
            e.clone(),
            shorter(self.algebra, e.clone()),
            self.displacements
                .normal_form(self.inputs.spec, self.algebra, e),
        ]
    }
}
