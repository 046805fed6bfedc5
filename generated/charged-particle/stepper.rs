// Written by `clebsch derive --write`. Do not edit.

//! The model [`ChargedParticle`](struct@ChargedParticle) with its parameters, states and steps.
#![allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
#![allow(confusable_idents, unused_variables, clippy::all)]
use ::clebsch::emitted::*;
/// The parameters of [`ChargedParticle`](struct@ChargedParticle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChargedParticleParameters<T = f64> {
    /// `m`: mass; a number.
    pub m: T,
    /// `q`: charge; a number.
    pub q: T,
    /// `B`: magnetic field; a vector of 3 components.
    pub B: SVector<T, 3>,
    /// `E`: electric field; a vector of 3 components.
    pub E: SVector<T, 3>,
}
/// Charged particle in uniform magnetic and electric fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChargedParticle<T = f64> {
    parameters: ChargedParticleParameters<T>,
}
impl<T: Real> ChargedParticle<T> {
    /// The text of the model.
    pub const SOURCE: &'static str = "/// Charged particle in uniform magnetic and electric fields.\npub model ChargedParticle {\n    /// mass\n    param m: Real;\n    /// charge\n    param q: Real;\n    /// magnetic field\n    param B: Vec<3>;\n    /// electric field\n    param E: Vec<3>;\n    /// position of the particle\n    field X: Vec<3>;\n    lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + (1/2)*q*dot(cross(B, X), next(X) - X) + h*q*dot(E, X);\n}";
    /// A hash of the model and the version of clebsch.
    pub const FINGERPRINT: u64 = 13364345416425682192u64;
    /// Checks the parameters.
    ///
    /// # Errors
    /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
    /// is not an admissible factor of the equation of a step. The error names the parameter.
    pub fn new(
        parameters: ChargedParticleParameters<T>,
    ) -> Result<Self, ParameterError> {
        validate::finite("m", &[parameters.m])?;
        validate::finite("q", &[parameters.q])?;
        validate::finite("B", parameters.B.as_slice())?;
        validate::finite("E", parameters.E.as_slice())?;
        Ok(Self { parameters })
    }
}
/// Initial data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChargedParticleInitial<T = f64> {
    /// `X` at node 0.
    pub X: Additive<3, 1, T>,
    /// Its momentum at node 0.
    pub momentum: FieldMomentum<3, 1, T>,
}
/// The state at one node, which can be compared and saved. The momentum is stored in the space frame, advected quantities as their values at the identity, so that rounding errors do not accumulate. Positions and their momenta are stored as two numbers, the second below the rounding of the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChargedParticleState<T = f64> {
    X: Additive<3, 1, T>,
    momentum: FieldMomentum<3, 1, T>,
    place_rest: SMatrix<T, 3, 1>,
    momentum_rest: SMatrix<T, 3, 1>,
    node: u64,
}
impl<T: Real> ChargedParticleState<T> {
    /// `X` at this node.
    pub fn X(&self) -> Additive<3, 1, T> {
        self.X
    }
    /// Its momentum at this node.
    pub fn momentum(&self) -> FieldMomentum<3, 1, T> {
        self.momentum
    }
}
/// The step size, and the last velocities as initial guesses for the next step.
#[derive(Clone, Copy, Debug)]
pub struct ChargedParticleWorkspace<T = f64> {
    h: T,
}
impl<T: Real> ChargedParticle<T> {
    /// The data with which steps of size `h` from `state` begin.
    fn prepared(
        &self,
        _: &ChargedParticleState<T>,
        h: T,
        _: (),
    ) -> Result<ChargedParticleWorkspace<T>, StartError> {
        Ok(ChargedParticleWorkspace { h })
    }
    /// One step, in place. Method: one small linear system, because the balance is linear.
    ///
    /// # Errors
    /// If the step cannot be solved. The error gives numbers and a remedy; the state is unchanged.
    #[inline]
    pub fn step(
        &self,
        state: &mut ChargedParticleState<T>,
        work: &mut ChargedParticleWorkspace<T>,
    ) -> Result<(), StepError> {
        let h = work.h;
        let ChargedParticleParameters { m, q, B, E, .. } = self.parameters;
        let X = state.X.matrix();
        let ΔX = match left_sided(
            &(SMatrix::<T, 3, 3>::identity() * (m / h)
                + hat(&B) * (T::from_f64(0.5) * q)),
            &(state.momentum.0
                - (B.cross(&X) * (T::from_f64(0.5) * q)
                    - E * (T::from_f64(0.5) * h * q))),
            "m Id/h + ½ q hat(B)",
        ) {
            Ok(solved) => solved,
            Err(e) => return Err(StepCause::Singular(e).at_node(state.node)),
        };
        let ΔX_matrix = ΔX.matrix();
        let (X_moved, X_rest) = state.X.moved(&(ΔX), &state.place_rest);
        let (momentum_next, momentum_rest) = added(
            &state.momentum.0,
            &state.momentum_rest,
            &(E * (h * q) - B.cross(&ΔX_matrix) * (T::from_f64(0.5) * q)),
        );
        if !(all_finite(&momentum_next)) {
            return Err(StepCause::not_finite("momentum").at_node(state.node));
        }
        state.X = X_moved;
        state.place_rest = X_rest;
        state.momentum = FieldMomentum(momentum_next);
        state.momentum_rest = momentum_rest;
        state.node += 1;
        Ok(())
    }
}
::clebsch::stepper! {
    [] ChargedParticle,
    ChargedParticleParameters { m, q, B, E },
    ChargedParticleInitial { X, momentum },
    ChargedParticleState { X, momentum, place_rest, momentum_rest } at node,
    ChargedParticleWorkspace { h },
    tried {} nothing symmetric judged { (3 * 1) }
    start { X, momentum = momentum } { place_rest, momentum_rest }
    observables { state.X, state.momentum }
    invariants { energy, momentum_across_E }
}
/// A configuration at one node; it need not lie on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChargedParticleConfiguration<T = f64> {
    /// `X` at the node.
    pub X: Additive<3, 1, T>,
}
impl<T: Real> ChargedParticle<T> {
    /// The residual of the discrete Euler-Lagrange equations at the middle of three
    /// consecutive configurations: components are derivatives of the action of the two edges
    /// along the coordinates of the Lie algebra, on the side of the velocity. SO(n): for
    /// `i < j`, row by row, the element with -1 at (i, j) and +1 at (j, i); GL(n): matrix
    /// units, row by row. Components beyond the coordinates are zero. Zero on solutions.
    pub fn balance(
        &self,
        h: T,
        before: &ChargedParticleConfiguration<T>,
        here: &ChargedParticleConfiguration<T>,
        after: &ChargedParticleConfiguration<T>,
    ) -> SVector<T, 3> {
        let ChargedParticleParameters { m, q, B, E, .. } = self.parameters;
        let X_before = before.X.matrix();
        let X = here.X.matrix();
        let ΔX_before = before.X.spatial_velocity(&here.X).matrix();
        let ΔX = here.X.spatial_velocity(&after.X).matrix();
        let t1 = h.powi(-1);
        ΔX_before * (t1 * m) + E * (h * q) + B.cross(&X_before) * (T::from_f64(0.5) * q)
            - ΔX * (t1 * m) - B.cross(&X) * (T::from_f64(0.5) * q)
            - B.cross(&ΔX) * (T::from_f64(0.5) * q)
    }
    /// The Hessian of the kinetic energy in all velocities together, at the identity.
    fn inertia_at(&self, state: &ChargedParticleState<T>) -> SMatrix<T, 3, 3> {
        let ChargedParticleParameters { m, .. } = self.parameters;
        columns(|axis| {
            let ξ: SVector<T, 3> = array_basis::<T, 3, 1>(axis);
            ξ * m
        })
    }
    /// The kinetic and the potential energy of the limit of small steps, at this node's momentum.
    pub fn energies(&self, state: &ChargedParticleState<T>) -> (T, T) {
        let ChargedParticleParameters { q, B, E, .. } = self.parameters;
        let X = state.X.matrix();
        let momentum = state.momentum().0 - (B * (T::from_f64(0.5) * q)).cross(&X);
        let velocity = solve_leading_or_nan(&self.inertia_at(state), &momentum, (3 * 1));
        (momentum.dot(&velocity) * T::from_f64(0.5), -(q * E.dot(&X)))
    }
    /// The physical energy at this node.
    pub fn energy(&self, state: &ChargedParticleState<T>) -> T {
        let (kinetic, potential) = self.energies(state);
        kinetic + potential
    }
    /// `E × p_k - E × (X_k × (½ q B))`: Noether: the action changes by a total difference under translations.
    pub fn momentum_across_E(&self, state: &ChargedParticleState<T>) -> SVector<T, 3> {
        let ChargedParticleParameters { q, B, E, .. } = self.parameters;
        let X = state.X.matrix();
        let p = state.momentum().0;
        E.cross(&p) - E.cross(&X.cross(&(B * (T::from_f64(0.5) * q))))
    }
    /// The discrete energy of the edge between two consecutive states, `m ΔX_k·ΔX_k/(2 h²) - ½ q E·X_k - ½ q E·X_{k+1}`: bounded, since the stepper is symplectic.
    pub fn discrete_energy(
        &self,
        h: T,
        before: &ChargedParticleState<T>,
        after: &ChargedParticleState<T>,
    ) -> T {
        let ChargedParticleParameters { m, q, E, .. } = self.parameters;
        let ΔX_matrix = before
            .X
            .velocity_between(&before.place_rest, &after.X, &after.place_rest)
            .matrix();
        let X = before.X.matrix();
        let X_next = after.X.matrix();
        T::from_f64(0.5) * m * ΔX_matrix.dot(&ΔX_matrix) / (h * h)
            - T::from_f64(0.5) * q * E.dot(&X) - T::from_f64(0.5) * q * E.dot(&X_next)
    }
    /// The state after a trial step of size `h`; `None` if it fails.
    #[cold]
    fn attempt(
        &self,
        state: &ChargedParticleState<T>,
        h: T,
    ) -> Option<ChargedParticleState<T>> {
        let mut moving = *state;
        self.step(&mut moving, &mut ChargedParticleWorkspace { h }).ok()?;
        Some(moving)
    }
}
impl ChargedParticle<f64> {
    /// The scales of all invariants at a state, for steps of `h`.
    fn scales(&self, state: &ChargedParticleState<f64>, h: f64, out: &mut [f64]) {
        type T = f64;
        let ChargedParticleParameters { q, B, E, .. } = self.parameters;
        let X = state.X.matrix();
        let energies = self.energies(state);
        let impulse = T::from_f64(0.5) * (h * h).sqrt() * (q * q).sqrt()
            * E.dot(&E).sqrt();
        let state = &ChargedParticleState {
            momentum: FieldMomentum(not_less(state.momentum.0, (0, 3), impulse)),
            ..*state
        };
        let energy = size_of_energy(energies, self.energies(state));
        let p = state.momentum().0;
        let t1 = E.cross(&X.cross(&(B * (T::from_f64(0.5) * q))));
        let out = put(out, [energy]);
        put(out, [t1.dot(&t1).sqrt() + p.dot(&p).sqrt() * E.dot(&E).sqrt(); 3 * 1]);
    }
    /// The model as data.
    pub const CARD: Card = Card {
        name: "ChargedParticle",
        kebab: "charged-particle",
        doc: "Charged particle in uniform magnetic and electric fields.",
        source: Self::SOURCE,
        fingerprint: Self::FINGERPRINT,
        summary: "discrete Lagrangian  m ΔX_k·ΔX_k/(2 h) + ½ q B·(X_k × ΔX_k) + ½ h q E·X_k + ½ h q E·X_{k+1}\nmomentum of X        m ΔX_k/h + ½ q (B × X_k)\nRiccati form         none; linear, L = m Id/h + ½ q hat(B), R = 1\ninvariants           energy, momentum_across_E\ntime reversal        symmetric: second order\ncertificate          13 identities proved by normal form",
        solver: "Explicit: one small linear system, because the balance is linear",
        parameters: &[
            Kind::Scalar.field("m", [1, 1], "mass"),
            Kind::Scalar.field("q", [1, 1], "charge"),
            Kind::Vector.field("B", [3, 1], "magnetic field"),
            Kind::Vector.field("E", [3, 1], "electric field"),
        ],
        initial: &[
            Kind::Vector.field("X", [3, 1], "position of the particle"),
            Kind::FieldMomentum.field("momentum", [3, 1], "momentum of X"),
        ],
        observables: &[
            Kind::Vector.field("X", [3, 1], "position of the particle"),
            Kind::FieldMomentum.field("momentum", [3, 1], "momentum of X"),
        ],
        invariants: &[
            Invariant::exact(
                "energy",
                "½ (p_k + X_k × (½ q B))·ζ - q E·X_k, where p_k = m ζ + ½ q (B × X_k)",
                1usize,
            ),
            Invariant::exact(
                "momentum_across_E",
                "E × p_k - E × (X_k × (½ q B))",
                3 * 1,
            ),
        ],
        discrete_energy: Invariant::bounded(
            "discrete_energy",
            "m ΔX_k·ΔX_k/(2 h²) - ½ q E·X_k - ½ q E·X_{k+1}",
            1,
        ),
        ..Card::plain(&open::<Self>, &only_size::<Self>)
    };
}
