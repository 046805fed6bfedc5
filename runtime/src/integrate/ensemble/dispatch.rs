//! The instruction set that the steps of an ensemble run on, chosen at run time.
//! Takes the work as a closure; gives what it gives.

/// The instruction set of an ensemble's steps. The results are the same on all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum InstructionSet {
    /// The best one that the processor has: AVX-512, AVX2 or that of the build.
    #[default]
    Best,
    /// AVX2 where the processor has it, else that of the build.
    Avx2,
    /// What the program was built for.
    Build,
}

impl InstructionSet {
    /// Does the work. What it inlines is compiled for each instruction set; what it calls is not.
    #[cfg(feature = "simd")]
    #[inline(always)]
    pub(super) fn run<R>(self, work: impl FnOnce() -> R) -> R {
        match self {
            Self::Best => pulp::Arch::new().dispatch(work),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Avx2 => match pulp::x86::V3::try_new() {
                Some(avx2) => avx2.vectorize(work),
                None => work(),
            },
            #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
            Self::Avx2 => work(),
            Self::Build => work(),
        }
    }

    /// Does the work, on what the program was built for.
    #[cfg(not(feature = "simd"))]
    #[inline(always)]
    pub(super) fn run<R>(self, work: impl FnOnce() -> R) -> R {
        work()
    }
}
