//! Solves a step: `q'` and the constraint multipliers from `p = -D1 L(q, q')`, then `p' = D2 L(q, q')`. Follows the root from zero
//! velocity while the momentum grows, then refines it to 32 digits.

use super::dense::Factored;
use super::problem::{End, Problem};
use crate::oracle::dual::Number;
use crate::oracle::pair::Pair;

/// The result of a step.
#[derive(Clone, Debug)]
pub struct Solved {
    /// The configuration at the end.
    pub head: Vec<Pair>,
    /// Constraint multipliers times half the step size.
    pub impulses: Vec<Pair>,
    /// Momenta at the end, projected onto the constraints.
    pub momenta: Vec<Pair>,
    /// The Jacobian of Newton's method at the end.
    pub tangent: Factored,
}

fn size(list: &[f64]) -> f64 {
    list.iter().fold(0.0, |most, x| match x.is_nan() {
        true => f64::INFINITY,
        false => x.abs().max(most),
    })
}

impl Problem {
    /// The residual of the equations at `head` for the momenta `wanted`.
    fn left(&self, head: &[Pair], impulses: &[Pair], wanted: &[Pair]) -> Vec<Pair> {
        let (_, across) = self.held(&self.start);
        let own = self.gradient(head, End::Tail);
        let mut out: Vec<Pair> = own.iter().zip(wanted).map(|(d, p)| -*d - *p).collect();
        for (row, impulse) in across.iter().zip(impulses) {
            for (x, d) in out.iter_mut().zip(row) {
                *x = *x - *d * *impulse;
            }
        }
        out.extend(self.held(head).0);
        out
    }

    /// The Jacobian of Newton's method.
    fn tangent(&self, head: &[Pair]) -> Factored {
        let mut rows = self.mixed(self.action.twice, [&self.start, head], |x| x.high);
        let (_, here) = self.held(&self.start);
        let (_, there) = self.held(head);
        for (i, row) in rows.iter_mut().enumerate() {
            row.iter_mut().for_each(|x| *x = -*x);
            row.extend(here.iter().map(|g| -g[i].high));
        }
        for g in &there {
            let mut row: Vec<f64> = g.iter().map(|x| x.high).collect();
            row.resize(g.len() + here.len(), 0.0);
            rows.push(row);
        }
        Factored::of(rows)
    }

    /// Corrects head and impulses once; returns the size of the correction.
    fn correct(
        &self,
        (head, impulses): (&mut Vec<Pair>, &mut Vec<Pair>),
        wanted: &[Pair],
        tangent: &Factored,
    ) -> f64 {
        let left: Vec<f64> = self
            .left(head, impulses, wanted)
            .iter()
            .map(|x| x.high)
            .collect();
        let by = tangent.solve(&left);
        let minus: Vec<Pair> = by.iter().map(|x| Pair::constant(-x)).collect();
        let (along, across) = minus.split_at(minus.len() - impulses.len());
        *head = self.moved(head, along);
        for (x, d) in impulses.iter_mut().zip(across) {
            *x = *x + *d;
        }
        size(&by)
    }

    /// The end of the step on the root connected to zero velocity; `None` if continuation loses it.
    #[must_use]
    pub fn solve(&self) -> Option<Solved> {
        let rest: Vec<Pair> = self
            .gradient(&self.start, End::Tail)
            .iter()
            .map(|d| -*d)
            .collect();
        let count = self.held(&self.start).0.len();
        let mut at = (self.start.clone(), vec![Pair::constant(0.0); count]);
        let (mut way, mut stride) = (0.0_f64, 1.0_f64);
        while way < 1.0 {
            let goal = (way + stride).min(1.0);
            let part = Pair::constant(goal);
            let momenta = rest.iter().zip(&self.momenta);
            let wanted: Vec<Pair> = momenta.map(|(r, p)| *r + part * (*p - *r)).collect();
            match self.stage(at.clone(), &wanted) {
                Some(found) => {
                    (at, way) = (found, goal);
                    stride *= 2.0;
                }
                None if stride < 1e-4 => return None,
                None => stride /= 2.0,
            }
        }
        let tangent = self.tangent(&at.0);
        self.refined(at, tangent)
    }

