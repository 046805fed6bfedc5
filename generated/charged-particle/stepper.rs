// Written by `clebsch derive --write`. Do not edit.

/// The model [`ChargedParticle`](struct@ChargedParticle) and what belongs to it.
#[allow(
    non_snake_case,
    uncommon_codepoints,
    mixed_script_confusables,
    confusable_idents,
    clippy::all
)]
pub mod charged_particle {
    use ::clebsch::emitted::*;
    /// Parameters of [`ChargedParticle`](struct@ChargedParticle), as given.
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
        /// The model as it was stated.
        pub const SOURCE: &'static str = "/// Charged particle in uniform magnetic and electric fields.\npub model ChargedParticle {\n    /// mass\n    param m: Real;\n    /// charge\n    param q: Real;\n    /// magnetic field\n    param B: Vec<3>;\n    /// electric field\n    param E: Vec<3>;\n    /// place of the particle\n    field X: Vec<3>;\n    lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) + (1/2)*q*dot(cross(B, X), next(X) - X) + h*q*dot(E, X);\n}";
        /// A number that changes when the model or its derivation does.
        pub const FINGERPRINT: u64 = 13602584445213405510u64;
        /// Checks the parameters.
        ///
        /// # Errors
        /// Names the parameter that is not finite, lacks its stated symmetry, breaks an
        /// assumption, or is no admissible factor of the equation to solve.
        pub fn new(
            parameters: ChargedParticleParameters<T>,
        ) -> Result<Self, ParameterError> {
            validate::finite("m", &[parameters.m])?;
            validate::finite("q", &[parameters.q])?;
            validate::finite("B", parameters.B.as_slice())?;
            validate::finite("E", parameters.E.as_slice())?;
            Ok(Self { parameters })
        }
        /// The parameters.
        pub fn parameters(&self) -> &ChargedParticleParameters<T> {
            &self.parameters
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
    /// What moves, at one node: comparable, to be saved. The momentum is kept in the space frame, advected quantities by their value carried back to the identity, so that roundoff does not accumulate. Places and their momenta are kept in two numbers, the rest below the rounding of the other.
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
        /// The number of the node.
        pub fn node(&self) -> u64 {
            self.node
        }
    }
    /// The step and the last velocities, from which the next solves start.
    #[derive(Clone, Copy, Debug)]
    pub struct ChargedParticleWorkspace<T = f64> {
        h: T,
    }
    impl<T: Real> ChargedParticle<T> {
        /// Starts a trajectory with step `h` from data at node 0.
        ///
        /// # Errors
        /// Names the value that is not finite, or says why the first step cannot be solved and
        /// which step could.
        pub fn start(
            &self,
            initial: ChargedParticleInitial<T>,
            h: T,
        ) -> Result<(ChargedParticleState<T>, ChargedParticleWorkspace<T>), StartError> {
            validate::positive_step(h)?;
            let state = self.at_node_0(initial)?;
            Ok((state, self.workspace(&state, h)?))
        }
        /// The state at node 0.
        fn at_node_0(
            &self,
            initial: ChargedParticleInitial<T>,
        ) -> Result<ChargedParticleState<T>, StartError> {
            validate::finite("X", initial.X.matrix().as_slice())?;
            validate::finite("momentum", initial.momentum.0.as_slice())?;
            Ok(ChargedParticleState {
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
            state: &ChargedParticleState<T>,
            h: T,
        ) -> Result<ChargedParticleWorkspace<T>, StartError> {
            validate::directed_step(h)?;
            let state = *state;
            let work = ChargedParticleWorkspace { h };
            let (mut trial, mut scratch) = (state, work);
            self.step(&mut trial, &mut scratch)
                .map_err(|e| StartError::Refused(e.cause))?;
            Ok(work)
        }
        /// One step, in place. Solved thus: the balance is linear: one small linear system.
        ///
        /// # Errors
        /// When the step cannot be solved, with numbers and a remedy; the state is then unchanged.
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
                &(SMatrix::<T, 3, 3>::identity() * m / h
                    + hat(&B) * T::from_f64(0.5) * q),
                &(state.momentum.0
                    - (B.cross(&X) * T::from_f64(0.5) * q
                        - E * T::from_f64(0.5) * h * q)),
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
                &(E * h * q - B.cross(&ΔX_matrix) * T::from_f64(0.5) * q),
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
    impl<T: Real> Stepper for ChargedParticle<T> {
        type Scalar = T;
        type State = ChargedParticleState<T>;
        type Workspace = ChargedParticleWorkspace<T>;
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
            self.step(&mut moving, &mut ChargedParticleWorkspace { h }).ok()?;
            Some(moving)
        }
        fn node(state: &Self::State) -> u64 {
            state.node
        }
        fn at_node(state: Self::State, node: u64) -> Self::State {
            ChargedParticleState {
                node: node,
                ..state
            }
        }
    }
    impl<T: Real> Reversible for ChargedParticle<T> {}
    impl<T: Real> ::clebsch::OfScalars for ChargedParticleParameters<T> {
        type Scalar = T;
        type Over<U: Real> = ChargedParticleParameters<U>;
        fn over<U: Real>(
            &self,
            change: &mut impl FnMut(T) -> U,
        ) -> ChargedParticleParameters<U> {
            ChargedParticleParameters {
                m: self.m.over(change),
                q: self.q.over(change),
                B: self.B.over(change),
                E: self.E.over(change),
            }
        }
    }
    impl<T: Real> ::clebsch::OfScalars for ChargedParticleInitial<T> {
        type Scalar = T;
        type Over<U: Real> = ChargedParticleInitial<U>;
        fn over<U: Real>(
            &self,
            change: &mut impl FnMut(T) -> U,
        ) -> ChargedParticleInitial<U> {
            ChargedParticleInitial {
                X: self.X.over(change),
                momentum: self.momentum.over(change),
            }
        }
    }
    impl<T: Real> ::clebsch::OfScalars for ChargedParticleState<T> {
        type Scalar = T;
        type Over<U: Real> = ChargedParticleState<U>;
        fn over<U: Real>(
            &self,
            change: &mut impl FnMut(T) -> U,
        ) -> ChargedParticleState<U> {
            ChargedParticleState {
                X: self.X.over(change),
                momentum: self.momentum.over(change),
                place_rest: self.place_rest.over(change),
                momentum_rest: self.momentum_rest.over(change),
                node: self.node,
            }
        }
    }
    impl<T: Real> ::clebsch::integrate::Model for ChargedParticle<T> {
        type Parameters = ChargedParticleParameters<T>;
        type Initial = ChargedParticleInitial<T>;
        type Choice = ();
        type Over<U: Real> = ChargedParticle<U>;
        const SIDE_BY_SIDE: bool = false;
        fn of(parameters: Self::Parameters) -> Result<Self, ParameterError> {
            Self::new(parameters)
        }
        fn given(&self) -> &Self::Parameters {
            &self.parameters
        }
        fn begin(
            &self,
            initial: Self::Initial,
        ) -> Result<ChargedParticleState<T>, StartError> {
            self.at_node_0(initial)
        }
        fn prepare(
            &self,
            state: &ChargedParticleState<T>,
            h: T,
            _: Self::Choice,
        ) -> Result<Self::Workspace, StartError> {
            self.workspace(state, h)
        }
    }
    /// A configuration at one node, solution or not.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct ChargedParticleConfiguration<T = f64> {
        /// `X` at the node.
        pub X: Additive<3, 1, T>,
    }
    impl<T: Real> ChargedParticle<T> {
        /// The residual of the discrete Euler-Lagrange equations at the middle one of three
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
            let t2 = E * T::from_f64(0.5) * h * q;
            let parts: [SVector<T, 3>; 1] = [
                ΔX_before * t1 * m + t2 + B.cross(&X_before) * T::from_f64(0.5) * q
                    - ΔX * t1 * m + t2 - B.cross(&X) * T::from_f64(0.5) * q
                    - B.cross(&ΔX) * T::from_f64(0.5) * q,
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
    impl<T: Real> ChargedParticle<T> {
        /// What the step of size `h` from one state to the next leaves of its equations: the
        /// momentum that is carried to the second state, less the one that the motion between
        /// them brings there. One part a configuration, angular and linear ones of a rigid
        /// motion apart, each with the size of the terms it is made of: those of a spatial
        /// velocity are the two elements it is made from, as they are stored.
        pub fn residual(
            &self,
            before: &ChargedParticleState<T>,
            after: &ChargedParticleState<T>,
            h: T,
        ) -> [Residual; 1] {
            let ChargedParticleParameters { m, q, B, E, .. } = self.parameters;
            let ΔX_matrix = before
                .X
                .velocity_between(&before.place_rest, &after.X, &after.place_rest)
                .matrix();
            let X = before.X.matrix();
            let t1 = h.powi(-1);
            let t2 = (q * q).sqrt();
            let _ = h;
            [
                {
                    let momentum = after.momentum.0;
                    Residual {
                        size: length(
                                &(momentum
                                    - (ΔX_matrix * t1 * m + E * T::from_f64(0.5) * h * q
                                        + B.cross(&X) * T::from_f64(0.5) * q)),
                            )
                            .magnitude(),
                        scale: length(&momentum).magnitude()
                            + ((t1 * t1).sqrt() * (m * m).sqrt()
                                * ΔX_matrix.dot(&ΔX_matrix).sqrt()
                                + T::from_f64(0.5) * (h * h).sqrt() * t2 * E.dot(&E).sqrt()
                                + T::from_f64(0.5) * t2 * B.dot(&B).sqrt()
                                    * X.dot(&X).sqrt())
                                .magnitude(),
                    }
                },
            ]
        }
    }
    impl<T: Real> ChargedParticle<T> {
        /// The kinetic and the potential energy at this node: those of the limit of small steps,
        /// at the node's momentum.
        pub fn energies(&self, state: &ChargedParticleState<T>) -> (T, T) {
            let ChargedParticleParameters { m, q, B, E, .. } = self.parameters;
            let X = state.X.matrix();
            let parts: [SVector<T, 3>; 1] = [
                state.momentum().0 - (B * T::from_f64(0.5) * q).cross(&X),
            ];
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
            (momentum.dot(&velocity) * T::from_f64(0.5), -(q * E.dot(&X)))
        }
        /// The physical energy at this node.
        pub fn energy(&self, state: &ChargedParticleState<T>) -> T {
            let (kinetic, potential) = self.energies(state);
            kinetic + potential
        }
        /// `E × p_k - E × (X_k × (½ q B))`: Noether: the action changes by a total difference under translations.
        pub fn momentum_across_E(
            &self,
            state: &ChargedParticleState<T>,
        ) -> SVector<T, 3> {
            let ChargedParticleParameters { q, B, E, .. } = self.parameters;
            let X = state.X.matrix();
            let p = state.momentum().0;
            E.cross(&p) - E.cross(&X.cross(&(B * T::from_f64(0.5) * q)))
        }
    }
    impl<T: Real> ChargedParticle<T> {
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
            T::from_f64(0.5) * h.powi(-2) * m * ΔX_matrix.dot(&ΔX_matrix)
                - T::from_f64(0.5) * q * E.dot(&X)
                - T::from_f64(0.5) * q * E.dot(&X_next)
        }
    }
    /// One trajectory of the model, its type hidden.
    struct ChargedParticleTrajectory {
        model: ChargedParticle<f64>,
        state: ChargedParticleState<f64>,
        steps: Steps<ChargedParticle<f64>>,
        h: f64,
        /// The state before the last step.
        before: ChargedParticleState<f64>,
        /// Whether a step is one of the derivation, not composed and without modified moments.
        plain: bool,
        kinetic: Option<KineticWarning>,
    }
    impl Trajectory for ChargedParticleTrajectory {
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
            &ChargedParticle::<f64>::CARD
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
            let out = put(out, rows(self.model.momentum_across_E(state)));
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
                    let ChargedParticleParameters { q, B, E, .. } = self
                        .model
                        .parameters;
                    let X = state.X.matrix();
                    let p = state.momentum().0;
                    let t1 = E.cross(&X.cross(&(B * T::from_f64(0.5) * q)));
                    let value: T = t1.dot(&t1).sqrt()
                        + p.dot(&p).sqrt() * E.dot(&E).sqrt();
                    value
                }; 3 * 1],
            );
            let _ = out;
        }
    }
    impl ChargedParticle<f64> {
        /// The model as data.
        pub const CARD: Card = Card {
            name: "ChargedParticle",
            kebab: "charged-particle",
            doc: "Charged particle in uniform magnetic and electric fields.",
            source: Self::SOURCE,
            fingerprint: Self::FINGERPRINT,
            summary: "action of one step   m ΔX_k·ΔX_k/(2 h) + ½ q B·(X_k × ΔX_k) + ½ h q E·X_k + ½ h q E·X_{k+1}\nmomentum of X        m ΔX_k/h + ½ q (B × X_k)\nRiccati form         none; linear, L = m Id/h + ½ q hat(B), R = 1\ninvariants           energy, momentum_across_E\ntime reversal        symmetric: second order\ncertificate          13 identities proved by normal form",
            solver: "Explicit: the balance is linear: one small linear system",
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
                    doc: "mass",
                },
                Field {
                    name: "q",
                    ascii: "q",
                    rows: 1,
                    cols: 1,
                    kind: Kind::Scalar,
                    doc: "charge",
                },
                Field {
                    name: "B",
                    ascii: "B",
                    rows: 3,
                    cols: 1,
                    kind: Kind::Vector,
                    doc: "magnetic field",
                },
                Field {
                    name: "E",
                    ascii: "E",
                    rows: 3,
                    cols: 1,
                    kind: Kind::Vector,
                    doc: "electric field",
                },
            ],
            initial: &[
                Field {
                    name: "X",
                    ascii: "X",
                    rows: 3,
                    cols: 1,
                    kind: Kind::Vector,
                    doc: "place of the particle",
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
                    doc: "place of the particle",
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
                    formula: "½ (p_k + X_k × (½ q B))·ζ - q E·X_k, where p_k = m ζ + ½ q (B × X_k)",
                    rows: 1usize,
                    conserved: Conserved::Exactly,
                },
                Invariant {
                    name: "momentum_across_E",
                    formula: "E × p_k - E × (X_k × (½ q B))",
                    rows: 3 * 1,
                    conserved: Conserved::Exactly,
                },
            ],
            discrete_energy: Invariant {
                name: "discrete_energy",
                formula: "m ΔX_k·ΔX_k/(2 h²) - ½ q E·X_k - ½ q E·X_{k+1}",
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
            state: &ChargedParticleState<f64>,
        ) -> Option<KineticWarning> {
            type T = f64;
            let ChargedParticleParameters { m, .. } = self.parameters;
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
                [] => Some(ChargedParticle::<f64>::CARD),
                _ => None,
            }
        }
        fn open(
            parameters: &[Vec<f64>],
            initial: &[Vec<f64>],
            settings: Settings,
        ) -> Result<Box<dyn Trajectory>, OpenError> {
            for (field, expected, found) in [
                ("parameters", 4usize, parameters.len()),
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
            let model = ChargedParticle::new(ChargedParticleParameters {
                m: number_of("m", parameters.get(0usize))?,
                q: number_of("q", parameters.get(1usize))?,
                B: matrix_of("B", parameters.get(2usize))?,
                E: matrix_of("E", parameters.get(3usize))?,
            })?;
            let initial = ChargedParticleInitial {
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
                Box::new(ChargedParticleTrajectory {
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
pub use charged_particle::*;
