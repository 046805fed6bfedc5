//! Random models on every group of the language, compiled like a user's models. Every profile builds this package without
//! optimisation, because the tests run once and compilation dominates the cost.
//!
//! `CLEBSCH_RANDOM_MODELS=300 cargo test -p clebsch-compiled` compiles and runs three hundred models; `CLEBSCH_RANDOM_FIRST=1000`
//! selects other seeds.

use clebsch::card::Card;
use clebsch::nalgebra::SMatrix;
use clebsch::{Additive, Linear, Orthogonal, PlaneMotion, RigidMotion, Rotation, UnitQuaternion};

include!(concat!(env!("OUT_DIR"), "/models.rs"));

/// A body on a spring, stated by its configurations at both ends of the step. Regression: in a cross product, a sum of rotated
/// points was emitted with the columns of the preceding matrix.
#[allow(missing_docs, non_snake_case)]
pub mod spring {
    clebsch::model! {
        pub model Spring {
            param J: Sym<3>;
            param m, s: Real;
            param a, o: Vec<3>;
            group G: SE<3> velocity V;
            constraint next(G) = G*V;
            let x = pos(next(G)) - pos(G);
            let y = pos(G) + rot(G)*a - o;
            lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + m*dot(x, x)/(2*h) - (h/2)*s*dot(y, y);
        }
    }
}

/// A compiled model.
#[derive(Clone, Copy, Debug)]
pub struct Compiled {
    /// The seed of the model.
    pub seed: u64,
    /// The residual at three nodes; the first argument is the step size.
    pub residual: fn(f64, &NamedValues) -> Result<Vec<f64>, String>,
    /// The card through which the test steps the model.
    pub card: &'static Card,
}

/// Values by name and level, row by row.
#[derive(Clone, Debug)]
pub struct NamedValues(pub Vec<(String, i8, Vec<f64>)>);

impl NamedValues {
    /// Returns the value as type `V`.
    ///
    /// # Errors
    /// If the name and level have no value, or if the value does not have type `V`.
    pub fn get<V: Typed>(&self, name: &str, level: i8) -> Result<V, String> {
        let found = self.0.iter().find(|(n, l, _)| n == name && *l == level);
        let (.., data) = found.ok_or_else(|| format!("`{name}` is not given at {level}"))?;
        V::typed(data).ok_or_else(|| format!("`{name}` is no such value: {data:?}"))
    }
}

/// A type that emitted code accepts.
pub trait Typed: Sized {
    /// Builds the value from its entries, row by row.
    fn typed(data: &[f64]) -> Option<Self>;
}

impl Typed for f64 {
    fn typed(data: &[f64]) -> Option<Self> {
        data.first().copied()
    }
}

impl<const R: usize, const C: usize> Typed for SMatrix<f64, R, C> {
    fn typed(data: &[f64]) -> Option<Self> {
        (data.len() == R * C).then(|| Self::from_row_slice(data))
    }
}

impl<const R: usize, const C: usize> Typed for Additive<R, C, f64> {
    fn typed(data: &[f64]) -> Option<Self> {
        SMatrix::typed(data).map(Self::new)
    }
}

impl Typed for PlaneMotion<f64> {
    fn typed(data: &[f64]) -> Option<Self> {
        Self::from_matrix(&SMatrix::typed(data)?).ok()
    }
}

impl Typed for Rotation<f64> {
    fn typed(data: &[f64]) -> Option<Self> {
        Self::from_matrix(&SMatrix::typed(data)?).ok()
    }
}

impl Typed for UnitQuaternion<f64> {
    fn typed(data: &[f64]) -> Option<Self> {
        // The components are the first column of the left-multiplication matrix.
        let at = |i: usize| data.get(4 * i).copied();
        Self::from_components([at(0)?, at(1)?, at(2)?, at(3)?]).ok()
    }
}

impl Typed for RigidMotion<f64> {
    fn typed(data: &[f64]) -> Option<Self> {
        Self::from_matrix(&SMatrix::typed(data)?).ok()
    }
}

impl<const N: usize> Typed for Orthogonal<N, f64> {
    fn typed(data: &[f64]) -> Option<Self> {
        Self::from_matrix(&SMatrix::typed(data)?).ok()
    }
}

impl<const N: usize> Typed for Linear<N, f64> {
    fn typed(data: &[f64]) -> Option<Self> {
        Self::from_matrix(&SMatrix::typed(data)?).ok()
    }
}
