//! Two bodies with a spherical joint: full Newton on the pair of rotations, with 3 x 3 blocks. Takes J_i + eps d_i d_i^T, the arms
//! d_i, eps, attitudes, body momenta and h; gives attitudes and momenta at the nodes. The state is both attitudes and both spatial
//! momenta. `coupled_fixed_point` contains the thesis's iteration.

use super::Unsolvable;
use super::attitude::{
    Matrix, Quaternion, Vector, add_outer, add_scaled, apply, apply_transposed, cross, crossed,
    dot, inverse, largest, product, scaled, scaled_matrix, sum, transposed_product,
};
use super::principal_axes::PrincipalAxes;

/// The data of the pair; matrices and arms in the axes of each body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Poinsot matrices about the centres of mass, plus eps d d^T.
    pub poinsots: [Matrix; 2],
    /// Joint -> centre of mass.
    pub arms: [Vector; 2],
    /// Reduced mass.
    pub eps: f64,
}

/// Maximum number of Newton iterations per step.
pub const MOST_ITERATIONS: usize = 4;

/// Largest residual of an accepted solution, in units of h/2 times the largest momentum (at least one).
pub const RESIDUAL: f64 = 1e-15;

/// One body's half of the equations, in principal axes.
#[derive(Clone, Copy, Debug)]
struct Half {
    moments: Vector,
    arm: Vector,
}

/// Rodrigues vector c and derived quantities: with alpha = 1 + |c|^2, G = (I c + c x I c)/alpha and w = (c x d + c x (c x d))/alpha
/// = (Om - Id) d / 2.
#[derive(Clone, Copy, Debug)]
struct Turn {
    c: Vector,
    inverse: f64,
    momentum: Vector,
    moved: Vector,
}

impl Half {
    #[inline(always)]
    fn turn(&self, c: &Vector) -> Turn {
        let inverse = 1.0 / (1.0 + dot(c, c));
        let [i1, i2, i3] = self.moments;
        let b = [i1 * c[0], i2 * c[1], i3 * c[2]];
        let momentum = scaled(inverse, &add_scaled(&b, 1.0, &cross(c, &b)));
        let side = cross(c, &self.arm);
        let moved = scaled(inverse, &add_scaled(&side, 1.0, &cross(c, &side)));
        Turn {
            c: *c,
            inverse,
            momentum,
            moved,
        }
    }

    /// dG/dc = (I - hat(I c) + hat(c) I - 2 G c^T)/alpha.
    #[inline(always)]
    fn momentum_rate(&self, t: &Turn) -> Matrix {
        let [i1, i2, i3] = self.moments;
        let [x, y, z] = t.c;
        let base = [
            [i1, z * (i3 - i2), y * (i3 - i2)],
            [z * (i1 - i3), i2, x * (i1 - i3)],
            [y * (i2 - i1), x * (i2 - i1), i3],
        ];
        rate(&base, t.inverse, &t.momentum, &t.c)
    }

    /// dw/dc = (-hat(d) + (c.d) Id + c d^T - 2 d c^T - 2 w c^T)/alpha.
    #[inline(always)]
    fn moved_rate(&self, t: &Turn) -> Matrix {
        let d = self.arm;
        let along = dot(&t.c, &d);
        let skew = [
            [along, d[2], -d[1]],
            [-d[2], along, d[0]],
            [d[1], -d[0], along],
        ];
        let base = add_outer(&add_outer(&skew, &t.c, &d), &d, &scaled(-2.0, &t.c));
        rate(&base, t.inverse, &t.moved, &t.c)
    }
}

/// (base - 2 v c^T)/alpha.
#[inline(always)]
fn rate(base: &Matrix, inverse: f64, v: &Vector, c: &Vector) -> Matrix {
    scaled_matrix(inverse, &add_outer(base, v, &scaled(-2.0, c)))
}

/// The factored Newton matrix in blocks: A11^-1, A21, A11^-1 A12 and the inverse of the Schur complement.
#[derive(Clone, Copy, Debug)]
struct Factors {
    first: Matrix,
    lower: Matrix,
    upper: Matrix,
    schur: Matrix,
}

