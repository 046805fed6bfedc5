// Written by `clebsch derive --write`. Do not edit.

//! The model [`BodyInQuadraticField`](struct@BodyInQuadraticField) with its parameters, states and steps.
#![allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
#![allow(confusable_idents, unused_variables, clippy::all)]
use ::clebsch::emitted::*;
/// The parameters of [`BodyInQuadraticField`](struct@BodyInQuadraticField).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyInQuadraticFieldParameters<T = f64> {
    /// `J`: Poinsot (second-moment) matrix; a matrix of size 3 x 3, symmetric.
    pub J: SMatrix<T, 3, 3>,
    /// `K`: matrix of the field, body frame: potential energy ½ Γ·KΓ; a matrix of size 3 x 3, symmetric.
    pub K: SMatrix<T, 3, 3>,
}
/// Rigid body about a fixed point in a quadratic field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyInQuadraticField<T = f64> {
    parameters: BodyInQuadraticFieldParameters<T>,
    factor: Poinsot<T>,
    method: Method,
}
impl<T: Real> BodyInQuadraticField<T> {
    /// The text of the model.
    pub const SOURCE: &'static str = "/// Rigid body about a fixed point in a quadratic field.\npub model BodyInQuadraticField {\n    /// Poinsot (second-moment) matrix\n    param J: Sym<3>;\n    /// matrix of the field, body frame: potential energy ½ Γ·KΓ\n    param K: Sym<3>;\n    /// attitude, body to space\n    group Λ: SO<3> velocity Ω;\n    /// axis of the field, body frame\n    advected Γ: Vec<3>;\n    /// reconstruction\n    constraint next(Λ) = Λ*Ω;\n    /// the axis is fixed in space\n    constraint next(Γ) = Ω^T*Γ;\n    lagrangian = -tr(J*Ω)/h - (1/2)*h*dot(Γ, K*Γ);\n}";
    /// A hash of the model and the version of clebsch.
    pub const FINGERPRINT: u64 = 15875467048490531730u64;
    /// Checks the parameters.
    ///
    /// # Errors
    /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
    /// is not an admissible factor of the equation of a step. The error names the parameter.
    pub fn new(
        parameters: BodyInQuadraticFieldParameters<T>,
    ) -> Result<Self, ParameterError> {
        validate::finite_entries("J", &parameters.J)?;
        validate::symmetric("J", &parameters.J)?;
        validate::finite_entries("K", &parameters.K)?;
        validate::symmetric("K", &parameters.K)?;
        let BodyInQuadraticFieldParameters { J, .. } = parameters;
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
pub struct BodyInQuadraticFieldInitial<T = f64> {
    /// `Λ` at node 0: body -> space.
    pub Λ: Rotation<T>,
    /// Momentum at node 0, in the body frame.
    pub body_momentum: BodyMomentum<T>,
    /// `Γ` at node 0.
    pub Γ: SVector<T, 3>,
}
/// The state at one node, which can be compared and saved. The momentum is stored in the space frame, advected quantities as their values at the identity, so that rounding errors do not accumulate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyInQuadraticFieldState<T = f64> {
    Λ: Rotation<T>,
    momentum: SpatialMomentum<T>,
    Γ: SVector<T, 3>,
    node: u64,
}
impl<T: Real> BodyInQuadraticFieldState<T> {
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
/// The step size, the solver, and the momentum of the edge that begins at the state `here`. A step from any other state computes the momentum again.
#[derive(Clone, Copy, Debug)]
pub struct BodyInQuadraticFieldWorkspace<T = f64> {
    h: T,
    method: Method,
    edge: Edge<T>,
    here: BodyInQuadraticFieldState<T>,
}
impl<T: Real> BodyInQuadraticField<T> {
    /// The state at node 0.
    fn begin(
        &self,
        initial: BodyInQuadraticFieldInitial<T>,
    ) -> Result<BodyInQuadraticFieldState<T>, StartError> {
        validate::finite("Λ", &initial.Λ.quaternion())?;
        validate::finite("body_momentum", initial.body_momentum.0.as_slice())?;
        validate::finite("Γ", initial.Γ.as_slice())?;
        let Γ = {
            let Λ = initial.Λ.matrix();
            let Γ_start = initial.Γ;
            Λ * Γ_start
        };
        Ok(BodyInQuadraticFieldState {
            Λ: initial.Λ,
            momentum: initial.body_momentum.to_space(&initial.Λ),
            Γ,
            node: 0,
        })
    }
    /// The edge that begins at this state, for a step `h`.
    #[inline(never)]
    fn edge(&self, state: &BodyInQuadraticFieldState<T>, h: T) -> Edge<T> {
        let BodyInQuadraticFieldParameters { K, .. } = self.parameters;
        let Λ = state.Λ.matrix();
        let Γ_reference = state.Γ;
        let Γ = Λ.tr_mul(&Γ_reference);
        let kick = (K * Γ).cross(&Γ) * (T::from_f64(0.5) * h);
        Edge::new(Λ.tr_mul(&state.momentum.0) - kick, state.momentum.0 - Λ * kick)
    }
    /// The next node and the edge that begins there, given the attitude there.
    #[inline(always)]
    fn arrived(
        &self,
        state: &BodyInQuadraticFieldState<T>,
        edge: &Edge<T>,
        h: T,
        Λ_moved: TurnedRotation<T>,
    ) -> Moving<T> {
        let BodyInQuadraticFieldParameters { K, .. } = self.parameters;
        let Λ_next = Λ_moved.matrix();
        let Γ_reference = state.Γ;
        let Γ_next = Λ_next.tr_mul(&Γ_reference);
        let space = edge.space();
        let torque = -((K * Γ_next).cross(&Γ_next) * h);
        let kick = Λ_next * torque;
        Moving {
            attitude: Λ_moved.rotation(),
            momentum: SpatialMomentum(space + kick * T::from_f64(0.5)),
            edge: Edge::new(Λ_next.tr_mul(&space) + torque, space + kick),
        }
    }
    /// `Γ` at the node of this state.
    #[inline]
    pub fn Γ(&self, state: &BodyInQuadraticFieldState<T>) -> SVector<T, 3> {
        let Λ = state.Λ.matrix();
        let Γ_reference = state.Γ;
        Λ.tr_mul(&Γ_reference)
    }
}
::clebsch::stepper! {
    [] BodyInQuadraticField,
    BodyInQuadraticFieldParameters { J, K },
    BodyInQuadraticFieldInitial { Λ, body_momentum, Γ },
    BodyInQuadraticFieldState { Λ, momentum, Γ } at node,
    BodyInQuadraticFieldWorkspace { h, method, edge, here },
    forced { Λ, momentum, Γ } solver symmetric judged { 3 }
    ("explicit up to the root of one quartic per step, because the left factor is symmetric and constant")
    observables { state.Λ, state.body_momentum, state.spatial_momentum, Γ }
    invariants { energy, momentum_Gamma, Gamma_squared }
}
/// A configuration at one node; it need not lie on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyInQuadraticFieldConfiguration<T = f64> {
    /// `Λ` at the node: body -> space.
    pub Λ: Rotation<T>,
    /// `Γ` at the node, evolved by its constraint.
    pub Γ: SVector<T, 3>,
}
impl<T: Real> BodyInQuadraticField<T> {
    /// The residual of the discrete Euler-Lagrange equations at the middle of three
    /// consecutive configurations: component `i` is the derivative of the action of the
    /// two edges when the middle element is rotated about its axis `i` (a body axis on
    /// the body side, a space axis on the spatial side). Zero on solutions.
    pub fn balance(
        &self,
        h: T,
        before: &BodyInQuadraticFieldConfiguration<T>,
        here: &BodyInQuadraticFieldConfiguration<T>,
        after: &BodyInQuadraticFieldConfiguration<T>,
    ) -> SVector<T, 3> {
        let BodyInQuadraticFieldParameters { J, K, .. } = self.parameters;
        let Γ_before = before.Γ;
        let Γ = here.Γ;
        let Γ_next = after.Γ;
        let Ω_before = before.Λ.body_velocity(&here.Λ).matrix();
        let Ω = here.Λ.body_velocity(&after.Λ).matrix();
        let t1 = h.powi(-1);
        axial_of_difference(&(J * Ω_before)) * t1 - (K * Γ).cross(&Γ) * h
            + axial_of_difference(&(J * Ω.transpose())) * t1
    }
    /// The Hessian of the kinetic energy in all velocities together, at the identity.
    fn inertia_at(&self, state: &BodyInQuadraticFieldState<T>) -> SMatrix<T, 3, 3> {
        let BodyInQuadraticFieldParameters { J, .. } = self.parameters;
        columns(|axis| {
            let ξ: SMatrix<T, 3, 3> = basis::<T>(axis);
            let t1 = vee(&ξ);
            t1 * J.trace() - J * t1
        })
    }
    /// The kinetic and the potential energy of the limit of small steps, at this node's momentum.
    pub fn energies(&self, state: &BodyInQuadraticFieldState<T>) -> (T, T) {
        let BodyInQuadraticFieldParameters { K, .. } = self.parameters;
        let Γ = self.Γ(state);
        let momentum = state.body_momentum().0;
        let velocity = solve_leading_or_nan(&self.inertia_at(state), &momentum, 3);
        (
            momentum.dot(&velocity) * T::from_f64(0.5),
            T::from_f64(0.5) * Γ.dot(&(K * Γ)),
        )
    }
    /// The physical energy at this node.
    pub fn energy(&self, state: &BodyInQuadraticFieldState<T>) -> T {
        let (kinetic, potential) = self.energies(state);
        kinetic + potential
    }
    /// `μ_k·Γ_k`: Casimir: the Kelvin-Noether quantity of the advected quantities.
    pub fn momentum_Gamma(&self, state: &BodyInQuadraticFieldState<T>) -> T {
        let Γ = self.Γ(state);
        let μ = state.body_momentum().0;
        μ.dot(&Γ)
    }
    /// `Γ_k·Γ_k`: Casimir: invariant under the group action.
    pub fn Gamma_squared(&self, state: &BodyInQuadraticFieldState<T>) -> T {
        let Γ = self.Γ(state);
        Γ.dot(&Γ)
    }
    /// The discrete energy of the edge between two consecutive states, `tr(J)/h² - tr(J Ω_k)/h² + ¼ Γ_k·(K Γ_k) + ¼ Γ_{k+1}·(K Γ_{k+1})`: bounded, since the stepper is symplectic.
    pub fn discrete_energy(
        &self,
        h: T,
        before: &BodyInQuadraticFieldState<T>,
        after: &BodyInQuadraticFieldState<T>,
    ) -> T {
        let BodyInQuadraticFieldParameters { J, K, .. } = self.parameters;
        let Γ = self.Γ(before);
        let Γ_next = self.Γ(after);
        let Ω_matrix = before.Λ.body_velocity(&after.Λ).matrix();
        T::from_f64(0.25) * Γ.dot(&(K * Γ))
            + T::from_f64(0.25) * Γ_next.dot(&(K * Γ_next))
            - (J * less_identity(&Ω_matrix)).trace() / (h * h)
    }
}
impl BodyInQuadraticField<f64> {
    /// The scales of all invariants at a state, for steps of `h`.
    fn scales(&self, state: &BodyInQuadraticFieldState<f64>, h: f64, out: &mut [f64]) {
        let BodyInQuadraticFieldParameters { K, .. } = self.parameters;
        let Γ = self.Γ(state);
        let energies = self.energies(state);
        let s1 = Γ.dot(&Γ).sqrt();
        let impulse = (h * h).sqrt() * (K * K).trace().sqrt() * s1 * s1;
        let state = &BodyInQuadraticFieldState {
            momentum: SpatialMomentum(not_less(state.momentum.0, (0, 3), impulse)),
            ..*state
        };
        let energy = size_of_energy(energies, self.energies(state));
        let μ = state.body_momentum().0;
        let t1 = Γ.dot(&Γ).sqrt();
        put(out, [energy, μ.dot(&μ).sqrt() * t1, t1 * t1]);
    }
    /// The model as data.
    pub const CARD: Card = Card {
        name: "BodyInQuadraticField",
        kebab: "body-in-quadratic-field",
        doc: "Rigid body about a fixed point in a quadratic field.",
        source: Self::SOURCE,
        fingerprint: Self::FINGERPRINT,
        summary: "discrete Lagrangian  -tr(J Ω_k)/h - ¼ h Γ_k·(K Γ_k) - ¼ h Γ_{k+1}·(K Γ_{k+1})\nmomentum of Λ        -J Ω_kᵀ/h + Ω_k J/h\nRiccati form         exact, C = J\ninvariants           energy, momentum_Gamma, Gamma_squared\ntime reversal        symmetric: second order\ncertificate          17 identities proved by normal form",
        solver: "Moser-Veselov: explicit up to the root of one quartic per step, because the left factor is symmetric and constant",
        parameters: &[
            Kind::SecondMoments.field("J", [3, 3], "Poinsot (second-moment) matrix"),
            Kind::Symmetric
                .field(
                    "K",
                    [3, 3],
                    "matrix of the field, body frame: potential energy ½ Γ·KΓ",
                ),
        ],
        initial: &[
            Kind::Rotation.spelt("Λ", "Lambda", [3, 3], "attitude, body to space"),
            Kind::BodyMomentum.field("body_momentum", [3, 1], "momentum, body frame"),
            Kind::Vector.spelt("Γ", "Gamma", [3, 1], "axis of the field, body frame"),
        ],
        observables: &[
            Kind::Rotation.spelt("Λ", "Lambda", [3, 3], "attitude, body to space"),
            Kind::BodyMomentum.field("body_momentum", [3, 1], "momentum, body frame"),
            Kind::SpatialMomentum
                .field("spatial_momentum", [3, 1], "momentum, space frame"),
            Kind::Vector.spelt("Γ", "Gamma", [3, 1], "axis of the field, body frame"),
        ],
        invariants: &[
            Invariant::bounded(
                "energy",
                "½ μ_k·ζ + ½ Γ_k·(K Γ_k), where μ_k = -J ζ + tr(J) ζ",
                1usize,
            ),
            Invariant::exact("momentum_Gamma", "μ_k·Γ_k", 1usize),
            Invariant::exact("Gamma_squared", "Γ_k·Γ_k", 1usize),
        ],
        discrete_energy: Invariant::bounded(
            "discrete_energy",
            "tr(J)/h² - tr(J Ω_k)/h² + ¼ Γ_k·(K Γ_k) + ¼ Γ_{k+1}·(K Γ_{k+1})",
            1,
        ),
        solvers: &Method::NAMES,
        ..Card::plain(&open::<Self>, &only_size::<Self>)
    };
}
