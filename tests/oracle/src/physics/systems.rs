//! Initial data of the other hand-written systems: spatial forms, coupled bodies, bodies in fields and in n dimensions. Each
//! function gives a motion at node 0 for a step size.

// Index loops keep the shape of the formulas.
#![allow(clippy::needless_range_loop)]

use super::cases::{diagonal, generic_top, lagrange_top};
use crate::handwritten::attitude::{Matrix, Quaternion, Vector, add_scaled, apply};
use crate::handwritten::body_in_field::{BodyInField, Field, QuadraticField, TwoFields};
use crate::handwritten::body_n::{BodyN, identity, product, transposed};
use crate::handwritten::coupled_bodies::{CoupledBodies, Pair};
use crate::handwritten::free_body_spatial::FreeBodySpatial;
use crate::handwritten::heavy_top_spatial::{HeavyTopSpatial, SpatialTop};
use crate::handwritten::kirchhoff_body::{KirchhoffBody, Momentum, Submerged};
use crate::reference::{coupled_sym, spatial};

/// The diagonal of J for principal moments I.
pub fn poinsot(moments: Vector) -> Vector {
    let half = 0.5 * (moments[0] + moments[1] + moments[2]);
    moments.map(|i| half - i)
}

/// The reference run of the free body in the spatial representation.
pub fn spatial_body(h: f64) -> FreeBodySpatial {
    let [x, y, z] = spatial::QUATERNION_0;
    let w = (1.0 - x * x - y * y - z * z).sqrt();
    FreeBodySpatial::start(&spatial::J0, &Quaternion([w, x, y, z]), &spatial::M0, h)
        .expect("solvable")
}

/// The reference run of the Lagrange top in the spatial representation.
pub fn spatial_top(h: f64) -> HeavyTopSpatial {
    let start = lagrange_top();
    let r = start.attitude.matrix();
    let seen = product(&product(&r, &start.top.poinsot), &transposed(&r));
    let top = SpatialTop {
        weight: 1.0,
        up: start.top.up,
        poinsot: seen,
        arm: apply(&r, &start.top.weight),
    };
    HeavyTopSpatial::start(&top, &start.attitude, &apply(&r, &start.body_momentum), h)
        .expect("solvable")
}

/// The reference run of coupled bodies: data, attitudes, body momenta.
pub fn reference_pair() -> (Pair, [Quaternion; 2], [Vector; 2]) {
    let mut j = diagonal(poinsot(coupled_sym::MOMENTS));
    for (r, row) in j.iter_mut().enumerate() {
        for (c, x) in row.iter_mut().enumerate() {
            *x += coupled_sym::EPS * coupled_sym::ARM[r] * coupled_sym::ARM[c];
        }
    }
    let pair = Pair {
        poinsots: [j; 2],
        arms: [coupled_sym::ARM; 2],
        eps: coupled_sym::EPS,
    };
    let second = Quaternion::from_matrix(&coupled_sym::ATTITUDE_0);
    (pair, [Quaternion::IDENTITY, second], [coupled_sym::M0; 2])
}

/// Two different bodies with arms off their principal axes.
pub fn generic_pair() -> (Pair, [Quaternion; 2], [Vector; 2]) {
    let pair = Pair {
        poinsots: [
            [[0.9, 0.1, -0.15], [0.1, 0.6, 0.05], [-0.15, 0.05, 1.2]],
            [[0.7, -0.05, 0.1], [-0.05, 1.1, 0.2], [0.1, 0.2, 0.8]],
        ],
        arms: [[0.4, -0.3, 0.8], [-0.2, 0.7, 0.5]],
        eps: 0.4,
    };
    let q = [
        Quaternion([0.5, 0.1, -0.7, 0.5]).normalised(),
        Quaternion([0.3, -0.6, 0.2, 0.7]).normalised(),
    ];
    (pair, q, [[0.7, -0.4, 0.9], [-0.3, 0.8, 0.2]])
}

/// The attitude of body 2 relative to body 1.
pub fn relative(pair: &CoupledBodies) -> Matrix {
    let [a, b] = pair.attitudes();
    a.conjugate().times(&b).matrix()
}

/// Spatial momentum of the pair.
pub fn total(pair: &CoupledBodies) -> Vector {
    let [a, b] = pair.spatial_momenta();
    add_scaled(&a, 1.0, &b)
}

/// A free body in N dimensions without symmetry: the diagonal of J and the motion.
pub fn body_n<const N: usize>(h: f64) -> ([f64; N], BodyN<N>) {
    let mut j = [0.0; N];
    let mut mu = [[0.0; N]; N];
    for a in 0..N {
        j[a] = 0.5 + 0.25 * a as f64;
        for b in 0..a {
            let m = 0.4 * (1.3 * a as f64 + 2.1 * b as f64).cos();
            mu[a][b] = m;
            mu[b][a] = -m;
        }
    }
    let start = identity();
    (j, BodyN::start(&j, &start, &mu, h).expect("solvable"))
}

/// A quadratic field whose axes differ from the body's.
pub fn quadratic_field() -> QuadraticField {
    QuadraticField {
        stiffness: [[1.0, 0.3, -0.2], [0.3, -0.5, 0.4], [-0.2, 0.4, 0.7]],
        axis: [0.36, 0.48, 0.8],
    }
}

/// Two fields in general directions.
pub fn two_fields() -> TwoFields {
    TwoFields {
        weight: [0.3, -0.2, 0.9],
        dipole: [0.4, 0.5, -0.1],
        up: [0.0, 0.0, 1.0],
        field: [0.6, 0.2, 0.3],
    }
}

/// The generic body in a field.
pub fn body_in<F: Field>(field: &F, h: f64) -> BodyInField<F> {
    let start = generic_top();
    let attitude = start.attitude.normalised();
    BodyInField::start(
        &start.top.poinsot,
        field,
        &attitude,
        &start.body_momentum,
        h,
    )
    .expect("solvable")
}

/// The generic body in the quadratic field.
pub fn quadratic_body(h: f64) -> BodyInField<QuadraticField> {
    body_in(&quadratic_field(), h)
}

/// An asymmetric body in a fluid; `weight` is the net weight after buoyancy, with a moment of the same size.
pub fn submerged(weight: f64) -> (Submerged, Quaternion, Vector, Momentum) {
    let body = Submerged {
        poinsot: [[0.9, 0.1, -0.15], [0.1, 0.6, 0.05], [-0.15, 0.05, 1.2]],
        masses: [[1.5, 0.1, 0.0], [0.1, 2.0, -0.2], [0.0, -0.2, 3.0]],
        coupling: [[0.1, 0.02, 0.0], [-0.03, -0.05, 0.04], [0.01, 0.0, 0.15]],
        moment: [0.3, 0.1, -0.7].map(|c| weight * c),
        weight,
        up: [0.0, 0.0, 1.0],
    };
    let momentum = Momentum {
        angular: [0.3, -0.2, 0.8],
        linear: [0.9, 0.2, 0.4],
    };
    let attitude = Quaternion([0.5, 0.1, -0.7, 0.5]).normalised();
    (body, attitude, [0.3, -0.1, 0.2], momentum)
}

/// The motion of that body.
pub fn submerged_body(weight: f64, h: f64) -> KirchhoffBody {
    let (body, attitude, position, momentum) = submerged(weight);
    KirchhoffBody::start(&body, &attitude, &position, &momentum, h).expect("solvable")
}
