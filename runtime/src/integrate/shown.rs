//! The observables and invariants of a model, entry by entry of the lists in its call of `stepper!`. Takes the place
//! to write to, the model, a state, the step and the workspace; writes the numbers of one entry and gives the rest of
//! the place.

/// One entry:
///
/// - `energy`: a function of the model at a state, `h.energy` at a step and a state;
/// - `state.momentum`: a function of the state; `work.Λ.momentum`: the same function of the body momentum that the
///   solver updates, transformed to space by the element. It shows a drift if the state stores a constant;
/// - either `as skew`, the coordinates of a skew matrix, or `as spectrum`, the coefficients of a pencil.
#[doc(hidden)]
#[macro_export]
macro_rules! shown {
    ([state.$name:ident] $out:ident $model:ident $state:ident $($_:ident)*) => {
        $crate::of_numbers::put($state.$name(), $out)
    };
    ([state.$name:ident as skew] $out:ident $model:ident $state:ident $($_:ident)*) => {
        $crate::emitted::put($out, $crate::emitted::skew_coordinates(&$state.$name().0))
    };
    ([work.$element:ident.$name:ident] $out:ident $model:ident $state:ident $h:ident $work:ident) => {{
        let iterated = $work.map(|w| w.solver.body_momentum().to_space(&$state.$element()));
        $crate::of_numbers::put(iterated.unwrap_or($state.$name()), $out)
    }};
    ([h.$name:ident] $out:ident $model:ident $state:ident $h:ident $($_:ident)*) => {
        $crate::of_numbers::put($model.$name($h, $state), $out)
    };
    ([$name:ident] $out:ident $model:ident $state:ident $($_:ident)*) => {
        $crate::of_numbers::put($model.$name($state), $out)
    };
    ([$name:ident as skew] $out:ident $model:ident $state:ident $($_:ident)*) => {
        $crate::emitted::put(
            $out,
            $crate::emitted::skew_coordinates(&$model.$name($state)),
        )
    };
    ([$name:ident as spectrum] $out:ident $model:ident $state:ident $($_:ident)*) => {
        $crate::emitted::put($out, $crate::emitted::spectrum($model.$name($state)))
    };
}
