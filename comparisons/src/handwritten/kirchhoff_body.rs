//! Rigid body in an ideal fluid on SE(3). The rotation is Moser-Veselov; the linear velocity of a step is the mean of its
//! translation in the body frames of both ends. Takes J, added masses M, coupling D, weight, position, body momentum and h; gives
//! positions and momenta at the nodes. The state is attitude, position, and spatial momentum about the origin.

use super::Unsolvable;
use super::attitude::{
    Matrix, Quaternion, Vector, add_outer, add_scaled, apply, apply_transposed, cross, crossed,
    dot, hat, inverse, largest, product, scaled, scaled_matrix, sum, transposed,
};

/// The data of a body and its fluid, in body axes except for the vertical.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Submerged {
    /// Poinsot matrix of the rotational inertia, including the fluid.
    pub poinsot: Matrix,
    /// Mass and added masses M, symmetric.
    pub masses: Matrix,
    /// Coupling D: omega . D u is part of the kinetic energy.
    pub coupling: Matrix,
    /// Moment of weight minus buoyancy.
    pub moment: Vector,
    /// Weight minus buoyancy.
    pub weight: f64,
    /// Vertical z, space axes.
    pub up: Vector,
}

/// Angular and linear momentum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Momentum {
    /// Angular momentum: about the body's point in body axes, or about the origin in spatial axes.
    pub angular: Vector,
    /// Linear momentum.
    pub linear: Vector,
}

/// Maximum number of Newton iterations per step, with two corrections each.
const MOST_ITERATIONS: usize = 10;

/// Largest residual of an accepted solution, relative to its largest term or one.
const RESIDUAL: f64 = 1e-15;

/// Quantities of a trial rotation with Rodrigues vector c, alpha = 1 + |c|^2.
#[derive(Clone, Copy, Debug)]
struct Trial {
    c: Vector,
    inverse: f64,
    /// Force conjugate to the velocity, p - c x p.
    force: Vector,
    /// h times the linear velocity.
    u: Vector,
    /// D u.
    carried: Vector,
    /// Translation of the step in the initial body frame, u + c x u.
    y: Vector,
    /// The angular momentum terms divided by alpha.
    spin: Vector,
    residual: Vector,
}

/// A moving body.
#[derive(Clone, Copy, Debug)]
pub struct KirchhoffBody {
    q: Quaternion,
    x: Vector,
    m: Momentum,
    past: [Vector; 4],
    known: u32,
    body: Submerged,
    inertia: Matrix,
    inverse_masses: Matrix,
    h: f64,
}

impl KirchhoffBody {
    /// Starts a trajectory with the body momentum of node 0.
    pub fn start(
        body: &Submerged,
        attitude: &Quaternion,
        position: &Vector,
        momentum: &Momentum,
        h: f64,
    ) -> Result<KirchhoffBody, Unsolvable> {
        let trace = body.poinsot[0][0] + body.poinsot[1][1] + body.poinsot[2][2];
        let inertia = [0, 1, 2]
            .map(|i| [0, 1, 2].map(|j| if i == j { trace } else { 0.0 } - body.poinsot[i][j]));
        let inverse_masses = inverse(&body.masses);
        if !inverse_masses.iter().flatten().all(|x| x.is_finite()) {
            return Err(Unsolvable);
        }
        let rotation = attitude.matrix();
        let linear = apply(&rotation, &momentum.linear);
        let angular = add_scaled(
            &apply(&rotation, &momentum.angular),
            1.0,
            &cross(position, &linear),
        );
        Ok(KirchhoffBody {
            q: *attitude,
            x: *position,
            m: Momentum { angular, linear },
            past: [[0.0; 3]; 4],
            known: 0,
            body: *body,
            inertia,
            inverse_masses,
            h,
        })
    }

    /// Half the change of the spatial momentum at a node: -(h/2) of the weight at x, and its moment.
    #[inline(always)]
    fn kick(&self, rotation: &Matrix, x: &Vector) -> Momentum {
        let half = 0.5 * self.h;
        let body = &self.body;
        let moment = cross(&body.up, &apply(rotation, &body.moment));
        let lever = cross(x, &body.up);
        Momentum {
            angular: add_scaled(&moment, -body.weight, &lever).map(|c| half * c),
            linear: body.up.map(|c| -half * body.weight * c),
        }
    }

    /// The equation of angular momentum for c, with the equation of linear momentum already solved. With f = p - c x p, u = M^-1 (h
    /// f - 2 D^T c / alpha), y = u + c x u and k = D u it reads (2 I c + 2 c x I c + k + c x k - c (c . k)) / alpha + (h/2) y x f =
    /// h pi.
    #[inline(always)]
    fn trial(&self, c: &Vector, p: &Vector, pi: &Vector) -> Trial {
        let inverse = 1.0 / (1.0 + dot(c, c));
        let force = add_scaled(p, -1.0, &cross(c, p));
        let turning = apply_transposed(&self.body.coupling, c);
        let pushed = add_scaled(&scaled(self.h, &force), -2.0 * inverse, &turning);
        let u = apply(&self.inverse_masses, &pushed);
        let carried = apply(&self.body.coupling, &u);
        let y = add_scaled(&u, 1.0, &cross(c, &u));
        let b = add_scaled(&carried, 2.0, &apply(&self.inertia, c));
        let spin = add_scaled(&b, 1.0, &cross(c, &b));
        let spin = scaled(inverse, &add_scaled(&spin, -dot(c, &carried), c));
        let drag = cross(&y, &force);
        Trial {
            c: *c,
            inverse,
            force,
            u,
            carried,
            y,
            spin,
            residual: add_scaled(&add_scaled(&spin, -self.h, pi), 0.5 * self.h, &drag),
        }
    }

