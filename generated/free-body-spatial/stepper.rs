// Written by `clebsch derive --write`. Do not edit.

/// The model [`FreeBodySpatial`](struct@FreeBodySpatial) and what belongs to it.
#[allow(
    non_snake_case,
    uncommon_codepoints,
    mixed_script_confusables,
    confusable_idents,
    clippy::all
)]
pub mod free_body_spatial {
    use ::clebsch::emitted::*;
    /// Parameters of [`FreeBodySpatial`](struct@FreeBodySpatial), as given.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct FreeBodySpatialParameters<T = f64> {
        /// No parameters: the scalar type alone.
        pub scalar: ::core::marker::PhantomData<T>,
    }
    /// Free rigid body, spatial representation.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct FreeBodySpatial<T = f64> {
        parameters: FreeBodySpatialParameters<T>,
        method: Method,
    }
    impl<T: Real> FreeBodySpatial<T> {
        /// The model as it was stated.
        pub const SOURCE: &'static str = "/// Free rigid body, spatial representation.\npub model FreeBodySpatial {\n    /// attitude, body to space\n    group Λ: SO<3> velocity ω;\n    /// Poinsot (second-moment) matrix in space axes\n    advected J: Sym<3>;\n    /// reconstruction\n    constraint next(Λ) = ω*Λ;\n    /// the body carries its second moments along\n    constraint next(J) = ω*J*ω^T;\n    lagrangian = -tr(ω*J)/h;\n}";
        /// A number that changes when the model or its derivation does.
        pub const FINGERPRINT: u64 = 18057726445234217378u64;
        /// Checks the parameters.
        ///
        /// # Errors
        /// Names the parameter that is not finite, lacks its stated symmetry, breaks an
        /// assumption, or is no admissible factor of the equation to solve.
        pub fn new(
            parameters: FreeBodySpatialParameters<T>,
        ) -> Result<Self, ParameterError> {
            Ok(Self {
                parameters,
                method: Method::of_size(3),
            })
        }
        /// The same model, its steps solved by the solver named.
        #[must_use]
        pub fn with_solver(self, method: Method) -> Self {
            Self { method, ..self }
        }
        /// The parameters.
        pub fn parameters(&self) -> &FreeBodySpatialParameters<T> {
            &self.parameters
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
    /// What moves, at one node: comparable, to be saved. The momentum is kept in the space frame, advected quantities by their value carried back to the identity, so that roundoff does not accumulate.
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
        /// The number of the node.
        pub fn node(&self) -> u64 {
            self.node
        }
    }
    /// The step and the constants of the trajectory. Made anew for a state of another body.
    #[derive(Clone, Copy, Debug)]
    pub struct FreeBodySpatialWorkspace<T = f64> {
        h: T,
        solver: Free<T>,
        J: SMatrix<T, 3, 3>,
    }
    ::clebsch::saved! {
        [] FreeBodySpatialWorkspace { h, solver, J }
    }
    impl<T: Real> FreeBodySpatialWorkspace<T> {
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
    impl<T: Real> FreeBodySpatial<T> {
        /// Starts a trajectory with step `h` from data at node 0.
        ///
        /// # Errors
        /// Names the value that is not admissible, or says why the first step cannot be solved and
        /// which could.
        pub fn start(
            &self,
            initial: FreeBodySpatialInitial<T>,
            h: T,
        ) -> Result<(FreeBodySpatialState<T>, FreeBodySpatialWorkspace<T>), StartError> {
            ::clebsch::integrate::Model::start_with(self, initial, h, Default::default())
        }
        /// As `start`, with steps of this order: see [`Order`].
        ///
        /// # Errors
        /// As `start`; also for what this size or scalar does not have.
        pub fn start_with(
            &self,
            initial: FreeBodySpatialInitial<T>,
            h: T,
            choice: Order,
        ) -> Result<(FreeBodySpatialState<T>, FreeBodySpatialWorkspace<T>), StartError> {
            ::clebsch::integrate::Model::start_with(self, initial, h, choice)
        }
        /// A workspace for steps of `h`, of either sign, from any state; errors as of `start`.
        pub fn workspace(
            &self,
            state: &FreeBodySpatialState<T>,
            h: T,
        ) -> Result<FreeBodySpatialWorkspace<T>, StartError> {
            self.prepare(state, h, Default::default())
        }
        /// The body behind the quantities of a state.
        #[inline(never)]
        fn factor(
            &self,
            state: &FreeBodySpatialState<T>,
        ) -> Result<Poinsot<T>, ParameterError> {
            let J = state.J;
            Poinsot::new(J).map_err(|e| e.in_field("J_k"))
        }
        /// One step, in place. Solved thus: C is carried by the motion, constant in the body, and no node term acts, so κ is conserved: solved once, every step explicit.
        ///
        /// # Errors
        /// When the step cannot be solved, with numbers and a remedy; the state is then unchanged.
        #[inline]
        pub fn step(
            &self,
            state: &mut FreeBodySpatialState<T>,
            work: &mut FreeBodySpatialWorkspace<T>,
        ) -> Result<(), StepError> {
            if !(same(&work.J, &state.J)) {
                let Ok(factor) = self.factor(state) else {
                    return Err(
                        StepCause::NotFinite {
                            what: "body",
                        }
                            .at_node(state.node),
                    );
                };
                if let Err(e) = work
                    .solver
                    .restart_as(&factor, &state.Λ, &state.momentum)
                {
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
            let J = Λ * (J_reference * Λ.transpose());
            J
        }
    }
    impl<T: Real> Stepper for FreeBodySpatial<T> {
        type Scalar = T;
        type State = FreeBodySpatialState<T>;
        type Workspace = FreeBodySpatialWorkspace<T>;
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
            FreeBodySpatialState {
                node: node,
                ..state
            }
        }
    }
    impl<T: Real> Reversible for FreeBodySpatial<T> {}
    ::clebsch::of_scalars! {
        [] FreeBodySpatialParameters { scalar }
    }
    ::clebsch::of_scalars! {
        [] FreeBodySpatialInitial { Λ, spatial_momentum, J }
    }
    ::clebsch::of_scalars! {
        [] FreeBodySpatialState { Λ, momentum, J } at node
    }
    impl<T: Real> ::clebsch::integrate::Model for FreeBodySpatial<T> {
        type Parameters = FreeBodySpatialParameters<T>;
        type Initial = FreeBodySpatialInitial<T>;
        type Choice = Order;
        type Over<U: Real> = FreeBodySpatial<U>;
        const SIDE_BY_SIDE: bool = true;
        fn of(parameters: Self::Parameters) -> Result<Self, ParameterError> {
            Self::new(parameters)
        }
        fn given(&self) -> &Self::Parameters {
            &self.parameters
        }
        fn begin(
            &self,
            initial: Self::Initial,
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
        fn prepared(
            &self,
            state: &FreeBodySpatialState<T>,
            h: T,
            choice: Self::Choice,
        ) -> Result<Self::Workspace, StartError> {
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
        fn compensated(work: Self::Workspace) -> Self::Workspace {
            work.compensated()
        }
    }
    /// A configuration at one node, solution or not.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct FreeBodySpatialConfiguration<T = f64> {
        /// `Λ` at the node: body -> space.
        pub Λ: Rotation<T>,
        /// `J` at the node, as its constraint carries it.
        pub J: SMatrix<T, 3, 3>,
    }
    impl<T: Real> FreeBodySpatial<T> {
        /// The residual of the discrete Euler-Lagrange equations at the middle one of three
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
            let parts: [SVector<T, 3>; 1] = [
                axial_of_difference(&(ω_before * J_before)) * t1
                    - axial_of_difference(&(ω * J)) * t1,
            ];
            parts[0]
        }
    }
    impl<T: Real> FreeBodySpatial<T> {
        /// What the step of size `h` from one state to the next leaves of its equations: the
        /// momentum that is carried to the second state, less the one that the motion between
        /// them brings there. One part a configuration, angular and linear ones of a rigid
        /// motion apart, each with the size of the terms it is made of: those of a spatial
        /// velocity are the two elements it is made from, as they are stored.
        pub fn residual(
            &self,
            before: &FreeBodySpatialState<T>,
            after: &FreeBodySpatialState<T>,
            h: T,
        ) -> [Residual; 1] {
            let ω_matrix = before.Λ.spatial_velocity(&after.Λ).matrix();
            let Λ = before.Λ.matrix();
            let J_reference = before.J;
            let J = Λ * (J_reference * Λ.transpose());
            let t1 = h.powi(-1);
            let _ = h;
            [
                {
                    let momentum = after.momentum.0;
                    Residual {
                        size: length(
                                &(momentum - (axial_of_difference(&(ω_matrix * J)) * t1)),
                            )
                            .magnitude(),
                        scale: length(&momentum).magnitude()
                            + (T::from_f64(2.0) * (t1 * t1).sqrt()
                                * (ω_matrix.tr_mul(&ω_matrix)).trace().sqrt()
                                * (J * J).trace().sqrt())
                                .magnitude(),
                    }
                },
            ]
        }
    }
    impl<T: Real> FreeBodySpatial<T> {
        /// The kinetic and the potential energy at this node: those of the limit of small steps,
        /// at the node's momentum.
        pub fn energies(&self, state: &FreeBodySpatialState<T>) -> (T, T) {
            let Λ = state.Λ.matrix();
            let J_reference = state.J;
            let J = Λ * (J_reference * Λ.transpose());
            let parts: [SVector<T, 3>; 1] = [state.spatial_momentum().0];
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
        pub fn energy(&self, state: &FreeBodySpatialState<T>) -> T {
            let (kinetic, potential) = self.energies(state);
            kinetic + potential
        }
        /// `tr(J_k)`: Casimir: invariant under the group action.
        pub fn trace_J1(&self, state: &FreeBodySpatialState<T>) -> T {
            let Λ = state.Λ.matrix();
            let J_reference = state.J;
            let J = Λ * (J_reference * Λ.transpose());
            J.trace()
        }
        /// `tr(J_k²)`: Casimir: invariant under the group action.
        pub fn trace_J2(&self, state: &FreeBodySpatialState<T>) -> T {
            let Λ = state.Λ.matrix();
            let J_reference = state.J;
            let J = Λ * (J_reference * Λ.transpose());
            (J * J).trace()
        }
        /// `tr(J_k³)`: Casimir: invariant under the group action.
        pub fn trace_J3(&self, state: &FreeBodySpatialState<T>) -> T {
            let Λ = state.Λ.matrix();
            let J_reference = state.J;
            let J = Λ * (J_reference * Λ.transpose());
            (J * (J * J)).trace()
        }
        /// `m_k·(J_k² m_k)`: Manakov integral, quadratic in the momentum.
        pub fn momentum_quadratic(&self, state: &FreeBodySpatialState<T>) -> T {
            let Λ = state.Λ.matrix();
            let J_reference = state.J;
            let J = Λ * (J_reference * Λ.transpose());
            let m = state.spatial_momentum().0;
            m.dot(&(J * (J * m)))
        }
    }
    impl<T: Real> FreeBodySpatial<T> {
        /// The discrete energy of the edge between two consecutive states, `-tr(ω_k J_k)/h² + tr(J_k)/h²`: constant, since it holds the sum of the eigenvalues of the velocity times the left factor, the half of those of the Lax matrix that the principal solution takes.
        pub fn discrete_energy(
            &self,
            h: T,
            before: &FreeBodySpatialState<T>,
            after: &FreeBodySpatialState<T>,
        ) -> T {
            let ω_matrix = before.Λ.spatial_velocity(&after.Λ).matrix();
            let Λ = before.Λ.matrix();
            let J_reference = before.J;
            let J = Λ * (J_reference * Λ.transpose());
            -((less_identity(&ω_matrix) * J).trace() / (h * h))
        }
    }
    impl ::clebsch::integrate::Described for FreeBodySpatial<f64> {
        fn card() -> &'static Card {
            &Self::CARD
        }
        fn read(
            parameters: &[Vec<f64>],
            initial: &[Vec<f64>],
        ) -> Result<(Self, Self::Initial), OpenError> {
            let model = Self::new(FreeBodySpatialParameters {
                scalar: ::core::marker::PhantomData,
            })?;
            let initial = FreeBodySpatialInitial {
                Λ: rotation_of("Λ", initial.get(0usize))?,
                spatial_momentum: SpatialMomentum(
                    matrix_of("spatial_momentum", initial.get(1usize))?,
                ),
                J: matrix_of("J", initial.get(2usize))?,
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
            let out = put(out, rows(self.J(state)));
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
            let out = put(out, [self.trace_J1(state)]);
            let out = put(out, [self.trace_J2(state)]);
            let out = put(out, [self.trace_J3(state)]);
            let out = put(out, [self.momentum_quadratic(state)]);
            let _ = (state, out);
        }
        fn scales(&self, state: &Self::State, h: f64, out: &mut [f64]) {
            type T = f64;
            let Λ = state.Λ.matrix();
            let J_reference = state.J;
            let J = Λ * (J_reference * Λ.transpose());
            let m = state.spatial_momentum().0;
            let t1 = m.dot(&m).sqrt();
            let t2 = (J * J).trace();
            let t3 = t2.sqrt();
            let out = put(out, [sum_of_sizes(self.energies(state)); 1usize]);
            let out = put(out, [t1; 3usize]);
            let out = put(out, [T::from_f64(3.0).sqrt() * t3; 1usize]);
            let out = put(out, [t3 * t3; 1usize]);
            let out = put(out, [t3 * t3 * t3; 1usize]);
            let out = put(out, [t2 * (t1 * t1); 1usize]);
            let _ = (state, h, out);
        }
    }
    impl FreeBodySpatial<f64> {
        /// The model as data.
        pub const CARD: Card = Card {
            name: "FreeBodySpatial",
            kebab: "free-body-spatial",
            doc: "Free rigid body, spatial representation.",
            source: Self::SOURCE,
            fingerprint: Self::FINGERPRINT,
            summary: "discrete Lagrangian  -tr(ω_k J_k)/h\nmomentum of Λ        ω_k J_k/h - J_k ω_kᵀ/h\nRiccati form         exact, C = J_k\ninvariants           energy, spatial_momentum, trace_J1, trace_J2, trace_J3, momentum_quadratic\ntime reversal        symmetric: second order\ncertificate          16 identities proved by normal form",
            solver: "Moser-Veselov: C is carried by the motion, constant in the body, and no node term acts, so κ is conserved: solved once, every step explicit",
            order: 2u32,
            orders: &[2, 4, 6, 8, 10],
            preprocessed: true,
            reversible: true,
            parameters: &[],
            initial: &[
                Kind::Rotation
                    .field("Λ", [3, 3], "attitude, body to space")
                    .spelt("Lambda"),
                Kind::SpatialMomentum
                    .field("spatial_momentum", [3, 1], "momentum, space frame"),
                Kind::SecondMoments
                    .field("J", [3, 3], "Poinsot (second-moment) matrix in space axes"),
            ],
            observables: &[
                Kind::Rotation
                    .field("Λ", [3, 3], "attitude, body to space")
                    .spelt("Lambda"),
                Kind::BodyMomentum
                    .field("body_momentum", [3, 1], "momentum, body frame"),
                Kind::SpatialMomentum
                    .field("spatial_momentum", [3, 1], "momentum, space frame"),
                Kind::SecondMoments
                    .field("J", [3, 3], "Poinsot (second-moment) matrix in space axes"),
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
            state: &FreeBodySpatialState<f64>,
        ) -> Option<KineticWarning> {
            type T = f64;
            let Λ = state.Λ.matrix();
            let J_reference = state.J;
            let J = Λ * (J_reference * Λ.transpose());
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
pub use free_body_spatial::*;
