//! The systems that a step solves. Velocities that occur in each other's equations, directly or through other
//! velocities, form one block. Each block is classified and solved separately; forces between blocks depend only on
//! values that are known at the node. Takes the balances and their Riccati forms; gives the blocks and the method
//! of each.

use super::balance::{Balance, shorter};
use super::holds;
use super::seen_from_body::outgoing;
use super::select_solver::{BECAUSE, Method, Solve, StepEquation, is_constant, is_of_space};
use super::two_sided_linear::TwoSidedLinear;
use super::variation::at;
use super::{Derivation, Letters};
use crate::algebra::Algebra;
use crate::check::spec::{Hold, Spec};
use crate::expr::{self, Expr, Shift};

/// Configurations whose velocities are solved together.
#[derive(Clone, Debug)]
pub struct Block {
    /// Its configurations, in the order of the model.
    pub members: Vec<usize>,
    /// The method: a left factor, Davenport's eigenvalue problem, a linear balance or Newton.
    pub method: Method,
    /// The method in words and, after `BECAUSE`, the reason for it.
    pub reason: String,
    /// The constraints whose multipliers are solved with it.
    pub holds: Vec<usize>,
    /// Whether its balances are one linear system in the velocities, which Newton's method solves.
    pub is_one_system: bool,
}

impl Block {
    /// Whether its balance is linear in the velocity.
    pub fn is_linear(&self) -> bool {
        matches!(self.method, Method::Linear)
    }

    /// How a step solves a linear balance.
    pub fn linear_work(&self) -> Option<&str> {
        let (work, _) = self.reason.split_once(BECAUSE)?;
        self.is_linear().then_some(work)
    }

    /// Whether it is a Moser-Veselov equation with a left factor known at the node.
    pub fn has_factor(&self) -> bool {
        matches!(self.method, Method::LeftFactor | Method::Davenport)
    }

    /// Whether it is solved by Newton's method.
    pub fn is_newton(&self) -> bool {
        matches!(self.method, Method::Newton)
    }
}

/// The blocks of a model, in the order of their first members.
pub fn blocks(
    spec: &Spec,
    letters: &Letters,
    balances: &[Balance],
    riccati: &[StepEquation],
    algebra: &Algebra,
) -> Vec<Block> {
    let momenta = outgoing(spec, letters, balances);
    let velocities = spec.configurations.iter();
    let velocities: Vec<_> = velocities.map(|c| at(c.velocity, Shift::HERE)).collect();
    // The first member of the block of each configuration; an action couples both ways.
    let mut first: Vec<usize> = (0..velocities.len()).collect();
    for (i, momentum) in momenta.iter().enumerate() {
        for (j, w) in velocities.iter().enumerate() {
            if !expr::contains(momentum, *w) || first[i] == first[j] {
                continue;
            }
            let (low, high) = (first[i].min(first[j]), first[i].max(first[j]));
            for f in first.iter_mut().filter(|f| **f == high) {
                *f = low;
            }
        }
    }
    // A constraint couples all configurations in it.
    let held = |hold: &Hold| -> Vec<usize> {
        let each = 0..velocities.len();
        each.filter(|i| holds::holds(&letters.symbols, spec, hold, *i))
            .collect()
    };
    let held: Vec<Vec<usize>> = spec.holds.iter().map(held).collect();
    for members in &held {
        let low = members.iter().map(|i| first[*i]).min().unwrap_or(0);
        let tied: Vec<usize> = members.iter().map(|i| first[*i]).collect();
        for f in first.iter_mut().filter(|f| tied.contains(f)) {
            *f = low;
        }
    }
    let starts = (0..first.len()).filter(|i| first[*i] == *i);
    let members = starts.map(|i| (0..first.len()).filter(|j| first[*j] == i).collect());
    members
        .map(|members| {
            let mut block = block(spec, letters, riccati, members);
            let own = |j: &usize| held[*j].first().is_some_and(|i| block.members.contains(i));
            block.holds = (0..held.len()).filter(own).collect();
            if !block.holds.is_empty() {
                block.method = Method::Newton;
                block.reason = HELD.to_owned();
                return block;
            }
            if block.is_newton()
                && linear_together(spec, letters, balances, &block.members, algebra)
            {
                block.is_one_system = true;
                block.reason = ONE_SYSTEM.to_owned();
            }
            block
        })
        .collect()
}

/// How velocities are solved together with multipliers.
pub(super) const HELD: &str = "Newton's method for velocities and multipliers together, because the constraints must be satisfied at the end of the step";

/// Why Newton's method solves a linear system.
const ONE_SYSTEM: &str = "one linear system, which the first correction of Newton's method solves";

