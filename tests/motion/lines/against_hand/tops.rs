//! Coupled tops: random states, with the results of the compiled and the hand-written stepper.

use super::{Shown, System, attitude, moments, stretched, turned};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Rotation};
use clebsch_models::lattices::coupled_tops::*;
use clebsch_oracle::handwritten::attitude::{Quaternion, Vector, scaled_matrix};
use clebsch_oracle::handwritten::lattices::coupled_tops as hand;
use clebsch_oracle::oracle::points::Source;

/// Tops in an open chain or a ring.
#[derive(Clone)]
pub struct Coupled {
    row: hand::Row,
    attitudes: Vec<Quaternion>,
    momenta: Vec<Vector>,
    h: f64,
}

/// A matrix as a runtime type.
pub fn matrix(m: &[[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| m[i][j])
}

/// Attitudes as runtime types.
pub fn rotations(attitudes: &[Quaternion]) -> Vec<Rotation> {
    let each = attitudes.iter().map(|q| Rotation::from_quaternion(q.0));
    each.map(|q| q.expect("a unit quaternion")).collect()
}

/// Body momenta as runtime types.
pub fn body_momenta(momenta: &[Vector]) -> Vec<BodyMomentum> {
    let each = momenta.iter().map(|m| BodyMomentum(Vector3::from(*m)));
    each.collect()
}

/// The entries of all attitudes, row by row.
pub fn entries(attitudes: impl Iterator<Item = Quaternion>) -> Vec<f64> {
    attitudes.flat_map(|q| q.matrix().concat()).collect()
}

/// The entries of all runtime attitudes, row by row.
pub fn entries_of(attitudes: impl Iterator<Item = Rotation>) -> Vec<f64> {
    let each = attitudes.map(|r| r.matrix().transpose());
    each.flat_map(|m| m.as_slice().to_vec()).collect()
}

impl System for Coupled {
    const KINDS: usize = 7;
    const ENDS: usize = 2;

    fn draw(source: &mut Source, n: usize, ends: usize) -> Self {
        let nodes = n + 1 - ends;
        Self {
            attitudes: (0..nodes).map(|_| attitude(source)).collect(),
            momenta: (0..nodes).map(|_| source.vector()).collect(),
            row: hand::Row {
                spacing: source.between(0.5, 1.5),
                poinsot: moments(source),
                stiffness: source.symmetric::<3>().0,
                weight: source.vector(),
                up: source.vector(),
                ring: ends == 1,
            },
            // With the largest step size, some tops need more than one iteration for the root, so that the stepper also processes a
            // block one by one.
            h: source.between(0.02, 0.2),
        }
    }

    fn nudged(&self, kind: usize, share: f64) -> Option<Self> {
        let mut moved = self.clone();
        let row = &mut moved.row;
        match kind {
            0 => moved.momenta = self.momenta.iter().map(|m| stretched(*m, share)).collect(),
            1 => moved.attitudes = turned(&self.attitudes, share),
            2 => row.spacing *= 1.0 + share,
            3 => row.poinsot = scaled_matrix(1.0 + share, &row.poinsot),
            4 => row.stiffness = scaled_matrix(1.0 + share, &row.stiffness),
            5 => row.weight[0] *= 1.0 + share,
            _ => row.up[2] *= 1.0 + share,
        }
        Some(moved)
    }

    fn by_hand(&self, steps: usize) -> Option<Shown> {
        let (q, m) = (&self.attitudes, &self.momenta);
        let mut tops = hand::CoupledTops::start(&self.row, q, m, self.h).ok()?;
        for _ in 0..steps {
            tops.step().ok()?;
        }
        Some(vec![
            entries(tops.attitudes()),
            tops.spatial_momenta().flatten().collect(),
        ])
    }

    fn generated(&self, steps: usize) -> Option<Shown> {
        let row = &self.row;
        let parameters = CoupledTopsParameters {
            s: row.spacing,
            J: matrix(&row.poinsot),
            C: matrix(&row.stiffness),
            gU: row.weight.into(),
            z: row.up.into(),
        };
        let (n, ends) = match row.ring {
            true => (self.momenta.len(), CoupledTopsEnds::Ring),
            false => (self.momenta.len() - 1, CoupledTopsEnds::Open),
        };
        let tops = CoupledTops::new(parameters, CoupledTopsSites { N: n, ends }).ok()?;
        let initial = CoupledTopsInitial {
            Λ: rotations(&self.attitudes),
            body_momentum_Λ: body_momenta(&self.momenta),
        };
        let (mut state, mut work) = tops.start(initial, self.h).ok()?;
        for _ in 0..steps {
            tops.step(&mut state, &mut work).ok()?;
        }
        let momenta = state.spatial_momentum_Λ();
        Some(vec![
            entries_of(state.Λ()),
            momenta.flat_map(|m| m.0.as_slice().to_vec()).collect(),
        ])
    }
}
