//! Parameters that satisfy conditions: the coordinates in which they may vary, and a damped Gauss-Newton iteration
//! from given values. Takes equations and inequalities between parameters; gives values that satisfy them, or None.
//! The work is bounded, in nodes evaluated.

use super::draw;
use crate::check::spec::Assumption;
use crate::derive::bracket;
use crate::expr::shape::Structure;
use crate::expr::symbol::{SymbolId, Symbols};
use crate::expr::{self, Expr};
use crate::interpret::{Assignment, Matrix, evaluate};
use crate::syntax::ast::Comparison;
use std::cell::Cell;

/// A condition on the parameters.
pub(super) struct Condition {
    difference: Expr,
    bound: Expr,
    relation: Comparison,
}

/// Two values count as equal if they differ by less than this fraction of the size of their terms.
const EQUAL: f64 = 1e-9;

/// The relative margin by which an inequality must hold, so that rounding does not matter.
const CLEAR: f64 = 1e-6;

impl Condition {
    /// The condition of an assumption.
    pub(super) fn of(symbols: &Symbols, a: &Assumption) -> Condition {
        Condition::new(symbols, a, a.relation)
    }

    /// The condition that an inequality does not hold; None for an equation.
    pub(super) fn opposite(symbols: &Symbols, a: &Assumption) -> Option<Condition> {
        Some(Condition::new(symbols, a, a.relation.opposite()?))
    }

    fn new(symbols: &Symbols, a: &Assumption, relation: Comparison) -> Condition {
        let difference = expr::sub(a.left.clone(), a.right.clone());
        Condition {
            bound: expr::magnitude(symbols, &difference),
            difference,
            relation,
        }
    }

    /// The number of nodes that one evaluation visits.
    fn cost(&self) -> u64 {
        u64::from(self.difference.size()) + u64::from(self.bound.size())
    }
}

/// The remaining work.
pub(super) struct Budget(Cell<u64>);

impl Budget {
    /// A budget of this many nodes.
    pub(super) fn new(nodes: u64) -> Budget {
        Budget(Cell::new(nodes))
    }

    /// Whether the budget is used up, so that an unsuccessful search proves nothing.
    pub(super) fn is_spent(&self) -> bool {
        self.0.get() == 0
    }

    fn take(&self, nodes: u64) -> Option<()> {
        let left = self.0.get().checked_sub(nodes);
        self.0.set(left.unwrap_or(0));
        left.map(|_| ())
    }
}

/// Conditions on some parameters, with the entries that may vary.
pub(super) struct Problem<'a> {
    symbols: &'a Symbols,
    conditions: &'a [Condition],
    letters: Vec<SymbolId>,
    free: Vec<(SymbolId, usize, usize)>,
    budget: &'a Budget,
}

/// The largest number of entries that vary together.
const MOST: usize = 48;

/// The number of iterations from one start.
const ITERATIONS: usize = 40;

