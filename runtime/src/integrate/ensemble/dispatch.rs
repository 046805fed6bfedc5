//! The instruction set that the steps of an ensemble run on, chosen at run time.
//! Takes the work; gives its output.

/// The instruction set of an ensemble's steps. The results are the same on all instruction sets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum InstructionSet {
    /// The best instruction set of the processor: AVX-512, AVX2 or the one of the build.
    #[default]
    Best,
    /// AVX2 if the processor supports it, else the instruction set of the build.
    Avx2,
    /// The instruction set that the program was built for.
    Build,
}

/// Work that is compiled for each instruction set. It is a trait because a closure cannot be marked for inlining, and
/// a call that is not inlined uses the instruction set of the build.
pub trait Work {
    /// The result of the work.
    type Output;

    /// Does the work. Mark it `#[inline(always)]`, and the functions of its inner loops too.
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

    /// Does the work on the instruction set of the build.
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