    /// The inverse Jacobian of the residual with respect to c.
    #[inline(always)]
    fn tangent(&self, t: &Trial, p: &Vector) -> Matrix {
        let c = &t.c;
        let d = &self.body.coupling;
        // d(2 D^T c / alpha) = (2/alpha) D^T (Id - 2 c c^T / alpha).
        let along = scaled(2.0 * t.inverse, &apply_transposed(d, c));
        let hat_p = hat(p);
        let turning = add_outer(&transposed(d), &scaled(-1.0, &along), c);
        let pushed = sum(&scaled_matrix(self.h, &hat_p), -2.0 * t.inverse, &turning);
        let du = product(&self.inverse_masses, &pushed);
        let dk = product(d, &du);
        let db = sum(&dk, 2.0, &self.inertia);
        let b = add_scaled(&t.carried, 2.0, &apply(&self.inertia, c));
        let mut spin = sum(&db, 1.0, &crossed(c, &db));
        spin = sum(&spin, -1.0, &hat(&b));
        // -d(c (c . k)) = -(c . k) Id - c k^T - c (c^T dk).
        let row = add_scaled(&t.carried, 1.0, &apply_transposed(&dk, c));
        spin = add_outer(&spin, &scaled(-1.0, c), &row);
        let ck = dot(c, &t.carried);
        spin[0][0] -= ck;
        spin[1][1] -= ck;
        spin[2][2] -= ck;
        let dy = sum(&sum(&du, 1.0, &crossed(c, &du)), -1.0, &hat(&t.u));
        let drag = sum(&crossed(&t.y, &hat_p), -1.0, &crossed(&t.force, &dy));
        let spin = scaled_matrix(t.inverse, &add_outer(&spin, &t.spin, &scaled(-2.0, c)));
        let total = sum(&spin, 0.5 * self.h, &drag);
        inverse(&total)
    }

    /// Steps once; the state is unchanged if Newton's method does not converge.
    #[inline(always)]
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        let rotation = self.q.matrix();
        let kick = self.kick(&rotation, &self.x);
        let linear = add_scaled(&self.m.linear, 1.0, &kick.linear);
        let angular = add_scaled(&self.m.angular, 1.0, &kick.angular);
        let p = apply_transposed(&rotation, &linear);
        let pi = apply_transposed(
            &rotation,
            &add_scaled(&angular, -1.0, &cross(&self.x, &linear)),
        );
        let [a, b, c, d] = &self.past;
        let guess = if self.known < 4 {
            [0.0; 3]
        } else {
            let near = add_scaled(&scaled(4.0, a), -6.0, b);
            add_scaled(&add_scaled(&near, 4.0, c), -1.0, d)
        };
        let scale = (self.h * largest(&pi)).max(1.0);
        let mut trial = self.trial(&guess, &p, &pi);
        let mut iterations = 0;
        loop {
            let tangent = self.tangent(&trial, &p);
            // A second correction with the same matrix costs a residual instead of a matrix; both together converge cubically.
            for _ in 0..2 {
                let change = apply(&tangent, &trial.residual);
                trial = self.trial(&add_scaled(&trial.c, -1.0, &change), &p, &pi);
            }
            let size = largest(&trial.residual);
            if size <= RESIDUAL * scale {
                break;
            }
            iterations += 1;
            if iterations == MOST_ITERATIONS || !size.is_finite() {
                return Err(Unsolvable);
            }
        }
        self.past = [trial.c, self.past[0], self.past[1], self.past[2]];
        self.known += u32::from(self.known < 4);
        let [cx, cy, cz] = trial.c;
        // Removes the rounding error of |q|^2 = 1, to first order.
        let correction = 1.5 - 0.5 * self.q.norm_squared();
        self.q = self
            .q
            .times(&Quaternion([1.0, cx, cy, cz]))
            .scaled(correction * trial.inverse.sqrt());
        self.x = add_scaled(&self.x, 1.0, &apply(&rotation, &trial.y));
        let kick = self.kick(&self.q.matrix(), &self.x);
        self.m = Momentum {
            linear: add_scaled(&linear, 1.0, &kick.linear),
            angular: add_scaled(&angular, 1.0, &kick.angular),
        };
        Ok(())
    }

    /// Attitude body -> space at the current node.
    pub fn attitude(&self) -> Quaternion {
        self.q
    }

    /// Position of the body's point.
    pub fn position(&self) -> Vector {
        self.x
    }

    /// Momentum about the origin, space axes.
    pub fn spatial_momentum(&self) -> Momentum {
        self.m
    }

    /// Momentum about the body's point, body axes.
    pub fn body_momentum(&self) -> Momentum {
        let rotation = self.q.matrix();
        let about = add_scaled(&self.m.angular, -1.0, &cross(&self.x, &self.m.linear));
        Momentum {
            angular: apply_transposed(&rotation, &about),
            linear: apply_transposed(&rotation, &self.m.linear),
        }
    }
}