/// Whether the balances of these configurations are linear in all their velocities together; on GL(n) and for fields.
fn linear_together(
    spec: &Spec,
    letters: &Letters,
    balances: &[Balance],
    members: &[usize],
    algebra: &Algebra,
) -> bool {
    let s = &letters.symbols;
    let group = |i: &usize| spec.configurations[*i].group;
    if !members
        .iter()
        .all(|i| group(i).is_additive() || group(i).is_linear())
    {
        return false;
    }
    let velocity = |i: &usize| at(spec.configurations[*i].velocity, Shift::HERE);
    let changes: Vec<_> = members
        .iter()
        .map(|i| (velocity(i), expr::here(s, letters.variation[*i])))
        .collect();
    members.iter().all(|i| {
        let momentum = expr::substitute(s, &balances[*i].outgoing, &spec.end_of_edge());
        let change = shorter(algebra, expr::directional(s, &momentum, &changes));
        members
            .iter()
            .all(|j| !expr::contains(&change, velocity(j)))
    })
}

fn block(spec: &Spec, letters: &Letters, riccati: &[StepEquation], members: Vec<usize>) -> Block {
    let (method, reason) = match members.as_slice() {
        [i] => match &riccati[*i] {
            StepEquation::Exact(mv) if is_constant(letters, mv) => (
                Method::LeftFactor,
                format!("a Moser-Veselov solver{BECAUSE}its left factor is constant"),
            ),
            StepEquation::Exact(_) if is_of_space(&spec.configurations[*i]) => (
                Method::Davenport,
                format!(
                    "the largest real eigenvalue of a 4 x 4 matrix{BECAUSE}its left factor is known at each node"
                ),
            ),
            StepEquation::Quaternionic(q)
                if is_constant(letters, &q.edge) && spec.configurations[*i].side.is_body() =>
            {
                let how = format!("one scalar equation{BECAUSE}its coefficients are constant");
                (Method::UnitQuaternions, how)
            }
            StepEquation::Linear(form) => (Method::Linear, linear(form)),
            StepEquation::None(why) => (Method::Newton, format!("Newton's method{BECAUSE}{why}")),
            _ => (Method::Newton, "Newton's method".to_owned()),
        },
        _ => (
            Method::Newton,
            format!("Newton's method{BECAUSE}their equations are coupled"),
        ),
    };
    Block {
        members,
        method,
        reason,
        holds: Vec::new(),
        is_one_system: false,
    }
}

/// How a linear balance is solved.
fn linear(form: &TwoSidedLinear) -> String {
    let number = |e: &Expr| e.shape().is_scalar();
    let what = match (number(&form.left), number(&form.right)) {
        (true, true) => "one division",
        (false, false) => "two small linear systems",
        _ => "one small linear system",
    };
    format!("{what}{BECAUSE}the balance is linear")
}

/// The methods of all blocks in one sentence, with equal ones combined.
pub fn reasons(letters: &Letters, spec: &Spec, blocks: &[Block]) -> String {
    if let [only] = blocks {
        return only.reason.clone();
    }
    let name = |i: &usize| {
        let velocity = spec.configurations[*i].velocity;
        letters.symbols.get(velocity).name.clone()
    };
    let mut groups: Vec<(&str, Vec<String>)> = Vec::new();
    for b in blocks {
        let names: Vec<String> = b.members.iter().map(name).collect();
        let names = names.join(" with ");
        match groups.iter_mut().find(|(reason, _)| *reason == b.reason) {
            Some((_, list)) => list.push(names),
            None => groups.push((&b.reason, vec![names])),
        }
    }
    let each = groups.iter().map(|(reason, list)| match list.as_slice() {
        [only] => format!("{only} by {reason}"),
        several => format!("{} each by {reason}", several.join(", ")),
    });
    let clauses: Vec<String> = each.collect();
    clauses.join("; ")
}

impl Derivation {
    /// A block as a model of its own, with the other configurations known: its configurations, their equations and
    /// the method of their solution. All else is copied from the whole model.
    pub fn of_block(&self, b: &Block) -> Derivation {
        fn part<T: Clone>(list: &[T], members: &[usize]) -> Vec<T> {
            let kept = members.iter().filter_map(|i| list.get(*i));
            kept.cloned().collect()
        }
        let mut own = self.clone();
        let members = b.members.as_slice();
        own.spec.configurations = part(&self.spec.configurations, members);
        let letters = &mut own.letters;
        for list in [
            &mut letters.variation,
            &mut letters.direction,
            &mut letters.rate,
            &mut letters.acceleration,
            &mut letters.momentum,
            &mut letters.edge_momentum,
            &mut letters.node_momentum,
        ] {
            *list = part(list, members);
        }
        own.balances = part(&self.balances, members);
        own.carries = part(&self.carries, members);
        let seen = self.solve.seen_from_body.as_ref();
        own.solve = Solve {
            riccati: part(&self.solve.riccati, members),
            method: b.method.clone(),
            reason: b.reason.clone(),
            turned: None,
            seen_from_body: seen.map(|list| part(list, members)),
            blocks: Vec::new(),
            one_system: Vec::new(),
        };
        match b.holds.is_empty() {
            true => own,
            false => own.with_multipliers(&b.holds),
        }
    }
}

#[cfg(test)]
mod tests;
