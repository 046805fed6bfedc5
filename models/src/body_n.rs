//! The free rigid body in n dimensions, with any left factor (thesis 2.3; Moser and Veselov 1991, Manakov 1976).

use crate::case::{Case, Citations, Entry, Place};
use crate::thesis::THESIS;
use clebsch::nalgebra::SMatrix;
use clebsch::solvers::left_factor::LeftFactor;

clebsch::model! {
    /// Free rigid body in n dimensions.
    pub model BodyN {
        dim n in 3..=8;
        /// second moments of mass; any matrix with positive determinant
        param C: Mat<n>;
        /// attitude, body to space
        group Λ: SO<n> velocity Ω;
        /// reconstruction
        constraint next(Λ) = Λ * Ω;
        lagrangian = -tr(C^T*Ω)/h;
    }
}

/// The equations that also appear in the thesis.
const CITATIONS: Citations = Citations {
    work: Some(THESIS),
    statement: "",
    places: &[
        (Place::Reconstruction("Λ"), "(2.62)"),
        (Place::Relation("Λ"), "(2.60)"),
    ],
};

const STEP: f64 = 0.1;

/// Distinct second moments between 0.5 and 2.37.
fn moments<const N: usize>() -> SMatrix<f64, N, N> {
    SMatrix::from_fn(|i, j| match i == j {
        true => 0.5 + 0.25 * i as f64 + 0.03 * (i * i % 5) as f64,
        false => 0.0,
    })
}

/// A skew matrix without special structure.
fn momentum<const N: usize>() -> SMatrix<f64, N, N> {
    let entry = |i: usize, j: usize| 1.0 - 0.37 * ((3 * i + 5 * j) % 7) as f64;
    SMatrix::from_fn(|i, j| match i.cmp(&j) {
        core::cmp::Ordering::Less => -entry(i, j),
        core::cmp::Ordering::Equal => 0.0,
        core::cmp::Ordering::Greater => entry(j, i),
    })
}

/// A rotation by half a radian in the plane of the first two axes.
fn turn<const N: usize>() -> SMatrix<f64, N, N> {
    let (sin, cos) = 0.5_f64.sin_cos();
    let mut turn = SMatrix::identity();
    (turn[(0, 0)], turn[(0, 1)], turn[(1, 0)], turn[(1, 1)]) = (cos, -sin, sin, cos);
    turn
}

fn rows<const N: usize>(a: &SMatrix<f64, N, N>) -> Vec<f64> {
    a.transpose().as_slice().to_vec()
}

/// A case whose steps use this fraction of the exact bound.
fn case<const N: usize>(name: &str, doc: &str, c: SMatrix<f64, N, N>, fraction: f64) -> Case {
    let m = momentum::<N>();
    // The factors here are valid; opening the case rejects an invalid one.
    let ratio = LeftFactor::new(c).map_or(1.0, |factor| factor.reach(&(m * STEP)));
    Case {
        name: name.to_owned(),
        doc: doc.to_owned(),
        h: STEP,
        steps: 10_000,
        parameters: vec![rows(&c)],
        initial: vec![
            rows(&SMatrix::<f64, N, N>::identity()),
            rows(&(m * (fraction / ratio))),
        ],
        bounds: Vec::new(),
    }
}

/// The model and its cases.
pub fn entry() -> Entry {
    Entry {
        card: BodyN::<4>::CARD,
        citations: CITATIONS,
        cases: vec![
            case(
                "four",
                "four dimensions, momentum at 0.3 of the existence bound",
                moments::<4>(),
                0.3,
            ),
            case(
                "three",
                "three dimensions, momentum at 0.3 of the existence bound",
                moments::<3>(),
                0.3,
            ),
            case(
                "five",
                "five dimensions, momentum at 0.3 of the existence bound",
                moments::<5>(),
                0.3,
            ),
            case(
                "six",
                "six dimensions, momentum at 0.3 of the existence bound",
                moments::<6>(),
                0.3,
            ),
            case(
                "seven",
                "seven dimensions, momentum at 0.3 of the existence bound",
                moments::<7>(),
                0.3,
            ),
            case(
                "eight",
                "eight dimensions, momentum at 0.3 of the existence bound",
                moments::<8>(),
                0.3,
            ),
            case(
                "near-the-bound",
                "four dimensions, momentum at 0.95 of the existence bound",
                moments::<4>(),
                0.95,
            ),
            case(
                "turned",
                "four dimensions, non-symmetric left factor, momentum at 0.3 of the existence bound; for this step size \
                 only, since with a fixed factor the term tr(Cᵀ ξ) does not vanish as h -> 0",
                moments::<4>() * turn::<4>(),
                0.3,
            ),
        ],
    }
}
