//! The torque-free rigid body, stepped explicitly.
//! Takes the body, the start and the step size; advances the attitude, keeps the body momentum.

mod by_name;
mod projection;
mod saved;

use super::cayley::{Orbit, Pencil, dot, gyroscopic, square_sum};
use super::compensation;
use super::kappa::kappa;
use super::phase::Phase;
use super::preprocess::preprocessed;
use super::principal::PrincipalAxes;
use super::{MoserVeselovError, Order, Poinsot};
use crate::solvers::Method;
use crate::{BodyMomentum, Real, Rotation, SpatialMomentum};
use nalgebra::{Matrix3, Vector3};

/// Steps between two projections. Rounding changes the invariants by about one ulp per step in random directions, so
/// about eight ulps accumulate in between, at a sixty-fourth of the cost.
const PROJECT_EVERY: u32 = 64;

/// Steps between two normalisations of the attitude: the rounding errors of the norm have the same sign in all steps,
/// and would accumulate until the projection.
const REPAIR_EVERY: u32 = 8;

/// Relative change of the energy, in roundings, up to which a new attitude belongs to the same
/// trajectory: several projections change it by that much.
const SAME_TRAJECTORY: f64 = 64.0;

/// Squared sine of the angle between `u` and `adj(I) u` below which the energy is not corrected. This close to a
/// principal axis (or with equal moments), the energy depends only on `|u|`, to second order in the sine times the
/// rounding error.
const DEGENERATE: f64 = 1e-6;

/// The rounding that a projection has removed, from the steps since the previous projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correction<T = f64> {
    /// Change of the body momentum, over its length.
    pub momentum: T,
    /// Angle that the attitude was turned by, in radians.
    pub attitude: T,
}

/// The constants and the momentum of one free trajectory.
///
/// `|mu|^2` and `mu . I^-1 mu` are exact invariants of the discrete motion, so `kappa` is a constant and a step costs
/// one division and one square root. Every 64 steps a projection removes rounding: it moves the momentum back to its
/// two quadrics, and rotates the attitude so that it maps the body momentum to the spatial momentum.
///
/// The solver works in principal axes, so that every body costs the same as a diagonal one. Types
/// with derivatives use the given axes, since a principal frame is not differentiable if two moments
/// agree.
///
/// ```
/// use clebsch::nalgebra::{Matrix3, Vector3};
/// use clebsch::solvers::moser_veselov::Free;
/// use clebsch::{Poinsot, Rotation, SpatialMomentum};
///
/// let body = Poinsot::from_inertia(&Matrix3::from_diagonal(&Vector3::new(3.5, 2.5, 2.0)))?;
/// let mut attitude = Rotation::identity();
/// let momentum = SpatialMomentum(Vector3::new(-0.5, 0.0, 1.0));
/// let mut free = Free::start(&body, &attitude, &momentum, 0.1)?;
/// for _ in 0..1000 {
///     free.step(&mut attitude)?;
/// }
/// let seen_from_space = free.body_momentum().to_space(&attitude);
/// assert!((seen_from_space.0 - momentum.0).norm() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Free<T = f64> {
    /// The momentum `h mu / (2 unit)`.
    axes: [Axis<T>; 3],
    /// The constants for plain numbers, in principal axes.
    orbit: Orbit<T>,
    /// The constants for numbers with derivatives, in the given axes.
    pencil: Pencil<T>,
    /// The body in the solver's axes, with the moments modified for the order.
    body: Poinsot<T>,
    /// Maps components in the solver's axes to components in the given axes.
    frame: Matrix3<T>,
    /// Whether the two frames differ.
    turned: bool,
    until_projection: u32,
    /// Whether the projection is enabled.
    projects: bool,
    /// The compensating rotation about the momentum, if requested, and the steps until the next projection. The
    /// projection code applies the rotation after every step, so that steps without it cost nothing.
    compensation: Option<(Rotation<T>, u32)>,
    /// The squares of the last [`Correction`].
    corrected: [T; 2],
    /// The attitude at the end of the last step. If the given attitude differs, the user has set it.
    attitude: Rotation<T>,
    momentum: SpatialMomentum<T>,
    h: T,
    order: Order,
    /// The solver of a step; all solvers but `kappa` ignore the constants.
    method: Method,
    /// The body in the given axes.
    given: Poinsot<T>,
    /// `|u|^2`; constant.
    square: T,
    /// The inverse of `|u|^2`; 0 for a body at rest.
    per_square: T,
    /// `u . adj(I) u`; constant.
    energy: T,
    /// The factor from `u` to the momentum: `2 unit / h`.
    per_scale: T,
    /// The representation for many plain steps at once.
    phase: Phase<T>,
}

