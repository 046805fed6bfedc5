//! Free body on SU(2), body representation: the family L_d = -(4c/h) q0 + (2/h) Q . (I - c) Q of discrete Lagrangians. Takes
//! diagonal moments I, the parameter c, a unit quaternion, body momentum and h; gives quaternion and momentum at the nodes. c = 0
//! is Moser-Veselov on SO(3). For any other c, L_d is not a function on SO(3), but the scheme is of second order and Poisson.

use super::Unsolvable;
use super::attitude::{Quaternion, Vector, add_scaled, apply, apply_transposed, dot};
use super::spaced::{SpacedQuaternion, SpacedVector};

/// Number of steps between two resets to the conserved spatial momentum, as for the free body on SO(3).
const REANCHOR_EVERY: u32 = 64;

/// A moving body. With u = h mu / 2, a step solves c Q + q0 (I - c) Q + Q x I Q = u for W = (q0, Q).
#[derive(Clone, Copy, Debug)]
pub struct CayleyKlein {
    u: SpacedVector,
    q: SpacedQuaternion,
    /// Shifts s of the last three steps; the next step starts from the parabola through them.
    shifts: [f64; 3],
    until_anchor: u32,
    moments: Vector,
    reciprocal: Vector,
    gyration: Vector,
    c: f64,
    /// h/2 times the spatial momentum of node 0.
    spatial: Vector,
    h: f64,
}

impl CayleyKlein {
    /// Starts a trajectory with the body momentum of node 0. The first step must be solvable.
    pub fn start(
        moments: &Vector,
        c: f64,
        quaternion: &Quaternion,
        body_momentum: &Vector,
        h: f64,
    ) -> Result<CayleyKlein, Unsolvable> {
        let i = *moments;
        let u = body_momentum.map(|m| 0.5 * h * m);
        let mut body = CayleyKlein {
            u: SpacedVector::new(u),
            q: SpacedQuaternion::new(*quaternion),
            shifts: [0.0; 3],
            until_anchor: REANCHOR_EVERY,
            moments: i,
            reciprocal: i.map(|m| 1.0 / m),
            gyration: [i[1] - i[2], i[2] - i[0], i[0] - i[1]],
            c,
            spatial: apply(&quaternion.matrix(), &u),
            h,
        };
        body.shifts = [body.shift(&u, body.first_shift(&u))?.0; 3];
        Ok(body)
    }

    /// s for small steps: s = Q . (I - c) Q + c (1 - q0) with Q = I^-1 u.
    fn first_shift(&self, u: &Vector) -> f64 {
        let turn = [0, 1, 2].map(|i| u[i] * self.reciprocal[i]);
        dot(&turn, u) - 0.5 * self.c * dot(&turn, &turn)
    }

    /// The shift s and its W, up to a positive factor.
    ///
    /// With s = Q . (I - c) Q + c (1 - q0), the three equations become linear: (I - s - hat(u)) Q = q0 u, solved by (q0, Q) ~ (det,
    /// n) as on SO(3). One equation remains for s alone: u . n - s det = c (|(det, n)| - det).
    #[inline(always)]
    fn shift(&self, u: &Vector, start: f64) -> Result<(f64, Quaternion), Unsolvable> {
        let squares = u.map(|x| x * x);
        let a = (squares[0] + squares[1]) + squares[2];
        let twist = [
            self.gyration[0] * (u[1] * u[2]),
            self.gyration[1] * (u[2] * u[0]),
            self.gyration[2] * (u[0] * u[1]),
        ];
        let [i1, i2, i3] = self.moments;
        let mut s = start;
        for _ in 0..50 {
            let (d1, d2, d3) = (i1 - s, i2 - s, i3 - s);
            let (d23, d31, d12) = (d2 * d3, d3 * d1, d1 * d2);
            let det = d1 * (d23 + squares[0]) + (d2 * squares[1] + d3 * squares[2]);
            let n1 = (d23 + a) * u[0] + twist[0];
            let n2 = (d31 + a) * u[1] + twist[1];
            let n3 = (d12 + a) * u[2] + twist[2];
            let nn = (n1 * n1 + n2 * n2) + n3 * n3;
            let un = (u[0] * n1 + u[1] * n2) + u[2] * n3;
            let length = (det * det + nn).sqrt();
            // (|w| - det) without cancellation.
            let value = (un - s * det) * (length + det) - self.c * nn;
            let det_rate = -((d23 + d31) + (d12 + a));
            let (r1, r2, r3) = (-(d2 + d3) * u[0], -(d3 + d1) * u[1], -(d1 + d2) * u[2]);
            let un_rate = (u[0] * r1 + u[1] * r2) + u[2] * r3;
            let half_nn_rate = (n1 * r1 + n2 * r2) + n3 * r3;
            let length_rate = (det * det_rate + half_nn_rate) / length;
            let slope = (un_rate - det - s * det_rate) * (length + det)
                + (un - s * det) * (length_rate + det_rate)
                - (self.c + self.c) * half_nn_rate;
            let change = value / slope;
            s -= change;
            // Convergence is quadratic: the error of this change is its own square.
            if change.abs() <= 3e-9 * i2 {
                let (e1, e2, e3) = (d1 + change, d2 + change, d3 + change);
                let (e23, e31, e12) = (e2 * e3, e3 * e1, e1 * e2);
                let turn = Quaternion([
                    e1 * (e23 + squares[0]) + (e2 * squares[1] + e3 * squares[2]),
                    (e23 + a) * u[0] + twist[0],
                    (e31 + a) * u[1] + twist[1],
                    (e12 + a) * u[2] + twist[2],
                ]);
                return Ok((s, turn));
            }
        }
        Err(Unsolvable)
    }

