//! Free body of revolution on SU(2), the family of `cayley_klein`, with an explicit step. With two equal moments, the rotation
//! angle of the step and its axial component are constant, so a single scalar equation is solved at the start. Takes diagonal
//! moments (two of them equal), the parameter c, a unit quaternion, body momentum and h; gives quaternion and momentum at the
//! nodes.

use super::Unsolvable;
use super::attitude::{Quaternion, Vector, apply, apply_transposed};

/// Number of steps between two resets to the conserved spatial momentum, as for the free body on SO(3).
const REANCHOR_EVERY: u32 = 64;

/// A moving body of revolution.
///
/// With I = (a, a, b), d = b - a and u = h mu / 2, the equation c Q + q0 (I - c) Q + Q x I Q = u becomes D Q3 = u3 and (A + d Q3 R)
/// (Q1, Q2) = (u1, u2). Here A = c + q0 (a - c), D = c + q0 (b - c), and R is a quarter turn. The momentum rotates about the axis
/// by twice the angle of A + d Q3 R, so u3, the length of u and q0 are the same at every node.
#[derive(Clone, Copy, Debug)]
pub struct SymmetricCayleyKlein {
    /// h/2 times the body momentum.
    u: Vector,
    q: Quaternion,
    /// The axis of revolution and the two other axes, in cyclic order.
    places: [usize; 3],
    /// q0 and the axial component of every step.
    turn: [f64; 2],
    /// The map from the transverse momentum to the transverse component: (x, y) -> (p x - r y, r x + p y).
    across: [f64; 2],
    /// Cosine and sine of the rotation of the transverse momentum per step.
    precession: [f64; 2],
    until_anchor: u32,
    moments: Vector,
    /// h/2 times the spatial momentum of node 0.
    spatial: Vector,
    h: f64,
}

impl SymmetricCayleyKlein {
    /// Starts a trajectory with the body momentum of node 0.
    ///
    /// # Errors
    /// [`Unsolvable`] if no two moments are equal, or if the equation has no solution.
    pub fn start(
        moments: &Vector,
        c: f64,
        quaternion: &Quaternion,
        body_momentum: &Vector,
        h: f64,
    ) -> Result<SymmetricCayleyKlein, Unsolvable> {
        let places = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
        // Moments from a diagonalisation are equal only to rounding.
        let equal = |x: f64, y: f64| (x - y).abs() <= 8.0 * f64::EPSILON * x;
        let found = places
            .into_iter()
            .find(|[_, j, k]| equal(moments[*j], moments[*k]));
        let places = found.ok_or(Unsolvable)?;
        let [axis, j, k] = places;
        let (a, b) = (moments[j], moments[axis]);
        let u = body_momentum.map(|m| 0.5 * h * m);
        let (along, squared) = (u[axis], u[j] * u[j] + u[k] * u[k]);
        let deviation = deviation([a, b], c, along, squared)?;
        let (q0, d) = (1.0 - deviation, b - a);
        let spin = along / (b - deviation * (b - c));
        let (p, r) = (a - deviation * (a - c), d * spin);
        let square = p * p + r * r;
        Ok(SymmetricCayleyKlein {
            u,
            q: *quaternion,
            places,
            turn: [q0, spin],
            across: [p / square, r / square],
            precession: [(p * p - r * r) / square, 2.0 * p * r / square],
            until_anchor: REANCHOR_EVERY,
            moments: *moments,
            spatial: apply(&quaternion.matrix(), &u),
            h,
        })
    }

    /// Steps once; the equation is already solved.
    #[inline(always)]
    pub fn step(&mut self) {
        let [axis, j, k] = self.places;
        let ([q0, spin], [p, r], [cos, sin]) = (self.turn, self.across, self.precession);
        let (x, y) = (self.u[j], self.u[k]);
        let mut turn = [0.0; 3];
        turn[axis] = spin;
        turn[j] = p * x - r * y;
        turn[k] = r * x + p * y;
        self.u[j] = cos * x - sin * y;
        self.u[k] = sin * x + cos * y;
        let [a, b, c] = turn;
        self.q = self.q.times(&Quaternion([q0, a, b, c]));
        self.until_anchor -= 1;
        if self.until_anchor == 0 {
            self.anchor();
        }
    }

    /// Removes the rounding error of many steps: normalises q and recomputes u from the attitude, except for its constant
    /// component.
    #[cold]
    #[inline(never)]
    fn anchor(&mut self) {
        let axis = self.places[0];
        let along = self.u[axis];
        self.q = self.q.normalised();
        self.u = apply_transposed(&self.q.matrix(), &self.spatial);
        self.u[axis] = along;
        self.until_anchor = REANCHOR_EVERY;
    }

    /// The unit quaternion at the current node; q and -q are different states.
    pub fn quaternion(&self) -> Quaternion {
        self.q
    }

    /// Body momentum mu_k.
    pub fn body_momentum(&self) -> Vector {
        self.u.map(|x| 2.0 * x / self.h)
    }

    /// Spatial momentum, constant since node 0.
    pub fn spatial_momentum(&self) -> Vector {
        self.spatial.map(|x| 2.0 * x / self.h)
    }

    /// Energy mu . I^-1 mu / 2: constant for every member of the family, because |mu| and the axial component are.
    pub fn energy(&self) -> f64 {
        let mu = self.body_momentum();
        (0..3).map(|i| 0.5 * mu[i] * mu[i] / self.moments[i]).sum()
    }
}

/// 1 - q0: the smallest root e of e (2 - e) = Q3^2 + t / (A^2 + d^2 Q3^2), with t = u1^2 + u2^2. Newton's method converges
/// monotonically from the left; it passes the root only if there is none.
fn deviation([a, b]: [f64; 2], c: f64, along: f64, across: f64) -> Result<f64, Unsolvable> {
    let d = b - a;
    let mut e = 0.0;
    for _ in 0..100 {
        let (p, q) = (a - e * (a - c), b - e * (b - c));
        let spin = along / q;
        let spin_rate = spin * (b - c) / q;
        let square = p * p + (d * spin) * (d * spin);
        let square_rate = 2.0 * (d * d * spin * spin_rate - p * (a - c));
        let value = e * (2.0 - e) - spin * spin - across / square;
        let slope =
            2.0 - 2.0 * e - 2.0 * spin * spin_rate + across * square_rate / (square * square);
        // NaN also takes this branch.
        let rises = slope > 0.0 && q > 0.0;
        if !rises {
            return Err(Unsolvable);
        }
        let change = -value / slope;
        e += change;
        // Convergence is quadratic: the remaining error is the square of this change.
        if change.abs() <= 1e-9 * e {
            let (p, q) = (a - e * (a - c), b - e * (b - c));
            let spin = along / q;
            let square = p * p + (d * spin) * (d * spin);
            e -= (e * (2.0 - e) - spin * spin - across / square) / slope;
            return Ok(e);
        }
        if e == 0.0 {
            // A body at rest.
            return Ok(e);
        }
    }
    Err(Unsolvable)
}
