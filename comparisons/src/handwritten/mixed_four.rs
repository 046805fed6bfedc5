//! Two bodies, a rigid motion and a point mass coupled by springs. The springs act at the nodes, so that each body moves freely
//! between two kicks. Takes the data, configurations, momenta and h; gives configurations and momenta at the nodes. Rotations use
//! Moser-Veselov; the velocity of the point solves a cubic.

use super::Unsolvable;
use super::attitude::{
    Matrix, Quaternion, Vector, add_scaled, apply, apply_transposed, cross, dot, scaled,
};
use super::principal_axes::PrincipalAxes;
use super::principal_root::Quartic;

/// The data of the four bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Four {
    /// Poinsot matrices of the first body, of the rigid motion and of the second body.
    pub poinsots: [Matrix; 3],
    /// Mass of the rigid motion.
    pub motion_mass: f64,
    /// Mass of the point.
    pub point_mass: f64,
    /// Weight of the quartic term of its kinetic energy.
    pub quartic: f64,
    /// Stiffness of all springs.
    pub stiffness: f64,
    /// Attachment points of the springs in the first body, the rigid motion and the second body.
    pub arms: [Vector; 3],
    /// Acceleration of gravity, which acts on the point.
    pub gravity: Vector,
}

/// Their configurations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Places {
    /// Attitudes of the first body, the rigid motion and the second body.
    pub attitudes: [Quaternion; 3],
    /// Position of the rigid motion.
    pub motion: Vector,
    /// Position of the point.
    pub point: Vector,
}

/// Angular momenta about each centre, and linear momenta, all in spatial axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Momenta {
    /// Angular momenta of the first body, the rigid motion and the second body.
    pub angular: [Vector; 3],
    /// Linear momentum of the rigid motion.
    pub motion: Vector,
    /// Linear momentum of the point.
    pub point: Vector,
}

impl Four {
    /// Torques and forces of springs and gravity in these configurations.
    #[inline(always)]
    pub fn pulled(&self, places: &Places) -> Momenta {
        let Places {
            attitudes,
            motion,
            point,
        } = places;
        let k = self.stiffness;
        let seen = |at: usize| apply(&attitudes[at].matrix(), &self.arms[at]);
        let [arm, held, pointer] = [seen(0), seen(1), seen(2)];
        // Energies k |X - R p|^2/2, k |x + Q s - X|^2/2, and k (q e).(R p).
        let first = scaled(k, &add_scaled(point, -1.0, &arm));
        let end = add_scaled(motion, 1.0, &held);
        let second = scaled(k, &add_scaled(point, -1.0, &end));
        let aligned = scaled(k, &cross(&pointer, &arm));
        let weight = scaled(self.point_mass, &self.gravity);
        Momenta {
            angular: [
                add_scaled(&cross(&arm, &first), 1.0, &aligned),
                cross(&held, &second),
                scaled(-1.0, &aligned),
            ],
            motion: second,
            point: add_scaled(&add_scaled(&weight, -1.0, &first), -1.0, &second),
        }
    }

    /// The velocity of the point with momentum (m + 4 b |v|^2) v.
    #[inline(always)]
    pub fn point_velocity(&self, momentum: &Vector) -> Vector {
        let (m, b) = (self.point_mass, 4.0 * self.quartic);
        let size = dot(momentum, momentum).sqrt();
        let mut v = size / m;
        // Newton's method converges monotonically from above to the root of a convex function.
        for _ in 0..60 {
            let change = (v * (m + b * v * v) - size) / (m + 3.0 * b * v * v);
            v -= change;
            if change.abs() <= 1e-15 * v.abs() {
                break;
            }
        }
        scaled(1.0 / (m + b * v * v), momentum)
    }
}

/// A free body over one step.
#[derive(Clone, Copy, Debug)]
struct Body {
    axes: PrincipalAxes,
    quartic: Quartic,
}

impl Body {
    fn new(poinsot: &Matrix) -> Result<Body, Unsolvable> {
        let axes = PrincipalAxes::new(poinsot)?;
        Ok(Body {
            axes,
            quartic: Quartic::new(&axes.moments),
        })
    }