    /// Steps once; if the equation has no solution, the state is unchanged.
    #[inline(always)]
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        let u = self.u.get();
        let [old, last, now] = self.shifts;
        let (s, turn) = self.shift(&u, 3.0 * (now - last) + old)?;
        self.shifts = [last, now, s];
        let inverse = 1.0 / turn.norm_squared();
        let [_, n1, n2, n3] = turn.0;
        // mu' = Om^T mu: only the sign of Q x I Q changes.
        let double = inverse + inverse;
        self.u.set([
            u[0] + double * (self.gyration[0] * (n2 * n3)),
            u[1] + double * (self.gyration[1] * (n3 * n1)),
            u[2] + double * (self.gyration[2] * (n1 * n2)),
        ]);
        self.q.set(self.q.get().times(&turn).scaled(inverse.sqrt()));
        self.until_anchor -= 1;
        if self.until_anchor == 0 {
            self.anchor();
        }
        Ok(())
    }

    /// Removes the rounding error of many steps: normalises q and recomputes u from the attitude.
    #[cold]
    #[inline(never)]
    fn anchor(&mut self) {
        let q = self.q.get().normalised();
        self.q.set(q);
        self.u.set(apply_transposed(&q.matrix(), &self.spatial));
        self.until_anchor = REANCHOR_EVERY;
    }

    /// The unit quaternion at the current node; q and -q are different states.
    pub fn quaternion(&self) -> Quaternion {
        self.q.get()
    }

    /// Body momentum mu_k.
    pub fn body_momentum(&self) -> Vector {
        self.u.get().map(|x| 2.0 * x / self.h)
    }

    /// Spatial momentum, constant since node 0.
    pub fn spatial_momentum(&self) -> Vector {
        self.spatial.map(|x| 2.0 * x / self.h)
    }

    /// Energy mu . I^-1 mu / 2: exact for c = 0, otherwise oscillating within O(h^2).
    pub fn energy(&self) -> f64 {
        let mu = self.body_momentum();
        0.5 * dot(&mu, &[0, 1, 2].map(|i| mu[i] * self.reciprocal[i]))
    }

    /// The residual of the derived equation c Q + q0 (I - c) Q + Q x I Q = u at the current node.
    pub fn residual(&self) -> Result<f64, Unsolvable> {
        let u = self.u.get();
        let (_, turn) = self.shift(&u, self.first_shift(&u))?;
        let [q0, x, y, z] = turn.normalised().0;
        let q = [x, y, z];
        let image = [0, 1, 2].map(|i| self.moments[i] * q[i]);
        let left = [0, 1, 2].map(|i| self.c * q[i] + q0 * (image[i] - self.c * q[i]));
        let left = add_scaled(&left, 1.0, &super::attitude::cross(&q, &image));
        // Written so that NaN propagates.
        Ok((0..3)
            .map(|i| (left[i] - u[i]).abs())
            .fold(0.0, |a: f64, b| if b <= a || a.is_nan() { a } else { b }))
    }
}
