// Written by `clebsch derive --write`. Do not edit.

//! The model [`HeavyTopSpatial`](struct@HeavyTopSpatial) with its parameters, states and steps.
#![allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
#![allow(confusable_idents, unused_variables, clippy::all)]
use ::clebsch::emitted::*;
/// The parameters of [`HeavyTopSpatial`](struct@HeavyTopSpatial).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeavyTopSpatialParameters<T = f64> {
    /// `w`: weight; a number.
    pub w: T,
    /// `z`: vertical (up), space frame; a vector of 3 components.
    pub z: SVector<T, 3>,
}
/// Heavy top, spatial representation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeavyTopSpatial<T = f64> {
    parameters: HeavyTopSpatialParameters<T>,
    method: Method,
}
impl<T: Real> HeavyTopSpatial<T> {
    /// The text of the model.
    pub const SOURCE: &'static str = "/// Heavy top, spatial representation.\npub model HeavyTopSpatial {\n    /// weight\n    param w: Real;\n    /// vertical (up), space frame\n    param z: Vec<3>;\n    /// attitude, body to space\n    group Λ: SO<3> velocity ω;\n    /// Poinsot (second-moment) matrix, space frame\n    advected J: Sym<3>;\n    /// vector from support to centre of mass, space frame\n    advected χ: Vec<3>;\n    /// reconstruction\n    constraint next(Λ) = ω*Λ;\n    /// advection of the second moments\n    constraint next(J) = ω*J*ω^T;\n    /// advection of the centre of mass\n    constraint next(χ) = ω*χ;\n    lagrangian = -tr(ω*J)/h - h*w*dot(χ, z);\n}";
    /// A hash of the model and the version of clebsch.
    pub const FINGERPRINT: u64 = 12931622307764238321u64;
    /// Checks the parameters.
    ///
    /// # Errors
    /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
    /// is not an admissible factor of the equation of a step. The error names the parameter.
    pub fn new(
        parameters: HeavyTopSpatialParameters<T>,
    ) -> Result<Self, ParameterError> {
        validate::finite("w", &[parameters.w])?;
        validate::finite("z", parameters.z.as_slice())?;
        Ok(Self {
            parameters,
            method: Method::of_size(3),
        })
    }
}
/// Initial data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeavyTopSpatialInitial<T = f64> {
    /// `Λ` at node 0: body -> space.
    pub Λ: Rotation<T>,
    /// Momentum at node 0, in the space frame.
    pub spatial_momentum: SpatialMomentum<T>,
    /// `J` at node 0.
    pub J: SMatrix<T, 3, 3>,
    /// `χ` at node 0.
    pub χ: SVector<T, 3>,
}
/// The state at one node, which can be compared and saved. The momentum is stored in the space frame, advected quantities as their values at the identity, so that rounding errors do not accumulate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeavyTopSpatialState<T = f64> {
    Λ: Rotation<T>,
    momentum: SpatialMomentum<T>,
    J: SMatrix<T, 3, 3>,
    χ: SVector<T, 3>,
    node: u64,
}
impl<T: Real> HeavyTopSpatialState<T> {
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
/// The step size, the solver, the left factor, and the momentum of the edge that begins at the state `here`. A step from any other state computes them again.
#[derive(Clone, Copy, Debug)]
pub struct HeavyTopSpatialWorkspace<T = f64> {
    h: T,
    method: Method,
    factor: Poinsot<T>,
    edge: Edge<T>,
    here: HeavyTopSpatialState<T>,
}
impl<T: Real> HeavyTopSpatial<T> {
    /// The state at node 0.
    fn begin(
        &self,
        initial: HeavyTopSpatialInitial<T>,
    ) -> Result<HeavyTopSpatialState<T>, StartError> {
        validate::finite("Λ", &initial.Λ.quaternion())?;
        validate::finite("spatial_momentum", initial.spatial_momentum.0.as_slice())?;
        validate::finite_entries("J", &initial.J)?;
        validate::finite("χ", initial.χ.as_slice())?;
        let J = {
            let Λ = initial.Λ.matrix();
            let J_start = initial.J;
            Λ.tr_mul(&(J_start * Λ))
        };
        let χ = {
            let Λ = initial.Λ.matrix();
            let χ_start = initial.χ;
            Λ.tr_mul(&χ_start)
        };
        Ok(HeavyTopSpatialState {
            Λ: initial.Λ,
            momentum: initial.spatial_momentum,
            J,
            χ,
            node: 0,
        })
    }
    /// The factor of the equation at a state, prepared for the solver.
    #[inline(never)]
    fn factor(
        &self,
        state: &HeavyTopSpatialState<T>,
    ) -> Result<Poinsot<T>, ParameterError> {
        let J = state.J;
        Poinsot::new(J).map_err(|e| e.in_field("J_k"))
    }
    /// The edge that begins at this state, for a step `h`.
    #[inline(never)]
    fn edge(&self, state: &HeavyTopSpatialState<T>, h: T) -> Edge<T> {
        let HeavyTopSpatialParameters { w, z, .. } = self.parameters;
        let Λ = state.Λ.matrix();
        let χ_reference = state.χ;
        let χ = Λ * χ_reference;
        let space = state.momentum.0 - (-(z.cross(&χ) * (T::from_f64(0.5) * h * w)));
        Edge::new(state.Λ.matrix().tr_mul(&space), space)
    }
    /// The next node and the edge that begins there, given the attitude there.
    #[inline(always)]
    fn arrived(
        &self,
        state: &HeavyTopSpatialState<T>,
        edge: &Edge<T>,
        h: T,
        Λ_moved: TurnedRotation<T>,
    ) -> Moving<T> {
        let HeavyTopSpatialParameters { w, z, .. } = self.parameters;
        let Λ_next = Λ_moved.matrix();
        let χ_reference = state.χ;
        let χ_next = Λ_next * χ_reference;
        let space = edge.space();
        let torque = Λ_next.tr_mul(&z).cross(&(χ_reference * (h * w)));
        let kick = (z * (h * w)).cross(&χ_next);
        let left = space + kick;
        Moving {
            attitude: Λ_moved.rotation(),
            momentum: SpatialMomentum(space + kick * T::from_f64(0.5)),
            edge: Edge::new(Λ_next.tr_mul(&space) + torque, left),
        }
    }
    /// `J` at the node of this state.
    #[inline]
    pub fn J(&self, state: &HeavyTopSpatialState<T>) -> SMatrix<T, 3, 3> {
        let Λ = state.Λ.matrix();
        let J_reference = state.J;
        Λ * (J_reference * Λ.transpose())
    }
    /// `χ` at the node of this state.
    #[inline]
    pub fn χ(&self, state: &HeavyTopSpatialState<T>) -> SVector<T, 3> {
        let Λ = state.Λ.matrix();
        let χ_reference = state.χ;
        Λ * χ_reference
    }
}
::clebsch::stepper! {
    [] HeavyTopSpatial,
    HeavyTopSpatialParameters { w, z },
    HeavyTopSpatialInitial { Λ, spatial_momentum, J, χ },
    HeavyTopSpatialState { Λ, momentum, J, χ } at node,
    HeavyTopSpatialWorkspace { h, method, factor, edge, here },
    forced { Λ, momentum, J, χ } solver symmetric judged { 3 }
    ("explicit up to the root of one quartic per step, because the left factor is symmetric and constant in the body frame",
        of J)
    observables { state.Λ, state.body_momentum, state.spatial_momentum, J, χ }
    invariants { energy, chi_squared, trace_J1, trace_J2, trace_J3, chi_J_chi,
        chi_J2_chi, momentum_z }
}
/// A configuration at one node; it need not lie on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeavyTopSpatialConfiguration<T = f64> {
    /// `Λ` at the node: body -> space.
    pub Λ: Rotation<T>,
    /// `J` at the node, evolved by its constraint.
    pub J: SMatrix<T, 3, 3>,
    /// `χ` at the node, evolved by its constraint.
    pub χ: SVector<T, 3>,
}
impl<T: Real> HeavyTopSpatial<T> {
    /// The residual of the discrete Euler-Lagrange equations at the middle of three
    /// consecutive configurations: component `i` is the derivative of the action of the
    /// two edges when the middle element is rotated about its axis `i` (a body axis on
    /// the body side, a space axis on the spatial side). Zero on solutions.
    pub fn balance(
        &self,
        h: T,
        before: &HeavyTopSpatialConfiguration<T>,
        here: &HeavyTopSpatialConfiguration<T>,
        after: &HeavyTopSpatialConfiguration<T>,
    ) -> SVector<T, 3> {
        let HeavyTopSpatialParameters { w, z, .. } = self.parameters;
        let J_before = before.J;
        let χ_before = before.χ;
        let J = here.J;
        let χ = here.χ;
        let J_next = after.J;
        let χ_next = after.χ;
        let ω_before = before.Λ.spatial_velocity(&here.Λ).matrix();
        let ω = here.Λ.spatial_velocity(&after.Λ).matrix();
        let t1 = h.powi(-1);
        axial_of_difference(&(ω_before * J_before)) * t1 + z.cross(&χ) * (h * w)
            - axial_of_difference(&(ω * J)) * t1
    }
    /// The Hessian of the kinetic energy in all velocities together, at the identity.
    fn inertia_at(&self, state: &HeavyTopSpatialState<T>) -> SMatrix<T, 3, 3> {
        let J = self.J(state);
        columns(|axis| {
            let ξ: SMatrix<T, 3, 3> = basis::<T>(axis);
            let t1 = vee(&ξ);
            t1 * J.trace() - J * t1
        })
    }
    /// The kinetic and the potential energy of the limit of small steps, at this node's momentum.
    pub fn energies(&self, state: &HeavyTopSpatialState<T>) -> (T, T) {
        let HeavyTopSpatialParameters { w, z, .. } = self.parameters;
        let χ = self.χ(state);
        let momentum = state.spatial_momentum().0;
        let velocity = solve_leading_or_nan(&self.inertia_at(state), &momentum, 3);
        (momentum.dot(&velocity) * T::from_f64(0.5), w * z.dot(&χ))
    }
    /// The physical energy at this node.
    pub fn energy(&self, state: &HeavyTopSpatialState<T>) -> T {
        let (kinetic, potential) = self.energies(state);
        kinetic + potential
    }
    /// `χ_k·χ_k`: Casimir: invariant under the group action.
    pub fn chi_squared(&self, state: &HeavyTopSpatialState<T>) -> T {
        let χ = self.χ(state);
        χ.dot(&χ)
    }
    /// `tr(J_k)`: Casimir: invariant under the group action.
    pub fn trace_J1(&self, state: &HeavyTopSpatialState<T>) -> T {
        let J = self.J(state);
        J.trace()
    }
    /// `tr(J_k²)`: Casimir: invariant under the group action.
    pub fn trace_J2(&self, state: &HeavyTopSpatialState<T>) -> T {
        let J = self.J(state);
        (J * J).trace()
    }
    /// `tr(J_k³)`: Casimir: invariant under the group action.
    pub fn trace_J3(&self, state: &HeavyTopSpatialState<T>) -> T {
        let J = self.J(state);
        (J * (J * J)).trace()
    }
    /// `χ_k·(J_k χ_k)`: Casimir: invariant under the group action.
    pub fn chi_J_chi(&self, state: &HeavyTopSpatialState<T>) -> T {
        let J = self.J(state);
        let χ = self.χ(state);
        χ.dot(&(J * χ))
    }
    /// `χ_k·(J_k² χ_k)`: Casimir: invariant under the group action.
    pub fn chi_J2_chi(&self, state: &HeavyTopSpatialState<T>) -> T {
        let J = self.J(state);
        let χ = self.χ(state);
        χ.dot(&(J * (J * χ)))
    }
    /// `m_k·z`: Noether: the action is invariant under rotations about the axis in space.
    pub fn momentum_z(&self, state: &HeavyTopSpatialState<T>) -> T {
        let HeavyTopSpatialParameters { z, .. } = self.parameters;
        let m = state.spatial_momentum().0;
        m.dot(&z)
    }
    /// The discrete energy of the edge between two consecutive states, `-tr(ω_k J_k)/h² + tr(J_k)/h² + ½ w z·χ_k + ½ w z·χ_{k+1}`: bounded, since the stepper is symplectic.
    pub fn discrete_energy(
        &self,
        h: T,
        before: &HeavyTopSpatialState<T>,
        after: &HeavyTopSpatialState<T>,
    ) -> T {
        let HeavyTopSpatialParameters { w, z, .. } = self.parameters;
        let J = self.J(before);
        let χ = self.χ(before);
        let χ_next = self.χ(after);
        let ω_matrix = before.Λ.spatial_velocity(&after.Λ).matrix();
        T::from_f64(0.5) * w * z.dot(&χ) + T::from_f64(0.5) * w * z.dot(&χ_next)
            - (J * less_identity(&ω_matrix)).trace() / (h * h)
    }
}
impl HeavyTopSpatial<f64> {
    /// The scales of all invariants at a state, for steps of `h`.
    fn scales(&self, state: &HeavyTopSpatialState<f64>, h: f64, out: &mut [f64]) {
        type T = f64;
        let HeavyTopSpatialParameters { w, z, .. } = self.parameters;
        let J = self.J(state);
        let χ = self.χ(state);
        let energies = self.energies(state);
        let impulse = T::from_f64(0.5) * (h * h).sqrt() * (w * w).sqrt()
            * z.dot(&z).sqrt() * χ.dot(&χ).sqrt();
        let state = &HeavyTopSpatialState {
            momentum: SpatialMomentum(not_less(state.momentum.0, (0, 3), impulse)),
            ..*state
        };
        let energy = size_of_energy(energies, self.energies(state));
        let m = state.spatial_momentum().0;
        let t1 = χ.dot(&χ).sqrt();
        let t2 = (J * J).trace().sqrt();
        put(
            out,
            [
                energy,
                t1 * t1,
                T::from_f64(3.0).sqrt() * t2,
                t2 * t2,
                t2 * t2 * t2,
                t1 * t2 * t1,
                t1 * t2 * t2 * t1,
                m.dot(&m).sqrt() * z.dot(&z).sqrt(),
            ],
        );
    }
    /// The model as data.
    pub const CARD: Card = Card {
        name: "HeavyTopSpatial",
        kebab: "heavy-top-spatial",
        doc: "Heavy top, spatial representation.",
        source: Self::SOURCE,
        fingerprint: Self::FINGERPRINT,
        summary: "discrete Lagrangian  -tr(ω_k J_k)/h - ½ h w χ_k·z - ½ h w χ_{k+1}·z\nmomentum of Λ        ω_k J_k/h - J_k ω_kᵀ/h\nRiccati form         exact, C = J_k\ninvariants           energy, chi_squared, trace_J1, trace_J2, trace_J3, chi_J_chi, chi_J2_chi, momentum_z\ntime reversal        symmetric: second order\ncertificate          22 identities proved by normal form",
        solver: "Moser-Veselov: explicit up to the root of one quartic per step, because the left factor is symmetric and constant in the body frame",
        parameters: &[
            Kind::Scalar.field("w", [1, 1], "weight"),
            Kind::Vector.field("z", [3, 1], "vertical (up), space frame"),
        ],
        initial: &[
            Kind::Rotation.spelt("Λ", "Lambda", [3, 3], "attitude, body to space"),
            Kind::SpatialMomentum
                .field("spatial_momentum", [3, 1], "momentum, space frame"),
            Kind::SecondMoments
                .field("J", [3, 3], "Poinsot (second-moment) matrix, space frame"),
            Kind::Vector
                .spelt(
                    "χ",
                    "chi",
                    [3, 1],
                    "vector from support to centre of mass, space frame",
                ),
        ],
        observables: &[
            Kind::Rotation.spelt("Λ", "Lambda", [3, 3], "attitude, body to space"),
            Kind::BodyMomentum.field("body_momentum", [3, 1], "momentum, body frame"),
            Kind::SpatialMomentum
                .field("spatial_momentum", [3, 1], "momentum, space frame"),
            Kind::SecondMoments
                .field("J", [3, 3], "Poinsot (second-moment) matrix, space frame"),
            Kind::Vector
                .spelt(
                    "χ",
                    "chi",
                    [3, 1],
                    "vector from support to centre of mass, space frame",
                ),
        ],
        invariants: &[
            Invariant::bounded(
                "energy",
                "½ m_k·ζ + w z·χ_k, where m_k = -J_k ζ + tr(J_k) ζ",
                1usize,
            ),
            Invariant::exact("chi_squared", "χ_k·χ_k", 1usize),
            Invariant::exact("trace_J1", "tr(J_k)", 1usize),
            Invariant::exact("trace_J2", "tr(J_k²)", 1usize),
            Invariant::exact("trace_J3", "tr(J_k³)", 1usize),
            Invariant::exact("chi_J_chi", "χ_k·(J_k χ_k)", 1usize),
            Invariant::exact("chi_J2_chi", "χ_k·(J_k² χ_k)", 1usize),
            Invariant::exact("momentum_z", "m_k·z", 1usize),
        ],
        discrete_energy: Invariant::bounded(
            "discrete_energy",
            "-tr(ω_k J_k)/h² + tr(J_k)/h² + ½ w z·χ_k + ½ w z·χ_{k+1}",
            1,
        ),
        solvers: &Method::NAMES,
        ..Card::plain(&open::<Self>, &only_size::<Self>)
    };
}