    /// The rotation of a step from h/2 times the momentum, both in principal axes.
    #[inline(always)]
    fn turn(&self, u: &Vector) -> Result<Quaternion, Unsolvable> {
        let squares = u.map(|c| c * c);
        let a = (squares[0] + squares[1]) + squares[2];
        let kappa = self.quartic.principal_root(&squares, a)?;
        let i = self.axes.moments;
        let d = i.map(|moment| moment - kappa);
        let determinant = d[0] * (d[1] * d[2] + squares[0]) + d[1] * squares[1] + d[2] * squares[2];
        let along =
            |x: usize, y: usize, z: usize| (d[y] * d[z] + a) * u[x] + (i[y] - i[z]) * (u[y] * u[z]);
        let turn = Quaternion([determinant, along(0, 1, 2), along(1, 2, 0), along(2, 0, 1)]);
        Ok(turn.normalised())
    }
}

/// The four moving bodies, in principal axes.
#[derive(Clone, Copy, Debug)]
pub struct MixedFour {
    places: Places,
    momenta: Momenta,
    /// Rates of change at the current node, which the next step uses first.
    rates: Momenta,
    bodies: [Body; 3],
    /// The data, with arms in principal axes.
    given: Four,
    h: f64,
}

impl MixedFour {
    /// Starts a trajectory with the momenta of node 0.
    ///
    /// # Errors
    /// [`Unsolvable`] if the data are not admissible for a rigid body.
    pub fn start(
        given: &Four,
        places: &Places,
        momenta: &Momenta,
        h: f64,
    ) -> Result<MixedFour, Unsolvable> {
        let [one, two, three] = &given.poinsots;
        let bodies = [Body::new(one)?, Body::new(two)?, Body::new(three)?];
        let inside = Four {
            arms: std::array::from_fn(|at| bodies[at].axes.enter(&given.arms[at])),
            ..*given
        };
        let mut four = MixedFour {
            places: Places {
                attitudes: std::array::from_fn(|at| {
                    bodies[at].axes.enter_attitude(&places.attitudes[at])
                }),
                ..*places
            },
            momenta: *momenta,
            rates: *momenta,
            bodies,
            given: inside,
            h,
        };
        four.rates = four.given.pulled(&four.places);
        Ok(four)
    }

    fn kicked(momenta: &Momenta, time: f64, rates: &Momenta) -> Momenta {
        let [a, b, c] = &momenta.angular;
        let [d, e, f] = &rates.angular;
        Momenta {
            angular: [
                add_scaled(a, time, d),
                add_scaled(b, time, e),
                add_scaled(c, time, f),
            ],
            motion: add_scaled(&momenta.motion, time, &rates.motion),
            point: add_scaled(&momenta.point, time, &rates.point),
        }
    }

    /// Steps once; if the step has no solution, the state is unchanged.
    ///
    /// # Errors
    /// [`Unsolvable`] in that case.
    #[inline(always)]
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        let half = 0.5 * self.h;
        let on_edge = Self::kicked(&self.momenta, half, &self.rates);
        let mut turned = self.places.attitudes;
        for (at, body) in self.bodies.iter().enumerate() {
            let own = apply_transposed(&turned[at].matrix(), &on_edge.angular[at]);
            let turn = body.turn(&scaled(half, &own))?;
            turned[at] = turned[at].times(&turn).normalised();
        }
        let velocity = self.given.point_velocity(&on_edge.point);
        self.places = Places {
            attitudes: turned,
            motion: add_scaled(
                &self.places.motion,
                self.h / self.given.motion_mass,
                &on_edge.motion,
            ),
            point: add_scaled(&self.places.point, self.h, &velocity),
        };
        self.rates = self.given.pulled(&self.places);
        self.momenta = Self::kicked(&on_edge, half, &self.rates);
        Ok(())
    }

    /// Configurations at the current node.
    pub fn places(&self) -> Places {
        let inside = &self.places.attitudes;
        Places {
            attitudes: std::array::from_fn(|at| self.bodies[at].axes.leave_attitude(&inside[at])),
            ..self.places
        }
    }

    /// Momenta at the current node.
    pub fn momenta(&self) -> Momenta {
        self.momenta
    }
}
