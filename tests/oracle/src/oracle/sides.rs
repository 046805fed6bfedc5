//! The two choices that a stated action leaves open: the side of a variation, and the edge of a summand at one node.

use super::dual::Number;

/// The side of the group element on which a variation acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// `Λ exp(ε X)`: the velocity is `Λ_k⁻¹ Λ_{k+1}`.
    Body,
    /// `exp(ε X) Λ`: the velocity is `Λ_{k+1} Λ_k⁻¹`.
    Space,
}

/// Where a summand without velocity is evaluated on the edge from node k to node k+1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeRule {
    /// The mean of both ends: second order.
    Symmetric,
    /// At node k+1, the head of the edge.
    Incoming,
    /// At node k, the tail of the edge.
    Outgoing,
}

impl NodeRule {
    /// The nodal summand of one edge from its values at both ends.
    pub fn split<T: Number>(self, at_tail: T, at_head: T) -> T {
        match self {
            Self::Symmetric => (at_tail + at_head) * T::constant(0.5),
            Self::Incoming => at_head,
            Self::Outgoing => at_tail,
        }
    }

    /// The keyword of the model language.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Symmetric => "symmetric",
            Self::Incoming => "incoming",
            Self::Outgoing => "outgoing",
        }
    }
}
