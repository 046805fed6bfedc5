//! Symmetries as a linear problem: find coefficients for the momenta of some motions such that no step changes the
//! combination. Takes random steps in exact arithmetic; gives all solutions in small integers, and for fixed
//! parameters the number of solutions in any numbers.

use super::columns::Columns;
use super::draws::Roots;
use super::motions::{Motion, Sort};
use super::random_step::{RandomStep, completed, start};
use super::{Inputs, here};
use crate::algebra::assumed::{Independent, eliminate, rank};
use crate::algebra::exact::{Matrix, Point, add, mul, negate, rational};
use crate::expr::{self, Expr, Letter, Shift};

/// Rows beyond the number of unknowns. With probability 1e-18, one more row is dependent by chance.
const MORE: usize = 2;

/// The largest number of unknowns.
const WIDEST: usize = 64;

/// The largest numerator and denominator of a coefficient.
const LARGEST: u64 = 1000;

/// The largest number of evaluations in one search, in entries of matrices times nodes of expressions.
const WORK: usize = 40_000_000;

/// Steps whose differences are added with signs.
pub(super) struct Sample<'a>(Vec<(bool, RandomStep<'a>)>);

impl Sample<'_> {
    /// The sum of the changes of a quantity.
    fn change(&self, e: &Expr) -> Option<Vec<u64>> {
        let mut out: Option<Vec<u64>> = None;
        for (minus, p) in &self.0 {
            let (before, after) = (p.before.value(e)?, p.after.value(e)?);
            let change = after.data.iter().zip(&before.data);
            let change = change.map(|(a, b)| {
                let d = add(*a, negate(*b));
                if *minus { negate(d) } else { d }
            });
            out = Some(match out {
                None => change.collect(),
                Some(sum) => sum.iter().zip(change).map(|(x, y)| add(*x, y)).collect(),
            });
        }
        out
    }
}

/// Samples, computed on demand.
pub(super) struct Samples<'a, 'x> {
    x: &'x Inputs<'a>,
    roots: &'x Roots,
    list: Vec<Sample<'a>>,
    /// Whether a change by a total difference counts as no change.
    differences: bool,
    attempt: u64,
}

impl<'a, 'x> Samples<'a, 'x> {
    /// Samples of steps, starting with the given ones.
    pub(super) fn of_steps(
        x: &'x Inputs<'a>,
        roots: &'x Roots,
        passages: &[RandomStep<'a>],
    ) -> Self {
        let list = passages.iter().map(|p| Sample(vec![(false, p.clone())]));
        Samples {
            x,
            roots,
            list: list.collect(),
            differences: false,
            attempt: 2 * passages.len() as u64,
        }
    }

    /// Samples of steps, without total differences.
    pub(super) fn of_differences(x: &'x Inputs<'a>, roots: &'x Roots) -> Self {
        Samples {
            x,
            roots,
            list: Vec::new(),
            differences: true,
            attempt: 0,
        }
    }

    fn get(&mut self, index: usize) -> Option<&Sample<'a>> {
        while self.list.len() <= index {
            if self.attempt > 8 * index as u64 + 200 {
                return None;
            }
            // Even attempts use the smallest size of a named dimension.
            self.attempt += 2;
            let made =
                start(self.x, self.roots, self.x.assumed, self.attempt).and_then(
                    |mut p| match self.differences {
                        true if !self.roots.hold_everywhere(self.x) => None,
                        true => chain(self.x, self.roots, &p, 1)?.pop(),
                        false => {
                            self.roots.led(self.x, &mut p, self.attempt)?;
                            Some(Sample(vec![(false, completed(self.x, p)?)]))
                        }
                    },
                );
            self.list.extend(made);
        }
        self.list.get(index)
    }

    /// Coefficients for which the sum of the quantities does not change: a basis of all such coefficients.
    pub(super) fn combinations(&mut self, values: &[Expr]) -> Vec<Vec<i64>> {
        let n = values.len();
        if n == 0 {
            return Vec::new();
        }
        let mut rows: Vec<Vec<u64>> = Vec::new();
        let mut independent = Independent::default();
        let mut index = 0;
        // At least four steps; with assumptions more, because their branches alternate.
        let least = if self.x.assumed.is_empty() { 4 } else { 8 };
        while rows.len() < n + MORE || index < least {
            if index > n + least + 4 {
                return Vec::new();
            }
            let Some(sample) = self.get(index) else {
                return Vec::new();
            };
            index += 1;
            let columns: Option<Vec<Vec<u64>>> = values.iter().map(|v| sample.change(v)).collect();
            let Some(columns) = columns else { continue };
            let entries = columns.first().map_or(0, Vec::len);
            for k in 0..entries {
                let row: Vec<u64> = columns.iter().map(|c| c[k]).collect();
                if let Some(fresh) = independent.reduced(&row) {
                    independent.push(fresh);
                }
                if independent.len() == n {
                    return Vec::new();
                }
                rows.push(row);
            }
        }
        let found = null_space(rows, n);
        found.iter().filter_map(|v| whole_numbers(v)).collect()
    }
}

