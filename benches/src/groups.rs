//! Blocks of work for models on SU(2) and SE(3), in unit quaternions and in a fluid: the same steps from the same initial state.
//! Each step is a fallible call, and initialisation is outside the measured time.

use crate::loops::{generated, written};
use crate::operation_counts::Block;
use clebsch::nalgebra::{Matrix3, Vector3, Vector4, Vector6};
use clebsch::{BodyImpulse, BodyMomentum, RigidMotion, Rotation, SpatialMomentum, UnitQuaternion};
use clebsch_models::cayley_klein::{CayleyKlein, CayleyKleinInitial, CayleyKleinParameters};
use clebsch_models::cayley_klein_spatial::{
    CayleyKleinSpatial, CayleyKleinSpatialInitial, CayleyKleinSpatialParameters,
};
use clebsch_models::kirchhoff_body::{
    KirchhoffBody, KirchhoffBodyInitial, KirchhoffBodyParameters,
};
use clebsch_oracle::handwritten;
use clebsch_oracle::handwritten::attitude::{Matrix, Quaternion, Vector};
use clebsch_oracle::physics::systems::{submerged, submerged_body};
use clebsch_oracle::reference::H;

const MOMENTS: Vector = [3.5, 2.5, 2.0];

const MOMENTUM: Vector = [-0.5, 0.3, 1.0];

/// The body starts at the identity, so that inertia and momentum are the same in body and space.
fn inertia() -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::from(MOMENTS))
}

/// A block of the generated body in unit quaternions, the member `c` of the family.
pub fn generated_cayley_klein(c: f64) -> Block<impl FnOnce()> {
    let parameters = CayleyKleinParameters { I: inertia(), c };
    let initial = CayleyKleinInitial {
        q: UnitQuaternion::identity(),
        body_momentum: BodyMomentum(Vector3::from(MOMENTUM)),
    };
    generated!(CayleyKlein::new(parameters), initial)
}

/// A block of the generated body in unit quaternions, spatial representation.
pub fn generated_cayley_klein_spatial(c: f64) -> Block<impl FnOnce()> {
    let initial = CayleyKleinSpatialInitial {
        q: UnitQuaternion::identity(),
        spatial_momentum: SpatialMomentum(Vector3::from(MOMENTUM)),
        I: inertia(),
    };
    let parameters = CayleyKleinSpatialParameters { c };
    generated!(CayleyKleinSpatial::new(parameters), initial)
}

/// A block of the hand-written body in unit quaternions.
pub fn written_cayley_klein(c: f64) -> impl FnOnce() {
    let start = Quaternion::IDENTITY;
    let motion = handwritten::cayley_klein::CayleyKlein::start(&MOMENTS, c, &start, &MOMENTUM, H);
    written!(motion.expect("solvable"))
}

fn matrix(rows: &Matrix) -> Matrix3<f64> {
    Matrix3::from_fn(|r, c| rows[r][c])
}

/// A block of the generated body in a fluid, without net weight, because a heavy body accelerates without limit.
pub fn generated_kirchhoff_body() -> Block<impl FnOnce()> {
    let (body, attitude, place, momentum) = submerged(0.0);
    let [a, b, c] = body.moment;
    let [x, y, z] = body.up;
    let parameters = KirchhoffBodyParameters {
        J: matrix(&body.poinsot),
        M: matrix(&body.masses),
        D: matrix(&body.coupling),
        b: Vector4::new(a, b, c, body.weight),
        Z: Vector4::new(x, y, z, 0.0),
    };
    let ([a, b, c], [d, e, f]) = (momentum.angular, momentum.linear);
    let initial = KirchhoffBodyInitial {
        G: RigidMotion {
            rotation: Rotation::from_quaternion(attitude.0).expect("a unit quaternion"),
            translation: Vector3::from(place),
        },
        body_momentum: BodyImpulse(Vector6::new(a, b, c, d, e, f)),
    };
    generated!(KirchhoffBody::new(parameters), initial)
}

/// A block of the hand-written body in a fluid.
pub fn written_kirchhoff_body() -> impl FnOnce() {
    written!(submerged_body(0.0, H))
}
