//! Compares a step of a model with the solution, and with the sensitivity to its data. Gives errors in units of increments and
//! momenta, and the change of both if every datum changes in its last bit.

use super::group::inverse;
use super::motion::{Block, Motion};
use super::place::Letter;
use super::problem::Problem;
use super::solve::Solved;
use crate::oracle::dual::Number;
use crate::oracle::pair::Pair;
use crate::oracle::points::Source;
use crate::oracle::sides::Side;

/// Half a unit in the last place of one.
pub const ROUNDING: f64 = f64::EPSILON / 2.0;

/// Relative errors of increments and momenta; the largest over all blocks.
#[derive(Clone, Copy, Debug, Default)]
pub struct Off {
    /// The error of increments, without the rounding of the configuration that the model returns.
    pub increment: f64,
    /// The error of momenta.
    pub momentum: f64,
}

impl Off {
    /// The larger of both, component by component.
    #[must_use]
    pub fn worse(self, other: Off) -> Off {
        let larger = |a: f64, b: f64| if a >= b { a } else { b };
        Off {
            increment: larger(self.increment, other.increment),
            momentum: larger(self.momentum, other.momentum),
        }
    }
}

/// NaN counts as infinite.
fn largest(list: impl IntoIterator<Item = f64>) -> f64 {
    list.into_iter().fold(0.0, |most, x| match x.is_nan() {
        true => f64::INFINITY,
        false => x.abs().max(most),
    })
}

/// A fraction; 0/0 counts as 0.
fn part(of: f64, whole: f64) -> f64 {
    if of == 0.0 { 0.0 } else { of / whole }
}

/// The rounding error of a returned group element, as an increment. Each entry is a sum of `rows` rounded products, counted twice
/// for the orthonormalisation. The initial element that the model received may deviate from its group by rounding, and the
/// deviation persists.
fn shown(block: &Block, told: &[Pair], tail: &[Pair], head: &[Pair]) -> Vec<f64> {
    let n = block.rows;
    let Motion::Turned(_, side) = &block.motion else {
        // The previous position and its increment have one rounding error each.
        return head.iter().map(|x| 2.0 * ROUNDING * x.high.abs()).collect();
    };
    let back = inverse(n, tail);
    let absolute = |list: &[Pair]| -> Vec<f64> { list.iter().map(|x| x.high.abs()).collect() };
    let times = |a: &[f64], b: &[f64]| super::group::product(n, a, b);
    let turn = match side {
        Side::Body => super::group::product(n, &back, head),
        Side::Space => super::group::product(n, head, &back),
    };
    let (there, turn, back) = (absolute(tail), absolute(&turn), absolute(&back));
    let entries = match side {
        Side::Body => times(&back, &times(&there, &turn)),
        Side::Space => times(&times(&turn, &there), &back),
    };
    let outside = tail.iter().zip(told).map(|(a, b)| (*a - *b).high);
    let outside = largest(outside) * n as f64;
    let each = 4.0 * n as f64 * ROUNDING;
    entries.iter().map(|x| each * x + outside).collect()
}

impl Problem {
    /// The distance between the model's end of this step and the solution.
    #[must_use]
    pub fn off(&self, solved: &Solved, head: &[Pair], momenta: &[f64]) -> Off {
        let mut out = Off::default();
        let mut from = 0;
        for block in &self.blocks {
            let own = block.at..block.at + block.size();
            let (tail, end) = (&self.start[own.clone()], &solved.head[own.clone()]);
            let change: Vec<Pair> = head[own.clone()]
                .iter()
                .zip(end)
                .map(|(a, b)| *a - *b)
                .collect();
            let change = block.as_increment(tail, &change);
            let rounding = shown(block, &self.told[own], tail, end);
            let beyond = change
                .iter()
                .zip(rounding)
                .map(|(x, r)| match x.high.is_nan() {
                    true => f64::INFINITY,
                    false => (x.high.abs() - r).max(0.0),
                });
            let size = largest(block.increment(tail, end).iter().map(|x| x.high));
            let range = from..from + block.directions();
            from = range.end;
            if range.is_empty() {
                continue;
            }
            let wanted = &solved.momenta[range.clone()];
            let before = &self.momenta[range.clone()];
            let apart = momenta[range]
                .iter()
                .zip(wanted)
                .map(|(a, b)| (Pair::constant(*a) - *b).high);
            let weight = largest(wanted.iter().chain(before).map(|x| x.high));
            out = out.worse(Off {
                increment: part(largest(beyond), size),
                momentum: part(largest(apart), weight),
            });
        }
        out
    }

