//! Steps of a free body by a solver that does not use the trajectory's constants. Takes the trajectory and the solver's
//! name; advances attitude and body momentum.

use super::{Free, Order};
use crate::solvers::Method;
use crate::solvers::left_factor::rotation_at;
use crate::solvers::moser_veselov::MoserVeselovError;
use crate::{Real, Rotation, SpatialMomentum};

impl<T: Real> Free<T> {
    /// This trajectory, with the solver `method` in every step. Every solver except `kappa` prepares the
    /// body anew.
    #[must_use]
    pub fn solved_by(self, method: Method) -> Self {
        match method {
            Method::Kappa => self,
            _ => Self {
                method,
                attitude: nowhere(),
                ..self
            },
        }
    }

    /// A step by another solver.
    pub(super) fn step_by(
        &mut self,
        attitude: &mut Rotation<T>,
        momentum: &SpatialMomentum<T>,
    ) -> Result<(), MoserVeselovError> {
        // Modified moments depend on the trajectory.
        let mut here = *self;
        here.restart(attitude, momentum)?;
        let body = match self.order {
            Order::Two => *self.given.matrix(),
            _ => here.frame * here.body.matrix() * here.frame.transpose(),
        };
        let h_mu = attitude.inverse_rotate(&(momentum.0 * self.h));
        let Ok(omega) = rotation_at(&body, &h_mu, self.method) else {
            return Err(MoserVeselovError::of_solver(
                self.method,
                &self.given,
                &h_mu,
            ));
        };
        let turned = *attitude * omega;
        let arrived = match &here.compensation {
            None => turned,
            Some((compensation, _)) => *compensation * turned,
        };
        *self = here;
        let h_mu = arrived.inverse_rotate(&(momentum.0 * self.h));
        let u = self.body.scaled(&self.frame.tr_mul(&h_mu));
        for (axis, x) in self.axes.iter_mut().zip(u) {
            axis.body = x;
        }
        *attitude = arrived;
        Ok(())
    }
}

/// An attitude of NaN, which differs from every attitude.
fn nowhere<T: Real>() -> Rotation<T> {
    Rotation::from_unit([T::from_f64(f64::NAN); 4])
}