    /// One continuation stage: each correction must be at most half the previous one.
    fn stage(
        &self,
        (mut head, mut impulses): (Vec<Pair>, Vec<Pair>),
        wanted: &[Pair],
    ) -> Option<(Vec<Pair>, Vec<Pair>)> {
        let mut before = f64::INFINITY;
        let mut first = 0.0;
        for count in 0..20 {
            let tangent = self.tangent(&head);
            let length = self.correct((&mut head, &mut impulses), wanted, &tangent);
            if !length.is_finite() || length > 0.5 * before {
                return None;
            }
            if count == 0 {
                first = length;
            }
            before = length;
            if length <= 1e-9 * first {
                return Some((head, impulses));
            }
        }
        None
    }

    /// Refines an approximate solution to 32 digits.
    #[must_use]
    pub fn refined(
        &self,
        (mut head, mut impulses): (Vec<Pair>, Vec<Pair>),
        tangent: Factored,
    ) -> Option<Solved> {
        let away: Vec<f64> = {
            let both = head.iter().zip(&self.start);
            both.map(|(b, a)| (*b - *a).high).collect()
        };
        // The next correction would be smaller by the precision of a double.
        let enough = 1e-18 * size(&away);
        for _ in 0..12 {
            let length = self.correct((&mut head, &mut impulses), &self.momenta, &tangent);
            if length <= enough {
                let momenta = self.arrived(&head)?;
                return Some(Solved {
                    head,
                    impulses,
                    momenta,
                    tangent,
                });
            }
        }
        None
    }

    /// The momenta at the end, without their component along the constraint forces.
    fn arrived(&self, head: &[Pair]) -> Option<Vec<Pair>> {
        let mut momenta = self.gradient(head, End::Head);
        let Some((_, second)) = self.action.held else {
            return Some(momenta);
        };
        // The Hessian of the kinetic energy at zero velocity is -h D1 D2 L.
        let (_, across) = self.held(head);
        let hessian: Vec<Vec<Pair>> = {
            let rows = self.mixed(second, [head, head], |x| x);
            let scaled = |x: &Pair| -(*x * Pair::constant(self.h));
            let each = rows.iter().map(|row| row.iter().map(scaled).collect());
            each.collect()
        };
        let solve = |right: &[Pair]| linear(&hessian, right);
        let velocities: Vec<Vec<Pair>> = across.iter().map(|g| solve(g)).collect();
        let inner = |a: &[Pair], b: &[Pair]| {
            let each = a.iter().zip(b).map(|(x, y)| *x * *y);
            each.fold(Pair::constant(0.0), |sum, x| sum + x)
        };
        let small: Vec<Vec<Pair>> = across
            .iter()
            .map(|g| velocities.iter().map(|v| inner(g, v)).collect())
            .collect();
        let rates: Vec<Pair> = velocities.iter().map(|v| inner(v, &momenta)).collect();
        for (g, impulse) in across.iter().zip(linear(&small, &rates)) {
            for (p, d) in momenta.iter_mut().zip(g) {
                *p = *p - *d * impulse;
            }
        }
        Some(momenta)
    }
}

/// Solves a linear system to 32 digits: in double precision, then by iterative refinement.
fn linear(rows: &[Vec<Pair>], right: &[Pair]) -> Vec<Pair> {
    let plain = rows.iter().map(|row| row.iter().map(|x| x.high).collect());
    let factored = Factored::of(plain.collect());
    let mut x = vec![Pair::constant(0.0); right.len()];
    for _ in 0..4 {
        let left: Vec<f64> = rows
            .iter()
            .zip(right)
            .map(|(row, b)| {
                let each = row.iter().zip(&x).map(|(a, x)| *a * *x);
                each.fold(*b, |rest, term| rest - term).high
            })
            .collect();
        for (x, d) in x.iter_mut().zip(factored.solve(&left)) {
            *x = *x + Pair::constant(d);
        }
    }
    x
}
