//! Runge-Kutta methods with error control: Dormand and Prince 5(4), the method of Matlab's ode45; their 8(5,3); and Verner's 9(8)
//! for references. Gives the state at every node. Steps end at the nodes, so that nothing is interpolated.

use crate::continuous::Motion;
use crate::handwritten::Unsolvable;
use differential_equations::methods::{Adaptive, DormandPrince, ExplicitRungeKutta, Ordinary};
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};

/// The equations in the interface of the integrator library.
#[derive(Clone, Debug)]
struct Equations<M>(M);

impl<M: Motion<N>, const N: usize> ODE<f64, [f64; N]> for Equations<M> {
    #[inline(always)]
    fn diff(&self, _time: f64, y: &[f64; N], out: &mut [f64; N]) {
        self.0.rate(y, out);
    }
}

/// Dormand and Prince 5(4).
pub type Method54<const N: usize> =
    ExplicitRungeKutta<Ordinary, DormandPrince, f64, [f64; N], 5, 7, 7>;
/// Dormand and Prince 8(5,3).
pub type Method85<const N: usize> =
    ExplicitRungeKutta<Ordinary, DormandPrince, f64, [f64; N], 8, 12, 16>;
/// Verner's efficient 9(8).
pub type Method98<const N: usize> =
    ExplicitRungeKutta<Ordinary, Adaptive, f64, [f64; N], 9, 16, 21>;

/// A Runge-Kutta method.
pub trait Scheme<const N: usize>: OrdinaryNumericalMethod<f64, [f64; N]> {
    /// The method with this absolute and relative tolerance for the error of one step, and this first step size.
    fn with(tolerance: f64, first: f64) -> Self;
}

impl<const N: usize> Scheme<N> for Method54<N> {
    fn with(tolerance: f64, first: f64) -> Self {
        let method = Self::dopri5().rtol(tolerance).atol(tolerance);
        method.h0(first).max_steps(usize::MAX)
    }
}

impl<const N: usize> Scheme<N> for Method85<N> {
    fn with(tolerance: f64, first: f64) -> Self {
        let method = Self::dop853().rtol(tolerance).atol(tolerance);
        method.h0(first).max_steps(usize::MAX)
    }
}

impl<const N: usize> Scheme<N> for Method98<N> {
    fn with(tolerance: f64, first: f64) -> Self {
        let method = Self::rkv988e().rtol(tolerance).atol(tolerance);
        method.h0(first).max_steps(usize::MAX)
    }
}

/// The accuracy of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Absolute and relative tolerance for the error of one step.
    pub tolerance: f64,
    /// Largest step size relative to the node distance, at most 1.
    pub part: f64,
}

impl Accuracy {
    /// A tolerance, with steps as large as the node distance permits.
    pub const fn of(tolerance: f64) -> Self {
        Self {
            tolerance,
            part: 1.0,
        }
    }

    /// Accuracy at rounding level, with at least `pieces` steps per node, whatever the error estimate says.
    pub fn reference(pieces: u32) -> Self {
        Self {
            tolerance: 1e-15,
            part: 1.0 / f64::from(pieces.max(1)),
        }
    }
}

/// A motion sampled at the nodes.
#[derive(Clone, Debug)]
pub struct RungeKutta<R, M, const N: usize> {
    method: R,
    equations: Equations<M>,
    h: f64,
    longest: f64,
}

impl<R: Scheme<N>, M: Motion<N>, const N: usize> RungeKutta<R, M, N> {
    /// Starts a motion with node distance `h`.
    ///
    /// # Errors
    /// [`Unsolvable`] if the initial state is not finite.
    pub fn start(
        motion: M,
        start: &[f64; N],
        h: f64,
        accuracy: Accuracy,
    ) -> Result<Self, Unsolvable> {
        let mut method = R::with(accuracy.tolerance, accuracy.part * h);
        let equations = Equations(motion);
        // The library needs an end time only to bound steps; here the nodes bound them.
        let end = h * 1e15;
        method
            .init(&equations, 0.0, end, start)
            .map_err(|_| Unsolvable)?;
        Ok(Self {
            method,
            equations,
            h,
            longest: accuracy.part * h,
        })
    }

    /// Advances to the next node.
    ///
    /// # Errors
    /// [`Unsolvable`] if the tolerance cannot be met because the motion is not finite.
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        // Time is measured from the last node: the sum of all steps would lose a digit in a thousand nodes, and the equations are
        // autonomous.
        let mut left = self.h;
        while left > 1e-10 * self.h {
            let wanted = self.method.h().abs().min(self.longest);
            // Takes two equal steps instead of a full step and a tiny remainder.
            let taken = if wanted >= (1.0 - 1e-9) * left {
                left
            } else {
                wanted.min(0.5 * left)
            };
            if taken.is_nan() || taken <= 1e-9 * self.h {
                return Err(Unsolvable);
            }
            let before = self.method.t();
            self.method.set_h(taken);
            self.method.step(&self.equations).map_err(|_| Unsolvable)?;
            if self.method.t() > before {
                left -= taken;
                // A shortened step must not reduce the next step size.
                if self.method.h() < wanted {
                    self.method.set_h(wanted);
                }
            }
        }
        Ok(())
    }

    /// The state at the current node.
    pub fn state(&self) -> &[f64; N] {
        self.method.y()
    }
}
