//! How many operations a tape takes.

use crate::record::{Step, Tape};

/// Numbers of scalar operations.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Count {
    /// Sums, differences and negatives.
    pub additions: usize,
    /// Products.
    pub multiplications: usize,
    /// Quotients.
    pub divisions: usize,
    /// Functions, roots and powers.
    pub functions: usize,
}

impl Count {
    /// All of them.
    #[must_use]
    pub fn total(self) -> usize {
        self.additions + self.multiplications + self.divisions + self.functions
    }
}

/// The operations of a tape.
#[must_use]
pub fn count(tape: &Tape) -> Count {
    let mut count = Count::default();
    for step in &tape.steps {
        match step {
            Step::Input(_) | Step::Double(_) | Step::Ratio(..) | Step::Pi => {}
            Step::Add(..) | Step::Sub(..) | Step::Neg(_) => count.additions += 1,
            Step::Mul(..) => count.multiplications += 1,
            Step::Div(..) => count.divisions += 1,
            Step::Function(..) | Step::Power(..) | Step::Root(..) => count.functions += 1,
        }
    }
    count
}