impl Factors {
    #[inline(always)]
    fn solve(&self, f: &[Vector; 2]) -> [Vector; 2] {
        let half = apply(&self.first, &f[0]);
        let second = apply(
            &self.schur,
            &add_scaled(&f[1], -1.0, &apply(&self.lower, &half)),
        );
        [
            add_scaled(&half, -1.0, &apply(&self.upper, &second)),
            second,
        ]
    }
}

/// Two moving bodies, each in its principal axes. Stores momenta times h/2.
#[derive(Clone, Copy, Debug)]
pub struct CoupledBodies {
    q: [Quaternion; 2],
    m: [Vector; 2],
    /// Rodrigues vectors of the last four steps, newest first; the next step starts from the cubic through them.
    past: [[Vector; 2]; 4],
    known: u32,
    halves: [Half; 2],
    eps: f64,
    axes: [PrincipalAxes; 2],
    h: f64,
    iterations: usize,
    residual: f64,
}

impl CoupledBodies {
    /// Starts a trajectory with the body momenta of node 0.
    pub fn start(
        pair: &Pair,
        attitudes: &[Quaternion; 2],
        body_momenta: &[Vector; 2],
        h: f64,
    ) -> Result<CoupledBodies, Unsolvable> {
        let axes = [
            PrincipalAxes::new(&pair.poinsots[0])?,
            PrincipalAxes::new(&pair.poinsots[1])?,
        ];
        let q = [0, 1].map(|i| axes[i].enter_attitude(&attitudes[i]));
        let m = [0, 1]
            .map(|i| apply(&q[i].matrix(), &axes[i].enter(&body_momenta[i])).map(|c| 0.5 * h * c));
        Ok(CoupledBodies {
            q,
            m,
            past: [[[0.0; 3]; 2]; 4],
            known: 0,
            halves: [0, 1].map(|i| Half {
                moments: axes[i].moments,
                arm: axes[i].enter(&pair.arms[i]),
            }),
            eps: pair.eps,
            axes,
            h,
            iterations: 0,
            residual: 0.0,
        })
    }

    /// The equations G_1 - eps d_1 x R w_2 = u_1 and G_2 - eps d_2 x R^T w_1 = u_2: left side minus right side.
    #[inline(always)]
    fn residuals(&self, t: &[Turn; 2], r: &Matrix, u: &[Vector; 2]) -> [Vector; 2] {
        let [one, two] = &self.halves;
        let first = cross(&one.arm, &apply(r, &t[1].moved));
        let second = cross(&two.arm, &apply_transposed(r, &t[0].moved));
        [
            add_scaled(&add_scaled(&t[0].momentum, -self.eps, &first), -1.0, &u[0]),
            add_scaled(&add_scaled(&t[1].momentum, -self.eps, &second), -1.0, &u[1]),
        ]
    }

    #[inline(always)]
    fn factors(&self, t: &[Turn; 2], r: &Matrix) -> Factors {
        let [one, two] = &self.halves;
        let a11 = one.momentum_rate(&t[0]);
        let a22 = two.momentum_rate(&t[1]);
        let a12 = crossed(
            &scaled(-self.eps, &one.arm),
            &product(r, &two.moved_rate(&t[1])),
        );
        let a21 = crossed(
            &scaled(-self.eps, &two.arm),
            &transposed_product(r, &one.moved_rate(&t[0])),
        );
        let first = inverse(&a11);
        let upper = product(&first, &a12);
        let schur = sum(&a22, -1.0, &product(&a21, &upper));
        Factors {
            first,
            lower: a21,
            upper,
            schur: inverse(&schur),
        }
    }

    /// The initial guess of Newton's method, extrapolated from previous steps.
    #[inline(always)]
    fn guess(&self) -> [Vector; 2] {
        let [a, b, c, d] = &self.past;
        let weights = match self.known {
            0 => [0.0, 0.0, 0.0, 0.0],
            1 => [1.0, 0.0, 0.0, 0.0],
            2 => [2.0, -1.0, 0.0, 0.0],
            3 => [3.0, -3.0, 1.0, 0.0],
            _ => [4.0, -6.0, 4.0, -1.0],
        };
        let [p, q, r, s] = weights;
        let along = |i: usize| {
            let older = add_scaled(&scaled(r, &c[i]), s, &d[i]);
            add_scaled(&add_scaled(&older, q, &b[i]), p, &a[i])
        };
        [along(0), along(1)]
    }

