// Written by `clebsch derive --write`. Do not edit.

/// The model [`Kepler`](struct@Kepler) and what belongs to it.
#[allow(
    non_snake_case,
    uncommon_codepoints,
    mixed_script_confusables,
    confusable_idents,
    clippy::all
)]
pub mod kepler {
    use ::clebsch::emitted::*;
    /// Parameters of [`Kepler`](struct@Kepler), as given.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct KeplerParameters<T = f64> {
        /// `m`: mass of the planet; a number.
        pub m: T,
        /// `k`: gravitational parameter of the sun: its mass times the constant of gravitation; a number.
        pub k: T,
    }
    /// Planet about a fixed sun.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Kepler<T = f64> {
        parameters: KeplerParameters<T>,
    }
    impl<T: Real> Kepler<T> {
        /// The model as it was stated.
        pub const SOURCE: &'static str = "/// Planet about a fixed sun.\npub model Kepler {\n    /// mass of the planet\n    param m: Real;\n    /// gravitational parameter of the sun: its mass times the constant of gravitation\n    param k: Real;\n    /// place of the planet, the sun at the origin\n    field X: Vec<3>;\n    lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + h*m*k/sqrt(dot(X, X));\n}";
        /// A number that changes when the model or its derivation does.
        pub const FINGERPRINT: u64 = 51819993755699707u64;
        /// Checks the parameters.
        ///
        /// # Errors
        /// Names the parameter that is not finite, lacks its stated symmetry, breaks an
        /// assumption, or is no admissible factor of the equation to solve.
        pub fn new(parameters: KeplerParameters<T>) -> Result<Self, ParameterError> {
            validate::finite("m", &[parameters.m])?;
            validate::finite("k", &[parameters.k])?;
            Ok(Self { parameters })
        }
        /// The parameters.
        pub fn parameters(&self) -> &KeplerParameters<T> {
            &self.parameters
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
    /// What moves, at one node: comparable, to be saved. The momentum is kept in the space frame, advected quantities by their value carried back to the identity, so that roundoff does not accumulate. Places and their momenta are kept in two numbers, the rest below the rounding of the other.
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
        /// The number of the node.
        pub fn node(&self) -> u64 {
            self.node
        }
    }
    /// The step and the last velocities, from which the next solves start.
    #[derive(Clone, Copy, Debug)]
    pub struct KeplerWorkspace<T = f64> {
        h: T,
    }
    ::clebsch::saved! {
        [] KeplerWorkspace { h, }
    }
    impl<T: Real> Kepler<T> {
        /// Starts a trajectory with step `h` from data at node 0.
        ///
        /// # Errors
        /// Names the value that is not admissible, or says why the first step cannot be solved and
        /// which could.
        pub fn start(
            &self,
            initial: KeplerInitial<T>,
            h: T,
        ) -> Result<(KeplerState<T>, KeplerWorkspace<T>), StartError> {
            ::clebsch::integrate::Model::start_with(self, initial, h, Default::default())
        }
        /// A workspace for steps of `h`, of either sign, from any state; errors as of `start`.
        pub fn workspace(
            &self,
            state: &KeplerState<T>,
            h: T,
        ) -> Result<KeplerWorkspace<T>, StartError> {
            self.prepare(state, h, Default::default())
        }
        /// One step, in place. Solved thus: the balance is linear: one division.
        ///
        /// # Errors
        /// When the step cannot be solved, with numbers and a remedy; the state is then unchanged.
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
            let t1 = X.dot(&X);
            let t2 = X_next.dot(&X_next);
            let (momentum_next, momentum_rest) = added(
                &state.momentum.0,
                &state.momentum_rest,
                &((-(X * (T::from_f64(0.5) * h * m * k / (t1 * t1.sqrt()))))
                    - X_next * (T::from_f64(0.5) * h * m * k / (t2 * t2.sqrt()))),
            );
            if !(all_finite(&momentum_next)) {
                return Err(
                    StepCause::NotFinite {
                        what: "momentum",
                    }
                        .at_node(state.node),
                );
            }
            state.X = X_moved;
            state.place_rest = X_rest;
            state.momentum = FieldMomentum(momentum_next);
            state.momentum_rest = momentum_rest;
            state.node += 1;
            Ok(())
        }
    }
    impl<T: Real> Stepper for Kepler<T> {
        type Scalar = T;
        type State = KeplerState<T>;
        type Workspace = KeplerWorkspace<T>;
        fn workspace(
            &self,
            state: &Self::State,
            h: T,
        ) -> Result<Self::Workspace, StartError> {
            self.prepare(state, h, Default::default())
        }
        #[inline(always)]
        fn advance(
            &self,
            state: &mut Self::State,
            work: &mut Self::Workspace,
        ) -> Result<(), StepError> {
            self.step(state, work)
        }
        #[cold]
        fn attempt(&self, state: &Self::State, h: T) -> Option<Self::State> {
            let mut moving = *state;
            self.step(&mut moving, &mut KeplerWorkspace { h }).ok()?;
            Some(moving)
        }
        fn node(state: &Self::State) -> u64 {
            state.node
        }
        fn at_node(state: Self::State, node: u64) -> Self::State {
            KeplerState { node: node, ..state }
        }
    }
    impl<T: Real> Reversible for Kepler<T> {}
    ::clebsch::of_scalars! {
        [] KeplerParameters { m, k }
    }
    ::clebsch::of_scalars! {
        [] KeplerInitial { X, momentum }
    }
    ::clebsch::of_scalars! {
        [] KeplerState { X, momentum, place_rest, momentum_rest } at node
    }
    impl<T: Real> ::clebsch::integrate::Model for Kepler<T> {
        type Parameters = KeplerParameters<T>;
        type Initial = KeplerInitial<T>;
        type Choice = ();
        type Over<U: Real> = Kepler<U>;
        const SIDE_BY_SIDE: bool = false;
        fn of(parameters: Self::Parameters) -> Result<Self, ParameterError> {
            Self::new(parameters)
        }
        fn given(&self) -> &Self::Parameters {
            &self.parameters
        }
        fn begin(&self, initial: Self::Initial) -> Result<KeplerState<T>, StartError> {
            validate::finite("X", initial.X.matrix().as_slice())?;
            validate::finite("momentum", initial.momentum.0.as_slice())?;
            Ok(KeplerState {
                X: initial.X,
                momentum: initial.momentum,
                place_rest: SMatrix::zeros(),
                momentum_rest: SMatrix::zeros(),
                node: 0,
            })
        }
        fn prepared(
            &self,
            state: &KeplerState<T>,
            h: T,
            _: Self::Choice,
        ) -> Result<Self::Workspace, StartError> {
            {
                let X = state.X.matrix();
                validate::defined(
                    domain::Domain::NotZero,
                    domain::Function::Quotient,
                    "√(X_k·X_k)",
                    X.dot(&X).sqrt(),
                )?;
            }
            Ok(KeplerWorkspace { h })
        }
    }
    /// A configuration at one node, solution or not.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct KeplerConfiguration<T = f64> {
        /// `X` at the node.
        pub X: Additive<3, 1, T>,
    }
    impl<T: Real> Kepler<T> {
        /// The residual of the discrete Euler-Lagrange equations at the middle one of three
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
            let t3 = -(X * (T::from_f64(0.5) * h * m * k / (t2 * t2.sqrt())));
            let parts: [SVector<T, 3>; 1] = [
                ΔX_before * (t1 * m) + t3 - ΔX * (t1 * m) + t3,
            ];
            {
                let mut all = SVector::<T, 3>::zeros();
                let rest = all.as_mut_slice();
                let rest = put_matrix(rest, &parts[0]);
                let _ = rest;
                all
            }
        }
    }
    impl<T: Real> Kepler<T> {
        /// What the step of size `h` from one state to the next leaves of its equations: the
        /// momentum that is carried to the second state, less the one that the motion between
        /// them brings there. One part a configuration, angular and linear ones of a rigid
        /// motion apart, each with the size of the terms it is made of: those of a spatial
        /// velocity are the two elements it is made from, as they are stored.
        pub fn residual(
            &self,
            before: &KeplerState<T>,
            after: &KeplerState<T>,
            h: T,
        ) -> [Residual; 1] {
            let KeplerParameters { m, k, .. } = self.parameters;
            let ΔX_matrix = before
                .X
                .velocity_between(&before.place_rest, &after.X, &after.place_rest)
                .matrix();
            let X_next = after.X.matrix();
            let t1 = h.powi(-1);
            let t2 = X_next.dot(&X_next);
            let t3 = t2.powi(-1);
            let t4 = t2.powr(-1, 2);
            let t5 = (m * m).sqrt();
            let _ = h;
            [
                {
                    let momentum = after.momentum.0;
                    Residual {
                        size: length(
                                &(momentum
                                    - (ΔX_matrix * (t1 * m)
                                        - X_next * (T::from_f64(0.5) * h * m * k * t3 * t4))),
                            )
                            .magnitude(),
                        scale: length(&momentum).magnitude()
                            + ((t1 * t1).sqrt() * t5 * ΔX_matrix.dot(&ΔX_matrix).sqrt()
                                + T::from_f64(0.5) * (h * h).sqrt() * t5 * (k * k).sqrt()
                                    * (t3 * t3).sqrt() * (t4 * t4).sqrt() * t2.sqrt())
                                .magnitude(),
                    }
                },
            ]
        }
    }
    impl<T: Real> Kepler<T> {
        /// The kinetic and the potential energy at this node: those of the limit of small steps,
        /// at the node's momentum.
        pub fn energies(&self, state: &KeplerState<T>) -> (T, T) {
            let KeplerParameters { m, k, .. } = self.parameters;
            let X = state.X.matrix();
            let parts: [SVector<T, 3>; 1] = [state.momentum().0];
            let momentum = {
                let mut all = SVector::<T, 3>::zeros();
                let rest = all.as_mut_slice();
                let rest = put_matrix(rest, &parts[0]);
                let _ = rest;
                all
            };
            let mut inertia = SMatrix::<T, 3, 3>::zeros();
            for axis in 0..(3 * 1) {
                let ξ: SVector<T, 3> = array_basis::<T, 3, 1>(axis);
                let t1 = ξ * (T::from_f64(0.5) * m);
                let parts: [SVector<T, 3>; 1] = [t1 + t1];
                inertia
                    .set_column(
                        axis,
                        &{
                            let mut all = SVector::<T, 3>::zeros();
                            let rest = all.as_mut_slice();
                            let rest = put_matrix(rest, &parts[0]);
                            let _ = rest;
                            all
                        },
                    );
            }
            let velocity = solve_leading_or_nan(&inertia, &momentum, 0 + (3 * 1));
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
    }
    impl<T: Real> Kepler<T> {
        /// The discrete energy of the edge between two consecutive states, `m ΔX_k·ΔX_k/(2 h²) - m k/(2 √(X_k·X_k)) - m k/(2 √(X_{k+1}·X_{k+1}))`: bounded, since the stepper is symplectic.
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
    }
    impl ::clebsch::integrate::Described for Kepler<f64> {
        fn card() -> &'static Card {
            &Self::CARD
        }
        fn read(
            parameters: &[Vec<f64>],
            initial: &[Vec<f64>],
        ) -> Result<(Self, Self::Initial), OpenError> {
            let model = Self::new(KeplerParameters {
                m: number_of("m", parameters.get(0usize))?,
                k: number_of("k", parameters.get(1usize))?,
            })?;
            let initial = KeplerInitial {
                X: additive_of("X", initial.get(0usize))?,
                momentum: FieldMomentum(matrix_of("momentum", initial.get(1usize))?),
            };
            Ok((model, initial))
        }
        fn ways(
            self,
            state: &Self::State,
            settings: Settings,
        ) -> Result<(Self, Steps<Self>), OpenError> {
            let model = chosen_solver(settings, Self::CARD.solvers).map(|_| self)?;
            let steps = Steps::of_order(&model, state, settings, Self::CARD.orders)?;
            Ok((model, steps))
        }
        fn judged(&self, state: &Self::State) -> Option<KineticWarning> {
            self.kinetic_warning(state)
        }
        fn left_over(&self, before: &Self::State, after: &Self::State, h: f64) -> f64 {
            Residual::largest(&self.residual(before, after, h))
        }
        fn observe(&self, state: &Self::State, out: &mut [f64]) {
            let out = put(out, rows(state.X().matrix()));
            let out = put(out, rows(state.momentum().0));
            let _ = out;
        }
        fn invariants(
            &self,
            state: &Self::State,
            _: Option<&Self::Workspace>,
            out: &mut [f64],
        ) {
            let out = put(out, [self.energy(state)]);
            let out = put(out, rows(self.momentum_angular(state)));
            let _ = (state, out);
        }
        fn scales(&self, state: &Self::State, h: f64, out: &mut [f64]) {
            let mut enlarged = *state;
            {
                type T = f64;
                let KeplerParameters { m, k, .. } = self.parameters;
                let X = state.X.matrix();
                let t1 = X.dot(&X);
                let t2 = t1.powi(-1);
                let t3 = t1.powr(-1, 2);
                let t4 = T::from_f64(0.5) * (h * h).sqrt() * (m * m).sqrt()
                    * (k * k).sqrt() * (t2 * t2).sqrt() * (t3 * t3).sqrt() * t1.sqrt();
                enlarged.momentum = FieldMomentum(
                    not_less(enlarged.momentum.0, (0, 3), t4 + t4),
                );
            }
            let state = &enlarged;
            type T = f64;
            let X = state.X.matrix();
            let p = state.momentum().0;
            let out = put(out, [sum_of_sizes(self.energies(state)); 1usize]);
            let out = put(out, [p.dot(&p).sqrt() * X.dot(&X).sqrt(); 3 * 1]);
            let _ = (state, h, out);
        }
    }
    impl Kepler<f64> {
        /// The model as data.
        pub const CARD: Card = Card {
            name: "Kepler",
            kebab: "kepler",
            doc: "Planet about a fixed sun.",
            source: Self::SOURCE,
            fingerprint: Self::FINGERPRINT,
            summary: "discrete Lagrangian  m ΔX_k·ΔX_k/(2 h) + h m k/(2 √(X_k·X_k)) + h m k/(2 √(X_{k+1}·X_{k+1}))\nmomentum of X        m ΔX_k/h\nRiccati form         none; linear, L = m/h, R = 1\ninvariants           energy, momentum_angular\ntime reversal        symmetric: second order\ncertificate          13 identities proved by normal form",
            solver: "Explicit: the balance is linear: one division",
            order: 2u32,
            orders: &[2, 4, 6, 8],
            preprocessed: false,
            reversible: true,
            parameters: &[
                Kind::Scalar.field("m", [1, 1], "mass of the planet"),
                Kind::Scalar
                    .field(
                        "k",
                        [1, 1],
                        "gravitational parameter of the sun: its mass times the constant of gravitation",
                    ),
            ],
            initial: &[
                Kind::Vector
                    .field("X", [3, 1], "place of the planet, the sun at the origin"),
                Kind::FieldMomentum.field("momentum", [3, 1], "momentum of X"),
            ],
            observables: &[
                Kind::Vector
                    .field("X", [3, 1], "place of the planet, the sun at the origin"),
                Kind::FieldMomentum.field("momentum", [3, 1], "momentum of X"),
            ],
            invariants: &[
                Invariant::bounded(
                    "energy",
                    "½ p_k·ζ - m k/√(X_k·X_k), where p_k = m ζ",
                    1usize,
                ),
                Invariant::exact("momentum_angular", "X_k × p_k", 3 * 1),
            ],
            discrete_energy: Invariant::bounded(
                "discrete_energy",
                "m ΔX_k·ΔX_k/(2 h²) - m k/(2 √(X_k·X_k)) - m k/(2 √(X_{k+1}·X_{k+1}))",
                1,
            ),
            open: open::<Self>,
            solvers: &[],
            dimensions: &[],
            sized: only_size::<Self>,
        };
        /// What is wrong with the kinetic energy at a state, if anything: its Hessian in all
        /// velocities together, at the identity, should be positive definite.
        #[cold]
        #[allow(unused_variables)]
        pub fn kinetic_warning(
            &self,
            state: &KeplerState<f64>,
        ) -> Option<KineticWarning> {
            type T = f64;
            let KeplerParameters { m, .. } = self.parameters;
            let mut inertia = SMatrix::<T, 3, 3>::zeros();
            for axis in 0..(3 * 1) {
                let ξ: SVector<T, 3> = array_basis::<T, 3, 1>(axis);
                let t1 = ξ * (T::from_f64(0.5) * m);
                let parts: [SVector<T, 3>; 1] = [t1 + t1];
                inertia
                    .set_column(
                        axis,
                        &{
                            let mut all = SVector::<T, 3>::zeros();
                            let rest = all.as_mut_slice();
                            let rest = put_matrix(rest, &parts[0]);
                            let _ = rest;
                            all
                        },
                    );
            }
            KineticWarning::of(&inertia, 0 + (3 * 1))
        }
    }
}
#[allow(unused_imports)]
pub use kepler::*;
