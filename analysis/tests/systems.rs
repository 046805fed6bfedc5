//! Discrete systems with closed forms.

use clebsch_analysis::{Energy, First, Flow};
use nalgebra::{DMatrix, DVector};
use std::fmt;

/// Why a step of a test system fails.
#[derive(Clone, Debug, PartialEq)]
pub struct Undefined;

impl fmt::Display for Undefined {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the step is not defined.")
    }
}

impl std::error::Error for Undefined {}

/// A potential on R^d with two derivatives.
pub struct Potential {
    pub dimension: usize,
    pub gradient: fn(&[f64]) -> DVector<f64>,
    pub hessian: fn(&[f64]) -> DMatrix<f64>,
}

/// A splitting method for the Hamiltonian |p|^2 / 2 + V(q). A state is q, then p.
pub struct Splitting {
    pub potential: Potential,
    /// Leapfrog: half a kick, drift, half a kick. Otherwise symplectic Euler: kick, drift.
    pub leapfrog: bool,
}

impl Splitting {
    pub fn leapfrog(potential: Potential) -> Self {
        Self {
            potential,
            leapfrog: true,
        }
    }

    fn kick(&self, z: &mut [f64], tangent: &mut DMatrix<f64>, h: f64) {
        let d = self.potential.dimension;
        let (q, p) = z.split_at_mut(d);
        let gradient = (self.potential.gradient)(q);
        p.iter_mut()
            .zip(gradient.iter())
            .for_each(|(p, g)| *p -= h * g);
        let change = h * (self.potential.hessian)(q) * tangent.rows(0, d);
        let mut rows = tangent.rows_mut(d, d);
        rows -= change;
    }

    fn drift(&self, z: &mut [f64], tangent: &mut DMatrix<f64>, h: f64) {
        let d = self.potential.dimension;
        let (q, p) = z.split_at_mut(d);
        q.iter_mut().zip(p.iter()).for_each(|(q, p)| *q += h * p);
        let change = h * tangent.rows(d, d);
        let mut rows = tangent.rows_mut(0, d);
        rows += change;
    }
}

impl Flow for Splitting {
    type State = Vec<f64>;
    type Error = Undefined;

    fn dimension(&self) -> usize {
        2 * self.potential.dimension
    }

    fn step(&self, at: &Vec<f64>, h: f64) -> Result<Vec<f64>, Undefined> {
        self.tangent(at, h).map(|(next, _)| next)
    }

    fn tangent(&self, at: &Vec<f64>, h: f64) -> Result<(Vec<f64>, DMatrix<f64>), Undefined> {
        let n = self.dimension();
        let (mut z, mut tangent) = (at.clone(), DMatrix::identity(n, n));
        let kick = if self.leapfrog { h / 2.0 } else { h };
        self.kick(&mut z, &mut tangent, kick);
        self.drift(&mut z, &mut tangent, h);
        if self.leapfrog {
            self.kick(&mut z, &mut tangent, kick);
        }
        Ok((z, tangent))
    }

    fn moved(&self, at: &Vec<f64>, by: &[f64]) -> Vec<f64> {
        at.iter().zip(by).map(|(x, y)| x + y).collect()
    }

    fn difference(&self, from: &Vec<f64>, to: &Vec<f64>) -> Vec<f64> {
        to.iter().zip(from).map(|(x, y)| x - y).collect()
    }
}

/// A map of R^2 whose formula also gives its derivative, row by row.
pub struct Plane<M>(pub M);

impl<M: Fn([f64; 2], f64) -> Option<([f64; 2], [f64; 4])>> Flow for Plane<M> {
    type State = [f64; 2];
    type Error = Undefined;

    fn dimension(&self) -> usize {
        2
    }

    fn step(&self, at: &[f64; 2], h: f64) -> Result<[f64; 2], Undefined> {
        self.tangent(at, h).map(|(next, _)| next)
    }

