//! The torque-free rigid body, stepped explicitly.
//! Takes the body, the start and the step size; advances the attitude, keeps the body momentum.

use super::cayley::{Pencil, cross, dot, gyroscopic};
use super::kappa::kappa;
use super::{MoserVeselovError, Poinsot};
use crate::{BodyMomentum, Real, Rotation, SpatialMomentum};
use nalgebra::Vector3;

/// Steps between two projections. Rounding moves the invariants by about one ulp per step in
/// random directions, so eight ulps gather in between, at a sixty-fourth of the cost.
const PROJECT_EVERY: u32 = 64;

/// Squared sine of the angle between `u` and `adj(I) u` below which the energy is left alone: so
/// near to a principal axis (or with equal moments) it depends on `|u|` only, to second order in
/// the sine times the rounding error.
const DEGENERATE: f64 = 1e-6;

/// The constants and the momentum of one free trajectory.
///
/// `|mu|^2` and `mu . I^-1 mu` are exact invariants of the discrete motion, so `kappa` is a
/// constant and a step costs one division and one square root. Every 64 steps rounding is taken
/// out: the momentum goes back to its two quadrics, the attitude to where it maps the body
/// momentum on the spatial one.
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
    body: Poinsot<T>,
    pencil: Pencil<T>,
    /// The momentum `h mu / (2 unit)`.
    axes: [Axis<T>; 3],
    /// `|u|^2`; constant.
    square: T,
    /// `u . adj(I) u`; constant.
    energy: T,
    /// What turns `u` back into the momentum: `2 unit / h`.
    per_scale: T,
    until_projection: u32,
}

/// One component of the scaled momentum. Body and spatial components alternate in memory on
/// purpose: side by side, the body components are loaded in overlapping pairs, which the processor
/// cannot forward from the stores of the step before (a third of the cost of a step).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axis<T> {
    /// Body axes, at the current node.
    body: T,
    /// Spatial axes; constant.
    space: T,
}

impl<T: Real> Free<T> {
    /// Prepares a trajectory from the attitude, the spatial momentum and the step size `h` (of
    /// either sign, not zero).
    ///
    /// # Errors
    /// [`MoserVeselovError`], with the largest step size that would do, when the motion is too fast
    /// for `h` (in lanes of different `h`: said of the first). If it starts, every further step can
    /// be made.
    pub fn start(
        body: &Poinsot<T>,
        attitude: &Rotation<T>,
        momentum: &SpatialMomentum<T>,
        h: T,
    ) -> Result<Self, MoserVeselovError> {
        let h_m = momentum.0.map(|x| x * h);
        let spatial = body.scaled(&h_m);
        let h_mu = attitude.inverse_rotate(&h_m);
        let u = body.scaled(&h_mu);
        let square = dot(u, u);
        let energy = dot(u, body.adjugate_times::<false>(u));
        let Some(kappa) = kappa(body, square, energy) else {
            let error = MoserVeselovError::diagnose(body, &h_mu);
            return Err(error.with_linear_step(h.value()));
        };
        Ok(Self {
            body: *body,
            pencil: Pencil::new::<false>(body, kappa, square),
            axes: [0, 1, 2].map(|i| Axis {
                body: u[i],
                space: spatial[i],
            }),
            square,
            energy,
            per_scale: T::from_f64(2.0 * body.unit) / h,
            until_projection: PROJECT_EVERY,
        })
    }

    /// The body momentum at the current node.
    #[inline]
    pub fn body_momentum(&self) -> BodyMomentum<T> {
        let [x, y, z] = self.u().map(|x| x * self.per_scale);
        BodyMomentum(Vector3::new(x, y, z))
    }

