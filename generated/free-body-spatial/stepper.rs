// Written by `clebsch derive --write`. Do not edit.

//! The model [`FreeBodySpatial`](struct@FreeBodySpatial) with its parameters, states and steps.
#![allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
#![allow(confusable_idents, unused_variables, clippy::all)]
use ::clebsch::emitted::*;
/// The parameters of [`FreeBodySpatial`](struct@FreeBodySpatial).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBodySpatialParameters<T = f64> {
    /// The model has no parameters; this field fixes the scalar type.
    pub scalar: ::core::marker::PhantomData<T>,
}
/// Free rigid body, spatial representation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBodySpatial<T = f64> {
    parameters: FreeBodySpatialParameters<T>,
    method: Method,
}
impl<T: Real> FreeBodySpatial<T> {
    /// The text of the model.
    pub const SOURCE: &'static str = "/// Free rigid body, spatial representation.\npub model FreeBodySpatial {\n    /// attitude, body to space\n    group Λ: SO<3> velocity ω;\n    /// Poinsot (second-moment) matrix, space frame\n    advected J: Sym<3>;\n    /// reconstruction\n    constraint next(Λ) = ω*Λ;\n    /// advection of the second moments\n    constraint next(J) = ω*J*ω^T;\n    lagrangian = -tr(ω*J)/h;\n}";
    /// A hash of the model and the version of clebsch.
    pub const FINGERPRINT: u64 = 9490886532172270337u64;
    /// Checks the parameters.
    ///
    /// # Errors
    /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
    /// is not an admissible factor of the equation of a step. The error names the parameter.
    pub fn new(
        parameters: FreeBodySpatialParameters<T>,
    ) -> Result<Self, ParameterError> {
        Ok(Self {
            parameters,
            method: Method::of_size(3),
        })
    }
}
/// Initial data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBodySpatialInitial<T = f64> {
    /// `Λ` at node 0: body -> space.
    pub Λ: Rotation<T>,
    /// Momentum at node 0, in the space frame.
    pub spatial_momentum: SpatialMomentum<T>,
    /// `J` at node 0.
    pub J: SMatrix<T, 3, 3>,
}
/// The state at one node, which can be compared and saved. The momentum is stored in the space frame, advected quantities as their values at the identity, so that rounding errors do not accumulate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBodySpatialState<T = f64> {
    Λ: Rotation<T>,
    momentum: SpatialMomentum<T>,
    J: SMatrix<T, 3, 3>,
    node: u64,
}
impl<T: Real> FreeBodySpatialState<T> {
    /// `Λ` at this node: body -> space.
    pub fn Λ(&self) -> Rotation<T> {
        self.Λ
    }
    /// The momentum at this node, in the space frame.
    pub fn spatial_momentum(&self) -> SpatialMomentum<T> {
        self.momentum
    }
    /// The momentum at this node, in the body frame.
    pub fn body_momentum(&self) -> BodyMomentum<T> {
        self.momentum.to_body(&self.Λ)
    }
}
/// The step size and the constants of the trajectory. A step from any other state computes the constants again.
#[derive(Clone, Copy, Debug)]
pub struct FreeBodySpatialWorkspace<T = f64> {
    h: T,
    solver: Free<T>,
    J: SMatrix<T, 3, 3>,
}
impl<T: Real> FreeBodySpatial<T> {
    /// The state at node 0.
    fn begin(
        &self,
        initial: FreeBodySpatialInitial<T>,
    ) -> Result<FreeBodySpatialState<T>, StartError> {
        validate::finite("Λ", &initial.Λ.quaternion())?;
        validate::finite("spatial_momentum", initial.spatial_momentum.0.as_slice())?;
        validate::finite_entries("J", &initial.J)?;
        let J = {
            let Λ = initial.Λ.matrix();
            let J_start = initial.J;
            Λ.tr_mul(&(J_start * Λ))
        };
        Ok(FreeBodySpatialState {
            Λ: initial.Λ,
            momentum: initial.spatial_momentum,
            J,
            node: 0,
        })
    }
    /// The data with which steps of size `h` from `state` begin.
    fn prepared(
        &self,
        state: &FreeBodySpatialState<T>,
        h: T,
        choice: Order,
    ) -> Result<FreeBodySpatialWorkspace<T>, StartError> {
        Ok(FreeBodySpatialWorkspace {
            h,
            solver: Free::start_of_order(
                    &self.factor(state)?,
                    &state.Λ,
                    &state.momentum,
                    h,
                    choice,
                )?
                .solved_by(self.method),
            J: state.J,
        })
    }
    /// The factor of the equation at a state, prepared for the solver.
    #[inline(never)]
    fn factor(
        &self,
        state: &FreeBodySpatialState<T>,
    ) -> Result<Poinsot<T>, ParameterError> {
        let J = state.J;
        Poinsot::new(J).map_err(|e| e.in_field("J_k"))
    }
    /// One step, in place. Method: explicit up to the root of one quartic at the start, because the left factor is symmetric and constant in the body frame, and no force acts.
    ///
    /// # Errors
    /// If the step cannot be solved. The error gives numbers and a remedy; the state is unchanged.
    #[inline]
    pub fn step(
        &self,
        state: &mut FreeBodySpatialState<T>,
        work: &mut FreeBodySpatialWorkspace<T>,
    ) -> Result<(), StepError> {
        if !(same(&work.J, &state.J)) {
            let Ok(factor) = self.factor(state) else {
                return Err(StepCause::not_finite("body").at_node(state.node));
            };
            if let Err(e) = work.solver.restart_as(&factor, &state.Λ, &state.momentum) {
                return Err(StepCause::from(e).at_node(state.node));
            }
            work.J = state.J;
        }
        if let Err(e) = work.solver.follow(&mut state.Λ, &state.momentum) {
            return Err(StepCause::from(e).at_node(state.node));
        }
        state.node += 1;
        Ok(())
    }
    /// `J` at the node of this state.
    #[inline]
    pub fn J(&self, state: &FreeBodySpatialState<T>) -> SMatrix<T, 3, 3> {
        let Λ = state.Λ.matrix();
        let J_reference = state.J;
        Λ * (J_reference * Λ.transpose())
    }
}
::clebsch::stepper! {
    [] FreeBodySpatial,
    FreeBodySpatialParameters { scalar },
    FreeBodySpatialInitial { Λ, spatial_momentum, J },
    FreeBodySpatialState { Λ, momentum, J } at node,
    FreeBodySpatialWorkspace { h, solver, J },
    free { Λ, momentum } order modified judged { 3 }
    observables { state.Λ, state.body_momentum, state.spatial_momentum, J }
    invariants { energy, work.Λ.spatial_momentum, trace_J1, trace_J2, trace_J3,
        momentum_quadratic }
}
/// A configuration at one node; it need not lie on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBodySpatialConfiguration<T = f64> {
    /// `Λ` at the node: body -> space.
    pub Λ: Rotation<T>,
    /// `J` at the node, evolved by its constraint.
    pub J: SMatrix<T, 3, 3>,
}
impl<T: Real> FreeBodySpatial<T> {
    /// The residual of the discrete Euler-Lagrange equations at the middle of three
    /// consecutive configurations: component `i` is the derivative of the action of the
    /// two edges when the middle element is rotated about its axis `i` (a body axis on
    /// the body side, a space axis on the spatial side). Zero on solutions.
    pub fn balance(
        &self,
        h: T,
        before: &FreeBodySpatialConfiguration<T>,
        here: &FreeBodySpatialConfiguration<T>,
        after: &FreeBodySpatialConfiguration<T>,
    ) -> SVector<T, 3> {
        let J_before = before.J;
        let J = here.J;
        let J_next = after.J;
        let ω_before = before.Λ.spatial_velocity(&here.Λ).matrix();
        let ω = here.Λ.spatial_velocity(&after.Λ).matrix();
        let t1 = h.powi(-1);
        axial_of_difference(&(ω_before * J_before)) * t1
            - axial_of_difference(&(ω * J)) * t1
    }
    /// The Hessian of the kinetic energy in all velocities together, at the identity.
    fn inertia_at(&self, state: &FreeBodySpatialState<T>) -> SMatrix<T, 3, 3> {
        let J = self.J(state);
        columns(|axis| {
            let ξ: SMatrix<T, 3, 3> = basis::<T>(axis);
            let t1 = vee(&ξ);
            t1 * J.trace() - J * t1
        })
    }
    /// The kinetic and the potential energy of the limit of small steps, at this node's momentum.
    pub fn energies(&self, state: &FreeBodySpatialState<T>) -> (T, T) {
        let momentum = state.spatial_momentum().0;
        let velocity = solve_leading_or_nan(&self.inertia_at(state), &momentum, 3);
        (momentum.dot(&velocity) * T::from_f64(0.5), T::zero())
    }
    /// The physical energy at this node.
    pub fn energy(&self, state: &FreeBodySpatialState<T>) -> T {
        let (kinetic, potential) = self.energies(state);
        kinetic + potential
    }
    /// `tr(J_k)`: Casimir: invariant under the group action.
    pub fn trace_J1(&self, state: &FreeBodySpatialState<T>) -> T {
        let J = self.J(state);
        J.trace()
    }
    /// `tr(J_k²)`: Casimir: invariant under the group action.
    pub fn trace_J2(&self, state: &FreeBodySpatialState<T>) -> T {
        let J = self.J(state);
        (J * J).trace()
    }
    /// `tr(J_k³)`: Casimir: invariant under the group action.
    pub fn trace_J3(&self, state: &FreeBodySpatialState<T>) -> T {
        let J = self.J(state);
        (J * (J * J)).trace()
    }
    /// `m_k·(J_k² m_k)`: Manakov integral, quadratic in the momentum.
    pub fn momentum_quadratic(&self, state: &FreeBodySpatialState<T>) -> T {
        let J = self.J(state);
        let m = state.spatial_momentum().0;
        m.dot(&(J * (J * m)))
    }
    /// The discrete energy of the edge between two consecutive states, `-tr(ω_k J_k)/h² + tr(J_k)/h²`: constant, since up to constants it is the trace of the left factor times the velocity, which the eigenvalues of the Lax matrix determine.
    pub fn discrete_energy(
        &self,
        h: T,
        before: &FreeBodySpatialState<T>,
        after: &FreeBodySpatialState<T>,
    ) -> T {
        let J = self.J(before);
        let ω_matrix = before.Λ.spatial_velocity(&after.Λ).matrix();
        -((J * less_identity(&ω_matrix)).trace() / (h * h))
    }
}
impl FreeBodySpatial<f64> {
    /// The scales of all invariants at a state, for steps of `h`.
    fn scales(&self, state: &FreeBodySpatialState<f64>, h: f64, out: &mut [f64]) {
        type T = f64;
        let J = self.J(state);
        let m = state.spatial_momentum().0;
        let t1 = m.dot(&m).sqrt();
        let t2 = (J * J).trace();
        let t3 = t2.sqrt();
        let out = put(out, [sum_of_sizes(self.energies(state))]);
        let out = put(out, [t1; 3usize]);
        put(out, [T::from_f64(3.0).sqrt() * t3, t3 * t3, t3 * t3 * t3, t2 * (t1 * t1)]);
    }
    /// The model as data.
    pub const CARD: Card = Card {
        name: "FreeBodySpatial",
        kebab: "free-body-spatial",
        doc: "Free rigid body, spatial representation.",
        source: Self::SOURCE,
        fingerprint: Self::FINGERPRINT,
        summary: "discrete Lagrangian  -tr(ω_k J_k)/h\nmomentum of Λ        ω_k J_k/h - J_k ω_kᵀ/h\nRiccati form         exact, C = J_k\ninvariants           energy, spatial_momentum, trace_J1, trace_J2, trace_J3, momentum_quadratic\ntime reversal        symmetric: second order\ncertificate          16 identities proved by normal form",
        solver: "Moser-Veselov: explicit up to the root of one quartic at the start, because the left factor is symmetric and constant in the body frame, and no force acts",
        orders: &[2, 4, 6, 8, 10],
        preprocessed: true,
        parameters: &[],
        initial: &[
            Kind::Rotation.spelt("Λ", "Lambda", [3, 3], "attitude, body to space"),
            Kind::SpatialMomentum
                .field("spatial_momentum", [3, 1], "momentum, space frame"),
            Kind::SecondMoments
                .field("J", [3, 3], "Poinsot (second-moment) matrix, space frame"),
        ],
        observables: &[
            Kind::Rotation.spelt("Λ", "Lambda", [3, 3], "attitude, body to space"),
            Kind::BodyMomentum.field("body_momentum", [3, 1], "momentum, body frame"),
            Kind::SpatialMomentum
                .field("spatial_momentum", [3, 1], "momentum, space frame"),
            Kind::SecondMoments
                .field("J", [3, 3], "Poinsot (second-moment) matrix, space frame"),
        ],
        invariants: &[
            Invariant::exact(
                "energy",
                "½ m_k·ζ, where m_k = -J_k ζ + tr(J_k) ζ",
                1usize,
            ),
            Invariant::exact("spatial_momentum", "m_k", 3usize),
            Invariant::exact("trace_J1", "tr(J_k)", 1usize),
            Invariant::exact("trace_J2", "tr(J_k²)", 1usize),
            Invariant::exact("trace_J3", "tr(J_k³)", 1usize),
            Invariant::exact("momentum_quadratic", "m_k·(J_k² m_k)", 1usize),
        ],
        discrete_energy: Invariant::exact(
            "discrete_energy",
            "-tr(ω_k J_k)/h² + tr(J_k)/h²",
            1,
        ),
        solvers: &Method::NAMES,
        ..Card::plain(&open::<Self>, &only_size::<Self>)
    };
}
