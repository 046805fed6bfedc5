//! The continuous motion of a free rigid body in closed form: Jacobi's elliptic functions for the body momentum, and an elliptic
//! integral of the third kind for the angle about the spatial momentum (Whittaker, Analytical Dynamics, section 69; Landau and
//! Lifshitz, Mechanics, section 37). Gives attitude and momentum at any time. The only error is rounding: a few 1e-16 times the
//! number of radians of rotation.

use super::{BodyMotion, Start};
use crate::elliptic::{complete, incomplete, jacobi, third_kind};
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{Quaternion, Vector, apply_transposed, dot};
use crate::handwritten::principal_axes::PrincipalAxes;

/// The motion as a function of time.
#[derive(Clone, Copy, Debug)]
pub struct Exact {
    axes: PrincipalAxes,
    /// Rotation from the frame of the formulas to principal axes. In the frame of the formulas, the momentum circles about the
    /// third axis.
    order: Quaternion,
    course: Course,
    start: Frame,
    h: f64,
    node: u64,
    here: (Quaternion, Vector),
}

/// The motion of the momentum in the frame of the formulas.
#[derive(Clone, Copy, Debug)]
enum Course {
    /// Rotation about a principal axis, or a body with three equal moments; the value is the body angular velocity.
    Steady(Vector),
    /// mu = (A1 cn, A2 sn, A3 dn)(rate t + phase), with k < 1.
    Periodic(Periodic),
    /// The limit k = 1: mu = (A1 sech, A2 tanh, A3 sech), the motion between the two unstable rotations.
    Separatrix(Periodic),
}

#[derive(Clone, Copy, Debug)]
struct Periodic {
    amplitudes: Vector,
    rate: f64,
    /// Argument of the elliptic functions at time 0.
    phase: f64,
    /// 1 - k^2.
    m1: f64,
    quarter: f64,
    /// 1/I_3 and 1/I_1 - 1/I_3.
    third: f64,
    spread: f64,
    /// 1 - n of the integral of the third kind: (A2/A1)^2.
    rest: f64,
    /// The integral at `phase`, and over a quarter period.
    integral: f64,
    quarter_integral: f64,
    norm: f64,
}

/// Orthonormal frame attached to the momentum, and the attitude at time 0 relative to it.
#[derive(Clone, Copy, Debug)]
struct Frame {
    /// Attitude of the frame of the formulas at time 0.
    attitude: Quaternion,
    /// Body momentum at time 0, in the frame of the formulas.
    mu: Vector,
}

impl Exact {
    /// The motion from `start`; its `h` is the node distance of [`BodyMotion::step`].
    ///
    /// # Errors
    /// [`Unsolvable`] if the matrix is not admissible for a rigid body.
    pub fn start(start: &Start) -> Result<Self, Unsolvable> {
        let axes = PrincipalAxes::new(&start.poinsot)?;
        let mut moments = axes.moments;
        let mut order = Quaternion::IDENTITY;
        let mut mu = axes.enter(&start.body_momentum);
        // The momentum circles about axis 3 if |mu|^2 - 2 E I_2 has the sign of I_3 - I_2. Written in the deciding components, so
        // that nothing cancels.
        let about = |axis: usize| mu[axis] * mu[axis] * (1.0 - moments[1] / moments[axis]).abs();
        if about(0) > about(2) {
            // A quarter turn about the middle axis: (x, y, z) -> (-z, y, x).
            let half = std::f64::consts::FRAC_1_SQRT_2;
            order = Quaternion([half, 0.0, half, 0.0]);
            mu = apply_transposed(&order.matrix(), &mu);
            moments = [moments[2], moments[1], moments[0]];
        }
        let attitude = axes.enter_attitude(&start.attitude).times(&order);
        Ok(Self {
            axes,
            order,
            course: Course::new(&moments, &mu),
            start: Frame { attitude, mu },
            h: start.h,
            node: 0,
            here: (start.attitude, start.body_momentum),
        })
    }

