//! The step of a body whose forced equation is solved by its factor, written once: a solver finds the rotation of the
//! body along an edge, and the torques of the model act at the node at its end. Takes the names of a model's types
//! and fields; gives `prepared`, `step` and `refused` around its functions `edge` and `arrived`.

/// Its arguments, in order:
///
/// - `pub step`, or `step_untested`, which leaves numbers that are not finite to a later test;
/// - the fields of the element, of its momentum and of the other quantities of a state;
/// - the fields from which the `factor` is computed, if each trajectory has its own;
/// - how the step is solved, as a phrase, and the function that tests a start, if there is one;
/// - the types.
#[doc(hidden)]
#[macro_export]
macro_rules! forced_step {
    (
        $visible:vis $step:ident { $element:ident, $momentum:ident $(, $kept:ident)* } $of:tt [$($factor:ident)?]
        [$solved:literal $($tests:ident)?] [$($size:ident)*] $state:ident $node:ident $work:ident $T:ident
    ) => {
        /// The initial workspace for steps of `h` from `state`.
        fn prepared(
            &self,
            state: &$state<$($size,)* $T>,
            h: $T,
            choice: Option<$crate::solvers::Method>,
        ) -> Result<$work<$($size,)* $T>, $crate::StartError> {
            $(self.$tests(state, h)?;)?
            Ok($work {
                h,
                method: choice.unwrap_or(self.method),
                $($factor: self.$factor(state)?,)?
                edge: self.edge(state, h),
                here: *state,
            })
        }

        #[doc = concat!(" One step, in place. Method: ", $solved, ".")]
        ///
        /// # Errors
        /// If the step cannot be solved. The error gives numbers and a remedy; the state is unchanged.
        #[inline]
        $visible fn $step(
            &self,
            state: &mut $state<$($size,)* $T>,
            work: &mut $work<$($size,)* $T>,
        ) -> Result<(), $crate::StepError> {
            let h = work.h;
            if work.here.$element != state.$element
                || work.here.$momentum != state.$momentum
                $(|| !$crate::emitted::same(&work.here.$kept, &state.$kept))*
            {
                $crate::forced_step! { @another $of self state work $node }
                work.edge = self.edge(state, h);
                work.here = *state;
            }
            let (edge, factor) = (&work.edge, $crate::forced_step! { @factor [$($factor)?] self work });
            let turned = match work.method {
                $crate::solvers::Method::Kappa => edge.turn(factor, h, &state.$element),
                method => edge.turn_by(method, factor, h, &state.$element),
            };
            let turned = match turned {
                Ok(turned) => turned,
                Err(e) => return Err(self.refused(*state, factor, h, e)),
            };
            let arrival = self.arrived(state, edge, h, turned);
            $crate::forced_step! { @finite $step arrival state $node }
            // The other quantities of a state do not change.
            (state.$element, work.here.$element) = (arrival.attitude, arrival.attitude);
            (state.$momentum, work.here.$momentum) = (arrival.momentum, arrival.momentum);
            state.$node += 1;
            work.edge = arrival.edge;
            Ok(())
        }

        /// Reports how far the step exceeds the bound, and a step size that succeeds.
        #[cold]
        fn refused(
            &self,
            state: $state<$($size,)* $T>,
            factor: &$crate::emitted::Poinsot<$T>,
            h: $T,
            e: $crate::solvers::moser_veselov::MoserVeselovError,
        ) -> $crate::StepError {
            let e = e.with_searched_step(factor, h, |trial| self.edge(&state, trial).body());
            $crate::StepCause::from(e).at_node(state.$node)
        }
    };

    (@another [] $($_:ident)*) => {};
    // Compositions move the attitude in every step, and the body is the same.
    (@another [$($reference:ident)&+] $model:ident $state:ident $work:ident $node:ident) => {
        if !($($crate::emitted::same(&$work.here.$reference, &$state.$reference))&*) {
            $work.factor = match $model.factor($state) {
                Ok(factor) => factor,
                Err(_) => return Err($crate::StepCause::not_finite("body").at_node($state.$node)),
            };
        }
    };

    (@factor [] $model:ident $work:ident) => { &$model.factor };
    (@factor [factor] $model:ident $work:ident) => { &$work.factor };

    (@finite step $arrival:ident $state:ident $node:ident) => {
        if !$crate::emitted::all_finite(&$arrival.momentum.0) {
            return Err($crate::StepCause::not_finite("momentum").at_node($state.$node));
        }
    };
    (@finite step_untested $($_:ident)*) => {};
}
