//! Runge-Kutta methods with error control: Dormand and Prince 5(4), as Matlab's ode45, their 8(5,3),
//! and Verner's 9(8) for references. Takes a motion, a start, a tolerance and the distance of nodes;
//! gives the state at every node. A step of the method ends there, so that nothing is interpolated.

use crate::continuous::Motion;
use crate::handwritten::Unsolvable;
use differential_equations::methods::{Adaptive, DormandPrince, ExplicitRungeKutta, Ordinary};
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};

/// The equations as the library of methods wants them.
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

/// A method: how it is made for a tolerance.
pub trait Scheme<const N: usize>: OrdinaryNumericalMethod<f64, [f64; N]> {
    /// The method with this tolerance of the error of one step, absolute and relative, and this first step.
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

/// How finely a method works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Tolerance of the error of one step, absolute and relative.
    pub tolerance: f64,
    /// Longest step as a part of the distance of nodes, at most 1.
    pub part: f64,
}

impl Accuracy {
    /// A tolerance, and steps as long as nodes allow.
    pub const fn of(tolerance: f64) -> Self {
        Self {
            tolerance,
            part: 1.0,
        }
    }

    /// Rounding level, whatever the estimate of the error says: at least `pieces` steps a node.
    pub fn reference(pieces: u32) -> Self {
        Self {
            tolerance: 1e-15,
            part: 1.0 / f64::from(pieces.max(1)),
        }
    }
}

/// A motion that visits the nodes.
#[derive(Clone, Debug)]
pub struct RungeKutta<R, M, const N: usize> {
    method: R,
    equations: Equations<M>,
    h: f64,
    longest: f64,
}

impl<R: Scheme<N>, M: Motion<N>, const N: usize> RungeKutta<R, M, N> {
    /// Starts a motion whose nodes are `h` apart.
    ///
    /// # Errors
    /// [`Unsolvable`] when the start is not finite.
    pub fn start(
        motion: M,
        start: &[f64; N],
        h: f64,
        accuracy: Accuracy,
    ) -> Result<Self, Unsolvable> {
        let mut method = R::with(accuracy.tolerance, accuracy.part * h);
        let equations = Equations(motion);
        // The library asks for an end, and only to bound steps; nodes bound them here.
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

    /// Goes to the next node.
    ///
    /// # Errors
    /// [`Unsolvable`] when the tolerance cannot be met: the motion is not finite.
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        // Time is counted from the node: the sum of all steps would lose a digit in a thousand nodes,
        // and the equations do not contain it.
        let mut left = self.h;
        while left > 1e-10 * self.h {
            let wanted = self.method.h().abs().min(self.longest);
            // Two equal steps rather than a whole one and a splinter.
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
                // A step cut short says nothing against a longer one.
                if self.method.h() < wanted {
                    self.method.set_h(wanted);
                }
            }
        }
        Ok(())
    }

    /// The state at the present node.
    pub fn state(&self) -> &[f64; N] {
        self.method.y()
    }
}
