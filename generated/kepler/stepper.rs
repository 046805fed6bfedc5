// Written by `clebsch derive --write`. Do not edit.

//! The model [`Kepler`](struct@Kepler) with its parameters, states and steps.
#![allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
#![allow(confusable_idents, unused_variables, clippy::all)]
use ::clebsch::emitted::*;
/// The parameters of [`Kepler`](struct@Kepler).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeplerParameters<T = f64> {
    /// `m`: mass of the planet; a number.
    pub m: T,
    /// `k`: gravitational parameter of the sun: the gravitational constant times its mass; a number.
    pub k: T,
}
/// Kepler problem: a planet orbits a fixed sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kepler<T = f64> {
    parameters: KeplerParameters<T>,
}
impl<T: Real> Kepler<T> {
    /// The text of the model.
    pub const SOURCE: &'static str = "/// Kepler problem: a planet orbits a fixed sun.\npub model Kepler {\n    /// mass of the planet\n    param m: Real;\n    /// gravitational parameter of the sun: the gravitational constant times its mass\n    param k: Real;\n    /// position of the planet relative to the sun\n    field X: Vec<3>;\n    lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + h*m*k/sqrt(dot(X, X));\n}";
    /// A hash of the model and the version of clebsch.
    pub const FINGERPRINT: u64 = 10275978829428782379u64;
    /// Checks the parameters.
    ///
    /// # Errors
    /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
    /// is not an admissible factor of the equation of a step. The error names the parameter.
    pub fn new(parameters: KeplerParameters<T>) -> Result<Self, ParameterError> {
        validate::finite("m", &[parameters.m])?;
        validate::finite("k", &[parameters.k])?;
        Ok(Self { parameters })
    }
}
/// Initial data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeplerInitial<T = f64> {
    /// `X` at node 0.
    pub X: Additive<3, 1, T>,
    /// Its momentum at node 0.
    pub momentum: FieldMomentum<3, 1, T>,
}
/// The state at one node, which can be compared and saved. The momentum is stored in the space frame, advected quantities as their values at the identity, so that rounding errors do not accumulate. Positions and their momenta are stored as two numbers, the second below the rounding of the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeplerState<T = f64> {
    X: Additive<3, 1, T>,
    momentum: FieldMomentum<3, 1, T>,
    place_rest: SMatrix<T, 3, 1>,
    momentum_rest: SMatrix<T, 3, 1>,
    node: u64,
}
impl<T: Real> KeplerState<T> {
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
pub struct KeplerWorkspace<T = f64> {
    h: T,
}
impl<T: Real> Kepler<T> {
    /// The data with which steps of size `h` from `state` begin.
    fn prepared(
        &self,
        state: &KeplerState<T>,
        h: T,
        _: (),
    ) -> Result<KeplerWorkspace<T>, StartError> {
        {
            let X = state.X.matrix();
            validate::defined(
                domain::Domain::NotZero,
                domain::Function::Quotient,
                "|X_k|",
                X.dot(&X).sqrt(),
            )?;
        }
        Ok(KeplerWorkspace { h })
    }
    /// One step, in place. Method: one division, because the balance is linear.
    ///
    /// # Errors
    /// If the step cannot be solved. The error gives numbers and a remedy; the state is unchanged.
    #[inline]
    pub fn step(
        &self,
        state: &mut KeplerState<T>,
        work: &mut KeplerWorkspace<T>,
    ) -> Result<(), StepError> {
        let h = work.h;
        let KeplerParameters { m, k, .. } = self.parameters;
        let X = state.X.matrix();
        let b1 = X.dot(&X);
        let ΔX = match divided(
            &(state.momentum.0
                - (X * (T::from_f64(0.5) * h * m * k / (b1 * b1.sqrt())))),
            m / h,
            "m/h",
        ) {
            Ok(solved) => solved,
            Err(e) => return Err(StepCause::Singular(e).at_node(state.node)),
        };
        let (X_moved, X_rest) = state.X.moved(&(ΔX), &state.place_rest);
        let X_next = X_moved.matrix();
        let t2 = X_next.dot(&X_next);
        let (momentum_next, momentum_rest) = added(
            &state.momentum.0,
            &state.momentum_rest,
            &(-(X * (T::from_f64(0.5) * h * m * k / (b1 * b1.sqrt())))
                - X_next * (T::from_f64(0.5) * h * m * k / (t2 * t2.sqrt()))),
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
    [] Kepler,
    KeplerParameters { m, k },
    KeplerInitial { X, momentum },
    KeplerState { X, momentum, place_rest, momentum_rest } at node,
    KeplerWorkspace { h },
    tried {} nothing symmetric judged { (3 * 1) }
    start { X, momentum = momentum } { place_rest, momentum_rest }
    observables { state.X, state.momentum }
    invariants { energy, momentum_angular }
}
/// A configuration at one node; it need not lie on a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeplerConfiguration<T = f64> {
    /// `X` at the node.
    pub X: Additive<3, 1, T>,
}
impl<T: Real> Kepler<T> {
    /// The residual of the discrete Euler-Lagrange equations at the middle of three
    /// consecutive configurations: components are derivatives of the action of the two edges
    /// along the coordinates of the Lie algebra, on the side of the velocity. SO(n): for
    /// `i < j`, row by row, the element with -1 at (i, j) and +1 at (j, i); GL(n): matrix
    /// units, row by row. Components beyond the coordinates are zero. Zero on solutions.
    pub fn balance(
        &self,
        h: T,
        before: &KeplerConfiguration<T>,
        here: &KeplerConfiguration<T>,
        after: &KeplerConfiguration<T>,
    ) -> SVector<T, 3> {
        let KeplerParameters { m, k, .. } = self.parameters;
        let X = here.X.matrix();
        let ΔX_before = before.X.spatial_velocity(&here.X).matrix();
        let ΔX = here.X.spatial_velocity(&after.X).matrix();
        let t1 = h.powi(-1);
        let t2 = X.dot(&X);
        ΔX_before * (t1 * m) - X * (h * m * k / (t2 * t2.sqrt())) - ΔX * (t1 * m)
    }
    /// The Hessian of the kinetic energy in all velocities together, at the identity.
    fn inertia_at(&self, state: &KeplerState<T>) -> SMatrix<T, 3, 3> {
        let KeplerParameters { m, .. } = self.parameters;
        columns(|axis| {
            let ξ: SVector<T, 3> = array_basis::<T, 3, 1>(axis);
            ξ * m
        })
    }
    /// The kinetic and the potential energy of the limit of small steps, at this node's momentum.
    pub fn energies(&self, state: &KeplerState<T>) -> (T, T) {
        let KeplerParameters { m, k, .. } = self.parameters;
        let X = state.X.matrix();
        let momentum = state.momentum().0;
        let velocity = solve_leading_or_nan(&self.inertia_at(state), &momentum, (3 * 1));
        (momentum.dot(&velocity) * T::from_f64(0.5), -(m * k / X.dot(&X).sqrt()))
    }
    /// The physical energy at this node.
    pub fn energy(&self, state: &KeplerState<T>) -> T {
        let (kinetic, potential) = self.energies(state);
        kinetic + potential
    }
    /// `X_k × p_k`: Noether: the action is invariant under rotations of space.
    pub fn momentum_angular(&self, state: &KeplerState<T>) -> SVector<T, 3> {
        let X = state.X.matrix();
        let p = state.momentum().0;
        X.cross(&p)
    }
    /// The discrete energy of the edge between two consecutive states, `m ΔX_k·ΔX_k/(2 h²) - m k/(2 |X_k|) - m k/(2 |X_{k+1}|)`: bounded, since the stepper is symplectic.
    pub fn discrete_energy(
        &self,
        h: T,
        before: &KeplerState<T>,
        after: &KeplerState<T>,
    ) -> T {
        let KeplerParameters { m, k, .. } = self.parameters;
        let ΔX_matrix = before
            .X
            .velocity_between(&before.place_rest, &after.X, &after.place_rest)
            .matrix();
        let X = before.X.matrix();
        let X_next = after.X.matrix();
        T::from_f64(0.5) * m * ΔX_matrix.dot(&ΔX_matrix) / (h * h)
            - T::from_f64(0.5) * m * k / X.dot(&X).sqrt()
            - T::from_f64(0.5) * m * k / X_next.dot(&X_next).sqrt()
    }
    /// The state after a trial step of size `h`; `None` if it fails.
    #[cold]
    fn attempt(&self, state: &KeplerState<T>, h: T) -> Option<KeplerState<T>> {
        let mut moving = *state;
        self.step(&mut moving, &mut KeplerWorkspace { h }).ok()?;
        Some(moving)
    }
}
impl Kepler<f64> {
    /// The scales of all invariants at a state, for steps of `h`.
    fn scales(&self, state: &KeplerState<f64>, h: f64, out: &mut [f64]) {
        let KeplerParameters { m, k, .. } = self.parameters;
        let X = state.X.matrix();
        let energies = self.energies(state);
        let s1 = X.dot(&X);
        let s2 = s1.powi(-1);
        let s3 = s1.powr(-1, 2);
        let impulse = (h * h).sqrt() * (m * m).sqrt() * (k * k).sqrt() * (s2 * s2).sqrt()
            * (s3 * s3).sqrt() * s1.sqrt();
        let state = &KeplerState {
            momentum: FieldMomentum(not_less(state.momentum.0, (0, 3), impulse)),
            ..*state
        };
        let energy = size_of_energy(energies, self.energies(state));
        let p = state.momentum().0;
        let out = put(out, [energy]);
        put(out, [p.dot(&p).sqrt() * X.dot(&X).sqrt(); 3 * 1]);
    }
    /// The model as data.
    pub const CARD: Card = Card {
        name: "Kepler",
        kebab: "kepler",
        doc: "Kepler problem: a planet orbits a fixed sun.",
        source: Self::SOURCE,
        fingerprint: Self::FINGERPRINT,
        summary: "discrete Lagrangian  m ΔX_k·ΔX_k/(2 h) + h m k/(2 |X_k|) + h m k/(2 |X_{k+1}|)\nmomentum of X        m ΔX_k/h\nRiccati form         none; linear, L = m/h, R = 1\ninvariants           energy, momentum_angular\ntime reversal        symmetric: second order\ncertificate          13 identities proved by normal form",
        solver: "Explicit: one division, because the balance is linear",
        parameters: &[
            Kind::Scalar.field("m", [1, 1], "mass of the planet"),
            Kind::Scalar
                .field(
                    "k",
                    [1, 1],
                    "gravitational parameter of the sun: the gravitational constant times its mass",
                ),
        ],
        initial: &[
            Kind::Vector
                .field("X", [3, 1], "position of the planet relative to the sun"),
            Kind::FieldMomentum.field("momentum", [3, 1], "momentum of X"),
        ],
        observables: &[
            Kind::Vector
                .field("X", [3, 1], "position of the planet relative to the sun"),
            Kind::FieldMomentum.field("momentum", [3, 1], "momentum of X"),
        ],
        invariants: &[
            Invariant::bounded(
                "energy",
                "½ p_k·ζ - m k/|X_k|, where p_k = m ζ",
                1usize,
            ),
            Invariant::exact("momentum_angular", "X_k × p_k", 3 * 1),
        ],
        discrete_energy: Invariant::bounded(
            "discrete_energy",
            "m ΔX_k·ΔX_k/(2 h²) - m k/(2 |X_k|) - m k/(2 |X_{k+1}|)",
            1,
        ),
        ..Card::plain(&open::<Self>, &only_size::<Self>)
    };
}
