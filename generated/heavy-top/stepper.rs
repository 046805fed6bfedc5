// Written by `clebsch derive --write`. Do not edit.

/// The model [`HeavyTop`](struct@HeavyTop) and what belongs to it.
#[allow(
    non_snake_case,
    uncommon_codepoints,
    mixed_script_confusables,
    confusable_idents,
    clippy::all
)]
pub mod heavy_top {
    use ::clebsch::emitted::*;
    /// Parameters of [`HeavyTop`](struct@HeavyTop), as given.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct HeavyTopParameters<T = f64> {
        /// `J`: Poinsot (second-moment) matrix; a 3 x 3 matrix, symmetric.
        pub J: SMatrix<T, 3, 3>,
        /// `gU`: weight times support -> centre of mass, body frame; a vector of 3 components.
        pub gU: SVector<T, 3>,
        /// `z`: vertical (up), space frame; a vector of 3 components.
        pub z: SVector<T, 3>,
    }
    /// Heavy top, body representation.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct HeavyTop<T = f64> {
        parameters: HeavyTopParameters<T>,
        factor: Poinsot<T>,
        method: Method,
    }
    impl<T: Real> HeavyTop<T> {
        /// The model as it was stated.
        pub const SOURCE: &'static str = "/// Heavy top, body representation.\npub model HeavyTop {\n    /// Poinsot (second-moment) matrix\n    param J: Sym<3>;\n    /// weight times support -> centre of mass, body frame\n    param gU: Vec<3> as \"m g \\chi\";\n    /// vertical (up), space frame\n    param z: Vec<3>;\n    /// attitude, body to space\n    group Λ: SO<3> velocity Ω;\n    /// the vertical seen from the body\n    advected Γ: Vec<3> = Λ^T*z;\n    /// reconstruction\n    constraint next(Λ) = Λ*Ω;\n    /// how Γ is carried\n    constraint next(Γ) = Ω^T*Γ;\n    lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ);\n}";
        /// A number that changes when the model or its derivation does.
        pub const FINGERPRINT: u64 = 13467537385938448784u64;
        /// Checks the parameters.
        ///
        /// # Errors
        /// Names the parameter that is not finite, lacks its stated symmetry, breaks an
        /// assumption, or is no admissible factor of the equation to solve.
        pub fn new(parameters: HeavyTopParameters<T>) -> Result<Self, ParameterError> {
            validate::finite_entries("J", &parameters.J)?;
            validate::symmetric("J", &parameters.J)?;
            validate::finite("gU", parameters.gU.as_slice())?;
            validate::finite("z", parameters.z.as_slice())?;
            let HeavyTopParameters { J, .. } = parameters;
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
        pub fn parameters(&self) -> &HeavyTopParameters<T> {
            &self.parameters
        }
    }
    /// Initial data.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct HeavyTopInitial<T = f64> {
        /// `Λ` at node 0: body -> space.
        pub Λ: Rotation<T>,
        /// Momentum at node 0, in the body frame.
        pub body_momentum: BodyMomentum<T>,
    }
    /// What moves, at one node: comparable, to be saved. The momentum is kept in the space frame, advected quantities by their value carried back to the identity, so that roundoff does not accumulate.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct HeavyTopState<T = f64> {
        Λ: Rotation<T>,
        momentum: SpatialMomentum<T>,
        node: u64,
    }
    impl<T: Real> HeavyTopState<T> {
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
    /// The step, the solver's name, and the momentum of the edge that begins at the state `here`. Made anew for any other state.
    #[derive(Clone, Copy, Debug)]
    pub struct HeavyTopWorkspace<T = f64> {
        h: T,
        method: Method,
        edge: Edge<T>,
        here: HeavyTopState<T>,
    }
    impl<T: Real> HeavyTop<T> {
        /// Starts a trajectory with step `h` from data at node 0, with the model's solver.
        ///
        /// # Errors
        /// Names the value that is not finite, or says why the first step cannot be solved and
        /// which step could.
        pub fn start(
            &self,
            initial: HeavyTopInitial<T>,
            h: T,
        ) -> Result<(HeavyTopState<T>, HeavyTopWorkspace<T>), StartError> {
            self.start_with(initial, h, self.method)
        }
        /// As `start`, with the solver named.
        ///
        /// # Errors
        /// As `start`; also when the solver does not serve this size or scalar.
        pub fn start_with(
            &self,
            initial: HeavyTopInitial<T>,
            h: T,
            method: Method,
        ) -> Result<(HeavyTopState<T>, HeavyTopWorkspace<T>), StartError> {
            validate::positive_step(h)?;
            let state = self.at_node_0(initial)?;
            Ok((state, self.workspace_with(&state, h, method)?))
        }
        /// The state at node 0.
        fn at_node_0(
            &self,
            initial: HeavyTopInitial<T>,
        ) -> Result<HeavyTopState<T>, StartError> {
            validate::finite("Λ", &initial.Λ.quaternion())?;
            validate::finite("body_momentum", initial.body_momentum.0.as_slice())?;
            Ok(HeavyTopState {
                Λ: initial.Λ,
                momentum: initial.body_momentum.to_space(&initial.Λ),
                node: 0,
            })
        }
        /// A workspace for steps of `h`, of either sign, from any state.
        ///
        /// # Errors
        /// When `h` is zero or not finite, or the first step cannot be solved.
        pub fn workspace(
            &self,
            state: &HeavyTopState<T>,
            h: T,
        ) -> Result<HeavyTopWorkspace<T>, StartError> {
            self.workspace_with(state, h, self.method)
        }
        /// The same with the solver named.
        ///
        /// # Errors
        /// When `h` is zero or not finite, or the first step cannot be solved.
        pub fn workspace_with(
            &self,
            state: &HeavyTopState<T>,
            h: T,
            method: Method,
        ) -> Result<HeavyTopWorkspace<T>, StartError> {
            validate::directed_step(h)?;
            let state = *state;
            let work = HeavyTopWorkspace {
                h,
                method,
                edge: self.edge(&state, h),
                here: state,
            };
            let (mut trial, mut scratch) = (state, work);
            self.step(&mut trial, &mut scratch)
                .map_err(|e| StartError::Refused(e.cause))?;
            Ok(work)
        }
        /// One step, in place. Solved thus: C is constant and symmetric: explicit up to the root of one quartic per step.
        ///
        /// # Errors
        /// When the step cannot be solved, with numbers and a remedy; the state is then unchanged.
        #[inline]
        pub fn step(
            &self,
            state: &mut HeavyTopState<T>,
            work: &mut HeavyTopWorkspace<T>,
        ) -> Result<(), StepError> {
            let h = work.h;
            if work.here.Λ != state.Λ || work.here.momentum != state.momentum {
                work.edge = self.edge(state, h);
                work.here = *state;
            }
            let edge = &work.edge;
            let turned = match work.method {
                Method::Kappa => edge.turn(&self.factor, h, &state.Λ),
                method => edge.turn_by(method, &self.factor, h, &state.Λ),
            };
            let Λ_moved = match turned {
                Ok(turned) => turned,
                Err(e) => return Err(self.refused(*state, &self.factor, h, e)),
            };
            let arrival = self.arrived(state, edge, h, Λ_moved);
            if !(all_finite(&arrival.momentum.0)) {
                return Err(
                    StepCause::NotFinite {
                        what: "momentum",
                    }
                        .at_node(state.node),
                );
            }
            (state.Λ, work.here.Λ) = (arrival.attitude, arrival.attitude);
            (state.momentum, work.here.momentum) = (arrival.momentum, arrival.momentum);
            state.node += 1;
            work.edge = arrival.edge;
            Ok(())
        }
        /// The next node and the edge that begins there, given the attitude there.
        #[inline(always)]
        fn arrived(
            &self,
            state: &HeavyTopState<T>,
            edge: &Edge<T>,
            h: T,
            Λ_moved: TurnedRotation<T>,
        ) -> Moving<T> {
            let HeavyTopParameters { gU, z, .. } = self.parameters;
            let Λ_next = Λ_moved.matrix();
            let Γ_next = Λ_next.tr_mul(&z);
            let space = edge.space();
            let torque = -(gU * h).cross(&Γ_next);
            let kick = Λ_next * torque;
            let momentum_next = space + kick * T::from_f64(0.5);
            let edge_next = Edge::new(Λ_next.tr_mul(&space) + torque, space + kick);
            Moving {
                attitude: Λ_moved.rotation(),
                momentum: SpatialMomentum(momentum_next),
                edge: edge_next,
            }
        }
        /// The edge that begins at this state, for a step `h`.
        #[inline(never)]
        fn edge(&self, state: &HeavyTopState<T>, h: T) -> Edge<T> {
            let HeavyTopParameters { gU, z, .. } = self.parameters;
            let Λ = state.Λ.matrix();
            let Γ = Λ.tr_mul(&z);
            let kick = gU.cross(&Γ) * T::from_f64(0.5) * h;
            Edge::new(Λ.tr_mul(&state.momentum.0) - kick, state.momentum.0 - Λ * kick)
        }
        /// Says how far the step is beyond the bound, and which step could be solved.
        #[cold]
        fn refused(
            &self,
            state: HeavyTopState<T>,
            factor: &Poinsot<T>,
            h: T,
            e: MoserVeselovError,
        ) -> StepError {
            let e = e
                .with_searched_step(factor, h, |trial| self.edge(&state, trial).body());
            StepCause::from(e).at_node(state.node)
        }
        /// `Γ` at the node of this state.
        #[inline]
        pub fn Γ(&self, state: &HeavyTopState<T>) -> SVector<T, 3> {
            let HeavyTopParameters { z, .. } = self.parameters;
            let Λ = state.Λ.matrix();
            let Γ = Λ.tr_mul(&z);
            Γ
        }
    }
    impl<T: Real> Stepper for HeavyTop<T> {
        type Scalar = T;
        type State = HeavyTopState<T>;
        type Workspace = HeavyTopWorkspace<T>;
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
        #[inline(always)]
        fn advance_many(
            &self,
            state: &mut Self::State,
            work: &mut Self::Workspace,
            count: u64,
        ) -> Result<(), StepError> {
            if T::LANES > 1 {
                return advance_side_by_side(self, state, work, count);
            }
            for _ in 0..count {
                self.step(state, work)?;
            }
            Ok(())
        }
        fn node(state: &Self::State) -> u64 {
            state.node
        }
        fn at_node(state: Self::State, node: u64) -> Self::State {
            HeavyTopState {
                node: node,
                ..state
            }
        }
    }
    impl<T: Real> SideBySide for HeavyTop<T> {
        #[inline(always)]
        fn moving(
            &self,
            state: &HeavyTopState<T>,
            work: &HeavyTopWorkspace<T>,
        ) -> Option<Moving<T>> {
            let another = work.method != Method::Kappa || work.here.Λ != state.Λ
                || work.here.momentum != state.momentum;
            (!another)
                .then_some(Moving {
                    attitude: state.Λ,
                    momentum: state.momentum,
                    edge: work.edge,
                })
        }
        #[inline(always)]
        fn arrive(
            state: &mut HeavyTopState<T>,
            work: &mut HeavyTopWorkspace<T>,
            moving: &Moving<T>,
            steps: u64,
        ) {
            (state.Λ, state.momentum) = (moving.attitude, moving.momentum);
            state.node += steps;
            (work.here, work.edge) = (*state, moving.edge);
        }
        #[inline(always)]
        fn is_diagonal(&self, work: &HeavyTopWorkspace<T>) -> bool {
            let _ = work;
            self.factor.is_diagonal()
        }
        #[inline(always)]
        fn step_lanes<const DIAGONAL: bool>(
            &self,
            state: &HeavyTopState<T>,
            work: &HeavyTopWorkspace<T>,
            from: &Moving<T>,
            to: &mut Moving<T>,
        ) -> bool {
            let mut easy = true;
            for lane in 0..T::LANES {
                let (attitude, edge) = from.from(lane);
                let (h, factor) = (work.h.one_of(lane), self.factor.in_lane(lane));
                let (turned, found) = edge
                    .turn_at_once::<DIAGONAL>(&factor, h, &attitude);
                let model = HeavyTop::<<T as Real>::One> {
                    parameters: HeavyTopParameters {
                        J: self.parameters.J.in_lane(lane),
                        gU: self.parameters.gU.in_lane(lane),
                        z: self.parameters.z.in_lane(lane),
                    },
                    factor: self.factor.in_lane(lane),
                    method: self.method,
                };
                let state = HeavyTopState::<<T as Real>::One> {
                    Λ: attitude,
                    momentum: from.momentum.in_lane(lane),
                    node: state.node,
                };
                easy &= found & to.set(lane, model.arrived(&state, &edge, h, turned));
            }
            easy
        }
    }
    impl<T: Real> Reversible for HeavyTop<T> {}
    impl<T: Real> ::clebsch::OfScalars for HeavyTopParameters<T> {
        type Scalar = T;
        type Over<U: Real> = HeavyTopParameters<U>;
        fn over<U: Real>(
            &self,
            change: &mut impl FnMut(T) -> U,
        ) -> HeavyTopParameters<U> {
            HeavyTopParameters {
                J: self.J.over(change),
                gU: self.gU.over(change),
                z: self.z.over(change),
            }
        }
    }
    impl<T: Real> ::clebsch::OfScalars for HeavyTopInitial<T> {
        type Scalar = T;
        type Over<U: Real> = HeavyTopInitial<U>;
        fn over<U: Real>(&self, change: &mut impl FnMut(T) -> U) -> HeavyTopInitial<U> {
            HeavyTopInitial {
                Λ: self.Λ.over(change),
                body_momentum: self.body_momentum.over(change),
            }
        }
    }
    impl<T: Real> ::clebsch::OfScalars for HeavyTopState<T> {
        type Scalar = T;
        type Over<U: Real> = HeavyTopState<U>;
        fn over<U: Real>(&self, change: &mut impl FnMut(T) -> U) -> HeavyTopState<U> {
            HeavyTopState {
                Λ: self.Λ.over(change),
                momentum: self.momentum.over(change),
                node: self.node,
            }
        }
    }
    impl<T: Real> ::clebsch::integrate::Model for HeavyTop<T> {
        type Parameters = HeavyTopParameters<T>;
        type Initial = HeavyTopInitial<T>;
        type Choice = ();
        type Over<U: Real> = HeavyTop<U>;
        const SIDE_BY_SIDE: bool = true;
        fn of(parameters: Self::Parameters) -> Result<Self, ParameterError> {
            Self::new(parameters)
        }
        fn given(&self) -> &Self::Parameters {
            &self.parameters
        }
        fn begin(&self, initial: Self::Initial) -> Result<HeavyTopState<T>, StartError> {
            self.at_node_0(initial)
        }
        fn prepare(
            &self,
            state: &HeavyTopState<T>,
            h: T,
            _: Self::Choice,
        ) -> Result<Self::Workspace, StartError> {
            self.workspace(state, h)
        }
    }
    /// A configuration at one node, solution or not.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct HeavyTopConfiguration<T = f64> {
        /// `Λ` at the node: body -> space.
        pub Λ: Rotation<T>,
    }
    impl<T: Real> HeavyTop<T> {
        /// The residual of the discrete Euler-Lagrange equations at the middle one of three
        /// consecutive configurations: component `i` is the derivative of the action of the
        /// two edges when the middle element is rotated about its axis `i` (a body axis on
        /// the body side, a space axis on the spatial side). Zero on solutions.
        pub fn balance(
            &self,
            h: T,
            before: &HeavyTopConfiguration<T>,
            here: &HeavyTopConfiguration<T>,
            after: &HeavyTopConfiguration<T>,
        ) -> SVector<T, 3> {
            let HeavyTopParameters { J, gU, z, .. } = self.parameters;
            let Λ = here.Λ.matrix();
            let Γ = Λ.tr_mul(&z);
            let Ω_before = before.Λ.body_velocity(&here.Λ).matrix();
            let Ω = here.Λ.body_velocity(&after.Λ).matrix();
            let t1 = h.powi(-1);
            let t2 = -(gU.cross(&Γ) * T::from_f64(0.5) * h);
            let parts: [SVector<T, 3>; 1] = [
                axial_of_difference(&(J * Ω_before)) * t1 + t2
                    + axial_of_difference(&(J * Ω.transpose())) * t1 + t2,
            ];
            parts[0]
        }
    }
    impl<T: Real> HeavyTop<T> {
        /// What the step of size `h` from one state to the next leaves of its equations: the
        /// momentum that is carried to the second state, less the one that the motion between
        /// them brings there. One part a configuration, angular and linear ones of a rigid
        /// motion apart, each with the size of the terms it is made of: those of a spatial
        /// velocity are the two elements it is made from, as they are stored.
        pub fn residual(
            &self,
            before: &HeavyTopState<T>,
            after: &HeavyTopState<T>,
            h: T,
        ) -> [Residual; 1] {
            let HeavyTopParameters { J, gU, z, .. } = self.parameters;
            let Ω_matrix = before.Λ.body_velocity(&after.Λ).matrix();
            let Λ_next = after.Λ.matrix();
            let Γ_next = Λ_next.tr_mul(&z);
            let t1 = h.powi(-1);
            let _ = h;
            [
                {
                    let momentum = after.momentum.to_body(&after.Λ).0;
                    Residual {
                        size: length(
                                &(momentum
                                    - (axial_of_difference(&(J * Ω_matrix)) * t1
                                        - gU.cross(&Γ_next) * T::from_f64(0.5) * h)),
                            )
                            .magnitude(),
                        scale: length(&momentum).magnitude()
                            + (T::from_f64(2.0) * (t1 * t1).sqrt()
                                * (J * J).trace().sqrt()
                                * (Ω_matrix.tr_mul(&Ω_matrix)).trace().sqrt()
                                + T::from_f64(0.5) * (h * h).sqrt() * gU.dot(&gU).sqrt()
                                    * Γ_next.dot(&Γ_next).sqrt())
                                .magnitude(),
                    }
                },
            ]
        }
    }
    impl<T: Real> HeavyTop<T> {
        /// The kinetic and the potential energy at this node: those of the limit of small steps,
        /// at the node's momentum.
        pub fn energies(&self, state: &HeavyTopState<T>) -> (T, T) {
            let HeavyTopParameters { J, gU, z, .. } = self.parameters;
            let Λ = state.Λ.matrix();
            let Γ = Λ.tr_mul(&z);
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
            (momentum.dot(&velocity) * T::from_f64(0.5), gU.dot(&Γ))
        }
        /// The physical energy at this node.
        pub fn energy(&self, state: &HeavyTopState<T>) -> T {
            let (kinetic, potential) = self.energies(state);
            kinetic + potential
        }
        /// `μ_k·Γ_k`: Casimir: the Kelvin-Noether quantity of the advected quantities.
        pub fn momentum_Gamma(&self, state: &HeavyTopState<T>) -> T {
            let HeavyTopParameters { z, .. } = self.parameters;
            let Λ = state.Λ.matrix();
            let Γ = Λ.tr_mul(&z);
            let μ = state.body_momentum().0;
            μ.dot(&Γ)
        }
        /// `Γ_k·Γ_k`: Casimir: invariant under the group action.
        pub fn Gamma_squared(&self, state: &HeavyTopState<T>) -> T {
            let HeavyTopParameters { z, .. } = self.parameters;
            let Λ = state.Λ.matrix();
            let Γ = Λ.tr_mul(&z);
            Γ.dot(&Γ)
        }
    }
    impl<T: Real> HeavyTop<T> {
        /// The discrete energy of the edge between two consecutive states, `tr(J)/h² - tr(J Ω_k)/h² + ½ gU·Γ_k + ½ gU·Γ_{k+1}`: bounded, since the stepper is symplectic.
        pub fn discrete_energy(
            &self,
            h: T,
            before: &HeavyTopState<T>,
            after: &HeavyTopState<T>,
        ) -> T {
            let HeavyTopParameters { J, gU, z, .. } = self.parameters;
            let Ω_matrix = before.Λ.body_velocity(&after.Λ).matrix();
            let Λ = before.Λ.matrix();
            let Γ = Λ.tr_mul(&z);
            let Λ_next = after.Λ.matrix();
            let Γ_next = Λ_next.tr_mul(&z);
            T::from_f64(0.5) * gU.dot(&Γ) + T::from_f64(0.5) * gU.dot(&Γ_next)
                - h.powi(-2) * (J * less_identity(&Ω_matrix)).trace()
        }
    }
    /// One trajectory of the model, its type hidden.
    struct HeavyTopTrajectory {
        model: HeavyTop<f64>,
        state: HeavyTopState<f64>,
        steps: Steps<HeavyTop<f64>>,
        h: f64,
        /// The state before the last step.
        before: HeavyTopState<f64>,
        /// Whether a step is one of the derivation, not composed and without modified moments.
        plain: bool,
        kinetic: Option<KineticWarning>,
    }
    impl Trajectory for HeavyTopTrajectory {
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
            &HeavyTop::<f64>::CARD
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
            let out = put(out, rows(state.Λ().matrix()));
            let out = put(out, rows(state.body_momentum().0));
            let out = put(out, rows(state.spatial_momentum().0));
            let out = put(out, rows(self.model.Γ(state)));
            let _ = out;
        }
        fn invariants(&self, out: &mut [f64]) {
            let state = &self.state;
            let out = put(out, [self.model.energy(state)]);
            let out = put(out, [self.model.momentum_Gamma(state)]);
            let out = put(out, [self.model.Gamma_squared(state)]);
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
                    let HeavyTopParameters { z, .. } = self.model.parameters;
                    let Λ = state.Λ.matrix();
                    let Γ = Λ.tr_mul(&z);
                    let μ = state.body_momentum().0;
                    let value: T = μ.dot(&μ).sqrt() * Γ.dot(&Γ).sqrt();
                    value
                }; 1usize],
            );
            let out = put(
                out,
                [{
                    type T = f64;
                    let HeavyTopParameters { z, .. } = self.model.parameters;
                    let Λ = state.Λ.matrix();
                    let Γ = Λ.tr_mul(&z);
                    let t1 = Γ.dot(&Γ).sqrt();
                    let value: T = t1 * t1;
                    value
                }; 1usize],
            );
            let _ = out;
        }
    }
    impl HeavyTop<f64> {
        /// The model as data.
        pub const CARD: Card = Card {
            name: "HeavyTop",
            kebab: "heavy-top",
            doc: "Heavy top, body representation.",
            source: Self::SOURCE,
            fingerprint: Self::FINGERPRINT,
            summary: "action of one step   -tr(J Ω_k)/h - ½ h gU·Γ_k - ½ h gU·Γ_{k+1}\nmomentum of Λ        -J Ω_kᵀ/h + Ω_k J/h\nRiccati form         exact, C = J\ninvariants           energy, momentum_Gamma, Gamma_squared\ntime reversal        symmetric: second order\ncertificate          17 identities proved by normal form",
            solver: "Moser-Veselov: C is constant and symmetric: explicit up to the root of one quartic per step",
            order: 2u32,
            orders: &[2, 4, 6, 8],
            preprocessed: false,
            reversible: true,
            parameters: &[
                Field {
                    name: "J",
                    ascii: "J",
                    rows: 3,
                    cols: 3,
                    kind: Kind::SecondMoments,
                    doc: "Poinsot (second-moment) matrix",
                },
                Field {
                    name: "gU",
                    ascii: "gU",
                    rows: 3,
                    cols: 1,
                    kind: Kind::Vector,
                    doc: "weight times support -> centre of mass, body frame",
                },
                Field {
                    name: "z",
                    ascii: "z",
                    rows: 3,
                    cols: 1,
                    kind: Kind::Vector,
                    doc: "vertical (up), space frame",
                },
            ],
            initial: &[
                Field {
                    name: "Λ",
                    ascii: "Lambda",
                    rows: 3,
                    cols: 3,
                    kind: Kind::Rotation,
                    doc: "attitude, body to space",
                },
                Field {
                    name: "body_momentum",
                    ascii: "body_momentum",
                    rows: 3,
                    cols: 1,
                    kind: Kind::BodyMomentum,
                    doc: "momentum, body frame",
                },
            ],
            observables: &[
                Field {
                    name: "Λ",
                    ascii: "Lambda",
                    rows: 3,
                    cols: 3,
                    kind: Kind::Rotation,
                    doc: "attitude, body to space",
                },
                Field {
                    name: "body_momentum",
                    ascii: "body_momentum",
                    rows: 3,
                    cols: 1,
                    kind: Kind::BodyMomentum,
                    doc: "momentum, body frame",
                },
                Field {
                    name: "spatial_momentum",
                    ascii: "spatial_momentum",
                    rows: 3,
                    cols: 1,
                    kind: Kind::SpatialMomentum,
                    doc: "momentum, space frame",
                },
                Field {
                    name: "Γ",
                    ascii: "Gamma",
                    rows: 3,
                    cols: 1,
                    kind: Kind::Vector,
                    doc: "the vertical seen from the body",
                },
            ],
            invariants: &[
                Invariant {
                    name: "energy",
                    formula: "½ μ_k·ζ + gU·Γ_k, where μ_k = -J ζ + tr(J) ζ",
                    rows: 1usize,
                    conserved: Conserved::Boundedly,
                },
                Invariant {
                    name: "momentum_Gamma",
                    formula: "μ_k·Γ_k",
                    rows: 1usize,
                    conserved: Conserved::Exactly,
                },
                Invariant {
                    name: "Gamma_squared",
                    formula: "Γ_k·Γ_k",
                    rows: 1usize,
                    conserved: Conserved::Exactly,
                },
            ],
            discrete_energy: Invariant {
                name: "discrete_energy",
                formula: "tr(J)/h² - tr(J Ω_k)/h² + ½ gU·Γ_k + ½ gU·Γ_{k+1}",
                rows: 1,
                conserved: Conserved::Boundedly,
            },
            open: Self::open,
            solvers: &Method::NAMES,
            dimensions: &[],
            sized: Self::sized,
        };
        /// What is wrong with the kinetic energy at a state, if anything: its Hessian in all
        /// velocities together, at the identity, should be positive definite.
        #[cold]
        #[allow(unused_variables)]
        pub fn kinetic_warning(
            &self,
            state: &HeavyTopState<f64>,
        ) -> Option<KineticWarning> {
            type T = f64;
            let HeavyTopParameters { J, .. } = self.parameters;
            let mut inertia = SMatrix::<T, 3, 3>::zeros();
            for axis in 0..3 {
                let ξ: SMatrix<T, 3, 3> = basis::<T>(axis);
                let t1 = vee(&ξ);
                let t2 = hat(&(t1 * T::from_f64(0.5) * J.trace())) * T::from_f64(0.5);
                let t3 = -(hat(&(J * t1 * T::from_f64(0.5))) * T::from_f64(0.5));
                let parts: [SVector<T, 3>; 1] = [
                    axial_of_difference(&(t2 + t2 + t3 + t3)),
                ];
                inertia.set_column(axis, &parts[0]);
            }
            KineticWarning::of(&inertia, 3)
        }
        /// The card of the model at the given sizes, in the order of their declaration.
        fn sized(sizes: &[usize]) -> Option<Card> {
            match sizes {
                [] => Some(HeavyTop::<f64>::CARD),
                _ => None,
            }
        }
        fn open(
            parameters: &[Vec<f64>],
            initial: &[Vec<f64>],
            settings: Settings,
        ) -> Result<Box<dyn Trajectory>, OpenError> {
            for (field, expected, found) in [
                ("parameters", 3usize, parameters.len()),
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
            let model = HeavyTop::new(HeavyTopParameters {
                J: matrix_of("J", parameters.get(0usize))?,
                gU: matrix_of("gU", parameters.get(1usize))?,
                z: matrix_of("z", parameters.get(2usize))?,
            })?;
            let initial = HeavyTopInitial {
                Λ: rotation_of("Λ", initial.get(0usize))?,
                body_momentum: BodyMomentum(
                    matrix_of("body_momentum", initial.get(1usize))?,
                ),
            };
            let model = match chosen_solver(settings, Self::CARD.solvers)? {
                Some(method) => model.with_solver(method),
                None => model,
            };
            let state = model.at_node_0(initial)?;
            let kinetic = model.kinetic_warning(&state);
            let steps = Steps::of_order(&model, &state, settings, Self::CARD.orders)
                .map_err(|e| OpenError::from(e).beside(kinetic))?;
            let plain = matches!(steps, Steps::Plain(_));
            Ok(
                Box::new(HeavyTopTrajectory {
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
pub use heavy_top::*;
