//! Splitting of the free body's Hamiltonian into three rotations about principal axes (McLachlan, Phys. Rev. Lett. 71, 1993; Reich
//! 1994): plain and optimised second order, and fourth order by Suzuki's composition. The motions conserve |momentum| and the
//! spatial momentum to rounding, and the energy within O(h^2) or O(h^4). The steps are explicit and never fail.

use super::{BodyMotion, Start};
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{Quaternion, Vector};
use crate::handwritten::principal_axes::PrincipalAxes;

/// Attitude and body momentum in principal axes.
#[derive(Clone, Copy, Debug)]
struct Phase {
    q: Quaternion,
    mu: Vector,
}

/// Sine and cosine of half the angle of a rotation.
type Half = (f64, f64);

impl Phase {
    /// The rotation of the body about axis `AXIS`, which preserves the spatial momentum.
    #[inline(always)]
    fn turn<const AXIS: usize>(&mut self, (s, c): Half) {
        let (j, k) = ((AXIS + 1) % 3, (AXIS + 2) % 3);
        let (sine, cosine) = (2.0 * (s * c), 1.0 - 2.0 * (s * s));
        let (x, y) = (self.mu[j], self.mu[k]);
        self.mu[j] = cosine * x + sine * y;
        self.mu[k] = cosine * y - sine * x;
        let q = self.q.0;
        let (w, a, b, d) = (q[0], q[AXIS + 1], q[j + 1], q[k + 1]);
        self.q.0[0] = w * c - a * s;
        self.q.0[AXIS + 1] = a * c + w * s;
        self.q.0[j + 1] = b * c + d * s;
        self.q.0[k + 1] = d * c - b * s;
    }
}

/// The exact half angle, with one call of the math library.
#[inline(always)]
fn trigonometric(angle: f64) -> Half {
    (0.5 * angle).sin_cos()
}

/// A rational approximation with one division. The tangent of a quarter of the angle is correct to first order. Any odd function of
/// the angle keeps the step a composition of exact Poisson flows, so the order remains two.
#[inline(always)]
fn rational(angle: f64) -> Half {
    let quarter = 0.25 * angle;
    let square = quarter * quarter;
    let inverse = 1.0 / (1.0 + square);
    ((quarter + quarter) * inverse, (1.0 - square) * inverse)
}

/// Two half rotations in sequence.
#[inline(always)]
fn doubled((s, c): Half) -> Half {
    (2.0 * (s * c), 1.0 - 2.0 * (s * s))
}

/// Initial data in principal axes, and the rate h / I_i of each angle.
fn enter(start: &Start) -> Result<(Phase, Vector, PrincipalAxes), Unsolvable> {
    let axes = PrincipalAxes::new(&start.poinsot)?;
    let phase = Phase {
        q: axes.enter_attitude(&start.attitude),
        mu: axes.enter(&start.body_momentum),
    };
    Ok((phase, axes.moments.map(|i| start.h / i), axes))
}

/// Rotations by h/2, h/2, h, h/2, h/2 about axes 1, 2, 3, 2, 1, each with its own sine and cosine.
#[inline(always)]
fn strang(phase: &mut Phase, rates: &Vector) {
    phase.turn::<0>(trigonometric(0.5 * (rates[0] * phase.mu[0])));
    phase.turn::<1>(trigonometric(0.5 * (rates[1] * phase.mu[1])));
    phase.turn::<2>(trigonometric(rates[2] * phase.mu[2]));
    phase.turn::<1>(trigonometric(0.5 * (rates[1] * phase.mu[1])));
    phase.turn::<0>(trigonometric(0.5 * (rates[0] * phase.mu[0])));
}

/// Second order: five rotations per step.
#[derive(Clone, Copy, Debug)]
pub struct Splitting {
    phase: Phase,
    rates: Vector,
    axes: PrincipalAxes,
}

impl Splitting {
    /// Starts a motion.
    ///
    /// # Errors
    /// [`Unsolvable`] if the matrix is not admissible for a rigid body.
    pub fn start(start: &Start) -> Result<Self, Unsolvable> {
        let (phase, rates, axes) = enter(start)?;
        Ok(Self { phase, rates, axes })
    }
}

