//! Random models on every group of the language, compiled as a user's are. The package is built
//! without optimisation, in every profile: it is run once, and compiling is what it costs.
//!
//! `CLEBSCH_RANDOM_MODELS=300 cargo test -p clebsch-compiled` compiles and runs three hundred,
//! `CLEBSCH_RANDOM_FIRST=1000` others.

use clebsch::card::Card;
use clebsch::nalgebra::SMatrix;
use clebsch::{Additive, Linear, Orthogonal, PlaneMotion, RigidMotion, Rotation, UnitQuaternion};

include!(concat!(env!("OUT_DIR"), "/models.rs"));

/// A body on a spring, stated by its configurations at both ends of the step: a sum of carried points
/// under a vector product, which was emitted with the columns of the matrix before it.
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
    /// What it was made from.
    pub seed: u64,
    /// Its residual at three nodes, the step first.
    pub residual: fn(f64, &Given) -> Result<Vec<f64>, String>,
    /// Its description, by which it is stepped.
    pub card: &'static Card,
}

/// Values by name and level, row by row.
#[derive(Clone, Debug)]
pub struct Given(pub Vec<(String, i8, Vec<f64>)>);

impl Given {
    /// The value in the type that is asked for.
    ///
    /// # Errors
    /// When there is none, or it is no such value.
    pub fn get<V: Typed>(&self, name: &str, level: i8) -> Result<V, String> {
        let found = self.0.iter().find(|(n, l, _)| n == name && *l == level);
        let (.., data) = found.ok_or_else(|| format!("`{name}` is not given at {level}"))?;
        V::typed(data).ok_or_else(|| format!("`{name}` is no such value: {data:?}"))
    }
}

/// A value that emitted code takes.
pub trait Typed: Sized {
    /// From its entries, row by row.
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
        // The first column of the left multiplication.
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
