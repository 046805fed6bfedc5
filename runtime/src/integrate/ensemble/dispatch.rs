//! The instruction set that the steps of an ensemble run on, chosen at run time.
//! Takes the work; gives what it gives.

/// The instruction set of an ensemble's steps. The results are the same on all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum InstructionSet {
    /// The best one that the processor has: AVX-512, AVX2 or that of the build.
    #[default]
    Best,
    /// AVX2 where the processor has it, else that of the build.
    Avx2,
    /// What the program was built for.
    Build,
}

/// What is to be compiled for each instruction set. A trait, since a closure cannot be told to be
/// inlined, and what is called and not inlined is compiled for the build's own.
pub trait Work {
    /// What it gives.
    type Output;

    /// Does it. To be marked `#[inline(always)]`, as the functions of its inner loops.
    fn done(self) -> Self::Output;
}

impl InstructionSet {
    /// Does the work.
    #[cfg(feature = "simd")]
    pub fn run<W: Work>(self, work: W) -> W::Output {
        match self {
            Self::Best => pulp::Arch::new().dispatch(Dispatched(work)),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Avx2 => match pulp::x86::V3::try_new() {
                Some(avx2) => pulp::Simd::vectorize(avx2, Dispatched(work)),
                None => work.done(),
            },
            #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
            Self::Avx2 => work.done(),
            Self::Build => work.done(),
        }
    }

    /// Does the work, on what the program was built for.
    #[cfg(not(feature = "simd"))]
    pub fn run<W: Work>(self, work: W) -> W::Output {
        work.done()
    }
}

#[cfg(feature = "simd")]
struct Dispatched<W>(W);

#[cfg(feature = "simd")]
impl<W: Work> pulp::WithSimd for Dispatched<W> {
    type Output = W::Output;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> W::Output {
        self.0.done()
    }
}
