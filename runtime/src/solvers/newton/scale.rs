//! Raises the scales of equations above the size of their own terms if necessary. An equation counts as solved if its
//! residual is rounding relative to its scale, but rounding of the velocities can leave a larger residual than its own
//! terms suggest. Takes the absolute values of the last factored tangent, and scales; raises the scales. Gives the
//! lengths for corrections.

use super::parts::{Kinds, SlowPartTest};
use crate::scalar::larger;

/// The square root of the rounding unit.
const SHARE: f64 = 1.5e-8;

/// The rounding error of a length, in roundings of the terms of its equation.
const NOISE: f64 = 1e4;

/// Measures the unit of length of each part and the rounding error of its length, from the tangent and the inverse
/// sizes of the terms.
#[cold]
pub(super) fn measure(
    kinds: &Kinds<'_>,
    entry: &dyn Fn(usize, usize) -> f64,
    weights: &[f64],
    [units, noise]: [&mut [f64]; 2],
) {
    kinds.units_into(entry, SlowPartTest::OfStep, units);
    // The coordinate's own equation, and equations without a diagonal entry, such as constraints.
    let of = |k: usize| {
        let rows = (0..kinds.size).filter(|i| *i == k || entry(*i, *i) == 0.0);
        let each = rows.map(|i| {
            let weight = weights.get(i).copied().unwrap_or(f64::NAN);
            NOISE * f64::EPSILON / (entry(i, k).abs() * weight)
        });
        each.filter(|x| x.is_finite()).fold(0.0, larger)
    };
    let mut most = 0.0;
    for (b, (own, unit)) in noise.iter_mut().zip(units.iter()).enumerate() {
        *own = kinds.own(b).map(of).fold(0.0, larger);
        let share = *own / unit;
        most = if share.is_finite() {
            larger(most, share)
        } else {
            most
        };
    }
    // A multiplier has the relative uncertainty of the parts on which it acts.
    for (b, (own, unit)) in noise.iter_mut().zip(units.iter()).enumerate() {
        if kinds.own(b).all(|k| entry(k, k) == 0.0) {
            let [step, stage] =
                [SlowPartTest::OfStep, SlowPartTest::OfStage].map(|x| x.of(kinds.open[b]));
            *own = larger(*own, most * unit * (step / stage));
        }
    }
}

/// The scales are computed anew if a part of the velocity is shorter than this fraction of its length at that time:
/// otherwise, even cubic terms are at least four tenths as large as then.
const SHORTER: f64 = 0.75;

/// The tangent of the equations, with the lengths of the parts of the velocity.
pub(super) struct Tangent<'a> {
    /// The absolute value of the tangent at an equation and a coordinate; zero if it is unknown.
    pub entry: &'a dyn Fn(usize, usize) -> f64,
    /// The part that a coordinate belongs to.
    pub part_of: &'a dyn Fn(usize) -> usize,
    /// The lengths of the parts of the velocity.
    pub lengths: &'a [f64],
}

