//! Extrapolates the last four solutions to a starting value for an iteration. Takes solutions in order; stores the
//! latest first.

use crate::Real;

/// The last solutions of one equation.
#[derive(Clone, Debug)]
pub(super) struct Extrapolated<T> {
    /// The solutions, the latest first.
    pub solutions: [Vec<T>; 4],
    /// The number of solutions.
    pub solved: usize,
}

impl<T: Real> Extrapolated<T> {
    pub fn new(sites: usize) -> Self {
        Self {
            solutions: core::array::from_fn(|_| vec![T::zero(); sites]),
            solved: 0,
        }
    }

    /// The latest solution.
    pub fn latest(&self) -> &[T] {
        &self.solutions[0]
    }

    /// Puts the extrapolation of the last solutions in front; without solutions, it is `first` at every site.
    pub fn next(&mut self, first: impl Fn(usize) -> T) -> &mut [T] {
        let [latest, earlier, before, earliest] = &mut self.solutions;
        let (three, six) = (T::from_f64(3.0), T::from_f64(6.0));
        let four = T::from_f64(4.0);
        for a in 0..latest.len() {
            let (x, y, z, w) = (latest[a], earlier[a], before[a], earliest[a]);
            earliest[a] = match self.solved {
                0 => first(a),
                1 => x,
                2 => x + (x - y),
                3 => three * (x - y) + z,
                _ => four * (x + z) - six * y - w,
            };
        }
        self.solutions.rotate_right(1);
        &mut self.solutions[0]
    }

    /// Marks the entry in front as a solution.
    pub fn accept(&mut self) {
        self.solved = (self.solved + 1).min(self.solutions.len());
    }
}