impl<'a> Problem<'a> {
    /// The problem of some conditions; `None` if too many entries would vary.
    pub(super) fn new(
        symbols: &'a Symbols,
        conditions: &'a [Condition],
        budget: &'a Budget,
    ) -> Option<Problem<'a>> {
        let all = conditions.iter().flat_map(|c| expr::letters(&c.difference));
        let mut letters: Vec<SymbolId> = all.map(|l| l.symbol).collect();
        letters.sort();
        letters.dedup();
        let mut free = Vec::new();
        for id in &letters {
            let symbol = symbols.get(*id);
            let size = |d| draw::size(symbols, d);
            let (rows, cols) = (size(symbol.shape.rows), size(symbol.shape.cols));
            match symbol.structure {
                // These vary along curves, so they keep their initial value.
                Structure::Orthogonal | Structure::UnitQuaternion | Structure::RigidMotion => {}
                other => {
                    let entries = bracket::coordinates(other, rows, cols).into_iter();
                    free.extend(entries.map(|(i, j)| (*id, i, j)));
                }
            }
        }
        (free.len() <= MOST).then_some(Problem {
            symbols,
            conditions,
            letters,
            free,
            budget,
        })
    }

    /// The parameters that occur in the conditions.
    pub(super) fn letters(&self) -> &[SymbolId] {
        &self.letters
    }

    /// Whether the values satisfy every condition exactly as stated, without a margin.
    pub(super) fn holds(&self, values: &Assignment) -> bool {
        let mut all = self.conditions.iter();
        all.all(|c| match self.measured(c, values) {
            None => false,
            Some((d, bound)) => {
                let x = d.get(0, 0);
                match c.relation {
                    Comparison::Equal => d.data.iter().all(|x| x.abs() <= EQUAL * bound),
                    Comparison::Greater => x > 0.0,
                    Comparison::AtLeast => x >= 0.0,
                    Comparison::Less => x < 0.0,
                    Comparison::AtMost => x <= 0.0,
                }
            }
        })
    }

    /// Values near the given ones that meet the conditions, if the iteration finds some.
    pub(super) fn solve(&self, start: &Assignment) -> Option<Assignment> {
        if self.holds(start) {
            return Some(start.clone());
        }
        let mut values = start.clone();
        let mut r = self.residual(&values)?;
        let mut damping = 1e-3;
        for _ in 0..ITERATIONS {
            let columns: Vec<Vec<f64>> = (0..self.free.len())
                .map(|k| {
                    let by = 1e-7 * (1.0 + self.entry(&values, k).abs());
                    let moved = self.moved(&values, |j| if j == k { by } else { 0.0 });
                    let new = self.residual(&moved)?;
                    Some(new.iter().zip(&r).map(|(a, b)| (a - b) / by).collect())
                })
                .collect::<Option<_>>()?;
            let mut better = None;
            for _ in 0..6 {
                let step = damped(&columns, &r, damping);
                let moved = self.moved(&values, |j| step.get(j).copied().unwrap_or(0.0));
                let new = self.residual(&moved);
                if let Some(new) = new.filter(|new| square(new) < square(&r)) {
                    better = Some((moved, new));
                    damping = (damping / 10.0).max(1e-12);
                    break;
                }
                damping *= 10.0;
            }
            let (moved, new) = better?;
            (values, r) = (moved, new);
            if self.holds(&values) {
                return Some(values);
            }
        }
        None
    }

    /// Left side minus right side, and a bound of the size of their terms.
    fn measured(&self, c: &Condition, values: &Assignment) -> Option<(Matrix, f64)> {
        self.budget.take(c.cost())?;
        let d = evaluate(self.symbols, &c.difference, values).ok()?;
        let bound = evaluate(self.symbols, &c.bound, values).ok()?.get(0, 0);
        let finite = d.data.iter().all(|x| x.is_finite()) && bound.is_finite();
        finite.then_some((d, bound))
    }

    /// A vector that vanishes if all conditions hold by the margin [`CLEAR`].
    fn residual(&self, values: &Assignment) -> Option<Vec<f64>> {
        let mut out = Vec::new();
        for c in self.conditions {
            let (d, bound) = self.measured(c, values)?;
            let x = d.get(0, 0);
            match c.relation {
                Comparison::Equal => out.extend(d.data),
                Comparison::Greater | Comparison::AtLeast => {
                    out.push((CLEAR * bound - x).max(0.0));
                }
                Comparison::Less | Comparison::AtMost => out.push((CLEAR * bound + x).max(0.0)),
            }
        }
        Some(out)
    }

    fn entry(&self, values: &Assignment, k: usize) -> f64 {
        let (id, i, j) = self.free[k];
        let found = values.value(&self.symbols.get(id).name);
        found.map_or(0.0, |m| m.get(i, j))
    }

    /// The values with every free entry changed; the mirrored entry changes too.
    fn moved(&self, values: &Assignment, by: impl Fn(usize) -> f64) -> Assignment {
        let mut out = values.clone();
        for id in &self.letters {
            let symbol = self.symbols.get(*id);
            let Some(mut m) = values.value(&symbol.name).cloned() else {
                continue;
            };
            let mirror = match symbol.structure {
                Structure::Symmetric => 1.0,
                Structure::Skew => -1.0,
                _ => 0.0,
            };
            for (k, (_, i, j)) in self.free.iter().enumerate().filter(|(_, f)| f.0 == *id) {
                let x = by(k);
                m.data[i * m.cols + j] += x;
                if i != j && mirror != 0.0 {
                    m.data[j * m.cols + i] += mirror * x;
                }
            }
            out.set(&symbol.name, 0, m.rows, m.cols, &m.data);
        }
        out
    }
}

fn square(r: &[f64]) -> f64 {
    r.iter().map(|x| x * x).sum()
}

/// The step `-(A^T A + damping diag)^-1 A^T r` for the columns of `A`.
fn damped(columns: &[Vec<f64>], r: &[f64], damping: f64) -> Vec<f64> {
    let n = columns.len();
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(x, y)| x * y).sum() };
    let total = columns.iter().map(|c| dot(c, c)).sum::<f64>();
    let mut rows: Vec<Vec<f64>> = (0..n)
        .map(|i| {
            let mut row: Vec<f64> = (0..n).map(|j| dot(&columns[i], &columns[j])).collect();
            row[i] += damping * total + f64::MIN_POSITIVE;
            row.push(-dot(&columns[i], r));
            row
        })
        .collect();
    for k in 0..n {
        let pivot = rows[k].clone();
        for row in &mut rows[k + 1..] {
            let f = row[k] / pivot[k];
            for (x, p) in row.iter_mut().zip(&pivot).skip(k) {
                *x -= f * p;
            }
        }
    }
    let mut step = vec![0.0; n];
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| rows[k][j] * step[j]).sum();
        step[k] = (rows[k][n] - known) / rows[k][k];
    }
    step
}