/// One component of the scaled momentum. Body and spatial components alternate in memory on
/// purpose: side by side, the body components are loaded in overlapping pairs, which the processor
/// cannot forward from the stores of the step before (a third of the cost of a step).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axis<T> {
    /// Principal axes, at the current node.
    body: T,
    /// Spatial axes; constant.
    space: T,
}

crate::saved!([] Axis { body, space });

impl<T: Real> Free<T> {
    /// Prepares a trajectory from the attitude, the spatial momentum and the step size `h` (of
    /// either sign, not zero). The steps have order two and are symplectic.
    ///
    /// # Errors
    /// [`MoserVeselovError`], with the largest step size that succeeds, if the motion is too fast
    /// for `h`. If it starts, every further step can be made.
    pub fn start(
        body: &Poinsot<T>,
        attitude: &Rotation<T>,
        momentum: &SpatialMomentum<T>,
        h: T,
    ) -> Result<Self, MoserVeselovError> {
        Self::start_of_order(body, attitude, momentum, h, Order::Two)
    }

    /// Like [`Free::start`], for steps of the given order. The moments are modified once, so a step costs the same at
    /// every order.
    ///
    /// Above order two the map of the momentum is Poisson, and energy, `|mu|^2` and spatial momentum are as exact as at
    /// order two. The joint map of momentum and attitude is not symplectic: the defect has the size of the step's
    /// error. [`Free::compensated`] removes it.
    ///
    /// # Errors
    /// The errors of [`Free::start`]; the largest step size is then found by bisection.
    pub fn start_of_order(
        body: &Poinsot<T>,
        attitude: &Rotation<T>,
        momentum: &SpatialMomentum<T>,
        h: T,
        order: Order,
    ) -> Result<Self, MoserVeselovError> {
        let h_m = momentum.0.map(|x| x * h);
        let spatial = body.scaled(&h_m);
        let h_mu = attitude.inverse_rotate(&h_m);
        let (given, frame) = (*body, principal_frame(body));
        let body = match &frame {
            Some(axes) => body.in_principal_axes(axes.moments),
            None => given,
        };
        let turned = frame.filter(|axes| axes.frame != Rotation::identity());
        let rotation = turned.as_ref().map(|axes| axes.frame);
        let turned = turned.map(|axes| axes.frame.matrix());
        let frame = turned.unwrap_or_else(Matrix3::identity);
        let u = body.scaled(&frame.tr_mul(&h_mu));
        let refused = || match order {
            Order::Two => MoserVeselovError::diagnose(&given, &h_mu).with_linear_step(h),
            _ => MoserVeselovError::diagnose_order(&given, &h_mu, h, order),
        };
        let Some(body) = preprocessed(&body, u, order) else {
            return Err(refused());
        };
        let square = dot(u, u);
        let moving = square.where_positive(T::one());
        let energy = dot(u, body.adjugate_times::<false>(u));
        let products = [u[1] * u[2], u[2] * u[0], u[0] * u[1]];
        let squares = u.map(|x| x * x);
        let kappa = kappa(
            &body,
            square,
            body.energy.value::<false>(squares, products),
            body.deviation.value::<false>(squares, products),
        );
        let Some(kappa) = kappa else {
            return Err(refused());
        };
        let pencil = Pencil::new(&body, kappa, square);
        Ok(Self {
            axes: [0, 1, 2].map(|i| Axis {
                body: u[i],
                space: spatial[i],
            }),
            orbit: Orbit::new(&body, &pencil, u),
            pencil,
            body,
            frame,
            turned: turned.is_some(),
            until_projection: PROJECT_EVERY,
            projects: true,
            compensation: None,
            corrected: [T::zero(); 2],
            attitude: *attitude,
            momentum: *momentum,
            h,
            order,
            method: Method::Kappa,
            given,
            square,
            per_square: moving / (square + (T::one() - moving)),
            energy,
            per_scale: T::from_f64(2.0 * body.unit) / h,
            phase: Phase::new(rotation.unwrap_or_else(Rotation::identity), square, kappa),
        })
    }

