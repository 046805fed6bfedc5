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
    impl<T: Real> Kepler<T> {
        /// Starts a trajectory with step `h` from data at node 0.
        ///
        /// # Errors
        /// Names the value that is not finite, or says why the first step cannot be solved and
        /// which step could.
        pub fn start(
            &self,
            initial: KeplerInitial<T>,
            h: T,
        ) -> Result<(KeplerState<T>, KeplerWorkspace<T>), StartError> {
            validate::positive_step(h)?;
            let state = self.at_node_0(initial)?;
            Ok((state, self.workspace(&state, h)?))
        }
        /// The state at node 0.
        fn at_node_0(
            &self,
            initial: KeplerInitial<T>,
        ) -> Result<KeplerState<T>, StartError> {
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
        /// A workspace for steps of `h`, of either sign, from any state.
        ///
        /// # Errors
        /// When `h` is zero or not finite, or the first step cannot be solved.
        pub fn workspace(
            &self,
            state: &KeplerState<T>,
            h: T,
        ) -> Result<KeplerWorkspace<T>, StartError> {
            validate::directed_step(h)?;
            let state = *state;
            {
                let X = state.X.matrix();
                validate::defined(
                    domain::Domain::NotZero,
                    domain::Function::Quotient,
                    "√(X_k·X_k)",
                    X.dot(&X).sqrt(),
                )?;
            }
            let work = KeplerWorkspace { h };
            let (mut trial, mut scratch) = (state, work);
            self.step(&mut trial, &mut scratch)
                .map_err(|e| StartError::Refused(e.cause))?;
            Ok(work)
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
                    - (X * T::from_f64(0.5) * h * m * k * b1.powr(-1, 2) / b1)),
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
                &((-(X * T::from_f64(0.5) * h * m * k * t1.powr(-1, 2) / t1))
                    - X_next * T::from_f64(0.5) * h * m * k * t2.powr(-1, 2) / t2),
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
            self.workspace(state, h)
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
    impl<T: Real> ::clebsch::OfScalars for KeplerParameters<T> {
        type Scalar = T;
        type Over<U: Real> = KeplerParameters<U>;
        fn over<U: Real>(&self, change: &mut impl FnMut(T) -> U) -> KeplerParameters<U> {
            KeplerParameters {
                m: self.m.over(change),
                k: self.k.over(change),
            }
        }
    }
    impl<T: Real> ::clebsch::OfScalars for KeplerInitial<T> {
        type Scalar = T;
        type Over<U: Real> = KeplerInitial<U>;
        fn over<U: Real>(&self, change: &mut impl FnMut(T) -> U) -> KeplerInitial<U> {
            KeplerInitial {
                X: self.X.over(change),
                momentum: self.momentum.over(change),
            }
        }
    }
    impl<T: Real> ::clebsch::OfScalars for KeplerState<T> {
        type Scalar = T;
        type Over<U: Real> = KeplerState<U>;
        fn over<U: Real>(&self, change: &mut impl FnMut(T) -> U) -> KeplerState<U> {
            KeplerState {
                X: self.X.over(change),
                momentum: self.momentum.over(change),
                place_rest: self.place_rest.over(change),
                momentum_rest: self.momentum_rest.over(change),
                node: self.node,
            }
        }
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
            self.at_node_0(initial)
        }
        fn prepare(
            &self,
            state: &KeplerState<T>,
            h: T,
            _: Self::Choice,
        ) -> Result<Self::Workspace, StartError> {
            self.workspace(state, h)
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
            let t3 = -(X * T::from_f64(0.5) * h * m * k * t2.powr(-1, 2) / t2);
            let parts: [SVector<T, 3>; 1] = [
                ΔX_before * t1 * m + t3 - ΔX * t1 * m + t3,
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
                                    - (ΔX_matrix * t1 * m
                                        - X_next * T::from_f64(0.5) * h * m * k * t3 * t4)),
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
                let t1 = ξ * T::from_f64(0.5) * m;
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
            (
                momentum.dot(&velocity) * T::from_f64(0.5),
                -(m * k * X.dot(&X).powr(-1, 2)),
            )
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
            T::from_f64(0.5) * h.powi(-2) * m * ΔX_matrix.dot(&ΔX_matrix)
                - T::from_f64(0.5) * m * k * X.dot(&X).powr(-1, 2)
                - T::from_f64(0.5) * m * k * X_next.dot(&X_next).powr(-1, 2)
        }
    }
    /// One trajectory of the model, its type hidden.
    struct KeplerTrajectory {
        model: Kepler<f64>,
        state: KeplerState<f64>,
        steps: Steps<Kepler<f64>>,
        h: f64,
        /// The state before the last step.
        before: KeplerState<f64>,
        /// Whether a step is one of the derivation, not composed and without modified moments.
        plain: bool,
        kinetic: Option<KineticWarning>,
    }
    impl Trajectory for KeplerTrajectory {
        fn node(&self) -> u64 {
            self.state.node()
        }
        fn time(&self) -> f64 {
            self.h * self.state.node() as f64
        }
        fn step(&mut self) -> Result<(), StepError> {
            let before = self.state;
            self.steps.step(&self.model, &mut self.state)?;
            self.before = before;
            Ok(())
        }
        fn card(&self) -> &'static Card {
            &Kepler::<f64>::CARD
        }
        fn kinetic_warning(&self) -> Option<KineticWarning> {
            self.kinetic
        }
        fn residual(&self) -> Option<f64> {
            let moved = self.before.node() != self.state.node();
            (self.plain && moved)
                .then(|| {
                    Residual::largest(
                        &self.model.residual(&self.before, &self.state, self.h),
                    )
                })
        }
        fn observe(&self, out: &mut [f64]) {
            let state = &self.state;
            let out = put(out, rows(state.X().matrix()));
            let out = put(out, rows(state.momentum().0));
            let _ = out;
        }
        fn invariants(&self, out: &mut [f64]) {
            let state = &self.state;
            let out = put(out, [self.model.energy(state)]);
            let out = put(out, rows(self.model.momentum_angular(state)));
            let _ = out;
        }
        fn scales(&self, out: &mut [f64]) {
            let state = &self.state;
            let out = put(
                out,
                [{
                    let (kinetic, potential) = self.model.energies(state);
                    kinetic.abs() + potential.abs()
                }; 1usize],
            );
            let out = put(
                out,
                [{
                    type T = f64;
                    let X = state.X.matrix();
                    let p = state.momentum().0;
                    let value: T = p.dot(&p).sqrt() * X.dot(&X).sqrt();
                    value
                }; 3 * 1],
            );
            let _ = out;
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
            summary: "action of one step   m ΔX_k·ΔX_k/(2 h) + h m k/(2 √(X_k·X_k)) + h m k/(2 √(X_{k+1}·X_{k+1}))\nmomentum of X        m ΔX_k/h\nRiccati form         none; linear, L = m/h, R = 1\ninvariants           energy, momentum_angular\ntime reversal        symmetric: second order\ncertificate          13 identities proved by normal form",
            solver: "Explicit: the balance is linear: one division",
            order: 2u32,
            orders: &[2, 4, 6, 8],
            preprocessed: false,
            reversible: true,
            parameters: &[
                Field {
                    name: "m",
                    ascii: "m",
                    rows: 1,
                    cols: 1,
                    kind: Kind::Scalar,
                    doc: "mass of the planet",
                },
                Field {
                    name: "k",
                    ascii: "k",
                    rows: 1,
                    cols: 1,
                    kind: Kind::Scalar,
                    doc: "gravitational parameter of the sun: its mass times the constant of gravitation",
                },
            ],
            initial: &[
                Field {
                    name: "X",
                    ascii: "X",
                    rows: 3,
                    cols: 1,
                    kind: Kind::Vector,
                    doc: "place of the planet, the sun at the origin",
                },
                Field {
                    name: "momentum",
                    ascii: "momentum",
                    rows: 3,
                    cols: 1,
                    kind: Kind::FieldMomentum,
                    doc: "momentum of X",
                },
            ],
            observables: &[
                Field {
                    name: "X",
                    ascii: "X",
                    rows: 3,
                    cols: 1,
                    kind: Kind::Vector,
                    doc: "place of the planet, the sun at the origin",
                },
                Field {
                    name: "momentum",
                    ascii: "momentum",
                    rows: 3,
                    cols: 1,
                    kind: Kind::FieldMomentum,
                    doc: "momentum of X",
                },
            ],
            invariants: &[
                Invariant {
                    name: "energy",
                    formula: "½ p_k·ζ - m k/√(X_k·X_k), where p_k = m ζ",
                    rows: 1usize,
                    conserved: Conserved::Boundedly,
                },
                Invariant {
                    name: "momentum_angular",
                    formula: "X_k × p_k",
                    rows: 3 * 1,
                    conserved: Conserved::Exactly,
                },
            ],
            discrete_energy: Invariant {
                name: "discrete_energy",
                formula: "m ΔX_k·ΔX_k/(2 h²) - m k/(2 √(X_k·X_k)) - m k/(2 √(X_{k+1}·X_{k+1}))",
                rows: 1,
                conserved: Conserved::Boundedly,
            },
            open: Self::open,
            solvers: &[],
            dimensions: &[],
            sized: Self::sized,
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
                let t1 = ξ * T::from_f64(0.5) * m;
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
        /// The card of the model at the given sizes, in the order of their declaration.
        fn sized(sizes: &[usize]) -> Option<Card> {
            match sizes {
                [] => Some(Kepler::<f64>::CARD),
                _ => None,
            }
        }
        fn open(
            parameters: &[Vec<f64>],
            initial: &[Vec<f64>],
            settings: Settings,
        ) -> Result<Box<dyn Trajectory>, OpenError> {
            for (field, expected, found) in [
                ("parameters", 2usize, parameters.len()),
                ("initial values", 2usize, initial.len()),
            ] {
                if expected != found {
                    return Err(OpenError::Count {
                        field,
                        expected,
                        found,
                    });
                }
            }
            let model = Kepler::new(KeplerParameters {
                m: number_of("m", parameters.get(0usize))?,
                k: number_of("k", parameters.get(1usize))?,
            })?;
            let initial = KeplerInitial {
                X: additive_of("X", initial.get(0usize))?,
                momentum: FieldMomentum(matrix_of("momentum", initial.get(1usize))?),
            };
            chosen_solver(settings, Self::CARD.solvers)?;
            let state = model.at_node_0(initial)?;
            let kinetic = model.kinetic_warning(&state);
            let steps = Steps::of_order(&model, &state, settings, Self::CARD.orders)
                .map_err(|e| OpenError::from(e).beside(kinetic))?;
            let plain = matches!(steps, Steps::Plain(_));
            Ok(
                Box::new(KeplerTrajectory {
                    model,
                    state,
                    steps,
                    h: settings.h,
                    before: state,
                    plain,
                    kinetic,
                }),
            )
        }
    }
}
#[allow(unused_imports)]
pub use kepler::*;
