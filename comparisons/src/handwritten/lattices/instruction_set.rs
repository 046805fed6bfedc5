//! Runs a step on the widest instruction set of the processor with the feature `simd`, otherwise on that of the build.
//! Takes what steps; gives what the step gives. No number depends on it: nothing is contracted.

use crate::handwritten::Unsolvable;

/// What has a step. Its functions are to be marked `#[inline(always)]`, as all that they call.
pub trait Steps {
    /// One step.
    fn stepped(&mut self) -> Result<(), Unsolvable>;
}

/// The step, on the widest instruction set.
#[cfg(feature = "simd")]
pub fn widest(line: &mut impl Steps) -> Result<(), Unsolvable> {
    struct Dispatched<'a, S>(&'a mut S);
    impl<S: Steps> pulp::WithSimd for Dispatched<'_, S> {
        type Output = Result<(), Unsolvable>;

        #[inline(always)]
        fn with_simd<V: pulp::Simd>(self, _: V) -> Self::Output {
            self.0.stepped()
        }
    }
    pulp::Arch::new().dispatch(Dispatched(line))
}

/// The step, on the instruction set of the build.
#[cfg(not(feature = "simd"))]
pub fn widest(line: &mut impl Steps) -> Result<(), Unsolvable> {
    line.stepped()
}
