//! The principal root kappa of the Moser-Veselov quartic for principal moments I and u = h N / 2. Let s1, s2, s3 be the elementary
//! symmetric functions of I, a = |u|^2 and e = s3 sum u_i^2 / I_i. Then kappa^4 - s1 kappa^3 + (s2 + 2a) kappa^2 - (s3 + s1 a)
//! kappa + e + a^2 = 0, and kappa is the smallest positive root.

use super::Unsolvable;
use super::attitude::{Quaternion, Vector};

/// Functions of the moments of inertia alone; all coefficients are divided by s3.
#[derive(Clone, Copy, Debug)]
pub struct Quartic {
    reciprocal: Vector,
    /// (s2 / I_i - s1) / s3: the first correction to kappa = sum u_i^2 / I_i is the sum of u_i^2 times this.
    deviation: Vector,
    /// Largest sum u_i^2 / I_i for which one improvement of the series is exact to rounding.
    easy: f64,
    /// 1 / s3.
    fourth: f64,
    /// s1 / s3.
    third: f64,
    /// s2 / s3.
    second: f64,
}

/// The rotation of the step as an unnormalised quaternion, from u, its squared components, their sum `a`, and the root kappa.
/// `gyration` contains the differences I_2 - I_3, I_3 - I_1, I_1 - I_2 of the moments.
#[inline(always)]
pub fn turn(
    moments: &Vector,
    gyration: &Vector,
    u: &Vector,
    squares: &Vector,
    a: f64,
    kappa: f64,
) -> Quaternion {
    let [i1, i2, i3] = *moments;
    let (d1, d2, d3) = (i1 - kappa, i2 - kappa, i3 - kappa);
    let d23 = d2 * d3;
    Quaternion([
        d1 * (d23 + squares[0]) + (d2 * squares[1] + d3 * squares[2]),
        (d23 + a) * u[0] + gyration[0] * (u[1] * u[2]),
        (d3 * d1 + a) * u[1] + gyration[1] * (u[2] * u[0]),
        (d1 * d2 + a) * u[2] + gyration[2] * (u[0] * u[1]),
    ])
}

impl Quartic {
    /// Coefficients of the quartic for moments of inertia I.
    pub fn new(moments: &Vector) -> Quartic {
        let [a, b, c] = *moments;
        let product = a * b * c;
        let reciprocal = [1.0 / a, 1.0 / b, 1.0 / c];
        let third = (a + b + c) / product;
        let second = (a * b + b * c + c * a) / product;
        Quartic {
            reciprocal,
            deviation: reciprocal.map(|r| second * r - third),
            easy: 0.02 / second,
            fourth: 1.0 / product,
            third,
            second,
        }
    }

    /// kappa for u with squared components `squares` and their sum `a`.
    ///
    /// Small steps take one pass without a loop: a two-term series, then one fourth-order iteration with a single division. Larger
    /// steps take a second iteration. The largest take the monotone iteration, which also detects that no root exists.
    #[inline(always)]
    pub fn principal_root(&self, squares: &Vector, a: f64) -> Result<f64, Unsolvable> {
        let (kappa, terms) = self.once(squares, a);
        // Written so that NaN takes the slow path, which reports it.
        if terms.energy <= self.easy {
            Ok(kappa)
        } else {
            self.hard(kappa, &terms)
        }
    }

    /// kappa by the single pass, and whether it is exact to rounding; otherwise the value is meaningless. The code is branch-free,
    /// so that the compiler vectorises a loop over many bodies.
    #[inline(always)]
    pub fn root_at_once(&self, squares: &Vector, a: f64) -> (f64, bool) {
        let (kappa, terms) = self.once(squares, a);
        (kappa, terms.energy <= self.easy)
    }