    /// The body momentum at the current node.
    #[inline]
    pub fn body_momentum(&self) -> BodyMomentum<T> {
        BodyMomentum(self.frame * Vector3::from(self.u().map(|x| x * self.per_scale)))
    }

    /// The order of the steps.
    #[inline]
    pub fn order(&self) -> Order {
        self.order
    }

    /// The correction of the last projection; zero before the first projection, at step 64.
    #[must_use]
    pub fn correction(&self) -> Correction<T> {
        let [momentum, attitude] = self.corrected.map(T::sqrt);
        Correction { momentum, attitude }
    }

    /// This trajectory without projection: rounding errors accumulate, so that you can measure them. The
    /// quaternion of the attitude is still normalised.
    #[must_use]
    pub fn without_projection(self) -> Self {
        Self {
            projects: false,
            ..self
        }
    }

    /// This trajectory with compensated steps: each step is followed by a constant rotation about the
    /// spatial momentum. For orders four, six and eight this makes the map of momentum and attitude
    /// symplectic up to the error of a step of order ten. The rotation is as small as the error of a
    /// step, so that order, energy and momentum are unchanged. Steps of order two need no
    /// compensation; for order ten no compensation is known.
    #[must_use]
    pub fn compensated(mut self) -> Self {
        if !matches!(self.order, Order::Two | Order::Ten) {
            let h_mu = self.body_momentum().0.map(|x| x * self.h);
            let factor = compensation::factor(&self.given, self.given.scaled(&h_mu), self.order);
            let half = self.axes.map(|axis| axis.space * factor);
            self.compensation = Some((compensation::rotation(half), PROJECT_EVERY));
            self.count_anew();
        }
        self
    }

    /// Like [`Free::step`], for a state that may have been replaced: the step starts from the given attitude and
    /// momentum.
    ///
    /// # Errors
    /// The errors of [`Free::start`] after a replacement, otherwise of [`Free::step`]. The state is then unchanged.
    #[inline]
    pub fn follow(
        &mut self,
        attitude: &mut Rotation<T>,
        momentum: &SpatialMomentum<T>,
    ) -> Result<(), MoserVeselovError> {
        if *attitude != self.attitude || *momentum != self.momentum {
            return self.elsewhere(attitude, momentum);
        }
        self.step_on(attitude)
    }

    /// Advances the attitude and the stored momentum by one step.
    ///
    /// # Errors
    /// If a number becomes NaN or infinite (the start rejects such numbers); the attitude and the momentum are then
    /// unchanged.
    #[inline]
    pub fn step(&mut self, attitude: &mut Rotation<T>) -> Result<(), MoserVeselovError> {
        let momentum = self.momentum;
        self.follow(attitude, &momentum)
    }

    /// Restarts with another body, and the same step size and order.
    ///
    /// # Errors
    /// The errors of [`Free::start_of_order`]; nothing is changed.
    #[cold]
    #[inline(never)]
    pub fn restart_as(
        &mut self,
        body: &Poinsot<T>,
        attitude: &Rotation<T>,
        momentum: &SpatialMomentum<T>,
    ) -> Result<(), MoserVeselovError> {
        let started = Self::start_of_order(body, attitude, momentum, self.h, self.order)?;
        let started = match self.compensation {
            Some(_) => started.compensated(),
            None => started,
        };
        *self = Self {
            projects: self.projects,
            ..started.solved_by(self.method)
        };
        Ok(())
    }

    /// Continues from a state that was changed from outside. Compositions do so in every step. On the
    /// same trajectory the constants are unchanged, and only the position on it is new.
    #[inline(never)]
    fn rejoin(
        &mut self,
        attitude: &Rotation<T>,
        momentum: &SpatialMomentum<T>,
    ) -> Result<(), MoserVeselovError> {
        if *momentum == self.momentum {
            let space = Vector3::from(self.axes.map(|axis| axis.space));
            let [u] = self.frame.tr_mul(&attitude.inverse_rotate(&space)).data.0;
            let energy = dot(u, self.energy_gradient(u));
            let change = (energy - self.energy) / self.energy;
            // False for NaN, which occurs for a body at rest.
            if change.magnitude() <= SAME_TRAJECTORY * T::EPSILON {
                for (axis, x) in self.axes.iter_mut().zip(u) {
                    axis.body = x;
                }
                // As at a start, so the next steps do not depend on how many steps preceded them.
                self.count_anew();
                self.phase.lost();
                return Ok(());
            }
        }
        self.restart(attitude, momentum)
    }

