//! Block-tridiagonal systems of chains and rings with 3 x 3 blocks: elimination from the first site, without pivoting. A ring is
//! solved by bordering: its last site is separated, and the others form an open chain.

use crate::handwritten::attitude::{
    Matrix, Vector, add_scaled, apply, inverse, product, scaled, scaled_matrix, sum,
};

/// The block between a site and a neighbour: a matrix, or a scalar multiple of the identity.
pub trait Coupling: Copy {
    /// The zero block.
    const ZERO: Self;
    /// C v.
    fn applied(&self, v: &Vector) -> Vector;
    /// C M.
    fn times(&self, m: &Matrix) -> Matrix;
    /// M C.
    fn after(&self, m: &Matrix) -> Matrix;
    /// As a matrix.
    fn matrix(&self) -> Matrix;
}

impl Coupling for Matrix {
    const ZERO: Matrix = [[0.0; 3]; 3];

    #[inline(always)]
    fn applied(&self, v: &Vector) -> Vector {
        apply(self, v)
    }

    #[inline(always)]
    fn times(&self, m: &Matrix) -> Matrix {
        product(self, m)
    }

    #[inline(always)]
    fn after(&self, m: &Matrix) -> Matrix {
        product(m, self)
    }

    fn matrix(&self) -> Matrix {
        *self
    }
}

impl Coupling for f64 {
    const ZERO: f64 = 0.0;

    #[inline(always)]
    fn applied(&self, v: &Vector) -> Vector {
        scaled(*self, v)
    }

    #[inline(always)]
    fn times(&self, m: &Matrix) -> Matrix {
        scaled_matrix(*self, m)
    }

    #[inline(always)]
    fn after(&self, m: &Matrix) -> Matrix {
        scaled_matrix(*self, m)
    }

    fn matrix(&self) -> Matrix {
        let c = *self;
        [[c, 0.0, 0.0], [0.0, c, 0.0], [0.0, 0.0, c]]
    }
}

/// A system and its factors.
#[derive(Clone, Debug)]
pub struct BlockTridiagonal<C> {
    ring: bool,
    /// Blocks with the previous site.
    before: Vec<C>,
    /// Blocks with the next site.
    after: Vec<C>,
    /// Inverse pivot of each site after elimination of the previous ones.
    pivots: Vec<Matrix>,
    /// For a ring: the coupling of the last site to each other site.
    border: Vec<Matrix>,
}

/// u - C v.
#[inline(always)]
fn less(u: &Vector, c: &impl Coupling, v: &Vector) -> Vector {
    add_scaled(u, -1.0, &c.applied(v))
}

impl<C: Coupling> BlockTridiagonal<C> {
    /// Allocates for this number of sites, at least two for a ring.
    pub fn new(sites: usize, ring: bool) -> Self {
        BlockTridiagonal {
            ring,
            before: vec![C::ZERO; sites],
            after: vec![C::ZERO; sites],
            pivots: vec![[[0.0; 3]; 3]; sites],
            border: vec![[[0.0; 3]; 3]; if ring { sites - 1 } else { 0 }],
        }
    }

    /// Sets the blocks of a site with its neighbours; blocks beyond an open end are not read.
    #[inline(always)]
    pub fn couple(&mut self, site: usize, before: C, after: C) {
        self.before[site] = before;
        self.after[site] = after;
    }

    /// Eliminates a site with diagonal block `own`; call in the order of the sites.
    #[inline(always)]
    pub fn eliminate(&mut self, site: usize, own: &Matrix, right: &mut [Vector]) {
        if self.ring && site + 1 == self.pivots.len() {
            return self.close(own);
        }
        let mut left = *own;
        if site > 0 {
            let onward = self.after[site - 1].after(&self.pivots[site - 1]);
            left = sum(own, -1.0, &self.before[site].times(&onward));
        }
        self.pivots[site] = inverse(&left);
        self.forward(site, right);
    }

    #[inline(always)]
    fn forward(&self, site: usize, right: &mut [Vector]) {
        let mut own = right[site];
        if site > 0 {
            own = less(&own, &self.before[site], &right[site - 1]);
        }
        right[site] = apply(&self.pivots[site], &own);
    }

