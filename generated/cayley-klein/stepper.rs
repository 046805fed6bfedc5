// Written by `clebsch derive --write`. Do not edit.

//! The model [`CayleyKlein`](struct@CayleyKlein) with its parameters, states and steps.
#![allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
#![allow(confusable_idents, unused_variables, clippy::all)]
use ::clebsch::emitted::*;
/// The parameters of [`CayleyKlein`](struct@CayleyKlein).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CayleyKleinParameters<T = f64> {
    /// `I`: principal moments of inertia; a matrix of size 3 x 3, diagonal.
    pub I: SMatrix<T, 3, 3>,
    /// `c`: choice of discretisation: 0 for Moser-Veselov, 1 for the thesis; a number.
    pub c: T,
}
/// Free rigid body in unit quaternions.
/// The body momentum is q* m q, a Hopf map of q: its fibres over the sphere of body momenta are circles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CayleyKlein<T = f64> {
    parameters: CayleyKleinParameters<T>,
    factor: QuaternionBody<T>,
}
impl<T: Real> CayleyKlein<T> {
    /// The text of the model.
    pub const SOURCE: &'static str = "/// Free rigid body in unit quaternions.\n/// The body momentum is q* m q, a Hopf map of q: its fibres over the sphere of body momenta are circles.\npub model CayleyKlein {\n    /// principal moments of inertia\n    param I: Diag<3>;\n    /// choice of discretisation: 0 for Moser-Veselov, 1 for the thesis\n    param c: Real;\n    /// attitude, body to space\n    group q: SU<2> velocity W;\n    constraint next(q) = q*W;\n    lagrangian = -4*c*re(W)/h + 2*dot(im(W), (I - c*Id)*im(W))/h;\n}";
    /// A hash of the model and the version of clebsch.
    pub const FINGERPRINT: u64 = 17749404698490029629u64;
    /// Checks the parameters.
    ///
    /// # Errors
    /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
    /// is not an admissible factor of the equation of a step. The error names the parameter.
    pub fn new(parameters: CayleyKleinParameters<T>) -> Result<Self, ParameterError> {
        validate::finite_entries("I", &parameters.I)?;
        validate::diagonal("I", &parameters.I)?;
        validate::finite("c", &[parameters.c])?;
        let CayleyKleinParameters { I, c, .. } = parameters;
        let factor = QuaternionBody::new(
            "I - c Id",
            I - SMatrix::<T, 3, 3>::identity() * c,
            c,
        )?;
        Ok(Self { parameters, factor })
    }
}
/// Initial data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CayleyKleinInitial<T = f64> {
    /// `q` at node 0: body -> space.
    pub q: UnitQuaternion<T>,
    /// Momentum at node 0, in the body frame.
    pub body_momentum: BodyMomentum<T>,
}
/// The state at one node, which can be compared and saved. The momentum is stored in the space frame, advected quantities as their values at the identity, so that rounding errors do not accumulate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CayleyKleinState<T = f64> {
    q: UnitQuaternion<T>,
    momentum: SpatialMomentum<T>,
    node: u64,
}
impl<T: Real> CayleyKleinState<T> {
    /// `q` at this node: body -> space.
    pub fn q(&self) -> UnitQuaternion<T> {
        self.q
    }
    /// The momentum at this node, in the space frame.
    pub fn spatial_momentum(&self) -> SpatialMomentum<T> {
        self.momentum
    }
    /// The momentum at this node, in the body frame.
    pub fn body_momentum(&self) -> BodyMomentum<T> {
        self.momentum.to_body(&self.q)
    }
}
/// The step size, and the momentum of the edge that begins at the state `here`. A step from any other state computes the momentum again.
#[derive(Clone, Copy, Debug)]
pub struct CayleyKleinWorkspace<T = f64> {
    h: T,
    edge: Edge<T>,
    here: CayleyKleinState<T>,
}
impl<T: Real> CayleyKlein<T> {
    /// The data with which steps of size `h` from `state` begin.
    fn prepared(
        &self,
        state: &CayleyKleinState<T>,
        h: T,
        _: (),
    ) -> Result<CayleyKleinWorkspace<T>, StartError> {
        Ok(CayleyKleinWorkspace {
            h,
            edge: self.edge(state, h),
            here: *state,
        })
    }
    /// One step, in place. Method: one scalar equation per step, because its coefficients are constant.
    ///
    /// # Errors
    /// If the step cannot be solved. The error gives numbers and a remedy; the state is unchanged.
    #[inline]
    pub fn step(
        &self,
        state: &mut CayleyKleinState<T>,
        work: &mut CayleyKleinWorkspace<T>,
    ) -> Result<(), StepError> {
        let h = work.h;
        if work.here.q != state.q || work.here.momentum != state.momentum {
            work.edge = self.edge(state, h);
            work.here = *state;
        }
        let solved = work.edge.free_in_quaternions(&self.factor, h, &state.q);
        let (q_next, edge_next) = match solved {
            Ok(next) => next,
            Err(e) => return Err(self.refused(*state, &self.factor, h, e)),
        };
        (state.q, work.here.q) = (q_next, q_next);
        state.node += 1;
        work.edge = edge_next;
        Ok(())
    }
    /// The edge that begins at this state, for a step `h`.
    #[inline(never)]
    fn edge(&self, state: &CayleyKleinState<T>, h: T) -> Edge<T> {
        let turn = state.q.rotation().matrix();
        Edge::new(turn.tr_mul(&state.momentum.0), state.momentum.0)
    }
    /// Reports how far the step exceeds the bound, and a step size that succeeds.
    #[cold]
    fn refused(
        &self,
        state: CayleyKleinState<T>,
        factor: &QuaternionBody<T>,
        h: T,
        e: QuaternionError,
    ) -> StepError {
        let e = e.with_searched_step(factor, h, |trial| self.edge(&state, trial).body());
        StepCause::from(e).at_node(state.node)
    }
}
::clebsch::stepper! {
    [] CayleyKlein,
    CayleyKleinParameters { I, c },
    CayleyKleinInitial { q, body_momentum },
    CayleyKleinState { q, momentum } at node,
    CayleyKleinWorkspace { h, edge, here },
    explicit {} nothing symmetric judged { 3 }
    start { q, momentum = body_momentum.to_space }
    observables { state.q, state.body_momentum, state.spatial_momentum }
    invariants { energy, state.spatial_momentum, momentum_squared }
}
/// A configuration at one node; it need not lie on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CayleyKleinConfiguration<T = f64> {
    /// `q` at the node: body -> space.
    pub q: UnitQuaternion<T>,
}
impl<T: Real> CayleyKlein<T> {
    /// The residual of the discrete Euler-Lagrange equations at the middle of three
    /// consecutive configurations: components are derivatives of the action of the two edges
    /// along the coordinates of the Lie algebra, on the side of the velocity. SO(n): for
    /// `i < j`, row by row, the element with -1 at (i, j) and +1 at (j, i); GL(n): matrix
    /// units, row by row. Components beyond the coordinates are zero. Zero on solutions.
    pub fn balance(
        &self,
        h: T,
        before: &CayleyKleinConfiguration<T>,
        here: &CayleyKleinConfiguration<T>,
        after: &CayleyKleinConfiguration<T>,
    ) -> SVector<T, 3> {
        let CayleyKleinParameters { I, c, .. } = self.parameters;
        let W_before = before.q.body_velocity(&here.q).matrix();
        let W = here.q.body_velocity(&after.q).matrix();
        let t1 = h.powi(-1);
        let t2 = quaternion_imaginary(&W_before);
        let t3 = quaternion_imaginary(&W);
        quaternion_imaginary(
            &W_before.tr_mul(&pure_quaternion(&diagonal_times(&I, &t2))),
        ) * (T::from_f64(2.0) * t1) + t2 * (T::from_f64(2.0) * t1 * c)
            - quaternion_imaginary(&(W_before * W_before)) * (t1 * c)
            - quaternion_imaginary(&(W * pure_quaternion(&diagonal_times(&I, &t3))))
                * (T::from_f64(2.0) * t1) - t3 * (T::from_f64(2.0) * t1 * c)
            + quaternion_imaginary(&(W * W)) * (t1 * c)
    }
    /// The Hessian of the kinetic energy in all velocities together, at the identity.
    fn inertia_at(&self, state: &CayleyKleinState<T>) -> SMatrix<T, 3, 3> {
        let CayleyKleinParameters { I, .. } = self.parameters;
        columns(|axis| {
            let ξ: SVector<T, 3> = unit::<T, 3>(axis);
            diagonal_times(&I, &ξ)
        })
    }
    /// The kinetic and the potential energy of the limit of small steps, at this node's momentum.
    pub fn energies(&self, state: &CayleyKleinState<T>) -> (T, T) {
        let momentum = state.body_momentum().0;
        let velocity = solve_leading_or_nan(&self.inertia_at(state), &momentum, 3);
        (momentum.dot(&velocity) * T::from_f64(0.5), T::zero())
    }
    /// The physical energy at this node.
    pub fn energy(&self, state: &CayleyKleinState<T>) -> T {
        let (kinetic, potential) = self.energies(state);
        kinetic + potential
    }
    /// `μ_k·μ_k`: Casimir: constant on coadjoint orbits.
    pub fn momentum_squared(&self, state: &CayleyKleinState<T>) -> T {
        let μ = state.body_momentum().0;
        μ.dot(&μ)
    }
    /// The discrete energy of the edge between two consecutive states, `-4 c re(W_k)/h² + 2 im(W_k)·((I - c Id) im(W_k))/h² + 4 c/h²`: bounded, since the stepper is symplectic.
    pub fn discrete_energy(
        &self,
        h: T,
        before: &CayleyKleinState<T>,
        after: &CayleyKleinState<T>,
    ) -> T {
        let CayleyKleinParameters { I, c, .. } = self.parameters;
        let W_matrix = before.q.body_velocity(&after.q).matrix();
        let t1 = quaternion_imaginary(&W_matrix);
        T::from_f64(2.0) * t1.dot(&((I - SMatrix::<T, 3, 3>::identity() * c) * t1))
            / (h * h)
            - T::from_f64(4.0) * c * quaternion_real(&less_identity(&W_matrix)) / (h * h)
    }
}
impl CayleyKlein<f64> {
    /// The scales of all invariants at a state, for steps of `h`.
    fn scales(&self, state: &CayleyKleinState<f64>, h: f64, out: &mut [f64]) {
        let q = state.q.matrix();
        let μ = state.body_momentum().0;
        let t1 = quaternion_rotation(&q) * μ;
        let t2 = μ.dot(&μ).sqrt();
        let out = put(out, [sum_of_sizes(self.energies(state))]);
        let out = put(out, [t1.dot(&t1).sqrt(); 3usize]);
        put(out, [t2 * t2]);
    }
    /// The model as data.
    pub const CARD: Card = Card {
        name: "CayleyKlein",
        kebab: "cayley-klein",
        doc: "Free rigid body in unit quaternions. The body momentum is q* m q, a Hopf map of q: its fibres over the sphere of body momenta are circles.",
        source: Self::SOURCE,
        fingerprint: Self::FINGERPRINT,
        summary: "discrete Lagrangian  -4 c re(W_k)/h + 2 im(W_k)·((I - c Id) im(W_k))/h\nmomentum of q        2 im((-c Id/h + ½ quat(2 (I - c Id) im(W_k)/h)) W_kᵀ)\nRiccati form         none; in unit quaternions, A = I - c Id, β = c\ninvariants           energy, spatial_momentum, momentum_squared\ntime reversal        symmetric: second order\ncertificate          4 identities proved by normal form, 6 (of three dimensions) by exact evaluation at random points modulo 2^61 - 1",
        solver: "Unit quaternions: one scalar equation per step, because its coefficients are constant",
        parameters: &[
            Kind::Diagonal.field("I", [3, 3], "principal moments of inertia"),
            Kind::Scalar
                .field(
                    "c",
                    [1, 1],
                    "choice of discretisation: 0 for Moser-Veselov, 1 for the thesis",
                ),
        ],
        initial: &[
            Kind::UnitQuaternion.field("q", [4, 1], "attitude, body to space"),
            Kind::BodyMomentum.field("body_momentum", [3, 1], "momentum, body frame"),
        ],
        observables: &[
            Kind::UnitQuaternion.field("q", [4, 1], "attitude, body to space"),
            Kind::BodyMomentum.field("body_momentum", [3, 1], "momentum, body frame"),
            Kind::SpatialMomentum
                .field("spatial_momentum", [3, 1], "momentum, space frame"),
        ],
        invariants: &[
            Invariant::bounded("energy", "½ μ_k·ζ, where μ_k = I ζ", 1usize),
            Invariant::exact("spatial_momentum", "rot(q_k) μ_k", 3usize),
            Invariant::exact("momentum_squared", "μ_k·μ_k", 1usize),
        ],
        discrete_energy: Invariant::bounded(
            "discrete_energy",
            "-4 c re(W_k)/h² + 2 im(W_k)·((I - c Id) im(W_k))/h² + 4 c/h²",
            1,
        ),
        ..Card::plain(&open::<Self>, &only_size::<Self>)
    };
}