    /// Steps once; the state is unchanged if Newton does not converge in [`MOST_ITERATIONS`].
    #[inline(always)]
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        let rotations = [self.q[0].matrix(), self.q[1].matrix()];
        let u = [
            apply_transposed(&rotations[0], &self.m[0]),
            apply_transposed(&rotations[1], &self.m[1]),
        ];
        let r = transposed_product(&rotations[0], &rotations[1]);
        let [one, two] = &self.halves;
        let mut c = self.guess();
        let mut t = [one.turn(&c[0]), two.turn(&c[1])];
        let mut f = self.residuals(&t, &r, &u);
        let scale = largest(&u[0]).max(largest(&u[1])).max(1.0);
        let mut iterations = 0;
        loop {
            iterations += 1;
            let factors = self.factors(&t, &r);
            // A second correction with the same matrix costs a residual instead of a factorisation; both together converge
            // cubically.
            for _ in 0..2 {
                let change = factors.solve(&f);
                c = [
                    add_scaled(&c[0], -1.0, &change[0]),
                    add_scaled(&c[1], -1.0, &change[1]),
                ];
                t = [one.turn(&c[0]), two.turn(&c[1])];
                f = self.residuals(&t, &r, &u);
            }
            let (first, second) = (largest(&f[0]), largest(&f[1]));
            // Written so that NaN propagates.
            let size = first.max(second) + 0.0 * (first + second);
            if size <= RESIDUAL * scale {
                self.residual = size;
                break;
            }
            if iterations == MOST_ITERATIONS || !size.is_finite() {
                return Err(Unsolvable);
            }
        }
        self.iterations = iterations;
        self.past = [c, self.past[0], self.past[1], self.past[2]];
        self.known += u32::from(self.known < 4);
        // The joint transfers eps (Om_1 - Id) d_1 x (Om_2 - Id) d_2 in space, which conserves the sum of the momenta.
        let moved = [
            apply(&rotations[0], &t[0].moved),
            apply(&rotations[1], &t[1].moved),
        ];
        let handed = scaled(2.0 * self.eps, &cross(&moved[0], &moved[1]));
        self.m = [
            add_scaled(&self.m[0], -1.0, &handed),
            add_scaled(&self.m[1], 1.0, &handed),
        ];
        for (q, turn) in self.q.iter_mut().zip(&t) {
            let [x, y, z] = turn.c;
            // Removes the rounding error of |q|^2 = 1, to first order.
            let correction = 1.5 - 0.5 * q.norm_squared();
            let turned = q.times(&Quaternion([1.0, x, y, z]));
            *q = turned.scaled(correction * turn.inverse.sqrt());
        }
        Ok(())
    }

    /// Newton iterations of the last step.
    pub fn iterations(&self) -> usize {
        self.iterations
    }

    /// Largest residual of the last step.
    pub fn residual(&self) -> f64 {
        self.residual
    }

    /// Attitudes body -> space at the current node.
    pub fn attitudes(&self) -> [Quaternion; 2] {
        [0, 1].map(|i| self.axes[i].leave_attitude(&self.q[i]))
    }

    /// Spatial momenta at the current node.
    pub fn spatial_momenta(&self) -> [Vector; 2] {
        self.m.map(|m| m.map(|c| 2.0 * c / self.h))
    }

    /// Body momenta at the current node.
    pub fn body_momenta(&self) -> [Vector; 2] {
        [0, 1].map(|i| {
            let u = apply_transposed(&self.q[i].matrix(), &self.m[i]);
            self.axes[i].leave(&u).map(|c| 2.0 * c / self.h)
        })
    }

    /// Energy mu . M^-1 mu / 2 with the joint mass matrix of both bodies; oscillates within O(h^2).
    pub fn energy(&self) -> f64 {
        let rotations = [self.q[0].matrix(), self.q[1].matrix()];
        let u = [0, 1].map(|i| apply_transposed(&rotations[i], &self.m[i]));
        let r = transposed_product(&rotations[0], &rotations[1]);
        let rest = [
            self.halves[0].turn(&[0.0; 3]),
            self.halves[1].turn(&[0.0; 3]),
        ];
        // At c = 0 Newton's matrix is the mass matrix.
        let rates = self.factors(&rest, &r).solve(&u);
        2.0 * (dot(&u[0], &rates[0]) + dot(&u[1], &rates[1])) / (self.h * self.h)
    }
}