    /// Attitude body -> space and body momentum at a time.
    pub fn at(&self, time: f64) -> (Quaternion, Vector) {
        let (q, mu) = match &self.course {
            Course::Steady(rate) => {
                let speed = dot(rate, rate).sqrt();
                let (s, c) = (0.5 * speed * time).sin_cos();
                let s = if speed > 0.0 { s / speed } else { 0.0 };
                let turn = Quaternion([c, s * rate[0], s * rate[1], s * rate[2]]);
                (self.start.attitude.times(&turn), self.start.mu)
            }
            Course::Periodic(motion) => {
                let (mu, angle) = motion.at(time);
                (self.start.carried(&mu, angle, motion.norm), mu)
            }
            Course::Separatrix(motion) => {
                let (mu, angle) = motion.at_separatrix(time);
                (self.start.carried(&mu, angle, motion.norm), mu)
            }
        };
        let to_principal = self.order.conjugate();
        let attitude = self.axes.leave_attitude(&q.times(&to_principal));
        let mu = apply_transposed(&to_principal.matrix(), &mu);
        (attitude, self.axes.leave(&mu))
    }
}

impl Course {
    /// For moments with I_2 between the others, and a momentum that circles about axis 3.
    fn new(moments: &Vector, mu: &Vector) -> Self {
        let r = moments.map(|i| 1.0 / i);
        let steady = Self::Steady([r[0] * mu[0], r[1] * mu[1], r[2] * mu[2]]);
        // Coefficients of Euler's equations mu_1' = a_1 mu_2 mu_3 and cyclic; they sum to zero.
        let a = [r[2] - r[1], r[0] - r[2], r[1] - r[0]];
        let squares = mu.map(|c| c * c);
        let first = squares[0] + squares[1] * (a[0] / -a[1]);
        // Steady for three equal moments, or if only the third component is nonzero.
        let turning = first > 0.0 && a[0] != 0.0;
        if !turning || !first.is_finite() {
            return steady;
        }
        let rest = -a[1] / a[0];
        let third = squares[2] + squares[1] * (a[2] / -a[1]);
        // Signs for which the argument starts within a quarter period of 0.
        let amplitude_1 = first.sqrt().copysign(mu[0]);
        let amplitude_3 = third.sqrt().copysign(mu[2]);
        let amplitude_2 = (rest * first)
            .sqrt()
            .copysign(a[1] * amplitude_1 * amplitude_3);
        let rate = third.sqrt() * (-a[0] * a[1]).sqrt();
        // 1 - k^2 without the cancellation in k^2 = a_3 A_1^2 / (a_1 A_3^2).
        let m1 = (squares[2] - squares[0] * (a[2] / a[0])) / third;
        let (sine, cosine) = (mu[1] / amplitude_2, mu[0] / amplitude_1);
        // Rotation about the middle axis: unstable, but steady.
        if squares[0] + squares[2] == 0.0 {
            return steady;
        }
        let mut motion = Periodic {
            amplitudes: [amplitude_1, amplitude_2, amplitude_3],
            rate,
            phase: 0.0,
            m1,
            quarter: 0.0,
            third: r[2],
            spread: a[1],
            rest,
            integral: 0.0,
            quarter_integral: 0.0,
            norm: dot(mu, mu).sqrt(),
        };
        if m1 <= 0.0 {
            motion.phase = sine.clamp(-1.0, 1.0).atanh();
            motion.integral = motion.separatrix_integral(motion.phase);
            return Self::Separatrix(motion);
        }
        motion.quarter = complete(m1);
        motion.quarter_integral = third_kind(rest, 1.0, 0.0, m1);
        let (sine, cosine) = (sine / sine.hypot(cosine), cosine / sine.hypot(cosine));
        motion.phase = incomplete(sine, cosine, m1);
        motion.integral = motion.integral(motion.phase);
        Self::Periodic(motion)
    }
}

impl Periodic {
    /// u = 2 j K + r with |r| <= K.
    fn reduced(&self, u: f64) -> (f64, f64) {
        let half = 2.0 * self.quarter;
        let turns = (u / half).round();
        (turns, u - turns * half)
    }

