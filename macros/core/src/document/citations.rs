//! What a derivation cites: where each equation of a model stands in a work, and what is wrong with it there. It is data
//! that comes with the model; nothing here is found out from the model.

pub use crate::print::document::Work;

/// An equation that can be cited. Those of every configuration have one citation.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Place<'a> {
    /// The reconstruction of the configuration with this name.
    Reconstruction(&'a str),
    /// The rule by which the advected quantity with this name evolves.
    Rule(&'a str),
    /// The discrete Lagrangian.
    Action,
    /// The Clebsch action.
    ClebschAction,
    /// The Clebsch relation of the variable with this name.
    Relation(&'a str),
    /// The momentum map of the multipliers.
    Lifted,
    /// The momentum of the edge.
    Momentum,
    /// The momentum of the edge as the momentum map at its start.
    AtStart,
    /// The momentum of the edge as the momentum map at its end.
    AtEnd,
    /// The discrete Euler-Poincaré equation.
    Balance,
    /// The Moser-Veselov equation, which a Riccati equation solves.
    Riccati,
    /// The continuous equation of motion.
    Continuous,
}

/// What is cited of one model.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Citations {
    /// The work that is cited.
    pub work: Option<Work>,
    /// What is said of the whole model, a paragraph; empty for nothing. A name between dollar signs is mathematics.
    pub statement: &'static str,
    /// Where equations stand in the work, and what is said of that; mathematics stands between dollar signs.
    pub places: &'static [(Place<'static>, &'static str)],
}

impl Citations {
    /// Nothing is cited.
    pub const NONE: Citations = Citations {
        work: None,
        statement: "",
        places: &[],
    };

    /// The source of an equation, `thesis (2.85)`.
    pub fn of(&self, place: Place<'_>) -> Option<String> {
        let (work, mut places) = (self.work?, self.places.iter());
        let (_, said) = places.find(|(at, _)| *at == place)?;
        Some(format!("{} {said}", work.named))
    }
}
