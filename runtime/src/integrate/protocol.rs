//! The protocol of an emitted model, written once: how a trajectory starts, the traits for compositions, ensembles
//! and the command line, and how all data are saved. Takes the names of its types and fields, and the form of its
//! steps; gives the implementations around the functions `begin`, `prepared` and `step` of the model. The macro
//! generates those functions that follow from the names.

/// The protocol of a model: its types with all their fields, const parameters in brackets, and
///
/// - the form of its steps: `forced` (`forced_untested` if the model tests its steps itself), `free`, `tried` (it has
///   a shorter function to try a step) or `explicit`;
/// - the fields of the element, of its momentum and of the other quantities of a state;
/// - what you can choose about its steps: `order`, `solver`, `nothing`;
/// - how higher orders are reached: `modified` moments, compositions of `symmetric` steps, or `none`;
/// - whether its kinetic energy is `judged` at the start, in how many coordinates, or `unjudged`;
/// - in parentheses how forced steps are solved, `of` which fields the factor of a trajectory is computed, and the
///   function that `tests` a start;
/// - how the `start` of each element of a state is computed, and how the momentum of an element is computed from the
///   given momentum; then the remainders of positions that are stored in two numbers. Absent if the model has its own
///   `begin`;
/// - the observables and the invariants, in the form that `shown!` reads.
#[doc(hidden)]
#[macro_export]
macro_rules! stepper {
    (
        [$($size:ident)*] $model:ident,
        $parameters:ident { $($parameter:ident),* },
        $initial:ident { $($given:ident),* },
        $state:ident { $($kept:ident),* } at $node:ident,
        $work:ident { $($remembered:ident),* },
        $form:ident { $($moved:ident),* } $choice:ident $orders:ident $judged:ident $({ $coordinates:expr })?
        $(($solved:literal $(, of $($reference:ident)&+)? $(, tests $tests:ident)?))?
        $(start $start:tt $({ $($rest:ident),* })?)?
        observables { $($($seen:ident).+ $(as $shape:ident)?),* }
        invariants { $($($constant:ident).+ $(as $form_of:ident)?),* }
    ) => {
        $crate::of_scalars! { [$($size)*] $parameters { $($parameter),* } }
        $crate::of_scalars! { [$($size)*] $initial { $($given),* } }
        $crate::of_scalars! { [$($size)*] $state { $($kept),* } at $node }
        $crate::saved! { [$($size)*] $work { $($remembered),* } }

        impl<$(const $size: usize,)* T: $crate::Real> $model<$($size,)* T> {
            /// The parameters.
            pub fn parameters(&self) -> &$parameters<$($size,)* T> {
                &self.parameters
            }

            /// Starts a trajectory with step `h` from data at node 0.
            ///
            /// # Errors
            /// Names the value that is not admissible, or says why the first step cannot be solved and
            /// which could.
            pub fn start(
                &self,
                initial: $initial<$($size,)* T>,
                h: T,
            ) -> Result<($state<$($size,)* T>, $work<$($size,)* T>), $crate::StartError> {
                $crate::integrate::Model::start_with(self, initial, h, Default::default())
            }

            /// A workspace for steps of `h`, of either sign, from any state; errors as of `start`.
            pub fn workspace(
                &self,
                state: &$state<$($size,)* T>,
                h: T,
            ) -> Result<$work<$($size,)* T>, $crate::StartError> {
                $crate::integrate::Model::prepare(self, state, h, Default::default())
            }

            $crate::stepper_part! { @started $choice [$($size)*] $initial $state $work T }

            $crate::stepper_part! { @begin [$($start { $($($rest),*)? })?] [$($size)*] $initial $state $node T }

            $crate::stepper_part! {
                @made $form { $($moved),* } [$($($($reference)&+)?)?] [$($solved $($tests)?)?]
                [$($size)*] $state $node $work T
            }
        }

        impl<$(const $size: usize,)* T: $crate::Real> $state<$($size,)* T> {
            /// The number of the node.
            pub fn node(&self) -> u64 {
                self.$node
            }
        }

        $crate::stepper_part! { @watched $form [$($size)*] $work }

        impl<$(const $size: usize,)* T: $crate::Real> $crate::integrate::Stepper for $model<$($size,)* T> {
            type Scalar = T;
            type State = $state<$($size,)* T>;
            type Workspace = $work<$($size,)* T>;

            fn workspace(&self, state: &Self::State, h: T) -> Result<Self::Workspace, $crate::StartError> {
                $crate::integrate::Model::prepare(self, state, h, Default::default())
            }

            #[inline(always)]
            fn advance(
                &self,
                state: &mut Self::State,
                work: &mut Self::Workspace,
            ) -> Result<(), $crate::StepError> {
                self.step(state, work)
            }

            $crate::stepper_part! { @many $form { $($moved),* } $node T }

            fn node(state: &Self::State) -> u64 {
                state.$node
            }

            fn at_node(state: Self::State, node: u64) -> Self::State {
                $state { $node: node, ..state }
            }
        }

        $crate::stepper_part! {
            @lanes $form [$($($($reference)&+)?)?] { $($moved),* } [$($size)*] $model $parameters { $($parameter),* } $state $node $work
        }

        $crate::stepper_part! { @reversible $orders [$($size)*] $model }

        impl<$(const $size: usize,)* T: $crate::Real> $crate::integrate::Model for $model<$($size,)* T> {
            type Parameters = $parameters<$($size,)* T>;
            type Initial = $initial<$($size,)* T>;
            type Choice = $crate::stepper_part! { @choice $choice };
            type Over<__U: $crate::Real> = $model<$($size,)* __U>;
            const SIDE_BY_SIDE: bool = $crate::stepper_part! { @side_by_side $form };

            fn of(parameters: Self::Parameters) -> Result<Self, $crate::ParameterError> {
                Self::new(parameters)
            }

            fn given(&self) -> &Self::Parameters {
                &self.parameters
            }

            fn begin(&self, initial: Self::Initial) -> Result<Self::State, $crate::StartError> {
                Self::begin(self, initial)
            }

            fn prepared(
                &self,
                state: &Self::State,
                h: T,
                choice: Self::Choice,
            ) -> Result<Self::Workspace, $crate::StartError> {
                Self::prepared(self, state, h, choice)
            }

            $crate::stepper_part! { @compensated $form }
        }

        impl<$(const $size: usize),*> $crate::integrate::Described for $model<$($size,)* f64> {
            fn card() -> &'static $crate::card::Card {
                &Self::CARD
            }

            fn read(
                parameters: &[Vec<f64>],
                initial: &[Vec<f64>],
            ) -> Result<(Self, Self::Initial), $crate::card::OpenError> {
                let mut given = $crate::of_numbers::FieldNumbers::new(Self::CARD.parameters, parameters);
                let model = Self::new($parameters { $($parameter: given.take()?),* })?;
                let mut given = $crate::of_numbers::FieldNumbers::new(Self::CARD.initial, initial);
                Ok((model, $initial { $($given: given.take()?),* }))
            }

            fn ways(
                self,
                state: &Self::State,
                settings: $crate::card::Settings,
            ) -> Result<(Self, $crate::integrate::Steps<Self>), $crate::card::OpenError> {
                let chosen = $crate::card::chosen_solver(settings, Self::CARD.solvers)?;
                let model = $crate::stepper_part! { @solved_by $choice self chosen };
                let steps = $crate::stepper_part! { @steps $orders &model, state, settings, Self::CARD.orders };
                Ok((model, steps?))
            }

            $crate::stepper_part! { @judged $judged }

            fn observe(&self, state: &Self::State, out: &mut [f64]) {
                $(let out = $crate::shown! { [$($seen).+ $(as $shape)?] out self state };)*
                let _ = out;
            }

            fn invariants(
                &self,
                state: &Self::State,
                h: f64,
                work: Option<&Self::Workspace>,
                out: &mut [f64],
            ) {
                let _ = (h, work);
                $(let out = $crate::shown! { [$($constant).+ $(as $form_of)?] out self state h work };)*
                let _ = out;
            }

            fn scales(&self, state: &Self::State, h: f64, out: &mut [f64]) {
                Self::scales(self, state, h, out);
            }
        }

        $crate::stepper_part! { @warning $judged $({ $coordinates })? [$($size)*] $model $state }
    };
}

