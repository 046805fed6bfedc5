// Written by `clebsch derive --write`. Do not edit.

//! The model [`BodyInTwoFields`](struct@BodyInTwoFields) with its parameters, states and steps.
#![allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
#![allow(confusable_idents, unused_variables, clippy::all)]
use ::clebsch::emitted::*;
/// The parameters of [`BodyInTwoFields`](struct@BodyInTwoFields).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyInTwoFieldsParameters<T = f64> {
    /// `J`: Poinsot (second-moment) matrix; a matrix of size 3 x 3, symmetric.
    pub J: SMatrix<T, 3, 3>,
    /// `gU`: weight times the vector from support to centre of mass, body frame; a vector of 3 components.
    pub gU: SVector<T, 3>,
    /// `p`: dipole moment, body frame; a vector of 3 components.
    pub p: SVector<T, 3>,
    /// `z`: vertical (up), space frame; a vector of 3 components.
    pub z: SVector<T, 3>,
    /// `b`: field that acts on the dipole, space frame; a vector of 3 components.
    pub b: SVector<T, 3>,
}
/// Rigid body about a fixed point in two uniform fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyInTwoFields<T = f64> {
    parameters: BodyInTwoFieldsParameters<T>,
    factor: Poinsot<T>,
    method: Method,
}
impl<T: Real> BodyInTwoFields<T> {
    /// The text of the model.
    pub const SOURCE: &'static str = "/// Rigid body about a fixed point in two uniform fields.\npub model BodyInTwoFields {\n    /// Poinsot (second-moment) matrix\n    param J: Sym<3>;\n    /// weight times the vector from support to centre of mass, body frame\n    param gU: Vec<3> as \"m g \\chi\";\n    /// dipole moment, body frame\n    param p: Vec<3>;\n    /// vertical (up), space frame\n    param z: Vec<3>;\n    /// field that acts on the dipole, space frame\n    param b: Vec<3>;\n    /// attitude, body to space\n    group Λ: SO<3> velocity Ω;\n    /// vertical, body frame\n    advected Γ: Vec<3> = Λ^T*z;\n    /// field that acts on the dipole, body frame\n    advected B: Vec<3> = Λ^T*b;\n    /// reconstruction\n    constraint next(Λ) = Λ*Ω;\n    /// Γ and B are fixed in space\n    constraint next(Γ) = Ω^T*Γ;\n    constraint next(B) = Ω^T*B;\n    lagrangian = -tr(J*Ω)/h - h*(dot(gU, Γ) - dot(p, B));\n}";
    /// A hash of the model and the version of clebsch.
    pub const FINGERPRINT: u64 = 4245126510531692259u64;
    /// Checks the parameters.
    ///
    /// # Errors
    /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
    /// is not an admissible factor of the equation of a step. The error names the parameter.
    pub fn new(
        parameters: BodyInTwoFieldsParameters<T>,
    ) -> Result<Self, ParameterError> {
        validate::finite_entries("J", &parameters.J)?;
        validate::symmetric("J", &parameters.J)?;
        validate::finite("gU", parameters.gU.as_slice())?;
        validate::finite("p", parameters.p.as_slice())?;
        validate::finite("z", parameters.z.as_slice())?;
        validate::finite("b", parameters.b.as_slice())?;
        let BodyInTwoFieldsParameters { J, .. } = parameters;
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
pub struct BodyInTwoFieldsInitial<T = f64> {
    /// `Λ` at node 0: body -> space.
    pub Λ: Rotation<T>,
    /// Momentum at node 0, in the body frame.
    pub body_momentum: BodyMomentum<T>,
}
/// The state at one node, which can be compared and saved. The momentum is stored in the space frame, advected quantities as their values at the identity, so that rounding errors do not accumulate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyInTwoFieldsState<T = f64> {
    Λ: Rotation<T>,
    momentum: SpatialMomentum<T>,
    node: u64,
}
impl<T: Real> BodyInTwoFieldsState<T> {
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
pub struct BodyInTwoFieldsWorkspace<T = f64> {
    h: T,
    method: Method,
    edge: Edge<T>,
    here: BodyInTwoFieldsState<T>,
}
impl<T: Real> BodyInTwoFields<T> {
    /// The edge that begins at this state, for a step `h`.
    #[inline(never)]
    fn edge(&self, state: &BodyInTwoFieldsState<T>, h: T) -> Edge<T> {
        let BodyInTwoFieldsParameters { gU, p, z, b, .. } = self.parameters;
        let Λ = state.Λ.matrix();
        let Γ = Λ.tr_mul(&z);
        let B = Λ.tr_mul(&b);
        let kick = gU.cross(&Γ) * (T::from_f64(0.5) * h)
            - p.cross(&B) * (T::from_f64(0.5) * h);
        Edge::new(Λ.tr_mul(&state.momentum.0) - kick, state.momentum.0 - Λ * kick)
    }
    /// The next node and the edge that begins there, given the attitude there.
    #[inline(always)]
    fn arrived(
        &self,
        state: &BodyInTwoFieldsState<T>,
        edge: &Edge<T>,
        h: T,
        Λ_moved: TurnedRotation<T>,
    ) -> Moving<T> {
        let BodyInTwoFieldsParameters { gU, p, z, b, .. } = self.parameters;
        let Λ_next = Λ_moved.matrix();
        let Γ_next = Λ_next.tr_mul(&z);
        let B_next = Λ_next.tr_mul(&b);
        let space = edge.space();
        let torque = (p * h).cross(&B_next) - (gU * h).cross(&Γ_next);
        let kick = Λ_next * torque;
        Moving {
            attitude: Λ_moved.rotation(),
            momentum: SpatialMomentum(space + kick * T::from_f64(0.5)),
            edge: Edge::new(Λ_next.tr_mul(&space) + torque, space + kick),
        }
    }
    /// `Γ` at the node of this state.
    #[inline]
    pub fn Γ(&self, state: &BodyInTwoFieldsState<T>) -> SVector<T, 3> {
        let BodyInTwoFieldsParameters { z, .. } = self.parameters;
        let Λ = state.Λ.matrix();
        Λ.tr_mul(&z)
    }
    /// `B` at the node of this state.
    #[inline]
    pub fn B(&self, state: &BodyInTwoFieldsState<T>) -> SVector<T, 3> {
        let BodyInTwoFieldsParameters { b, .. } = self.parameters;
        let Λ = state.Λ.matrix();
        Λ.tr_mul(&b)
    }
}
::clebsch::stepper! {
    [] BodyInTwoFields,
    BodyInTwoFieldsParameters { J, gU, p, z, b },
    BodyInTwoFieldsInitial { Λ, body_momentum },
    BodyInTwoFieldsState { Λ, momentum } at node,
    BodyInTwoFieldsWorkspace { h, method, edge, here },
    forced { Λ, momentum } solver symmetric judged { 3 }
    ("explicit up to the root of one quartic per step, because the left factor is symmetric and constant")
    start { Λ, momentum = body_momentum.to_space }
    observables { state.Λ, state.body_momentum, state.spatial_momentum, Γ, B }
    invariants { energy, Gamma_squared, Gamma_B, B_squared }
}
/// A configuration at one node; it need not lie on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyInTwoFieldsConfiguration<T = f64> {
    /// `Λ` at the node: body -> space.
    pub Λ: Rotation<T>,
}
impl<T: Real> BodyInTwoFields<T> {
    /// The residual of the discrete Euler-Lagrange equations at the middle of three
    /// consecutive configurations: component `i` is the derivative of the action of the
    /// two edges when the middle element is rotated about its axis `i` (a body axis on
    /// the body side, a space axis on the spatial side). Zero on solutions.
    pub fn balance(
        &self,
        h: T,
        before: &BodyInTwoFieldsConfiguration<T>,
        here: &BodyInTwoFieldsConfiguration<T>,
        after: &BodyInTwoFieldsConfiguration<T>,
    ) -> SVector<T, 3> {
        let BodyInTwoFieldsParameters { J, gU, p, z, b, .. } = self.parameters;
        let Λ = here.Λ.matrix();
        let Γ = Λ.tr_mul(&z);
        let B = Λ.tr_mul(&b);
        let Ω_before = before.Λ.body_velocity(&here.Λ).matrix();
        let Ω = here.Λ.body_velocity(&after.Λ).matrix();
        let t1 = h.powi(-1);
        axial_of_difference(&(J * Ω_before)) * t1 - gU.cross(&Γ) * h + p.cross(&B) * h
            + axial_of_difference(&(J * Ω.transpose())) * t1
    }
    /// The Hessian of the kinetic energy in all velocities together, at the identity.
    fn inertia_at(&self, state: &BodyInTwoFieldsState<T>) -> SMatrix<T, 3, 3> {
        let BodyInTwoFieldsParameters { J, .. } = self.parameters;
        columns(|axis| {
            let ξ: SMatrix<T, 3, 3> = basis::<T>(axis);
            let t1 = vee(&ξ);
            t1 * J.trace() - J * t1
        })
    }
    /// The kinetic and the potential energy of the limit of small steps, at this node's momentum.
    pub fn energies(&self, state: &BodyInTwoFieldsState<T>) -> (T, T) {
        let BodyInTwoFieldsParameters { gU, p, .. } = self.parameters;
        let Γ = self.Γ(state);
        let B = self.B(state);
        let momentum = state.body_momentum().0;
        let velocity = solve_leading_or_nan(&self.inertia_at(state), &momentum, 3);
        (momentum.dot(&velocity) * T::from_f64(0.5), gU.dot(&Γ) - p.dot(&B))
    }
    /// The physical energy at this node.
    pub fn energy(&self, state: &BodyInTwoFieldsState<T>) -> T {
        let (kinetic, potential) = self.energies(state);
        kinetic + potential
    }
    /// `Γ_k·Γ_k`: Casimir: invariant under the group action.
    pub fn Gamma_squared(&self, state: &BodyInTwoFieldsState<T>) -> T {
        let Γ = self.Γ(state);
        Γ.dot(&Γ)
    }
    /// `Γ_k·B_k`: Casimir: invariant under the group action.
    pub fn Gamma_B(&self, state: &BodyInTwoFieldsState<T>) -> T {
        let Γ = self.Γ(state);
        let B = self.B(state);
        Γ.dot(&B)
    }
    /// `B_k·B_k`: Casimir: invariant under the group action.
    pub fn B_squared(&self, state: &BodyInTwoFieldsState<T>) -> T {
        let B = self.B(state);
        B.dot(&B)
    }
    /// The discrete energy of the edge between two consecutive states, `tr(J)/h² - tr(J Ω_k)/h² + ½ gU·Γ_k + ½ gU·Γ_{k+1} - ½ p·B_k - ½ p·B_{k+1}`: bounded, since the stepper is symplectic.
    pub fn discrete_energy(
        &self,
        h: T,
        before: &BodyInTwoFieldsState<T>,
        after: &BodyInTwoFieldsState<T>,
    ) -> T {
        let BodyInTwoFieldsParameters { J, gU, p, .. } = self.parameters;
        let Γ = self.Γ(before);
        let Γ_next = self.Γ(after);
        let B = self.B(before);
        let B_next = self.B(after);
        let Ω_matrix = before.Λ.body_velocity(&after.Λ).matrix();
        T::from_f64(0.5) * gU.dot(&Γ) + T::from_f64(0.5) * gU.dot(&Γ_next)
            - T::from_f64(0.5) * p.dot(&B) - T::from_f64(0.5) * p.dot(&B_next)
            - (J * less_identity(&Ω_matrix)).trace() / (h * h)
    }
}
impl BodyInTwoFields<f64> {
    /// The scales of all invariants at a state, for steps of `h`.
    fn scales(&self, state: &BodyInTwoFieldsState<f64>, h: f64, out: &mut [f64]) {
        let BodyInTwoFieldsParameters { gU, p, .. } = self.parameters;
        let Γ = self.Γ(state);
        let B = self.B(state);
        let energies = self.energies(state);
        let s1 = (h * h).sqrt();
        let impulse = s1 * gU.dot(&gU).sqrt() * Γ.dot(&Γ).sqrt()
            + s1 * p.dot(&p).sqrt() * B.dot(&B).sqrt();
        let state = &BodyInTwoFieldsState {
            momentum: SpatialMomentum(not_less(state.momentum.0, (0, 3), impulse)),
            ..*state
        };
        let energy = size_of_energy(energies, self.energies(state));
        let t1 = Γ.dot(&Γ).sqrt();
        let t2 = B.dot(&B).sqrt();
        put(out, [energy, t1 * t1, t1 * t2, t2 * t2]);
    }
    /// The model as data.
    pub const CARD: Card = Card {
        name: "BodyInTwoFields",
        kebab: "body-in-two-fields",
        doc: "Rigid body about a fixed point in two uniform fields.",
        source: Self::SOURCE,
        fingerprint: Self::FINGERPRINT,
        summary: "discrete Lagrangian  -tr(J Ω_k)/h - ½ h gU·Γ_k + ½ h p·B_k - ½ h gU·Γ_{k+1} + ½ h p·B_{k+1}\nmomentum of Λ        -J Ω_kᵀ/h + Ω_k J/h\nRiccati form         exact, C = J\ninvariants           energy, Gamma_squared, Gamma_B, B_squared\ntime reversal        symmetric: second order\ncertificate          22 identities proved by normal form",
        solver: "Moser-Veselov: explicit up to the root of one quartic per step, because the left factor is symmetric and constant",
        parameters: &[
            Kind::SecondMoments.field("J", [3, 3], "Poinsot (second-moment) matrix"),
            Kind::Vector
                .field(
                    "gU",
                    [3, 1],
                    "weight times the vector from support to centre of mass, body frame",
                ),
            Kind::Vector.field("p", [3, 1], "dipole moment, body frame"),
            Kind::Vector.field("z", [3, 1], "vertical (up), space frame"),
            Kind::Vector.field("b", [3, 1], "field that acts on the dipole, space frame"),
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
            Kind::Vector.spelt("Γ", "Gamma", [3, 1], "vertical, body frame"),
            Kind::Vector.field("B", [3, 1], "field that acts on the dipole, body frame"),
        ],
        invariants: &[
            Invariant::bounded(
                "energy",
                "½ μ_k·ζ + gU·Γ_k - p·B_k, where μ_k = -J ζ + tr(J) ζ",
                1usize,
            ),
            Invariant::exact("Gamma_squared", "Γ_k·Γ_k", 1usize),
            Invariant::exact("Gamma_B", "Γ_k·B_k", 1usize),
            Invariant::exact("B_squared", "B_k·B_k", 1usize),
        ],
        discrete_energy: Invariant::bounded(
            "discrete_energy",
            "tr(J)/h² - tr(J Ω_k)/h² + ½ gU·Γ_k + ½ gU·Γ_{k+1} - ½ p·B_k - ½ p·B_{k+1}",
            1,
        ),
        solvers: &Method::NAMES,
        ..Card::plain(&open::<Self>, &only_size::<Self>)
    };
}
