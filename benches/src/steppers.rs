//! One block of work for each stepper: the same steps from the same initial state. Each step is a fallible call, and initialisation
//! is outside the measured time.

use crate::blocks::STEPS;
use crate::loops::generated;
use crate::operation_counts::Block;
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Rotation};
use clebsch_models::free_body::{FreeBody, FreeBodyInitial, FreeBodyParameters};
use clebsch_models::heavy_top::{HeavyTop, HeavyTopInitial, HeavyTopParameters};
use clebsch_oracle::handwritten;
use clebsch_oracle::physics::cases::Start;
use std::hint::black_box;

fn matrix(start: &Start) -> Matrix3<f64> {
    Matrix3::from_fn(|r, c| start.top.poinsot[r][c])
}

fn attitude(start: &Start) -> Rotation<f64> {
    Rotation::from_quaternion(start.attitude.0).expect("a unit quaternion")
}

/// A block of the generated free body.
pub fn generated_body(start: &Start) -> Block<impl FnOnce() + use<>> {
    let initial = FreeBodyInitial {
        Λ: attitude(start),
        body_momentum: BodyMomentum(Vector3::from(start.body_momentum)),
    };
    generated!(
        FreeBody::new(FreeBodyParameters { J: matrix(start) }),
        initial,
        start.h
    )
}

/// A block of the hand-written free body.
pub fn written_body(start: &Start) -> impl FnOnce() + use<> {
    let body = handwritten::free_body::FreeBody::start(
        &start.top.poinsot,
        &start.attitude,
        &start.body_momentum,
        start.h,
    )
    .expect("solvable");
    move || {
        let mut body = black_box(body);
        for _ in 0..STEPS {
            body.step();
        }
        black_box(&body);
    }
}

/// A block of the generated heavy top.
pub fn generated_top(start: &Start) -> Block<impl FnOnce() + use<>> {
    let parameters = HeavyTopParameters {
        J: matrix(start),
        gU: Vector3::from(start.top.weight),
        z: Vector3::from(start.top.up),
    };
    let initial = HeavyTopInitial {
        Λ: attitude(start),
        body_momentum: BodyMomentum(Vector3::from(start.body_momentum)),
    };
    generated!(HeavyTop::new(parameters), initial, start.h)
}

/// A block of the hand-written heavy top.
pub fn written_top(start: &Start) -> impl FnOnce() + use<> {
    let top = handwritten::heavy_top::HeavyTop::start(
        &start.top,
        &start.attitude,
        &start.body_momentum,
        start.h,
    )
    .expect("solvable");
    move || {
        let mut top = black_box(top);
        for _ in 0..STEPS {
            top.step().expect("solvable");
        }
        black_box(&top);
    }
}
