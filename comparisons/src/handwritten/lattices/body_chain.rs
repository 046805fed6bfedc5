//! Bodies in a chain or ring whose kinetic energy couples neighbours. Newton's method solves for all Rodrigues vectors together,
//! from zero velocity, with a block-tridiagonal matrix. Takes J, the position d of the coupling mass, the coupling strength eps,
//! attitudes, body momenta and h; gives attitudes and momenta at the nodes. Stores momenta times h/2.

use super::block_tridiagonal::BlockTridiagonal;
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{
    Matrix, Quaternion, Vector, add_outer, add_scaled, apply, apply_transposed, cross, crossed,
    dot, largest, product, scaled, scaled_matrix, transposed_product,
};
use crate::handwritten::principal_axes::PrincipalAxes;

/// The data of the identical bodies, in body axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bodies {
    /// Poinsot (second moment) matrix J.
    pub poinsot: Matrix,
    /// Position d of the mass that couples to the mass of the next body.
    pub arm: Vector,
    /// Strength of the coupling.
    pub eps: f64,
}

/// Maximum number of Newton matrices per step.
const MOST_MATRICES: usize = 20;

/// Convergence threshold relative to the largest Rodrigues vector: a sixteenth of its rounding error.
const LEFT: f64 = f64::EPSILON / 16.0;

/// Rodrigues vector c and derived quantities: with alpha = 1 + |c|^2, G = (I c + c x I c)/alpha and w = (c x d + c x (c x d))/alpha
/// = (Om - Id) d / 2.
#[derive(Clone, Copy, Debug)]
struct Turn {
    inverse: f64,
    momentum: Vector,
    moved: Vector,
}

/// The common data of all bodies, in principal axes.
#[derive(Clone, Copy, Debug)]
struct Body {
    moments: Vector,
    arm: Vector,
    eps: f64,
}

impl Body {
    #[inline(always)]
    fn turn(&self, c: &Vector) -> Turn {
        let inverse = 1.0 / (1.0 + dot(c, c));
        let [i1, i2, i3] = self.moments;
        let b = [i1 * c[0], i2 * c[1], i3 * c[2]];
        let side = cross(c, &self.arm);
        Turn {
            inverse,
            momentum: scaled(inverse, &add_scaled(&b, 1.0, &cross(c, &b))),
            moved: scaled(inverse, &add_scaled(&side, 1.0, &cross(c, &side))),
        }
    }

    /// dG/dc = (I - hat(I c) + hat(c) I - 2 G c^T)/alpha.
    #[inline(always)]
    fn momentum_rate(&self, c: &Vector, t: &Turn) -> Matrix {
        let [i1, i2, i3] = self.moments;
        let [x, y, z] = *c;
        let base = [
            [i1, z * (i3 - i2), y * (i3 - i2)],
            [z * (i1 - i3), i2, x * (i1 - i3)],
            [y * (i2 - i1), x * (i2 - i1), i3],
        ];
        let whole = add_outer(&base, &t.momentum, &scaled(-2.0, c));
        scaled_matrix(t.inverse, &whole)
    }

    /// dw/dc = (-hat(d) + (c.d) Id + c d^T - 2 (d + w) c^T)/alpha.
    #[inline(always)]
    fn moved_rate(&self, c: &Vector, t: &Turn) -> Matrix {
        let d = self.arm;
        let along = dot(c, &d);
        let skew = [
            [along, d[2], -d[1]],
            [-d[2], along, d[0]],
            [d[1], -d[0], along],
        ];
        let both = add_scaled(&d, 1.0, &t.moved);
        let whole = add_outer(&add_outer(&skew, c, &d), &both, &scaled(-2.0, c));
        scaled_matrix(t.inverse, &whole)
    }

    /// -eps d x R^T v.
    #[inline(always)]
    fn dragged(&self, r: &Matrix, v: &Vector) -> Vector {
        scaled(-self.eps, &cross(&self.arm, &apply_transposed(r, v)))
    }

    /// `dragged` applied to each column of a matrix.
    #[inline(always)]
    fn dragging(&self, r: &Matrix, m: &Matrix) -> Matrix {
        crossed(&scaled(-self.eps, &self.arm), &transposed_product(r, m))
    }
}

/// The moving bodies.
#[derive(Clone, Debug)]
pub struct BodyChain {
    body: Body,
    ring: bool,
    q: Vec<Quaternion>,
    rotations: Vec<Matrix>,
    /// Spatial momenta.
    m: Vec<Vector>,
    /// Body momenta.
    known: Vec<Vector>,
    /// Rodrigues vectors of the step.
    c: Vec<Vector>,
    turns: Vec<Turn>,
    /// Spatial w, with one extra entry at either end.
    moved: Vec<Vector>,
    /// Derivative of spatial w with respect to the Rodrigues vector.
    moving: Vec<Matrix>,
    right: Vec<Vector>,
    system: BlockTridiagonal<Matrix>,
    axes: PrincipalAxes,
    h: f64,
}

impl BodyChain {
    /// Starts a trajectory with the body momenta of node 0. A ring needs at least two bodies.
    pub fn start(
        bodies: &Bodies,
        ring: bool,
        attitudes: &[Quaternion],
        body_momenta: &[Vector],
        h: f64,
    ) -> Result<BodyChain, Unsolvable> {
        let axes = PrincipalAxes::new(&bodies.poinsot)?;
        let n = attitudes.len();
        let q: Vec<Quaternion> = attitudes.iter().map(|q| axes.enter_attitude(q)).collect();
        let rotations: Vec<Matrix> = q.iter().map(Quaternion::matrix).collect();
        let m = rotations.iter().zip(body_momenta);
        let m = m.map(|(r, m)| apply(r, &axes.enter(m)).map(|x| 0.5 * h * x));
        Ok(BodyChain {
            body: Body {
                moments: axes.moments,
                arm: axes.enter(&bodies.arm),
                eps: bodies.eps,
            },
            ring,
            q,
            m: m.collect(),
            rotations,
            known: vec![[0.0; 3]; n],
            c: vec![[0.0; 3]; n],
            turns: vec![
                Turn {
                    inverse: 1.0,
                    momentum: [0.0; 3],
                    moved: [0.0; 3],
                };
                n
            ],
            moved: vec![[0.0; 3]; n + 2],
            moving: vec![[[0.0; 3]; 3]; n],
            right: vec![[0.0; 3]; n],
            system: BlockTridiagonal::new(n, ring),
            axes,
            h,
        })
    }

