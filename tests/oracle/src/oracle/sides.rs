//! On which side a variation acts, and to which edge a summand at one node belongs.
//! Takes nothing; gives the two choices that a stated action leaves open.

use super::dual::Number;

/// On which side of the group element a variation acts.
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
    /// At node k+1, the node into which the edge comes.
    Incoming,
    /// At node k, the node out of which the edge goes.
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

    /// The word of the model language.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Symmetric => "symmetric",
            Self::Incoming => "incoming",
            Self::Outgoing => "outgoing",
        }
    }
}
