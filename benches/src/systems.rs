//! Blocks of work for the spatial forms, coupled bodies and bodies in fields: the same steps from the same initial state. Each step
//! is a fallible call, and initialisation is outside the measured time.

use crate::blocks::STEPS;
use crate::loops::{generated, written};
use crate::operation_counts::Block;
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Rotation, SpatialMomentum};
use clebsch_models::body_in_quadratic_field::{
    BodyInQuadraticField, BodyInQuadraticFieldInitial, BodyInQuadraticFieldParameters,
};
use clebsch_models::body_in_two_fields::{
    BodyInTwoFields, BodyInTwoFieldsInitial, BodyInTwoFieldsParameters,
};
use clebsch_models::coupled_bodies::{
    CoupledBodies, CoupledBodiesInitial, CoupledBodiesParameters,
};
use clebsch_models::free_body_spatial::{
    FreeBodySpatial, FreeBodySpatialInitial, FreeBodySpatialParameters,
};
use clebsch_models::heavy_top_spatial::{
    HeavyTopSpatial, HeavyTopSpatialInitial, HeavyTopSpatialParameters,
};
use clebsch_oracle::handwritten;
use clebsch_oracle::handwritten::attitude::{Matrix, Quaternion, Vector, apply_transposed};
use clebsch_oracle::handwritten::coupled_bodies::Pair;
use clebsch_oracle::physics::cases::generic_top;
use clebsch_oracle::physics::systems::{
    body_in, quadratic_field, spatial_body, spatial_top, two_fields,
};
use clebsch_oracle::reference::H;
use std::hint::black_box;

fn matrix(rows: &Matrix) -> Matrix3<f64> {
    Matrix3::from_fn(|r, c| rows[r][c])
}

fn rotation(q: &Quaternion) -> Rotation<f64> {
    Rotation::from_quaternion(q.0).expect("a unit quaternion")
}

/// A block of the generated free body, spatial representation.
pub fn generated_free_body_spatial() -> Block<impl FnOnce()> {
    let start = spatial_body(H);
    let initial = FreeBodySpatialInitial {
        Λ: rotation(&start.attitude()),
        spatial_momentum: SpatialMomentum(Vector3::from(start.spatial_momentum())),
        J: matrix(&start.poinsot()),
    };
    let parameters = FreeBodySpatialParameters {
        scalar: std::marker::PhantomData,
    };
    generated!(FreeBodySpatial::new(parameters), initial)
}

/// A block of the hand-written free body, spatial representation.
pub fn written_free_body_spatial() -> impl FnOnce() {
    let body = spatial_body(H);
    move || {
        let mut body = black_box(body);
        for _ in 0..STEPS {
            body.step();
        }
        black_box(&body);
    }
}

/// A block of the generated top, spatial representation.
pub fn generated_heavy_top_spatial() -> Block<impl FnOnce()> {
    let start = spatial_top(H);
    let initial = HeavyTopSpatialInitial {
        Λ: rotation(&start.attitude()),
        spatial_momentum: SpatialMomentum(Vector3::from(start.spatial_momentum())),
        J: matrix(&start.poinsot()),
        χ: Vector3::from(start.arm()),
    };
    let parameters = HeavyTopSpatialParameters {
        w: 1.0,
        z: Vector3::z(),
    };
    generated!(HeavyTopSpatial::new(parameters), initial)
}

/// A block of the hand-written top, spatial representation.
pub fn written_heavy_top_spatial() -> impl FnOnce() {
    written!(spatial_top(H))
}

/// Data, attitudes and body momenta of a pair.
pub type Joined = (Pair, [Quaternion; 2], [Vector; 2]);

/// A block of the generated pair.
pub fn generated_pair((pair, attitudes, momenta): &Joined) -> Block<impl FnOnce() + use<>> {
    let parameters = CoupledBodiesParameters {
        J1: matrix(&pair.poinsots[0]),
        J2: matrix(&pair.poinsots[1]),
        d1: Vector3::from(pair.arms[0]),
        d2: Vector3::from(pair.arms[1]),
        eps: pair.eps,
    };
    let initial = CoupledBodiesInitial {
        Λ1: rotation(&attitudes[0]),
        body_momentum_Λ1: BodyMomentum(Vector3::from(momenta[0])),
        Λ2: rotation(&attitudes[1]),
        body_momentum_Λ2: BodyMomentum(Vector3::from(momenta[1])),
    };
    generated!(CoupledBodies::new(parameters), initial)
}

/// A block of the hand-written pair.
pub fn written_pair((pair, attitudes, momenta): &Joined) -> impl FnOnce() + use<> {
    let motion = handwritten::coupled_bodies::CoupledBodies::start(pair, attitudes, momenta, H);
    written!(motion.expect("solvable"))
}

/// A block of the generated body in a quadratic field.
pub fn generated_quadratic_field() -> Block<impl FnOnce()> {
    let (start, field) = (generic_top(), quadratic_field());
    let attitude = start.attitude.normalised();
    let parameters = BodyInQuadraticFieldParameters {
        J: matrix(&start.top.poinsot),
        K: matrix(&field.stiffness),
    };
    let initial = BodyInQuadraticFieldInitial {
        Λ: rotation(&attitude),
        body_momentum: BodyMomentum(Vector3::from(start.body_momentum)),
        Γ: Vector3::from(apply_transposed(&attitude.matrix(), &field.axis)),
    };
    generated!(BodyInQuadraticField::new(parameters), initial)
}

/// A block of the hand-written body in a quadratic field.
pub fn written_quadratic_field() -> impl FnOnce() {
    written!(body_in(&quadratic_field(), H))
}

/// A block of the generated body in two fields.
pub fn generated_two_fields() -> Block<impl FnOnce()> {
    let (start, fields) = (generic_top(), two_fields());
    let parameters = BodyInTwoFieldsParameters {
        J: matrix(&start.top.poinsot),
        gU: Vector3::from(fields.weight),
        p: Vector3::from(fields.dipole),
        z: Vector3::from(fields.up),
        b: Vector3::from(fields.field),
    };
    let initial = BodyInTwoFieldsInitial {
        Λ: rotation(&start.attitude.normalised()),
        body_momentum: BodyMomentum(Vector3::from(start.body_momentum)),
    };
    generated!(BodyInTwoFields::new(parameters), initial)
}

/// A block of the hand-written body in two fields.
pub fn written_two_fields() -> impl FnOnce() {
    written!(body_in(&two_fields(), H))
}
