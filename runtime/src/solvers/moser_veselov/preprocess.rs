//! Modified moments that give the Moser-Veselov step of a free body high order. Takes the body, its scaled momentum and
//! the order; gives the body to step instead.
//!
//! With `1 / I_i' = s / I_i + d` the discrete motion stays on the orbit of the true body. `s` and `d` are series in
//! the square of the step, chosen so that the motion along the orbit and the attitude agree with the true body
//! (Hairer and Vilmart, J. Phys. A 39 (2006) 13225). They depend only on the energy and `|mu|^2`, which the motion
//! conserves: a trajectory computes them once.
//!
//! The momentum's map is Poisson at every order. The map of momentum and attitude together is
//! symplectic at order two only, since `s` and `d` differ between neighbouring trajectories. A
//! rotation about the momentum, as small as the error of the step, restores symplecticity
//! ([`Free::compensated`](super::Free::compensated)).

use super::Poinsot;
use super::coefficients::{FACTOR, SHIFT, Term};
use crate::Real;
use crate::linalg;
use core::fmt;
use nalgebra::Matrix3;

/// The order of accuracy of a step, in momentum and attitude.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Order {
    /// Order two, without modification: symplectic in momentum and attitude.
    #[default]
    Two,
    /// Order four.
    Four,
    /// Order six.
    Six,
    /// Order eight.
    Eight,
    /// Order ten.
    Ten,
}

impl Order {
    /// All orders, from the lowest.
    pub const ALL: [Self; 5] = [Self::Two, Self::Four, Self::Six, Self::Eight, Self::Ten];

    /// The order as a number.
    #[must_use]
    pub fn number(self) -> u32 {
        2 * (self as u32) + 2
    }

    /// The order with this number, if there is one.
    #[must_use]
    pub fn of_number(number: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|o| o.number() == number)
    }

    /// The number of terms of the series for this order.
    pub(super) fn terms(self) -> usize {
        self as usize
    }
}

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.number())
    }
}

/// The body to step instead of `body`, for the trajectory through `u = h mu / (2 unit)`. `None` if
/// the step is so long that a modified moment is not positive in some lane.
pub(super) fn preprocessed<T: Real>(
    body: &Poinsot<T>,
    u: [T; 3],
    order: Order,
) -> Option<Poinsot<T>> {
    if order == Order::Two {
        return Some(*body);
    }
    let invariants = Invariants::of(body, u);
    let series = |table: &[&[Term]; 4]| {
        let taken = table.iter().take(order.terms());
        let terms = taken.flat_map(|list| list.iter());
        terms.fold(T::zero(), |sum, term| sum + invariants.value(term))
    };
    let (s, d) = (T::one() + series(&FACTOR), series(&SHIFT));
    let inverse = body.inverse_inertia() * s + Matrix3::from_diagonal_element(d);
    let inertia = linalg::inverse(&inverse)?;
    positive(&inertia).then(|| body.with_inertia(&inertia))
}

/// The variables of the polynomials.
pub(super) struct Invariants<T> {
    /// `h^2` times the energy.
    pub(super) energy: T,
    /// `h^2 |mu|^2 / 2`.
    pub(super) momentum: T,
    /// Symmetric functions of the inverse moments.
    pub(super) symmetric: [T; 3],
}

impl<T: Real> Invariants<T> {
    /// The invariants of the trajectory through `u = h mu / (2 unit)`, in units of the body.
    pub(super) fn of(body: &Poinsot<T>, u: [T; 3]) -> Self {
        let [x, y, z] = u;
        let squares = [x * x, y * y, z * z];
        let two = T::from_f64(2.0);
        let energy = body.energy.value::<false>(squares, [y * z, z * x, x * y]);
        Self {
            energy: two * energy,
            momentum: two * (squares[0] + squares[1] + squares[2]),
            symmetric: [
                body.symmetric.second,
                body.symmetric.first,
                body.symmetric.zeroth,
            ],
        }
    }

    fn value(&self, term: &Term) -> T {
        let (numerator, denominator) = term.factor;
        let [e1, e2, e3] = self.symmetric;
        let [p, q, r] = term.symmetric;
        let of_body = e1.powi(p) * e2.powi(q) * e3.powi(r);
        let of_motion = self.energy.powi(term.energy) * self.momentum.powi(term.momentum);
        T::from_ratio(numerator, denominator) * of_body * of_motion
    }
}

/// Whether a symmetric matrix is positive definite in every lane, by its leading minors. The
/// comparison is false for NaN.
fn positive<T: Real>(a: &Matrix3<T>) -> bool {
    let [[xx, xy, _], [_, yy, _], _] = a.data.0;
    [xx, xx * yy - xy * xy, linalg::determinant(a)]
        .iter()
        .all(|minor| minor.exceeds(T::zero()))
}