    /// `adj(I) u`, half the gradient of the energy.
    #[inline(always)]
    fn energy_gradient(&self, u: [T; 3]) -> [T; 3] {
        if plain::<T>() {
            self.body.adjugate_times::<true>(u)
        } else {
            self.body.adjugate_times::<false>(u)
        }
    }

    /// A step from a state that another function has set, or a step with another solver, which always starts from the state.
    #[cold]
    #[inline(never)]
    fn elsewhere(
        &mut self,
        attitude: &mut Rotation<T>,
        momentum: &SpatialMomentum<T>,
    ) -> Result<(), MoserVeselovError> {
        if self.method != Method::Kappa {
            return self.step_by(attitude, momentum);
        }
        self.rejoin(attitude, momentum)?;
        self.step_on(attitude)
    }

    #[cold]
    #[inline(never)]
    fn restart(
        &mut self,
        attitude: &Rotation<T>,
        momentum: &SpatialMomentum<T>,
    ) -> Result<(), MoserVeselovError> {
        let body = self.given;
        self.restart_as(&body, attitude, momentum)
    }

    #[inline(always)]
    fn step_on(&mut self, attitude: &mut Rotation<T>) -> Result<(), MoserVeselovError> {
        if !self.advance(attitude) {
            return Err(self.not_finite());
        }
        self.phase.lost();
        self.until_projection -= 1;
        if self.until_projection == 0 {
            self.settle(attitude);
        }
        self.attitude = *attitude;
        Ok(())
    }

    /// One step without the projection. If a number is not finite, returns false and changes nothing.
    #[inline(always)]
    fn advance(&mut self, attitude: &mut Rotation<T>) -> bool {
        let repairs = self.until_projection.is_multiple_of(REPAIR_EVERY);
        let (u, quaternion, norm) = self.moved(self.u(), attitude, repairs);
        if !norm.is_finite() {
            return false;
        }
        for (axis, x) in self.axes.iter_mut().zip(u) {
            axis.body = x;
        }
        *attitude = quaternion;
        true
    }

    /// The next `u` and attitude, and a number that is finite if and only if they are.
    #[inline(always)]
    fn moved(&self, u: [T; 3], attitude: &Rotation<T>, repairs: bool) -> ([T; 3], Rotation<T>, T) {
        let (det, n) = if plain::<T>() {
            self.orbit.solve(&self.body, u)
        } else {
            self.pencil.solve(&self.body, u)
        };
        let norm = square_sum(det, n);
        let per_norm = T::one() / norm;
        let [p, q, r] = if plain::<T>() {
            self.orbit.push(n)
        } else {
            gyroscopic::<T, false>(&self.body, n).map(|x| x + x)
        };
        let pushed = [
            u[0] + p * per_norm,
            u[1] + q * per_norm,
            u[2] + r * per_norm,
        ];
        let [x, y, z] = if self.turned {
            let [given] = (self.frame * Vector3::from(n)).data.0;
            given
        } else {
            n
        };
        // The product of the quaternions does not wait for the root, only its length does.
        let mut scale = per_norm.sqrt();
        if repairs {
            scale *= attitude.repair();
        }
        let turned = attitude.compose_raw(&Rotation::from_unit([det, x, y, z]));
        (pushed, turned.scaled(scale), norm)
    }