    /// The two-term series, improved once.
    #[inline(always)]
    fn once(&self, squares: &Vector, a: f64) -> (f64, Terms) {
        let [p, q, r] = self.reciprocal;
        let [pp, qq, rr] = self.deviation;
        let energy = (squares[0] * p + squares[1] * q) + squares[2] * r;
        let deviation = (squares[0] * pp + squares[1] * qq) + squares[2] * rr;
        let terms = Terms {
            energy,
            a_squared: self.fourth * (a * a),
            turn: self.third * a,
            curvature: self.second + 2.0 * (self.fourth * a),
        };
        let kappa = self.improved((energy + energy * deviation) + terms.a_squared, &terms);
        (kappa, terms)
    }

    /// One fourth-order iteration: Newton's correction d plus the next two terms of the inverse series, d + b d^2 + (2 b^2 + c)
    /// d^3. b and c are the second and third Taylor coefficients divided by the negative slope.
    #[inline(always)]
    fn improved(&self, start: f64, terms: &Terms) -> f64 {
        let square = start * start;
        let value = ((terms.energy - start) - terms.turn * start + terms.a_squared)
            + (square * (terms.curvature - self.third * start) + (square * square) * self.fourth);
        let fall = ((1.0 + terms.turn) - start * (2.0 * terms.curvature))
            + (square * (3.0 * self.third) - (start * square) * (4.0 * self.fourth));
        let inverse = 1.0 / fall;
        let second = terms.curvature + square * (6.0 * self.fourth) - start * (3.0 * self.third);
        let third = start * (4.0 * self.fourth) - self.third;
        let newton = value * inverse;
        let bent = (second * inverse) * newton;
        let twist = (third * inverse) * (newton * newton);
        (start + newton) + newton * (bent * (1.0 + (bent + bent)) + twist)
    }

    /// Steps near and beyond the solvability bound, and non-finite momenta.
    #[cold]
    #[inline(never)]
    fn hard(&self, kappa: f64, terms: &Terms) -> Result<f64, Unsolvable> {
        if terms.energy <= 6.0 * self.easy {
            Ok(self.improved(kappa, terms))
        } else {
            self.monotone(terms)
        }
    }

    /// Newton's iteration from the left of the smallest root. It converges monotonically, because the quartic is convex and
    /// decreasing there. A nonnegative slope before a root means that there is none.
    fn monotone(&self, terms: &Terms) -> Result<f64, Unsolvable> {
        let c0 = terms.energy + terms.a_squared;
        let linear = 1.0 + terms.turn;
        let mut kappa = c0 / linear;
        for _ in 0..200 {
            let g0 = c0
                + kappa
                    * (-linear
                        + kappa * (terms.curvature + kappa * (kappa * self.fourth - self.third)));
            let g1 = -linear
                + kappa
                    * (2.0 * terms.curvature
                        + kappa * (4.0 * kappa * self.fourth - 3.0 * self.third));
            // NaN also takes this branch.
            let falling = g1 < 0.0;
            if !falling || !g0.is_finite() {
                return Err(Unsolvable);
            }
            let change = -g0 / g1;
            kappa += change;
            // The rounding error of g0 is a few units of c0; below this change the iteration only oscillates.
            if change <= 4.0 * f64::EPSILON * kappa {
                return Ok(kappa);
            }
        }
        Err(Unsolvable)
    }

    /// The constant kappa of a free trajectory, computed once at the start by the monotone iteration.
    pub fn constant_root(&self, squares: &Vector, a: f64) -> Result<f64, Unsolvable> {
        let [p, q, r] = self.reciprocal;
        self.monotone(&Terms {
            energy: squares[0] * p + squares[1] * q + squares[2] * r,
            a_squared: self.fourth * (a * a),
            turn: self.third * a,
            curvature: self.second + 2.0 * (self.fourth * a),
        })
    }
}

/// Coefficients of the quartic that depend on u, divided by s3.
struct Terms {
    /// sum u_i^2 / I_i.
    energy: f64,
    /// a^2 / s3.
    a_squared: f64,
    /// a s1 / s3: the linear coefficient is minus (1 + turn).
    turn: f64,
    /// (s2 + 2a) / s3.
    curvature: f64,
}