impl Tangent<'_> {
    /// Raises scales that are at rounding level compared with others.
    pub fn raise(&self, scales: &mut [f64]) {
        self.momenta(scales);
        self.constraints(scales);
    }

    /// The inverse lengths for corrections of coordinates. The length is the length of the part of the velocity, or
    /// [`SHARE`] times the longest part in common units, whichever is larger. The inverse is zero for multipliers,
    /// which vanish without a constraint force. Every correction of a part of length zero is large.
    pub fn inverse_lengths(&self, out: &mut [f64]) {
        let parts = 0..out.len();
        let root = |part: usize| {
            let own = parts.clone().filter(|k| (self.part_of)(*k) == part);
            own.fold(0.0, |most: f64, k| most.max((self.entry)(k, k).sqrt()))
        };
        let length = |part: usize| self.lengths.get(part).copied().unwrap_or(0.0);
        // The number of parts is at most the number of coordinates.
        let most = (parts.clone()).fold(0.0, |most: f64, p| most.max(length(p) * root(p)));
        let known = most > 0.0 && most.is_finite();
        for (i, inverse) in out.iter_mut().enumerate() {
            let part = (self.part_of)(i);
            let own = root(part);
            if own == 0.0 && known {
                *inverse = 0.0;
                continue;
            }
            let least = if known { SHARE * most / own } else { 0.0 };
            let length = length(part).max(least);
            *inverse = match length.is_finite() {
                true => (1.0 / length).min(f64::MAX),
                // An element without coordinates, such as a half turn.
                false => 1.0,
            };
        }
    }

    /// The length of each part below which its scales are computed anew. `inverses` are the inverse lengths of the
    /// coordinates. The result is zero if corrections of a part are not measured by its own length.
    pub fn shortest(&self, inverses: &[f64], out: &mut [f64]) {
        for (i, inverse) in inverses.iter().enumerate() {
            let part = (self.part_of)(i);
            let length = self.lengths.get(part).copied().unwrap_or(0.0);
            if let Some(shortest) = out.get_mut(part) {
                *shortest = match length * inverse > 0.5 {
                    true => SHORTER * length.min(1.0 / inverse),
                    false => 0.0,
                };
            }
        }
    }

    /// A momentum over the root of its diagonal entry of the tangent has the same unit for all equations, the root of
    /// an action. In this unit no scale may be below `EPSILON` of the largest: the joint solution for all velocities
    /// leaves rounding of that size. Diagonal entries that are zero or unknown are skipped.
    fn momenta(&self, scales: &mut [f64]) {
        let root = |i: usize| (self.entry)(i, i).sqrt();
        let known = |i: &usize| root(*i) > 0.0 && root(*i).is_finite();
        let most = (0..scales.len())
            .filter(known)
            .fold(0.0, |most: f64, i| most.max(scales[i] / root(i)));
        for i in (0..scales.len()).filter(known) {
            scales[i] = scales[i].max(f64::EPSILON * root(i) * most);
        }
    }

    /// An equation without its own unknown, such as a constraint, has a residual from the rounding of the velocities.
    /// The velocities of a part are rounded relative to the length of the part, or to the effect of rounding of its
    /// momenta. The terms of the equation may be smaller: if a rotation preserves an axis of the basis, vanishing
    /// entries are pure rounding. Each correction is rounded as a whole, so the square of the rounding could be
    /// reached; half of these digits are required.
    fn constraints(&self, scales: &mut [f64]) {
        let size = scales.len();
        for i in (0..size).filter(|i| (self.entry)(*i, *i) == 0.0) {
            let mut least = 0.0;
            for j in 0..size {
                let entry = (self.entry)(i, j);
                if entry > 0.0 {
                    let moved = entry * self.velocity((self.part_of)(j), scales);
                    // Unknown entries do not raise a scale.
                    least = if moved > least && moved.is_finite() {
                        moved
                    } else {
                        least
                    };
                }
            }
            scales[i] = scales[i].max(SHARE * least);
        }
    }

    /// The length of a part of the velocity, or of the velocity that corresponds to the scale of its momentum,
    /// whichever is larger.
    fn velocity(&self, part: usize, scales: &[f64]) -> f64 {
        let length = self.lengths.get(part).copied().unwrap_or(0.0);
        let own = (0..scales.len()).filter(|j| (self.part_of)(*j) == part);
        own.map(|j| scales[j] / (self.entry)(j, j))
            .filter(|x| x.is_finite())
            .fold(length, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use crate::groups::Additive;
    use crate::scalar::{DoubleDouble, Real};
    use crate::solvers::newton::{Progress, Search, Solved};
    use nalgebra::SMatrix;

    /// The sizes of the terms are first computed at a trial far from the solution, where they are too large by far. At the
    /// step size of this oscillator, extrapolation gives such trials.
    #[test]
    fn a_velocity_shorter_than_its_trials_is_solved_to_rounding() {
        let (h, b, k) = (0.2, 0.6, 100.0);
        let (mut y, mut p) = (0.3, 3.4);
        let mut search = Search::<f64, Additive<1, 1>, 1>::from_rest();
        for node in 0..2000 {
            let m = p - 0.5 * h * k * y;
            let of = |v: f64| v / h + 4.0 * b * v * v * v / (h * h * h) - m;
            let slope = |v: f64| 1.0 / h + 12.0 * b * v * v / (h * h * h);
            let mut newton = search.begin(node);
            let solved: Solved<Additive<1, 1>> = loop {
                let v = newton.trial().matrix()[0];
                if newton.wants_scale() {
                    let terms = (v / h).abs() + 4.0 * b * (v / h).abs().powi(3) + m.abs();
                    newton.set_scale(|_| SMatrix::repeat(4.0 * f64::EPSILON * terms));
                }
                if newton.assess(SMatrix::repeat(of(v))) {
                    newton.set_tangent(&SMatrix::repeat(slope(v)));
                }
                match newton.correct() {
                    Progress::Continue => {}
                    Progress::Solved(solved) => break solved,
                    Progress::Failed(e) => panic!("node {node}: {e}"),
                }
            };
            search.remember(node, &solved);
            let v = solved.element.matrix()[0];
            // The correction of the solution, with the residual in twice the digits.
            let [wide_v, wide_h, wide_m] = [v, h, m].map(DoubleDouble::from);
            let ratio = wide_v / wide_h;
            let cubic = DoubleDouble::from(4.0 * b) * ratio * ratio * ratio;
            let left = ratio + cubic - wide_m;
            let off = left.value() / slope(v);
            // A residual is accepted at 4 roundings of terms that are at most 2.4 times smaller now, at a slope of at least
            // terms / v: that is 10 roundings. Without new scales, steps are off by 98.
            assert!(
                off.abs() <= 10.0 * f64::EPSILON * v.abs(),
                "node {node}: {off} of {v}"
            );
            y += v;
            p = m - 0.5 * h * k * y;
        }
    }
}
