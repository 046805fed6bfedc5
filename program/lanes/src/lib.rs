//! Runs a tape on many sets of inputs side by side, in the widest registers of the processor. Each set gives the same numbers as on
//! its own.

use clebsch_program::{Frame, Machine, WIDTH};

struct Run<'a>(&'a Machine, &'a mut Frame<WIDTH>);

impl pulp::WithSimd for Run<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> bool {
        self.0.computes(self.1)
    }
}

/// Computes on [`WIDTH`] sets of inputs. Returns false if a decision differs from the recorded one in any set; the outputs are then
/// meaningless.
pub fn run(machine: &Machine, frame: &mut Frame<WIDTH>) -> bool {
    pulp::Arch::new().dispatch(Run(machine, frame))
}
