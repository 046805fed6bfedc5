//! The rotation about the spatial momentum that makes a step with modified moments symplectic on
//! T*SO(3). Takes a body, the order of its steps and a trajectory; gives that rotation, a constant of
//! the trajectory.
//!
//! Let `H` be the energy and `C = |mu|^2 / 2`. A map that conserves momentum and energy and is symplectic for constant
//! `s`, `d` is a composition of the flows of `H` and `C`. A step of the body with inverse moments `s / I + d` is such
//! a map: a motion of the true body for the time `h s'`, then the flow of `C` for the time `h d'`, a rotation about
//! the momentum. If `s`, `d` are functions of `H` and `C`, so are `s'` and `d'`, and the map is symplectic if and only
//! if `s' dH + d' dC` is closed. A further rotation for the time `h b`, where `b` is a function of `H` and `C`, makes
//! it symplectic if `db/dH = ds'/dC - dd'/dH`.
//!
//! `s'` and `d'` follow from the series of order ten. The series give, for every body, the body to step instead; for
//! the body with inverse moments `s' / I + d'` this is the body with `s / I + d`. `s'`, `d'` and `b` are polynomials in
//! `h^2 H` and `h^2 C`, correct up to the eighth power of `h` for every order of the step. `s' - 1`, `d'` and `b` begin
//! with the first power that the step neglects.

use super::coefficients::{FACTOR, SHIFT, Term};
use super::preprocess::Invariants;
use super::{Order, Poinsot};
use crate::{Real, Rotation};

/// The number of powers of `h^2` that are kept, from zero to all known powers.
const POWERS: usize = 5;

/// A polynomial in `E = h^2 H` and `M = h^2 C`, up to a common degree: `[i][j]` is the factor of `E^i M^j`.
#[derive(Clone, Copy)]
struct Polynomial<T>([[T; POWERS]; POWERS]);

impl<T: Real> Polynomial<T> {
    fn constant(x: T) -> Self {
        let mut all = [[T::zero(); POWERS]; POWERS];
        all[0][0] = x;
        Self(all)
    }

    /// `E` and `M`.
    fn variables() -> [Self; 2] {
        let [mut energy, mut momentum] = [[[T::zero(); POWERS]; POWERS]; 2];
        energy[1][0] = T::one();
        momentum[0][1] = T::one();
        [Self(energy), Self(momentum)]
    }

    fn plus(mut self, other: &Self) -> Self {
        for (row, others) in self.0.iter_mut().zip(&other.0) {
            for (x, y) in row.iter_mut().zip(others) {
                *x += *y;
            }
        }
        self
    }

    fn scaled(self, factor: T) -> Self {
        Self(self.0.map(|row| row.map(|x| x * factor)))
    }

    /// The product, truncated to the powers that are kept.
    fn times(&self, other: &Self) -> Self {
        let mut all = [[T::zero(); POWERS]; POWERS];
        for i in 0..POWERS {
            for j in 0..POWERS - i {
                for k in 0..POWERS - i - j {
                    for l in 0..POWERS - i - j - k {
                        all[i + k][j + l] += self.0[i][j] * other.0[k][l];
                    }
                }
            }
        }
        Self(all)
    }

    fn power(&self, exponent: i32) -> Self {
        (0..exponent).fold(Self::constant(T::one()), |product, _| product.times(self))
    }

    /// `1 / (1 + x)` for an `x` without a constant term.
    fn inverse_of_one_plus(x: &Self) -> Self {
        let one = Self::constant(T::one());
        (1..POWERS).fold(one, |sum, _| one.plus(&sum.times(x).scaled(-T::one())))
    }

    fn value(&self, energy: T, momentum: T) -> T {
        self.0.iter().rev().fold(T::zero(), |sum, row| {
            let inner = row
                .iter()
                .rev()
                .fold(T::zero(), |sum, x| sum * momentum + *x);
            sum * energy + inner
        })
    }
}

/// A body as the series see it: its energy, `M`, and the symmetric functions of its inverse moments.
struct BodySeries<T> {
    energy: Polynomial<T>,
    momentum: Polynomial<T>,
    symmetric: [Polynomial<T>; 3],
}

