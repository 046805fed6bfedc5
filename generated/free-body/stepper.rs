// Written by `clebsch derive --write`. Do not edit.

//! The model [`FreeBody`](struct@FreeBody) with its parameters, states and steps.
#![allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
#![allow(confusable_idents, unused_variables, clippy::all)]
use ::clebsch::emitted::*;
/// The parameters of [`FreeBody`](struct@FreeBody).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBodyParameters<T = f64> {
    /// `J`: Poinsot (second-moment) matrix; a matrix of size 3 x 3, symmetric.
    pub J: SMatrix<T, 3, 3>,
}
/// Free rigid body, body representation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBody<T = f64> {
    parameters: FreeBodyParameters<T>,
    factor: Poinsot<T>,
    method: Method,
}
impl<T: Real> FreeBody<T> {
    /// The text of the model.
    pub const SOURCE: &'static str = "/// Free rigid body, body representation.\npub model FreeBody {\n    /// Poinsot (second-moment) matrix\n    param J: Sym<3>;\n    /// attitude, body to space\n    group Λ: SO<3> velocity Ω;\n    constraint next(Λ) = Λ*Ω;\n    lagrangian = -tr(J*Ω)/h;\n}";
    /// A hash of the model and the version of clebsch.
    pub const FINGERPRINT: u64 = 4354950754132218899u64;
    /// Checks the parameters.
    ///
    /// # Errors
    /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
    /// is not an admissible factor of the equation of a step. The error names the parameter.
    pub fn new(parameters: FreeBodyParameters<T>) -> Result<Self, ParameterError> {
        validate::finite_entries("J", &parameters.J)?;
        validate::symmetric("J", &parameters.J)?;
        let FreeBodyParameters { J, .. } = parameters;
        let factor = Poinsot::new(J).map_err(|e| e.in_field("J"))?;
        Ok(Self {
            parameters,
            factor,
            method: Method::of_size(3),
        })
    }
}
/// Initial data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBodyInitial<T = f64> {
    /// `Λ` at node 0: body -> space.
    pub Λ: Rotation<T>,
    /// Momentum at node 0, in the body frame.
    pub body_momentum: BodyMomentum<T>,
}
/// The state at one node, which can be compared and saved. The momentum is stored in the space frame, advected quantities as their values at the identity, so that rounding errors do not accumulate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBodyState<T = f64> {
    Λ: Rotation<T>,
    momentum: SpatialMomentum<T>,
    node: u64,
}
impl<T: Real> FreeBodyState<T> {
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
pub struct FreeBodyWorkspace<T = f64> {
    h: T,
    solver: Free<T>,
}
impl<T: Real> FreeBody<T> {
    /// The data with which steps of size `h` from `state` begin.
    fn prepared(
        &self,
        state: &FreeBodyState<T>,
        h: T,
        choice: Order,
    ) -> Result<FreeBodyWorkspace<T>, StartError> {
        Ok(FreeBodyWorkspace {
            h,
            solver: Free::start_of_order(
                    &self.factor,
                    &state.Λ,
                    &state.momentum,
                    h,
                    choice,
                )?
                .solved_by(self.method),
        })
    }
    /// One step, in place. Method: explicit up to the root of one quartic at the start, because the left factor is symmetric and constant, and no force acts.
    ///
    /// # Errors
    /// If the step cannot be solved. The error gives numbers and a remedy; the state is unchanged.
    #[inline]
    pub fn step(
        &self,
        state: &mut FreeBodyState<T>,
        work: &mut FreeBodyWorkspace<T>,
    ) -> Result<(), StepError> {
        if let Err(e) = work.solver.follow(&mut state.Λ, &state.momentum) {
            return Err(StepCause::from(e).at_node(state.node));
        }
        state.node += 1;
        Ok(())
    }
}
::clebsch::stepper! {
    [] FreeBody,
    FreeBodyParameters { J },
    FreeBodyInitial { Λ, body_momentum },
    FreeBodyState { Λ, momentum } at node,
    FreeBodyWorkspace { h, solver },
    free { Λ, momentum } order modified judged { 3 }
    start { Λ, momentum = body_momentum.to_space }
    observables { state.Λ, state.body_momentum, state.spatial_momentum }
    invariants { energy, work.Λ.spatial_momentum, momentum_squared, momentum_quadratic }
}
/// A configuration at one node; it need not lie on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBodyConfiguration<T = f64> {
    /// `Λ` at the node: body -> space.
    pub Λ: Rotation<T>,
}
impl<T: Real> FreeBody<T> {
    /// The residual of the discrete Euler-Lagrange equations at the middle of three
    /// consecutive configurations: component `i` is the derivative of the action of the
    /// two edges when the middle element is rotated about its axis `i` (a body axis on
    /// the body side, a space axis on the spatial side). Zero on solutions.
    pub fn balance(
        &self,
        h: T,
        before: &FreeBodyConfiguration<T>,
        here: &FreeBodyConfiguration<T>,
        after: &FreeBodyConfiguration<T>,
    ) -> SVector<T, 3> {
        let FreeBodyParameters { J, .. } = self.parameters;
        let Ω_before = before.Λ.body_velocity(&here.Λ).matrix();
        let Ω = here.Λ.body_velocity(&after.Λ).matrix();
        let t1 = h.powi(-1);
        axial_of_difference(&(J * Ω_before)) * t1
            + axial_of_difference(&(J * Ω.transpose())) * t1
    }
    /// The Hessian of the kinetic energy in all velocities together, at the identity.
    fn inertia_at(&self, state: &FreeBodyState<T>) -> SMatrix<T, 3, 3> {
        let FreeBodyParameters { J, .. } = self.parameters;
        columns(|axis| {
            let ξ: SMatrix<T, 3, 3> = basis::<T>(axis);
            let t1 = vee(&ξ);
            t1 * J.trace() - J * t1
        })
    }
    /// The kinetic and the potential energy of the limit of small steps, at this node's momentum.
    pub fn energies(&self, state: &FreeBodyState<T>) -> (T, T) {
        let momentum = state.body_momentum().0;
        let velocity = solve_leading_or_nan(&self.inertia_at(state), &momentum, 3);
        (momentum.dot(&velocity) * T::from_f64(0.5), T::zero())
    }
    /// The physical energy at this node.
    pub fn energy(&self, state: &FreeBodyState<T>) -> T {
        let (kinetic, potential) = self.energies(state);
        kinetic + potential
    }
    /// `μ_k·μ_k`: Casimir: constant on coadjoint orbits.
    pub fn momentum_squared(&self, state: &FreeBodyState<T>) -> T {
        let μ = state.body_momentum().0;
        μ.dot(&μ)
    }
    /// `μ_k·(J² μ_k)`: Manakov integral, quadratic in the momentum.
    pub fn momentum_quadratic(&self, state: &FreeBodyState<T>) -> T {
        let FreeBodyParameters { J, .. } = self.parameters;
        let μ = state.body_momentum().0;
        μ.dot(&(J * (J * μ)))
    }
    /// The discrete energy of the edge between two consecutive states, `tr(J)/h² - tr(J Ω_k)/h²`: constant, since up to constants it is the trace of the left factor times the velocity, which the eigenvalues of the Lax matrix determine.
    pub fn discrete_energy(
        &self,
        h: T,
        before: &FreeBodyState<T>,
        after: &FreeBodyState<T>,
    ) -> T {
        let FreeBodyParameters { J, .. } = self.parameters;
        let Ω_matrix = before.Λ.body_velocity(&after.Λ).matrix();
        -((J * less_identity(&Ω_matrix)).trace() / (h * h))
    }
}
impl FreeBody<f64> {
    /// The scales of all invariants at a state, for steps of `h`.
    fn scales(&self, state: &FreeBodyState<f64>, h: f64, out: &mut [f64]) {
        let FreeBodyParameters { J, .. } = self.parameters;
        let Λ = state.Λ.matrix();
        let μ = state.body_momentum().0;
        let t1 = Λ * μ;
        let t2 = μ.dot(&μ).sqrt();
        let out = put(out, [sum_of_sizes(self.energies(state))]);
        let out = put(out, [t1.dot(&t1).sqrt(); 3usize]);
        put(out, [t2 * t2, (J * J).trace() * (t2 * t2)]);
    }
    /// The model as data.
    pub const CARD: Card = Card {
        name: "FreeBody",
        kebab: "free-body",
        doc: "Free rigid body, body representation.",
        source: Self::SOURCE,
        fingerprint: Self::FINGERPRINT,
        summary: "discrete Lagrangian  -tr(J Ω_k)/h\nmomentum of Λ        -J Ω_kᵀ/h + Ω_k J/h\nRiccati form         exact, C = J\ninvariants           energy, spatial_momentum, momentum_squared, momentum_quadratic\ntime reversal        symmetric: second order\ncertificate          10 identities proved by normal form",
        solver: "Moser-Veselov: explicit up to the root of one quartic at the start, because the left factor is symmetric and constant, and no force acts",
        orders: &[2, 4, 6, 8, 10],
        preprocessed: true,
        parameters: &[
            Kind::SecondMoments.field("J", [3, 3], "Poinsot (second-moment) matrix"),
        ],
        initial: &[
            Kind::Rotation.spelt("Λ", "Lambda", [3, 3], "attitude, body to space"),
            Kind::BodyMomentum.field("body_momentum", [3, 1], "momentum, body frame"),
        ],
        observables: &[
            Kind::Rotation.spelt("Λ", "Lambda", [3, 3], "attitude, body to space"),
            Kind::BodyMomentum.field("body_momentum", [3, 1], "momentum, body frame"),
            Kind::SpatialMomentum
                .field("spatial_momentum", [3, 1], "momentum, space frame"),
        ],
        invariants: &[
            Invariant::exact(
                "energy",
                "½ μ_k·ζ, where μ_k = -J ζ + tr(J) ζ",
                1usize,
            ),
            Invariant::exact("spatial_momentum", "Λ_k μ_k", 3usize),
            Invariant::exact("momentum_squared", "μ_k·μ_k", 1usize),
            Invariant::exact("momentum_quadratic", "μ_k·(J² μ_k)", 1usize),
        ],
        discrete_energy: Invariant::exact(
            "discrete_energy",
            "tr(J)/h² - tr(J Ω_k)/h²",
            1,
        ),
        solvers: &Method::NAMES,
        ..Card::plain(&open::<Self>, &only_size::<Self>)
    };
}