/// The parts of [`stepper!`](crate::stepper) that differ between methods.
#[doc(hidden)]
#[macro_export]
macro_rules! stepper_part {
    (@started nothing $($_:tt)*) => {};
    (@started order [$($size:ident)*] $initial:ident $state:ident $work:ident $T:ident) => {
        $crate::stepper_part! { @solver }

        /// As `start`, with steps of this order: see [`Order`]($crate::solvers::moser_veselov::Order).
        ///
        /// # Errors
        /// As `start`; also if this size or scalar does not support the order.
        pub fn start_with(
            &self,
            initial: $initial<$($size,)* $T>,
            h: $T,
            choice: $crate::solvers::moser_veselov::Order,
        ) -> Result<($state<$($size,)* $T>, $work<$($size,)* $T>), $crate::StartError> {
            $crate::integrate::Model::start_with(self, initial, h, choice)
        }
    };
    (@started solver [$($size:ident)*] $initial:ident $state:ident $work:ident $T:ident) => {
        $crate::stepper_part! { @solver }

        /// Like `start`, with the given solver.
        ///
        /// # Errors
        /// As `start`; also for what this size or scalar does not have.
        pub fn start_with(
            &self,
            initial: $initial<$($size,)* $T>,
            h: $T,
            choice: impl Into<Option<$crate::solvers::Method>>,
        ) -> Result<($state<$($size,)* $T>, $work<$($size,)* $T>), $crate::StartError> {
            $crate::integrate::Model::start_with(self, initial, h, choice.into())
        }
    };
    (@solver) => {
        /// This model, with the given solver.
        #[must_use]
        pub fn with_solver(self, method: $crate::solvers::Method) -> Self {
            Self { method, ..self }
        }
    };

    (@begin [] $($_:tt)*) => {};
    (
        @begin [
            { $($element:ident, $momentum:ident = $given:ident $(.$way:ident)?);* } { $($rest:ident),* }
        ]
        [$($size:ident)*] $initial:ident $state:ident $node:ident $T:ident
    ) => {
        /// The state at node 0.
        fn begin(
            &self,
            initial: $initial<$($size,)* $T>,
        ) -> Result<$state<$($size,)* $T>, $crate::StartError> {
            $(
                $crate::validate::initial(stringify!($element), &initial.$element)?;
                $crate::validate::initial(stringify!($given), &initial.$given)?;
            )*
            Ok($state {
                $(
                    $element: initial.$element,
                    $momentum: initial.$given$(.$way(&initial.$element))?,
                )*
                $($rest: $crate::emitted::SMatrix::zeros(),)*
                $node: 0,
            })
        }
    };

    (@made forced $moved:tt [] $($others:tt)*) => {
        $crate::forced_step! { pub step $moved [] [] $($others)* }
    };
    (@made forced $moved:tt $of:tt $($others:tt)*) => {
        $crate::forced_step! { pub step $moved $of [factor] $($others)* }
    };
    (@made forced_untested $moved:tt [] $($others:tt)*) => {
        $crate::forced_step! { step_untested $moved [] [] $($others)* }
    };
    (@made forced_untested $moved:tt $of:tt $($others:tt)*) => {
        $crate::forced_step! { step_untested $moved $of [factor] $($others)* }
    };
    (@made $($_:tt)*) => {};

    (@watched free [$($size:ident)*] $work:ident) => {
        impl<$(const $size: usize,)* T: $crate::Real> $work<$($size,)* T> {
            /// The solver: the momentum that it stores, and the correction of its last projection.
            pub fn solver(&self) -> &$crate::solvers::moser_veselov::Free<T> {
                &self.solver
            }

            /// This workspace without projection: rounding errors accumulate, so that you can measure them.
            #[must_use]
            pub fn without_projection(mut self) -> Self {
                self.solver = self.solver.without_projection();
                self
            }

            /// This workspace with compensated steps: steps of order above two are symplectic in momentum and attitude.
            #[must_use]
            pub fn compensated(mut self) -> Self {
                self.solver = self.solver.compensated();
                self
            }
        }
    };
    (@watched $($_:tt)*) => {};

    (@many free { $element:ident, $momentum:ident } $node:ident $T:ident) => {
        #[inline(always)]
        fn advance_many(
            &self,
            state: &mut Self::State,
            work: &mut Self::Workspace,
            count: u64,
        ) -> Result<(), $crate::StepError> {
            if let Err(e) = work.solver.follow_many(&mut state.$element, &state.$momentum, count) {
                return Err($crate::StepCause::from(e).at_node(state.$node));
            }
            state.$node += count;
            Ok(())
        }
    };
    (@many tried $($_:tt)*) => {
        #[cold]
        fn attempt(&self, state: &Self::State, h: Self::Scalar) -> Option<Self::State> {
            Self::attempt(self, state, h)
        }
    };
    (@many explicit $($_:tt)*) => {};
    (@many forced_untested $($_:tt)*) => {};
    (@many $forced:ident { $($_:ident),* } $node:ident $T:ident) => {
        #[inline(always)]
        fn advance_many(
            &self,
            state: &mut Self::State,
            work: &mut Self::Workspace,
            count: u64,
        ) -> Result<(), $crate::StepError> {
            if $T::LANES > 1 {
                return $crate::integrate::advance_side_by_side(self, state, work, count);
            }
            for _ in 0..count {
                self.step(state, work)?;
            }
            Ok(())
        }
    };

    (@lanes forced [] $($others:tt)*) => { $crate::side_by_side! { of_model $($others)* } };
    (@lanes forced $of:tt $($others:tt)*) => { $crate::side_by_side! { of_state $($others)* } };
    (@lanes $($_:tt)*) => {};

    (@reversible none $($_:tt)*) => {};
    (@reversible $orders:ident [$($size:ident)*] $model:ident) => {
        impl<$(const $size: usize,)* T: $crate::Real> $crate::integrate::Reversible for $model<$($size,)* T> {}
    };

    (@choice order) => { $crate::solvers::moser_veselov::Order };
    (@choice solver) => { Option<$crate::solvers::Method> };
    (@choice nothing) => { () };

    (@side_by_side tried) => { false };
    (@side_by_side explicit) => { false };
    (@side_by_side forced_untested) => { false };
    (@side_by_side $lanes:ident) => { true };

    (@compensated free) => {
        fn compensated(work: Self::Workspace) -> Self::Workspace {
            work.compensated()
        }
    };
    (@compensated $form:ident) => {};

    (@solved_by nothing $model:ident $chosen:ident) => {{
        let _ = $chosen;
        $model
    }};
    (@solved_by $choice:ident $model:ident $chosen:ident) => {
        match $chosen {
            Some(method) => $model.with_solver(method),
            None => $model,
        }
    };

    (@steps modified $($given:tt)*) => { $crate::integrate::Steps::modified($($given)*) };
    (@steps symmetric $($given:tt)*) => { $crate::integrate::Steps::of_order($($given)*) };
    (@steps none $($given:tt)*) => { $crate::integrate::Steps::plain($($given)*) };

    (@judged judged) => {
        fn judged(&self, state: &Self::State) -> Option<$crate::kinetic::KineticWarning> {
            self.kinetic_warning(state)
        }
    };
    (@judged unjudged) => {};

    (@warning judged { $coordinates:expr } [$($size:ident)*] $model:ident $state:ident) => {
        impl<$(const $size: usize),*> $model<$($size,)* f64> {
            /// A warning if the Hessian of the kinetic energy is not positive definite at a state.
            #[cold]
            pub fn kinetic_warning(
                &self,
                state: &$state<$($size,)* f64>,
            ) -> Option<$crate::kinetic::KineticWarning> {
                $crate::kinetic::KineticWarning::of(&self.inertia_at(state), $coordinates)
            }
        }
    };
    (@warning unjudged $($_:tt)*) => {};
}

