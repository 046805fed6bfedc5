//! Blocks of work for elastic ellipsoids in three dimensions and for four configurations coupled by springs: the same steps from
//! the initial state of a gallery case. Each step is a fallible call, and initialisation is outside the measured time.

use crate::loops::{generated, written};
use crate::operation_counts::Block;
use clebsch::nalgebra::{Matrix3, Vector3, Vector6};
use clebsch::{
    Additive, BodyImpulse, BodyMomentum, BodyMomentumMatrix, FieldMomentum, Linear, RigidMotion,
    Rotation, SpatialMomentumMatrix, UnitQuaternion,
};
use clebsch_models::ellipsoid_convective::{
    EllipsoidConvective, EllipsoidConvectiveInitial, EllipsoidConvectiveParameters,
};
use clebsch_models::ellipsoid_spatial::{
    EllipsoidSpatial, EllipsoidSpatialInitial, EllipsoidSpatialParameters,
};
use clebsch_models::mixed_four::{MixedFour, MixedFourInitial, MixedFourParameters};
use clebsch_oracle::handwritten;
use clebsch_oracle::handwritten::attitude::{Matrix, Quaternion, Vector};
use clebsch_oracle::handwritten::ellipsoid::{Ellipsoid, Of};
use clebsch_oracle::handwritten::mixed_four::{Four, Momenta, Places};
use clebsch_oracle::reference::H;

const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Soft enough for the step size of the benchmarks, and free of stress at the identity.
const ENERGY: [f64; 4] = [0.1, 1.0, 1.0, 6.2];

/// The velocity, which equals the momentum if placement, metric and second moments are the identity.
const VELOCITY: Matrix = [[0.1, -0.5, 0.3], [0.4, -0.1, -0.2], [-0.3, 0.35, 0.05]];

fn matrix(rows: &Matrix) -> Matrix3<f64> {
    Matrix3::from_fn(|r, c| rows[r][c])
}

/// A block of the generated convective ellipsoid.
pub fn generated_convective() -> Block<impl FnOnce()> {
    let [a, b, c, d] = ENERGY;
    let parameters = EllipsoidConvectiveParameters {
        C0: Matrix3::identity(),
        I0: Matrix3::identity(),
        a,
        b,
        c,
        d,
    };
    let initial = EllipsoidConvectiveInitial {
        Q: Linear::identity(),
        body_momentum: BodyMomentumMatrix(matrix(&VELOCITY)),
    };
    generated!(EllipsoidConvective::<3>::new(parameters), initial)
}

/// A block of the generated spatial ellipsoid.
pub fn generated_spatial() -> Block<impl FnOnce()> {
    let [a, b, c, d] = ENERGY;
    let parameters = EllipsoidSpatialParameters {
        C0: Matrix3::identity(),
        I0: Matrix3::identity(),
        a,
        b,
        c,
        d,
    };
    let initial = EllipsoidSpatialInitial {
        Q: Linear::identity(),
        spatial_momentum: SpatialMomentumMatrix(matrix(&VELOCITY)),
    };
    generated!(EllipsoidSpatial::<3>::new(parameters), initial)
}

fn written_ellipsoid(of: Of) -> impl FnOnce() {
    let body = Ellipsoid {
        metric: IDENTITY,
        moments: IDENTITY,
        energy: ENERGY,
        of,
    };
    let motion = handwritten::ellipsoid::ElasticEllipsoid::start(&body, &IDENTITY, &VELOCITY, H);
    written!(motion.expect("solvable"))
}

/// A block of the hand-written ellipsoid with an energy of the convective metric.
pub fn written_convective() -> impl FnOnce() {
    written_ellipsoid(Of::Metric)
}

/// A block of the hand-written ellipsoid with an energy of the spatial second moments.
pub fn written_spatial() -> impl FnOnce() {
    written_ellipsoid(Of::Moments)
}

const FOUR: Four = Four {
    poinsots: [
        [[1.0, 0.0, 0.0], [0.0, 0.7, 0.0], [0.0, 0.0, 0.4]],
        [[0.5, 0.0, 0.0], [0.0, 0.8, 0.0], [0.0, 0.0, 0.6]],
        [[0.2, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 0.6]],
    ],
    motion_mass: 1.5,
    point_mass: 1.2,
    quartic: 0.3,
    stiffness: 0.9,
    arms: [[0.6, -0.2, 0.3], [0.2, 0.4, -0.1], [-0.3, 0.5, 0.4]],
    gravity: [0.0, 0.0, -0.5],
};

const PLACES: Places = Places {
    attitudes: [Quaternion::IDENTITY; 3],
    motion: [0.5, -0.3, 0.4],
    point: [0.8, 0.1, -0.2],
};

const MOMENTA: Momenta = Momenta {
    angular: [[0.3, -0.2, 0.6], [-0.2, 0.4, 0.1], [0.1, 0.5, -0.3]],
    motion: [0.3, 0.2, -0.1],
    point: [0.2, -0.4, 0.5],
};

/// A block of the generated four configurations.
pub fn generated_four() -> Block<impl FnOnce()> {
    let column = |v: &Vector| Vector3::from(*v);
    let [p, s, e] = FOUR.arms.each_ref().map(column);
    let parameters = MixedFourParameters {
        J: matrix(&FOUR.poinsots[0]),
        A: matrix(&FOUR.poinsots[1]),
        M: FOUR.motion_mass,
        // tr J - J of its Poinsot matrix.
        I: Matrix3::from_diagonal(&Vector3::new(0.9, 0.8, 0.5)),
        m: FOUR.point_mass,
        b: FOUR.quartic,
        k: FOUR.stiffness,
        p,
        s,
        e,
        g: column(&FOUR.gravity),
    };
    let [first, second, third] = MOMENTA.angular;
    let ([a, b, c], [d, e, f]) = (second, MOMENTA.motion);
    let initial = MixedFourInitial {
        R: Rotation::identity(),
        body_momentum_R: BodyMomentum(column(&first)),
        G: RigidMotion {
            rotation: Rotation::identity(),
            translation: column(&PLACES.motion),
        },
        body_momentum_G: BodyImpulse(Vector6::new(a, b, c, d, e, f)),
        q: UnitQuaternion::identity(),
        body_momentum_q: BodyMomentum(column(&third)),
        X: Additive::new(column(&PLACES.point)),
        momentum_X: FieldMomentum(column(&MOMENTA.point)),
    };
    generated!(MixedFour::new(parameters), initial)
}

/// A block of the four hand-written configurations.
pub fn written_four() -> impl FnOnce() {
    let motion = handwritten::mixed_four::MixedFour::start(&FOUR, &PLACES, &MOMENTA, H);
    written!(motion.expect("solvable"))
}
