//! Blocks of work for a ring of ten frames coupled by springs in one model, and for ten single frames, each coupled to space by a
//! spring and stepped in turn, with the same inertia.

use crate::blocks::STEPS;
use crate::loops::generated;
use crate::operation_counts::Block;
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Rotation};
use clebsch_oracle::physics::cases::generic_top;
use std::hint::black_box;

clebsch::model! {
    /// Ten frames in a ring, each coupled to the next by their axes.
    model Frames {
        /// second moments of each frame
        param J: Sym<3>;
        /// axes that a spring pulls together
        param a, b: Vec<3>;
        /// stiffness
        param c: Real;
        group R0: SO<3> velocity V0;
        group R1: SO<3> velocity V1;
        group R2: SO<3> velocity V2;
        group R3: SO<3> velocity V3;
        group R4: SO<3> velocity V4;
        group R5: SO<3> velocity V5;
        group R6: SO<3> velocity V6;
        group R7: SO<3> velocity V7;
        group R8: SO<3> velocity V8;
        group R9: SO<3> velocity V9;
        constraint next(R0) = R0*V0;
        constraint next(R1) = R1*V1;
        constraint next(R2) = R2*V2;
        constraint next(R3) = R3*V3;
        constraint next(R4) = R4*V4;
        constraint next(R5) = R5*V5;
        constraint next(R6) = R6*V6;
        constraint next(R7) = R7*V7;
        constraint next(R8) = R8*V8;
        constraint next(R9) = R9*V9;
        lagrangian = -tr(J*(V0 + V1 + V2 + V3 + V4 + V5 + V6 + V7 + V8 + V9))/h
            + h*c*(dot(R0*a, R1*b) + dot(R1*a, R2*b) + dot(R2*a, R3*b) + dot(R3*a, R4*b)
                 + dot(R4*a, R5*b) + dot(R5*a, R6*b) + dot(R6*a, R7*b) + dot(R7*a, R8*b)
                 + dot(R8*a, R9*b) + dot(R9*a, R0*b));
    }
}

// A separate model instead of the gallery's top, which would otherwise no longer be compiled into a single loop.
clebsch::model! {
    /// A frame whose axis is coupled to a fixed axis in space: a heavy top.
    model Frame {
        /// second moments
        param J: Sym<3>;
        /// the axis, times the stiffness, and that in space
        param a, z: Vec<3>;
        group R: SO<3> velocity V;
        advected Z: Vec<3> = R^T*z;
        constraint next(R) = R*V;
        constraint next(Z) = V^T*Z;
        lagrangian = -tr(J*V)/h - h*dot(a, Z);
    }
}

/// The initial attitude and momentum of each of the ten bodies.
fn start(i: u8) -> (Rotation<f64>, BodyMomentum<f64>) {
    let at = f64::from(i);
    let turn = Vector3::new(0.1 * at, 0.2, -0.05 * at);
    let momentum = Vector3::new(0.3 - 0.05 * at, 0.2 + 0.01 * at, 0.8);
    (Rotation::exp(&turn), BodyMomentum(momentum))
}

fn moments() -> Matrix3<f64> {
    let rows = generic_top().top.poinsot;
    Matrix3::from_fn(|r, c| rows[r][c])
}

/// A block of the ten frames.
pub fn generated_frames() -> Block<impl FnOnce()> {
    let parameters = FramesParameters {
        J: moments(),
        a: Vector3::new(0.3, 0.1, 0.5),
        b: Vector3::new(-0.2, 0.4, 0.1),
        c: 0.7,
    };
    let [s0, s1, s2, s3, s4, s5, s6, s7, s8, s9] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9].map(start);
    let initial = FramesInitial {
        R0: s0.0,
        body_momentum_R0: s0.1,
        R1: s1.0,
        body_momentum_R1: s1.1,
        R2: s2.0,
        body_momentum_R2: s2.1,
        R3: s3.0,
        body_momentum_R3: s3.1,
        R4: s4.0,
        body_momentum_R4: s4.1,
        R5: s5.0,
        body_momentum_R5: s5.1,
        R6: s6.0,
        body_momentum_R6: s6.1,
        R7: s7.0,
        body_momentum_R7: s7.1,
        R8: s8.0,
        body_momentum_R8: s8.1,
        R9: s9.0,
        body_momentum_R9: s9.1,
    };
    generated!(Frames::new(parameters), initial)
}

/// A block of ten frames coupled to space, each stepped separately.
pub fn generated_single_frames() -> impl FnOnce() {
    let top = generic_top();
    let parameters = FrameParameters {
        J: moments(),
        a: Vector3::from(top.top.weight),
        z: Vector3::from(top.top.up),
    };
    let model = Frame::new(parameters).expect("parameters");
    let frames = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9].map(|i| {
        let (attitude, body_momentum) = start(i);
        let initial = FrameInitial {
            R: attitude,
            body_momentum,
        };
        model.start(initial, top.h).expect("solvable")
    });
    move || {
        let (model, mut frames) = black_box((model, frames));
        for _ in 0..STEPS {
            for (state, workspace) in &mut frames {
                model.step(state, workspace).expect("solvable");
            }
        }
        black_box(&frames);
    }
}
