// Written by `clebsch derive --write`. Do not edit.

/// The model [`FreeBody`](struct@FreeBody) and what belongs to it.
#[allow(
    non_snake_case,
    uncommon_codepoints,
    mixed_script_confusables,
    confusable_idents,
    clippy::all
)]
pub mod free_body {
    use ::clebsch::emitted::*;
    /// Parameters of [`FreeBody`](struct@FreeBody), as given.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct FreeBodyParameters<T = f64> {
        /// `J`: Poinsot (second-moment) matrix; a 3 x 3 matrix, symmetric.
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
        /// The model as it was stated.
        pub const SOURCE: &'static str = "/// Free rigid body, body representation.\npub model FreeBody {\n    /// Poinsot (second-moment) matrix\n    param J: Sym<3>;\n    /// attitude, body to space\n    group Λ: SO<3> velocity Ω;\n    constraint next(Λ) = Λ*Ω;\n    lagrangian = -tr(J*Ω)/h;\n}";
        /// A number that changes when the model or its derivation does.
        pub const FINGERPRINT: u64 = 4354950754132218899u64;
        /// Checks the parameters.
        ///
        /// # Errors
        /// Names the parameter that is not finite, lacks its stated symmetry, breaks an
        /// assumption, or is no admissible factor of the equation to solve.
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
        /// The same model, its steps solved by the solver named.
        #[must_use]
        pub fn with_solver(self, method: Method) -> Self {
            Self { method, ..self }
        }
        /// The parameters.
        pub fn parameters(&self) -> &FreeBodyParameters<T> {
            &self.parameters
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
    /// What moves, at one node: comparable, to be saved. The momentum is kept in the space frame, advected quantities by their value carried back to the identity, so that roundoff does not accumulate.
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
        /// The number of the node.
        pub fn node(&self) -> u64 {
            self.node
        }
    }
    /// The step and the constants of the trajectory. Belongs to the state it was started with.
    #[derive(Clone, Copy, Debug)]
    pub struct FreeBodyWorkspace<T = f64> {
        h: T,
        solver: Free<T>,
    }
    ::clebsch::saved! {
        [] FreeBodyWorkspace { h, solver }
    }
    impl<T: Real> FreeBodyWorkspace<T> {
        /// The solver: the momentum that it keeps, and what its last projection corrected.
        pub fn solver(&self) -> &Free<T> {
            &self.solver
        }
        /// The same, with rounding left to gather, so that it can be measured.
        #[must_use]
        pub fn without_projection(mut self) -> Self {
            self.solver = self.solver.without_projection();
            self
        }
        /// The same, with steps of an order above two made symplectic with the attitude.
        #[must_use]
        pub fn compensated(mut self) -> Self {
            self.solver = self.solver.compensated();
            self
        }
    }
    impl<T: Real> FreeBody<T> {
        /// Starts a trajectory with step `h` from data at node 0.
        ///
        /// # Errors
        /// Names the value that is not admissible, or says why the first step cannot be solved and
        /// which could.
        pub fn start(
            &self,
            initial: FreeBodyInitial<T>,
            h: T,
        ) -> Result<(FreeBodyState<T>, FreeBodyWorkspace<T>), StartError> {
            ::clebsch::integrate::Model::start_with(self, initial, h, Default::default())
        }
        /// As `start`, with steps of this order: see [`Order`].
        ///
        /// # Errors
        /// As `start`; also for what this size or scalar does not have.
        pub fn start_with(
            &self,
            initial: FreeBodyInitial<T>,
            h: T,
            choice: Order,
        ) -> Result<(FreeBodyState<T>, FreeBodyWorkspace<T>), StartError> {
            ::clebsch::integrate::Model::start_with(self, initial, h, choice)
        }
        /// A workspace for steps of `h`, of either sign, from any state; errors as of `start`.
        pub fn workspace(
            &self,
            state: &FreeBodyState<T>,
            h: T,
        ) -> Result<FreeBodyWorkspace<T>, StartError> {
            self.prepare(state, h, Default::default())
        }
        /// One step, in place. Solved thus: C is constant and no node term acts, so κ is conserved: solved once, every step explicit.
        ///
        /// # Errors
        /// When the step cannot be solved, with numbers and a remedy; the state is then unchanged.
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
    impl<T: Real> Stepper for FreeBody<T> {
        type Scalar = T;
        type State = FreeBodyState<T>;
        type Workspace = FreeBodyWorkspace<T>;
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
        #[inline(always)]
        fn advance_many(
            &self,
            state: &mut Self::State,
            work: &mut Self::Workspace,
            count: u64,
        ) -> Result<(), StepError> {
            if let Err(e) = work
                .solver
                .follow_many(&mut state.Λ, &state.momentum, count)
            {
                return Err(StepCause::from(e).at_node(state.node));
            }
            state.node += count;
            Ok(())
        }
        fn node(state: &Self::State) -> u64 {
            state.node
        }
        fn at_node(state: Self::State, node: u64) -> Self::State {
            FreeBodyState {
                node: node,
                ..state
            }
        }
    }
    impl<T: Real> Reversible for FreeBody<T> {}
    ::clebsch::of_scalars! {
        [] FreeBodyParameters { J }
    }
    ::clebsch::of_scalars! {
        [] FreeBodyInitial { Λ, body_momentum }
    }
    ::clebsch::of_scalars! {
        [] FreeBodyState { Λ, momentum } at node
    }
    impl<T: Real> ::clebsch::integrate::Model for FreeBody<T> {
        type Parameters = FreeBodyParameters<T>;
        type Initial = FreeBodyInitial<T>;
        type Choice = Order;
        type Over<U: Real> = FreeBody<U>;
        const SIDE_BY_SIDE: bool = true;
        fn of(parameters: Self::Parameters) -> Result<Self, ParameterError> {
            Self::new(parameters)
        }
        fn given(&self) -> &Self::Parameters {
            &self.parameters
        }
        fn begin(&self, initial: Self::Initial) -> Result<FreeBodyState<T>, StartError> {
            validate::finite("Λ", &initial.Λ.quaternion())?;
            validate::finite("body_momentum", initial.body_momentum.0.as_slice())?;
            Ok(FreeBodyState {
                Λ: initial.Λ,
                momentum: initial.body_momentum.to_space(&initial.Λ),
                node: 0,
            })
        }
        fn prepared(
            &self,
            state: &FreeBodyState<T>,
            h: T,
            choice: Self::Choice,
        ) -> Result<Self::Workspace, StartError> {
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
        fn compensated(work: Self::Workspace) -> Self::Workspace {
            work.compensated()
        }
    }
    /// A configuration at one node, solution or not.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct FreeBodyConfiguration<T = f64> {
        /// `Λ` at the node: body -> space.
        pub Λ: Rotation<T>,
    }
    impl<T: Real> FreeBody<T> {
        /// The residual of the discrete Euler-Lagrange equations at the middle one of three
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
            let parts: [SVector<T, 3>; 1] = [
                axial_of_difference(&(J * Ω_before)) * t1
                    + axial_of_difference(&(J * Ω.transpose())) * t1,
            ];
            parts[0]
        }
    }
    impl<T: Real> FreeBody<T> {
        /// What the step of size `h` from one state to the next leaves of its equations: the
        /// momentum that is carried to the second state, less the one that the motion between
        /// them brings there. One part a configuration, angular and linear ones of a rigid
        /// motion apart, each with the size of the terms it is made of: those of a spatial
        /// velocity are the two elements it is made from, as they are stored.
        pub fn residual(
            &self,
            before: &FreeBodyState<T>,
            after: &FreeBodyState<T>,
            h: T,
        ) -> [Residual; 1] {
            let FreeBodyParameters { J, .. } = self.parameters;
            let Ω_matrix = before.Λ.body_velocity(&after.Λ).matrix();
            let t1 = h.powi(-1);
            let _ = h;
            [
                {
                    let momentum = after.momentum.to_body(&after.Λ).0;
                    Residual {
                        size: length(
                                &(momentum - (axial_of_difference(&(J * Ω_matrix)) * t1)),
                            )
                            .magnitude(),
                        scale: length(&momentum).magnitude()
                            + (T::from_f64(2.0) * (t1 * t1).sqrt()
                                * (J * J).trace().sqrt()
                                * (Ω_matrix.tr_mul(&Ω_matrix)).trace().sqrt())
                                .magnitude(),
                    }
                },
            ]
        }
    }
    impl<T: Real> FreeBody<T> {
        /// The kinetic and the potential energy at this node: those of the limit of small steps,
        /// at the node's momentum.
        pub fn energies(&self, state: &FreeBodyState<T>) -> (T, T) {
            let FreeBodyParameters { J, .. } = self.parameters;
            let parts: [SVector<T, 3>; 1] = [state.body_momentum().0];
            let momentum: SVector<T, 3> = parts[0];
            let inertia = SMatrix::<
                T,
                3,
                3,
            >::from_fn(|i, j| {
                let ξ = basis::<T>(i);
                let η = basis::<T>(j);
                T::from_f64(0.5) * J.trace()
                    * (vee(&η).dot(&vee(&ξ)) + vee(&ξ).dot(&vee(&η)))
                    - T::from_f64(0.5)
                        * (vee(&η).dot(&(J * vee(&ξ))) + vee(&ξ).dot(&(J * vee(&η))))
            });
            let velocity = solve_or_nan(&inertia, &momentum);
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
    }
    impl<T: Real> FreeBody<T> {
        /// The discrete energy of the edge between two consecutive states, `tr(J)/h² - tr(J Ω_k)/h²`: constant, since it holds the sum of the eigenvalues of the velocity times the left factor, the half of those of the Lax matrix that the principal solution takes.
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
    impl ::clebsch::integrate::Described for FreeBody<f64> {
        fn card() -> &'static Card {
            &Self::CARD
        }
        fn read(
            parameters: &[Vec<f64>],
            initial: &[Vec<f64>],
        ) -> Result<(Self, Self::Initial), OpenError> {
            let model = Self::new(FreeBodyParameters {
                J: matrix_of("J", parameters.get(0usize))?,
            })?;
            let initial = FreeBodyInitial {
                Λ: rotation_of("Λ", initial.get(0usize))?,
                body_momentum: BodyMomentum(
                    matrix_of("body_momentum", initial.get(1usize))?,
                ),
            };
            Ok((model, initial))
        }
        fn ways(
            self,
            state: &Self::State,
            settings: Settings,
        ) -> Result<(Self, Steps<Self>), OpenError> {
            let model = match chosen_solver(settings, Self::CARD.solvers)? {
                Some(method) => self.with_solver(method),
                None => self,
            };
            let steps = Steps::modified(&model, state, settings, Self::CARD.orders)?;
            Ok((model, steps))
        }
        fn judged(&self, state: &Self::State) -> Option<KineticWarning> {
            self.kinetic_warning(state)
        }
        fn left_over(&self, before: &Self::State, after: &Self::State, h: f64) -> f64 {
            Residual::largest(&self.residual(before, after, h))
        }
        fn observe(&self, state: &Self::State, out: &mut [f64]) {
            let out = put(out, rows(state.Λ().matrix()));
            let out = put(out, rows(state.body_momentum().0));
            let out = put(out, rows(state.spatial_momentum().0));
            let _ = out;
        }
        fn invariants(
            &self,
            state: &Self::State,
            work: Option<&Self::Workspace>,
            out: &mut [f64],
        ) {
            let out = put(out, [self.energy(state)]);
            let iterated = work.map(|w| w.solver.body_momentum().to_space(&state.Λ()));
            let out = put(out, rows(iterated.unwrap_or(state.spatial_momentum()).0));
            let out = put(out, [self.momentum_squared(state)]);
            let out = put(out, [self.momentum_quadratic(state)]);
            let _ = (state, out);
        }
        fn scales(&self, state: &Self::State, h: f64, out: &mut [f64]) {
            type T = f64;
            let FreeBodyParameters { J, .. } = self.parameters;
            let Λ = state.Λ.matrix();
            let μ = state.body_momentum().0;
            let t1 = Λ * μ;
            let t2 = μ.dot(&μ).sqrt();
            let out = put(out, [sum_of_sizes(self.energies(state)); 1usize]);
            let out = put(out, [t1.dot(&t1).sqrt(); 3usize]);
            let out = put(out, [t2 * t2; 1usize]);
            let out = put(out, [(J * J).trace() * (t2 * t2); 1usize]);
            let _ = (state, h, out);
        }
    }
    impl FreeBody<f64> {
        /// The model as data.
        pub const CARD: Card = Card {
            name: "FreeBody",
            kebab: "free-body",
            doc: "Free rigid body, body representation.",
            source: Self::SOURCE,
            fingerprint: Self::FINGERPRINT,
            summary: "discrete Lagrangian  -tr(J Ω_k)/h\nmomentum of Λ        -J Ω_kᵀ/h + Ω_k J/h\nRiccati form         exact, C = J\ninvariants           energy, spatial_momentum, momentum_squared, momentum_quadratic\ntime reversal        symmetric: second order\ncertificate          10 identities proved by normal form",
            solver: "Moser-Veselov: C is constant and no node term acts, so κ is conserved: solved once, every step explicit",
            order: 2u32,
            orders: &[2, 4, 6, 8, 10],
            preprocessed: true,
            reversible: true,
            parameters: &[
                Kind::SecondMoments.field("J", [3, 3], "Poinsot (second-moment) matrix"),
            ],
            initial: &[
                Kind::Rotation
                    .field("Λ", [3, 3], "attitude, body to space")
                    .spelt("Lambda"),
                Kind::BodyMomentum.field("body_momentum", [3, 1], "momentum, body frame"),
            ],
            observables: &[
                Kind::Rotation
                    .field("Λ", [3, 3], "attitude, body to space")
                    .spelt("Lambda"),
                Kind::BodyMomentum
                    .field("body_momentum", [3, 1], "momentum, body frame"),
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
            open: open::<Self>,
            solvers: &Method::NAMES,
            dimensions: &[],
            sized: only_size::<Self>,
        };
        /// What is wrong with the kinetic energy at a state, if anything: its Hessian in all
        /// velocities together, at the identity, should be positive definite.
        #[cold]
        #[allow(unused_variables)]
        pub fn kinetic_warning(
            &self,
            state: &FreeBodyState<f64>,
        ) -> Option<KineticWarning> {
            type T = f64;
            let FreeBodyParameters { J, .. } = self.parameters;
            let mut inertia = SMatrix::<T, 3, 3>::zeros();
            for axis in 0..3 {
                let ξ: SMatrix<T, 3, 3> = basis::<T>(axis);
                let t1 = vee(&ξ);
                let t2 = hat(&(t1 * (T::from_f64(0.5) * J.trace()))) * T::from_f64(0.5);
                let t3 = -(hat(&(J * t1 * T::from_f64(0.5))) * T::from_f64(0.5));
                let parts: [SVector<T, 3>; 1] = [
                    axial_of_difference(&(t2 + t2 + t3 + t3)),
                ];
                inertia.set_column(axis, &parts[0]);
            }
            KineticWarning::of(&inertia, 3)
        }
    }
}
#[allow(unused_imports)]
pub use free_body::*;