    /// Eliminates the last site of a ring.
    fn close(&mut self, own: &Matrix) {
        let last = self.border.len();
        self.border.fill([[0.0; 3]; 3]);
        self.border[0] = self.before[0].matrix();
        let end = self.after[last - 1].matrix();
        self.border[last - 1] = sum(&self.border[last - 1], 1.0, &end);
        for site in 0..last {
            let mut block = self.border[site];
            if site > 0 {
                block = sum(
                    &block,
                    -1.0,
                    &self.before[site].times(&self.border[site - 1]),
                );
            }
            self.border[site] = product(&self.pivots[site], &block);
        }
        for site in (0..last - 1).rev() {
            let onward = self.after[site].after(&self.pivots[site]);
            let taken = product(&onward, &self.border[site + 1]);
            self.border[site] = sum(&self.border[site], -1.0, &taken);
        }
        let left = sum(own, -1.0, &self.before[last].times(&self.border[last - 1]));
        let left = sum(&left, -1.0, &self.after[last].times(&self.border[0]));
        self.pivots[last] = inverse(&left);
    }

    /// The solution, after all sites are eliminated.
    #[inline(always)]
    pub fn substitute(&self, right: &mut [Vector]) {
        let open = self.pivots.len() - usize::from(self.ring);
        for site in (0..open - 1).rev() {
            let beyond = self.after[site].applied(&right[site + 1]);
            right[site] = add_scaled(&right[site], -1.0, &apply(&self.pivots[site], &beyond));
        }
        if !self.ring {
            return;
        }
        let own = less(&right[open], &self.before[open], &right[open - 1]);
        let own = less(&own, &self.after[open], &right[0]);
        let own = apply(&self.pivots[open], &own);
        right[open] = own;
        for (x, border) in right.iter_mut().zip(&self.border) {
            *x = add_scaled(x, -1.0, &apply(border, &own));
        }
    }

    /// The solution for another right-hand side, with the existing factors.
    #[inline(always)]
    pub fn solve(&self, right: &mut [Vector]) {
        let open = self.pivots.len() - usize::from(self.ring);
        for site in 0..open {
            self.forward(site, right);
        }
        self.substitute(right);
    }
}

#[cfg(test)]
mod tests {
    use super::{BlockTridiagonal, Coupling};
    use crate::handwritten::attitude::{Matrix, Vector, add_scaled, apply};

    /// Diagonal blocks are at least four times as large as off-diagonal ones, with condition numbers below ten.
    fn solved<C: Coupling>(sites: usize, ring: bool, coupling: impl Fn(usize) -> C) -> f64 {
        let number = |k: usize| ((k * k + 3 * k) as f64 * 0.7).sin();
        let own: Vec<Matrix> = (0..sites)
            .map(|i| {
                [0, 1, 2].map(|a| {
                    [0, 1, 2].map(|b| number(9 * i + 3 * a + b) + if a == b { 8.0 } else { 0.0 })
                })
            })
            .collect();
        let x: Vec<Vector> = (0..sites)
            .map(|i| [0, 1, 2].map(|a| number(3 * i + a + 100)))
            .collect();
        let mut system = BlockTridiagonal::new(sites, ring);
        let mut right = Vec::new();
        for i in 0..sites {
            let (before, after) = (coupling(2 * i), coupling(2 * i + 1));
            system.couple(i, before, after);
            let mut value = apply(&own[i], &x[i]);
            if ring || i > 0 {
                value = add_scaled(&value, 1.0, &before.applied(&x[(i + sites - 1) % sites]));
            }
            if ring || i + 1 < sites {
                value = add_scaled(&value, 1.0, &after.applied(&x[(i + 1) % sites]));
            }
            right.push(value);
        }
        let mut again = right.clone();
        for (i, own) in own.iter().enumerate() {
            system.eliminate(i, own, &mut right);
        }
        system.substitute(&mut right);
        system.solve(&mut again);
        let off = right.iter().chain(&again).flatten();
        off.zip(x.iter().chain(&x).flatten())
            .fold(0.0, |m, (a, b)| m.max((a - b).abs()))
    }

    #[test]
    fn solutions_of_lines_and_rings() {
        for sites in [1, 2, 3, 4, 9] {
            for ring in [false, true] {
                if ring && sites == 1 {
                    continue;
                }
                let numbers = solved(sites, ring, |k| 0.9 * (k as f64).cos());
                let matrices = solved(sites, ring, |k| {
                    [0, 1, 2].map(|a| [0, 1, 2].map(|b| ((k + 5 * a + b) as f64).cos() * 0.6))
                });
                // Ten times a few rounding errors of sums of nine terms of size eight.
                assert!(numbers < 1e-14 && matrices < 1e-14, "{sites} {ring}");
            }
        }
    }
}
