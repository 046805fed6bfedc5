//! A neo-Hookean body by its placement Q, by Störmer-Verlet: `Q'' = -Q (μ (1 - C⁻¹) + (λ/2) log det(C) C⁻¹) I0⁻¹` with C = QᵀQ, for
//! the energy `(μ/2) (tr C - log det C) + (λ/8) log² det C`. Takes moments, placement and body momentum; gives placement and body
//! momentum after one step.

use super::Unsolvable;
use super::attitude::{
    Matrix, inverse, product, scaled_matrix, sum, transposed, transposed_product,
};
use super::ellipsoid;

/// The data of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHooke {
    /// I0, second moments of the reference.
    pub moments: Matrix,
    /// μ, the shear modulus.
    pub shear: f64,
    /// λ, Lamé's first constant.
    pub lame: f64,
}

impl NeoHooke {
    /// The derivative of the stored energy with respect to the placement.
    fn gradient(&self, q: &Matrix) -> Matrix {
        let (back, determinant) = ellipsoid::inverse(&transposed_product(q, q));
        let mut stress = scaled_matrix(0.5 * self.lame * determinant.ln() - self.shear, &back);
        for (i, row) in stress.iter_mut().enumerate() {
            row[i] += self.shear;
        }
        product(q, &stress)
    }

    /// Placement and body momentum after a step of h.
    ///
    /// # Errors
    /// [`Unsolvable`] if placement or moments are singular.
    pub fn step(&self, q: &Matrix, momentum: &Matrix, h: f64) -> Result<[Matrix; 2], Unsolvable> {
        let p = product(&inverse(&transposed(q)), momentum);
        let p = sum(&p, -0.5 * h, &self.gradient(q));
        let q = sum(q, h, &product(&p, &inverse(&self.moments)));
        let p = sum(&p, -0.5 * h, &self.gradient(&q));
        let known = q.iter().chain(&p).flatten().all(|x| x.is_finite());
        known
            .then(|| [q, transposed_product(&q, &p)])
            .ok_or(Unsolvable)
    }
}
