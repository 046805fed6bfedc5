//! The order of eigenvalues, and exact complex pairs.

use crate::eigen::Eigen;
use nalgebra::{Complex, DVector};
use std::cmp::Ordering;

impl Eigen {
    /// Makes the eigenvalues exact complex pairs or real, and sorts all.
    pub(crate) fn pair(&mut self) {
        let mut free: Vec<usize> = (0..self.values.len()).collect();
        // The eigenvalues farthest from the real axis have the clearest partners.
        free.sort_by(|&i, &j| self.values[j].im.abs().total_cmp(&self.values[i].im.abs()));
        let mut blocks: Vec<(usize, Option<usize>)> = Vec::new();
        while !free.is_empty() {
            let i = free.remove(0);
            let conjugate = self.values[i].conj();
            let distance = |j: usize| (self.values[j] - conjugate).norm();
            let partner =
                (0..free.len()).min_by(|&a, &b| distance(free[a]).total_cmp(&distance(free[b])));
            match partner.filter(|&at| distance(free[at]) < distance(i)) {
                Some(at) => blocks.push((i, Some(free.remove(at)))),
                None => blocks.push((i, None)),
            }
        }
        for &(i, j) in &blocks {
            match j {
                Some(j) => self.make_pair(i, j),
                None => self.make_real(i),
            }
        }
        blocks.sort_by(|&(i, _), &(j, _)| descending(self.values[i], self.values[j]));
        let order: Vec<usize> = blocks
            .into_iter()
            .flat_map(|(i, j)| std::iter::once(i).chain(j))
            .collect();
        self.values = order.iter().map(|&i| self.values[i]).collect();
        self.conditions = order.iter().map(|&i| self.conditions[i]).collect();
        self.vectors = self.vectors.select_columns(&order);
    }

    fn make_pair(&mut self, i: usize, j: usize) {
        let mean = (self.values[i] + self.values[j].conj()) * 0.5;
        let vector: DVector<_> = self.vectors.column(i).into_owned();
        let (up, vector) = if mean.im < 0.0 {
            (mean.conj(), vector.conjugate())
        } else {
            (mean, vector)
        };
        (self.values[i], self.values[j]) = (up, up.conj());
        self.vectors.set_column(j, &vector.conjugate());
        self.vectors.set_column(i, &vector);
        let condition = self.conditions[i].max(self.conditions[j]);
        (self.conditions[i], self.conditions[j]) = (condition, condition);
    }

    fn make_real(&mut self, i: usize) {
        self.values[i].im = 0.0;
        let vector: DVector<_> = self.vectors.column(i).into_owned();
        let largest = vector
            .iter()
            .copied()
            .max_by(|a, b| a.norm().total_cmp(&b.norm()));
        if let Some(largest) = largest.filter(|x| x.norm() > 0.0) {
            let real = vector.map(|x| Complex::new((x / largest).re, 0.0));
            self.vectors.set_column(i, &real.unscale(real.norm()));
        }
    }
}

fn descending(a: Complex<f64>, b: Complex<f64>) -> Ordering {
    b.norm()
        .total_cmp(&a.norm())
        .then(b.re.total_cmp(&a.re))
        .then(b.im.total_cmp(&a.im))
}