    fn tangent(&self, at: &[f64; 2], h: f64) -> Result<([f64; 2], DMatrix<f64>), Undefined> {
        let (next, rows) = (self.0)(*at, h).ok_or(Undefined)?;
        Ok((next, DMatrix::from_row_slice(2, 2, &rows)))
    }

    fn moved(&self, at: &[f64; 2], by: &[f64]) -> [f64; 2] {
        [at[0] + by[0], at[1] + by[1]]
    }

    fn difference(&self, from: &[f64; 2], to: &[f64; 2]) -> Vec<f64> {
        vec![to[0] - from[0], to[1] - from[1]]
    }
}

/// Oscillators with frequencies 1, 2, .. d.
pub fn oscillators(dimension: usize) -> Potential {
    Potential {
        dimension,
        gradient: |q| DVector::from_fn(q.len(), |i, _| ((i + 1) * (i + 1)) as f64 * q[i]),
        hessian: |q| {
            DMatrix::from_fn(q.len(), q.len(), |i, j| {
                if i == j {
                    ((i + 1) * (i + 1)) as f64
                } else {
                    0.0
                }
            })
        },
    }
}

/// The pendulum, V = -cos q.
pub fn pendulum() -> Potential {
    Potential {
        dimension: 1,
        gradient: |q| DVector::from_element(1, q[0].sin()),
        hessian: |q| DMatrix::from_element(1, 1, q[0].cos()),
    }
}

/// Henon and Heiles, V = (x^2 + y^2) / 2 + x^2 y - y^3 / 3.
pub fn henon_heiles() -> Potential {
    Potential {
        dimension: 2,
        gradient: |q| {
            DVector::from_vec(vec![
                q[0] + 2.0 * q[0] * q[1],
                q[1] + q[0] * q[0] - q[1] * q[1],
            ])
        },
        hessian: |q| {
            DMatrix::from_row_slice(
                2,
                2,
                &[1.0 + 2.0 * q[1], 2.0 * q[0], 2.0 * q[0], 1.0 - 2.0 * q[1]],
            )
        },
    }
}

/// A repeatable sequence of numbers between -1 and 1.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn draw(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub fn matrix(&mut self, rows: usize, columns: usize) -> DMatrix<f64> {
        DMatrix::from_fn(rows, columns, |_, _| self.draw())
    }

    pub fn symmetric(&mut self, n: usize) -> DMatrix<f64> {
        let a = self.matrix(n, n);
        &a + a.transpose()
    }
}

/// A potential of one variable: gives V, V', V'' and the derivative of V' in p.
pub struct Line<V>(pub V);

impl<V: Fn(f64, f64) -> Option<[f64; 4]>> Energy for Line<V> {
    type State = f64;
    type Error = Undefined;

    fn dimension(&self) -> usize {
        1
    }

    fn constraints(&self) -> usize {
        0
    }

    fn first(&self, at: &f64, p: f64) -> Result<First, Undefined> {
        let [energy, slope, ..] = (self.0)(*at, p).ok_or(Undefined)?;
        let gradient = DVector::from_element(1, slope);
        Ok(First {
            energy,
            gradient,
            conserved: DVector::zeros(0),
            gradients: DMatrix::zeros(0, 1),
        })
    }

    fn second(&self, at: &f64, p: f64, _: &[f64]) -> Result<DMatrix<f64>, Undefined> {
        Ok(DMatrix::from_element(
            1,
            1,
            (self.0)(*at, p).ok_or(Undefined)?[2],
        ))
    }

    fn in_parameter(
        &self,
        at: &f64,
        p: f64,
        _: &[f64],
    ) -> Result<(DVector<f64>, DVector<f64>), Undefined> {
        Ok((
            DVector::from_element(1, (self.0)(*at, p).ok_or(Undefined)?[3]),
            DVector::zeros(0),
        ))
    }

    fn moved(&self, at: &f64, by: &[f64]) -> f64 {
        at + by[0]
    }

    fn difference(&self, from: &f64, to: &f64) -> Vec<f64> {
        vec![to - from]
    }
}
