//! Rigid body in a field fixed in space, with the potential split over both ends of a step: second order, self-adjoint. Takes J, a
//! field, attitude, body momentum and h; gives attitude and momenta at the nodes. The state is the attitude quaternion and the
//! spatial momentum of the edge; field values follow from the attitude.

use super::Unsolvable;
use super::attitude::{
    Matrix, Quaternion, Vector, add_scaled, apply, apply_transposed, cross, dot,
};
use super::principal_axes::PrincipalAxes;
use super::principal_root::{self, Quartic};
use super::spaced::{SpacedQuaternion, SpacedVector};

/// A rotation as Id + scale E, so that products with E do not wait for the division in the scale.
#[derive(Clone, Copy, Debug)]
pub struct Turned {
    deviation: Matrix,
    scale: f64,
}

impl Turned {
    /// The rotation of a unit quaternion.
    fn of(q: &Quaternion) -> Turned {
        Turned {
            deviation: q.deviation(),
            scale: 2.0,
        }
    }

    /// The spatial components of a body vector.
    #[inline(always)]
    pub fn forth(&self, v: &Vector) -> Vector {
        add_scaled(v, self.scale, &apply(&self.deviation, v))
    }

    /// The body components of a spatial vector.
    #[inline(always)]
    pub fn back(&self, v: &Vector) -> Vector {
        add_scaled(v, self.scale, &apply_transposed(&self.deviation, v))
    }
}

/// A potential of the attitude.
pub trait Field: Copy {
    /// The same field with body quantities in principal axes and energies multiplied by `factor`.
    fn entered(&self, axes: &PrincipalAxes, factor: f64) -> Self;

    /// The rate of momentum at an attitude: its spatial and its body components.
    fn force(&self, rotation: &Turned) -> (Vector, Vector);

    /// Energy at an attitude.
    fn energy(&self, rotation: &Turned) -> f64;
}

/// Energy Gamma . K Gamma / 2 with Gamma = Lambda^T z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadraticField {
    /// K, symmetric, body axes.
    pub stiffness: Matrix,
    /// z, space axes.
    pub axis: Vector,
}

impl Field for QuadraticField {
    fn entered(&self, axes: &PrincipalAxes, factor: f64) -> QuadraticField {
        let columns = self.stiffness.map(|row| axes.enter(&row));
        // The loop above rotates rows, this one columns; K stays symmetric up to rounding.
        let rows = [0, 1, 2].map(|j| axes.enter(&[columns[0][j], columns[1][j], columns[2][j]]));
        QuadraticField {
            stiffness: [0, 1, 2]
                .map(|i| [0, 1, 2].map(|j| 0.5 * factor * (rows[i][j] + rows[j][i]))),
            axis: self.axis,
        }
    }

    #[inline(always)]
    fn force(&self, rotation: &Turned) -> (Vector, Vector) {
        let gamma = rotation.back(&self.axis);
        let gradient = apply(&self.stiffness, &gamma);
        // The spatial force is normal to z by construction, which preserves m . z.
        let spatial = cross(&self.axis, &rotation.forth(&gradient));
        (spatial, cross(&gamma, &gradient))
    }

    fn energy(&self, rotation: &Turned) -> f64 {
        let gamma = rotation.back(&self.axis);
        0.5 * dot(&gamma, &apply(&self.stiffness, &gamma))
    }
}

/// Energy gU . Gamma - p . B with Gamma = Lambda^T z and B = Lambda^T b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoFields {
    /// gU: weight times support -> centre of mass, body axes.
    pub weight: Vector,
    /// p: dipole moment, body axes.
    pub dipole: Vector,
    /// z, space axes.
    pub up: Vector,
    /// b, space axes.
    pub field: Vector,
}

impl Field for TwoFields {
    fn entered(&self, axes: &PrincipalAxes, factor: f64) -> TwoFields {
        TwoFields {
            weight: axes.enter(&self.weight).map(|c| factor * c),
            dipole: axes.enter(&self.dipole).map(|c| factor * c),
            ..*self
        }
    }

    #[inline(always)]
    fn force(&self, rotation: &Turned) -> (Vector, Vector) {
        // With two fields no spatial momentum component is conserved, so this uses the body form, with one product fewer.
        let force = add_scaled(
            &cross(&rotation.back(&self.up), &self.weight),
            -1.0,
            &cross(&rotation.back(&self.field), &self.dipole),
        );
        (rotation.forth(&force), force)
    }