    /// Steps once; the state is unchanged if Newton's method does not converge.
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        for (u, (r, m)) in self
            .known
            .iter_mut()
            .zip(self.rotations.iter().zip(&self.m))
        {
            *u = apply_transposed(r, m);
        }
        self.c.fill([0.0; 3]);
        self.turn();
        self.solve()?;
        for i in 0..self.c.len() {
            let around = add_scaled(&self.moved[i], 1.0, &self.moved[i + 2]);
            let taken = cross(&self.moved[i + 1], &around);
            self.m[i] = add_scaled(&self.m[i], -2.0 * self.body.eps, &taken);
            let ([x, y, z], q) = (self.c[i], self.q[i]);
            // Removes the rounding error of |q|^2 = 1, to first order.
            let correction = 1.5 - 0.5 * q.norm_squared();
            let turned = q.times(&Quaternion([1.0, x, y, z]));
            self.q[i] = turned.scaled(correction * self.turns[i].inverse.sqrt());
            self.rotations[i] = self.q[i].matrix();
        }
        Ok(())
    }

    /// Newton's method. Each matrix serves two corrections, which together converge cubically.
    #[inline(always)]
    fn solve(&mut self) -> Result<(), Unsolvable> {
        let mut bend = 0.0_f64;
        for _ in 0..MOST_MATRICES {
            self.factor();
            let (first, size) = self.correct();
            if !first.is_finite() {
                return Err(Unsolvable);
            }
            // A correction d leaves an error of bend d^2; a second correction e with the same matrix leaves 2 bend d e.
            if bend > 0.0 && bend * first * first <= LEFT * size || size == 0.0 {
                return Ok(());
            }
            self.residuals();
            self.system.solve(&mut self.right);
            let (second, size) = self.correct();
            bend = bend.max(second / (first * first));
            if 2.0 * bend * first * second <= LEFT * size {
                return Ok(());
            }
        }
        Err(Unsolvable)
    }

    /// Computes the quantities that depend on the Rodrigues vectors.
    #[inline(always)]
    fn turn(&mut self) {
        let n = self.c.len();
        for i in 0..n {
            self.turns[i] = self.body.turn(&self.c[i]);
            self.moved[i + 1] = apply(&self.rotations[i], &self.turns[i].moved);
        }
        if self.ring {
            (self.moved[0], self.moved[n + 1]) = (self.moved[n], self.moved[1]);
        }
    }

    /// u_i - G_i + eps d x R_i^T (R_{i-1} w_{i-1} + R_{i+1} w_{i+1}).
    #[inline(always)]
    fn residual(&self, i: usize) -> Vector {
        let around = add_scaled(&self.moved[i], 1.0, &self.moved[i + 2]);
        let drag = self.body.dragged(&self.rotations[i], &around);
        let made = add_scaled(&self.turns[i].momentum, 1.0, &drag);
        add_scaled(&self.known[i], -1.0, &made)
    }

    #[inline(always)]
    fn residuals(&mut self) {
        for i in 0..self.c.len() {
            self.right[i] = self.residual(i);
        }
    }

    /// Computes the residuals and the solution of the linearised system.
    #[inline(always)]
    fn factor(&mut self) {
        let n = self.c.len();
        for i in 0..n {
            let rate = self.body.moved_rate(&self.c[i], &self.turns[i]);
            self.moving[i] = product(&self.rotations[i], &rate);
        }
        for i in 0..n {
            let own = self.body.momentum_rate(&self.c[i], &self.turns[i]);
            let r = &self.rotations[i];
            let before = &self.moving[if i > 0 { i - 1 } else { n - 1 }];
            let after = &self.moving[if i + 1 < n { i + 1 } else { 0 }];
            let (before, after) = (self.body.dragging(r, before), self.body.dragging(r, after));
            self.system.couple(i, before, after);
            self.right[i] = self.residual(i);
            self.system.eliminate(i, &own, &mut self.right);
        }
        self.system.substitute(&mut self.right);
    }

    /// Corrects the Rodrigues vectors; returns the largest correction and the largest vector.
    #[inline(always)]
    fn correct(&mut self) -> (f64, f64) {
        let (mut change, mut size) = (0.0_f64, 0.0_f64);
        // `max` would ignore a NaN.
        let mut lost = 0.0;
        for (c, d) in self.c.iter_mut().zip(&self.right) {
            *c = add_scaled(c, 1.0, d);
            let own = largest(d);
            change = change.max(own);
            lost += 0.0 * own;
            size = size.max(largest(c));
        }
        self.turn();
        (change + lost, size)
    }

    /// Attitudes body -> space at the current node.
    pub fn attitudes(&self) -> impl ExactSizeIterator<Item = Quaternion> {
        self.q.iter().map(|q| self.axes.leave_attitude(q))
    }

    /// Spatial momenta at the current node.
    pub fn spatial_momenta(&self) -> impl ExactSizeIterator<Item = Vector> {
        self.m.iter().map(|m| m.map(|x| 2.0 * x / self.h))
    }
}
