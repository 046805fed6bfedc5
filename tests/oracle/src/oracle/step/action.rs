//! The action of one step as a generic function, written once and evaluated on several scalars, and the constraints of a node.

use super::place::Place;
use crate::oracle::dual::{Dual, Number};
use crate::oracle::pair::Pair;
use crate::oracle::square::Square;

/// The arguments of an action.
#[derive(Clone, Copy, Debug)]
pub struct Edge<'a, T> {
    /// The step size.
    pub h: T,
    /// Parameters, and initial values of advected quantities.
    pub given: Place<'a, T>,
    /// The initial state of the first step; it is not varied.
    pub start: Place<'a, T>,
    /// The configuration at node 0.
    pub tail: Place<'a, T>,
    /// The configuration at node 1.
    pub head: Place<'a, T>,
}

impl<T: Number> Edge<'_, T> {
    /// The mean over both ends of a term at one node.
    pub fn at_nodes(&self, term: impl Fn(&Place<'_, T>) -> T) -> T {
        (term(&self.tail) + term(&self.head)) * T::constant(0.5)
    }

    /// The increment of a scalar.
    #[must_use]
    pub fn change(&self, name: &str) -> T {
        self.head.real(name) - self.tail.real(name)
    }

    /// The increment of a vector.
    #[must_use]
    pub fn changes<const N: usize>(&self, name: &str) -> [T; N] {
        let (from, to): ([T; N], [T; N]) = (self.tail.column(name), self.head.column(name));
        std::array::from_fn(|i| to[i] - from[i])
    }

    /// The increment of a matrix.
    #[must_use]
    pub fn changed<const N: usize>(&self, name: &str) -> Square<T, N> {
        self.head.square(name) - self.tail.square(name)
    }

    /// `R^T*next(R)`.
    #[must_use]
    pub fn turn<const N: usize>(&self, name: &str) -> Square<T, N> {
        self.tail.square::<N>(name).transpose() * self.head.square(name)
    }

    /// `next(R)*R^T`.
    #[must_use]
    pub fn turn_in_space<const N: usize>(&self, name: &str) -> Square<T, N> {
        self.head.square::<N>(name) * self.tail.square::<N>(name).transpose()
    }

    /// `Q^-1*next(Q)`.
    #[must_use]
    pub fn map<const N: usize>(&self, name: &str) -> Square<T, N> {
        self.tail.square::<N>(name).inverse() * self.head.square(name)
    }
}

/// The action on one scalar type.
pub type On<T> = fn(&Edge<'_, T>) -> T;

/// The constraint functions at the head of an edge, on one scalar type.
pub type ConstraintFunctions<T> = fn(&Place<'_, T>, &Place<'_, T>) -> Vec<T>;

/// The constraints, and the action with second derivatives to 32 digits.
pub type OfHeld = (ConstraintFunctions<Dual<Pair>>, On<Dual<Dual<Pair>>>);

/// An action on the scalar types that the solver needs.
#[derive(Clone, Copy, Debug)]
pub struct Action {
    /// First derivatives to 32 digits.
    pub precise: On<Dual<Pair>>,
    /// Second derivatives to 16 digits, for the Jacobian of Newton's method.
    pub twice: On<Dual<Dual<f64>>>,
    /// The constraints, with second derivatives to 32 digits for the velocity of a momentum.
    pub held: Option<OfHeld>,
}

/// The `Action` of a generic function. The optional second function gives the constraints as a function of parameters and a node.
#[macro_export]
macro_rules! action {
    ($edge:ident) => {
        $crate::oracle::step::Action {
            precise: $edge,
            twice: $edge,
            held: None,
        }
    };
    ($edge:ident, $held:ident) => {
        $crate::oracle::step::Action {
            precise: $edge,
            twice: $edge,
            held: Some(($held, $edge)),
        }
    };
}