    /// Advances the attitude, and the momentum kept inside, by one step.
    ///
    /// # Errors
    /// When a number has become NaN or infinite (the start allows none); the attitude and the
    /// momentum are then unchanged.
    #[inline]
    pub fn step(&mut self, attitude: &mut Rotation<T>) -> Result<(), MoserVeselovError> {
        let sound = if self.body.diagonal {
            self.advance::<true>(attitude)
        } else {
            self.advance::<false>(attitude)
        };
        if !sound {
            let nan = Vector3::repeat(T::from_f64(f64::NAN));
            return Err(MoserVeselovError::diagnose(&self.body, &nan));
        }
        self.until_projection -= 1;
        if self.until_projection == 0 {
            // The call gets a copy, so that the compiler may keep the original in registers.
            let copy = *self;
            let (u, aligned) = copy.projected(*attitude);
            for (axis, x) in self.axes.iter_mut().zip(u) {
                axis.body = x;
            }
            *attitude = aligned;
            self.until_projection = PROJECT_EVERY;
        }
        Ok(())
    }

    /// One bare step; false, and nothing changed, when a number is not finite.
    #[inline(always)]
    fn advance<const DIAGONAL: bool>(&mut self, attitude: &mut Rotation<T>) -> bool {
        let (det, n) = self.pencil.solve::<DIAGONAL>(&self.body, self.u());
        let [x, y, z] = n;
        let norm = (det * det + x * x) + (y * y + z * z);
        if !norm.is_finite() {
            return false;
        }
        let per_norm = T::one() / norm;
        let gyro = gyroscopic::<T, DIAGONAL>(&self.body, n);
        for (axis, push) in self.axes.iter_mut().zip(gyro) {
            axis.body += (push + push) * per_norm;
        }
        // The length of the old attitude is repaired on the way: its rounding errors have a common
        // sign where `norm` hardly varies, and would add up. Root and quotient run side by side.
        let scale = norm.sqrt() * (attitude.repair() * per_norm);
        let omega = Rotation::from_unit([det * scale, x * scale, y * scale, z * scale]);
        *attitude = attitude.compose_raw(&omega);
        true
    }

    /// The momentum and the attitude with their rounding errors taken out.
    #[inline(never)]
    fn projected(&self, attitude: Rotation<T>) -> ([T; 3], Rotation<T>) {
        let u = self.on_quadrics(self.u());
        (u, self.aligned(attitude, u))
    }

    /// `u`, body axes.
    #[inline(always)]
    fn u(&self) -> [T; 3] {
        let [x, y, z] = &self.axes;
        [x.body, y.body, z.body]
    }

    /// One Newton step for `|u|^2 = square`, `u . v = energy` with `v = adj(I) u`, along the two
    /// gradients `u` and `v`; along `u` alone where they are parallel.
    fn on_quadrics(&self, u: [T; 3]) -> [T; 3] {
        let (one, half) = (T::one(), T::from_f64(0.5));
        let v = self.body.adjugate_times::<false>(u);
        let (uu, uv, vv) = (dot(u, u), dot(u, v), dot(v, v));
        let (f, g) = (half * (self.square - uu), half * (self.energy - uv));
        let gram = uu * vv - uv * uv;
        let both = (gram - T::from_f64(DEGENERATE) * (uu * vv)).where_positive(one);
        let gram = both * gram + (one - both);
        let y = both * ((uu * g - uv * f) / gram);
        let moving = uu.where_positive(one);
        let x = moving * ((f - uv * y) / (uu + (one - moving)));
        [
            u[0] + (x * u[0] + y * v[0]),
            u[1] + (x * u[1] + y * v[1]),
            u[2] + (x * u[2] + y * v[2]),
        ]
    }

    /// Turns the attitude from the left by the small angle that takes the body momentum, seen from
    /// space, to the conserved spatial one. A body at rest is only normalised.
    fn aligned(&self, attitude: Rotation<T>, [x, y, z]: [T; 3]) -> Rotation<T> {
        let one = T::one();
        let attitude = Rotation::normalised(attitude.quaternion());
        let [[a, b, c]] = attitude.rotate(&Vector3::new(x, y, z)).data.0;
        let moving = self.square.where_positive(one);
        let half = moving * (T::from_f64(0.5) / (self.square + (one - moving)));
        let [p, q, r] = cross([a, b, c], self.axes.map(|axis| axis.space)).map(|x| x * half);
        Rotation::from_unit([one, p, q, r])
            .compose_raw(&attitude)
            .renormalised()
    }
}
