//! The solvers of the Moser-Veselov equation, selected by name.

use core::fmt;
use core::str::FromStr;

/// A solver of `Omega C^T - C Omega^T = h N`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// SO(3): the quartic for `kappa = u . c`, then a linear solve. Explicit; the fastest there.
    Kappa,
    /// Newton's method on the Lie algebra: any size, any scalar.
    LieNewton,
    /// SO(3): the largest real eigenvalue of a 4 x 4 matrix; the factor needs no preparation.
    Davenport,
    /// The matrix sign function of the Hamiltonian matrix: any size, any scalar.
    Sign,
    /// The ordered Schur form of the Hamiltonian matrix: any size, plain double precision.
    Schur,
}

impl Method {
    /// All solvers, in the order in which they are offered.
    pub const ALL: [Method; 5] = [
        Method::Kappa,
        Method::LieNewton,
        Method::Davenport,
        Method::Sign,
        Method::Schur,
    ];

    /// The name, as the command line spells it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Method::Kappa => "kappa",
            Method::LieNewton => "lie-newton",
            Method::Davenport => "davenport",
            Method::Sign => "sign",
            Method::Schur => "schur",
        }
    }

    /// All names, in the same order.
    pub const NAMES: [&'static str; 5] = ["kappa", "lie-newton", "davenport", "sign", "schur"];

    /// All names, with the solver that needs no preparation first, for factors that change in each step.
    pub const DAVENPORT_FIRST: [&'static str; 5] =
        ["davenport", "kappa", "lie-newton", "sign", "schur"];

    /// The names of solvers for matrices of any size.
    pub const ANY_SIZE: [&'static str; 3] = ["lie-newton", "sign", "schur"];

    /// The default for matrices of this size.
    #[must_use]
    pub const fn of_size(n: usize) -> Method {
        match n {
            3 => Method::Kappa,
            _ => Method::LieNewton,
        }
    }

    /// This solver if it supports matrices of size `n`, otherwise the default for that size.
    #[must_use]
    pub const fn serving(self, n: usize) -> Method {
        match (self, n) {
            (Method::Kappa | Method::Davenport, n) if n != 3 => Method::of_size(n),
            _ => self,
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A name that is not in [`Method::ALL`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoSuchMethod;

impl fmt::Display for NoSuchMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no such solver; the solvers are ")?;
        for (i, method) in Method::ALL.iter().enumerate() {
            let comma = if i > 0 { ", " } else { "" };
            write!(f, "{comma}{method}")?;
        }
        Ok(())
    }
}

impl std::error::Error for NoSuchMethod {}

impl FromStr for Method {
    type Err = NoSuchMethod;

    fn from_str(name: &str) -> Result<Self, NoSuchMethod> {
        let mut all = Method::ALL.into_iter();
        all.find(|m| m.name() == name).ok_or(NoSuchMethod)
    }
}