    fn energy(&self, rotation: &Turned) -> f64 {
        dot(&self.weight, &rotation.back(&self.up)) - dot(&self.dipole, &rotation.back(&self.field))
    }
}

/// A moving body, in principal axes. Stores momenta times h/2 and forces times h^2/4.
#[derive(Clone, Copy, Debug)]
pub struct BodyInField<F> {
    q: SpacedQuaternion,
    /// Spatial momentum of the outgoing edge.
    n: SpacedVector,
    /// Body momentum of the outgoing edge at this node, the only input of the solver.
    u: SpacedVector,
    /// Half the change of the spatial momentum at the node.
    kick: SpacedVector,
    field: F,
    moments: Vector,
    gyration: Vector,
    quartic: Quartic,
    axes: PrincipalAxes,
    h: f64,
}

impl<F: Field> BodyInField<F> {
    /// Starts a trajectory with the body momentum of node 0.
    pub fn start(
        poinsot: &Matrix,
        field: &F,
        attitude: &Quaternion,
        body_momentum: &Vector,
        h: f64,
    ) -> Result<BodyInField<F>, Unsolvable> {
        let axes = PrincipalAxes::new(poinsot)?;
        let i = axes.moments;
        let q = axes.enter_attitude(attitude);
        let rotation = Turned::of(&q);
        let field = field.entered(&axes, 0.25 * h * h);
        let momentum = axes.enter(body_momentum).map(|c| 0.5 * h * c);
        let (kick, body_kick) = field.force(&rotation);
        Ok(BodyInField {
            q: SpacedQuaternion::new(q),
            n: SpacedVector::new(add_scaled(&rotation.forth(&momentum), 1.0, &kick)),
            u: SpacedVector::new(add_scaled(&momentum, 1.0, &body_kick)),
            kick: SpacedVector::new(kick),
            field,
            moments: i,
            gyration: [i[1] - i[2], i[2] - i[0], i[0] - i[1]],
            quartic: Quartic::new(&i),
            axes,
            h,
        })
    }

    /// Steps once; if the equation has no solution, the state is unchanged.
    #[inline(always)]
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        let u = self.u.get();
        let squares = u.map(|c| c * c);
        let a = (squares[0] + squares[1]) + squares[2];
        let kappa = self.quartic.principal_root(&squares, a)?;
        let turn = principal_root::turn(&self.moments, &self.gyration, &u, &squares, a, kappa);
        let q = self.q.get();
        let unscaled = q.times(&turn);
        // The numerator removes the rounding error of |q|^2 = 1, to first order.
        let correction = 2.0 - q.norm_squared();
        let scale = (correction + correction) / turn.norm_squared();
        let rotation = Turned {
            deviation: unscaled.deviation(),
            scale,
        };
        let n = self.n.get();
        let (kick, body_kick) = self.field.force(&rotation);
        let carried = rotation.back(&n);
        self.u.set(add_scaled(&carried, 2.0, &body_kick));
        self.n.set(add_scaled(&n, 2.0, &kick));
        self.kick.set(kick);
        self.q.set(unscaled.scaled((0.5 * scale).sqrt()));
        Ok(())
    }

    /// Attitude body -> space at the current node.
    pub fn attitude(&self) -> Quaternion {
        self.axes.leave_attitude(&self.q.get())
    }

    /// Spatial momentum m_k at the current node.
    pub fn spatial_momentum(&self) -> Vector {
        add_scaled(&self.n.get(), -1.0, &self.kick.get()).map(|c| 2.0 * c / self.h)
    }

    /// Body momentum mu_k at the current node.
    pub fn body_momentum(&self) -> Vector {
        apply_transposed(&self.attitude().matrix(), &self.spatial_momentum())
    }

    /// The kinetic energy mu . I^-1 mu / 2 plus the field energy; oscillates within O(h^2).
    pub fn energy(&self) -> f64 {
        let rotation = Turned::of(&self.q.get());
        let mu = rotation.back(&self.spatial_momentum());
        let [x, y, z] = [0, 1, 2].map(|i| mu[i] * mu[i] / self.moments[i]);
        0.5 * (x + y + z) + self.field.energy(&rotation) * 4.0 / (self.h * self.h)
    }
}
