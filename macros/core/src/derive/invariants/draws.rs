//! Random nodes at which the roots of the action exist and constraints are satisfied. In exact arithmetic half of
//! all numbers have a square root, so that a draw of many bodies at once would almost always fail. Bodies are drawn
//! one by one, each until the roots that it completes exist. Takes a model; gives nodes, and velocities that lead
//! to such nodes.

use super::{Inputs, here};
use crate::algebra::exact::Point;
use crate::check::spec::Advected;
use crate::derive::holds::Solved;
use crate::derive::variation::at;
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Letter, Node, Shift};

/// The largest number of draws for one body: with eight roots, one draw in 256 succeeds.
const TRIES: u64 = 2048;

/// The conditions on random nodes: roots that must exist, and constraints.
pub(crate) struct Roots {
    /// Roots, each with the last configuration that it depends on.
    list: Vec<(usize, Expr)>,
    /// Letters that constraints determine.
    solved: Solved,
}

impl Roots {
    /// The roots of the action that depend on configurations at a single node, with advected quantities replaced by
    /// their definitions.
    pub(super) fn of(x: &Inputs) -> Roots {
        let s = &x.letters.symbols;
        let mut all = Vec::new();
        collect(&x.action.total, &mut all);
        let defined = |a: &Advected| Some((here(a.quantity), a.definition.clone()?));
        let definitions: Vec<(Letter, Expr)> = x.spec.advected.iter().filter_map(defined).collect();
        let mut out: Vec<(usize, Expr)> = Vec::new();
        for root in all {
            let moving =
                |l: &Letter| matches!(s.get(l.symbol).role, Role::Element | Role::Advected);
            let letters = expr::letters(&root);
            let mut times: Vec<i8> = letters
                .iter()
                .filter(|l| moving(l))
                .map(|l| l.shift.time)
                .collect();
            times.dedup();
            let [time] = times.as_slice() else { continue };
            if expr::contains_role(s, &root, Role::Velocity) {
                continue;
            }
            let root = expr::substitute(s, &expr::shift_time(s, &root, -time), &definitions);
            let held = x.spec.configurations.iter().enumerate();
            let last = held
                .filter(|(_, c)| expr::contains(&root, here(c.element)))
                .map(|(i, _)| i)
                .max();
            let Some(last) = last else { continue };
            if !out.iter().any(|(_, known)| *known == root) {
                out.push((last, root));
            }
        }
        Roots {
            list: out,
            solved: Solved::of(x.spec, x.letters, x.algebra),
        }
    }

    /// Whether the end of every step satisfies the constraints that could be solved. False if these determine
    /// parameters, which all nodes share.
    pub(super) fn hold_everywhere(&self, x: &Inputs) -> bool {
        let role = |l: &Letter| x.letters.symbols.get(l.symbol).role;
        let mut letters = self.solved.list().iter().map(|(l, _)| l);
        letters.all(|l| role(l) == Role::Element)
    }

    fn exist(&self, at: &Point, last: usize) -> bool {
        let mut own = self.list.iter().filter(|(i, _)| *i == last);
        own.all(|(_, root)| at.value(root).is_some())
    }

    /// Sets the letters that constraints determine to their values; `None` if a root does not exist then.
    fn held(&self, node: &mut Point) -> Option<()> {
        if self.solved.list().is_empty() {
            return Some(());
        }
        for (letter, value) in self.solved.list() {
            node.set(*letter, node.value(value)?);
        }
        let mut roots = self.list.iter();
        roots
            .all(|(_, root)| node.value(root).is_some())
            .then_some(())
    }

    /// Draws the elements of a node again, if roots do not exist there.
    pub(super) fn placed(&self, x: &Inputs, node: &mut Point, attempt: u64) -> Option<()> {
        for (i, c) in x.spec.configurations.iter().enumerate() {
            let drawn = (0..TRIES).any(|turn| {
                if turn > 0
                    && let Some(value) = node.redrawn(mixed(attempt, turn)).letter(here(c.element))
                {
                    node.set(here(c.element), value);
                }
                self.exist(node, i)
            });
            drawn.then_some(())?;
        }
        self.held(node)
    }

    /// Draws the velocities of a step again, if roots do not exist at its end.
    pub(super) fn led(&self, x: &Inputs, node: &mut Point, attempt: u64) -> Option<()> {
        if self.list.is_empty() && self.solved.list().is_empty() {
            return Some(());
        }
        let mut end = node.clone();
        for (i, c) in x.spec.configurations.iter().enumerate() {
            let drawn = (0..TRIES).any(|turn| {
                if turn > 0
                    && let Some(value) = node.redrawn(mixed(attempt, turn)).letter(here(c.velocity))
                {
                    node.set(here(c.velocity), value);
                }
                let Some(moved) = node.value(&c.update) else {
                    return false;
                };
                end.set(here(c.element), moved);
                self.exist(&end, i)
            });
            drawn.then_some(())?;
        }
        self.held(&mut end)?;
        let s = &x.letters.symbols;
        for c in &x.spec.configurations {
            let l = here(c.element);
            if self.solved.list().iter().any(|(known, _)| *known == l) {
                let mut ends = node.clone();
                let next = expr::letter(s, c.element, Shift::NEXT);
                ends.set(at(c.element, Shift::NEXT), end.letter(l)?);
                let velocity = c.group.velocity(s, c.side, expr::here(s, c.element), next);
                node.set(here(c.velocity), ends.value(&velocity)?);
            }
        }
        Some(())
    }
}

fn mixed(attempt: u64, turn: u64) -> u64 {
    (attempt + 1) * TRIES + turn
}

/// Square roots, the innermost first.
fn collect(e: &Expr, out: &mut Vec<Expr>) {
    e.children().into_iter().for_each(|a| collect(a, out));
    if matches!(e.node(), Node::Power(_, q) if q.denominator() == 2) && !out.contains(e) {
        out.push(e.clone());
    }
}
