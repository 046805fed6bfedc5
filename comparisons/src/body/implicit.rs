//! The Moser-Veselov step of the free body with published solvers: iterations for the Rodrigues vector c of the step's rotation, I
//! c + c x I c = (1 + |c|^2) h mu / 2. Gives the same map as the explicit step, by Hairer and Vilmart's fixed-point iteration (J.
//! Phys. A 39, 2006, section 3) or by Newton's method. A step fails if its iteration does not converge.

use super::{BodyMotion, Start};
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{Quaternion, Vector, cross, dot};
use crate::handwritten::principal_axes::PrincipalAxes;

/// Iteration limit. Near the solvability bound, the fixed-point iteration needs hundreds of iterations. At practical step sizes it
/// needs five to ten, and Newton's method two or three.
const PASSES: usize = 60;

/// A body in principal axes, with the data of an iteration.
#[derive(Clone, Copy, Debug)]
struct Body {
    moments: Vector,
    inverse: Vector,
    gyration: Vector,
    /// h/2 times the body momentum.
    u: Vector,
    q: Quaternion,
    axes: PrincipalAxes,
    h: f64,
}

impl Body {
    fn start(start: &Start) -> Result<Self, Unsolvable> {
        let axes = PrincipalAxes::new(&start.poinsot)?;
        let i = axes.moments;
        let momentum = axes.enter(&start.body_momentum);
        Ok(Self {
            moments: i,
            inverse: i.map(|i| 1.0 / i),
            gyration: [i[1] - i[2], i[2] - i[0], i[0] - i[1]],
            u: momentum.map(|m| 0.5 * start.h * m),
            q: axes.enter_attitude(&start.attitude),
            axes,
            h: start.h,
        })
    }

    /// I c.
    #[inline(always)]
    fn carried(&self, c: &Vector) -> Vector {
        let i = self.moments;
        [i[0] * c[0], i[1] * c[1], i[2] * c[2]]
    }

    /// Rotates the body by the rotation of c.
    #[inline(always)]
    fn advance(&mut self, c: &Vector) {
        let alpha = 1.0 + dot(c, c);
        let inverse = 1.0 / alpha;
        let w = self.gyration;
        self.u[0] += 2.0 * inverse * (w[0] * (c[1] * c[2]));
        self.u[1] += 2.0 * inverse * (w[1] * (c[2] * c[0]));
        self.u[2] += 2.0 * inverse * (w[2] * (c[0] * c[1]));
        let turn = Quaternion([1.0, c[0], c[1], c[2]]);
        self.q = self.q.times(&turn).scaled(inverse.sqrt());
    }

    fn attitude(&self) -> Quaternion {
        self.axes.leave_attitude(&self.q.normalised())
    }

    fn body_momentum(&self) -> Vector {
        self.axes.leave(&self.u).map(|c| 2.0 * c / self.h)
    }
}

/// Largest component.
#[inline(always)]
fn largest(v: &Vector) -> f64 {
    v[0].abs().max(v[1].abs()).max(v[2].abs())
}

/// Hairer and Vilmart's fixed-point iteration: c <- I^-1 ((1 + |c|^2) u - c x I c).
#[derive(Clone, Copy, Debug)]
pub struct FixedPoint {
    body: Body,
}

impl FixedPoint {
    /// Starts a motion.
    ///
    /// # Errors
    /// [`Unsolvable`] if the matrix is not admissible for a rigid body.
    pub fn start(start: &Start) -> Result<Self, Unsolvable> {
        Ok(Self {
            body: Body::start(start)?,
        })
    }

    #[inline(always)]
    fn solve(&self) -> Result<Vector, Unsolvable> {
        let Body { inverse, u, .. } = self.body;
        let mut c = [inverse[0] * u[0], inverse[1] * u[1], inverse[2] * u[2]];
        for _ in 0..PASSES {
            let turned = cross(&c, &self.body.carried(&c));
            let alpha = 1.0 + dot(&c, &c);
            let next = [
                inverse[0] * (alpha * u[0] - turned[0]),
                inverse[1] * (alpha * u[1] - turned[1]),
                inverse[2] * (alpha * u[2] - turned[2]),
            ];
            let change = [next[0] - c[0], next[1] - c[1], next[2] - c[2]];
            c = next;
            // Two units in the last place of the largest component, because rounding can alternate by one.
            if largest(&change) <= 2.0 * f64::EPSILON * largest(&c) {
                return Ok(c);
            }
        }
        Err(Unsolvable)
    }
}

impl BodyMotion for FixedPoint {
    #[inline(always)]
    fn step(&mut self) -> Result<(), Unsolvable> {
        let c = self.solve()?;
        self.body.advance(&c);
        Ok(())
    }

    fn attitude(&self) -> Quaternion {
        self.body.attitude()
    }

    fn body_momentum(&self) -> Vector {
        self.body.body_momentum()
    }
}

/// Newton's method, with the extrapolation of the last two solutions as its initial guess.
#[derive(Clone, Copy, Debug)]
pub struct Newton {
    body: Body,
    last: [Vector; 2],
}

impl Newton {
    /// Starts a motion.
    ///
    /// # Errors
    /// [`Unsolvable`] if the matrix is not admissible for a rigid body.
    pub fn start(start: &Start) -> Result<Self, Unsolvable> {
        let body = Body::start(start)?;
        let (i, u) = (body.inverse, body.u);
        let first = [i[0] * u[0], i[1] * u[1], i[2] * u[2]];
        Ok(Self {
            body,
            last: [first, first],
        })
    }

    #[inline(always)]
    fn solve(&self) -> Result<Vector, Unsolvable> {
        let (i, u) = (self.body.moments, self.body.u);
        let [before, last] = self.last;
        let mut c = [
            2.0 * last[0] - before[0],
            2.0 * last[1] - before[1],
            2.0 * last[2] - before[2],
        ];
        for _ in 0..PASSES {
            let b = self.body.carried(&c);
            let turned = cross(&c, &b);
            let alpha = 1.0 + dot(&c, &c);
            let rest: Vector = std::array::from_fn(|k| b[k] + turned[k] - alpha * u[k]);
            // Columns of the Jacobian: I e_k + c x I e_k + e_k x I c - 2 c_k u.
            let column = |k: usize| {
                let (l, n) = ((k + 1) % 3, (k + 2) % 3);
                let mut column = [0.0; 3];
                column[k] = i[k];
                column[l] = c[n] * i[k] - b[n];
                column[n] = b[l] - c[l] * i[k];
                [0, 1, 2].map(|r| column[r] - 2.0 * c[k] * u[r])
            };
            let [x, y, z] = [column(0), column(1), column(2)];
            let (yz, zx, xy) = (cross(&y, &z), cross(&z, &x), cross(&x, &y));
            let inverse = 1.0 / dot(&x, &yz);
            let change = [
                inverse * dot(&rest, &yz),
                inverse * dot(&rest, &zx),
                inverse * dot(&rest, &xy),
            ];
            c = [c[0] - change[0], c[1] - change[1], c[2] - change[2]];
            // The next change is about the square of this change: below a unit in the last place.
            if largest(&change) <= 1e-8 * largest(&c) {
                return Ok(c);
            }
        }
        Err(Unsolvable)
    }
}

impl BodyMotion for Newton {
    #[inline(always)]
    fn step(&mut self) -> Result<(), Unsolvable> {
        let c = self.solve()?;
        self.body.advance(&c);
        self.last = [self.last[1], c];
        Ok(())
    }

    fn attitude(&self) -> Quaternion {
        self.body.attitude()
    }

    fn body_momentum(&self) -> Vector {
        self.body.body_momentum()
    }
}
