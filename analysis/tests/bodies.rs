//! The energy of a free rigid body, in space and on a sphere of momenta.

use crate::systems::Undefined;
use clebsch_analysis::{Energy, First};
use nalgebra::{DMatrix, DVector, Vector3};

/// The kinetic energy of a free rigid body as a function of its momentum in R^3, with |m|^2 / 2 fixed. The parameter is
/// the second moment of inertia.
pub struct Body {
    pub inertia: [f64; 3],
    /// Whether rotations about the third axis count as symmetries.
    pub symmetric: bool,
}

impl Body {
    fn inverse(&self, p: f64) -> DVector<f64> {
        DVector::from_vec(vec![1.0 / self.inertia[0], 1.0 / p, 1.0 / self.inertia[2]])
    }
}

impl Energy for Body {
    type State = Vector3<f64>;
    type Error = Undefined;

    fn dimension(&self) -> usize {
        3
    }

    fn constraints(&self) -> usize {
        1
    }

    fn first(&self, at: &Vector3<f64>, p: f64) -> Result<First, Undefined> {
        let m = DVector::from_column_slice(at.as_slice());
        let gradient = self.inverse(p).component_mul(&m);
        Ok(First {
            energy: gradient.dot(&m) / 2.0,
            gradient,
            conserved: DVector::from_element(1, m.norm_squared() / 2.0),
            gradients: DMatrix::from_rows(&[m.transpose()]),
        })
    }

    fn second(
        &self,
        _: &Vector3<f64>,
        p: f64,
        multipliers: &[f64],
    ) -> Result<DMatrix<f64>, Undefined> {
        Ok(DMatrix::from_diagonal(
            &self.inverse(p).add_scalar(multipliers[0]),
        ))
    }

    fn in_parameter(
        &self,
        at: &Vector3<f64>,
        p: f64,
        _: &[f64],
    ) -> Result<(DVector<f64>, DVector<f64>), Undefined> {
        Ok((
            DVector::from_vec(vec![0.0, -at.y / (p * p), 0.0]),
            DVector::zeros(1),
        ))
    }

    fn moved(&self, at: &Vector3<f64>, by: &[f64]) -> Vector3<f64> {
        at + Vector3::new(by[0], by[1], by[2])
    }

    fn difference(&self, from: &Vector3<f64>, to: &Vector3<f64>) -> Vec<f64> {
        (to - from).as_slice().to_vec()
    }

    fn symmetries(&self, at: &Vector3<f64>) -> DMatrix<f64> {
        let turn = Vector3::z().cross(at);
        DMatrix::from_column_slice(3, 1, turn.as_slice())
            .columns(0, usize::from(self.symmetric))
            .into_owned()
    }
}

/// The same energy on the unit sphere, in the chart that scales m + b1 e1 + b2 e2 to length 1.
pub struct Sphere;

impl Sphere {
    fn frame(m: &Vector3<f64>) -> [Vector3<f64>; 2] {
        let aside = if m.x.abs() < 0.6 {
            Vector3::x()
        } else {
            Vector3::y()
        };
        let first = m.cross(&aside).normalize();
        [first, m.cross(&first)]
    }

    fn gradient(m: &Vector3<f64>) -> Vector3<f64> {
        m.component_div(&Vector3::new(1.0, 2.0, 3.0))
    }
}

impl Energy for Sphere {
    type State = Vector3<f64>;
    type Error = Undefined;

    fn dimension(&self) -> usize {
        2
    }

    fn constraints(&self) -> usize {
        0
    }

    fn first(&self, at: &Vector3<f64>, _: f64) -> Result<First, Undefined> {
        let gradient = Self::gradient(at);
        Ok(First {
            energy: gradient.dot(at) / 2.0,
            gradient: DVector::from_iterator(2, Self::frame(at).iter().map(|e| e.dot(&gradient))),
            conserved: DVector::zeros(0),
            gradients: DMatrix::zeros(0, 2),
        })
    }

    fn second(&self, at: &Vector3<f64>, _: f64, _: &[f64]) -> Result<DMatrix<f64>, Undefined> {
        let frame = Self::frame(at);
        let radial = Self::gradient(at).dot(at);
        Ok(DMatrix::from_fn(2, 2, |i, j| {
            frame[i].dot(&Self::gradient(&frame[j])) - if i == j { radial } else { 0.0 }
        }))
    }

    fn in_parameter(
        &self,
        _: &Vector3<f64>,
        _: f64,
        _: &[f64],
    ) -> Result<(DVector<f64>, DVector<f64>), Undefined> {
        Ok((DVector::zeros(2), DVector::zeros(0)))
    }

    fn moved(&self, at: &Vector3<f64>, by: &[f64]) -> Vector3<f64> {
        let [first, second] = Self::frame(at);
        (at + by[0] * first + by[1] * second).normalize()
    }

    fn difference(&self, from: &Vector3<f64>, to: &Vector3<f64>) -> Vec<f64> {
        let scaled = to / to.dot(from);
        Self::frame(from).iter().map(|e| e.dot(&scaled)).collect()
    }
}
