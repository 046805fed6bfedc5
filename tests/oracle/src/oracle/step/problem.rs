//! A step to solve, and the derivatives in its equations: first derivatives to 32 digits, second derivatives to 16, and the
//! constraints.

use super::action::Action;
use super::action::{Edge, On};
use super::motion::Block;
use super::place::{Place, Table};
use crate::oracle::dual::{Dual, Number};
use crate::oracle::pair::Pair;

/// A step to solve.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The action.
    pub action: Action,
    /// The step size.
    pub h: f64,
    /// Names of parameters and initial values.
    pub names: Table,
    /// Their values.
    pub given: Vec<Pair>,
    /// Names of the configuration.
    pub moving: Table,
    /// How each configuration is varied.
    pub blocks: Vec<Block>,
    /// The initial configuration, as the model receives it.
    pub told: Vec<Pair>,
    /// The initial configuration, with elements exactly in their groups.
    pub start: Vec<Pair>,
    /// Initial momenta, along the directions of all blocks.
    pub momenta: Vec<Pair>,
    /// For a chain: the largest distance of coupled sites, and the number of sites if it is a ring.
    pub reach: Option<(usize, Option<usize>)>,
}

/// An end of the edge.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum End {
    Tail,
    Head,
}

impl Problem {
    /// All directions: the block and the index of the direction.
    fn directions(&self) -> impl Iterator<Item = (&Block, usize)> {
        let all = self.blocks.iter();
        all.flat_map(|b| (0..b.directions()).map(move |d| (b, d)))
    }

    fn evaluated<T: Number>(&self, f: On<T>, lists: [&[T]; 4]) -> T {
        let [given, start, tail, head] = lists;
        let moving = |values| Place {
            table: &self.moving,
            values,
        };
        f(&Edge {
            h: T::constant(self.h),
            given: Place {
                table: &self.names,
                values: given,
            },
            start: moving(start),
            tail: moving(tail),
            head: moving(head),
        })
    }

    /// `D1 L` or `D2 L` along all directions.
    pub(super) fn gradient(&self, head: &[Pair], end: End) -> Vec<Pair> {
        let still =
            |list: &[Pair]| -> Vec<Dual<Pair>> { list.iter().map(|x| steady(*x)).collect() };
        let (given, start, at_head) = (still(&self.given), still(&self.start), still(head));
        let value = match end {
            End::Tail => &self.start,
            End::Head => head,
        };
        let each = self.directions().map(|(block, direction)| {
            let mut varied = still(value);
            let own = block.at..block.at + block.size();
            let tangent = block.tangent(&value[own.clone()], direction);
            for (x, slope) in varied[own].iter_mut().zip(tangent) {
                x.slope = slope;
            }
            let ends = match end {
                End::Tail => [&varied, &at_head],
                End::Head => [&start, &varied],
            };
            self.evaluated(self.action.precise, [&given, &start, ends[0], ends[1]])
                .slope
        });
        each.collect()
    }

    /// The mixed second derivatives of the action with respect to tail and head.
    pub(super) fn mixed<T: Number>(
        &self,
        f: On<Dual<Dual<T>>>,
        [tail, head]: [&[Pair]; 2],
        of: fn(Pair) -> T,
    ) -> Vec<Vec<T>> {
        let plain = |list: &[Pair]| -> Vec<T> { list.iter().map(|x| of(*x)).collect() };
        let twice = |list: &[T]| -> Vec<Dual<Dual<T>>> {
            let all = list.iter();
            all.map(|x| steady(steady(*x))).collect()
        };
        let (given, start) = (twice(&plain(&self.given)), twice(&plain(&self.start)));
        let (tail, head) = (plain(tail), plain(head));
        let together = self.together();
        let rows = self.directions().map(|(row, by_tail)| {
            let mut from = twice(&tail);
            let own = row.at..row.at + row.size();
            let tangent = row.tangent(&tail[own.clone()], by_tail);
            for (x, slope) in from[own].iter_mut().zip(tangent) {
                x.slope.value = slope;
            }
            let mut out = vec![of(Pair::constant(0.0)); together.iter().map(Vec::len).sum()];
            for all in &together {
                let mut to = twice(&head);
                for (_, column, by_head) in all {
                    let own = column.at..column.at + column.size();
                    let tangent = column.tangent(&head[own.clone()], *by_head);
                    for (x, slope) in to[own].iter_mut().zip(tangent) {
                        x.value.slope = slope;
                    }
                }
                let found = self.evaluated(f, [&given, &start, &from, &to]).slope.slope;
                // Among the directions varied together, at most one is near enough to contribute.
                if let Some((k, ..)) = all.iter().find(|(_, b, _)| self.is_near(row, b)) {
                    out[*k] = found;
                }
            }
            out
        });
        rows.collect()
    }

    /// Whether one term may contain the velocities of both configurations.
    fn is_near(&self, a: &Block, b: &Block) -> bool {
        let Some((reach, ring)) = self.reach else {
            return true;
        };
        let apart = a.site.abs_diff(b.site);
        apart <= reach || ring.is_some_and(|n| n - apart <= reach)
    }

    /// Groups of directions that can be varied together: no configuration is near two of them.
    fn together(&self) -> Vec<Vec<(usize, &Block, usize)>> {
        let mut out: Vec<Vec<(usize, &Block, usize)>> = Vec::new();
        for (k, (block, direction)) in self.directions().enumerate() {
            let is_apart = |other: &Block| {
                let mut all = self.blocks.iter();
                !all.any(|near| self.is_near(near, block) && self.is_near(near, other))
            };
            let free = out
                .iter_mut()
                .find(|all| all.iter().all(|(_, other, _)| is_apart(other)));
            match free {
                Some(all) => all.push((k, block, direction)),
                None => out.push(vec![(k, block, direction)]),
            }
        }
        out
    }

    /// The constraints at a node, and their derivatives along all directions.
    pub(super) fn held(&self, node: &[Pair]) -> (Vec<Pair>, Vec<Vec<Pair>>) {
        let Some((held, _)) = self.action.held else {
            return (Vec::new(), Vec::new());
        };
        let still =
            |list: &[Pair]| -> Vec<Dual<Pair>> { list.iter().map(|x| steady(*x)).collect() };
        let given = still(&self.given);
        let given = Place {
            table: &self.names,
            values: &given,
        };
        let at = |values: &[Dual<Pair>]| {
            let table = &self.moving;
            held(&given, &Place { table, values })
        };
        let values: Vec<Pair> = at(&still(node)).iter().map(|x| x.value).collect();
        let mut rows = vec![Vec::new(); values.len()];
        for (block, direction) in self.directions() {
            let mut varied = still(node);
            let own = block.at..block.at + block.size();
            let tangent = block.tangent(&node[own.clone()], direction);
            for (x, slope) in varied[own].iter_mut().zip(tangent) {
                x.slope = slope;
            }
            for (row, x) in rows.iter_mut().zip(at(&varied)) {
                row.push(x.slope);
            }
        }
        (values, rows)
    }

    /// A node moved by `by` along the directions.
    #[must_use]
    pub fn moved(&self, node: &[Pair], by: &[Pair]) -> Vec<Pair> {
        let mut out = node.to_vec();
        let mut from = 0;
        for block in &self.blocks {
            let own = block.at..block.at + block.size();
            let amount = &by[from..from + block.directions()];
            from += block.directions();
            let moved = block.moved(&node[own.clone()], amount);
            out[own].copy_from_slice(&moved);
        }
        out
    }
}

/// A constant.
fn steady<T: Number>(value: T) -> Dual<T> {
    Dual {
        value,
        slope: T::constant(0.0),
    }
}
