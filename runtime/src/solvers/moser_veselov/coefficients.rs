//! The coefficients of the modified moments, as rational numbers. Used by [`super::preprocess`]; one list for each
//! power of the step, from the second power on.
//!
//! The Taylor series of the exact motion was inserted into the Moser-Veselov equation
//! `I c + c x I c = (1 + |c|^2) h mu / 2`. This was solved for the moments. The coefficients of
//! `1 / I_i' = s / I_i + d` were fitted in exact arithmetic at fifty rational bodies and momenta. The
//! fit is overdetermined and its residual is zero. Hairer and Vilmart, J. Phys. A 39 (2006) 13225, prove
//! that `s` and `d` exist.

/// `factor H^energy C^momentum e1^p e2^q e3^r`, with `H = h^2` times the energy, `C = h^2 |mu|^2 /
/// 2` and the elementary symmetric functions `e` of the inverse moments.
pub(super) struct Term {
    pub(super) factor: (i64, i64),
    pub(super) energy: i32,
    pub(super) momentum: i32,
    pub(super) symmetric: [i32; 3],
}

const fn term(
    numerator: i64,
    denominator: i64,
    energy: i32,
    momentum: i32,
    symmetric: [i32; 3],
) -> Term {
    Term {
        factor: (numerator, denominator),
        energy,
        momentum,
        symmetric,
    }
}

/// The terms of `s - 1`: powers 2, 4, 6, 8 of the step.
pub(super) const FACTOR: [&[Term]; 4] = [
    &[term(-1, 3, 1, 0, [1, 0, 0]), term(1, 6, 0, 1, [0, 1, 0])],
    &[
        term(1, 30, 2, 0, [2, 0, 0]),
        term(-1, 60, 2, 0, [0, 1, 0]),
        term(-1, 30, 1, 1, [1, 1, 0]),
        term(2, 15, 1, 1, [0, 0, 1]),
        term(1, 30, 0, 2, [0, 2, 0]),
        term(-1, 10, 0, 2, [1, 0, 1]),
    ],
    &[
        term(-1, 630, 3, 0, [3, 0, 0]),
        term(1, 630, 3, 0, [1, 1, 0]),
        term(1, 35, 3, 0, [0, 0, 1]),
        term(1, 420, 2, 1, [2, 1, 0]),
        term(41, 2520, 2, 1, [0, 2, 0]),
        term(-53, 630, 2, 1, [1, 0, 1]),
        term(-1, 70, 1, 2, [1, 2, 0]),
        term(11, 210, 1, 2, [2, 0, 1]),
        term(-1, 84, 1, 2, [0, 1, 1]),
        term(17, 2520, 0, 3, [0, 3, 0]),
        term(-11, 420, 0, 3, [1, 1, 1]),
        term(5, 126, 0, 3, [0, 0, 2]),
    ],
    &[
        term(1, 22680, 4, 0, [4, 0, 0]),
        term(-1, 15120, 4, 0, [2, 1, 0]),
        term(17, 5040, 4, 0, [0, 2, 0]),
        term(-3, 280, 4, 0, [1, 0, 1]),
        term(-1, 11340, 3, 1, [3, 1, 0]),
        term(-11, 1890, 3, 1, [1, 2, 0]),
        term(23, 945, 3, 1, [2, 0, 1]),
        term(-23, 1260, 3, 1, [0, 1, 1]),
        term(13, 3780, 2, 2, [2, 2, 0]),
        term(1, 2520, 2, 2, [0, 3, 0]),
        term(-17, 1260, 2, 2, [3, 0, 1]),
        term(1, 252, 2, 2, [1, 1, 1]),
        term(53, 1260, 2, 2, [0, 0, 2]),
        term(-11, 3240, 1, 3, [1, 3, 0]),
        term(17, 1260, 1, 3, [2, 1, 1]),
        term(47, 7560, 1, 3, [0, 2, 1]),
        term(-47, 945, 1, 3, [1, 0, 2]),
        term(31, 22680, 0, 4, [0, 4, 0]),
        term(-19, 2520, 0, 4, [1, 2, 1]),
        term(1, 120, 0, 4, [2, 0, 2]),
        term(97, 15120, 0, 4, [0, 1, 2]),
    ],
];

/// The terms of `d`.
pub(super) const SHIFT: [&[Term]; 4] = [
    &[term(1, 6, 1, 0, [0, 1, 0]), term(-1, 3, 0, 1, [0, 0, 1])],
    &[
        term(-1, 60, 2, 0, [1, 1, 0]),
        term(-1, 10, 2, 0, [0, 0, 1]),
        term(-1, 60, 1, 1, [0, 2, 0]),
        term(2, 15, 1, 1, [1, 0, 1]),
        term(-1, 60, 0, 2, [0, 1, 1]),
    ],
    &[
        term(1, 1260, 3, 0, [2, 1, 0]),
        term(-13, 1260, 3, 0, [0, 2, 0]),
        term(1, 42, 3, 0, [1, 0, 1]),
        term(13, 2520, 2, 1, [1, 2, 0]),
        term(-8, 315, 2, 1, [2, 0, 1]),
        term(11, 252, 2, 1, [0, 1, 1]),
        term(1, 1260, 1, 2, [0, 3, 0]),
        term(-1, 1260, 1, 2, [1, 1, 1]),
        term(-22, 315, 1, 2, [0, 0, 2]),
        term(-19, 2520, 0, 3, [0, 2, 1]),
        term(1, 35, 0, 3, [1, 0, 2]),
    ],
    &[
        term(-1, 45360, 4, 0, [3, 1, 0]),
        term(-1, 7560, 4, 0, [1, 2, 0]),
        term(-1, 360, 4, 0, [2, 0, 1]),
        term(17, 1680, 4, 0, [0, 1, 1]),
        term(-1, 1512, 3, 1, [2, 2, 0]),
        term(97, 22680, 3, 1, [0, 3, 0]),
        term(8, 2835, 3, 1, [3, 0, 1]),
        term(-23, 1890, 3, 1, [1, 1, 1]),
        term(-1, 35, 3, 1, [0, 0, 2]),
        term(-1, 1512, 2, 2, [1, 3, 0]),
        term(19, 7560, 2, 2, [2, 1, 1]),
        term(-19, 1080, 2, 2, [0, 2, 1]),
        term(89, 1890, 2, 2, [1, 0, 2]),
        term(-1, 45360, 1, 3, [0, 4, 0]),
        term(37, 7560, 1, 3, [1, 2, 1]),
        term(-2, 105, 1, 3, [2, 0, 2]),
        term(19, 1260, 1, 3, [0, 1, 2]),
        term(-61, 45360, 0, 4, [0, 3, 1]),
        term(3, 560, 0, 4, [1, 1, 2]),
        term(-61, 4536, 0, 4, [0, 0, 3]),
    ],
];
