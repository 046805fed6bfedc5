//! The placement Q of an elastic ellipsoid: C0 Q'' I0 = -grad V(Q) by Störmer-Verlet: half a kick, a drift, half a kick. Takes C0,
//! I0, the stored energy of C = Q^T C0 Q or of S = Q I0 Q^T, placement, velocity and h; gives placements and momenta at the nodes.

use super::Unsolvable;
use super::body_n::{Square, product, transposed, transposed_product};

/// The argument of the stored energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Of {
    /// C = Q^T C0 Q, the convective metric.
    Metric,
    /// S = Q I0 Q^T, the spatial second moments.
    Moments,
}

/// A Mooney-Rivlin ellipsoid: W(X) = a I1(X) + b I2(X) + c det(X) - (d/2) log det(X).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid<const N: usize> {
    /// C0, metric of space.
    pub metric: Square<N>,
    /// I0, second moments of the reference.
    pub moments: Square<N>,
    /// a, b, c, d.
    pub energy: [f64; 4],
    /// The argument of W.
    pub of: Of,
}

/// The inverse and the determinant, by elimination with pivoting; not finite if the matrix is singular.
#[inline(always)]
pub fn inverse<const N: usize>(a: &Square<N>) -> (Square<N>, f64) {
    let mut left = *a;
    let mut right = super::body_n::identity();
    let mut determinant = 1.0;
    for k in 0..N {
        let mut pivot = k;
        for r in k + 1..N {
            if left[r][k].abs() > left[pivot][k].abs() {
                pivot = r;
            }
        }
        if pivot != k {
            left.swap(k, pivot);
            right.swap(k, pivot);
            determinant = -determinant;
        }
        determinant *= left[k][k];
        let reciprocal = 1.0 / left[k][k];
        for c in 0..N {
            left[k][c] *= reciprocal;
            right[k][c] *= reciprocal;
        }
        for r in 0..N {
            let factor = left[r][k];
            if r != k {
                for c in 0..N {
                    left[r][c] -= factor * left[k][c];
                    right[r][c] -= factor * right[k][c];
                }
            }
        }
    }
    (right, determinant)
}

/// a + s b.
#[inline(always)]
fn sum<const N: usize>(a: &Square<N>, s: f64, b: &Square<N>) -> Square<N> {
    let mut out = *a;
    for (row, other) in out.iter_mut().zip(b) {
        for (x, y) in row.iter_mut().zip(other) {
            *x += s * y;
        }
    }
    out
}

fn trace<const N: usize>(a: &Square<N>) -> f64 {
    a.iter().enumerate().map(|(i, row)| row[i]).sum()
}

impl<const N: usize> Ellipsoid<N> {
    /// The argument of W at this placement.
    #[inline(always)]
    fn argument(&self, q: &Square<N>) -> Square<N> {
        match self.of {
            Of::Metric => transposed_product(q, &product(&self.metric, q)),
            Of::Moments => product(&product(q, &self.moments), &transposed(q)),
        }
    }

    /// W' = a + b (tr X - X) + (c det X - d/2) X^-1, symmetric.
    #[inline(always)]
    fn stress(&self, x: &Square<N>) -> Square<N> {
        let [a, b, c, d] = self.energy;
        let (inverse, determinant) = inverse(x);
        let share = c * determinant - 0.5 * d;
        let mut out = [[0.0; N]; N];
        let diagonal = a + b * trace(x);
        for i in 0..N {
            for j in 0..N {
                out[i][j] = share * inverse[i][j] - b * x[i][j];
            }
            out[i][i] += diagonal;
        }
        out
    }

    /// The stored energy at this placement.
    pub fn stored(&self, q: &Square<N>) -> f64 {
        let x = self.argument(q);
        let [a, b, c, d] = self.energy;
        let (first, determinant) = (trace(&x), inverse(&x).1);
        let second = 0.5 * (first * first - trace(&product(&x, &x)));
        a * first + b * second + c * determinant - 0.5 * d * determinant.ln()
    }
}

/// An ellipsoid with precomputed data for its acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prepared<const N: usize> {
    /// The ellipsoid.
    pub body: Ellipsoid<N>,
    /// I0^-1 for an energy of C, C0^-1 for an energy of S; the other factor cancels.
    factor: Square<N>,
}

