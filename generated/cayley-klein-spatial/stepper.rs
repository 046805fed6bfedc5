// Written by `clebsch derive --write`. Do not edit.

//! The model [`CayleyKleinSpatial`](struct@CayleyKleinSpatial) with its parameters, states and steps.
#![allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
#![allow(confusable_idents, unused_variables, clippy::all)]
use ::clebsch::emitted::*;
/// The parameters of [`CayleyKleinSpatial`](struct@CayleyKleinSpatial).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CayleyKleinSpatialParameters<T = f64> {
    /// `c`: choice of discretisation: 0 for Moser-Veselov, 1 for the thesis; a number.
    pub c: T,
}
/// Free rigid body in unit quaternions, spatial representation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CayleyKleinSpatial<T = f64> {
    parameters: CayleyKleinSpatialParameters<T>,
}
impl<T: Real> CayleyKleinSpatial<T> {
    /// The text of the model.
    pub const SOURCE: &'static str = "/// Free rigid body in unit quaternions, spatial representation.\npub model CayleyKleinSpatial {\n    /// choice of discretisation: 0 for Moser-Veselov, 1 for the thesis\n    param c: Real;\n    /// attitude, body to space\n    group q: SU<2> velocity w;\n    /// inertia tensor, space frame\n    advected I: Sym<3>;\n    constraint next(q) = w*q;\n    constraint next(I) = rot(w)*I*rot(w)^T;\n    lagrangian = -4*c*re(w)/h + 2*dot(im(w), (I - c*Id)*im(w))/h;\n}";
    /// A hash of the model and the version of clebsch.
    pub const FINGERPRINT: u64 = 4331359141793115439u64;
    /// Checks the parameters.
    ///
    /// # Errors
    /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
    /// is not an admissible factor of the equation of a step. The error names the parameter.
    pub fn new(
        parameters: CayleyKleinSpatialParameters<T>,
    ) -> Result<Self, ParameterError> {
        validate::finite("c", &[parameters.c])?;
        Ok(Self { parameters })
    }
}
/// Initial data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CayleyKleinSpatialInitial<T = f64> {
    /// `q` at node 0: body -> space.
    pub q: UnitQuaternion<T>,
    /// Momentum at node 0, in the space frame.
    pub spatial_momentum: SpatialMomentum<T>,
    /// `I` at node 0.
    pub I: SMatrix<T, 3, 3>,
}
/// The state at one node, which can be compared and saved. The momentum is stored in the space frame, advected quantities as their values at the identity, so that rounding errors do not accumulate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CayleyKleinSpatialState<T = f64> {
    q: UnitQuaternion<T>,
    momentum: SpatialMomentum<T>,
    I: SMatrix<T, 3, 3>,
    node: u64,
}
impl<T: Real> CayleyKleinSpatialState<T> {
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
pub struct CayleyKleinSpatialWorkspace<T = f64> {
    h: T,
    factor: QuaternionBody<T>,
    edge: Edge<T>,
    here: CayleyKleinSpatialState<T>,
}
impl<T: Real> CayleyKleinSpatial<T> {
    /// The state at node 0.
    fn begin(
        &self,
        initial: CayleyKleinSpatialInitial<T>,
    ) -> Result<CayleyKleinSpatialState<T>, StartError> {
        validate::finite("q", &initial.q.components())?;
        validate::finite("spatial_momentum", initial.spatial_momentum.0.as_slice())?;
        validate::finite_entries("I", &initial.I)?;
        let I = {
            let q = initial.q.matrix();
            let I_start = initial.I;
            quaternion_rotation(&q).tr_mul(&(I_start * quaternion_rotation(&q)))
        };
        Ok(CayleyKleinSpatialState {
            q: initial.q,
            momentum: initial.spatial_momentum,
            I,
            node: 0,
        })
    }
    /// The data with which steps of size `h` from `state` begin.
    fn prepared(
        &self,
        state: &CayleyKleinSpatialState<T>,
        h: T,
        _: (),
    ) -> Result<CayleyKleinSpatialWorkspace<T>, StartError> {
        Ok(CayleyKleinSpatialWorkspace {
            h,
            factor: self.factor(state)?,
            edge: self.edge(state, h),
            here: *state,
        })
    }
    /// The factor of the equation at a state, prepared for the solver.
    #[inline(never)]
    fn factor(
        &self,
        state: &CayleyKleinSpatialState<T>,
    ) -> Result<QuaternionBody<T>, ParameterError> {
        let CayleyKleinSpatialParameters { c, .. } = self.parameters;
        let I = state.I;
        QuaternionBody::new("I_k - c Id", I - SMatrix::<T, 3, 3>::identity() * c, c)
    }
    /// One step, in place. Method: one scalar equation per step, because its coefficients are constant in the body frame.
    ///
    /// # Errors
    /// If the step cannot be solved. The error gives numbers and a remedy; the state is unchanged.
    #[inline]
    pub fn step(
        &self,
        state: &mut CayleyKleinSpatialState<T>,
        work: &mut CayleyKleinSpatialWorkspace<T>,
    ) -> Result<(), StepError> {
        let h = work.h;
        if work.here.q != state.q || work.here.momentum != state.momentum
            || !(same(&work.here.I, &state.I))
        {
            if !(same(&work.here.I, &state.I)) {
                work.factor = match self.factor(state) {
                    Ok(factor) => factor,
                    Err(_) => {
                        return Err(StepCause::not_finite("body").at_node(state.node));
                    }
                };
            }
            work.edge = self.edge(state, h);
            work.here = *state;
        }
        let solved = work.edge.free_in_quaternions(&work.factor, h, &state.q);
        let (q_next, edge_next) = match solved {
            Ok(next) => next,
            Err(e) => return Err(self.refused(*state, &work.factor, h, e)),
        };
        (state.q, work.here.q) = (q_next, q_next);
        state.node += 1;
        work.edge = edge_next;
        Ok(())
    }
    /// The edge that begins at this state, for a step `h`.
    #[inline(never)]
    fn edge(&self, state: &CayleyKleinSpatialState<T>, h: T) -> Edge<T> {
        let space = state.momentum.0;
        Edge::new(state.q.rotation().matrix().tr_mul(&space), space)
    }
    /// Reports how far the step exceeds the bound, and a step size that succeeds.
    #[cold]
    fn refused(
        &self,
        state: CayleyKleinSpatialState<T>,
        factor: &QuaternionBody<T>,
        h: T,
        e: QuaternionError,
    ) -> StepError {
        let e = e.with_searched_step(factor, h, |trial| self.edge(&state, trial).body());
        StepCause::from(e).at_node(state.node)
    }
    /// `I` at the node of this state.
    #[inline]
    pub fn I(&self, state: &CayleyKleinSpatialState<T>) -> SMatrix<T, 3, 3> {
        let q = state.q.matrix();
        let I_reference = state.I;
        quaternion_rotation(&q) * (I_reference * quaternion_rotation(&q).transpose())
    }
}
::clebsch::stepper! {
    [] CayleyKleinSpatial,
    CayleyKleinSpatialParameters { c },
    CayleyKleinSpatialInitial { q, spatial_momentum, I },
    CayleyKleinSpatialState { q, momentum, I } at node,
    CayleyKleinSpatialWorkspace { h, factor, edge, here },
    explicit {} nothing symmetric judged { 3 }
    observables { state.q, state.body_momentum, state.spatial_momentum, I }
    invariants { energy, state.spatial_momentum, trace_I1, trace_I2, trace_I3 }
}
/// A configuration at one node; it need not lie on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CayleyKleinSpatialConfiguration<T = f64> {
    /// `q` at the node: body -> space.
    pub q: UnitQuaternion<T>,
    /// `I` at the node, evolved by its constraint.
    pub I: SMatrix<T, 3, 3>,
}
impl<T: Real> CayleyKleinSpatial<T> {
    /// The residual of the discrete Euler-Lagrange equations at the middle of three
    /// consecutive configurations: components are derivatives of the action of the two edges
    /// along the coordinates of the Lie algebra, on the side of the velocity. SO(n): for
    /// `i < j`, row by row, the element with -1 at (i, j) and +1 at (j, i); GL(n): matrix
    /// units, row by row. Components beyond the coordinates are zero. Zero on solutions.
    pub fn balance(
        &self,
        h: T,
        before: &CayleyKleinSpatialConfiguration<T>,
        here: &CayleyKleinSpatialConfiguration<T>,
        after: &CayleyKleinSpatialConfiguration<T>,
    ) -> SVector<T, 3> {
        let CayleyKleinSpatialParameters { c, .. } = self.parameters;
        let I_before = before.I;
        let I = here.I;
        let I_next = after.I;
        let w_before = before.q.spatial_velocity(&here.q).matrix();
        let w = here.q.spatial_velocity(&after.q).matrix();
        let t1 = h.powi(-1);
        let t2 = quaternion_imaginary(&w_before);
        let t3 = quaternion_imaginary(&w);
        let t4 = I * t3;
        quaternion_imaginary(&(w_before * pure_quaternion(&(I_before * t2))))
            * (T::from_f64(2.0) * t1) + t2 * (T::from_f64(2.0) * t1 * c)
            - quaternion_imaginary(&(w_before * w_before)) * (t1 * c)
            + t4.cross(&t3) * (T::from_f64(4.0) * t1)
            - quaternion_imaginary(&w.tr_mul(&pure_quaternion(&t4)))
                * (T::from_f64(2.0) * t1) - t3 * (T::from_f64(2.0) * t1 * c)
            + quaternion_imaginary(&(w * w)) * (t1 * c)
    }
    /// The Hessian of the kinetic energy in all velocities together, at the identity.
    fn inertia_at(&self, state: &CayleyKleinSpatialState<T>) -> SMatrix<T, 3, 3> {
        let I = self.I(state);
        columns(|axis| {
            let ξ: SVector<T, 3> = unit::<T, 3>(axis);
            I * ξ
        })
    }
    /// The kinetic and the potential energy of the limit of small steps, at this node's momentum.
    pub fn energies(&self, state: &CayleyKleinSpatialState<T>) -> (T, T) {
        let momentum = state.spatial_momentum().0;
        let velocity = solve_leading_or_nan(&self.inertia_at(state), &momentum, 3);
        (momentum.dot(&velocity) * T::from_f64(0.5), T::zero())
    }
    /// The physical energy at this node.
    pub fn energy(&self, state: &CayleyKleinSpatialState<T>) -> T {
        let (kinetic, potential) = self.energies(state);
        kinetic + potential
    }
    /// `tr(I_k)`: Casimir: invariant under the group action.
    pub fn trace_I1(&self, state: &CayleyKleinSpatialState<T>) -> T {
        let I = self.I(state);
        I.trace()
    }
    /// `tr(I_k²)`: Casimir: invariant under the group action.
    pub fn trace_I2(&self, state: &CayleyKleinSpatialState<T>) -> T {
        let I = self.I(state);
        (I * I).trace()
    }
    /// `tr(I_k³)`: Casimir: invariant under the group action.
    pub fn trace_I3(&self, state: &CayleyKleinSpatialState<T>) -> T {
        let I = self.I(state);
        (I * (I * I)).trace()
    }
    /// The discrete energy of the edge between two consecutive states, `-4 c re(w_k)/h² + 2 im(w_k)·((I_k - c Id) im(w_k))/h² + 4 c/h²`: bounded, since the stepper is symplectic.
    pub fn discrete_energy(
        &self,
        h: T,
        before: &CayleyKleinSpatialState<T>,
        after: &CayleyKleinSpatialState<T>,
    ) -> T {
        let CayleyKleinSpatialParameters { c, .. } = self.parameters;
        let I = self.I(before);
        let w_matrix = before.q.spatial_velocity(&after.q).matrix();
        let t1 = quaternion_imaginary(&w_matrix);
        T::from_f64(2.0) * t1.dot(&((I - SMatrix::<T, 3, 3>::identity() * c) * t1))
            / (h * h)
            - T::from_f64(4.0) * c * quaternion_real(&less_identity(&w_matrix)) / (h * h)
    }
}
impl CayleyKleinSpatial<f64> {
    /// The scales of all invariants at a state, for steps of `h`.
    fn scales(&self, state: &CayleyKleinSpatialState<f64>, h: f64, out: &mut [f64]) {
        type T = f64;
        let I = self.I(state);
        let m = state.spatial_momentum().0;
        let t1 = (I * I).trace().sqrt();
        let out = put(out, [sum_of_sizes(self.energies(state))]);
        let out = put(out, [m.dot(&m).sqrt(); 3usize]);
        put(out, [T::from_f64(3.0).sqrt() * t1, t1 * t1, t1 * t1 * t1]);
    }
    /// The model as data.
    pub const CARD: Card = Card {
        name: "CayleyKleinSpatial",
        kebab: "cayley-klein-spatial",
        doc: "Free rigid body in unit quaternions, spatial representation.",
        source: Self::SOURCE,
        fingerprint: Self::FINGERPRINT,
        summary: "discrete Lagrangian  -4 c re(w_k)/h + 2 im(w_k)·((I_k - c Id) im(w_k))/h\nmomentum of q        2 im((-c Id/h + ½ quat(2 (I_k - c Id) im(w_k)/h)) w_kᵀ)\nRiccati form         none; in unit quaternions, A = I_k - c Id, β = c\ninvariants           energy, spatial_momentum, trace_I1, trace_I2, trace_I3\ntime reversal        symmetric: second order\ncertificate          10 identities proved by normal form, 6 (of three dimensions) by exact evaluation at random points modulo 2^61 - 1",
        solver: "Unit quaternions: one scalar equation per step, because its coefficients are constant in the body frame",
        parameters: &[
            Kind::Scalar
                .field(
                    "c",
                    [1, 1],
                    "choice of discretisation: 0 for Moser-Veselov, 1 for the thesis",
                ),
        ],
        initial: &[
            Kind::UnitQuaternion.field("q", [4, 1], "attitude, body to space"),
            Kind::SpatialMomentum
                .field("spatial_momentum", [3, 1], "momentum, space frame"),
            Kind::Symmetric.field("I", [3, 3], "inertia tensor, space frame"),
        ],
        observables: &[
            Kind::UnitQuaternion.field("q", [4, 1], "attitude, body to space"),
            Kind::BodyMomentum.field("body_momentum", [3, 1], "momentum, body frame"),
            Kind::SpatialMomentum
                .field("spatial_momentum", [3, 1], "momentum, space frame"),
            Kind::Symmetric.field("I", [3, 3], "inertia tensor, space frame"),
        ],
        invariants: &[
            Invariant::bounded("energy", "½ m_k·ζ, where m_k = I_k ζ", 1usize),
            Invariant::exact("spatial_momentum", "m_k", 3usize),
            Invariant::exact("trace_I1", "tr(I_k)", 1usize),
            Invariant::exact("trace_I2", "tr(I_k²)", 1usize),
            Invariant::exact("trace_I3", "tr(I_k³)", 1usize),
        ],
        discrete_energy: Invariant::bounded(
            "discrete_energy",
            "-4 c re(w_k)/h² + 2 im(w_k)·((I_k - c Id) im(w_k))/h² + 4 c/h²",
            1,
        ),
        ..Card::plain(&open::<Self>, &only_size::<Self>)
    };
}