    /// The change of the solution, in the same units, if all data change in their last bits.
    #[must_use]
    pub fn response(&self, solved: &Solved, source: &mut Source) -> Off {
        let mut out = Off::default();
        for _ in 0..3 {
            let other = self.disturbed(source);
            let end = (solved.head.clone(), solved.impulses.clone());
            let Some(moved) = other.refined(end, solved.tangent.clone()) else {
                return Off {
                    increment: f64::INFINITY,
                    momentum: f64::INFINITY,
                };
            };
            let mut from = 0;
            for block in &self.blocks {
                let own = block.at..block.at + block.size();
                let own = |list: &[Pair]| list[own.clone()].to_vec();
                let here = block.increment(&own(&self.start), &own(&solved.head));
                let there = block.increment(&own(&other.start), &own(&moved.head));
                let range = from..from + block.directions();
                from = range.end;
                if range.is_empty() {
                    continue;
                }
                let (p, q) = (
                    &solved.momenta[range.clone()],
                    &moved.momenta[range.clone()],
                );
                let apart =
                    |a: &[Pair], b: &[Pair]| largest(a.iter().zip(b).map(|(x, y)| (*x - *y).high));
                let before = &self.momenta[range];
                let weight = largest(p.iter().chain(before).map(|x| x.high));
                let size = largest(here.iter().map(|x| x.high));
                out = out.worse(Off {
                    increment: part(apart(&here, &there), size),
                    momentum: part(apart(p, q), weight),
                });
            }
        }
        out
    }

    /// The same problem with the last bit of each datum changed up or down.
    fn disturbed(&self, source: &mut Source) -> Problem {
        let mut other = self.clone();
        let mut bit = || {
            Pair::constant(if source.chance(50) {
                f64::EPSILON
            } else {
                -f64::EPSILON
            })
        };
        for letter in &self.names.letters {
            disturb(letter, &mut other.given, &mut bit);
        }
        let momenta = self.momenta.iter().map(|p| *p + *p * bit());
        other.momenta = momenta.collect();
        let count: usize = self.blocks.iter().map(Block::directions).sum();
        let turned: Vec<Pair> = (0..count).map(|_| bit()).collect();
        // A group element rotates by the rounding unit; a position changes by its own last bit.
        let moved = self.moved(&self.start, &turned);
        for block in &self.blocks {
            for k in block.at..block.at + block.size() {
                other.start[k] = match block.motion {
                    Motion::Turned(..) => moved[k],
                    Motion::Added => self.start[k] + self.start[k] * bit(),
                    Motion::Fixed => self.start[k],
                };
            }
        }
        other
    }
}

/// Changes the last bits of one value; symmetric and skew matrices stay so.
fn disturb(letter: &Letter, values: &mut [Pair], bit: &mut impl FnMut() -> Pair) {
    let (rows, cols) = (letter.rows, letter.cols);
    for site in 0..letter.sites {
        let from = letter.at + site * rows * cols;
        let own = values[from..from + rows * cols].to_vec();
        let is = |sign: f64| {
            let mut all = (0..rows * cols).map(|k| (k / cols, k % cols));
            rows == cols
                && all.all(|(i, j)| own[i * cols + j].high == sign * own[j * cols + i].high)
        };
        let is_mirrored = is(1.0) || is(-1.0);
        for i in 0..rows {
            for j in 0..cols {
                if is_mirrored && j > i {
                    continue;
                }
                let by = bit();
                let places = [(i, j), (j, i)];
                for (i, j) in &places[..if is_mirrored && i != j { 2 } else { 1 }] {
                    let k = i * cols + j;
                    values[from + k] = own[k] + own[k] * by;
                }
            }
        }
    }
}