    /// The integral of the third kind from 0 to u.
    fn integral(&self, u: f64) -> f64 {
        let (turns, r) = self.reduced(u);
        let [sn, cn, _] = jacobi(r, self.m1);
        2.0 * turns * self.quarter_integral + third_kind(self.rest, sn, cn.max(0.0), self.m1)
    }

    /// Body momentum, and the rotation angle about the spatial momentum since time 0.
    fn at(&self, time: f64) -> (Vector, f64) {
        let u = self.rate * time + self.phase;
        let (turns, r) = self.reduced(u);
        let [sn, cn, dn] = jacobi(r, self.m1);
        let sign = if turns.rem_euclid(2.0) == 0.0 {
            1.0
        } else {
            -1.0
        };
        let [x, y, z] = self.amplitudes;
        let mu = [x * (sign * cn), y * (sign * sn), z * dn];
        (mu, self.angle(time, self.integral(u)))
    }

    fn angle(&self, time: f64, integral: f64) -> f64 {
        let gone = self.spread * (integral - self.integral) / self.rate;
        self.norm * (time * self.third + gone)
    }

    /// For k = 1: int du / (1 - n tanh^2 u) = (u - n/s (artanh or arctan)(s tanh u)) / (1 - n), n < 0.
    fn separatrix_integral(&self, u: f64) -> f64 {
        let n = 1.0 - self.rest;
        let tanh = u.tanh();
        let tail = if n < 0.0 {
            let s = (-n).sqrt();
            s * (s * tanh).atan()
        } else {
            let s = n.sqrt();
            -s * (s * tanh).atanh()
        };
        (u + tail) / self.rest
    }

    fn at_separatrix(&self, time: f64) -> (Vector, f64) {
        let u = self.rate * time + self.phase;
        let sech = 1.0 / u.cosh();
        let [x, y, z] = self.amplitudes;
        let mu = [x * sech, y * u.tanh(), z * sech];
        (mu, self.angle(time, self.separatrix_integral(u)))
    }
}

impl Frame {
    /// The attitude for which the momentum `mu` has the same spatial direction as at time 0, after a rotation by `angle` about it.
    /// Both momenta use frames whose third axis is the momentum and whose first axis is horizontal, normal to axis 3 of the body.
    /// This replaces Euler angles.
    fn carried(&self, mu: &Vector, angle: f64, norm: f64) -> Quaternion {
        let (s, c) = (0.5 * angle).sin_cos();
        let turn = Quaternion([c, 0.0, 0.0, s]);
        let before = nodal(&self.mu, norm);
        let now = nodal(mu, norm);
        self.attitude
            .times(&before.conjugate())
            .times(&turn)
            .times(&now)
            .normalised()
    }
}

/// The rotation R_x(theta) R_z(psi) that maps the body components of the momentum to (0, 0, |mu|).
fn nodal(mu: &Vector, norm: f64) -> Quaternion {
    let [x, y, z] = *mu;
    let plane = x.hypot(y);
    // tan(psi) = x / y and tan(theta) = plane / z, as half angles.
    let (sine, cosine) = if plane > 0.0 {
        (x / plane, y / plane)
    } else {
        (0.0, 1.0)
    };
    let half = |sine: f64, cosine: f64| {
        if cosine >= 0.0 {
            let c = (0.5 * (1.0 + cosine)).sqrt();
            (0.5 * sine / c, c)
        } else {
            let s = (0.5 * (1.0 - cosine)).sqrt().copysign(sine);
            (s, 0.5 * sine / s)
        }
    };
    let (ps, pc) = half(sine, cosine);
    let (ts, tc) = half(plane / norm, z / norm);
    Quaternion([tc, ts, 0.0, 0.0]).times(&Quaternion([pc, 0.0, 0.0, ps]))
}

impl BodyMotion for Exact {
    #[allow(clippy::cast_precision_loss)]
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.node += 1;
        self.here = self.at(self.node as f64 * self.h);
        Ok(())
    }

    fn attitude(&self) -> Quaternion {
        self.here.0
    }

    fn body_momentum(&self) -> Vector {
        self.here.1
    }
}