impl<const N: usize> Prepared<N> {
    /// Inverts the factor that multiplies the force.
    ///
    /// # Errors
    /// [`Unsolvable`] if it is singular.
    pub fn new(body: &Ellipsoid<N>) -> Result<Self, Unsolvable> {
        let (factor, _) = match body.of {
            Of::Metric => inverse(&body.moments),
            Of::Moments => inverse(&body.metric),
        };
        match factor.iter().flatten().all(|x| x.is_finite()) {
            true => Ok(Self {
                body: *body,
                factor,
            }),
            false => Err(Unsolvable),
        }
    }

    /// Q'' = -2 Q W'(C) I0^-1, or -2 C0^-1 W'(S) Q.
    #[inline(always)]
    pub fn acceleration(&self, q: &Square<N>) -> Square<N> {
        let stress = self.body.stress(&self.body.argument(q));
        let force = match self.body.of {
            Of::Metric => product(q, &product(&stress, &self.factor)),
            Of::Moments => product(&product(&self.factor, &stress), q),
        };
        force.map(|row| row.map(|x| -2.0 * x))
    }

    /// The velocity Q' of a momentum, which is a body momentum for an energy of C and a spatial one for an energy of S.
    pub fn velocity(&self, q: &Square<N>, momentum: &Square<N>) -> Square<N> {
        let back = inverse(q).0;
        // Q^T C0 Q' I0, and C0 Q' I0 Q^T.
        let material = match self.body.of {
            Of::Metric => product(&transposed(&back), momentum),
            Of::Moments => product(momentum, &transposed(&back)),
        };
        let left = inverse(&self.body.metric).0;
        product(&product(&left, &material), &inverse(&self.body.moments).0)
    }

    /// The momentum of a velocity.
    pub fn momentum(&self, q: &Square<N>, velocity: &Square<N>) -> Square<N> {
        let material = product(&product(&self.body.metric, velocity), &self.body.moments);
        match self.body.of {
            Of::Metric => transposed_product(q, &material),
            Of::Moments => product(&material, &transposed(q)),
        }
    }
}

/// A moving ellipsoid.
#[derive(Clone, Copy, Debug)]
pub struct ElasticEllipsoid<const N: usize> {
    q: Square<N>,
    v: Square<N>,
    /// Acceleration at the current placement, which the next step uses first.
    acceleration: Square<N>,
    body: Prepared<N>,
    h: f64,
}

impl<const N: usize> ElasticEllipsoid<N> {
    /// Starts a trajectory with the momentum of node 0, in the body for an energy of C and in space for an energy of S.
    ///
    /// # Errors
    /// [`Unsolvable`] for a singular placement or factor.
    pub fn start(
        body: &Ellipsoid<N>,
        placement: &Square<N>,
        momentum: &Square<N>,
        h: f64,
    ) -> Result<Self, Unsolvable> {
        let body = Prepared::new(body)?;
        let v = body.velocity(placement, momentum);
        let acceleration = body.acceleration(placement);
        let known = v.iter().chain(&acceleration).flatten();
        match known.fold(0.0, |sum, x| sum + x).is_finite() {
            true => Ok(Self {
                q: *placement,
                v,
                acceleration,
                body,
                h,
            }),
            false => Err(Unsolvable),
        }
    }

    /// Steps once; the state is unchanged if the new placement would be singular.
    ///
    /// # Errors
    /// [`Unsolvable`] in that case.
    #[inline(always)]
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        let half = 0.5 * self.h;
        let v = sum(&self.v, half, &self.acceleration);
        let q = sum(&self.q, self.h, &v);
        let acceleration = self.body.acceleration(&q);
        let v = sum(&v, half, &acceleration);
        let known = v.iter().flatten().fold(0.0, |sum, x| sum + x);
        if !known.is_finite() {
            return Err(Unsolvable);
        }
        (self.q, self.v, self.acceleration) = (q, v, acceleration);
        Ok(())
    }

    /// Placement at the current node.
    pub fn placement(&self) -> Square<N> {
        self.q
    }

    /// Momentum at the current node.
    pub fn momentum(&self) -> Square<N> {
        self.body.momentum(&self.q, &self.v)
    }

    /// Kinetic plus stored energy; oscillates within O(h^2).
    pub fn energy(&self) -> f64 {
        let body = &self.body.body;
        let material = product(&product(&body.metric, &self.v), &body.moments);
        0.5 * trace(&transposed_product(&self.v, &material)) + body.stored(&self.q)
    }
}