/// A basis of the solutions of `rows x = 0`.
fn null_space(mut rows: Vec<Vec<u64>>, n: usize) -> Vec<Vec<u64>> {
    let pivots = eliminate(&mut rows, n);
    let free = (0..n).filter(|j| !pivots.contains(j));
    free.map(|j| {
        let mut v = vec![0; n];
        v[j] = 1;
        for (row, p) in rows.iter().zip(&pivots) {
            v[*p] = negate(row[j]);
        }
        v
    })
    .collect()
}

/// The vector in integers without a common factor, with a positive first entry.
fn whole_numbers(v: &[u64]) -> Option<Vec<i64>> {
    let parts: Vec<(i64, i64)> = v
        .iter()
        .map(|x| rational(*x, LARGEST))
        .collect::<Option<_>>()?;
    let gcd = |mut a: i64, mut b: i64| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a.abs()
    };
    let below = parts.iter().try_fold(1i64, |m, (_, d)| {
        let next = m / gcd(m, *d) * d;
        (next <= LARGEST as i64).then_some(next)
    })?;
    let whole: Vec<i64> = parts.iter().map(|(n, d)| n * (below / d)).collect();
    let common = whole.iter().fold(0, |g, x| gcd(g, *x)).max(1);
    let sign = whole.iter().find(|x| **x != 0)?.signum();
    Some(whole.iter().map(|x| sign * x / common).collect())
}

/// All symmetries at fixed parameters.
pub(super) struct Kernel<'a> {
    /// The number of conserved momenta, minus the momenta that are constant or equal to others.
    pub(super) dimension: usize,
    /// Nodes of motions that share their parameters and their advected quantities.
    nodes: Vec<Point<'a>>,
}

impl<'a> Kernel<'a> {
    /// Solves for the coefficients of all columns at once, ignoring total differences; `None` if that exceeds the
    /// work limit.
    pub(super) fn new(
        x: &Inputs<'a>,
        roots: &Roots,
        columns: &Columns,
        attempt: u64,
    ) -> Option<Kernel<'a>> {
        // Each column with the common part of its motions.
        let own = columns.basis().filter_map(|list| {
            let first = list.first()?;
            let values = list.iter().map(|m| m.value.clone());
            let shape = first.value.shape();
            Some((*first, expr::sum(values.collect::<Vec<_>>(), shape)))
        });
        let own: Vec<(&Motion, Expr)> = own.collect();
        let base = start(x, roots, x.assumed, attempt)?;
        let width: usize = own.iter().map(|(m, _)| coordinates(&base, m)).sum();
        let times = usize::try_from(crate::work::times()).unwrap_or(1);
        let most = WORK.saturating_mul(times.min(2));
        if width > WIDEST * times || work(x, &base).saturating_mul(2 * (width + MORE)) > most {
            return None;
        }
        if !roots.hold_everywhere(x) {
            return None;
        }
        let steps = chain(x, roots, &base, width + MORE)?;
        let row = |entries: &dyn Fn(&Expr) -> Option<Matrix>| -> Option<Vec<u64>> {
            let mut out = Vec::new();
            for (m, sum) in &own {
                let value = entries(sum)?;
                out.extend(independent_entries(m.sort, &value));
            }
            Some(out)
        };
        let (mut changes, mut momenta) = (Vec::new(), Vec::new());
        let mut nodes = Vec::new();
        for sample in steps {
            changes.push(row(&|e| {
                let data = sample.change(e)?;
                let (_, first) = sample.0.first()?;
                let value = first.before.value(e)?;
                Some(Matrix { data, ..value })
            })?);
            let (_, step) = sample.0.into_iter().next()?;
            momenta.push(row(&|e| step.before.value(e))?);
            nodes.push(step.before);
        }
        let kept = null_space(changes, width);
        // For each combination, its function at the nodes and its constants.
        let functions = kept.iter().map(|v| {
            let products = momenta.iter().map(|row| {
                let terms = row.iter().zip(v);
                terms.fold(0, |t, (a, b)| add(t, mul(*a, *b)))
            });
            products.collect::<Vec<u64>>()
        });
        Some(Kernel {
            dimension: rank(&functions.collect::<Vec<_>>()),
            nodes,
        })
    }

    /// The number of linearly independent quantities, without constants.
    pub(super) fn spanned<'e>(&self, found: impl Iterator<Item = &'e Expr>) -> usize {
        let mut rows: Vec<Vec<u64>> = vec![vec![1; self.nodes.len()]];
        for e in found {
            let values: Option<Vec<Matrix>> = self.nodes.iter().map(|p| p.value(e)).collect();
            let Some(values) = values else { continue };
            let entries = values.first().map_or(0, |m| m.data.len());
            rows.extend((0..entries).map(|k| values.iter().map(|m| m.data[k]).collect::<Vec<_>>()));
        }
        rank(&rows) - 1
    }
}