/// The same step lane by lane, for ensembles of bodies whose forced equation is solved by a factor: the factor
/// `of_model`, or `of_state` if each trajectory has its own factor.
#[doc(hidden)]
#[macro_export]
macro_rules! side_by_side {
    (
        $of:ident { $element:ident, $momentum:ident $(, $kept:ident)* } [$($size:ident)*] $model:ident
        $parameters:ident { $($parameter:ident),* } $state:ident $node:ident $work:ident
    ) => {
        impl<$(const $size: usize,)* T: $crate::Real> $crate::integrate::SideBySide for $model<$($size,)* T> {
            #[inline(always)]
            fn moving(
                &self,
                state: &Self::State,
                work: &Self::Workspace,
            ) -> Option<$crate::integrate::Moving<T>> {
                let own = work.method == $crate::solvers::Method::Kappa
                    && work.here.$element == state.$element
                    && work.here.$momentum == state.$momentum
                    $(&& work.here.$kept == state.$kept)*;
                own.then_some($crate::integrate::Moving {
                    attitude: state.$element,
                    momentum: state.$momentum,
                    edge: work.edge,
                })
            }

            #[inline(always)]
            fn arrive(
                state: &mut Self::State,
                work: &mut Self::Workspace,
                moving: &$crate::integrate::Moving<T>,
                steps: u64,
            ) {
                (state.$element, state.$momentum) = (moving.attitude, moving.momentum);
                state.$node += steps;
                (work.here, work.edge) = (*state, moving.edge);
            }

            #[inline(always)]
            fn is_diagonal(&self, work: &Self::Workspace) -> bool {
                let _ = work;
                $crate::side_by_side! { @factor $of self work }.is_diagonal()
            }

            #[inline(always)]
            fn step_lanes<const DIAGONAL: bool>(
                &self,
                state: &Self::State,
                work: &Self::Workspace,
                from: &$crate::integrate::Moving<T>,
                to: &mut $crate::integrate::Moving<T>,
            ) -> bool {
                use $crate::scalar::InLanes as _;
                let mut easy = true;
                for lane in 0..T::LANES {
                    let (attitude, edge) = from.from(lane);
                    let h = work.h.one_of(lane);
                    let factor = $crate::side_by_side! { @factor $of self work }.in_lane(lane);
                    let (turned, found) = edge.turn_at_once::<DIAGONAL>(&factor, h, &attitude);
                    let parameters = $parameters {
                        $($parameter: self.parameters.$parameter.in_lane(lane)),*
                    };
                    let method = self.method;
                    let model = $crate::side_by_side! {
                        @one $of $model [$($size)*] T parameters factor method
                    };
                    let state = $state::<$($size,)* <T as $crate::Real>::One> {
                        $element: attitude,
                        $momentum: from.momentum.in_lane(lane),
                        $($kept: state.$kept.in_lane(lane),)*
                        $node: state.$node,
                    };
                    easy &= found & to.set(lane, model.arrived(&state, &edge, h, turned));
                }
                easy
            }
        }
    };
    (@factor of_model $model:ident $work:ident) => { $model.factor };
    (@factor of_state $model:ident $work:ident) => { $work.factor };
    (@one of_model $model:ident [$($size:ident)*] $T:ident $parameters:ident $factor:ident $method:ident) => {
        $model::<$($size,)* <$T as $crate::Real>::One> {
            parameters: $parameters,
            factor: $factor,
            method: $method,
        }
    };
    (@one of_state $model:ident [$($size:ident)*] $T:ident $parameters:ident $factor:ident $method:ident) => {
        $model::<$($size,)* <$T as $crate::Real>::One> {
            parameters: $parameters,
            method: $method,
        }
    };
}
