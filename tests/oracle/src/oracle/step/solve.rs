//! The end of a step: `p = -D1 L(q, q')` solved for `q'`, with the multipliers of what is held, then `p' = D2 L(q, q')`.
//! Takes a problem; follows the root from rest as the momentum grows, then corrects it in 32 digits.

use super::dense::Factored;
use super::problem::{End, Problem};
use crate::oracle::dual::Number;
use crate::oracle::pair::Pair;

/// The end of a step.
#[derive(Clone, Debug)]
pub struct Solved {
    /// What moves, at the end.
    pub head: Vec<Pair>,
    /// Multipliers of what is held, times half the step.
    pub impulses: Vec<Pair>,
    /// Momenta at the end, projected on what is held.
    pub momenta: Vec<Pair>,
    /// The matrix of Newton's method there.
    pub tangent: Factored,
}

fn size(list: &[f64]) -> f64 {
    list.iter().fold(0.0, |most, x| match x.is_nan() {
        true => f64::INFINITY,
        false => x.abs().max(most),
    })
}

impl Problem {
    /// The equations at a head: what they leave for the momenta `wanted`.
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

    /// The matrix of Newton's method.
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

    /// One correction of head and impulses; its length.
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

    /// The end of the step, on the root that goes out from rest; none where it is lost.
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

    /// One stage: corrections that fall by a factor of two each.
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

    /// The same in 32 digits, from an end that is nearly one.
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
        // One more correction would be smaller by the digits of a double.
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

    /// The momenta at the end, without what points across what is held.
    fn arrived(&self, head: &[Pair]) -> Option<Vec<Pair>> {
        let mut momenta = self.gradient(head, End::Head);
        let Some((_, second)) = self.action.held else {
            return Some(momenta);
        };
        // The kinetic energy at rest has the Hessian -h D1 D2 L.
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

/// A linear system in 32 digits: solved in double, corrected by what is left.
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