/// The number of independent entries of a momentum.
fn coordinates(point: &Point, m: &Motion) -> usize {
    match m.sort {
        Sort::Angular | Sort::Linear => 3,
        Sort::Mixed => 1,
        Sort::Rigid(n) => point.dim(n),
        Sort::Planes(n) => {
            let n = point.dim(n);
            n * (n - 1) / 2
        }
        Sort::Affine(n) | Sort::Entries(n) => point.dim(n) * point.dim(n),
        Sort::Shifts(shape) => point.dim(shape.rows) * point.dim(shape.cols),
    }
}

fn independent_entries(sort: Sort, value: &Matrix) -> Vec<u64> {
    match sort {
        Sort::Planes(_) => (0..value.rows)
            .flat_map(|i| (i + 1..value.cols).map(move |j| value.at(i, j)))
            .collect(),
        _ => value.data.clone(),
    }
}

/// The approximate cost of one step.
fn work(x: &Inputs, point: &Point) -> usize {
    let nodes: usize = x
        .balances
        .iter()
        .map(|b| (b.incoming.size() + b.outgoing.size()) as usize)
        .sum();
    let largest = x
        .spec
        .configurations
        .iter()
        .map(|c| point.dim(c.group.size()));
    let n = largest.max().unwrap_or(1);
    nodes.saturating_mul(n * n * n)
}

/// Steps between random nodes with the parameters of a point. Each comes with the steps from one origin (the identity
/// of the groups) to its two ends. A quantity that changes by `F(end) - F(start)` changes by `F` of the end over a
/// step that starts at the origin, up to a constant.
fn chain<'a>(
    x: &Inputs<'a>,
    roots: &Roots,
    base: &Point<'a>,
    count: usize,
) -> Option<Vec<Sample<'a>>> {
    let mut origin = base.clone();
    for c in &x.spec.configurations {
        // Fields keep their drawn values: a potential may be singular at zero or where fields coincide.
        if !c.group.is_additive() {
            origin.set(here(c.element), base.value(&c.group.identity())?);
        }
    }
    roots.placed(x, &mut origin, 0)?;
    for a in &x.spec.advected {
        if let Some(d) = &a.definition {
            let value = origin.value(d)?;
            origin.set(here(a.quantity), value);
        }
    }
    let mut out = Vec::new();
    let mut from: Option<RandomStep> = None;
    // Some draws fail because roots do not exist.
    for attempt in 0..8 * (count as u64 + 10) {
        if out.len() == count {
            return Some(out);
        }
        let Some(to) = from_origin(x, roots, &origin, 1000 + attempt) else {
            continue;
        };
        let Some(start) = &from else {
            from = Some(to);
            continue;
        };
        let Some(step) = between(x, &origin, start, &to) else {
            continue;
        };
        out.push(Sample(vec![
            (false, step),
            (true, to.clone()),
            (false, start.clone()),
        ]));
        from = Some(to);
    }
    None
}

/// The step from the origin to a random node.
fn from_origin<'a>(
    x: &Inputs<'a>,
    roots: &Roots,
    origin: &Point<'a>,
    attempt: u64,
) -> Option<RandomStep<'a>> {
    let draw = origin.redrawn(attempt);
    let mut p = origin.clone();
    let velocities = x.spec.configurations.iter().map(|c| c.velocity);
    let multipliers = x.spec.holds.iter().map(|h| h.multiplier);
    for drawn in velocities.chain(multipliers).map(here) {
        p.set(drawn, draw.letter(drawn)?);
    }
    roots.led(x, &mut p, attempt)?;
    completed(x, p)
}

/// The step from the end of `from` to the end of `to`.
fn between<'a>(
    x: &Inputs<'a>,
    origin: &Point<'a>,
    from: &RandomStep<'a>,
    to: &RandomStep<'a>,
) -> Option<RandomStep<'a>> {
    let mut p = origin.clone();
    for c in &x.spec.configurations {
        let element = here(c.element);
        let a = from.after.letter(element)?;
        let next = Letter {
            shift: Shift::NEXT,
            ..element
        };
        let s = &x.letters.symbols;
        let whole = expr::letter(s, c.element, Shift::NEXT);
        let velocity = c.group.velocity(s, c.side, expr::here(s, c.element), whole);
        let mut ends = p.clone();
        ends.set(element, a.clone());
        ends.set(next, to.after.letter(element)?);
        p.set(here(c.velocity), ends.value(&velocity)?);
        p.set(element, a);
    }
    for a in &x.spec.advected {
        p.set(here(a.quantity), from.after.letter(here(a.quantity))?);
    }
    completed(x, p)
}