impl<T: Real> BodySeries<T> {
    /// The body with inverse moments `s r + d`, where `r` has these symmetric functions.
    fn of(s: &Polynomial<T>, d: &Polynomial<T>, symmetric: [T; 3]) -> Self {
        let [energy, momentum] = Polynomial::variables();
        let [e1, e2, e3] = symmetric.map(Polynomial::constant);
        let number = |x: f64| T::from_f64(x);
        let (se1, sse2) = (s.times(&e1), s.times(s).times(&e2));
        let ssse3 = s.times(s).times(s).times(&e3);
        let (dd, ddd) = (d.times(d), d.times(d).times(d));
        Self {
            energy: s.times(&energy).plus(&d.times(&momentum)),
            momentum,
            symmetric: [
                se1.plus(&d.scaled(number(3.0))),
                sse2.plus(&d.times(&se1).scaled(number(2.0)))
                    .plus(&dd.scaled(number(3.0))),
                ssse3.plus(&d.times(&sse2)).plus(&dd.times(&se1)).plus(&ddd),
            ],
        }
    }

    /// The first tables of a series.
    fn series(&self, tables: &[&[Term]]) -> Polynomial<T> {
        let zero = Polynomial::constant(T::zero());
        let terms = tables.iter().flat_map(|list| list.iter());
        terms.fold(zero, |sum, term| {
            let [p, q, r] = term.symmetric;
            let [e1, e2, e3] = &self.symmetric;
            let product = e1.power(p).times(&e2.power(q)).times(&e3.power(r));
            let product = product.times(&self.energy.power(term.energy));
            let product = product.times(&self.momentum.power(term.momentum));
            let (numerator, denominator) = term.factor;
            sum.plus(&product.scaled(T::from_ratio(numerator, denominator)))
        })
    }
}

/// `b` for the trajectory through `u = h mu / (2 unit)`, in units of the body: half of the rotation is by the vector
/// `b u`, with `u` in the space frame.
pub(super) fn factor<T: Real>(body: &Poinsot<T>, u: [T; 3], order: Order) -> T {
    let one = Polynomial::constant(T::one());
    let invariants = Invariants::of(body, u);
    let symmetric = invariants.symmetric;
    let given = BodySeries::of(&one, &Polynomial::constant(T::zero()), symmetric);
    let taken = order.terms();
    let (s, d) = (
        one.plus(&given.series(&FACTOR[..taken])),
        given.series(&SHIFT[..taken]),
    );
    // Each pass makes one more power exact.
    let (mut effective_s, mut effective_d) = (one, Polynomial::constant(T::zero()));
    for _ in 0..POWERS {
        let effective = BodySeries::of(&effective_s, &effective_d, symmetric);
        let inverse = Polynomial::inverse_of_one_plus(&effective.series(&FACTOR));
        let shift = effective.series(&SHIFT).scaled(-T::one());
        effective_s = s.times(&inverse);
        effective_d = d.plus(&shift).times(&inverse);
    }
    let mut turn = effective_d.scaled(-T::one());
    for j in 0..POWERS {
        // A function of C alone does not affect symplecticity.
        turn.0[0][j] = T::zero();
    }
    for i in 1..POWERS {
        for j in 0..POWERS - i {
            let ratio = T::from_ratio(j as i64 + 1, i as i64);
            turn.0[i][j] += effective_s.0[i - 1][j + 1] * ratio;
        }
    }
    turn.value(invariants.energy, invariants.momentum)
}

/// The rotation by twice the small vector `half`, by the series of sine and cosine.
pub(super) fn rotation<T: Real>(half: [T; 3]) -> Rotation<T> {
    let [x, y, z] = half;
    let square = x * x + y * y + z * z;
    let series = |list: [i64; 4]| {
        let terms = list.into_iter().rev();
        terms.fold(T::zero(), |sum, n| T::from_ratio(1, n) - sum * square)
    };
    let (cosine, sine) = (series([1, 2, 24, 720]), series([1, 6, 120, 5040]));
    Rotation::from_unit([cosine, x * sine, y * sine, z * sine]).renormalised()
}
