//! A body on a hinge along a basis axis, compared with the equivalent pendulum of one angle. The entries of its rotation in the
//! constraints vanish up to rounding, and cannot serve as a scale for it.

use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Rotation};

clebsch::model! {
    /// A heavy body that rotates about the third axis.
    model Hinge {
        param J: Sym<3>;
        param g, a: Vec<3>;
        group R: SO<3> velocity W;
        constraint next(R) = R*W;
        hold l: dot(E1, R*E3) = 0;
        hold j: dot(E2, R*E3) = 0;
        lagrangian = -tr(J*W)/h + h*dot(g, R*a);
    }
}

const H: f64 = 0.01;
const STEPS: usize = 300;

fn about_third(angle: f64) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)
}

/// The final difference between the hinge and the pendulum, whose action in one angle is
/// `-(J11 + J22) cos(θ_{k+1} - θ_k)/h + h/2 (U(θ_k) + U(θ_{k+1}))`.
fn off(angle: f64, momentum: f64, g: Vector3<f64>) -> f64 {
    let j = Matrix3::new(0.5, 0.1, 0.05, 0.1, 0.7, 0.02, 0.05, 0.02, 0.9);
    let a = Vector3::new(1.0, 0.2, 0.3);
    let inertia = j[(0, 0)] + j[(1, 1)];
    let model = Hinge::new(HingeParameters { J: j, g, a }).expect("parameters");
    let initial = HingeInitial {
        R: Rotation::from_matrix(&about_third(angle)).expect("a rotation"),
        // The momentum of a rotation about the axis; products of inertia add components perpendicular to it.
        body_momentum: BodyMomentum(
            (Matrix3::identity() * j.trace() - j).column(2) * (momentum / inertia),
        ),
    };
    let (mut state, mut work) = model.start(initial, H).expect("starts");
    for _ in 0..STEPS {
        model.step(&mut state, &mut work).expect("steps");
    }
    // U = g . R(θ) a.
    let pull = |angle: f64| {
        let (s, c) = angle.sin_cos();
        g.x * (-s * a.x - c * a.y) + g.y * (c * a.x - s * a.y)
    };
    let (mut angle, mut momentum) = (angle, momentum);
    for _ in 0..STEPS {
        let turn = (H / inertia * (momentum + 0.5 * H * pull(angle))).asin();
        let next = angle + turn;
        momentum = inertia / H * turn.sin() + 0.5 * H * pull(next);
        angle = next;
    }
    (state.R().matrix() - about_third(angle)).norm()
}

#[test]
fn a_hinge_along_an_axis_of_the_basis_is_a_pendulum() {
    // Three hundred steps with a few rounding errors each; the motion does not amplify them.
    let least = 1e-12;
    let weight = Vector3::new(0.1, -1.0, 0.2);
    // From rest; rotated; with an initial velocity; without a force.
    for (angle, momentum, g) in [
        (0.0, 0.0, weight),
        (0.4, 0.0, weight),
        (-1.3, 0.8, weight),
        (0.0, 1.2, Vector3::zeros()),
    ] {
        let off = off(angle, momentum, g);
        assert!(off < least, "{angle} {momentum}: {off:e}");
    }
}