impl BodyMotion for Splitting {
    #[inline(always)]
    fn step(&mut self) -> Result<(), Unsolvable> {
        strang(&mut self.phase, &self.rates);
        Ok(())
    }

    fn attitude(&self) -> Quaternion {
        self.axes.leave_attitude(&self.phase.q.normalised())
    }

    fn body_momentum(&self) -> Vector {
        self.axes.leave(&self.phase.mu)
    }
}

/// Second order, optimised: rational angles, and the last rotation of a step merged with the first of the next step, which leaves
/// four per step.
#[derive(Clone, Copy, Debug)]
pub struct MergedSplitting {
    /// The state after the first half rotation of the next step.
    ahead: Phase,
    rates: Vector,
    axes: PrincipalAxes,
}

impl MergedSplitting {
    /// Starts a motion.
    ///
    /// # Errors
    /// [`Unsolvable`] if the matrix is not admissible for a rigid body.
    pub fn start(start: &Start) -> Result<Self, Unsolvable> {
        let (mut ahead, rates, axes) = enter(start)?;
        ahead.turn::<0>(rational(0.5 * (rates[0] * ahead.mu[0])));
        Ok(Self { ahead, rates, axes })
    }

    /// The state at the node, with the half rotation undone. The momentum component about its axis is the same before and after, so
    /// that only rounding is lost.
    fn node(&self) -> Phase {
        let mut phase = self.ahead;
        phase.turn::<0>(rational(-0.5 * (self.rates[0] * phase.mu[0])));
        phase
    }
}

impl BodyMotion for MergedSplitting {
    #[inline(always)]
    fn step(&mut self) -> Result<(), Unsolvable> {
        let (phase, rates) = (&mut self.ahead, &self.rates);
        phase.turn::<1>(rational(0.5 * (rates[1] * phase.mu[1])));
        phase.turn::<2>(rational(rates[2] * phase.mu[2]));
        phase.turn::<1>(rational(0.5 * (rates[1] * phase.mu[1])));
        phase.turn::<0>(doubled(rational(0.5 * (rates[0] * phase.mu[0]))));
        Ok(())
    }

    fn attitude(&self) -> Quaternion {
        self.axes.leave_attitude(&self.node().q.normalised())
    }

    fn body_momentum(&self) -> Vector {
        self.axes.leave(&self.node().mu)
    }
}

/// Fourth order: five second-order steps of sizes p h, p h, (1 - 4p) h, p h, p h with p = 1/(4 - 4^(1/3)) (Suzuki, Phys. Lett. A
/// 146, 1990).
#[derive(Clone, Copy, Debug)]
pub struct FourthOrderSplitting {
    phase: Phase,
    outer: Vector,
    middle: Vector,
    axes: PrincipalAxes,
}

impl FourthOrderSplitting {
    /// Starts a motion.
    ///
    /// # Errors
    /// [`Unsolvable`] if the matrix is not admissible for a rigid body.
    pub fn start(start: &Start) -> Result<Self, Unsolvable> {
        let (phase, rates, axes) = enter(start)?;
        let part = 1.0 / (4.0 - 4.0_f64.cbrt());
        Ok(Self {
            phase,
            outer: rates.map(|r| part * r),
            middle: rates.map(|r| (1.0 - 4.0 * part) * r),
            axes,
        })
    }
}

impl BodyMotion for FourthOrderSplitting {
    #[inline(always)]
    fn step(&mut self) -> Result<(), Unsolvable> {
        for rates in [self.outer, self.outer, self.middle, self.outer, self.outer] {
            strang(&mut self.phase, &rates);
        }
        Ok(())
    }

    fn attitude(&self) -> Quaternion {
        self.axes.leave_attitude(&self.phase.q.normalised())
    }

    fn body_momentum(&self) -> Vector {
        self.axes.leave(&self.phase.mu)
    }
}
