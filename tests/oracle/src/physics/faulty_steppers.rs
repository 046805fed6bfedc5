//! Deliberately wrong steppers with one fault each; every check must reject at least one of them. Takes the data of a heavy top (a
//! free body without weight) and a fault, and gives a motion. Without a fault the stepper is correct, so a rejection is due to the
//! fault.

use super::motion::Motion;
use super::taylor_reference::inverse_inertia;
use crate::handwritten::attitude::{
    Matrix, Quaternion, Vector, add_scaled, apply, apply_transposed, cross, dot,
};
use crate::handwritten::heavy_top::Top;
use crate::handwritten::one_sided_top::edge_rotation;
use crate::handwritten::principal_axes::PrincipalAxes;
use crate::handwritten::principal_root::Quartic;

/// The fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// No fault.
    None,
    /// The second half kick uses the vertical of the old node.
    KickAtOldNode,
    /// The vertical is advected by Om instead of Om^T.
    VerticalCarriedBackwards,
    /// Reports momentum and energy of the outgoing edge as values of the node.
    EdgeForNode,
    /// Pairs the momentum of the incoming edge, in the axes of its start, with the new vertical.
    LatePairing,
    /// Rotates by I^-1 h mu without solving the Moser-Veselov equation.
    Unsolved,
    /// Rotates in the opposite direction: uses the momentum sign of the thesis.
    Reversed,
    /// The momentum shrinks by one part in 10^7 each step.
    Friction,
}

/// A simple stepper in body variables with its own vertical, in principal axes of a diagonal or full J.
#[derive(Clone, Copy, Debug)]
pub struct FaultyTop {
    fault: Fault,
    top: Top,
    inverse: Matrix,
    axes: PrincipalAxes,
    quartic: Quartic,
    h: f64,
    q: Quaternion,
    mu: Vector,
    vertical: Vector,
    /// Momentum of the last edge, in the axes of its initial node.
    edge: Vector,
}

impl FaultyTop {
    /// Starts a trajectory with one fault.
    pub fn start(
        top: &Top,
        attitude: &Quaternion,
        body_momentum: &Vector,
        h: f64,
        fault: Fault,
    ) -> Result<FaultyTop, String> {
        let axes = PrincipalAxes::new(&top.poinsot).map_err(|refusal| refusal.to_string())?;
        Ok(FaultyTop {
            fault,
            top: *top,
            inverse: inverse_inertia(&top.poinsot),
            axes,
            quartic: Quartic::new(&axes.moments),
            h,
            q: *attitude,
            mu: *body_momentum,
            vertical: apply_transposed(&attitude.matrix(), &top.up),
            edge: *body_momentum,
        })
    }

    fn departing(&self) -> Vector {
        add_scaled(
            &self.mu,
            0.5 * self.h,
            &cross(&self.vertical, &self.top.weight),
        )
    }

    fn rotation(&self, n: &Vector) -> Result<Matrix, String> {
        if self.fault == Fault::Unsolved {
            let [x, y, z] = apply(&self.inverse, n).map(|c| 0.5 * self.h * c);
            return Ok(Quaternion([1.0, x, y, z]).normalised().matrix());
        }
        let principal = edge_rotation(&self.axes, &self.quartic, &self.axes.enter(n), self.h)
            .map_err(|refusal| refusal.to_string())?;
        // Columns of the rotation in user axes: R_user v = leave(R enter(v)).
        let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| {
            self.axes
                .leave(&apply(&principal.matrix(), &self.axes.enter(&e)))
        });
        let transposed = [0, 1, 2].map(|i| [columns[0][i], columns[1][i], columns[2][i]]);
        Ok(if self.fault == Fault::Reversed {
            columns
        } else {
            transposed
        })
    }
}

impl Motion for FaultyTop {
    fn step(&mut self) -> Result<(), String> {
        let n = self.departing();
        let turn = self.rotation(&n)?;
        let old = self.vertical;
        self.q = self.q.times(&Quaternion::from_matrix(&turn)).normalised();
        self.vertical = if self.fault == Fault::VerticalCarriedBackwards {
            apply(&turn, &old)
        } else {
            apply_transposed(&turn, &old)
        };
        self.edge = n;
        let arriving = apply_transposed(&turn, &n);
        let acting = if self.fault == Fault::KickAtOldNode {
            &old
        } else {
            &self.vertical
        };
        self.mu = add_scaled(&arriving, 0.5 * self.h, &cross(acting, &self.top.weight));
        if self.fault == Fault::Friction {
            self.mu = self.mu.map(|c| c * (1.0 - 1e-7));
        }
        Ok(())
    }

    fn attitude(&self) -> Matrix {
        self.q.matrix()
    }

    fn body_momentum(&self) -> Vector {
        match self.fault {
            Fault::EdgeForNode => self.departing(),
            Fault::LatePairing => self.edge,
            _ => self.mu,
        }
    }

    fn spatial_momentum(&self) -> Vector {
        apply(&self.q.matrix(), &self.body_momentum())
    }

    fn energy(&self) -> f64 {
        let mu = self.body_momentum();
        0.5 * dot(&mu, &apply(&self.inverse, &mu)) + dot(&self.top.weight, &self.vertical)
    }

    fn vertical(&self) -> Vector {
        self.vertical
    }
}