    /// Takes `count` steps at once, with the same result as single steps up to rounding. The attitude is computed at
    /// the end, from one angle. With lanes, the numbers then stay in registers.
    ///
    /// The result does not depend on how many steps one call takes, not even in rounding.
    ///
    /// # Errors
    /// The errors of [`Free::follow`]; nothing is changed.
    #[inline(always)]
    pub fn follow_many(
        &mut self,
        attitude: &mut Rotation<T>,
        momentum: &SpatialMomentum<T>,
        count: u64,
    ) -> Result<(), MoserVeselovError> {
        if self.method != Method::Kappa {
            let (mut solver, mut moving) = (*self, *attitude);
            for _ in 0..count {
                solver.step_by(&mut moving, momentum)?;
            }
            (*self, *attitude) = (solver, moving);
            return Ok(());
        }
        if *attitude != self.attitude || *momentum != self.momentum {
            self.rejoin(attitude, momentum)?;
            self.attitude = *attitude;
        }
        if !plain::<T>() || self.compensation.is_some() {
            return self.step_many(attitude, count);
        }
        let mut phase = self.phase;
        let body = (&self.body, &self.pencil, &self.orbit);
        let (path, mut moving) = phase.taken_up(body, attitude, self.u());
        let (mut left, mut until_projection) = (count, self.until_projection);
        let (mut norm, mut corrected) = (T::one(), self.corrected);
        while left > 0 {
            let until_repair = match until_projection % REPAIR_EVERY {
                0 => REPAIR_EVERY,
                n => n,
            };
            let steps = left.min(u64::from(until_repair));
            for _ in 0..steps {
                (moving, norm) = path.step(&moving);
            }
            left -= steps;
            // At most `REPAIR_EVERY` steps.
            until_projection -= steps as u32;
            if until_projection.is_multiple_of(REPAIR_EVERY) {
                moving.repair();
            }
            if until_projection == 0 {
                if self.projects {
                    let before = phase.solver_axes(moving.u);
                    let u = self.on_quadrics(before);
                    moving.u = phase.relabelled(u);
                    // The attitude rotates with the momentum.
                    corrected = [self.relative_change(before, u); 2];
                }
                until_projection = PROJECT_EVERY;
            }
        }
        // NaN and infinity persist, so one test is enough.
        if !norm.is_finite() {
            return Err(self.not_finite());
        }
        if count > 0 {
            *attitude = phase.left_at(&moving);
        }
        for (axis, x) in self.axes.iter_mut().zip(phase.solver_axes(moving.u)) {
            axis.body = x;
        }
        self.attitude = *attitude;
        self.until_projection = until_projection;
        self.corrected = corrected;
        self.phase = phase;
        Ok(())
    }

    /// Takes the steps one by one: for numbers with derivatives, and for steps that are each followed by a rotation.
    fn step_many(
        &mut self,
        attitude: &mut Rotation<T>,
        count: u64,
    ) -> Result<(), MoserVeselovError> {
        let (mut solver, mut moving) = (*self, *attitude);
        for _ in 0..count {
            solver.step_on(&mut moving)?;
        }
        (*self, *attitude) = (solver, moving);
        Ok(())
    }

    #[cold]
    #[inline(never)]
    fn not_finite(&self) -> MoserVeselovError {
        let nan = Vector3::repeat(T::from_f64(f64::NAN));
        MoserVeselovError::diagnose(&self.given, &nan)
    }

    /// Resets the counters of steps until the next projection; with compensation, each step is followed by a rotation.
    fn count_anew(&mut self) {
        self.until_projection = PROJECT_EVERY;
        if let Some((_, left)) = &mut self.compensation {
            *left = PROJECT_EVERY;
            self.until_projection = 1;
        }
    }

    /// The operations outside the fast path: the projection, and a compensating rotation.
    #[cold]
    #[inline(never)]
    fn settle(&mut self, attitude: &mut Rotation<T>) {
        if let Some((turn, left)) = &mut self.compensation {
            *attitude = turn.compose_raw(attitude).renormalised();
            *left -= 1;
            if *left > 0 {
                self.until_projection = 1;
                return;
            }
        }
        self.project(attitude);
        self.count_anew();
    }

    /// `u`, in the solver's axes.
    #[inline(always)]
    fn u(&self) -> [T; 3] {
        let [x, y, z] = &self.axes;
        [x.body, y.body, z.body]
    }
}

/// Whether the scalar type is without derivatives.
#[inline(always)]
fn plain<T: Real>() -> bool {
    T::order() == 0
}

/// The principal axes, if they are used.
fn principal_frame<T: Real>(body: &Poinsot<T>) -> Option<PrincipalAxes<T>> {
    plain::<T>().then(|| PrincipalAxes::of(body))
}
