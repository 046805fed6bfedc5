//! Initial data of the rigid-body tests: a body, its attitude and momentum at node 0, and a step size. Contains the reference runs,
//! the figures of the thesis, and generic bodies without symmetry.

use crate::handwritten::attitude::{Matrix, Quaternion, Vector};
use crate::handwritten::heavy_top::Top;
use crate::reference::{H, body_sym, steady_rotation, top_lagrange};

/// A body at a node, ready to step.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// Inertia, weight and vertical; a free body ignores the latter two.
    pub top: Top,
    /// Attitude body -> space.
    pub attitude: Quaternion,
    /// Node momentum in body axes.
    pub body_momentum: Vector,
    /// Step size.
    pub h: f64,
}

impl Start {
    /// The same start with another step size.
    pub fn with_step(&self, h: f64) -> Start {
        Start { h, ..*self }
    }
}

/// Diagonal matrix.
pub fn diagonal([a, b, c]: Vector) -> Matrix {
    [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]]
}

/// A free body with principal moments of inertia I, at the identity.
pub fn free(moments: Vector, body_momentum: Vector) -> Start {
    let half_trace = 0.5 * (moments[0] + moments[1] + moments[2]);
    Start {
        top: Top {
            poinsot: diagonal(moments.map(|i| half_trace - i)),
            weight: [0.0; 3],
            up: [0.0, 0.0, 1.0],
        },
        attitude: Quaternion::IDENTITY,
        body_momentum,
        h: H,
    }
}

/// The reference run of the symmetric free body (also figure 2.5 of the thesis).
pub fn symmetric_body() -> Start {
    free([2.0, 2.0, 1.0], body_sym::M0)
}

/// The body without symmetry of figures 2.6 and 2.8.
pub fn asymmetric_body() -> Start {
    free([3.5, 2.5, 2.0], [-0.5, 0.0, 1.0])
}

/// A flat body, I = (1, 2, 3): its J = diag(2, 1, 0) is singular.
pub fn flat_body() -> Start {
    free([1.0, 2.0, 3.0], [-0.5, 0.3, 1.0])
}

/// The reference run of a steady rotation.
pub fn steady_body() -> Start {
    free([2.0, 2.0, 1.0], steady_rotation::M0)
}

/// The reference run of the Lagrange top; the one-sided run uses the momentum as the momentum of the first edge.
pub fn lagrange_top() -> Start {
    Start {
        top: Top {
            poinsot: diagonal(top_lagrange::J),
            weight: top_lagrange::WEIGHT,
            up: top_lagrange::UP,
        },
        attitude: Quaternion::from_matrix(&top_lagrange::ATTITUDE_0),
        body_momentum: top_lagrange::M0,
        h: H,
    }
}

/// A Lagrange top that hangs and swings: integrable, and far from the saddle of the upright top.
pub fn hanging_top() -> Start {
    let upright = lagrange_top();
    Start {
        top: Top {
            weight: [0.0, 0.0, -1.0],
            ..upright.top
        },
        ..upright
    }
}

/// A top without symmetry: full J, centre of mass off every axis, vertical off the third axis.
pub fn generic_top() -> Start {
    Start {
        top: Top {
            poinsot: [[0.9, 0.1, -0.15], [0.1, 0.6, 0.05], [-0.15, 0.05, 1.2]],
            weight: [0.4, -0.3, 0.8],
            up: [0.36, 0.48, 0.8],
        },
        attitude: Quaternion([0.5, 0.1, -0.7, 0.5]),
        body_momentum: [0.7, -0.4, 0.9],
        h: H,
    }
}
