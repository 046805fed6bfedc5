//! Runs a step on the widest instruction set of the processor with the feature `simd`, otherwise on that of the build. The choice
//! does not change any result, because no operations are fused.

use crate::handwritten::Unsolvable;

/// A stepper. Mark its functions, and all that they call, `#[inline(always)]`.
pub trait Steps {
    /// Steps once.
    fn stepped(&mut self) -> Result<(), Unsolvable>;
}

/// Steps on the widest instruction set.
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

/// Steps on the instruction set of the build.
#[cfg(not(feature = "simd"))]
pub fn widest(line: &mut impl Steps) -> Result<(), Unsolvable> {
    line.stepped()
}
