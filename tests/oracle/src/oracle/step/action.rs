//! The action of one step as a function that is typed once and evaluated on several scalars.
//! Takes what stands at both ends; gives the action, or what constraints hold.

use super::place::Place;
use crate::oracle::dual::{Dual, Number};
use crate::oracle::pair::Pair;
use crate::oracle::square::Square;

/// What an action is a function of.
#[derive(Clone, Copy, Debug)]
pub struct Edge<'a, T> {
    /// The step.
    pub h: T,
    /// Parameters, and initial values of what the configuration carries.
    pub given: Place<'a, T>,
    /// Where the first step starts; it does not vary.
    pub start: Place<'a, T>,
    /// What moves, at node 0.
    pub tail: Place<'a, T>,
    /// What moves, at node 1.
    pub head: Place<'a, T>,
}

impl<T: Number> Edge<'_, T> {
    /// A term at one node, split over both edges of the node.
    pub fn at_nodes(&self, term: impl Fn(&Place<'_, T>) -> T) -> T {
        (term(&self.tail) + term(&self.head)) * T::constant(0.5)
    }

    /// The increment of a number.
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

/// One function on one scalar.
pub type On<T> = fn(&Edge<'_, T>) -> T;

/// What is held at the head of an edge, on one scalar: numbers that vanish.
pub type Held<T> = fn(&Place<'_, T>, &Place<'_, T>) -> Vec<T>;

/// What is held, and the action with second derivatives in 32 digits.
pub type OfHeld = (Held<Dual<Pair>>, On<Dual<Dual<Pair>>>);

/// An action on the scalars that a solution takes.
#[derive(Clone, Copy, Debug)]
pub struct Action {
    /// First derivatives in 32 digits.
    pub precise: On<Dual<Pair>>,
    /// Second derivatives in 16 digits, for the matrix of Newton's method.
    pub twice: On<Dual<Dual<f64>>>,
    /// What is held, and second derivatives in 32 digits for the velocity of a momentum.
    pub held: Option<OfHeld>,
}

/// The action of the generic function of this name; of a second one what is held, by parameters and a node.
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
